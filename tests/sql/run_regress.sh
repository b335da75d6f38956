#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs the extension in a private server: run_regress.sh SOURCE BUILD [PROGRAM]
# With PROGRAM (watertight) the script also compares the blobs of SQL and command line. The store's
# own tests then find out whether a private cluster of such a server has the extension.
set -euo pipefail
# shellcheck source=tests/unprivileged.sh
. "$(dirname "$0")/../unprivileged.sh"
# shellcheck source=tests/sql/regression.sh
. "$(dirname "$0")/regression.sh"
source=$(cd "$1" && pwd)
build=$(cd "$2" && pwd)
program=${3:-}

folder=$(mktemp -d /tmp/watertight-sql-XXXXXX)
started=no
cleanup() {
  status=$?
  if [ $started = yes ]; then
    run "$bin/pg_ctl" -D "$folder/data" -m immediate -s stop >/dev/null 2>&1 || true
  fi
  rm -rf "$folder"
  exit $status
}
trap cleanup EXIT

prepare "$source" "$build" "$folder"
run "$bin/pg_ctl" -D "$folder/data" -w -s -l "$folder/server.log" \
  -o "-c listen_addresses= -c unix_socket_directories=$folder/socket -c fsync=off" start ||
  { cat "$folder/server.log"; exit 1; }
started=yes
connect=(-h "$folder/socket" -U watertight)

if ! regress "${regression_tests[@]}"; then
  cat "$folder/regression.diffs" || true
  tail -20 "$folder/server.log"
  exit 1
fi

# A table of solids comes back from a dump whatever the settings of the new database are: rules are in the
# table and in the blobs.
ask() { run "$bin/psql" -X -q -At -v ON_ERROR_STOP=1 "${connect[@]}" -d "$1" -c "$2"; }
sum="SELECT md5(string_agg(id || encode(ewkb, 'hex') || encode(blob, 'hex'), ',' ORDER BY id)), count(*) FROM shapes"
run "$bin/pg_dump" "${connect[@]}" -d regression -t shapes >"$folder/shapes.sql"
ask postgres "CREATE DATABASE restored"
ask postgres "ALTER DATABASE restored SET watertight.planarity = 1e-9"
ask restored "CREATE EXTENSION watertight"
run "$bin/psql" -X -q -v ON_ERROR_STOP=1 "${connect[@]}" -d restored <"$folder/shapes.sql" >/dev/null
[ "$(ask restored "SELECT wt_rules()->>'planarity'")" = 0.000000001 ] || { echo "the setting has no effect"; exit 1; }
[ "$(ask restored "$sum")" = "$(ask regression "$sum")" ] || { echo "a dump brought other solids back"; exit 1; }
echo "a dump brings solids back under other settings"

# A column of solids and its index come back too, value by value.
ask regression "CREATE TABLE kept_town AS SELECT name, shape, wt_volume(shape) AS volume FROM town"
ask regression "CREATE INDEX kept_box ON kept_town USING gist (shape)"
run "$bin/pg_dump" "${connect[@]}" -d regression -t kept_town >"$folder/kept.sql"
run "$bin/psql" -X -q -v ON_ERROR_STOP=1 "${connect[@]}" -d restored <"$folder/kept.sql" >/dev/null
sum_of_kept="SELECT md5(string_agg(name || shape::text || volume, ',' ORDER BY name)), count(*) FROM kept_town WHERE wt_volume(shape) = volume"
[ "$(ask restored "$sum_of_kept")" = "$(ask regression "$sum_of_kept")" ] || { echo "a dump brought other values of type solid back"; exit 1; }
[ "$(ask restored "SELECT count(*) FROM kept_town")" -eq 4 ] || { echo "a dump lost solids"; exit 1; }
echo "a dump brings a column of solids back"

