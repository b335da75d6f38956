#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Exports a collection from a private PostgreSQL as one file: export.sh PROGRAM SOURCE. Requires
# that the command line and the service give the same sequence and Watertight files of the same
# content, and that these hold what was stored.
set -euo pipefail
# shellcheck source=tests/unprivileged.sh
. "$(dirname "$0")/../unprivileged.sh"
program=$(readlink -f "$1")
source=$(cd "$2" && pwd)
folder=$(mktemp -d /tmp/watertight-export-XXXXXX)
service=
cleanup() {
  status=$?
  if [ -n "$service" ]; then
    kill -KILL "$service" || echo "the service was gone already"
  fi
  for _ in $(seq 50); do # the cluster ends a moment after its last user
    if rm -rf "$folder" 2>/dev/null; then break; fi
    sleep 0.1
  done
  exit $status
}
trap cleanup EXIT
fail() { echo "export.sh: $*" >&2 && exit 1; }

hand_over "$folder"
cd "$folder"
cp "$source/examples/delft.city.jsonl" in.city.jsonl
chmod a+r in.city.jsonl
store=(--data-dir "$folder/data")

run "$program" ingest in.city.jsonl "${store[@]}" --collection delft --invalid keep -q >said 2>&1 ||
  [ $? -eq 1 ] || fail "$(cat said)" # exit status 1: some features are invalid
run "$program" export delft -o all.wt "${store[@]}" 2>said
grep -Eq '^watertight: [1-9][0-9]* features with [1-9][0-9]* solids written$' said || fail "$(cat said)"
run "$program" export delft -o all.city.jsonl "${store[@]}" 2>/dev/null
run "$program" export delft -o - "${store[@]}" 2>/dev/null | cmp - all.wt
run "$program" decode all.wt -o back.city.jsonl
cmp all.city.jsonl back.city.jsonl
# Each line is a line of the source, byte for byte, and occurs once; the order is another.
[ "$(wc -l <all.city.jsonl)" -gt 100 ] || fail "$(wc -l <all.city.jsonl) lines"
[ -z "$(sort all.city.jsonl | uniq -d)" ] || fail "a feature is there twice"
cmp <(sort all.city.jsonl) <(sort in.city.jsonl) || fail "other lines than came in"
[ "$(stat -c %s all.wt)" -lt "$(($(stat -c %s all.city.jsonl) / 4))" ] || fail "the pages save nothing"
! run "$program" export none -o none.wt "${store[@]}" 2>said || fail "exported a collection that is none"
grep -q "there is no collection 'none'" said || fail "$(cat said)"
[ ! -e none.wt ] || fail "an export that failed left a file"

# In formats without ids a feature has the name of its file; two files must not have one name.
mkdir a b
echo 'SOLID Z((((0 0 0,0 1 0,1 0 0,0 0 0)),((0 0 0,1 0 0,0 0 1,0 0 0)),((0 0 0,0 0 1,0 1 0,0 0 0)),((1 0 0,0 1 0,0 0 1,1 0 0))))' |
  tee a/house.wkt b/house.wkt >b/pair.wkt
cat a/house.wkt >>b/pair.wkt
chmod -R a+rX a b
! run "$program" ingest a/house.wkt b/house.wkt "${store[@]}" --collection wkt -q >said 2>&1 || fail "$(cat said)"
grep -q "would be called 'house', as one of 'a/house.wkt' is" said || fail "$(cat said)"
run "$program" ingest b/pair.wkt "${store[@]}" --collection wkt -q >said 2>&1 || fail "$(cat said)"
run "$program" export wkt -o wkt.wt "${store[@]}" 2>said
grep -q '^watertight: 3 features with 3 solids written$' said || fail "$(cat said)"
run "$program" ingest in.city.jsonl in.city.jsonl "${store[@]}" --collection twice --invalid skip -q >said 2>&1 || [ $? -eq 1 ]
grep -q "replaces the one from 'in.city.jsonl'" said || fail "$(cat said)"

"${as[@]}" "$program" serve "${store[@]}" --listen 127.0.0.1:0 >listening 2>log &
service=$!
for _ in $(seq 300); do
  if grep -q http listening; then break; fi
  kill -0 "$service" 2>/dev/null || fail "$(cat log)"
  sleep 0.1
done
url=$(sed -n 's/^listening on //p' listening)/collections/delft/export
curl -fsS "$url" >blobs.wt
run "$program" decode blobs.wt -o blobs.city.jsonl
cmp all.city.jsonl blobs.city.jsonl
[ "$(stat -c %s all.wt)" -lt "$(stat -c %s blobs.wt)" ] || fail "the pages save nothing over blobs"
curl -fsS "$url?f=cityjsonseq" | cmp - all.city.jsonl
curl -fsS -H 'Accept: application/city+json-seq' "$url" | cmp - all.city.jsonl
curl -fsS --http1.0 "$url" | cmp - blobs.wt
curl -fsSI "$url" | tr -d '\r' | grep -Fxq 'Content-Disposition: attachment; filename="delft.wt"'
# A download that broke off goes on, and has the same bytes then.
head -c 5000 blobs.wt >resumed.wt
curl -fsS -C - -o resumed.wt "$url"
cmp resumed.wt blobs.wt
[ "$(curl -fsS -r 10-19 "$url" | wc -c)" -eq 10 ] || fail "a range of ten bytes has another length"
curl -sS "${url/delft/none}" | grep -q '"status":404'
# A client that leaves in the middle of an export; a busy machine may need a while to begin it.
for seconds in 1 5 25; do
  left=0
  curl -sS --limit-rate 1000 --max-time "$seconds" -o part "$url?f=cityjsonseq" 2>/dev/null || left=$?
  [ "$left" -eq 28 ] || fail "a download at 1000 bytes a second ended with $left, not with a time-out"
  if [ -s part ]; then break; fi
done
[ -s part ] || fail "no byte within $seconds seconds"
[ "$(stat -c %s part)" -lt "$(stat -c %s all.city.jsonl)" ] || fail "the download was not cut off"
curl -fsS "$url" | cmp - blobs.wt
kill -TERM "$service"
ended=0
wait "$service" || ended=$?
service=
[ "$ended" -eq 0 ] || fail "the service ended with $ended: $(cat log)"
echo "$(wc -l <all.city.jsonl) lines, the same by command line and service"
