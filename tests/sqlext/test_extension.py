# SPDX-License-Identifier: GPL-3.0-or-later
"""The SQL extension in Python's sqlite3 and in the stock shell, on the database of a real small
study: every function against what the study stored, flags, wrong arguments, hostile blobs."""
import argparse
import os
import pathlib
import random
import shutil
import sqlite3
import statistics
import subprocess
import sys
import tempfile

STUDY = """study: extension
design: paired_seeds
seed: 5
replications: 2
duration_s: 40
scenarios:
  - name: crossing
    sumocfg: net/crossing.sumocfg
    driver_errors:
      - {model: failed_to_see, parameters: {probability_1: 1}}
variants:
  - name: baseline
  - {name: aeb, functions: [{function: aeb}]}
vehicles:
  default: car.yaml
  types: [{type: van, model: car.yaml}]
"""

parser = argparse.ArgumentParser()
parser.add_argument("--crashpulse", required=True)
parser.add_argument("--extension", required=True)
parser.add_argument("--network", required=True)
parser.add_argument("--db", help="ask this database; the second half of the test")
arguments = parser.parse_args()


def one(db, sql, *parameters):
    return db.execute(sql, parameters).fetchone()


def error_of(db, sql, *parameters):
    try:
        db.execute(sql, parameters).fetchall()
    except sqlite3.Error as error:
        return str(error)
    raise AssertionError(f"no error from {sql}")


def check_pulses(db):
    # What the stored pulses say is what was stored of the unrounded ones, but for the rounding.
    rows = db.execute(
        "SELECT v.olc_g, olc(p.samples), v.olc_status, olc_status(p.samples), v.delta_v_m_s, "
        "delta_v(p.samples, c.separation_s), delta_v(p.samples), v.peak_g, peak(p.samples), "
        "v.frontal FROM crash_vehicle AS v JOIN crash AS c ON c.id = v.crash_id "
        "JOIN pulse AS p USING (crash_id, role)").fetchall()
    assert len(rows) >= 10, len(rows)
    for olc, again, status, status_again, dv, dv_again, dv_largest, peak, peak_again, front in rows:
        if front:
            assert status == status_again, (status, status_again)
            assert (olc is None) == (again is None)
            assert olc is None or abs(olc - again) < 0.01 + 0.001 * olc, (olc, again)
        # Stored is that of the whole car, the pulse's that of its passenger cell, whose front still
        # swings when the cars part.
        assert dv_largest >= dv_again - 1e-9, (dv_largest, dv_again)
        assert abs(dv - dv_largest) < 0.3 + 0.1 * dv, (dv, dv_largest)
        assert abs(peak - peak_again) < 0.02 + 0.02 * peak, (peak, peak_again)

    crash, role, count, interval = one(
        db, "SELECT crash_id, role, sample_count, sample_interval_s FROM pulse LIMIT 1")
    samples = db.execute("SELECT * FROM pulse_samples(?, ?)", (crash, role)).fetchall()
    assert len(samples) == count and len(samples[0]) == 11
    assert samples[7][0] == 7 and abs(samples[7][1] - 7 * interval) < 1e-12
    by_blob = db.execute("SELECT s.* FROM pulse AS p, pulse_samples(p.samples) AS s WHERE "
                         "p.crash_id = ? AND p.role = ?", (crash, role)).fetchall()
    assert by_blob == samples
    # Descending order too, a join, an unknown crash, a NULL.
    backwards = db.execute("SELECT sample FROM pulse_samples(?, ?) ORDER BY sample DESC",
                           (crash, role)).fetchall()
    assert [row[0] for row in backwards] == list(range(count - 1, -1, -1))
    total = one(db, "SELECT count(*) FROM crash AS c, pulse_samples(c.id, 'a')")[0]
    assert total == one(db, "SELECT sum(sample_count) FROM pulse WHERE role = 'a'")[0]
    assert one(db, "SELECT count(*) FROM pulse_samples(-5, 'a')") == (0,)
    assert one(db, "SELECT count(*) FROM pulse_samples(NULL)") == (0,)
    assert one(db, "SELECT olc(NULL), delta_v(NULL), cfc(NULL, 60), peak(NULL)") == (None,) * 4

    # The filter smooths the sharpest of them, and what it gives is a pulse again.
    crash, role = one(db, "SELECT p.crash_id, p.role FROM pulse AS p, pulse_samples(p.samples) AS s GROUP "
                      "BY 1, 2 ORDER BY max(s.ax_m_s2) - min(s.ax_m_s2) DESC, 1, 2 LIMIT 1")
    raw, smooth = one(db, "SELECT max(s.ax_m_s2) - min(s.ax_m_s2), (SELECT max(ax_m_s2) - "
                      "min(ax_m_s2) FROM pulse_samples(cfc(p.samples, 20))) FROM pulse AS p, "
                      "pulse_samples(p.samples) AS s WHERE p.crash_id = ? AND p.role = ?",
                      crash, role)
    assert 0 < smooth < raw, (raw, smooth)
    # The pulse's four columns together do as well.
    assert one(db, "SELECT count(*) FROM pulse WHERE olc(samples) IS NOT olc(samples, codec, "
               "sample_interval_s, sample_count)") == (0,)


