#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# make_container_seeds.sh WATERTIGHT: writes the seeds of fuzz_container that are whole files again,
# after a change of the file. (The seeds *.part are texts, pages and blobs, made by hand.)
set -eu
watertight=$1
tests=$(cd "$(dirname "$0")/.." && pwd)
seeds="$tests/fuzz/seeds/container"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# encode NAME DOCUMENT OPTION...: exit status 1 says that something is kept unproven
encode() {
  name=$1 document=$2
  shift 2
  "$watertight" encode "$document" -o "$folder/x.wt" --invalid keep "$@" >/dev/null 2>&1 || [ $? -eq 1 ]
  mv "$folder/x.wt" "$seeds/$name.watertight"
}
encode 3dbag_b2 "$tests/data/cityjson/3dbag_b2.city.jsonl"
encode cube5 "$tests/data/cityjson/cube10.json"
encode twocubes "$tests/golden/solids/bodies-share-face.city.json" --for ranges
encode houses "$tests/data/cityjson/denhaag_random_5.city.jsonl" --for ranges
encode own_lattices "$tests/fuzz/seeds/gml/own_lattices.gml"

cp "$seeds/houses.watertight" "$folder/appended.wt"
"$watertight" append "$folder/appended.wt" "$tests/data/cityjson/3dbag_b2.city.jsonl" --invalid keep >/dev/null 2>&1 || [ $? -eq 1 ]
cp "$folder/appended.wt" "$seeds/appended.watertight"
size=$(wc -c <"$folder/appended.wt")
head -c $((size - 40)) "$folder/appended.wt" >"$seeds/torn.watertight"
