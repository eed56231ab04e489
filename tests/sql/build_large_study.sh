#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# build_large_study.sh DATABASE: the invented study of small_study.sql with 500 replications a
# scenario and variant and about 10^5 crashes.
set -eu
here=$(dirname "$0")
rm -f "$1" "$1-wal" "$1-shm"
version=0
{
    for file in "$here"/../../db/schema/[0-9]*.sql; do
        cat "$file"
        version=$((version + 1))
    done
    cat "$here/../../db/views.sql"
    sed -e 's/WHERE n < 7)/WHERE n < 499)/' \
        -e 's/1000 + 100 \* s.number + 10 \* v.number + n/1000 + 100000 * s.number + 10000 * v.number + n/' \
        -e 's/VALUES (9999, 12, 22, 8, 7008/VALUES (999999, 12, 22, 500, 7500/' \
        -e 's/WHERE k < 15)/WHERE k < 79)/' \
        -e 's/k < (4 + r.id/k < (68 + r.id/' "$here/small_study.sql"
    echo "PRAGMA application_id = 0x43504c53; PRAGMA user_version = $version;"
} | sqlite3 -batch -bail "$1"
