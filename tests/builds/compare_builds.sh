#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Builds the whole program in several ways and compares the fingerprints: hashes of blobs, reports
# and verdicts of generated solids and of the documents named.
# usage: compare_builds.sh SOURCE_DIRECTORY RELEASE_BUILD_DIRECTORY [DOCUMENT...]
# exit status: 0 equal, 1 different or a build failed, 77 clang++ is missing
set -eu

source_directory=$1
release=$2
work_directory=$2/builds
shift 2

if ! command -v clang++ >/dev/null 2>&1; then
  echo "clang++ is not installed: nothing to compare with"
  exit 77
fi
mkdir -p "$work_directory"
# looking for leaks takes seconds at the exit; the tests of that build do it
export ASAN_OPTIONS=detect_leaks=0

# print_fingerprint NAME BUILD_DIRECTORY DOCUMENT...: writes the fingerprint to
# WORK_DIRECTORY/NAME.txt
print_fingerprint() {
  name=$1
  program=$2/bin/build_fingerprint
  shift 2
  if ! "$program" "$@" >"$work_directory/$name.txt" 2>"$work_directory/$name.log"; then
    echo "$name: the program failed"
    tail -n 40 "$work_directory/$name.log"
    exit 1
  fi
}

# build NAME BUILD_DIRECTORY CMAKE_OPTION...: configures and builds the program. A compiler
# reads several files of a folder as one, which takes a third of the time.
build() {
  name=$1
  directory=$2
  shift 2
  if ! {
    cmake -S "$source_directory" -B "$directory" -G Ninja -DWATERTIGHT_BENCH=OFF -DCMAKE_UNITY_BUILD=ON "$@" &&
      cmake --build "$directory" --target build_fingerprint --parallel 2
  } >"$work_directory/$name.log" 2>&1; then
    echo "$name: the build failed"
    tail -n 40 "$work_directory/$name.log"
    exit 1
  fi
}

# One build for both: without optimization no function is inlined, so that a linker chooses one of two
# definitions of a name, and with -flto it compares them (-Wodr). It links on one core.
build gxx-O0-LTO "$work_directory/gxx-O0-LTO" -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O0 \
  -DCMAKE_INTERPROCEDURAL_OPTIMIZATION=ON -DWATERTIGHT_ENGINES=OFF &
background=$!
# another compiler and another level: -Os chooses other functions to inline than -O3
build clang-Os "$work_directory/clang-Os" -DCMAKE_BUILD_TYPE=MinSizeRel -DWATERTIGHT_SERVER=OFF \
  -DWATERTIGHT_ENGINES=OFF -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_C_COMPILER=clang
wait "$background"
# the engines are not compared: these builds use those of the release build
for engine in watertight-worker watertight-tetgen; do
  ln -sf "$release/bin/$engine" "$work_directory/gxx-O0-LTO/bin/"
  ln -sf "$release/bin/$engine" "$work_directory/clang-Os/bin/"
done
build gxx-checked "$source_directory/build/checked" --preset checked

directory_of() {
  case $1 in
    gxx-O3) echo "$release" ;;
    gxx-checked) echo "$source_directory/build/checked" ;;
    *) echo "$work_directory/$1" ;;
  esac
}

# print_two NAME NAME DOCUMENT...: at the same time, as each uses one core
print_two() {
  first=$1
  second=$2
  shift 2
  print_fingerprint "$first" "$(directory_of "$first")" "$@" &
  background=$!
  print_fingerprint "$second" "$(directory_of "$second")" "$@"
  wait "$background"
}

print_two gxx-O0-LTO gxx-checked "$@" # those that take longest
print_two gxx-O3 clang-Os "$@"
status=0
for other in gxx-checked gxx-O0-LTO clang-Os; do
  if ! diff "$work_directory/gxx-O3.txt" "$work_directory/$other.txt"; then
    echo "the fingerprints of gxx-O3 and $other differ"
    status=1
  fi
done
echo "$(wc -l <"$work_directory/gxx-O3.txt") lines compared between four builds"
exit "$status"
