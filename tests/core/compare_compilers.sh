#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Builds the codec's core with g++ -O0, g++ Release and clang++ Release and compares the hashes of
# the blobs that the builds make.
# usage: compare_compilers.sh SOURCE_DIRECTORY WORK_DIRECTORY
# exit status: 0 equal, 1 different or a build failed, 77 clang++ is missing
set -eu

source_directory=$1
work_directory=$2
given_name=${3-}
given_hashes=${4-}

if ! command -v clang++ >/dev/null 2>&1; then
  echo "clang++ is not installed: nothing to compare with"
  exit 77
fi
mkdir -p "$work_directory"

# hash_build NAME CXX CC BUILD_TYPE: leaves the hashes in WORK_DIRECTORY/NAME.txt
hash_build() {
  if [ "$1" = "$given_name" ]; then
    "$given_hashes" >"$work_directory/$1.txt"
    return
  fi
  directory="$work_directory/$1"
  if ! {
    cmake -S "$source_directory" -B "$directory" -G Ninja -DCMAKE_CXX_COMPILER="$2" \
      -DCMAKE_C_COMPILER="$3" -DCMAKE_BUILD_TYPE="$4" -DWATERTIGHT_CORE_ONLY=ON \
      -DCMAKE_CXX_FLAGS_DEBUG=-O0 &&
      cmake --build "$directory" --target blob_hashes --parallel 2
  } >"$directory.log" 2>&1; then
    tail -n 40 "$directory.log"
    exit 1
  fi
  "$directory/bin/blob_hashes" >"$directory.txt"
}

hash_build gxx-release g++ gcc Release
hash_build gxx-debug g++ gcc Debug
hash_build clang-release clang++ clang Release

status=0
for other in gxx-debug clang-release; do
  if ! diff "$work_directory/gxx-release.txt" "$work_directory/$other.txt"; then
    echo "the blobs of g++ Release and $other differ"
    status=1
  fi
done
echo "$(wc -l <"$work_directory/gxx-release.txt") hashes compared between three builds"
exit "$status"
