# SPDX-License-Identifier: GPL-3.0-or-later
"""crashpulse export and pulse: an exported crash, read back by 'crashpulse pulse', has the OLC and
delta-v of the database in every format that carries a pulse; readers written here from the rules of
the formats find what the database holds; sumo loads the points of interest; nothing is written
where it must not be."""
import argparse
import csv
import json
import math
import os
import pathlib
import sqlite3
import subprocess
import sys
import tempfile
import unittest
from xml.etree import ElementTree

parser = argparse.ArgumentParser()
parser.add_argument("--crashpulse", required=True)
parser.add_argument("--network", required=True, help="folder of the crossing")
parser.add_argument("--source", required=True, help="the project's folder")
ARGS = parser.parse_args()
LIST = ("id,vehicle_a,vehicle_b,speed_a_km_h,speed_b_km_h,offset_mm,angle_deg\n"
        "one,van,suv,50,40,0,0\ntwo,small_car,mid_size,45,45,300,10\nthree,mid_size,van,56,30,0,90\n"
        "four,honda_accord_2014,small_car,30,20,-500,-25\n")
TEST = pathlib.Path(ARGS.source) / ".." / "shared" / "reference" / "nhtsa_v10146_camry_2018"


def call(*words, code=0, cwd=None):
    done = subprocess.run([ARGS.crashpulse, *map(str, words)], text=True, capture_output=True, cwd=cwd)
    if done.returncode != code:
        raise AssertionError(f"{words}: exit code {done.returncode}, not {code}\n{done.stdout}{done.stderr}")
    return done


def figures(*words):
    return json.loads(call("pulse", *words, "--format", "json").stdout)


# ---- readers of our own, from the formats' rules -------------------------------------------------


def iso_lines(path):
    """Descriptors of an ISO-MME file, name padded to 28 columns, then ':value', and what follows."""
    fields, values = {}, []
    for line in path.read_text(encoding="ascii").split("\n"):
        if line[28:29] == ":":
            fields.setdefault(line[:28].rstrip(), line[29:])
        elif line:
            values.append(float(line))
    return fields, values


def iso_test(folder):
    """{test object: {code without object and filter: (interval, values)}} and the test's descriptors."""
    test, _ = iso_lines(next(folder.glob("*.mme")))
    listed, _ = iso_lines(next((folder / "Channel").glob("*.chn")))
    channels = {}
    for number in range(1, int(listed["Number of channels"]) + 1):
        code, _ = listed[f"Name of channel {number:03}"].split(" / ", 1)
        fields, values = iso_lines(folder / "Channel" / f"{folder.name}.{number:03}")
        assert fields["Channel code"] == code and len(code) == 16, (fields, code)
        assert fields["Reference channel"] == "implicit" and float(fields["Time of first sample"]) == 0.0
        assert int(fields["Number of samples"]) == len(values)
        assert fields["Unit"] == {"AC": "m/s2", "VE": "m/s", "DS": "m", "AN": "rad", "AV": "rad/s",
                                  "AA": "rad/s2"}[code[12:14]], fields
        assert fields["Channel frequency class"] == {"C": "180", "D": "60"}.get(code[15], "NOVALUE")
        assert code[:2] in ("10", "20") and code[2:12] == "VEHCCG0000", code
        channels.setdefault(int(code[0]), {})[code[12:]] = (float(fields["Sampling interval"]), values)
    return test, channels


def curves(path):
    """{title: [(time, value)]} of an LS-DYNA keyword file: fields of 10 and 20 columns."""
    found, lines = {}, [line for line in path.read_text().split("\n") if not line.startswith("$")]
    k = 0
    while k < len(lines):
        if lines[k] == "*DEFINE_CURVE_TITLE":
            title, card = lines[k + 1], lines[k + 2]
            numbers = [float(card[10 * f:10 * f + 10]) for f in range(6)]
            assert numbers[1:] == [0, 1, 1, 0, 0], card
            k += 3
            points = []
            while k < len(lines) and not lines[k].startswith("*"):
                points.append((float(lines[k][:20]), float(lines[k][20:40])))
                k += 1
            assert title not in found and numbers[0] not in [c[0] for c in found.values()]
            found[title] = (numbers[0], points)
        else:
            k += 1
    return {title: points for title, (_, points) in found.items()}


