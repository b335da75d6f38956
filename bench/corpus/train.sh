#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Makes the corpus of GIS solids and trains the set of priors number 1.
#
#   bench/corpus/train.sh BIN DATA CORPUS [MODEL]
#
# BIN has make_corpus and train_models; DATA is the folder of data sets (bench/corpus/README.md lists them); CORPUS is
# written, and MODEL if given (codec/models/model-1.bin). Prints the table of train_models and, last, the arguments that
# name the unseen sets for `compare`.
set -euo pipefail
[ $# -ge 3 ] || { sed -n '3,9s/^# \{0,1\}//p' "$0" >&2 && exit 2; }
bin=$(realpath "$1")
corpus=$(realpath "$3")
model=${4:+$(realpath "$4")}
cd "$2"
unseen=(hamburg_576_5950 capetown_cput_surface capetown_cput_solid vienna_fichtegasse vienna_johannesgasse
  vienna_karl-marx-hof vienna_schoenbrunn vienna_vorwaertshaus)

"$bin/make_corpus" "$corpus" cityjson/*.city.json cityjson/3dbag_5870.city.jsonl \
  cityjson/delft_3dbag.city.jsonl cityjson/small/{3dbag_b2,amsterdam_underpass,sisteron}.city.jsonl \
  cityjson/small/{multi_lod,texture5}.city.json gml/hamburg* gml/nrw* gml/saxony* gml/ogc* \
  gml/small_delft* gml/small_sig*
options=()
for set in "${unseen[@]}"; do options+=(--exclude "$set"); done
"$bin/train_models" "$corpus" "${options[@]}" --meshes meshes ${model:+--out "$model"}
echo "${options[@]/--exclude/--unseen}"
