# SPDX-License-Identifier: GPL-3.0-or-later
"""Every command and every line of code on the project's pages, run: commands page by page in a folder that looks like
the build folder, where the studies are shortened to a minute or so and the files that examples name lie ready;
YAML read by the program. What is not run here stands in a list with the test that runs it, or the reason."""
import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

parser = argparse.ArgumentParser()
for option in ("crashpulse", "source", "build"):
    parser.add_argument("--" + option, required=True)
arguments = parser.parse_args()
source, build = pathlib.Path(arguments.source).resolve(), pathlib.Path(arguments.build).resolve()

PAGES = ["README.md", "CONTRIBUTING.md", "sumo_scenarios/README.md", "db/README.md", "reports/README.md",
         "db/vehicles/README.md", "db/field/README.md", "db/reference/README.md", "db/validation/README.md",
         "src/README.md", "src/control/README.md", "src/exchange/README.md", "reports/example/README.md", "SECURITY.md"]
PAGES += [f"sumo_scenarios/{name}/README.md" for name in
          ("adas_comparison", "crossing", "demo", "head_on_drift", "head_on_overtaking", "left_turn", "null_treatment",
           "town")]
PAGES_ELSEWHERE = {"sumo_scenarios/own_function/README.md": "tests/run/test_own_function.py",
                   "sumo_scenarios/fmu_bridge/README.md": "tests/run/test_fmu.py",
                   "sumo_scenarios/ncap/README.md": "tests/matrix",
                   "db/vehicles/fleet/README.md": "describes files; tests of its fits"}

# Lines that are not run here, by their beginning, and what runs them.
ELSEWHERE = {
    "./demo ": "continuous integration", "./check ": "continuous integration",
    "cmake --preset release": "this build", "cmake --build build": "this build, and targets that write into the source",
    "(cd build && cpack -G DEB)": "install.package", "cmake --install build": "install.prefix",
    "ctest --test-dir build": "this test is run by it",
    "reports/paper_figures.sh": "browser.paper_figures", "crashpulse submit ": "slurm.submit",
    "crashpulse calibrate db/": "a fit takes hours; tests/calibrate fits smaller ones",
    "crashpulse validate --suite db/validation/suite.yaml   ": "minutes; cli.validate_suite runs it",
    "crashpulse validate --suite db/validation/suite.yaml --cases": "minutes; cli.validate_suite runs it",
    "crashpulse validate --suite db/validation/suite.yaml --vehicle": "minutes; cli.validate_suite runs it",
    "crashpulse compare demo.db --model-uncertainty": "sql.small_study_members: cli.golden, compare_model_uncertainty",
}
LANGUAGES_ELSEWHERE = {"python": "sqlext.readme", "r": "sqlext.readme", "sql": "sqlext.readme", "text": "no code",
                       "c": "tests/install"}
COMMANDS = ("crashpulse", "sqlite3", "sumo", "cmake", "ctest", "sed", "reports/", "./", "(cd ")
SHORT_S = {"demo/study.yaml": 360} # one with crashes in it; the others:
SECONDS = 60


def blocks(text):
    """(language, text) of every fenced block and every block that is indented by four blanks."""
    found, language, lines, previous = [], None, [], ""
    for line in text.splitlines() + [""]:
        if language is not None and language != "indented":
            if line.startswith("```"):
                found.append((language, "\n".join(lines)))
                language = None
            else:
                lines.append(line)
        elif line.startswith("```"):
            language, lines = line[3:].strip() or "text", []
        elif line.startswith("    ") and (language == "indented" or not previous.strip()):
            lines = lines + [line[4:]] if language == "indented" else [line[4:]]
            language = "indented"
        elif language == "indented":
            found.append(("sh", "\n".join(lines)))
            language = None
        # A command that markdown takes for prose would be run by nobody.
        assert language is not None or not re.match(r"(crashpulse|sqlite3) .*(\.db|\.yaml)\b", line), line
        previous = line
    return found


def shorten(text, seconds):
    text = re.sub(r"^replications: \d+", "replications: 1", text, flags=re.M)
    text = re.sub(r"^warmup_s: \S+", "warmup_s: 10", text, flags=re.M)
    return re.sub(r"^duration_s: \S+", f"duration_s: {seconds}", text, flags=re.M)


def make_sandbox(top):
    """What the build folder has, and the files of the reader's own that examples name."""
    (top / "bin").mkdir()
    (top / "bin/crashpulse").symlink_to(pathlib.Path(arguments.crashpulse).resolve())
    (top / "db").symlink_to(source / "db")
    shutil.copytree(build / "sumo_scenarios", top / "sumo_scenarios", ignore=shutil.ignore_patterns("CMakeFiles"))
    for study in (top / "sumo_scenarios").rglob("*.yaml"):
        name = study.relative_to(top / "sumo_scenarios").as_posix()
        study.write_text(shorten(study.read_text(), SHORT_S.get(name, SECONDS)))
    left_turn = top / "sumo_scenarios/left_turn"
    for ending in ("net.xml", "rou.xml"):
        shutil.copy(left_turn / f"left_turn.{ending}", top)
    shutil.copy(left_turn / "left_turn.sumocfg", top / "my_network.sumocfg")
    shutil.copy(left_turn / "left_turn.sumocfg", top / "town.sumocfg")
    shutil.copy(left_turn / "left_turn.rou.xml", top / "town.rou.xml")
    (top / "study.yaml").write_text((left_turn / "study.yaml").read_text()
                                    .replace("sumocfg: ", "sumocfg: sumo_scenarios/left_turn/")
                                    .replace("../../db", "db").replace("replications: 1", "replications: 2"))
    shutil.copy(source / "tests/fuzz/rows.csv", top / "cases.csv")
    shutil.copy(source / "db/vehicles/mid_size.yaml", top / "my_car.yaml")
    environment = {**os.environ, "PATH": f"{top / 'bin'}:{os.environ['PATH']}", "SUMO_HOME": "/usr/share/sumo"}
    run(top, environment, "crashpulse run sumo_scenarios/demo/study.yaml --db demo.db --quiet", "the demo")
    return environment


