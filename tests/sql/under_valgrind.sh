#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs the regression tests of the extension in a server under Valgrind: under_valgrind.sh SOURCE BUILD [TEST...]
# Needs valgrind, and some ten minutes. Prints the differences to the expected answers (plans without parallel
# workers are some) and each memory error with the extension in its stack; fails if there is one, or if a server process
# ended otherwise than by its own will.
set -euo pipefail
# shellcheck source=tests/unprivileged.sh
. "$(dirname "$0")/../unprivileged.sh"
# shellcheck source=tests/sql/regression.sh
. "$(dirname "$0")/regression.sh"
source=$(cd "$1" && pwd)
build=$(cd "$2" && pwd)
shift 2
tests=("$@")
if [ $# -eq 0 ]; then tests=("${regression_tests[@]}"); fi
command -v valgrind >/dev/null || { echo "valgrind is missing (Debian: valgrind)"; exit 1; }

folder=$(mktemp -d /tmp/watertight-valgrind-XXXXXX)
server=
cleanup() {
  status=$?
  if [ -n "$server" ]; then kill -INT "$server" 2>/dev/null && wait "$server"; fi
  rm -rf "$folder"
  exit $status
}
trap cleanup EXIT

prepare "$source" "$build" "$folder"
mkdir "$folder/logs"
hand_over "$folder/logs"
"${as[@]}" valgrind --quiet --log-file="$folder/logs/%p" --num-callers=40 --error-limit=no \
  "$bin/postgres" -D "$folder/data" -c listen_addresses= -c unix_socket_directories="$folder/socket" -c fsync=off \
  >server.log 2>&1 &
server=$!
for _ in $(seq 300); do
  if run "$bin/pg_isready" -q -h "$folder/socket"; then break; fi
  sleep 0.5
done
if ! regress "${tests[@]}"; then
  cat regression.diffs
fi
kill -INT "$server"
wait "$server" || { tail -20 server.log; echo "the server failed"; exit 1; }
server=
if grep -E "was terminated by signal" server.log; then exit 1; fi
# Reports are blocks between lines that hold the number of the process alone.
reports=$(awk 'BEGIN { RS = "==[0-9]+== \n" } /watertight\.so/' logs/*)
if [ -n "$reports" ]; then
  echo "$reports"
  echo "the extension makes memory errors"
  exit 1
fi
echo "no memory error has the extension in its stack: ${tests[*]}; all reports: $(cat logs/* | grep -cE "^==[0-9]+== [A-Z]")"
