# SPDX-License-Identifier: GPL-3.0-or-later
"""Bad inputs of every kind over every kind of file that the program reads. What is wrong is refused
with exit code 2, the file's name and the reason; what may be read either way gives a result or a
reason; a byte order mark and line ends of Windows change nothing. Never a signal, an endless run,
another file written or a message that acts on a terminal. --samples N: so many; 0: all."""
import os
import pathlib
import random
import re
import resource
import shutil
import subprocess
import sys
import tempfile

import hostile

parser = hostile.parser(__doc__, "network", "vehicles", "samples")
parser.add_argument("--sanitized", action="store_true", help="no limit of address space")
a = parser.parse_args()

# ---- good files ---------------------------------------------------------------------------------

EV5 = """----- EV5 -----
----- TEST -----
V5|MADE-UP TEST|NONE|01/JAN/2020|LAB|C1|REF1|NCA|VTB|CON|DRY|22|OTH|OTH|36.0|0|0|0|3|DAS
----- VEHICLE -----
1|16|03|2018|M1|4S|VIN|4CIF|2.5|AF|1500|1400|2700|4500|1800|1200|UN|UNK|P||1|2|3|4|5|6|7|8|9|10|11|12|13|14|15|16|17|18|19|20|21|36.0|0|0|DE
----- OCCUPANT -----
1|01|H3|0|M|0
----- INSTRUMENTATION -----
1|7|AC|NA|FLLR|XG|SEC|G'S|2800|MFG|12/APR/2017|800|21|36.0|-50|99|1000|AM|P|LEFT SILL X
----- END -----
"""


def fcd():
    steps = []
    for k in range(80):
        t, east, west = 0.1 * k, 10 + 1.0 * k, 110 - 1.0 * k
        steps.append(f'<timestep time="{t:.2f}">\n<vehicle id="a" x="{east:.4f}" y="0.5" angle="90" '
                     f'type="car" speed="10" pos="{east:.4f}" lane="e_0" slope="0"/>\n'
                     f'<vehicle id="b" x="{west:.4f}" y="0" angle="270" type="car" speed="10" '
                     f'pos="5" lane="w_0" slope="0"/>\n</timestep>\n')
    return '<?xml version="1.0" encoding="UTF-8"?>\n<fcd-export>\n' + "".join(steps) + "</fcd-export>\n"


def car(vehicles):
    text = (pathlib.Path(vehicles) / "fleet" / "small_car.yaml").read_text()
    return "\n".join(line for line in text.splitlines() if not line.startswith("#")) + "\n"


STUDY = hostile.study(30, replications=2, more="warmup_s: 5\n", scenario="""\
    driver_errors:
      - {model: failed_to_see, parameters: {probability_1: 0.5}}
""", variants="""\
  - {name: aeb, functions: [{function: aeb, parameters: {ttc_s: 1.2}}]}
vehicles:
  default: car.yaml
sweep:
  - {parameter: variants.aeb.aeb.ttc_s, values: [0.8, 1.2]}
""")
FILES = {
    "car.yaml": car(a.vehicles),
    "study.yaml": STUDY,
    "fit.yaml": hostile.fit(base="car.yaml"),
    "reference.csv": "speed_kmh,offset_mm,angle_deg,olc_fe_g\n56,0,0,23.9\n40,0,0,15.0\n",
    "pulse.csv": "",  # made by the program itself
    "list.csv": hostile.LIST + "two,suv,van,40,50,200,10\n",
    "collisions.xml": '<?xml version="1.0" encoding="UTF-8"?>\n<collisions>\n<collision time="4.90" '
                      'type="frontal" lane="e_0" pos="60" collider="a" victim="b" colliderType="car" '
                      'victimType="car" colliderSpeed="10" victimSpeed="10"/>\n</collisions>\n',
    "fcd.xml": fcd(),
    "types.rou.xml": '<routes>\n<vType id="car" length="4.6" width="1.8" height="1.5"/>\n</routes>\n',
    "t1.EV5": EV5,
    "t1.007": "".join(f"{k / 1000:.6f}\t{0.5 if k < 0 else -9.5:.6f}\n" for k in range(-50, 100)),
}
def described(**values):
    """Lines of an ISO-MME file."""
    return "".join(f"{name.replace('_', ' '):<28}:{value}\n" for name, value in values.items())


