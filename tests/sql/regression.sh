#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# To be sourced by scripts that run the regression tests of the extension, after unprivileged.sh. `prepare SOURCE BUILD
# FOLDER` makes a server's programs, its data and the tests in a folder, whose owner the server runs as, and goes there;
# `regress TEST...` then runs tests in the server whose socket is in FOLDER/socket.
# shellcheck disable=SC2034  # the sourcing scripts use these
regression_tests=(city functions encode repairs curved hostile helpers limits rules solid solid_index solid_pairs)

prepare() {
  folder=$3
  bin=$("$1/scripts/relocated-postgres" "$2" "$folder/prefix")
  cp -r "$1/tests/sql/sql" "$1/tests/sql/expected" "$folder/"
  mkdir "$folder/socket" "$folder/crashing" "$folder/hanging"
  printf '#!/bin/sh\nkill -SEGV $$\n' >"$folder/crashing/watertight-worker"
  cp "$(command -v sleep)" "$folder/hanging/sleep"
  printf '#!/bin/sh\nexec %s 600\n' "$folder/hanging/sleep" >"$folder/hanging/watertight-worker"
  local fake
  for fake in crashing hanging; do
    chmod +x "$folder/$fake/watertight-worker"
    cp "$folder/$fake/watertight-worker" "$folder/$fake/watertight-tetgen"
  done
  hand_over "$folder"
  chmod 0700 "$folder"
  cd "$folder" || exit
  run "$bin/initdb" -D "$folder/data" -N --username=watertight --encoding=UTF8 --no-locale \
    --auth=trust >"$folder/initdb.log" || { cat "$folder/initdb.log"; exit 1; }
}

regress() {
  run env LD_LIBRARY_PATH= PGTZ=UTC "$(dirname "$(pg_config --pgxs)")/../test/regress/pg_regress" \
    --inputdir="$folder" --outputdir="$folder" --bindir="$bin" --host="$folder/socket" --user=watertight \
    --load-extension=watertight "$@"
}
