#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The extension in the PostgreSQL of Debian 13: newer_postgres.sh SOURCE BUILD DEBIAN_MIRROR
# The C files are compiled against its headers and linked with the library of BUILD; the server of that Debian, in a root
# folder of its own, must give the answers of tests/sql/expected. Needs root and mmdebstrap. Exit code 77 without them.
set -euo pipefail
source=$(cd "$1" && pwd)
build=$(cd "$2" && pwd)
mirror=$3
version=17
tests=(functions encode hostile helpers limits rules solid solid_index solid_pairs)
if [ "$(id -u)" -ne 0 ] || ! command -v mmdebstrap >/dev/null; then
  echo "needs root and mmdebstrap"
  exit 77
fi

folder=$(mktemp -d /tmp/watertight-newer-XXXXXX)
root=$folder/root
as_postgres() {
  chroot "$root" setpriv --reuid=postgres --regid=postgres --clear-groups \
    env --chdir=/srv/regress PGTZ=UTC PG_ABS_SRCDIR=/srv/regress PG_ABS_BUILDDIR=/srv/regress "$@"
}
bin=/usr/lib/postgresql/$version/bin
helpers=/usr/lib/postgresql/$version/libexec/watertight
# shellcheck disable=SC2317 # called by the trap
cleanup() {
  status=$?
  if [ -f "$root/srv/regress/data/postmaster.pid" ]; then
    as_postgres "$bin/pg_ctl" -D /srv/regress/data -m immediate -s stop || status=1
  fi
  rm -rf "$folder"
  exit "$status"
}
trap cleanup EXIT

# The package with the headers would bring a compiler along: it is taken apart instead.
mmdebstrap --quiet --variant=apt --include="postgresql-$version,libproj25,proj-data" --aptopt='APT::Install-Recommends false' \
  --customize-hook="chroot \"\$1\" sh -c 'apt-get update -qq && cd /tmp && apt-get -o APT::Sandbox::User=root download -qq postgresql-server-dev-$version && dpkg-deb -x postgresql-server-dev-$version*.deb /'" \
  trixie "$root" "$mirror"

# compile COMMAND-LINE: as the build does, but with the newer headers and into the folder.
mkdir "$folder/objects"
own=$(pg_config --includedir-server)
ninja -C "$build" -t commands extension/watertight.so | grep -E 'sql/module/[a-z_]+\.c$|extension/watertight\.so' |
  sed -E "s, $own, $root/usr/include/postgresql/$version/server,; s, -MD -MT [^ ]+ -MF [^ ]+,,
          s,[^ ]*watertight_extension\.dir/module/([a-z_]+)\.c\.o,$folder/objects/\1.o,g; s,-o extension/watertight\.so,-o $folder/objects/watertight.so," \
    >"$folder/commands"
[ "$(wc -l <"$folder/commands")" -eq $(($(find "$source/sql/module" -name '*.c' | wc -l) + 1)) ] ||
  { echo "other commands than expected build the extension:"; cat "$folder/commands"; exit 1; }
(cd "$build" && bash -e "$folder/commands")

install -m 644 "$folder/objects/watertight.so" "$root/usr/lib/postgresql/$version/lib/"
cp "$source"/sql/watertight*.control "$source"/sql/watertight*--*.sql "$root/usr/share/postgresql/$version/extension/"
mkdir -p "$root$helpers"
for helper in watertight-worker watertight-tetgen; do
  if [ -x "$build/bin/$helper" ]; then cp "$build/bin/$helper" "$root$helpers/"; fi
done
# Libraries that Debian 13 has in another version, or not at all, come along.
chroot "$root" ldconfig -p >"$folder/libraries"
for program in "$folder/objects/watertight.so" "$build/bin/watertight-worker"; do
  ldd "$program" | awk '$2 == "=>" { print $1, $3 }'
done | sort -u | while read -r name file; do
  grep -qF "$name " "$folder/libraries" || cp -L "$file" "$root/usr/local/lib/"
done
chroot "$root" ldconfig
mkdir -p "$root/srv/regress/crashing" "$root/srv/regress/hanging"
printf '#!/bin/sh\nkill -SEGV $$\n' >"$root/srv/regress/crashing/watertight-worker"
printf '#!/bin/sh\nexec sleep 600\n' >"$root/srv/regress/hanging/watertight-worker"
for fake in crashing hanging; do
  chmod +x "$root/srv/regress/$fake/watertight-worker"
  cp "$root/srv/regress/$fake/watertight-worker" "$root/srv/regress/$fake/watertight-tetgen"
done
cp -r "$source/tests/sql/sql" "$root/srv/regress/"
chroot "$root" chown -R postgres: /srv/regress

# The server sees no /proc here, in which the extension would find its helpers.
as_postgres "$bin/initdb" -D /srv/regress/data -N --username=postgres --encoding=UTF8 --no-locale --auth=trust >/dev/null
as_postgres "$bin/pg_ctl" -D /srv/regress/data -w -s -l /srv/regress/server.log \
  -o "-c listen_addresses= -c unix_socket_directories=/srv/regress -c fsync=off -c timezone_abbreviations=Default -c watertight.libexec=$helpers" start >/dev/null
query() { as_postgres "$bin/psql" -X -h /srv/regress "$@"; }
query -q -d postgres -c "CREATE DATABASE regression"
query -q -d regression -c "CREATE EXTENSION watertight"
status=0
for name in "${tests[@]}"; do
  # Version 17 writes the unit of both limits of a setting.
  query -a -q -d regression <"$source/tests/sql/sql/$name.sql" 2>&1 |
    sed -E 's/\(([0-9]+) MB \.\. ([0-9]+) MB\)/(\1 .. \2)/' >"$folder/$name.out"
  diff -u "$source/tests/sql/expected/$name.out" "$folder/$name.out" || status=1
done
query -At -d regression -c "SELECT version(), extversion FROM pg_extension WHERE extname = 'watertight'"
exit "$status"