FILES["t2.mme"] = described(Number_of_test_objects=1, Name_of_test_object_1="car", Velocity_test_object_1=10.5)
FILES["t2.001"] = described(
    Channel_code="10VEHCCG0000ACXD", Unit="m/s2", Reference_channel="implicit", Sampling_interval="0.001",
    Time_of_first_sample="-0.01") + "".join(f"{0.0 if k < 10 else -95.0:.6E}\n" for k in range(130))
FILES["sled.k"] = ("*KEYWORD\n$ units: m-s-kg\n*DEFINE_CURVE_TITLE\ncrashpulse vehicle a v_x\n"
                   "         1         0       1.0       1.0\n" +
                   "".join(f"{k / 1000:20.10E}{max(0.0, 10.5 - 0.1 * k):20.10E}\n" for k in range(120)) + "*END\n")
FILES["any.csv"] = "time_s,ax_m_s2,vx_m_s\n" + "".join(
    f"{k / 1000:.3f},-100,{10.5 - 0.1 * k:.4f}\n" for k in range(100))
ASSESS = ["assess", "--collisions", "collisions.xml", "--fcd", "fcd.xml", "--routes", "types.rou.xml"]
# Who reads it, and where its form is checked: what it is made of, and how often it is changed at random.
READERS = {
    "car.yaml": (["crash", "car.yaml", "--speed", "50"], "yaml"),
    "study.yaml": (["plan", "study.yaml"], "yaml"),
    "fit.yaml": (["calibrate", "fit.yaml", "--output", "/proc/version/x.yaml"], "yaml"),
    "reference.csv": (["validate", "car.yaml", "--reference", "reference.csv"], "csv"),
    "pulse.csv": (["validate", "car.yaml", "--pulse", "pulse.csv"], "csv"),
    "list.csv": (["assess", "--configurations", "list.csv"], "csv"),
    "collisions.xml": (ASSESS, "xml"),
    "fcd.xml": (ASSESS, "xml"),
    "types.rou.xml": (ASSESS, "routes"),  # with any root, as SUMO reads them
    "t1.EV5": (["validate", "car.yaml", "--pulse", ".", "--channels", "7", "--until", "90"], "ev5"),
    "t2.mme": (["pulse", "t2.mme"], "mme"),
    "t2.001": (["pulse", "t2.mme"], "mme"),
    "sled.k": (["pulse", "sled.k"], "keyword"),
    "any.csv": (["pulse", "any.csv"], "csv"),
    "t1.007": (["validate", "car.yaml", "--pulse", ".", "--channels", "7", "--until", "90"], "curve"),
}

# ---- bad ones -----------------------------------------------------------------------------------

NUMBER = re.compile(rb"(?<=[ :,\[|\"])-?[0-9]+\.?[0-9]*(?=[ ,}\]|\n\"])")
ODD_NUMBERS = (b"nan", b"inf", b"-inf", b"1e999", b"1.5garbage", b"0x10", b"--1", b"1,5", b"1e-999",
               b"99999999999999999999", b"-1e30", b"1e30", b"'", b"\xc3\x97", b"=1+1", b"1 2", b"")


