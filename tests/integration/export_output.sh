#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Exports to files that only the caller can write: export_output.sh PROGRAM SOURCE. As root, with a user
# `watertight` that exists in this script's own view of /etc/passwd only. Also exports a collection of
# several headers, of GML and of a mesh as CityJSONSeq.
set -euo pipefail
program=$(readlink -f "$1")
source=$(cd "$2" && pwd)
if [ "$(id -u)" -eq 0 ] && [ -z "${3:-}" ]; then
  # A namespace of mounts of its own, with a passwd file that has the user.
  if ! unshare -m true 2>/dev/null; then
    echo "SKIPPED: root may not make a namespace here" && exit 77
  fi
  exec unshare -m "$0" "$1" "$2" inside
fi
folder=$(mktemp -d /tmp/watertight-output-XXXXXX)
cleanup() {
  status=$?
  for _ in $(seq 50); do # the cluster ends a moment after its last user
    if rm -rf "$folder" 2>/dev/null; then break; fi
    sleep 0.1
  done
  exit $status
}
trap cleanup EXIT
fail() { echo "export_output.sh: $*" >&2 && exit 1; }
if [ "${3:-}" = inside ]; then
  grep -v '^watertight:' /etc/passwd >"$folder/passwd"
  echo 'watertight:x:48173:48173::/nonexistent:/usr/sbin/nologin' >>"$folder/passwd"
  mount --bind "$folder/passwd" /etc/passwd
  mkdir "$folder/bin"
  chmod a+rx "$folder" "$folder/bin"
fi
cd "$folder"
mkdir mine
chmod 0700 mine # no other user may enter
store=(--data-dir "$folder/data")
[ "$(id -u)" -ne 0 ] || install -d -o watertight -g 48173 -m 0700 data
none_left() { [ "$(find mine -name '*.[0-9]*-[0-9]*' -o -name '*.??????' | wc -l)" -eq 0 ] || fail "a part of a file is left: $(ls mine)"; }

box() { # ID TRANSLATE MEMBERS
  echo '{"type":"CityJSON","version":"2.0","transform":{"scale":[0.001,0.001,0.001],"translate":['"$2"']}'"${3:-}"',"CityObjects":{},"vertices":[]}'
  echo '{"type":"CityJSONFeature","id":"'"$1"'","CityObjects":{"'"$1"'":{"type":"Building","geometry":[{"type":"Solid","lod":"1","boundaries":[[[[0,2,1]],[[0,1,3]],[[1,2,3]],[[2,0,3]]]]}]}},"vertices":[[0,0,0],[1000,0,0],[0,1000,0],[0,0,1000]]}'
}
ingest() { "$program" ingest "$@" "${store[@]}" -q >said 2>&1 || fail "$(cat said)"; }
export_to() { "$program" export "$@" "${store[@]}" 2>said; }

# Files in a folder of the caller; the umask and an old file's permissions count.
box a 10,20,0 >mine/a.city.jsonl
ingest mine/a.city.jsonl --collection one
(umask 027 && export_to one -o mine/one.city.jsonl) || fail "$(cat said)"
cmp mine/one.city.jsonl mine/a.city.jsonl
[ "$(stat -c '%a %u' mine/one.city.jsonl)" = "640 $(id -u)" ] || fail "$(stat -c '%a %u' mine/one.city.jsonl)"
export_to one -o mine/one.wt || fail "$(cat said)"
"$program" decode mine/one.wt -o mine/back.city.jsonl
cmp mine/back.city.jsonl mine/a.city.jsonl
export_to one -o - | cmp - mine/one.wt
none_left

# A failure leaves the old file and nothing else.
cp mine/one.wt mine/old.wt
! export_to none -o mine/old.wt || fail "exported a collection that is none"
cmp mine/old.wt mine/one.wt
! export_to none -o mine/new.wt || fail "exported a collection that is none"
[ ! -e mine/new.wt ] || fail "an export that failed left a file"
! export_to one -o mine/nowhere/new.wt || fail "wrote into a folder that is none"
grep -q 'mine/nowhere/new.wt: .*No such file' said || fail "$(cat said)"
none_left

# Documents with other transforms share a file; where no grid holds both there are several.
box b 30.5,20,7 ',"metadata":{"title":"b"}' >mine/b.city.jsonl
ingest mine/b.city.jsonl --collection one
export_to one -o mine/two.city.jsonl || fail "$(cat said)"
grep -q '2 features with 2 solids written, under one header for 2' said || fail "$(cat said)"
grep -q 'left out, because the headers differ in it: metadata/title' said || fail "$(cat said)"
grep -q '"vertices":\[\[20500,0,7000\]' mine/two.city.jsonl || fail "$(cat mine/two.city.jsonl)"
box c 0.12345678901,0,0 >mine/c.city.jsonl
ingest mine/c.city.jsonl --collection one
export_to one -o mine/parts.city.jsonl || fail "$(cat said)"
cmp mine/parts.city.jsonl mine/two.city.jsonl
cmp mine/parts-2.city.jsonl mine/c.city.jsonl
grep -q 'parts-2.city.jsonl: 1 feature with 1 solid written; a file of its own: no common grid' said || fail "$(cat said)"
[ "$(id -u)" -ne 0 ] || [ "$(stat -c %u mine/parts-2.city.jsonl)" = 0 ] || fail "another user's file"
! "$program" export one -o mine/none/parts.city.jsonl "${store[@]}" 2>said || fail "wrote into a folder that is none"
mkdir mine/blocked mine/blocked/x-2.city.jsonl
! export_to one -o mine/blocked/x.city.jsonl || fail "wrote over a folder"
[ ! -e mine/blocked/x.city.jsonl ] || fail "one file of two is left"
none_left

# GML and a mesh as CityJSONSeq: what the items of the collection are as CityJSON.
cp "$source/tests/data/gml/$(basename "$(find "$source/tests/data/gml" -name '*uilding*.gml' | LC_ALL=C sort | head -1)")" mine/city.gml
"$program" ingest mine/city.gml "${store[@]}" --collection gml --invalid keep -q >said 2>&1 || [ $? -eq 1 ] || fail "$(cat said)"
export_to gml -o mine/gml.city.jsonl || fail "$(cat said)"
"$program" validate -q mine/gml.city.jsonl >said 2>&1 || [ $? -eq 1 ] || fail "$(cat said)"
grep -q '"type":"Building"' mine/gml.city.jsonl || fail "$(head -c 2000 mine/gml.city.jsonl)"
echo 'SOLID Z((((0 0 0,0 1.25 0,1 0 0,0 0 0)),((0 0 0,1 0 0,0 0 1,0 0 0)),((0 0 0,0 0 1,0 1.25 0,0 0 0)),((1 0 0,0 1.25 0,0 0 1,1 0 0))))' >mine/house.wkt
ingest mine/house.wkt --collection mesh
export_to mesh -o mine/mesh.city.jsonl || fail "$(cat said)"
grep -q '1 feature came without a city model' said || fail "$(cat said)"
grep -q '"id":"house"' mine/mesh.city.jsonl || fail "$(cat mine/mesh.city.jsonl)"
echo "exports are the caller's files"
