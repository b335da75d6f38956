#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs PostgreSQL with the extension watertight in the foreground. The first start creates the
# cluster, the role and the database with the extension; later starts recover and run.
#   POSTGRES_PASSWORD   required at the first start: password of the role watertight (SCRAM)
#   POSTGRES_PORT       default 5432
#   POSTGRES_LISTEN     default '*'
#   POSTGRES_COORDINATOR  not empty at the first start: the database has the extension
#                       watertight_shards, and the role may make shards known to it
set -euo pipefail
data=/var/lib/postgresql/data
port=${POSTGRES_PORT:-5432}
bin=$(echo /usr/lib/postgresql/*/bin)
sockets=$(mktemp -d)

if [ ! -e "$data/ready" ]; then
  : "${POSTGRES_PASSWORD:?must be set at the first start}"
  # A start that was interrupted before it finished begins again: nothing was stored yet.
  find "$data" -mindepth 1 -delete
  "$bin/initdb" --pgdata="$data" --username=postgres --encoding=UTF8 --locale=C.UTF-8 \
    --auth-local=peer --auth-host=scram-sha-256 >/dev/null
  printf 'host all all all scram-sha-256\n' >>"$data/pg_hba.conf"
  "$bin/pg_ctl" --pgdata="$data" --wait --silent \
    --options="-c listen_addresses='' -c unix_socket_directories=$sockets -p $port" start >/dev/null
  "$bin/psql" -X -q -v ON_ERROR_STOP=1 -v password="$POSTGRES_PASSWORD" -h "$sockets" -p "$port" -d postgres <<'SQL'
CREATE ROLE watertight LOGIN PASSWORD :'password';
CREATE DATABASE watertight OWNER watertight ENCODING 'UTF8';
\connect watertight
CREATE EXTENSION watertight;
SQL
  if [ -n "${POSTGRES_COORDINATOR:-}" ]; then
    "$bin/psql" -X -q -v ON_ERROR_STOP=1 -h "$sockets" -p "$port" -d watertight <<'SQL'
SET client_min_messages = warning;
CREATE EXTENSION watertight_shards CASCADE;
GRANT USAGE ON FOREIGN DATA WRAPPER postgres_fdw TO watertight;
SQL
  fi
  "$bin/pg_ctl" --pgdata="$data" --wait --silent stop >/dev/null
  touch "$data/ready"
fi
exec "$bin/postgres" -D "$data" -p "$port" -c "listen_addresses=${POSTGRES_LISTEN:-*}" \
  -c "unix_socket_directories=$sockets"
