#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# To be sourced by tests that start a PostgreSQL, which refuses root: if the script runs as root,
# `hand_over FOLDER` gives the folder to another user, and from then on `run COMMAND...` runs
# commands as that user. In the background write "${as[@]}" COMMAND... & instead: then $! is the id
# of the command's process.
as=()
run() { "${as[@]}" "$@"; }
hand_over() {
  [ "$(id -u)" -eq 0 ] || return 0
  local user
  for user in postgres nobody; do
    if id "$user" >/dev/null 2>&1; then break; fi
  done
  as=(setpriv --reuid="$user" --regid="$(id -g "$user")" --clear-groups env HOME="$1")
  chown -R "$user:" "$1"
}
