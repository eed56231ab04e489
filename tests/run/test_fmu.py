# SPDX-License-Identifier: GPL-3.0-or-later
"""A functional mock-up unit as a function, by the shipped bridge: units of FMI 2 and 3, packed and unpacked,
give the database of the same rule as a function; what is wrong with one is named."""
import argparse
import pathlib
import shutil
import subprocess
import sys
import tempfile
import zipfile

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "builders"))
import own_study

parser = argparse.ArgumentParser()
parser.add_argument("--crashpulse", required=True)
parser.add_argument("--network", required=True)
parser.add_argument("--source", required=True)
parser.add_argument("--libraries", required=True)
arguments = parser.parse_args()
arguments.crashpulse = str(pathlib.Path(arguments.crashpulse).resolve())
libraries = pathlib.Path(arguments.libraries)

INPUTS = ["own_speed_m_s", "object1_ahead_m", "object1_left_m", "object1_heading_rad", "object1_speed_m_s"]
VARIABLES = [("ttc_s", "parameter"), *((name, "input") for name in INPUTS), ("brake_m_s2", "output")]


def description(version, output="brake_m_s2"):
    two = version == 2
    names = [(output if name == "brake_m_s2" else name, causality) for name, causality in VARIABLES]
    if two:
        head = 'fmiVersion="2.0" modelName="brake" guid="{brake-1}"'
        variables = "".join(f'<ScalarVariable name="{n}" valueReference="{k}" causality="{c}"><Real/>'
                            "</ScalarVariable>" for k, (n, c) in enumerate(names))
    else:
        head = 'fmiVersion="3.0" modelName="brake" instantiationToken="{brake-1}"'
        variables = "".join(f'<Float64 name="{n}" valueReference="{k}" causality="{c}"/>'
                            for k, (n, c) in enumerate(names))
    return (f'<?xml version="1.0"?><fmiModelDescription {head}><CoSimulation modelIdentifier="brake"/>'
            f"<ModelVariables>{variables}</ModelVariables></fmiModelDescription>")


def folder_of(version):
    return "binaries/linux64" if version == 2 else "binaries/x86_64-linux"


def pack(path, version, library, text=None, more=()):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as package:
        package.writestr("modelDescription.xml", text or description(version))
        package.write(libraries / library, f"{folder_of(version)}/brake.so")
        for name in more:
            package.writestr(name, "1")
    return path


def bridge_built(folder):
    prefix, build = folder / "prefix", folder / "bridge"
    (prefix / "include/crashpulse").mkdir(parents=True)
    shutil.copy(pathlib.Path(arguments.source) / "src/api/crashpulse/function.h", prefix / "include/crashpulse")
    subprocess.run(["cmake", "-S", pathlib.Path(arguments.source) / "sumo_scenarios/fmu_bridge", "-B", build,
                    f"-DCMAKE_PREFIX_PATH={prefix}"], check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", build], check=True, stdout=subprocess.DEVNULL)
    return build / "fmu_bridge.so"


def run(folder, function, db, expect=0, design="paired_seeds"):
    study = own_study.study_in(folder / "study", arguments.network, {"own": [function]}, design, replications=1,
                               duration_s=60)
    return own_study.run(arguments.crashpulse, study, folder / db, expect=expect)


def units_are_the_rule(folder, bridge):
    unpacked = folder / "unpacked"
    (unpacked / folder_of(2)).mkdir(parents=True)
    (unpacked / "resources").mkdir()
    (unpacked / "modelDescription.xml").write_text(description(2))
    shutil.copy(libraries / "fmu2.so", unpacked / folder_of(2) / "brake.so")
    units = {"two": pack(folder / "two.fmu", 2, "fmu2.so"), "three": pack(folder / "three.fmu", 3, "fmu3.so"),
             "unpacked": unpacked / "modelDescription.xml"}
    for design in ("paired_seeds", "counterfactual"):
        reference = f"{{function: plugin, library: {libraries / 'fmu_reference.so'}, as: own, parameters: {{ttc_s: 1.5}}}}"
        run(folder, reference, f"reference_{design}.db", design=design)
        for name, unit in units.items():
            function = (f"{{function: plugin, library: {bridge}, as: own, data: {unit}, "
                        "parameters: {ttc_s: 1.5}}")
            run(folder, function, f"{name}_{design}.db", design=design)
            own_study.assert_same(folder / f"{name}_{design}.db", folder / f"reference_{design}.db")
    found = own_study.rows(folder / "two_paired_seeds.db")["replication"]
    assert any('"own.activations":0.0' not in str(row) and "own.activations" in str(row) for row in found), found


def faults_are_named(folder, bridge):
    (folder / "none.fmu").write_bytes(b"PK\3\4 nothing")
    bad = {"no_number": (pack(folder / "bad.fmu", 2, "fmu2_bad.so"), "", "its request has acceleration_m_s2"),
           "damaged": (folder / "none.fmu", "", "neither a zip file nor XML"),
           "no_output": (pack(folder / "mute.fmu", 2, "fmu2.so", description(2, "other")), "",
                         "has neither the output brake_m_s2 nor warning_1"),
           "parameter": (folder / "two.fmu", "tttc_s: 1", "no real parameter of this name: tttc_s"),
           "resources": (pack(folder / "resources.fmu", 2, "fmu2.so", None, ["resources/map.bin"]), "",
                         "it has resources: unpack it"),
           "version": (pack(folder / "one.fmu", 2, "fmu2.so",
                            description(2).replace("2.0", "1.0")), "", "not of FMI 2 or 3"),
           "binary": (pack(folder / "mixed.fmu", 3, "fmu2.so"), "", "fmi3InstantiateCoSimulation")}
    for name, (unit, parameters, wanted) in bad.items():
        function = f"{{function: plugin, library: {bridge}, data: {unit}, parameters: {{{parameters}}}}}"
        result = run(folder, function, f"bad_{name}.db", expect=1)
        assert wanted in result.stderr and "fmu_bridge: " in result.stderr, (name, result.stderr)


with tempfile.TemporaryDirectory(prefix="crashpulse-test-") as name:
    built = bridge_built(pathlib.Path(name))
    for test in (units_are_the_rule, faults_are_named):
        test(pathlib.Path(name), built)
        print(f"{test.__name__}: ok", flush=True)
