#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""How db/pulse.zdict was made, the zstd dictionary of pulse codec 2:

    db/train_pulse_dictionary.py OUTPUT DATABASE...

trains one of 4 KB on the pulses of codec 2 in the databases (`zstd --train`; Debian's zstd). The
shipped one came of a database of its time and cannot be had again from another. A dictionary that
pulses were packed with is never replaced: another one makes another codec."""
import pathlib
import sqlite3
import subprocess
import sys
import tempfile

here = pathlib.Path(__file__).parent
output, databases = sys.argv[1], sys.argv[2:]
with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    for database in databases:
        rows = sqlite3.connect(database).execute(
            "SELECT crash_id, role, samples FROM pulse WHERE codec = 2")
        for crash, role, samples in rows:
            # The frame begins with zstd's magic number, after the few bytes of the header.
            frame = samples[samples.index(b"\x28\xb5\x2f\xfd"):]
            (folder / f"{crash}_{role}.zst").write_bytes(frame)
    known = here / "pulse.zdict"
    dictionary = ["-D", str(known)] if known.exists() else []
    subprocess.run(["zstd", "-q", "-d", "--rm", "-r", *dictionary, str(folder)], check=True)
    subprocess.run(["zstd", "-q", "--train", "-r", str(folder), "--maxdict=4096", "--dictID=1",
                    "-f", "-o", output], check=True)
