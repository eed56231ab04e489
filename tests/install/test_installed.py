# SPDX-License-Identifier: GPL-3.0-or-later
"""crashpulse as others have it: installed elsewhere, source and build folder out of reach, started from another
folder by a user who may not write to the installation.

--library: another program finds it by CMake and by pkg-config, and crashes a car with it.
--package: the Debian package, in a root of its own where the system lets one be made."""
import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

parser = argparse.ArgumentParser()
for option in ("build", "source", "cmake"):
    parser.add_argument("--" + option, required=True)
for option in ("library", "package", "debug"):
    parser.add_argument("--" + option, action="store_true")
arguments = parser.parse_args()
build, source = pathlib.Path(arguments.build).resolve(), pathlib.Path(arguments.source).resolve()
NOBODY = "65534"
CRASH = ["crash", "honda_accord_2014", "--speed", "56", "--format", "json"]


def run(*words, **options):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, **options)
    assert done.returncode == 0, f"{' '.join(map(str, words))}\n{done.stdout}\n{done.stderr}"
    return done.stdout


def namespace(script):
    """Words in front of a command that runs in mounts of its own, as a user without rights; [] where the system
    does not allow that."""
    unshare = ["unshare", "--mount"] if os.geteuid() == 0 else ["unshare", "--map-root-user", "--mount"]
    drop = f"exec setpriv --reuid {NOBODY} --regid {NOBODY} --clear-groups " if os.geteuid() == 0 else "exec "
    words = unshare + ["sh", "-ec", f'{script}\n{drop}"$@"', "sh"]
    return words if subprocess.run(words + ["true"], capture_output=True).returncode == 0 else []


def hidden(script=""):
    """The same where source and build folder are empty too."""
    folders = [source] + ([build] if source not in build.parents else [])
    hide = "\n".join(f"mount -t tmpfs none '{folder}'" for folder in folders)
    return namespace(f"{script}\n{hide}")


def check_files(prefix):
    """No file of the installation knows where it was built."""
    programs = 0
    for path in prefix.rglob("*"):
        if path.is_symlink():
            target = path.resolve()
            assert prefix in target.parents and target.exists(), f"{path} leads to {target}"
        elif path.is_file():
            content = path.read_bytes()
            if content[:4] == b"\x7fELF":
                programs += 1
                dynamic = run("readelf", "--dynamic", path)
                for line in dynamic.splitlines():
                    assert "PATH)" not in line or line.rstrip().endswith("[$ORIGIN/sumo_without_gui]"), line
            if not (arguments.debug and content[:4] == b"\x7fELF"):
                for folder in (source, build):
                    assert str(folder).encode() not in content, f"{path} names {folder}"
    assert programs >= 4, f"{programs} programs and libraries"
    for part in ("share/man/man1/crashpulse-run.1", "share/bash-completion/completions/crashpulse", "include/crashpulse.h",
                 "share/crashpulse/sumo_scenarios/town/town.rou.xml", "share/crashpulse/db/queries/worst_crashes.sql"):
        assert (prefix / part).is_file(), f"{part} is missing"


def clean_environment(folder):
    """Nothing of ours, but that a build with sanitizers finds what it is to suppress: the source is hidden."""
    suppressions = pathlib.Path(shutil.copy(source / "tests/lsan.supp", folder))
    suppressions.chmod(0o644)
    return {"PATH": "/usr/bin:/bin", "HOME": str(folder), "TMPDIR": str(folder),
            "LSAN_OPTIONS": f"suppressions={suppressions}"}


def check_program(program, data, before, folder):
    """A crash, a study on shipped networks, SQL with the extension: from an empty folder of one's own."""
    def crashpulse(*words):
        return run(*before, program, *words, cwd=folder, env=environment)

    environment = clean_environment(folder)
    own = json.loads(run(build / "crashpulse", *CRASH))
    assert json.loads(crashpulse(*CRASH)) == own
    study = (data / "sumo_scenarios/left_turn/study.yaml").read_text()
    assert "left_turn.sumocfg" in study
    shortened = []
    for line in study.splitlines():
        key = line.split(":")[0]
        line = {"replications": "replications: 1", "duration_s": "duration_s: 60"}.get(key, line)
        shortened.append(line.replace("sumocfg: ", f"sumocfg: {data}/sumo_scenarios/left_turn/")
                         .replace("../../db", f"{data}/db"))
    (folder / "study.yaml").write_text("\n".join(shortened) + "\n")
    crashpulse("run", "study.yaml", "--db", "study.db", "--jobs", "2")
    rows = json.loads(crashpulse("sql", "study.db", "--format", "json", "SELECT count(*) AS done, median(id, 0) > 0 AS "
                                 "has_functions FROM replication WHERE status = 'done'"))
    assert rows == [{"done": 2, "has_functions": 1}], rows


