#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# build_small_study.sh DATABASE [NAME]: the invented study of NAME.sql (default: small_study) in a new
# database, by way of the project's own schema files.
set -eu
here=$(dirname "$0")
rm -f "$1" "$1-wal" "$1-shm"
version=0
{
    for file in "$here"/../../db/schema/[0-9]*.sql; do
        cat "$file"
        version=$((version + 1))
    done
    cat "$here/../../db/views.sql" "$here/${2:-small_study}.sql"
    # "CPLS", and the number of schema files
    echo "PRAGMA application_id = 0x43504c53; PRAGMA user_version = $version;"
} | sqlite3 -batch -bail "$1"
