#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# build_small_study.sh DATABASE [NAME...]: the invented study of each NAME.sql in turn (default:
# small_study) in a new database, by way of the project's own schema files.
set -eu
here=$(dirname "$0")
db=$1
shift
[ $# -gt 0 ] || set -- small_study
rm -f "$db" "$db-wal" "$db-shm"
version=0
{
    for file in "$here"/../../db/schema/[0-9]*.sql; do
        cat "$file"
        version=$((version + 1))
    done
    cat "$here/../../db/views.sql"
    for name in "$@"; do
        cat "$here/$name.sql"
    done
    # "CPLS", and the number of schema files
    echo "PRAGMA application_id = 0x43504c53; PRAGMA user_version = $version;"
} | sqlite3 -batch -bail "$db"