def kinds(name, good, form, rng):
    """(what, content or a way to make the file, must: 2, 'same' or None for either)."""
    text = good.encode()
    yield "missing", lambda p: p.unlink(), 2
    yield "empty", b"", 2
    yield "only blanks", b"  \n\n \n", 2
    yield "a folder", lambda p: (p.unlink(), p.mkdir()), 2
    yield "a pipe", lambda p: (p.unlink(), os.mkfifo(p)), 2
    yield "a device", lambda p: (p.unlink(), p.symlink_to("/dev/zero")), 2
    yield "a link to itself", lambda p: (p.unlink(), p.symlink_to(name)), 2
    yield "huge", lambda p: os.truncate(p, 3 << 30), 2
    for at in (0, 1, len(text) // 2, len(text) - 1, len(text)):
        yield f"a zero byte at {at}", text[:at] + b"\0" + text[at:], 2
    yield "UTF-16", b"\xff\xfe" + good.encode("utf-16-le"), 2 if form not in ("xml", "routes") else None
    yield "binary", rng.randbytes(3000), 2
    yield "byte order mark", b"\xef\xbb\xbf" + text, "same"
    yield "CRLF", text.replace(b"\n", b"\r\n"), "same"
    yield "no last line end", text.rstrip(b"\n"), "same"
    yield "a line of a megabyte", text + b"x" * 1000000 + b"\n", None
    yield "a megabyte without a line end", b"a" * 1000000, 2
    yield "other text", b"hello, world\n" * 50, 2
    for place in rng.sample(range(len(text)), min(40, len(text))):
        yield f"cut at {place}", text[:place], None
        yield f"latin-1 at {place}", text[:place] + b"\xe9" + text[place:], None
        yield f"tab at {place}", text[:place] + b"\t" + text[place:], None
        yield f"escape at {place}", text[:place] + b"\x1b[2J" + text[place:], None
        yield f"a byte at {place}", text[:place] + bytes([rng.randrange(256)]) + text[place + 1:], None
        yield f"a quote at {place}", text[:place] + b'"' + text[place:], None
    lines = text.splitlines(keepends=True)
    for k in rng.sample(range(len(lines)), min(25, len(lines))):
        yield f"without line {k + 1}", b"".join(lines[:k] + lines[k + 1:]), None
        yield f"line {k + 1} twice", b"".join(lines[:k + 1] + lines[k:]), None
        other = rng.randrange(len(lines))
        swapped = list(lines)
        swapped[k], swapped[other] = swapped[other], swapped[k]
        yield f"lines {k + 1} and {other + 1} swapped", b"".join(swapped), None
    numbers = list(NUMBER.finditer(text))
    for match in rng.sample(numbers, min(40, len(numbers))):
        for odd in rng.sample(ODD_NUMBERS, 6):
            place = text[max(0, match.start() - 25):match.start()].decode(errors="replace")
            yield f"{odd} after {place!r}", text[:match.start()] + odd + text[match.end():], None
    if form == "yaml":
        key = lines[0].split(b":")[0]
        yield "a key twice", lines[0] + text, 2
        yield "an unknown key", text + b"nobody_knows: 1\n", 2
        yield "deep brackets", text + b"more: " + b"[" * 100000, 2
        yield "deep mappings", b"".join(b" " * k + b"a:\n" for k in range(3000)), 2
        yield "many aliases", (b"a: &a [x, x]\n" + b"".join(
            b"%c: &%c [*%c, *%c]\n" % (c + 1, c + 1, c, c) for c in range(97, 121)) + text), 2
        yield "an alias of nothing", text.replace(lines[0], key + b": *nothing\n", 1), 2
        yield "a merge key", text + b"<<: {a: 1}\n", 2
        yield "a second document", text + b"---\n" + text, 2
        yield "a list", b"- " + text.replace(b"\n", b"\n  ").rstrip() + b"\n", 2
        yield "a list for the first key", text.replace(lines[0], key + b": [1, 2]\n", 1), 2
        yield "a mapping for the first key", text.replace(lines[0], key + b": {a: b}\n", 1), 2
        yield "nothing for the first key", text.replace(lines[0], key + b":\n", 1), 2
        yield "an escape in a value", text.replace(lines[0], key + b': "a\\e[2J"\n', 1), 2
        yield "a zero in a value", text.replace(lines[0], key + b': "a\\0b"\n', 1), 2
        yield "a tag", text.replace(lines[0], key + b": !!python/object:os.system x\n", 1), None
        for bad in (b"nan", b"inf", b".inf", b"1e999", b"1.5garbage", b"0x10", b"[1]", b"{a: 1}", b"''"):
            for match in rng.sample(numbers, min(8, len(numbers))):
                yield (f"{bad} for the number at {match.start()}",
                       text[:match.start()] + bad + text[match.end():], None)
    if form == "csv":
        header, row = lines[0].rstrip(b"\n"), lines[1].rstrip(b"\n").split(b",")
        yield "a column twice", b"".join([header + b"," + header.split(b",")[-1] + b"\n"] + [
            line.rstrip(b"\n") + b",1\n" for line in lines[1:]]), 2
        yield "no header", b"".join(lines[1:]), 2
        yield "header alone", lines[0], 2
        yield "a field more", lines[0] + b",".join(row + [b"1"]) + b"\n" + b"".join(lines[2:]), 2
        yield "a field less", lines[0] + b",".join(row[:-1]) + b"\n" + b"".join(lines[2:]), 2
        for bad in (b"nan", b"inf", b"1e999", b"1.5garbage", b"0x10", b"", b"one", b"--1", b"1 2"):
            column = 2 if name == "pulse.csv" else len(row) - 1  # one that is read
            yield (f"{bad} for a number of row 2", lines[0] + b",".join(
                row[:column] + [bad] + row[column + 1:]) + b"\n" + b"".join(lines[2:]), 2)
    if form in ("xml", "routes"):
        yield "an entity bomb", (b'<?xml version="1.0"?>\n<!DOCTYPE x [<!ENTITY a "aaaaaaaaaa">' + b"".join(
            b'<!ENTITY %c "&%c;&%c;&%c;&%c;&%c;&%c;&%c;&%c;">' % (c + 1, *(8 * [c]))
            for c in range(97, 110)) + b"]>\n<collisions>&n;</collisions>\n"), 2
        must = 2 if form == "xml" else None
        yield "an entity of a file", (b'<?xml version="1.0"?>\n<!DOCTYPE x [<!ENTITY a SYSTEM '
                                      b'"/etc/passwd">]>\n<other>&a;</other>\n'), must
        yield "another root", b"<other/>\n", must
        yield "deep elements", b"<a>" * 100000, 2
        yield "many attributes", b"<a " + b"".join(b'x%d="1" ' % k for k in range(50000)) + b"/>", must


# ---- trying them --------------------------------------------------------------------------------


def limits():
    if not a.sanitized:
        resource.setrlimit(resource.RLIMIT_AS, (1 << 31, 1 << 31))
    resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 26, 1 << 26))