# An installation of the former version is updated; its functions, indexes and columns stay.
functions="SELECT p.oid::regprocedure, provolatile, proisstrict, proparallel, procost, obj_description(p.oid, 'pg_proc')
  FROM pg_proc p JOIN pg_depend d ON d.objid = p.oid AND d.deptype = 'e'
  JOIN pg_extension e ON e.oid = d.refobjid AND e.extname = 'watertight' ORDER BY p.oid::regprocedure::text"
ask postgres "CREATE DATABASE former"
ask former "CREATE EXTENSION watertight VERSION '0.1.0'"
[ "$(ask former "$functions" | wc -l)" -eq 6 ] || { echo "version 0.1.0 has other functions"; exit 1; }
cube=$(ask regression "SELECT encode(ewkb, 'hex') FROM solids WHERE name = 'cube'")
ask former "CREATE TABLE shapes (id int PRIMARY KEY, ewkb bytea CHECK (wt_is_valid(ewkb)),
  blob bytea GENERATED ALWAYS AS (wt_encode(ewkb)) STORED)"
ask former "CREATE INDEX shapes_valid ON shapes (wt_is_valid(ewkb))"
ask former "CREATE VIEW reports AS SELECT id, wt_validate(ewkb)->>'verdict' AS verdict FROM shapes"
ask former "INSERT INTO shapes VALUES (1, '\\x$cube')"
before=$(ask former "$sum")
ask former "ALTER EXTENSION watertight UPDATE"
[ "$(ask former "$functions")" = "$(ask restored "$functions")" ] || { echo "an update gives other functions"; exit 1; }
[ "$(ask former "$sum")" = "$before" ] || { echo "an update changed solids"; exit 1; }
[ "$(ask former "SELECT id, verdict, wt_rules_of(blob)->>'planarity' FROM reports JOIN shapes USING (id)")" = "1|valid|0.01" ] ||
  { echo "an update broke a view"; exit 1; }
ask former "INSERT INTO shapes VALUES (2, '\\x$cube')"
run "$bin/pg_dump" "${connect[@]}" -d former | run "$bin/psql" -X -q -v ON_ERROR_STOP=1 "${connect[@]}" \
  -d postgres >/dev/null || { echo "an updated database cannot be restored"; exit 1; }
[ "$(ask postgres "SELECT count(*) FROM shapes")" -eq 2 ] || { echo "a restored database lacks solids"; exit 1; }
echo "an installation of version 0.1.0 is updated"

