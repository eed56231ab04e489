# SPDX-License-Identifier: GPL-3.0-or-later
"""campaign.py --minutes M TARGET...: guided fuzzing of each target for so long, going on from what earlier
campaigns found worth keeping (--corpus). A line for each of them goes to --log: executions, hours, findings.
Inputs that ended the program stay in the corpus folder, beside those of their target. Exit status 1 after any."""
import argparse
import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import threading
import time

HEAD = """# Guided fuzzing

One line a target and campaign: `cmake --preset fuzz`, then `cmake --build build-fuzz --target fuzz_campaign`.
Findings are inputs that ended the program; what they showed is mended, each with a test, before the next line.

| date | target | executions | hours | branches reached | corpus | findings |
|---|---|---:|---:|---:|---:|---|
"""

parser = argparse.ArgumentParser()
parser.add_argument("--program", required=True)
parser.add_argument("--seeds", required=True, type=pathlib.Path)
parser.add_argument("--corpus", required=True, type=pathlib.Path)
parser.add_argument("--db", required=True)
parser.add_argument("--log", required=True, type=pathlib.Path)
parser.add_argument("--minutes", type=float, default=30)
parser.add_argument("--jobs", type=int, default=1)
parser.add_argument("targets", nargs="+")
a = parser.parse_args()


def number(pattern, text):
    found = re.findall(pattern, text)
    return int(found[-1]) if found else 0


def fuzz(target):
    corpus = a.corpus / target
    corpus.mkdir(parents=True, exist_ok=True)
    findings = a.corpus / f"{target}_findings"
    findings.mkdir(exist_ok=True)
    before = set(findings.iterdir())
    started_s, executions, branches = time.monotonic(), 0, 0
    with tempfile.TemporaryDirectory() as scratch:
        while (left_s := 60 * a.minutes - (time.monotonic() - started_s)) > 1:
            # After a finding on with the rest of the time.
            words = [a.program, corpus.resolve(), (a.seeds / target).resolve(),
                     f"-max_total_time={int(left_s) + 1}", f"-artifact_prefix={findings.resolve()}/",
                     "-print_final_stats=1", "-timeout=30", "-rss_limit_mb=4096", "-close_fd_mask=3",
                     "-max_len=16384", "-use_value_profile=1"]
            result = subprocess.run(words, capture_output=True, text=True, errors="replace", env=dict(
                os.environ, FUZZ_TARGET=target, FUZZ_DB=a.db, TMPDIR=scratch,
                ASAN_OPTIONS="detect_leaks=1:allocator_may_return_null=1"))
            executions += number(r"stat::number_of_executed_units:\s+(\d+)", result.stderr)
            branches = max(branches, number(r"cov: (\d+)", result.stderr))
            if result.returncode != 0 and not set(findings.iterdir()) - before:
                sys.exit(f"{target}: {result.stderr[-3000:]}")
            if result.returncode != 0:
                (a.corpus / f"{target}.log").write_text(result.stderr[-20000:])
    new = sorted(set(findings.iterdir()) - before)
    line = (f"| {time.strftime('%Y-%m-%d')} | {target} | {executions} | "
            f"{(time.monotonic() - started_s) / 3600:.2f} | {branches} | {len(list(corpus.iterdir()))} | "
            f"{', '.join(p.name for p in new) or 'none'} |")
    print(line, flush=True)
    with writing:
        text = a.log.read_text() if a.log.exists() else HEAD
        a.log.write_text(text + line + "\n")
    return new


writing = threading.Lock()
with concurrent.futures.ThreadPoolExecutor(a.jobs) as pool:
    done = list(pool.map(fuzz, a.targets))
found = [str(path) for new in done for path in new]
print(f"{len(a.targets)} targets, {len(found)} findings", *found, sep="\n")
sys.exit(1 if found else 0)
