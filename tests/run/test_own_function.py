# SPDX-License-Identifier: GPL-3.0-or-later
"""Functions that a study brings along: the shipped example, built by its own CMake against what is
installed, in a study and a matrix; ours built as libraries, which give the databases of the built-in ones; and
faulty ones, which fail their replications by name and nothing else."""
import argparse
import json
import pathlib
import shutil
import sqlite3
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "builders"))
import crossing_study
import own_study
from own_study import assert_same, messages

parser = argparse.ArgumentParser()
parser.add_argument("--crashpulse", required=True)
parser.add_argument("--network", required=True)
parser.add_argument("--source", required=True)
parser.add_argument("--build", required=True, help="folder that is installed from")
parser.add_argument("--libraries", required=True, help="folder of those built for this test")
arguments = parser.parse_args()
arguments.crashpulse = str(pathlib.Path(arguments.crashpulse).resolve())
libraries = pathlib.Path(arguments.libraries)
EXAMPLE = pathlib.Path(arguments.source) / "sumo_scenarios/own_function"


def study_in(folder, variants, *how, **more):
    return own_study.study_in(folder, arguments.network, variants, *how, **more)


def run(study, db, *words, expect=0):
    return own_study.run(arguments.crashpulse, study, db, *words, expect=expect)


def the_example_in_its_study(folder):
    """Built outside the tree, against a prefix with what src/api installs."""
    assert len((EXAMPLE / "my_aeb.c").read_text().splitlines()) < 100
    prefix, own = folder / "prefix", folder / "sumo_scenarios/own_function"
    subprocess.run(["cmake", "--install", pathlib.Path(arguments.build) / "src/api", "--prefix", prefix],
                   check=True, stdout=subprocess.DEVNULL)
    shutil.copytree(EXAMPLE, own, ignore=shutil.ignore_patterns("build"))
    for name in ("left_turn", "head_on_drift"):
        shutil.copytree(pathlib.Path(arguments.build) / "sumo_scenarios" / name, folder / "sumo_scenarios" / name)
    shutil.copytree(EXAMPLE.parent.parent / "db/vehicles", folder / "db/vehicles")
    subprocess.run(["cmake", "-S", own, "-B", own / "build", f"-DCMAKE_PREFIX_PATH={prefix}"],
                   check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", own / "build"], check=True, stdout=subprocess.DEVNULL)

    study, db, alone = own / "study.yaml", folder / "own.db", folder / "alone.db"
    planned = crossing_study.run(arguments.crashpulse, "plan", study)
    assert "loads code of its own: build/my_aeb.so, SHA-256 " in planned.stdout, planned.stdout
    assert "--allow-plugins" in planned.stderr, planned.stderr
    refused = crossing_study.run(arguments.crashpulse, "run", study, "--db", db, expect=2)
    assert "build/my_aeb.so" in refused.stderr and "--allow-plugins" in refused.stderr, refused.stderr
    assert not db.exists(), "a refused study made a database"
    text = study.read_text()
    study.write_text(text.replace("replications: 4", "replications: 2"))
    run(study, db, "--jobs", "4")
    run(study, alone, "--jobs", "1")
    crossing_study.assert_same(db, alone)
    outcomes = dict(sqlite3.connect(db).execute(
        "SELECT v.name, sum(c.outcome IN ('avoided', 'mitigated')) FROM counterfactual c "
        "JOIN variant v ON v.id = c.variant_id GROUP BY 1"))
    assert outcomes["my_aeb"] > 0 and outcomes["aeb"] > 0, outcomes
    acts = dict(sqlite3.connect(db).execute(
        "SELECT function, count(*) FROM counterfactual_function WHERE state = 'braking' GROUP BY 1"))
    print("outcomes", outcomes, "braking at contact", acts)

    # The same through a matrix.
    table = crossing_study.run(arguments.crashpulse, "matrix", EXAMPLE.parent / "ncap/ccfhos.yaml", "--library",
                               own / "build/my_aeb.so", "--db", folder / "matrix.db", "--format", "json").stdout
    cells = json.loads(table)
    assert len(cells) == 27 and all(c["impact_km_h"] < c["without_impact_km_h"] - 5 for c in cells), table

    # The hash of the library is part of the configuration: another one is another study.
    source = own / "my_aeb.c"
    source.write_text(source.read_text().replace('"ttc_s", 1.0', '"ttc_s", 1.1'))
    subprocess.run(["cmake", "--build", own / "build"], check=True, stdout=subprocess.DEVNULL)
    changed = run(study, db, expect=2)
    assert "library_hash" in changed.stderr or "functions" in changed.stderr, changed.stderr


def ours_as_libraries(folder):
    """Built from the same files: the same databases, to the bit."""
    def as_library(name, parameters):
        return f"{{function: plugin, library: {libraries / (name + '.so')}, parameters: {parameters}}}"

    def built_in(name, parameters):
        return f"{{function: {name}, parameters: {parameters}}}"

    wanted = [("aeb", "{ttc_s: 1.1, false_activations_per_h: 200, sensor_detection_probability_1: 0.7, "
               "penetration_1: 0.8}"),
              ("fcw", "{crossing_1: 1, turning_1: 1, compliance_1: 0.6}"), ("elk", "{}")]
    for design in ("paired_seeds", "counterfactual"):
        more = [("isa", "{tolerance_1: 0.05}")] if design == "paired_seeds" else []
        dbs = []
        for kind in (built_in, as_library):
            study = study_in(folder / "ours", {"ours": [kind(*w) for w in wanted + more]}, design,
                             duration_s=60)
            dbs.append(folder / f"{design}_{kind.__name__}.db")
            run(study, dbs[-1], "--jobs", "2")
        assert_same(*dbs)
    # What acts long before a crash is no treatment, whoever brings it along.
    study = study_in(folder / "isa", {"isa": [as_library("isa", "{}")]}, "counterfactual")
    refused = run(study, folder / "isa.db", expect=1)
    assert "isa" in refused.stderr and "acts long before a crash" in refused.stderr, refused.stderr


FAULTS = {
    "segfault": "crashed; ended by signal 11",
    "stack": "crashed; ended by signal 11",
    "endless": "does not come back (step_limit_s)",
    "not_a_number": "its request has acceleration_m_s2",
    "other_abi": "is built for version 2 of crashpulse/function.h, this crashpulse has version 1",
    "leak": "it leaks: memory has grown by more than 50 MB in its calls",
    "says_so": "has no idea what to do",
    "exits": "ended the process by exit",
    "unasked": "its request has warned_s, which is not among what it does",
}
WITHOUT_VEHICLE = ("other_abi", "leak")


def faulty(name, more=""):
    return (f"{{function: plugin, library: {libraries / ('faulty_' + name + '.so')}, "
            f"parameters: {{step_limit_s: 0.5, memory_limit_mb: 50{more}}}}}")


def faults_fail_by_name(folder):
    study = study_in(folder / "faults", {name: [faulty(name)] for name in [*FAULTS, "good"]})
    db = folder / "faults.db"
    result = run(study, db, "--jobs", "2", expect=1)
    failed, done = messages(db)
    assert done == {"baseline", "good"}, done
    for name, text in FAULTS.items():
        assert len(failed[name]) == 2, (name, failed)
        for message in failed[name]:
            assert text in message and f"faulty_{name}.so" in message, (name, message)
            assert message.startswith(f"faulty_{name}: "), message
            assert name in WITHOUT_VEHICLE or ("vehicle '" in message and " s: " in message), message
    assert f"{2 * len(FAULTS)} of {2 * len(FAULTS) + 4} replications failed" in result.stderr, result.stderr
    assert "4 done now" in result.stderr, result.stderr


def faults_in_branches(folder):
    """A treatment's function runs in forked copies: its fault has its name all the same."""
    for name in ("segfault", "endless", "not_a_number", "exits"):
        place = folder / f"branch_{name}"
        study = study_in(place, {"treated": [faulty(name)]}, "counterfactual", replications=1,
                         duration_s=60)
        run(study, place / "own.db", expect=1)
        ((message,),) = messages(place / "own.db")[0].values()
        assert "in a branch from " in message and f"faulty_{name}: " in message, message
        assert FAULTS[name].split(";")[0] in message and "vehicle '" in message, message


def sums_stay_as_they_are(folder):
    """A library that changes how numbers are rounded does so for itself."""
    dbs = []
    for name in ("good", "rounding"):
        text = faulty(name)[:-1] + ", as: same}"
        study = study_in(folder / "sums", {"own": [text, "{function: aeb}"]})
        dbs.append(folder / f"sums_{name}.db")
        run(study, dbs[-1])
    assert_same(*dbs)


def bad_studies(folder):
    """Exit code 2 with the place."""
    for text, wanted in (
            ("{function: plugin}", "must have a library"),
            ("{function: plugin, library: nowhere.so}", "must be a readable file, found 'nowhere.so'"),
            ("{function: aeb, library: car.yaml}", "belongs to 'function: plugin', found 'aeb'"),
            ("{function: plugin, library: car.yaml, as: 'a b'}", "makes the name 'a b'"),
            ("{function: plugin, library: car.yaml, parameters: {x: [1]}}", "must be a number or text")):
        study = study_in(folder / "bad", {"own": [text]})
        result = run(study, folder / "bad.db", expect=2)
        assert wanted in result.stderr and "study.yaml:" in result.stderr, result.stderr
    # Keys are the library's to know: it says so when it is loaded.
    study = study_in(folder / "bad", {"own": [faulty("good", ", ttc: 1")], "any": ["{function: plugin, "
                                              "library: car.yaml}"]})
    run(study, folder / "keys.db", expect=1)
    failed, _ = messages(folder / "keys.db")
    assert "'ttc' is not a parameter of" in failed["own"][0], failed
    assert "car.yaml: car.yaml: cannot be loaded" in failed["any"][0], failed


def swept(folder):
    """Parameters of a library are swept like others, if they are given."""
    place = folder / "swept"
    library = libraries / "aeb.so"
    study = study_in(place, {"own": [f"{{function: plugin, library: {library}, parameters: {{ttc_s: 1}}}}"]})
    study.write_text(study.read_text() +
                     "sweep:\n  - {parameter: variants.own.aeb.ttc_s, values: [0.5, 1.5]}\n")
    run(study, place / "own.db")
    found = dict(sqlite3.connect(place / "own.db").execute(
        "SELECT v.name, sum(json_extract(counters, '$.\"aeb.activations\"')) FROM replication r "
        "JOIN variant v ON v.id = r.variant_id WHERE v.name <> 'baseline' GROUP BY 1"))
    assert found["own@ttc_s=1.5"] > found["own@ttc_s=0.5"], found


with tempfile.TemporaryDirectory(prefix="crashpulse-test-") as name:
    for test in (bad_studies, the_example_in_its_study, ours_as_libraries, faults_fail_by_name,
                 faults_in_branches, sums_stay_as_they_are, swept):
        test(pathlib.Path(name))
        print(f"{test.__name__}: ok", flush=True)