def check_aggregates(db):
    generator = random.Random(4)
    numbers = [round(generator.gauss(20, 6), 2) for _ in range(301)]
    groups = [generator.random() < 0.4 for _ in numbers]
    db.execute("CREATE TEMP TABLE x (place INTEGER PRIMARY KEY, v, treated, low)")
    db.executemany("INSERT INTO x (v, treated, low) VALUES (?, ?, ?)",
                   [(v, g, v < 12) for v, g in zip(numbers, groups)])
    found = one(db, "SELECT median(v), quantile(v, 0.25), quantile(v, 0), quantile(v, 1) FROM x")
    quartile = statistics.quantiles(numbers, n=4, method="inclusive")[0]
    assert abs(found[0] - statistics.median(numbers)) < 1e-12
    assert abs(found[1] - quartile) < 1e-12
    assert found[2:] == (min(numbers), max(numbers))

    a = [v for v, g in zip(numbers, groups) if not g]
    b = [v for v, g in zip(numbers, groups) if g]
    delta = sum((y > x) - (y < x) for x in a for y in b) / len(a) / len(b)
    ks = max(abs(sum(x <= v for x in a) / len(a) - sum(y <= v for y in b) / len(b))
             for v in numbers)
    found = one(db, "SELECT cliffs_delta(v, treated), ks_distance(v, treated) FROM x")
    assert abs(found[0] - delta) < 1e-12 and abs(found[1] - ks) < 1e-12, (found, delta, ks)

    # Censored observations lie below every value: the same as a number below all.
    censored = one(db, "SELECT median(v, low), quantile(v, 0.75, low), cliffs_delta(v, treated, "
                   "low), ks_distance(v, treated, low), quantile(v, 0.01, low) FROM x")
    lowest = one(db, "SELECT median(w), quantile(w, 0.75), cliffs_delta(w, treated), "
                 "ks_distance(w, treated) FROM (SELECT iif(low, -1.0, v) AS w, treated FROM x)")
    assert censored[:4] == lowest and censored[4] is None, (censored, lowest)
    assert one(db, "SELECT median(NULL, 1) FROM x") == (None,)

    # NULL does not count; nothing gives NULL.
    assert one(db, "SELECT median(v) FROM x WHERE 0") == (None,)
    assert one(db, "SELECT cliffs_delta(v, 1) FROM x") == (None,)
    assert one(db, "SELECT median(iif(place > 100, NULL, v)) FROM x")[0] == \
        statistics.median_low(numbers[:100]) / 2 + statistics.median_high(numbers[:100]) / 2

    # As window functions, with rows that leave.
    rows = db.execute("SELECT v, median(v) OVER w, quantile(v, 0.9) OVER w FROM x WINDOW w AS "
                      "(ORDER BY place ROWS BETWEEN 7 PRECEDING AND 3 FOLLOWING)").fetchall()
    for k, (_, middle, high) in enumerate(rows):
        frame = numbers[max(0, k - 7):k + 4]
        assert abs(middle - statistics.median(frame)) < 1e-12, (k, middle)
        place = 0.9 * (len(frame) - 1)
        low = int(place)
        ordered = sorted(frame) + [0]
        wanted = ordered[low] + (place - low) * (ordered[low + 1] - ordered[low])
        assert abs(high - (wanted if place > low else ordered[low])) < 1e-9, (k, high, wanted)
    partition = db.execute("SELECT DISTINCT treated, median(v) OVER (PARTITION BY treated) FROM x "
                           "ORDER BY 1").fetchall()
    assert partition == [(0, statistics.median(a)), (1, statistics.median(b))]


