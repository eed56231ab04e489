#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# run_golden.sh CRASHPULSE DATABASE FOLDER: every case of golden/: NAME.cmd is a shell line with
# $crashpulse and $db; NAME.out its exact stdout (missing: empty), NAME.err a basic regular
# expression for each line of stderr (missing: empty), NAME.code its exit code (missing: 0). What
# was seen is left in FOLDER.
set -u
crashpulse=$1
db=$2
seen=$3
golden=$(cd "$(dirname "$0")" && pwd)/golden
export crashpulse db
mkdir -p "$seen"
cd "$(dirname "$db")" || exit 1
failures=0

for case in "$golden"/*.cmd; do
    name=$(basename "$case" .cmd)
    sh "$case" >"$seen/$name.out" 2>"$seen/$name.err" </dev/null
    code=$?
    wanted=0
    [ -f "$golden/$name.code" ] && wanted=$(cat "$golden/$name.code")
    if [ "$code" -ne "$wanted" ]; then
        echo "FAILED: $name: exit code $code, expected $wanted" >&2
        failures=$((failures + 1))
    fi
    out=/dev/null
    [ -f "$golden/$name.out" ] && out=$golden/$name.out
    if ! diff -u "$out" "$seen/$name.out" >&2; then
        echo "FAILED: $name: stdout differs" >&2
        failures=$((failures + 1))
    fi
    # stderr line by line against the patterns
    err=/dev/null
    [ -f "$golden/$name.err" ] && err=$golden/$name.err
    if [ "$(wc -l <"$err")" -ne "$(wc -l <"$seen/$name.err")" ]; then
        echo "FAILED: $name: stderr has another number of lines:" >&2
        cat "$seen/$name.err" >&2
        failures=$((failures + 1))
    else
        line=0
        while IFS= read -r pattern; do
            line=$((line + 1))
            if ! sed -n "${line}p" "$seen/$name.err" | grep -q -- "$pattern"; then
                echo "FAILED: $name: line $line of stderr is not '$pattern':" >&2
                sed -n "${line}p" "$seen/$name.err" >&2
                failures=$((failures + 1))
            fi
        done <"$err"
    fi
done
[ "$failures" -eq 0 ]
