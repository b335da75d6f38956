#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Sends signals to the program while it starts and to its private PostgreSQL: signals.sh PROGRAM.
# Requires that a start ends within seconds, that the service comes back by itself and says how it
# is, and that children have neither secrets nor a way to privileges.
set -euo pipefail
# shellcheck source=tests/unprivileged.sh
. "$(dirname "$0")/../unprivileged.sh"
program=$(readlink -f "$1")
folder=$(mktemp -d /tmp/watertight-signals-XXXXXX)
service=
other=
cleanup() {
  status=$?
  for process in $service $other; do kill -KILL "$process" 2>/dev/null || true; done
  for _ in $(seq 50); do # the cluster ends a moment after its last user
    if rm -rf "$folder" 2>/dev/null; then break; fi
    sleep 0.1
  done
  exit $status
}
trap cleanup EXIT
fail() { echo "signals.sh: $*" >&2 && exit 1; }

hand_over "$folder"
cd "$folder"
store=(--data-dir "$folder/data")
postmaster() { head -1 "$folder/data/postgres/postmaster.pid"; }

# until_true SECONDS COMMAND...: waits until the command succeeds.
until_true() {
  local deadline=$((SECONDS + $1))
  shift
  until "$@"; do
    [ "$SECONDS" -le "$deadline" ] || return 1
    sleep 0.05
  done
}
# ends SECONDS PROCESS: waits for the end of a child and sets `ended` to its exit status.
ends() {
  until_true "$1" gone "$2" || fail "a process was there $1 s after its signal: $(cat said)"
  ended=0
  wait "$2" || ended=$?
}
gone() { ! kill -0 "$1" 2>/dev/null || grep -qs '^State:.Z' "/proc/$1/status"; }
status_of() { curl -s -o answer -w '%{http_code}' --max-time 3 "$url$1" || true; }
probe() { [ "$(curl -s -o answer -w '%{http_code}' --max-time 3 "$probes$1")" = "$2" ]; }
answers() { [ "$(status_of "$1")" = "$2" ]; }
is_new() { [ -e data/postgres/postmaster.pid ] && [ "$(postmaster)" != "$server" ]; }
start_service() {
  rm -f listening said
  (ulimit -Sn 256 && exec "${as[@]}" env WATERTIGHT_DATABASE_URL= TOKEN=a-secret "$program" serve "${store[@]}" \
    --listen 127.0.0.1:0 --probes 127.0.0.1:0 >listening 2>said) &
  service=$!
  until_true 60 grep -qs http listening || fail "$(cat said)"
  url=$(sed -n 's/^listening on //p' listening)
  until_true 5 grep -qs event=probes said || fail "no address of the probes: $(cat said)"
  probes=$(sed -n 's/.*event=probes url=//p' said)
}
echo 'SOLID Z((((0 0 0,0 1 0,1 0 0,0 0 0)),((0 0 0,1 0 0,0 0 1,0 0 0)),((0 0 0,0 0 1,0 1 0,0 0 0)),((1 0 0,0 1 0,0 0 1,1 0 0))))' >a.wkt
chmod a+r a.wkt

# A signal while the first cluster is made.
for signal in TERM INT HUP; do
  "${as[@]}" "$program" serve "${store[@]}" --listen 127.0.0.1:0 >listening 2>said &
  service=$!
  until_true 10 test -e data/postgres.new || fail "no cluster is made: $(cat said)"
  kill -"$signal" "$service"
  ends 3 "$service"
  service=
  [ "$ended" -eq 0 ] || fail "SIG$signal at the start ended the service with $ended: $(cat said)"
  grep -q 'stopped while' said || fail "SIG$signal at the start said: $(cat said)"
  [ ! -e data/postgres.new ] || fail "a start that was stopped left files"
done

# A signal while another process holds the lock, to the service and to the commands.
"${as[@]}" bash -c 'exec 9<>data/cluster.lock && flock 9 && exec sleep 60' &
other=$!
sleep 0.3
for command in serve 'ingest a.wkt --collection c' 'export c -o c.wt'; do
  rm -f said
  # shellcheck disable=SC2086 # the command is several words
  "${as[@]}" "$program" $command "${store[@]}" >listening 2>said &
  waiting=$!
  until_true 10 grep -qs 'waiting: another process starts or stops the private database' said ||
    fail "$command does not say what it waits for: $(cat said)"
  kill -TERM "$waiting"
  ends 3 "$waiting"
  grep -q 'stopped while' said || fail "$command said: $(cat said)"
  [ "$command" != serve ] || [ "$ended" -eq 0 ] || fail "serve ended with $ended"
  [ "$command" = serve ] || [ "$ended" -eq 2 ] || fail "$command ended with $ended"
done
kill "$other"
wait "$other" 2>/dev/null || true
other=

