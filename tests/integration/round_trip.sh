#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Builds the images with podman, starts database and service by docker/compose.test.yaml, and runs
# round_trip.py against them: the images are installed from a file, a tile is stored by REST, read by REST and by SQL, and compared
# exactly; the database is killed while features are stored. Then a table is spread over the shards of
# docker/shards.compose.yaml. Removes everything that it started, in
# any case. Needs root and the packages of `scripts/install-dependencies containers`.
set -euo pipefail
cd "$(dirname "$0")/../.."
export CONTAINERS_CONF=$PWD/docker/containers.conf
[ "$(id -u)" -eq 0 ] || { echo "round_trip: podman needs root here" >&2; exit 1; }

project=watertight-test-$$
folder=$(mktemp -d)
# A bridge network turns on the forwarding of packets; the old setting is restored at the end.
forwarding=$(cat /proc/sys/net/ipv4/ip_forward)
free_port() { python3 -c 'import socket; s=socket.socket(); s.bind(("127.0.0.1",0)); print(s.getsockname()[1])'; }
POSTGRES_PASSWORD=$(head -c 18 /dev/urandom | base64 | tr -d '+/=')
POSTGRES_PORT=$(free_port)
SERVICE_PORT=$(free_port)
export POSTGRES_PASSWORD POSTGRES_PORT SERVICE_PORT
COORDINATOR_PORT=$(free_port)
export COORDINATOR_PORT WATERTIGHT_POSTGRES_IMAGE=localhost/watertight-postgres:test
compose() { podman-compose --project-name "$project" --file docker/compose.test.yaml "$@"; }
shards() { podman-compose --project-name "$project-shards" --file docker/shards.compose.yaml "$@"; }

clean_up() {
  status=$?
  if [ $status -ne 0 ]; then
    for name in db service; do
      echo "--- last lines of $name"
      podman logs --tail 40 "${project}_${name}_1" 2>&1 || true
    done
  fi
  compose down --volumes --timeout 5 >"$folder/down.log" 2>&1 || cat "$folder/down.log"
  shards down --volumes --timeout 5 >"$folder/down.log" 2>&1 || cat "$folder/down.log"
  podman network rm --force "${project}_default" "$project-shards_default" >/dev/null 2>&1 || true
  [ "$forwarding" != 0 ] || echo 0 >/proc/sys/net/ipv4/ip_forward || true
  rm -rf "$folder"
}
trap clean_up EXIT

scripts/make-base-image
# The builds use the host's compiler cache, if there is one: compiler and flags are the same, so
# most units are found in it.
cache=$(ccache --get-config cache_dir 2>/dev/null || true)
volumes=()
if [ -n "$cache" ]; then
  mkdir -p "$cache"
  volumes=(--volume "$cache:/ccache")
fi
for target in service postgres; do
  echo "building the image watertight-$target"
  podman build --network=host "${volumes[@]}" --build-arg "CMAKE_OPTIONS=${WATERTIGHT_CMAKE_OPTIONS:-}" --file docker/Dockerfile --target "$target" \
    --tag "localhost/watertight-$target:test" . >"$folder/build.log" 2>&1 ||
    { tail -60 "$folder/build.log"; exit 1; }
done

# The images are installed as on a machine that has none: from a file, in less than a minute until the service is ready.
images=(localhost/watertight-service:test localhost/watertight-postgres:test)
podman save --quiet --multi-image-archive --output "$folder/images.tar" "${images[@]}"
podman rmi --force "${images[@]}" >/dev/null
begin=$(date +%s)
podman load --quiet --input "$folder/images.tar" >/dev/null

# The exit status of `compose up` is ignored; both containers must run.
compose up --detach --no-build >"$folder/up.log" 2>&1 || true
for name in db service; do
  podman container exists "${project}_${name}_1" || { cat "$folder/up.log"; exit 1; }
done
for _ in $(seq 120); do ! curl -fsS -o "$folder/ready" "http://127.0.0.1:$SERVICE_PORT/readyz" 2>/dev/null || break; sleep 0.5; done
seconds=$(($(date +%s) - begin))
echo "the images are installed and the service is ready after $seconds s"
if [ ! -s "$folder/ready" ] || [ "$seconds" -ge 60 ]; then echo "round_trip: that takes a minute or longer" >&2 && exit 1; fi
python3 tests/integration/round_trip.py --service "http://127.0.0.1:$SERVICE_PORT" \
  --database "postgresql://watertight:$POSTGRES_PASSWORD@127.0.0.1:$POSTGRES_PORT/watertight" \
  --kill "podman kill -s KILL ${project}_db_1" --start "podman start ${project}_db_1" \
  --tile examples/delft.city.jsonl --invalid examples/invalid.city.jsonl
for name in db service; do
  podman healthcheck run "${project}_${name}_1" || { echo "round_trip: $name is not healthy" >&2; exit 1; }
done
compose down --volumes --timeout 5 >"$folder/down.log" 2>&1

# The exit status of `compose up` is ignored here too.
shards up --detach --no-build >"$folder/up.log" 2>&1 || true
for name in coordinator east west; do
  podman container exists "${project}-shards_${name}_1" || { cat "$folder/up.log"; exit 1; }
done
coordinator() {
  psql -X -q -At -v ON_ERROR_STOP=1 -v password="$POSTGRES_PASSWORD" \
    "postgresql://watertight:$POSTGRES_PASSWORD@127.0.0.1:$COORDINATOR_PORT/watertight" "$@"
}
tries=0
until coordinator -f docker/shards.sql >"$folder/shards.log" 2>&1; do
  tries=$((tries + 1))
  [ $tries -lt 120 ] || { cat "$folder/shards.log"; echo "round_trip: the shards do not answer" >&2; exit 1; }
  sleep 1
done
coordinator -c "CREATE TABLE city (id text NOT NULL, shape solid) PARTITION BY HASH (id)" -c "SELECT wt_spread('city', 4, '{east,west}')"
stored=$(build/release/bin/watertight rows examples/delft.city.jsonl | coordinator \
  -c "CREATE TEMP TABLE delivered (feature text, object text, lod text, ewkb bytea)" -c "COPY delivered FROM STDIN" \
  -c "SELECT count(*), sum(stored) FROM wt_load('city', 'SELECT object || lod AS id, ewkb AS shape FROM delivered', skip_invalid => true)" \
  -c "SELECT count(shape), round(sum(wt_volume(shape))) FROM city")
[ "$stored" = "$(printf '2|470\n470|1314329')" ] || { echo "round_trip: the shards have something else: $stored" >&2; exit 1; }
echo "470 solids were spread over two shards"
