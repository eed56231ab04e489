# SPDX-License-Identifier: GPL-3.0-or-later
"""What SUMO is given: every file that it opens is in the scenario's fingerprint (traced with strace),
a change of any of them is refused, and options that would break pairing, keep a worker waiting or
hide output are replaced, refused or told."""
import argparse
import gzip
import json
import os
import pathlib
import re
import shutil
import socket
import sqlite3
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "builders"))
import crossing_study

parser = argparse.ArgumentParser()
parser.add_argument("--crashpulse", required=True)
parser.add_argument("--network", required=True)
arguments = parser.parse_args()
arguments.crashpulse = str(pathlib.Path(arguments.crashpulse).resolve())

STUDY = """study: inputs
design: paired_seeds
seed: 1
replications: {replications}
duration_s: {duration_s}
step_length_s: 0.1
scenarios:
  - name: crossing
    sumocfg: {sumocfg}
    sumo_options: [{options}]
variants: [{{name: baseline}}, {{name: again}}]
background: {{duration_s: 0}}
"""
CONFIGURATION = """<?xml version="1.0"?>
<!-- <route-files value="of a comment.xml"/> -->
<configuration>{}</configuration>
"""


def run(*words, **more):
    return crossing_study.run(arguments.crashpulse, *words, **more)


def write_study(folder, configuration, options="", name="x.sumocfg", replications=1, duration_s=5):
    (folder / name).write_text(CONFIGURATION.format(configuration))
    study = folder / "study.yaml"
    study.write_text(STUDY.format(sumocfg=name, options=options, replications=replications,
                                  duration_s=duration_s))
    return study


def files_of(db):
    return json.loads(sqlite3.connect(db).execute("SELECT files FROM scenario").fetchone()[0])


# ---- the fingerprint -----------------------------------------------------------------------

# Every way to name a file that SUMO 1.15 takes: attributes with blanks, text, an entity, blanks in
# names, %20, environment, lists, folders, files that files include, compressed ones, sumo_options.
INPUTS = """
<input>
  <net-file value = 'net one.net.xml'/>
  <route-files>more/a.rou.xml , more/b%20c.rou.xml,d.rou.xml.gz</route-files>
  <a v="signs&#46;add.xml,${CRASHPULSE_TEST_NAME}.add.xml"/>
</input>"""


def write_inputs(folder):
    routes = (pathlib.Path(arguments.network) / "crossing.rou.xml").read_text()
    types = "".join(re.findall(r"<vType.*?(?:/>|</vType>)", routes, re.S))
    rest = re.sub(r"<vType.*?(?:/>|</vType>)", "", routes, flags=re.S)
    shutil.copy(pathlib.Path(arguments.network) / "crossing.net.xml", folder / "net one.net.xml")
    (folder / "more" / "deep").mkdir(parents=True)
    (folder / "more" / "a.rou.xml").write_text('<routes><include href="deep/types.xml"/></routes>')
    (folder / "more" / "deep" / "types.xml").write_text(f"<routes>{types}</routes>")
    (folder / "more" / "b c.rou.xml").write_text(rest)
    with gzip.open(folder / "d.rou.xml.gz", "wt") as packed:
        packed.write('<routes><include href="more/packed.xml"/></routes>')
    (folder / "more" / "packed.xml").write_text("<routes/>")
    lane = re.search(r'<lane id="(west_in_0)"', (folder / "net one.net.xml").read_text()).group(1)
    (folder / "signs.add.xml").write_text(
        f'<additional><variableSpeedSign id="s" lanes="{lane}" file="speeds.xml"/>'
        f'<laneData id="out" file="written.xml" freq="2"/></additional>')
    (folder / "speeds.xml").write_text('<vss><step time="1" speed="10"/></vss>')
    (folder / "of_environment.add.xml").write_text("<additional/>")
    (folder / "edges.txt").write_text("edge:west_in\n")