# The guide, as a reader follows it.
ask postgres "CREATE DATABASE guide"
if [ -n "$program" ]; then
  env PATH="$(dirname "$program"):$bin:$PATH" PGHOST="$folder/socket" PGUSER=watertight PGDATABASE=guide \
    python3 "$source/tests/sql/run_guide.py" "$source" "$source/docs/sql.md"
  found=$(HOME=$folder/home /usr/bin/python3 "$source/tests/sql/qgis_layer.py" "$folder/socket" guide watertight city_map 2>"$folder/qgis.log") ||
    { cat "$folder/qgis.log"; exit 1; }
  [ "$found" = "623 MultiPolygonZ EPSG:7415" ] || { echo "QGIS makes something else of the guide's view: $found"; exit 1; }
  echo "QGIS reads the guide's view of 623 solids"
  # A file becomes a table.
  ask guide "CREATE TABLE from_files (feature text, object text, lod text, ewkb bytea)"
  "$program" rows "$source/examples/delft.city.jsonl" |
    run "$bin/psql" -X -q -v ON_ERROR_STOP=1 "${connect[@]}" -d guide -c "COPY from_files FROM STDIN"
  ask guide "CREATE TABLE town AS SELECT feature, object, lod, wt_try_solid(ewkb) AS shape FROM from_files"
  found=$(ask guide "SELECT count(*), count(shape), count(DISTINCT feature), count(DISTINCT lod), max(wt_srid(shape)) FROM town")
  [ "$found" = "480|470|159|3|7415" ] || { echo "a file became another table: $found"; exit 1; }
  echo "a file became a table of 470 solids, and 10 that are refused"
  # The measures are those that the publisher states, within 0.1 %; bench/results/sql.md has the exceptions.
  ask guide "CREATE TABLE given (feature text, name text, value float8)"
  python3 "$source/tests/sql/given_measures.py" "$source/examples/delft.city.jsonl" |
    run "$bin/psql" -X -q -v ON_ERROR_STOP=1 "${connect[@]}" -d guide -c "COPY given FROM STDIN"
  found=$(run "$bin/psql" -X -q -At -v ON_ERROR_STOP=1 "${connect[@]}" -d guide <"$source/tests/sql/given_measures.sql")
  [ "$found" = "$(printf 'ground|152|150\nvolume|467|465\nwalls|152|151')" ] ||
    { echo "other measures are those that the publisher states:"; echo "$found"; exit 1; }
  echo "766 of 771 measures are those that the publisher states"
  query() { run "$bin/psql" -X -q -At "${connect[@]}" -d regression -c "$1"; }
  for name in cube pierced hollow; do
    query "SELECT encode(ewkb, 'base64') FROM solids WHERE name = '$name'" |
      base64 -d >"$folder/$name.ewkb"
    query "SELECT encode(wt_encode(ewkb), 'base64') FROM solids WHERE name = '$name'" |
      base64 -d >"$folder/$name.sql"
    "$program" encode --bare "$folder/$name.ewkb" -o "$folder/$name.blob"
    cmp "$folder/$name.blob" "$folder/$name.sql" || {
      echo "SQL and command line encode '$name' differently"
      exit 1
    }
  done
  echo "3 blobs of SQL and command line are equal"
fi

