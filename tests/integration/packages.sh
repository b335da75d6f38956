#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Builds the Debian packages from a finished build and uses them on a clean Debian 12: packages.sh BUILD_FOLDER
# Installs them with apt, builds a program with the library, judges an example, runs the service as its own user with the file of options of the
# package, calls it from SQL, and removes it: the data stay. Needs root and the packages of
# `scripts/install-dependencies containers`.
set -euo pipefail
build=$(realpath "$1")
cd "$(dirname "$0")/../.."
export CONTAINERS_CONF=$PWD/docker/containers.conf
[ "$(id -u)" -eq 0 ] || { echo "packages: podman needs root here" >&2; exit 1; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

cpack --config "$build/CPackConfig.cmake" -B "$folder" >"$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }
rm -rf "$folder/_CPack_Packages"
scripts/make-base-image
cat >"$folder/use" <<'USE'
set -euo pipefail
check() { if "${@:2}"; then echo "ok: $1"; else echo "WRONG: $1"; exit 1; fi; }
export DEBIAN_FRONTEND=noninteractive
apt-get update -qq
apt-get install -y -qq --no-install-recommends postgresql-15 curl bash-completion g++ cmake make pkg-config libgmp-dev libmpfr-dev \
  libexpat1-dev libzstd-dev >/dev/null 2>&1 # of Debian, not timed
start=$(date +%s)
apt-get install -y -qq --no-install-recommends /packages/*.deb >/dev/null 2>&1
seconds=$(($(date +%s) - start))
echo "installed in $seconds s"
check "the installation takes less than a minute" [ "$seconds" -lt 60 ]
status=0
watertight validate /examples/invalid.city.jsonl >/tmp/report || status=$?
check "the program judges an example" [ "$status" -eq 1 ]
status=0
watertight validate -q --proof tetrahedralization /examples/delft.city.jsonl >/tmp/report || status=$?
check "with its engines" [ "$status" -eq 1 ]
check "there is a manual page" grep -q man1/watertight.1 <(dpkg -L watertight) # slim images leave it out
check "a program is built with the library by CMake" \
  sh -c 'cmake -S /examples/library -B /tmp/library >/dev/null && cmake --build /tmp/library >/dev/null'
g++ -std=c++20 /examples/library/main.cpp $(pkg-config --cflags --libs watertight) -o /tmp/program
check "and by pkg-config" [ -x /tmp/program ]
status=0
/tmp/program /examples/delft.city.jsonl >/tmp/one || status=$?
check "its exit status says that not all is valid" [ "$status" -eq 1 ]
status=0
/tmp/library/solids_of_a_city /examples/delft.city.jsonl >/tmp/two || status=$?
check "so does that of the other" [ "$status" -eq 1 ]
check "it judges and packs a city" grep -q '^470 of 480 solids are valid' /tmp/one
check "both do the same" cmp -s /tmp/one /tmp/two
completed=$(bash -c '. /usr/share/bash-completion/completions/watertight; COMP_WORDS=(watertight inge) COMP_CWORD=1
  _watertight; echo "${COMPREPLY[*]}"; COMP_WORDS=(watertight serve --tls) COMP_CWORD=2; _watertight; echo "${COMPREPLY[*]}"')
check "bash completes commands and options" [ "$completed" = "$(printf 'ingest\n--tls-certificate --tls-key')" ]
check "the user of the service exists" id -u watertight >/dev/null
unit=/lib/systemd/system/watertight.service
command=$(sed -n 's/^ExecStart=//p' "$unit")
install -d -o watertight -g watertight /var/lib/watertight # as StateDirectory= does
watertight key editor --scope write --keys /etc/watertight/keys >/tmp/key
sed -i 's/^# keys/keys/' /etc/watertight/serve.toml
setpriv --reuid=watertight --regid=watertight --clear-groups --no-new-privs $command >/tmp/out 2>/tmp/log &
for _ in $(seq 100); do grep -q listening /tmp/out && break; sleep 0.3; done
url=$(sed -n 's/^listening on //p' /tmp/out)
check "the service starts by the command of its unit" curl -fsS -o /dev/null "$url/readyz"
code=$(curl -s -o /dev/null -w '%{http_code}' "$url/collections")
check "its file of options counts" [ "$code" = 401 ]
curl -fsS -u ":$(cat /tmp/key)" -H 'Content-Type: application/city+json-seq' \
  --data-binary @/examples/delft.city.jsonl "$url/collections/delft/items?invalid=keep" >/tmp/stored
check "it stores a city" grep -q '"stored":159' /tmp/stored
kill %1
wait %1
pg_ctlcluster 15 main start
as_postgres() { setpriv --reuid=postgres --regid=postgres --clear-groups psql -X -q -A -t -c "$1"; }
as_postgres 'CREATE EXTENSION watertight'
version=$(as_postgres "SELECT extversion FROM pg_extension WHERE extname = 'watertight'")
check "PostgreSQL has the extension ($version)" [ -n "$version" ]
pg_ctlcluster 15 main stop
apt-get remove -y -qq watertight postgresql-15-watertight libwatertight-dev >/dev/null 2>&1
check "the packages can be removed" [ ! -e /usr/bin/watertight ]
check "the data stay" [ -d /var/lib/watertight/data ]
USE
podman run --rm --network=host --init --volume "$folder:/packages:ro" --volume "$PWD/examples:/examples:ro" \
  debian:bookworm-slim bash /packages/use