def opened_by_sumo(folder, study, db):
    """Files below folder that a run opens only to read, but for the study and its database."""
    trace = folder.parent / "trace"
    # The leak checker does not work in a traced process; other tests look for leaks.
    options = os.environ.get("ASAN_OPTIONS", "")
    environment = {**os.environ, "ASAN_OPTIONS": f"{options}:detect_leaks=0".lstrip(":")}
    subprocess.run(["strace", "-f", "-qq", "-e", "trace=open,openat", "-o", trace,
                    arguments.crashpulse, "run", study, "--db", db, "--jobs", "1"], check=True,
                   capture_output=True, cwd=folder, env=environment)
    found = set()
    for line in trace.read_text(errors="replace").splitlines():
        match = re.search(r'open(?:at)?\((?:AT_FDCWD, )?"([^"]*)", ([A-Z_|]*).*= \d+$', line)
        if match and not re.search("O_WRONLY|O_RDWR|O_DIRECTORY", match.group(2)):
            path = (folder / match.group(1)).resolve()
            if folder.resolve() in path.parents and path.is_file():
                found.add(str(path.relative_to(folder.resolve())))
    return found - {study.name}


def test_fingerprint(folder):
    write_inputs(folder)
    study = write_study(folder, INPUTS, "--fcd-output, f.xml, --fcd-output.filter-edges.input-file, "
                                        "edges.txt")
    db = folder.parent / "inputs.db"
    expected = {"x.sumocfg", "net one.net.xml", "more/a.rou.xml", "more/b c.rou.xml",
                "more/deep/types.xml", "d.rou.xml.gz", "more/packed.xml", "signs.add.xml",
                "speeds.xml", "of_environment.add.xml", "sumo_options: edges.txt"}
    first = subprocess.run([arguments.crashpulse, "run", study, "--db", db], cwd=folder, text=True,
                           capture_output=True)
    assert first.returncode == 0, first.stderr
    assert set(files_of(db)) == expected, set(files_of(db)) ^ expected
    named = {name.replace("sumo_options: ", "") for name in files_of(db)}
    if shutil.which("strace"):
        opened = opened_by_sumo(folder, study, folder.parent / "traced.db")
        assert opened == named, opened ^ named
        print("strace: every file that SUMO opens is in the fingerprint")
    else:
        print("SKIPPED: strace is missing, what SUMO opens was not traced")

    # The same again is done; a change of any one file is refused by its name, by plan too.
    assert "2 done before" in subprocess.run(
        [arguments.crashpulse, "run", study, "--db", db], check=True, cwd=folder, text=True,
        capture_output=True).stderr
    for name in sorted(named):
        path = folder / name
        kept = path.read_bytes()
        if name.endswith(".gz"):
            path.write_bytes(gzip.compress(gzip.decompress(kept) + b"<!-- x -->"))
        else:
            path.write_bytes(kept.replace(b"</configuration>", b"<time/></configuration>")
                             if name == "x.sumocfg" else kept + b"\n")
        for command in ("plan", "run"):
            result = subprocess.run([arguments.crashpulse, command, study, "--db", db], cwd=folder,
                                    text=True, capture_output=True)
            assert result.returncode == 2, f"{command} with changed {name}: {result}"
            assert name in result.stderr, f"{command} does not name {name}: {result.stderr}"
        path.write_bytes(kept)


# ---- options -------------------------------------------------------------------------------

PLAIN = '<input><net-file value="crossing.net.xml"/><route-files value="crossing.rou.xml"/></input>'


def crashes(db):
    return sqlite3.connect(db).execute(
        "SELECT variant.name, replication.seed, crash.time_s FROM replication JOIN variant ON "
        "variant.id = variant_id LEFT JOIN crash ON replication_id = replication.id "
        "ORDER BY 2, 3, 1").fetchall()


def result_of(folder, configuration, options="", duration_s=40, replications=2, expect=0):
    study = write_study(folder, configuration, options, replications=replications,
                        duration_s=duration_s)
    db = folder.parent / "options.db"
    db.unlink(missing_ok=True)
    result = run("run", study, "--db", db, "--time-limit", "60", expect=expect)
    return crashes(db) if expect == 0 else None, result.stderr