def run(top, environment, script, where):
    done = subprocess.run(["bash", "-euo", "pipefail", "-c", script], cwd=top, env=environment, capture_output=True,
                          text=True, stdin=subprocess.DEVNULL)
    assert done.returncode == 0, f"{where}:\n{script}\n{done.stdout[-2000:]}\n{done.stderr[-2000:]}"
    return done.stdout


def commands(text):
    """Lines that belong together: continued by a backslash, or inside quotes."""
    command = ""
    for line in text.splitlines():
        command += ("\n" if command else "") + line
        bare = re.sub(r"\$\([^)]*\)", "", command)
        if not command.rstrip().endswith("\\") and bare.count('"') % 2 == 0:
            if command.strip():
                yield command
            command = ""
    assert not command, f"no end: {command}"


def run_block(top, environment, text, page):
    count = 0
    for command in commands(text):
        if command.lstrip().startswith("#"):
            continue
        assert command.startswith(COMMANDS), f"{page}: is this a command? {command}\nelse put it into ``` ```"
        beginning = [key for key in ELSEWHERE if command.startswith(key)]
        USED.update(beginning)
        if beginning:
            continue
        run(top, environment, command, page)
        if command.startswith("crashpulse init "):
            study = top / command.split()[2] / "study.yaml"
            study.write_text(shorten(study.read_text(), SECONDS))
        count += 1
    return count


BASE = """study: page
design: paired_seeds
seed: 1
replications: 2
duration_s: 60
scenarios:
  - name: left_turn
    sumocfg: sumo_scenarios/town/town.sumocfg
    driver_errors: [{model: failed_to_see}]
variants:
  - {name: baseline}
  - {name: aeb, functions: [{function: aeb, equipment: [{type: van, penetration_1: 0.5}]}]}
"""


def check_yaml(top, environment, text, page):
    """A study is planned, a vehicle crashed; of fits and suites every key is one of the reference."""
    first = text.split(":")[0].strip()
    if first in ("fit", "objective", "suite"):
        kind = "suite" if first == "suite" else "fit"
        known = run(top, environment, "crashpulse reference", page)
        part = re.search(rf"## {kind.capitalize()} files.*?(?=\n## )", known, re.S).group()
        keys = {key.split(".")[-1].rstrip("[]") for key in re.findall(r"^\| `([^`]+)`", part, re.M)}
        bare = re.sub(r'"[^"]*"|#.*', "", text)
        used = set(re.findall(r"(?:^|[\s{,])([a-z_][a-z0-9_]*):(?=\s)", bare))
        assert used and used <= keys, f"{page}: {sorted(used - keys)} are no keys"
    elif first == "vehicle":
        (top / "page_vehicle.yaml").write_text(text)
        run(top, environment, "crashpulse crash ./page_vehicle.yaml --speed 50", page)
    elif first == "name":
        assert "run: .ci/run" in text and (source / ".ci/run").is_file(), page # a workflow of GitHub's
    else:
        if first == "functions":
            text = BASE.replace("- {name: aeb, functions: [{function: aeb, equipment: [{type: van, penetration_1: 0.5}]}]}",
                                "- name: aeb\n    " + text.replace("\n", "\n    "))
        elif first != "study":
            text = BASE + text
        (top / "page_study.yaml").write_text(text)
        run(top, environment, "crashpulse plan page_study.yaml", page)


def check_links(page, text):
    for target in re.findall(r"\]\(([^)#]+)(?:#[^)]*)?\)", text):
        if not target.startswith("http"):
            assert (source / page).parent.joinpath(target).exists(), f"{page} leads to {target}, which is not there"


USED = set()
listed = subprocess.run(["git", "-C", source, "ls-files", "README.md", "*/README.md"], capture_output=True, text=True)
for page in listed.stdout.split():
    assert page in PAGES or page in PAGES_ELSEWHERE or page.startswith("tests/"), f"{page} is run by nothing: list it"

with tempfile.TemporaryDirectory(prefix="crashpulse-") as folder:
    top = pathlib.Path(folder)
    environment = make_sandbox(top)
    ran = snippets = 0
    for page in PAGES:
        text = (source / page).read_text()
        check_links(page, text)
        for language, block in blocks(text):
            if language == "sh":
                ran += run_block(top, environment, block, page)
            elif language == "yaml":
                check_yaml(top, environment, block, page)
                snippets += 1
            else:
                assert language in LANGUAGES_ELSEWHERE, f"{page}: nothing runs {language}"
    unused = set(ELSEWHERE) - USED
    assert not unused, f"no page has these any more: {sorted(unused)}"
    assert ran > 50 and snippets > 6, (ran, snippets)
    print(f"{ran} commands and {snippets} YAML texts of {len(PAGES)} pages work")
