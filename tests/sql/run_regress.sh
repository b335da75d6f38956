#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs the extension in a private server: run_regress.sh SOURCE BUILD [PROGRAM]
# With PROGRAM (watertight) the script also compares the blobs of SQL and command line. The store's
# own tests then find out whether a private cluster of such a server has the extension.
set -euo pipefail
# shellcheck source=tests/unprivileged.sh
. "$(dirname "$0")/../unprivileged.sh"
source=$(cd "$1" && pwd)
build=$(cd "$2" && pwd)
program=${3:-}
tests=(functions encode hostile helpers limits)

folder=$(mktemp -d /tmp/watertight-sql-XXXXXX)
started=no
cleanup() {
  status=$?
  if [ $started = yes ]; then
    run "$bin/pg_ctl" -D "$folder/data" -m immediate -s stop >/dev/null 2>&1 || true
  fi
  rm -rf "$folder"
  exit $status
}
trap cleanup EXIT

bin=$("$source/scripts/relocated-postgres" "$build" "$folder/prefix")
regress=$(dirname "$(pg_config --pgxs)")/../test/regress/pg_regress
cp -r "$source/tests/sql/sql" "$source/tests/sql/expected" "$folder/"
mkdir "$folder/socket" "$folder/crashing" "$folder/hanging"
printf '#!/bin/sh\nkill -SEGV $$\n' >"$folder/crashing/watertight-worker"
cp "$(command -v sleep)" "$folder/hanging/sleep"
printf '#!/bin/sh\nexec %s 600\n' "$folder/hanging/sleep" >"$folder/hanging/watertight-worker"
for fake in crashing hanging; do
  chmod +x "$folder/$fake/watertight-worker"
  cp "$folder/$fake/watertight-worker" "$folder/$fake/watertight-tetgen"
done
hand_over "$folder"
chmod 0700 "$folder"

cd "$folder"
run "$bin/initdb" -D "$folder/data" -N --username=watertight --encoding=UTF8 --no-locale \
  --auth=trust >"$folder/initdb.log" || { cat "$folder/initdb.log"; exit 1; }
run "$bin/pg_ctl" -D "$folder/data" -w -s -l "$folder/server.log" \
  -o "-c listen_addresses= -c unix_socket_directories=$folder/socket -c fsync=off" start ||
  { cat "$folder/server.log"; exit 1; }
started=yes
connect=(-h "$folder/socket" -U watertight)

if ! run env LD_LIBRARY_PATH= PGTZ=UTC "$regress" --inputdir="$folder" --outputdir="$folder" \
  --bindir="$bin" --host="$folder/socket" --user=watertight --load-extension=watertight \
  "${tests[@]}"; then
  cat "$folder/regression.diffs" || true
  tail -20 "$folder/server.log"
  exit 1
fi

if [ -n "$program" ]; then
  query() { run "$bin/psql" -X -q -At "${connect[@]}" -d regression -c "$1"; }
  for name in cube pierced hollow; do
    query "SELECT encode(ewkb, 'base64') FROM solids WHERE name = '$name'" |
      base64 -d >"$folder/$name.ewkb"
    query "SELECT encode(wt_encode(ewkb), 'base64') FROM solids WHERE name = '$name'" |
      base64 -d >"$folder/$name.sql"
    "$program" encode --bare "$folder/$name.ewkb" -o "$folder/$name.blob"
    cmp "$folder/$name.blob" "$folder/$name.sql" || {
      echo "SQL and command line encode '$name' differently"
      exit 1
    }
  done
  echo "3 blobs of SQL and command line are equal"
fi

# For every solid of these files, the extension must write the same bytes as the library, or find
# the solid invalid too, and give the solid back. Golden blobs must decode to the same solids.
if [ -x "$build/bin/encode_documents" ]; then
  query() { run "$bin/psql" -X -q -At -v ON_ERROR_STOP=1 "${connect[@]}" -d regression "$@"; }
  (cd "$source" && find examples tests/data tests/golden/solids tests/golden/blobs -type f |
    LC_ALL=C sort | xargs "$build/bin/encode_documents") >"$folder/rows"
  chmod a+r "$folder/rows"
  query -c "CREATE TABLE documents (name text, ewkb bytea, blob bytea)"
  query -c "COPY documents FROM STDIN" <"$folder/rows"
  for file in "$source"/tests/golden/blobs/*/*.blob; do
    printf '%s\t\\\\x%s\n' "${file#"$source"/}" "$(od -An -v -tx1 "$file" | tr -d ' \n')"
  done >"$folder/goldens"
  query -c "CREATE TABLE goldens (name text, blob bytea)"
  query -c "COPY goldens FROM STDIN" <"$folder/goldens"
  different=$(query -c "
    SELECT 'another verdict', name FROM documents WHERE wt_is_valid(ewkb) <> (blob IS NOT NULL)
    UNION ALL SELECT 'another blob', name FROM documents
      WHERE CASE WHEN blob IS NOT NULL THEN wt_encode(ewkb) <> blob END
    UNION ALL SELECT 'another solid', name FROM documents WHERE wt_decode(blob) <> ewkb
    UNION ALL SELECT 'another golden', name FROM goldens g LEFT JOIN documents d USING (name)
      WHERE d.ewkb IS DISTINCT FROM wt_decode(g.blob)")
  [ -z "$different" ] || { echo "SQL and library differ:"; echo "$different"; exit 1; }
  counts=$(query -c "SELECT count(blob), count(*) - count(blob) FROM documents")
  [ "${counts%|*}" -ge 500 ] || { echo "only ${counts%|*} blobs were compared"; exit 1; }
  echo "${counts%|*} blobs of SQL and library are equal, ${counts#*|} solids invalid in both"
fi

if [ -x "$build/bin/test_store" ]; then
  WATERTIGHT_POSTGRES_BIN=$bin "$build/bin/test_store" "the database has the extension*"
fi

# A helper process ends with its backend, and all connections are closed now.
helpers() {
  for link in /proc/[0-9]*/exe; do
    case $(readlink "$link" 2>/dev/null) in
      "$folder"/*/watertight-worker | "$folder"/*/watertight-tetgen | "$folder"/hanging/sleep)
        echo "$link" ;;
    esac
  done
}
for _ in $(seq 50); do
  left=$(helpers)
  if [ -z "$left" ]; then break; fi
  sleep 0.1
done
[ -z "$left" ] || { echo "helpers outlived their backends: $left"; exit 1; }