def run(folder, words):
    return hostile.run(a.crashpulse, folder, *words, limit_s=60, preexec_fn=limits)


def judge(name, must, right, result):
    err = result.stderr.decode("utf-8", errors="replace")
    if must == "same":
        if result.returncode != right.returncode or result.stdout != right.stdout:
            return f"gives another result: {result.returncode} {err[-300:]}"
        return None
    allowed = (2,) if must == 2 else (0, 1, 2)
    if result.returncode not in allowed:
        return f"exit code {result.returncode}: {err[-600:]}"
    if result.returncode and not hostile.has_message(err):
        return f"no message: {err[-300:]}"
    # Where there is no EV5 file its folder is named, where there is no channel its test.
    beside = {"t1.EV5": ".EV5", "t2.001": "t2.mme"}.get(name, name)
    if must == 2 and name not in err and beside not in err:
        return f"{name} is not named: {err[-300:]}"
    if "(null)" in err or any(ord(c) < 32 and c not in "\n\t\r" for c in err):
        return f"a message that is none: {err!r}"
    return None


rng = random.Random(20)
tried, wrong, refused = 0, 0, 0
with tempfile.TemporaryDirectory() as text:
    folder = pathlib.Path(text)
    shutil.copytree(a.network, folder / "net")
    for name, good in FILES.items():
        (folder / name).write_text(good)
    run(folder, ["crash", "car.yaml", "--speed", "50", "--pulse", "made.csv"])
    FILES["pulse.csv"] = (folder / "made.csv").read_text()
    (folder / "made.csv").rename(folder / "pulse.csv")
    cases, right = [], {}
    for name, (words, form) in READERS.items():
        right[name] = run(folder, words)
        # A fit is read, and looked at, up to where it would begin.
        expected = 1 if name == "fit.yaml" else 0
        if right[name].returncode != expected:
            sys.exit(f"{name}: {right[name]}")
        cases += [(name, *kind) for kind in kinds(name, FILES[name], form, rng)]
    if a.samples:
        cases = rng.sample(cases, min(a.samples, len(cases)))
    for name, what, content, must in cases:
        path, words = folder / name, READERS[name][0]
        path.write_text(FILES[name])
        if callable(content):
            content(path)
        else:
            path.write_bytes(content)
        before = hostile.names(folder)
        try:
            result = run(folder, words)
            fault = judge(name, must, right[name], result)
            refused += result.returncode == 2
        except subprocess.TimeoutExpired:
            fault = "no end in 60 s"
        if fault is None and hostile.names(folder) != before:
            fault = f"wrote {hostile.names(folder) - before}"
        tried += 1
        if fault:
            wrong += 1
            print(f"{name}, {what}: {fault}", flush=True)
        if path.is_dir() and not path.is_symlink():
            path.rmdir()
        elif path.is_symlink() or path.exists():
            path.unlink()
        path.write_text(FILES[name])
print(f"{tried} bad inputs tried, {refused} refused, {wrong} times something was wrong")
sys.exit(1 if wrong or tried == 0 else 0)
