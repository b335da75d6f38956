#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Fails, naming the places, if clang-format would change a C++ or JavaScript file of the repository.
# (The one C file, which includes PostgreSQL's headers, follows PostgreSQL's style.)
#   check_format.sh         checks
#   check_format.sh --fix   formats in place
set -euo pipefail
cd "$(dirname "$0")/../.."
clang_format=$(command -v clang-format-14 || command -v clang-format)
mapfile -d '' files < <(find . \( -name .git -o -name 'build*' -o -path ./data -o -name node_modules -o -path ./web/dist \) -prune -o \
  -type f \( -name '*.h' -o -name '*.cpp' -o -name '*.js' \) -print0)
# One process for all files: it starts slowly.
if [ "${1:-}" = --fix ]; then exec "$clang_format" --style=file -i "${files[@]}"; fi
"$clang_format" --style=file --dry-run -Werror "${files[@]}" ||
  { echo "clang-format: run tests/architecture/check_format.sh --fix" && exit 1; }
echo "clang-format: ${#files[@]} files"
