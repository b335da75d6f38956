#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Fuzzes each harness of a build of preset "fuzz" for a while, from its seeds.
#
#   tests/fuzz/smoke.sh BUILD SECONDS [NAME...]     e.g. build/fuzz 40 city_json wkt
#
# Corpora grow in BUILD/corpora/NAME; logs and finds are BUILD/corpora/NAME.log and NAME-crash-*.
# Prints one line for each harness. Exit status: 0 only if none found anything.
set -euo pipefail
[ $# -ge 2 ] || { sed -n '3,8s/^# \{0,1\}//p' "$0" >&2 && exit 2; }
build=$1
seconds=$2
shift 2
here=$(dirname "$0")
names=("$@")
if [ ${#names[@]} -eq 0 ]; then
  for source in "$here"/fuzz_*.cpp "$here"/*/fuzz_*.cpp; do
    source=${source##*/fuzz_}
    names+=("${source%.cpp}")
  done
fi

status=0
for name in "${names[@]}"; do
  corpus=$build/corpora/$name
  mkdir -p "$corpus"
  while read -r seed; do
    folder=${seed%/*} # golden files of several versions have the same names
    cp "$seed" "$corpus/seed-${folder##*/}-${seed##*/}"
  done <"$build/tests/fuzz/$name.seeds"
  options=(-max_total_time="$seconds" -max_len=32768 -timeout=600 -rss_limit_mb=2048
    -artifact_prefix="$build/corpora/$name-" -print_final_stats=1)
  case $name in
    city_json* | skeleton | rows | json_fg) options+=(-dict="$here/json.dict") ;;
    gml) options+=(-dict="$here/xml.dict") ;;
    texts) options+=(-max_len=4096) ;; # a run of longer ones takes seconds
  esac
  result=clean
  "$build/bin/fuzz_$name" "${options[@]}" "$corpus" >"$corpus.log" 2>&1 || { result=FIND && status=1; }
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$corpus.log")
  coverage=$(sed -nE 's/.* cov: ([0-9]+) .*/\1/p' "$corpus.log" | tail -n 1)
  printf '%-14s %5s seeds %9s runs %6s edges  %s\n' "$name" \
    "$(wc -l <"$build/tests/fuzz/$name.seeds")" "${runs:-?}" "${coverage:-?}" "$result"
done
exit $status
