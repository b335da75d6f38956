#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# exact_files.sh WATERTIGHT FILE...: encodes each document, decodes it, and compares the bytes.
# Prints the bytes of the file, of the Watertight file, and of the file under xz -9 and zstd -19.
# Exit status: 1 if a document did not come back. Documents that encode refuses are counted.
set -u
watertight=$1
shift
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
same=0 other=0 refused=0
printf '%10s %10s %10s %10s  %s\n' bytes .wt xz-9 zstd-19 file
for file in "$@"; do
  back="$folder/back.${file##*.}"
  if ! "$watertight" encode "$file" -o "$folder/x.wt" >/dev/null 2>&1; then
    refused=$((refused + 1))
    continue
  fi
  if "$watertight" decode "$folder/x.wt" -o "$back" && cmp -s "$file" "$back"; then
    same=$((same + 1))
  else
    other=$((other + 1))
    echo "DIFFERENT: $file"
  fi
  printf '%10d %10d %10d %10d  %s\n' "$(wc -c <"$file")" "$(wc -c <"$folder/x.wt")" \
    "$(xz -9 -c "$file" | wc -c)" "$(zstd -19 -q -c "$file" | wc -c)" "${file##*/}"
done
echo "$same documents came back, $other did not, encode refused $refused"
[ "$other" -eq 0 ]