def test_options(folder):
    for name in ("crossing.net.xml", "crossing.rou.xml"):
        shutil.copy(pathlib.Path(arguments.network) / name, folder / name)
    plain, words = result_of(folder, PLAIN)
    assert "warning: x.sumocfg" not in words and len({seed for _, seed, _ in plain}) == 2, words
    with socket.socket() as taken:  # a port that nobody else listens on is not needed
        taken.bind(("127.0.0.1", 0))
        port = taken.getsockname()[1]

    # Replaced: the same crashes as without, with a word and the line; by sumo_options too.
    for section, options, said in [
            ('<random value="true"/>', "", "x.sumocfg:3: random is set to false"),
            ("<abs-rand>1</abs-rand>", "", "x.sumocfg:3: abs-rand is set to false"),
            ("", '--random', "sumo_options: random is set to false"),
            (f'<remote-port value="{port}"/>', "", "remote-port is set to 0"),
            (f'<num-clients value="2"/><remote-port value="{port}"/>', "", "num-clients is set to 1"),
            ("", f'--remote-port, "{port}"', "sumo_options: remote-port is set to 0"),
            ("", '--remote-port, "0"', None),
            ('<no-internal-links value="true"/>', "", "no-internal-links is set to false"),
            ('<collision.stoptime value="10"/>', "", "collision.stoptime is set to 0"),
            ('<collision.action value="remove"/>', "", "collision.action is set to warn"),
            ('<ignore-accidents value="true"/>', "", "ignore-accidents is set to false"),
            ('<threads value="4"/>', "", "threads is set to 1"),
            ('<random value="false"/>', "", None)]:
        found, words = result_of(folder, PLAIN + section, options)
        assert found == plain, f"{section}{options}: {found} instead of {plain}"
        assert (said in words) if said else ("warning: x.sumocfg" not in words), words

    # Refused, with exit code 2, before there is a database.
    for section, options, said in [
            ('<mesosim value="true"/>', "", "x.sumocfg:3: mesosim must not be set"),
            ("", "--mesosim", "study.yaml:10: scenarios[0].sumo_options mesosim must not be set"),
            ('<end value="30"/>', "", "x.sumocfg:3: end must not come before the end of what is "
                                      "simulated, 40 s after the beginning, found '30', after 30 s"),
            ('<begin value="100"/><e value="0:02:00"/>', "", "found '0:02:00', after 20 s"),
            ("", '--end, "30"', "scenarios[0].sumo_options end must not come before"),
            ('<load-state value="s.xml"/>', "", "load-state must not be set"),
            ("", '--save-configuration, "s.xml"', "save-configuration must not be set"),
            ("", '--step-length, "1"', "step-length must not be set"),
            ("", '"1"', "must be options of SUMO with their values, found '1'")]:
        _, words = result_of(folder, PLAIN + section, options, expect=2)
        assert said in words and not (folder.parent / "options.db").exists(), words
    result_of(folder, PLAIN + '<end value="40"/>')

    # One of a later SUMO: told before this SUMO refuses it.
    _, words = result_of(folder, PLAIN + '<option-of-tomorrow value="1"/>', expect=None)
    assert "option-of-tomorrow is no option of SUMO 1.15" in words, words


def test_outputs(folder):
    (folder / "out").mkdir()
    before = {path.name for path in folder.rglob("*")}
    result_of(folder, PLAIN + '<output-prefix value="out/new_"/><tripinfo-output value="t.xml"/>'
              '<summary-output value="out/s.xml"/>', replications=1)
    written = {str(path.relative_to(folder)) for path in folder.rglob("*")
               if path.name not in before | {"x.sumocfg", "study.yaml"}}
    seed = sqlite3.connect(folder.parent / "options.db").execute(
        "SELECT seed FROM replication").fetchone()[0]
    assert written == {f"{place}crossing_{variant}_{seed}_new_{name}" for variant in
                       ("baseline", "again") for place, name in (("", "t.xml"), ("out/", "s.xml"))}
    # A network by itself has no name to put in front.
    run("background", folder / "x.sumocfg", "--duration", "2")
    assert (folder / "@background_1_new_t.xml").exists()
    assert not list(folder.rglob("*(null)*")) and not list(folder.rglob("*probe*"))


with tempfile.TemporaryDirectory() as name:
    os.environ["CRASHPULSE_TEST_NAME"] = "of_environment"
    for test in ("fingerprint", "options"):
        (pathlib.Path(name) / test).mkdir()
    test_fingerprint(pathlib.Path(name) / "fingerprint")
    test_options(pathlib.Path(name) / "options")
    test_outputs(pathlib.Path(name) / "options")
print("inputs and options of SUMO: as they should be")
