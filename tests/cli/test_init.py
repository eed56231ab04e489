# SPDX-License-Identifier: GPL-3.0-or-later
"""crashpulse init: the study it writes for networks it has not seen, and what it refuses. crashpulse doctor: what is
missing is named."""
import argparse
import json
import os
import pathlib
import subprocess
import tempfile

parser = argparse.ArgumentParser()
parser.add_argument("--crashpulse", required=True)
arguments = parser.parse_args()
SUMO = {**os.environ, "SUMO_HOME": "/usr/share/sumo"}


def crashpulse(*words, code=0, **options):
    done = subprocess.run([arguments.crashpulse, *map(str, words)], capture_output=True, text=True, **options)
    assert done.returncode == code, (words, done.returncode, done.stdout, done.stderr)
    return done


def make_network(folder, name, *words, configuration=""):
    """A network of netgenerate's with a flow over every edge that leads in."""
    subprocess.run(["netgenerate", *words, "--output-file", folder / f"{name}.net.xml"], check=True, env=SUMO,
                   capture_output=True)
    (folder / f"{name}.rou.xml").write_text(
        '<routes>\n<vType id="wagon" length="4.6" width="1.8"/>\n<vType id="bendy" vClass="bus"/>\n'
        '<flow id="f" type="wagon" from="A0B0" to="B1A1" begin="0" end="500" period="4"/>\n'
        '<flow id="g" type="wagon" from="B1A1" to="A0B0" begin="0" end="500" period="4"/>\n</routes>\n')
    (folder / f"{name}.sumocfg").write_text(
        f'<configuration>\n<net-file value="{name}.net.xml"/>\n<route-files value="{name}.rou.xml"/>\n{configuration}\n'
        '</configuration>\n')
    return folder / f"{name}.sumocfg"


def value(study, key):
    line, = [line for line in study.splitlines() if line.startswith(key + ":")]
    return line.split(":")[1].split("#")[0].strip()


def models(study):
    return [line.split("model: ")[1] for line in study.splitlines() if line.startswith("      - model: ")]


def check_networks(top):
    nets = top / "foreign nets" # a blank in the path
    nets.mkdir()
    grid = ["--grid", "--grid.number", "3", "--grid.length", "200"]
    signals = make_network(nets, "signals", *grid, "--default-junction-type", "traffic_light",
                           configuration='<begin value="100"/><end value="400"/><step-length value="0.05"/>')
    priority = make_network(nets, "priority", *grid, "--default-junction-type", "priority")

    # From another folder; the study names the configuration as seen from itself.
    said = crashpulse("init", "one", "--network", "foreign nets/signals.sumocfg", cwd=top).stdout
    study = (top / "one/study.yaml").read_text()
    assert 'sumocfg: "../foreign nets/signals.sumocfg"' in study, study
    assert "red_light" in models(study) and "risky_overtaking" not in models(study), models(study)
    assert value(study, "duration_s") == "300" and value(study, "step_length_s") == "0.05", study
    assert 0 < float(value(study, "warmup_s")) <= 100 and "wagon: passenger" in study and "bendy: bus" in study
    assert "crashpulse run one/study.yaml --db one/study.db" in said, said

    # No end: to the last departure and on; no lights: none to run; SUMO's step of 1 s is too long.
    crashpulse("init", top / "two", "--network", priority)
    study = (top / "two/study.yaml").read_text()
    assert value(study, "duration_s") == "800" and value(study, "step_length_s") == "0.1", study
    assert "red_light" not in models(study) and "no traffic light" in study
    assert {"failed_to_see", "misjudged_gap", "lane_drift", "late_braking"} == set(models(study)), models(study)
    plan = json.loads(crashpulse("plan", top / "two/study.yaml", "--format", "json").stdout)
    assert [row["variant"] for row in plan] == ["baseline", "aeb"], plan

    # A motorway: one direction, nobody gives way.
    (nets / "m.nod.xml").write_text('<nodes><node id="a" x="0" y="0"/><node id="b" x="900" y="0"/></nodes>')
    (nets / "m.edg.xml").write_text('<edges><edge id="ab" from="a" to="b" numLanes="2" speed="33"/></edges>')
    subprocess.run(["netconvert", "-n", nets / "m.nod.xml", "-e", nets / "m.edg.xml", "-o", nets / "m.net.xml",
                    "--xml-validation", "never"], check=True, env=SUMO, capture_output=True)
    (nets / "m.sumocfg").write_text('<configuration><net-file value="m.net.xml"/></configuration>')
    said = crashpulse("init", top / "three", "--network", nets / "m.sumocfg")
    study = (top / "three/study.yaml").read_text()
    assert models(study) == ["late_braking"] and value(study, "duration_s") == "900", study
    assert "no vehicle departs" in said.stderr and "119 km/h at most" in study, said.stderr
    return top / "one"


