#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Fails if a JavaScript file of the repository does not parse. Exit status 77: no Node.js.
set -euo pipefail
cd "$(dirname "$0")/../.."
if ! command -v node >/dev/null; then
  echo "no node"
  exit 77
fi
mapfile -d '' files < <(find . \( -name .git -o -name 'build*' -o -path ./data -o -name node_modules \) -prune -o \
  -type f -name '*.js' -print0)
for file in "${files[@]}"; do node --check "$file"; done
echo "node --check: ${#files[@]} files"
[ ${#files[@]} -gt 0 ]