start_service
until_true 5 answers /readyz 200 || fail "not ready: $(cat answer)"
probe /readyz 200 || fail "the address of the probes says not ready: $(cat answer)"
probe /collections 404 || fail "the address of the probes answers more than probes: $(cat answer)"

# What children see, and what nobody can get.
server=$(postmaster)
run cat "/proc/$server/environ" | tr '\0' '\n' >environment
grep -qx LC_ALL=C environment || fail "PostgreSQL has another environment: $(cat environment)"
! grep -q a-secret environment || fail "PostgreSQL sees the service's secrets"
for process in "$service" "$server"; do
  grep -Eq '^NoNewPrivs:.1$' "/proc/$process/status" || fail "$(cat "/proc/$process/comm") can gain privileges"
done
run cat "/proc/$service/limits" | awk '/^Max open files/ { exit $4 != $5 }' || fail "few files may be open"

# Signals without a meaning do nothing.
kill -USR1 "$service"
kill -USR2 "$service"
sleep 0.2
answers /healthz 200 || fail "SIGUSR1 or SIGUSR2 ended the service"

# A smart shutdown of the database: reads are back in seconds, and a command that starts meanwhile works.
run "$program" ingest a.wkt "${store[@]}" --collection c -q >/dev/null
for _ in 1 2 3 4 5 6; do curl -s -o /dev/null "$url/collections/c/items" & done # sessions of the pool
sleep 1
kill -TERM "$server"
run timeout 20 "$program" ingest a.wkt "${store[@]}" --collection c -q >/dev/null || fail "ingest hung or failed"
until_true 5 answers /collections/c/items 200 || fail "no read after a smart shutdown: $(cat answer)"
until_true 5 answers /readyz 200 || fail "not ready after a smart shutdown: $(cat answer)"
is_new || fail "the server that shut down is still there"
server=$(postmaster)
kill -TERM "$server" # once more, without a command that helps
until_true 5 is_new || fail "no new server after a smart shutdown"
until_true 5 grep -q 'the private database is back' said || fail "nothing was said: $(cat said)"
until_true 5 answers /readyz 200 || fail "not ready after a smart shutdown: $(cat answer)"

# A stopped postmaster: sessions of the pool go on, but the service is not ready.
server=$(postmaster)
kill -STOP "$server"
until_true 6 answers /readyz 503 || fail "ready with a stopped postmaster"
answers /healthz 200 || fail "not healthy with a stopped postmaster"
probe /healthz 200 || fail "the probes say not healthy with a stopped postmaster"
probe /readyz 503 || fail "the probes say ready with a stopped postmaster"
kill -CONT "$server"
until_true 6 answers /readyz 200 || fail "not ready after SIGCONT: $(cat answer)"

kill -KILL "$server"
until_true 5 is_new || fail "no new server after SIGKILL"
until_true 5 answers /readyz 200 || fail "not ready after SIGKILL: $(cat answer)"

# A closed terminal stops the service; nohup keeps it.
kill -HUP "$service"
ends 10 "$service"
service=
[ "$ended" -eq 0 ] || fail "SIGHUP ended the service with $ended: $(cat said)"
[ ! -e data/postgres/postmaster.pid ] || fail "the database outlived the service"
trap '' HUP
start_service
trap - HUP
kill -HUP "$service"
sleep 0.5
answers /healthz 200 || fail "SIGHUP ended a service that ignores it"
kill -TERM "$service"
ends 10 "$service"
service=
[ "$ended" -eq 0 ] || fail "SIGTERM ended the service with $ended: $(cat said)"

# A second signal ends a start at once. This start waits for a server that a killed service left.
start_service
kill -KILL "$service"
wait "$service" 2>/dev/null || true
server=$(postmaster)
kill -STOP "$server"
rm said
"${as[@]}" "$program" serve "${store[@]}" --listen 127.0.0.1:0 >listening 2>said &
service=$!
until_true 10 grep -qs 'waiting: the private database does not answer' said || fail "$(cat said)"
kill -TERM "$service"
sleep 0.3
kill -TERM "$service"
ends 1 "$service"
service=
[ "$ended" -eq 1 ] || fail "a second signal ended the start with $ended: $(cat said)"
kill -CONT "$server"
start_service
! is_new || fail "the server that was left is not used"
kill -TERM "$service"
ends 10 "$service"
service=

# As root, too few files are no missing user.
if [ "$(id -u)" -eq 0 ]; then
  mkdir -m 755 root && cp a.wkt root/
  for i in $(seq 30); do echo "root/$i.wkt"; cp a.wkt "root/$i.wkt"; done >names
  # shellcheck disable=SC2046 # many names
  ! (ulimit -n 20; "$program" ingest $(cat names) --data-dir "$folder/roots" --collection c) >/dev/null 2>many ||
    fail "30 files were opened with 20 descriptors"
  ! grep -q "there is no user" many || fail "$(cat many)"
fi
echo "starts, smart shutdown, stop, kill and signals as documented"