def check_own_network(program, before, folder):
    """A study that init makes of a network from elsewhere."""
    environment = {**clean_environment(folder), "SUMO_HOME": "/usr/share/sumo"}

    def here(*words):
        return run(*before, *words, cwd=folder, env=environment)

    here("netgenerate", "--grid", "--grid.number", "2", "--grid.length", "150", "--output-file", "foreign.net.xml")
    (folder / "foreign.rou.xml").write_text(
        '<routes><flow id="f" from="A0B0" to="B1A1" begin="0" end="60" period="3"/>'
        '<flow id="g" from="B1A1" to="A0B0" begin="0" end="60" period="3"/></routes>')
    (folder / "foreign.sumocfg").write_text(
        '<configuration><net-file value="foreign.net.xml"/><route-files value="foreign.rou.xml"/>'
        '<end value="80"/></configuration>')
    here(program, "init", "mine", "--network", "foreign.sumocfg")
    here(program, "run", "mine/study.yaml", "--db", "mine/study.db", "--jobs", "2")
    rows = json.loads(here(program, "sql", "mine/study.db", "--format", "json",
                           "SELECT count(*) AS done FROM replication WHERE status = 'done'"))
    assert rows == [{"done": 8}], rows
    here(program, "compare", "mine/study.db")
    here(program, "report", "mine/study.db", "--output", "mine/report.html")
    assert (folder / "mine/report.html").stat().st_size > 100000
    here(program, "init", "example") # the one that is installed, copied


def make_folders(top):
    """A folder that everybody reads and one that anybody writes."""
    top.chmod(0o755)
    own = top / "own"
    own.mkdir()
    own.chmod(0o777)
    return own


def check_prefix(top):
    own = make_folders(top)
    run(arguments.cmake, "--install", build, "--prefix", top / "as built")
    prefix = top / "moved to" # an installation can be moved
    (top / "as built").rename(prefix)
    check_files(prefix)
    before = hidden()
    if not before:
        print("source and build folder stay in reach: the system lets no mounts be made")
    check_program(prefix / "bin/crashpulse", prefix / "share/crashpulse", before, own)
    check_own_network(prefix / "bin/crashpulse", before, own)


def check_library(top):
    run(arguments.cmake, "--install", build, "--prefix", top / "prefix")
    client, made = pathlib.Path(arguments.source) / "tests/install/client", top / "client"
    flags = "-fsanitize=address,undefined" if "CRASHPULSE_SANITIZE:BOOL=ON" in (build / "CMakeCache.txt").read_text() else ""
    run(arguments.cmake, "-S", client, "-B", made, f"-DCMAKE_PREFIX_PATH={top / 'prefix'}", f"-DCMAKE_C_FLAGS={flags}",
        f"-DCMAKE_CXX_FLAGS={flags}")
    run(arguments.cmake, "--build", made)
    own = json.loads(run(build / "crashpulse", *CRASH))["vehicles"][0]["olc_g"]
    assert float(run(made / "client")) == own, own
    # 20 g evenly: the free flight takes t1 = sqrt(2 0.065 m / 20 g); OLC = V0 / (V0 / 20 g ... ) from s(t2) = 0.3 m
    status, olc_g = run(made / "client_cpp").split()
    assert status == "value" and abs(float(olc_g) - expected_olc_g(15.0, 20 * 9.80665)) < 0.02, olc_g

    # pkg-config finds it where it was moved to.
    (top / "prefix").rename(top / "moved")
    paths = {**os.environ, "PKG_CONFIG_PATH": str(next((top / "moved").rglob("pkgconfig")))}
    words = run("pkg-config", "--cflags", "--libs", "crashpulse", env=paths).split()
    run("cc", *flags.split(), client / "client.c", "-o", top / "client_pc", *words)
    library = next((top / "moved").rglob("libcrashpulse.so")).parent
    assert float(run(top / "client_pc", env={**os.environ, "LD_LIBRARY_PATH": str(library)})) == own
    symbols = [line.split()[-1] for line in run("nm", "-D", "--defined-only", library / "libcrashpulse.so").splitlines()]
    foreign = [name for name in symbols if not name.startswith("crashpulse_")]
    assert symbols and not foreign, foreign


def expected_olc_g(v0, a):
    """Of an even deceleration a from v0 to a stand, by bisection of the definition: the occupant flies until the car
    has lost 65 mm on it and then decelerates evenly; 300 mm are used up when both have one speed."""
    def car(t):
        t_end = v0 / a
        return (v0 - a * t, v0 * t - a * t * t / 2) if t < t_end else (0.0, v0 * v0 / (2 * a))

    t1 = (2 * 0.065 / a) ** 0.5
    low, high = t1, 0.5
    for _ in range(200):
        t2 = (low + high) / 2
        v, x = car(t2)
        gap = v0 * t2 - x - (v0 - v) * (t2 - t1) / 2
        low, high = (t2, high) if gap < 0.3 else (low, t2)
    return (v0 - car(t2)[0]) / (t2 - t1) / 9.80665


def check_package(top):
    own = make_folders(top)
    run("cpack", "--config", build / "CPackConfig.cmake", "-G", "DEB", "-B", top / "package")
    package, = (top / "package").glob("*.deb")
    depends = run("dpkg-deb", "--field", package, "Depends")
    for name in ("sumo (", "libode", "libsqlite3-0", "libgsl", "libpagmo"):
        assert name in depends, depends
    root = top / "root"
    run("dpkg-deb", "--extract", package, root)
    root.chmod(0o755)
    check_files(root / "usr")
    # Laid over /usr, it is where the package puts it: a root with what it depends on and nothing of ours.
    before = hidden(f"mount -t overlay -o ro,lowerdir='{root / 'usr'}':/usr overlay /usr")
    if not before:
        sys.exit("SKIPPED: the system lets no overlay be mounted")
    check_program("/usr/bin/crashpulse", root / "usr/share/crashpulse", before, own)
    check_own_network("/usr/bin/crashpulse", before, own)


with tempfile.TemporaryDirectory(prefix="crashpulse-") as folder:
    (check_library if arguments.library else check_package if arguments.package else check_prefix)(pathlib.Path(folder))