def check_refusals(top):
    before = (top / "one/study.yaml").read_text()
    done = crashpulse("init", top / "one", "--network", top / "foreign nets/signals.sumocfg", code=2)
    assert "is there already" in done.stderr and (top / "one/study.yaml").read_text() == before
    assert "No such file" in crashpulse("init", top / "x", "--network", top / "no.sumocfg", code=2).stderr
    (top / "empty.sumocfg").write_text("<configuration/>")
    assert "names no network" in crashpulse("init", top / "x", "--network", top / "empty.sumocfg", code=2).stderr
    assert not (top / "x/study.yaml").exists()


def check_example(top):
    crashpulse("init", "first", cwd=top)
    study = (top / "first/study.yaml").read_text()
    assert "sumocfg: left_turn.sumocfg" in study and "failed_to_see" in models(study), study
    shortened = study.replace("replications: 4", "replications: 1").replace(
        f"duration_s: {value(study, 'duration_s')}", "duration_s: 60")
    (top / "first/study.yaml").write_text(shortened.replace(f"warmup_s: {value(study, 'warmup_s')}", "warmup_s: 10"))
    crashpulse("run", "first/study.yaml", "--db", "first/study.db", "--jobs", "2", cwd=top)
    rows = json.loads(crashpulse("status", "first/study.db", "--format", "json", cwd=top).stdout)
    assert [(row["variant"], row["done"]) for row in rows] == [("baseline", 1), ("aeb", 1)], rows
    crashpulse("report", "first/study.db", "--output", "first/report.html", cwd=top)


def check_doctor(top):
    rows = {row["what"]: row for row in json.loads(crashpulse("doctor", "--format", "json", cwd=top).stdout)}
    for what in ("sumo", "worker, libsumo", "ODE, double precision", "a crash at 56 km/h", "SQL functions",
                 "example scenarios", "temporary files"):
        assert rows[what]["state"] == "ok", rows[what]
    # Without a PATH there is no SUMO: told, with what to do, and the exit code says so.
    done = crashpulse("doctor", "--format", "json", code=1, cwd=top, env={**os.environ, "PATH": str(top)})
    rows = {row["what"]: row for row in json.loads(done.stdout)}
    assert rows["sumo"]["state"] == "missing" and "apt-get install sumo" in rows["sumo"]["to_do"], rows["sumo"]
    assert rows["gnuplot"]["state"] == "warning" and rows["worker, libsumo"]["state"] == "ok"
    done = crashpulse("doctor", "--format", "json", code=1, cwd=top, env={**os.environ, "TMPDIR": "/no/such"})
    rows = {row["what"]: row for row in json.loads(done.stdout)}
    assert rows["temporary files"]["state"] == "missing", rows["temporary files"]


with tempfile.TemporaryDirectory(prefix="crashpulse-") as folder:
    top = pathlib.Path(folder)
    check_networks(top)
    check_refusals(top)
    check_example(top)
    check_doctor(top)