def check_flags(db):
    rows = {}
    for name, _, kind, _, count, flags in db.execute("PRAGMA function_list"):
        rows[name, count] = (kind, flags)
    deterministic, innocuous = 0x800, 0x200000
    for name, count, kind in (("olc", 1, "s"), ("olc_status", 1, "s"), ("delta_v", 1, "s"),
                              ("delta_v", 2, "s"), ("peak", 1, "s"), ("cfc", 2, "s"),
                              ("median", 1, "w"), ("median", 2, "w"), ("quantile", 2, "w"),
                              ("quantile", 3, "w"), ("cliffs_delta", 2, "a"),
                              ("ks_distance", 3, "a")):
        assert rows[name, count][0] == kind, (name, rows[name, count])
        assert rows[name, count][1] & deterministic and rows[name, count][1] & innocuous, name
    # So an index may use them, and a view with nothing trusted.
    db.execute("PRAGMA trusted_schema = OFF")
    db.execute("CREATE TEMP TABLE y (samples)")
    db.execute("CREATE INDEX temp.by_olc ON y (olc(samples))")
    db.execute("CREATE TEMP VIEW z AS SELECT median(olc_g) AS m FROM frontal_vehicle")
    db.execute("CREATE TEMP VIEW s AS SELECT s.* FROM pulse AS p, pulse_samples(p.samples) AS s")
    assert one(db, "SELECT m FROM z")[0] > 0 and one(db, "SELECT count(*) FROM s")[0] > 1000


def check_errors(db):
    for sql, words in (
            ("SELECT olc('text')", "olc: the first argument must be a pulse"),
            ("SELECT olc(12)", "olc: the first argument must be a pulse"),
            ("SELECT olc(x'')", "olc: pulse: damaged"),
            ("SELECT olc(x'28b52ffd2000')", "does not begin like a pulse of codec 2"),
            ("SELECT olc(zeroblob(100000))", "olc: pulse: damaged"),
            ("SELECT delta_v(samples, 'soon') FROM pulse", "delta_v: separation_s must be"),
            ("SELECT cfc(samples, -3) FROM pulse", "cfc: the class must be a number"),
            ("SELECT cfc(samples, 'CFC60') FROM pulse", "cfc: the class must be a number"),
            ("SELECT cfc(samples, 600) FROM pulse", "CFC"),
            ("SELECT * FROM pulse_samples", "pulse_samples: needs arguments"),
            ("SELECT * FROM pulse_samples(5)", "a single argument must be a pulse"),
            ("SELECT * FROM pulse_samples(x'c2ff')", "pulse_samples: pulse: damaged"),
            ("SELECT median('a')", "median: x must be a number"),
            ("SELECT quantile(1, 1.5)", "quantile: p must be a number from 0 to 1"),
            ("SELECT quantile(1, 'half')", "quantile: p must be a number from 0 to 1"),
            ("SELECT quantile(v, place / 400.0) FROM x", "p must be the same for all rows"),
            ("SELECT olc(samples, 1, 0.001, 100) FROM pulse", "pulse: damaged"),
            ("SELECT olc(samples, 'two', 0.001, 100) FROM pulse", "arguments must be samples"),
            ("SELECT median(1, 2, 3)", "wrong number of arguments"),
            ("CREATE VIRTUAL TABLE v USING pulse_samples", "no such module")):
        found = error_of(db, sql)
        assert words in found, (sql, found)


def check_hostile_blobs(db):
    # Bytes changed, cut, appended: a value or an error, and the connection lives on.
    blob = one(db, "SELECT samples FROM pulse ORDER BY length(samples) LIMIT 1")[0]
    generator = random.Random(1)
    refused = 0
    for _ in range(500):
        bytes_ = bytearray(blob)
        for _ in range(generator.choice((1, 1, 2, 8))):
            bytes_[generator.randrange(min(len(bytes_), generator.choice((4, 16, 10000))))] = \
                generator.randrange(256)
        if generator.random() < 0.3:
            bytes_ = bytes_[:generator.randrange(len(bytes_))]
        if generator.random() < 0.1:
            bytes_ += generator.randbytes(20)
        for sql in ("SELECT olc(?1), olc_status(?1), delta_v(?1), peak(?1)", "SELECT cfc(?1, 60)",
                    "SELECT sum(vx_m_s) FROM pulse_samples(?1)"):
            try:
                db.execute(sql, (bytes(bytes_),)).fetchall()
            except sqlite3.Error as error:
                assert "pulse" in str(error) or "cfc" in str(error), error
                refused += 1
    assert refused > 50, refused
    assert one(db, "SELECT olc_status(?)", blob)[0] in ("value", "no_deceleration", "beyond_0_5_s")