def olc_g(interval, v):
    """Occupant load criterion by its definition, small steps on the record continued at its end."""
    v0, step, s, t, t1 = v[0], 2e-5, 0.0, 0.0, None

    def at(time):
        place = time / interval
        k = min(int(place), len(v) - 1)
        return v[-1] if k + 1 >= len(v) else v[k] + (place - k) * (v[k + 1] - v[k])
    while t < 0.5:
        s += step * (v0 - 0.5 * (at(t) + at(t + step)))
        t += step
        if t1 is None and s >= 0.065:
            t1 = t
        if t1 is not None and s - 0.5 * (v0 - at(t)) * (t - t1) >= 0.3:
            return (v0 - at(t)) / (t - t1) / 9.80665
    return None


class Exports(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.work = pathlib.Path(cls.folder.name)
        (cls.work / "list.csv").write_text(LIST)
        cls.db = cls.work / "study.db"
        call("assess", "--configurations", cls.work / "list.csv", "--db", cls.db)
        connection = sqlite3.connect(cls.db)
        connection.row_factory = sqlite3.Row
        cls.rows = [dict(row) for row in connection.execute(
            "SELECT v.*, c.separation_s, c.x_m, c.y_m, c.number FROM crash_vehicle AS v JOIN crash AS c "
            "ON c.id = v.crash_id ORDER BY c.id, role")]
        connection.close()
        assert len(cls.rows) == 8
        # What the simulation itself gives, every half millisecond and unrounded, with the last contact.
        for row in cls.rows:
            raw = cls.work / "raw.csv"
            call("crash", "--from", cls.db, "--crash", row["crash_id"], "--raw", "--pulse", raw)
            lines = raw.read_text().splitlines()
            raw.write_text("\n".join([lines[0] + ",separation_s,contact_side"] + [
                f"{line},{row['separation_s']},{row['contact_side']}" for line in lines[1:]]) + "\n")
            row["simulated"] = figures(raw, "--vehicle", row["role"])

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def same(self, row, found, where):
        """Within 0.01 g and 0.01 km/h of what the simulation gave."""
        self.assertEqual(found["olc_status"], row["olc_status"], where)
        if row["olc_g"] is None:
            self.assertIsNone(found["olc_g"], where)
        else:
            self.assertAlmostEqual(found["olc_g"], row["olc_g"], delta=0.01, msg=where)
        # The change is largest at its end, where a rounded sample moves that time and with it the
        # components; the mean goes to the lowest v_x, whose time moves likewise.
        told = row["simulated"]
        for name, apart in (("olc_g", 0.01), ("delta_v_km_h", 0.01), ("delta_v_x_km_h", 0.05), ("delta_v_y_km_h", 0.05),
                            ("speed_km_h", 0.01), ("pdof_deg", 0.1), ("mean_g", 0.2), ("max_50ms_g", 0.02),
                            ("peak_g", 0.3)):
            if told[name] is not None:
                self.assertAlmostEqual(found[name], told[name], delta=apart, msg=(where, name))
        self.assertAlmostEqual(found["speed_km_h"], 3.6 * row["speed_m_s"], delta=0.01, msg=where)
        self.assertEqual(found["contact_side"], row["contact_side"], where)
        self.assertTrue(found["delta_v_final"], where)

    def test_read_back_every_format_gives_the_same(self):
        call("export", self.db, "--as", "iso-mme", "--output", self.work / "mme")
        call("export", self.db, "--as", "csv", "--output", self.work / "all.csv")
        for units in ("mm-ms-kg", "m-s-kg", "mm-s-t"):
            call("export", self.db, "--as", "lsdyna", "--units", units, "--output", self.work / units)
        for row in self.rows:
            crash, which = row["crash_id"], ("--vehicle", row["role"])
            self.same(row, figures(self.db, "--crash", crash, *which), "stored")
            self.same(row, figures(self.work / "mme" / f"crash_{crash}", *which), "iso-mme")
            self.same(row, figures(self.work / "all.csv", "--crash", crash, *which), "csv")
            for units in ("mm-ms-kg", "m-s-kg", "mm-s-t"):
                self.same(row, figures(self.work / units / f"crash_{crash}.k", *which), units)
        # One of them, as one file; and an export of what was exported.
        row = self.rows[2]
        for form, name in (("csv", "one.csv"), ("lsdyna", "one.k"), ("iso-mme", "one")):
            call("export", self.db, "--as", form, "--crash", row["crash_id"], "--output", self.work / name)
            path = self.work / name / f"crash_{row['crash_id']}" if form == "iso-mme" else self.work / name
            self.same(row, figures(path), form)
            for other, again in (("csv", "again.csv"), ("lsdyna", "again.k"), ("iso-mme", "again")):
                place = self.work / f"{form}-{again}"
                call("export", path, "--as", other, "--output", place)
                self.same(row, figures(place / "pulse" if other == "iso-mme" else place), (form, other))

    def test_iso_mme_is_what_the_standard_says(self):
        call("export", self.db, "--as", "iso-mme", "--output", self.work / "standard")
        pulses = {(row["crash_id"], row["role"]): row for row in self.rows}
        call("export", self.db, "--as", "csv", "--output", self.work / "ours.csv")
        with open(self.work / "ours.csv", encoding="ascii", newline="") as file:
            ours = list(csv.DictReader(file))
        for folder in sorted((self.work / "standard").iterdir()):
            test, objects = iso_test(folder)
            self.assertEqual(test["Number of test objects"], "2")
            self.assertEqual(sorted(objects), [1, 2])
            for number, role in ((1, "a"), (2, "b")):
                row = pulses[int(folder.name[6:]), role]
                self.assertEqual(test[f"Name of test object {number}"], row["vehicle_model"])
                self.assertAlmostEqual(float(test[f"Velocity test object {number}"]), row["speed_m_s"], 3)
                self.assertAlmostEqual(float(test[f"Mass test object {number}"]), row["mass_kg"], 3)
                self.assertEqual(test[f"Impact side test object {number}"],
                                 {"front": "FR", "left": "LE", "right": "RI", "rear": "RE"}[row["contact_side"]])
                own = [line for line in ours if line["crash_id"] == folder.name[6:] and line["vehicle"] == role]
                for code, column, sign in (("ACXC", "ax_m_s2", 1), ("ACYC", "ay_m_s2", -1), ("VEX0", "vx_m_s", 1),
                                           ("VEY0", "vy_m_s", -1), ("DSX0", "x_m", 1), ("DSY0", "y_m", -1),
                                           ("ANZ0", "yaw_rad", -1), ("AVZ0", "yaw_rate_rad_s", -1),
                                           ("AAZC", "yaw_acc_rad_s2", -1)):
                    interval, values = objects[number][code]
                    self.assertEqual(len(values), len(own))
                    self.assertAlmostEqual(interval, float(own[1]["time_s"]), 9)
                    for value, line in zip(values, own):
                        self.assertAlmostEqual(value, sign * float(line[column]), 6, (folder.name, code))
                # The filtered channel is the smoother one of the same motion.
                for name in ("ACX", "ACY", "AAZ"):
                    raw, smooth = objects[number][name + "C"][1], objects[number][name + "D"][1]
                    self.assertEqual(len(raw), len(smooth))
                    self.assertLessEqual(max(map(abs, smooth)), 1.05 * max(map(abs, raw)) + 0.1)
                if row["olc_g"] is not None:
                    interval, v = objects[number]["VEX0"]
                    self.assertAlmostEqual(olc_g(interval, v), row["olc_g"], delta=0.02)

    def test_load_curves_are_consistent(self):
        for units, length, time in (("mm-ms-kg", 1e3, 1e3), ("m-s-kg", 1, 1), ("mm-s-t", 1e3, 1)):
            place = self.work / f"curve-{units}.k"
            row = self.rows[0]
            call("export", self.db, "--as", "lsdyna", "--units", units, "--crash", row["crash_id"],
                 "--output", place)
            found = curves(place)
            self.assertEqual(len(found), 18)
            for role in "ab":
                own = self.rows[0 if role == "a" else 1]
                v = found[f"crashpulse vehicle {role} v_x"]
                a = found[f"crashpulse vehicle {role} a_x"]
                self.assertAlmostEqual(v[0][1] * time / length, own["speed_m_s"], 3)
                self.assertAlmostEqual(v[1][0], 1e-3 * time, 9)
                change = sum(0.5 * (one[1] + two[1]) * (two[0] - one[0]) for one, two in zip(a, a[1:]))
                self.assertAlmostEqual(change * time / length, (v[-1][1] - v[0][1]) * time / length, delta=0.1)
        # A curve of another program: its units and its id must be said.
        foreign = self.work / "foreign.k"
        foreign.write_text("*KEYWORD\n*DEFINE_CURVE\n        12         0      -1.0      15.6\n" +
                           "".join(f"{-0.001 * k:20.6f}{max(0.0, 1 - k / 80):20.10f}\n" for k in range(200)) +
                           "*DEFINE_CURVE\n13\n0,0\n1,1\n*END\n")
        self.assertIn("id (LCID) of the one meant", call("pulse", foreign, code=2).stderr)
        self.assertIn("system of units", call("pulse", foreign, "--channels", "12", code=2).stderr)
        one = figures(foreign, "--channels", "12", "--units", "m-s-kg")
        # 195 m/s^2 for 80 ms from 15.6 m/s: the car stands, 0.624 m on, before the occupant moves with it.
        t1 = math.sqrt(2 * 0.065 / 195)
        self.assertAlmostEqual(one["olc_g"], 15.6**2 / (2 * (0.3 + 0.624 - 15.6 * t1)) / 9.80665, delta=0.002)
        self.assertAlmostEqual(one["delta_v_km_h"], 56.16, 6)
        self.assertAlmostEqual(one["peak_g"], 195 / 9.80665, delta=1.0)

    def test_sites(self):
        place = self.work / "crashes.add.xml"
        call("export", self.db, "--as", "sumo-poi", "--output", place)
        root = ElementTree.parse(place).getroot()
        self.assertEqual(root.tag, "additional")
        self.assertEqual([poi.get("id") for poi in root],
                         [f"crash.{row['crash_id']}" for row in self.rows if row["role"] == "a"])
        for poi, row in zip(root, [row for row in self.rows if row["role"] == "a"]):
            self.assertAlmostEqual(float(poi.get("x")), row["x_m"], 3)
            found = {one.get("key"): one.get("value") for one in poi}
            self.assertEqual(found["vehicle_a"], row["sumo_id"])
            self.assertAlmostEqual(float(found["olc_a_g"]), row["olc_g"], 3)
        environment = {**os.environ, "SUMO_HOME": "/usr/share/sumo"}
        environment.pop("LD_PRELOAD", None)
        network = pathlib.Path(ARGS.network) / "crossing.net.xml"
        done = subprocess.run(["sumo", "-n", network, "-a", place, "--end", "1", "--xml-validation", "always"],
                              capture_output=True, text=True, env=environment)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

        call("export", self.db, "--as", "geojson", "--plane", "--output", self.work / "plane.json")
        found = json.loads((self.work / "plane.json").read_text())
        self.assertIn("not degrees", found["coordinates"])
        self.assertEqual([site["id"] for site in found["features"]],
                         [row["crash_id"] for row in self.rows if row["role"] == "a"])
        # On the earth: a made-up network in the plane of UTM zone 32, whose places other programs place.
        earth = self.work / "earth.net.xml"
        earth.write_text('<net version="1.9"><location netOffset="-683542.41,-4928877.56" convBoundary="0,0,1,1" '
                         'origBoundary="0,0,1,1" projParameter="+proj=utm +zone=32 +ellps=WGS84 +datum=WGS84 '
                         '+units=m +no_defs"/></net>')
        call("export", self.db, "--as", "geojson", "--network", earth, "--output", self.work / "earth.json")
        for site, flat in zip(json.loads((self.work / "earth.json").read_text())["features"], found["features"]):
            x, y = flat["geometry"]["coordinates"]
            longitude, latitude = site["geometry"]["coordinates"]
            self.assertAlmostEqual(longitude, self.utm(x + 683542.41, y + 4928877.56)[0], 7)
            self.assertAlmostEqual(latitude, self.utm(x + 683542.41, y + 4928877.56)[1], 7)
        self.assertIn("tells no projection", call("export", self.db, "--as", "geojson", "--network", network,
                                                  "--output", self.work / "no.json", code=2).stderr)

    @staticmethod
    def utm(east, north):
        """Longitude and latitude, degrees, of zone 32: Krueger's series to the fourth order."""
        a, f, k0, n0 = 6378137.0, 1 / 298.257223563, 0.9996, 0.0
        n = f / (2 - f)
        rectifying = a / (1 + n) * (1 + n**2 / 4 + n**4 / 64)
        beta = (n / 2 - 2 / 3 * n**2 + 37 / 96 * n**3, n**2 / 48 + n**3 / 15, 17 / 480 * n**3)
        delta = (2 * n - 2 / 3 * n**2 - 2 * n**3, 7 / 3 * n**2 - 8 / 5 * n**3, 56 / 15 * n**3)
        xi, eta = (north - n0) / (k0 * rectifying), (east - 500000.0) / (k0 * rectifying)
        xi_, eta_ = xi, eta
        for j, b in enumerate(beta, 1):
            xi_ -= b * math.sin(2 * j * xi) * math.cosh(2 * j * eta)
            eta_ -= b * math.cos(2 * j * xi) * math.sinh(2 * j * eta)
        chi = math.asin(math.sin(xi_) / math.cosh(eta_))
        latitude = chi + sum(d * math.sin(2 * j * chi) for j, d in enumerate(delta, 1))
        return 9.0 + math.degrees(math.atan2(math.sinh(eta_), math.cos(xi_))), math.degrees(latitude)

    def test_selections(self):
        def ids(*words):
            place = self.work / "selected.add.xml"
            call("export", self.db, "--as", "sumo-poi", "--output", place, *words)
            return [int(poi.get("id")[6:]) for poi in ElementTree.parse(place).getroot()]
        every = sorted({row["crash_id"] for row in self.rows})
        self.assertEqual(ids(), every)
        self.assertEqual(ids("--crash", every[1]), [every[1]])
        strong = sorted({row["crash_id"] for row in self.rows if (row["olc_g"] or 0) > 19})
        self.assertEqual(ids("--where", "olc_g > 19"), strong)
        self.assertEqual(ids("--where", "olc_g > 19 -- and no more"), strong)
        for wrong in ("olc_g >", "1); DELETE FROM crash; --", "no_such_column = 1"):
            call("export", self.db, "--as", "sumo-poi", "--output", self.work / "x.xml", "--where", wrong, code=2)
        self.assertIn("has no such crash", call("export", self.db, "--as", "csv", "--output", self.work / "x",
                                                "--where", "olc_g > 1000", code=2).stderr)
        self.assertIn("has no variant 'aeb'", call("export", self.db, "--as", "csv", "--treatment", "aeb",
                                                   "--output", self.work / "x", code=2).stderr)
        self.assertIn("has no scenario 'x'", call("export", self.db, "--as", "csv", "--scenario", "x",
                                                  "--output", self.work / "x", code=2).stderr)
        self.assertFalse((self.work / "x").exists() or (self.work / "x.xml").exists())
        self.assertEqual(sqlite3.connect(self.db).execute("SELECT count(*) FROM crash").fetchone(), (4,))

    def test_outputs_replace_nothing_that_is_read(self):
        before = self.db.read_bytes()
        for form in ("csv", "sumo-poi", "iso-mme", "lsdyna"):
            for target in (self.db, f"{self.db}-wal", self.work):
                call("export", self.db, "--as", form, "--output", target, code=2)
        link = self.work / "link"
        link.symlink_to(self.work / "list.csv")
        call("export", self.db, "--as", "csv", "--output", link, code=2)
        (self.work / "full").mkdir()
        self.assertIn("is a folder", call("export", self.db, "--as", "iso-mme", "--output", self.work / "full", code=2).stderr)
        self.assertIn("is there already", call("export", self.db, "--as", "iso-mme", "--output",
                                               self.work / "list.csv", code=2).stderr)
        self.assertEqual(self.db.read_bytes(), before)
        self.assertEqual((self.work / "list.csv").read_text(), LIST)
        self.assertEqual([path.name for path in self.work.iterdir() if ".part" in path.name], [])

    def test_names_lead_nowhere(self):
        """Names of a strange database are text: no path, no markup, no line of a file."""
        strange = self.work / "strange.db"
        strange.write_bytes(self.db.read_bytes())
        evil = "../../../evil\n*END <&\"'>\x1b[2J"
        connection = sqlite3.connect(strange)
        connection.execute("PRAGMA foreign_keys=OFF")
        connection.execute("UPDATE scenario SET name = ?", (evil,))
        connection.execute("UPDATE crash_vehicle SET sumo_id = ?", (evil,))
        connection.execute("UPDATE vehicle_model SET name = ? WHERE name = 'van'", (evil,))
        connection.execute("UPDATE crash_vehicle SET vehicle_model = ? WHERE vehicle_model = 'van'", (evil,))
        connection.commit()
        connection.close()
        inside = self.work / "inside"
        inside.mkdir()
        for form, name in (("iso-mme", "m"), ("lsdyna", "l"), ("sumo-poi", "p.xml"), ("csv", "c.csv")):
            call("export", strange, "--as", form, "--output", inside / name)
        call("export", strange, "--as", "geojson", "--plane", "--output", inside / "g.json")
        self.assertEqual(sorted(path.name for path in inside.iterdir()), ["c.csv", "g.json", "l", "m", "p.xml"])
        for path in inside.rglob("*"):
            self.assertNotIn("evil", path.name)
            if path.is_file():
                self.assertNotIn(b"\x1b", path.read_bytes(), path)
        self.assertTrue(ElementTree.parse(inside / "p.xml").getroot()[0])
        json.loads((inside / "g.json").read_text())
        crash = self.rows[0]["crash_id"]
        self.same(self.rows[0], figures(inside / "l" / f"crash_{crash}.k"), "strange names")
        self.same(self.rows[0], figures(inside / "m" / f"crash_{crash}"), "strange names")

    def test_parquet_is_a_line_away(self):
        said = call("export", self.db, "--as", "parquet", "--output", self.work / "p", code=2).stderr
        line = next(line.strip() for line in said.splitlines() if "python3 -c" in line)
        try:
            import pyarrow.parquet
        except ImportError:
            self.skipTest("pyarrow is not there: the line was not run")
        call("export", self.db, "--as", "csv", "--output", "pulses.csv", cwd=self.work)
        subprocess.run(line, shell=True, check=True, cwd=self.work)
        table = pyarrow.parquet.read_table(self.work / "pulses.parquet")
        self.assertEqual(set(table.column("crash_id").to_pylist()), {row["crash_id"] for row in self.rows})


class Pulses(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.work = pathlib.Path(self.folder.name)
        call("crash", "--pulse", self.work / "whole.csv", "--raw", "--speed", "56",
             pathlib.Path(ARGS.source) / "db" / "vehicles" / "mid_size.yaml")
        with open(self.work / "whole.csv", encoding="ascii", newline="") as file:
            self.rows = list(csv.DictReader(file))

    def tearDown(self):
        self.folder.cleanup()

    def write(self, rows, columns="time_s,ax_m_s2,vx_m_s", sign=",", begin="", end="\n"):
        names = columns.split(",")
        path = self.work / "pulse.csv"
        path.write_bytes((begin + end.join([sign.join(names)] + [sign.join(row[name] for name in names)
                                                                 for row in rows]) + end).encode())
        return path

    def test_against_the_simulation(self):
        told = json.loads(call("crash", pathlib.Path(ARGS.source) / "db" / "vehicles" / "mid_size.yaml",
                               "--speed", "56", "--format", "json").stdout)["vehicles"][0]
        found = figures(self.work / "whole.csv")
        for name in ("olc_g", "olc_t1_ms", "olc_t2_ms", "peak_g", "mean_g", "max_50ms_g", "asi_1", "t_v0_ms"):
            self.assertAlmostEqual(found[name], told[name], delta=1e-3 * max(1.0, abs(told[name])), msg=name)

    def test_a_record_that_ends_early_has_no_olc(self):
        whole = figures(self.write(self.rows))
        for end_s in (0.04, 0.06, 0.08):
            cut = [row for row in self.rows if float(row["time_s"]) <= end_s]
            done = call("pulse", self.write(cut), "--format", "json")
            found = json.loads(done.stdout)
            self.assertEqual((found["olc_status"], found["olc_g"]), ("record_ends_early", None), end_s)
            self.assertIn("before its OLC is decided", done.stderr)
            self.assertLess(found["delta_v_km_h"], whole["delta_v_km_h"])
        found = figures(self.write([row for row in self.rows if float(row["time_s"]) <= 0.06]))
        self.assertFalse(found["delta_v_final"])
        cut = [row for row in self.rows if 1e3 * float(row["time_s"]) <= whole["olc_t2_ms"] + 1]
        self.assertAlmostEqual(figures(self.write(cut))["olc_g"], whole["olc_g"], 6)

    def test_forms_of_tables(self):
        whole = figures(self.write(self.rows))
        for form in (dict(begin="\ufeff"), dict(end="\r\n"), dict(sign=";"), dict(sign=";", begin="\ufeff", end="\r\n")):
            found = figures(self.write(self.rows, **form))
            self.assertEqual(found["olc_g"], whole["olc_g"], form)
        # Either of the two channels will do, the speed said where the velocity is not.
        found = figures(self.write(self.rows, "time_s,vx_m_s"))
        self.assertAlmostEqual(found["olc_g"], whole["olc_g"], 6)
        self.assertIn("no speed at first contact", call("pulse", self.write(self.rows, "time_s,ax_m_s2"), code=2).stderr)
        found = figures(self.write(self.rows, "time_s,ax_m_s2"), "--speed", "56")
        self.assertAlmostEqual(found["olc_g"], whole["olc_g"], delta=0.01)
        # Samples before the contact.
        before = [dict(self.rows[0], time_s=f"{-k * float(self.rows[1]['time_s']):.10g}") for k in range(20, 0, -1)]
        self.assertAlmostEqual(figures(self.write(before + self.rows))["olc_g"], whole["olc_g"], 9)

    def test_what_is_wrong_is_said(self):
        decimal = [dict(row, vx_m_s=row["vx_m_s"].replace(".", ",")) for row in self.rows]
        self.assertIn(":2: vx_m_s must be a number, found '15,",
                      call("pulse", self.write(decimal, sign=";"), code=2).stderr)
        self.assertIn("must have a field for each of the 3 columns",
                      call("pulse", self.write(decimal), code=2).stderr)
        fast = [dict(row, vx_m_s=str(3.6 * float(row["vx_m_s"]))) for row in self.rows]
        self.assertIn("do not go together (unit, polarity", call("pulse", self.write(fast), code=2).stderr)
        turned = [dict(row, ax_m_s2=str(-float(row["ax_m_s2"]))) for row in self.rows]
        self.assertIn("do not go together", call("pulse", self.write(turned), code=2).stderr)
        words = ("--speed", "56")
        self.assertIn("reversed polarity?", call("pulse", self.write(turned, "time_s,ax_m_s2"), *words, code=2).stderr)
        self.assertIn("neither an .EV5 nor an .mme file", call("pulse", self.work, code=2).stderr)
        two = [dict(row, crash_id=number) for number in ("1", "2") for row in self.rows[:5]]
        self.assertIn("holds more than one crash",
                      call("pulse", self.write(two, "crash_id,time_s,ax_m_s2,vx_m_s"), code=2).stderr)

    @unittest.skipUnless(TEST.is_dir(), f"{TEST} is not there (NHTSA test 10146)")
    def test_the_real_one(self):
        found = figures(TEST)
        self.assertEqual(found["source"], "v10146.EV5, channels 93 and 94")
        self.assertAlmostEqual(found["olc_g"], 29.41, delta=0.01)
        self.assertAlmostEqual(found["t_v0_ms"], 74.0, delta=0.1)
        self.assertAlmostEqual(found["peak_g"], 40.9, delta=0.1)
        self.assertAlmostEqual(found["travel_mm"], 746, delta=1)
        self.assertAlmostEqual(found["delta_v_km_h"], 66.5, delta=0.1)
        self.assertAlmostEqual(found["delta_v_at_ms"], 113, delta=1)
        for curve, olc in ((93, 29.25), (94, 29.57), (99, 30.15), (100, 29.49)):
            self.assertAlmostEqual(figures(TEST, "--channels", curve)["olc_g"], olc, delta=0.01)
        self.assertIn("DRIVER HEAD X", call("pulse", TEST, "--channels", "1", code=2).stderr)
        for form, name in (("csv", "t.csv"), ("lsdyna", "t.k"), ("iso-mme", "t")):
            call("export", TEST, "--as", form, "--output", self.work / name)
            again = figures(self.work / name / "pulse" if form == "iso-mme" else self.work / name)
            self.assertAlmostEqual(again["olc_g"], found["olc_g"], delta=0.001)
            self.assertAlmostEqual(again["delta_v_km_h"], found["delta_v_km_h"], delta=0.001)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]])