# For every solid of these files, the extension must write the same bytes as the library, or find
# the solid invalid too, and give the solid back. Golden blobs must decode to the same solids.
if [ -x "$build/bin/encode_documents" ]; then
  query() { run "$bin/psql" -X -q -At -v ON_ERROR_STOP=1 "${connect[@]}" -d regression "$@"; }
  (cd "$source" && find examples tests/data tests/golden/solids tests/golden/blobs -type f |
    LC_ALL=C sort | xargs "$build/bin/encode_documents") >"$folder/rows"
  chmod a+r "$folder/rows"
  query -c "CREATE TABLE documents (name text, ewkb bytea, blob bytea)"
  query -c "COPY documents FROM STDIN" <"$folder/rows"
  for file in "$source"/tests/golden/blobs/*/*.blob; do
    printf '%s\t\\\\x%s\n' "${file#"$source"/}" "$(od -An -v -tx1 "$file" | tr -d ' \n')"
  done >"$folder/goldens"
  query -c "CREATE TABLE goldens (name text, blob bytea)"
  query -c "COPY goldens FROM STDIN" <"$folder/goldens"
  different=$(query -c "
    SELECT 'another verdict', name FROM documents WHERE wt_is_valid(ewkb) <> (blob IS NOT NULL)
    UNION ALL SELECT 'another blob', name FROM documents
      WHERE CASE WHEN blob IS NOT NULL THEN wt_encode(ewkb) <> blob END
    UNION ALL SELECT 'another solid', name FROM documents WHERE wt_decode(blob) <> ewkb
    UNION ALL SELECT 'another value', name FROM documents
      WHERE wt_try_solid(ewkb)::bytea IS DISTINCT FROM blob
    UNION ALL SELECT 'another value of a blob', name FROM documents
      WHERE blob IS NOT NULL AND wt_solid(blob)::bytea <> blob
    UNION ALL SELECT 'another measure', name FROM documents,
      LATERAL (SELECT wt_solid(blob) AS shape, wt_validate(ewkb)->'measures' AS measures) AS m
      WHERE blob IS NOT NULL AND (wt_volume(shape) <> (measures->>'volume')::float8 OR wt_area(shape) <> (measures->>'area')::float8
        OR wt_facet_count(shape) <> (measures->>'facets')::int OR wt_genus(shape) <> (measures->>'genus')::int
        OR abs(wt_area(shape) - (SELECT sum(area) FROM wt_faces(shape))) > 1e-9 * wt_area(shape))
    UNION ALL SELECT 'another golden', name FROM goldens g LEFT JOIN documents d USING (name)
      WHERE d.ewkb IS DISTINCT FROM wt_decode(g.blob)")
  [ -z "$different" ] || { echo "SQL and library differ:"; echo "$different"; exit 1; }
  # The parts of small ones between heights are together what they are parts of, to 0.1 %: facets that are not flat have other
  # triangles when they are cut. A part that touches itself is an error (cavities that touch).
  cut=$(query -c "
    CREATE FUNCTION parts_or_null(shape solid, low float8, high float8) RETURNS solid[] LANGUAGE plpgsql AS
    \$\$ BEGIN RETURN wt_clip_z(shape, low, high); EXCEPTION WHEN invalid_parameter_value OR SQLSTATE 'WT001' THEN RETURN NULL; END \$\$" -c "
    CREATE FUNCTION volume_of(parts solid[]) RETURNS float8 LANGUAGE sql AS
    \$\$ SELECT coalesce(sum(wt_volume(part)), 0) FROM unnest(parts) AS part \$\$" -c "
    CREATE TABLE cut AS SELECT name, shape, wt_volume_below(shape, height) AS below,
      parts_or_null(shape, '-Infinity', height) AS low, parts_or_null(shape, height, 'Infinity') AS high
    FROM (SELECT name, shape, round((0.37 * wt_bound(wt_bbox(shape), 6) + 0.63 * wt_bound(wt_bbox(shape), 3))::numeric, 4)::float8 AS height
          FROM documents, LATERAL (SELECT wt_solid(blob) AS shape) AS s WHERE blob IS NOT NULL AND wt_facet_count(shape) < 200) AS heights" -c "
    SELECT count(*) >= 500 AND count(*) > 0.98 * (SELECT count(*) FROM cut), count(*) FILTER (WHERE abs(volume_of(low) - below) > 1e-3 * wt_volume(shape)),
      count(*) FILTER (WHERE abs(volume_of(high) + below - wt_volume(shape)) > 1e-3 * wt_volume(shape)) FROM cut
    WHERE low IS NOT NULL AND high IS NOT NULL")
  [ "$cut" = "t|0|0" ] || { echo "parts are not the solids: $cut"; exit 1; }
  echo "solids are the sums of their parts below and above a height"
  # Measures of these solids, and of 10,000 random tetrahedra, against exact fractions.
  measured() {
    query -F"$(printf '\t')" -c "
      SELECT encode(wt_as_ewkb(shape), 'hex'), wt_solid_info(shape)->'lattice', wt_volume(shape), wt_area(shape),
        wt_centroid(shape), height, wt_volume_below(shape, height)
      FROM (SELECT shape, round((0.3 * wt_bound(wt_bbox(shape), 6) + 0.7 * wt_bound(wt_bbox(shape), 3))::numeric, 4)::float8 AS height
            FROM $1 AS solids) AS cut" |
      python3 "$source/tests/sql/exact_measures.py"
  }
  measured "(SELECT wt_solid(blob) AS shape FROM documents WHERE blob IS NOT NULL)"
  query -c "SELECT setseed(0.5)" -c "
    CREATE TABLE corners AS
    SELECT n, array_agg(format('%s %s %s', round((1e5 * random())::numeric, n % 8), round((10 ^ (n % 7) * random())::numeric, n % 8),
      round((1e2 * random())::numeric, 3)) ORDER BY i) AS p
    FROM generate_series(1, 10000) AS n, generate_series(1, 4) AS i GROUP BY n"
  # One of two orders of the corners is right, and some tetrahedra are flat.
  query -c "
    CREATE FUNCTION solid_or_null(wkt text) RETURNS solid LANGUAGE plpgsql AS
    \$\$ BEGIN RETURN wkt::solid; EXCEPTION WHEN OTHERS THEN RETURN NULL; END \$\$"
  query -c "
    CREATE TABLE tetrahedra AS
    SELECT coalesce(solid_or_null(one), solid_or_null(other)) AS shape
    FROM corners, LATERAL (SELECT
      format('POLYHEDRALSURFACE Z (((%1\$s,%3\$s,%2\$s,%1\$s)),((%1\$s,%2\$s,%4\$s,%1\$s)),((%2\$s,%3\$s,%4\$s,%2\$s)),((%1\$s,%4\$s,%3\$s,%1\$s)))',
             p[1], p[2], p[3], p[4]) AS one,
      format('POLYHEDRALSURFACE Z (((%1\$s,%3\$s,%2\$s,%1\$s)),((%1\$s,%2\$s,%4\$s,%1\$s)),((%2\$s,%3\$s,%4\$s,%2\$s)),((%1\$s,%4\$s,%3\$s,%1\$s)))',
             p[2], p[1], p[3], p[4]) AS other) AS texts"
  measured "(SELECT shape FROM tetrahedra WHERE shape IS NOT NULL)"
  # Solids and geometries of PostGIS, whose SFCGAL measures them too.
  query -c "COPY documents TO STDOUT" >"$folder/documents"
  ask postgres "CREATE DATABASE gis"
  ask gis "CREATE EXTENSION watertight"
  ask gis "CREATE TABLE documents (name text, ewkb bytea, blob bytea)"
  run "$bin/psql" -X -q "${connect[@]}" -d gis -c "COPY documents FROM STDIN" <"$folder/documents"
  run "$bin/psql" -X -q -At -v ON_ERROR_STOP=1 "${connect[@]}" -d gis <"$source/tests/sql/postgis.sql" >"$folder/gis.out"
  if [ "$(grep -c '|t$' "$folder/gis.out")" -ne 9 ] || [ "$(wc -l <"$folder/gis.out")" -ne 9 ]; then
    cat "$folder/gis.out"
    exit 1
  fi
  echo "PostGIS and SFCGAL agree"
  # Map programs see a view of solids as a layer.
  features=$(ask gis "SELECT count(*) FROM small")
  run ogrinfo -so "PG:host=$folder/socket user=watertight dbname=gis" for_maps >"$folder/layer" 2>&1 ||
    { cat "$folder/layer"; exit 1; }
  for line in "Geometry: 3D PolyhedralSurface" "Feature Count: $features"; do
    grep -qxF "$line" "$folder/layer" || { echo "GDAL sees no layer of solids:"; cat "$folder/layer"; exit 1; }
  done
  echo "GDAL sees a view of $features solids as a layer of polyhedral surfaces"
  counts=$(query -c "SELECT count(blob), count(*) - count(blob) FROM documents")
  [ "${counts%|*}" -ge 500 ] || { echo "only ${counts%|*} blobs were compared"; exit 1; }
  echo "${counts%|*} blobs of SQL and library are equal, ${counts#*|} solids invalid in both"
fi

if [ -x "$build/bin/test_store" ]; then
  WATERTIGHT_POSTGRES_BIN=$bin "$build/bin/test_store" "the database has the extension*"
fi

# A helper process ends with its backend, and all connections are closed now.
helpers() {
  for link in /proc/[0-9]*/exe; do
    case $(readlink "$link" 2>/dev/null) in
      "$folder"/*/watertight-worker | "$folder"/*/watertight-tetgen | "$folder"/hanging/sleep)
        echo "$link" ;;
    esac
  done
}
for _ in $(seq 50); do
  left=$(helpers)
  if [ -z "$left" ]; then break; fi
  sleep 0.1
done
[ -z "$left" ] || { echo "helpers outlived their backends: $left"; exit 1; }