def check_loading(path):
    # Again, by a statement that is running, as R does it: the same functions, no error.
    db = sqlite3.connect(path)
    db.enable_load_extension(True)
    for _ in range(2):
        assert one(db, "SELECT load_extension(?)", arguments.extension) == (None,)
    rows = db.execute("SELECT olc_g, olc_g > 12 FROM frontal_vehicle").fetchall()
    assert len(rows) > 5
    for short in ("median(olc_g)", "median(olc_g, censored)", "quantile(olc_g, 0.9)",
                  "quantile(olc_g, 0.9, censored)", "cliffs_delta(olc_g, variant = 'aeb')",
                  "ks_distance(olc_g, variant = 'aeb', censored)"):
        found = one(db, f"SELECT {short}, cp_{short} FROM frontal_vehicle")
        assert found[0] == found[1], (short, found)
    assert one(db, "SELECT count(*) FROM pulse WHERE olc(samples) IS NOT cp_olc(samples) OR "
                   "olc_status(samples) <> cp_olc_status(samples) OR "
                   "delta_v(samples) <> cp_delta_v(samples) OR peak(samples) <> cp_peak(samples) OR "
                   "cfc(samples, 60) <> cp_cfc(samples, 60)") == (0,)
    assert one(db, "SELECT (SELECT count(*) FROM pulse_samples(p.crash_id, p.role)) = "
                   "(SELECT count(*) FROM cp_pulse_samples(p.crash_id, p.role)) FROM pulse AS p") == (1,)
    assert "cp_median" not in error_of(db, "SELECT cp_median('a')")

    # A connection with a median of its own keeps it, and has ours under its other name.
    class Own:
        def step(self, _):
            pass

        def finalize(self):
            return -1

    db = sqlite3.connect(path)
    db.create_aggregate("median", 1, Own)
    db.enable_load_extension(True)
    assert one(db, "SELECT load_extension(?)", arguments.extension) == (None,)
    values = sorted(row[0] for row in db.execute("SELECT olc_g FROM frontal_vehicle WHERE olc_g > 0"))
    assert one(db, "SELECT median(olc_g), cp_median(olc_g) FROM frontal_vehicle WHERE olc_g > 0") == \
        (-1, statistics.median(values))


if arguments.db:
    check_loading(arguments.db)
    connection = sqlite3.connect(arguments.db)
    connection.enable_load_extension(True)
    connection.load_extension(arguments.extension)
    check_pulses(connection)
    check_aggregates(connection)
    check_errors(connection)
    check_hostile_blobs(connection)
    check_flags(connection)
    sys.exit(0)

with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    shutil.copytree(arguments.network, folder / "net")
    (folder / "study.yaml").write_text(STUDY)
    (folder / "car.yaml").write_text("vehicle: car\nparameters: []\n")
    study = folder / "study.db"
    subprocess.run([arguments.crashpulse, "run", folder / "study.yaml", "--db", study], check=True,
                   capture_output=True)
    environment = dict(os.environ)
    if environment.get("CRASHPULSE_PRELOAD"):
        environment["LD_PRELOAD"] = environment["CRASHPULSE_PRELOAD"]
        environment["ASAN_OPTIONS"] = "detect_leaks=0"
    subprocess.run([sys.executable, *sys.argv, "--db", str(study)], check=True, env=environment)
    # The stock shell finds it by the name of the file alone.
    load = f".load {arguments.extension.removesuffix('.so')}"
    query = "SELECT median(olc_g) > 0, (SELECT count(*) > 9 FROM pulse_samples(crash_id, 'a')) " \
            "FROM frontal_vehicle"
    shell = subprocess.run(["sqlite3", "-batch", "-cmd", load, study, query], capture_output=True,
                           text=True, env=environment)
    assert shell.stdout == "1|1\n", shell
