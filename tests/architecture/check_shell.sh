#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Fails if shellcheck has anything to say about a shell script of the repository.
set -euo pipefail
cd "$(dirname "$0")/../.."
find . \( -name .git -o -name 'build*' -o -path ./data \) -prune -o -type f \
  \( -name '*.sh' -o -path './scripts/*' -o -path './.ci/*' \) -print0 |
  xargs -0 grep -lZE '^#!.*\b(ba|da)?sh\b' |
  xargs -0 --no-run-if-empty shellcheck --severity=style
