-- The settings that bound a call: watertight.max_seconds and watertight.max_memory.
SELECT wt_version() IS NOT NULL AS loaded;
SHOW watertight.max_seconds;
SHOW watertight.max_memory;

-- A box of 2 n^2 + 4 n unit squares.
CREATE FUNCTION grid_box(n int) RETURNS bytea LANGUAGE sql IMMUTABLE AS $$
  WITH cells AS (SELECT i, j FROM generate_series(0, n - 1) i, generate_series(0, n - 1) j),
  faces AS (
    SELECT polygon(ARRAY[i, j, 9, i + 1, j, 9, i + 1, j + 1, 9, i, j + 1, 9]::float8[]) AS face, 0 AS o, i, j FROM cells
    UNION ALL SELECT polygon(ARRAY[i, j, 0, i, j + 1, 0, i + 1, j + 1, 0, i + 1, j, 0]::float8[]), 1, i, j FROM cells
    UNION ALL SELECT polygon(ARRAY[i, 0, 0, i + 1, 0, 0, i + 1, 0, 9, i, 0, 9]::float8[]), 2, i, 0 FROM cells WHERE j = 0
    UNION ALL SELECT polygon(ARRAY[i, n, 0, i, n, 9, i + 1, n, 9, i + 1, n, 0]::float8[]), 3, i, 0 FROM cells WHERE j = 0
    UNION ALL SELECT polygon(ARRAY[0, j, 0, 0, j, 9, 0, j + 1, 9, 0, j + 1, 0]::float8[]), 4, 0, j FROM cells WHERE i = 0
    UNION ALL SELECT polygon(ARRAY[n, j, 0, n, j + 1, 0, n, j + 1, 9, n, j, 9]::float8[]), 5, 0, j FROM cells WHERE i = 0)
  SELECT surface(array_agg(face ORDER BY o, i, j)) FROM faces $$;
CREATE TABLE large AS SELECT grid_box(20) AS small_ewkb, grid_box(120) AS ewkb;
CREATE TABLE large_blob AS SELECT wt_encode(ewkb) AS blob FROM large;
SELECT wt_is_valid(small_ewkb), wt_is_valid(ewkb) FROM large;

-- 29,280 facets need more than 4 MB; 880 do not.
SET watertight.max_memory = '4MB';
SELECT wt_is_valid(small_ewkb) FROM large;
SELECT wt_is_valid(ewkb) FROM large;
SELECT wt_encode(ewkb) FROM large;
SELECT wt_validate(ewkb) FROM large;
SELECT wt_decode(blob) FROM large_blob;
SELECT wt_info(blob) FROM large_blob;
\set VERBOSITY sqlstate
SELECT wt_is_valid(ewkb) FROM large;
\set VERBOSITY default
RESET watertight.max_memory;

-- A helper that hangs is ended by the time of the call.
\getenv folder PG_ABS_BUILDDIR
\set hanging :folder /hanging
SET watertight.libexec = :'hanging';
SET watertight.max_seconds = 1;
CREATE TEMP TABLE clock2 AS SELECT clock_timestamp() AS start;
SELECT wt_is_valid(ewkb) FROM hard;
\set VERBOSITY sqlstate
SELECT wt_is_valid(ewkb) FROM hard;
\set VERBOSITY default
SELECT clock_timestamp() - start < interval '8 s' AS ended_soon FROM clock2;
RESET watertight.libexec;
RESET watertight.max_seconds;

-- Only a superuser can raise or lower them; they bind everybody.
CREATE ROLE visitor LOGIN;
GRANT SELECT ON large, large_blob TO visitor;
SET watertight.max_memory = '4MB';
SET ROLE visitor;
SET watertight.max_seconds = 0;
SET watertight.max_memory = 0;
SELECT wt_is_valid(ewkb) FROM large;
SELECT wt_is_valid(small_ewkb) FROM large;
RESET ROLE;
-- Also not before the library is loaded, when PostgreSQL does not know the setting yet.
\set superuser :USER
\c - visitor
SET watertight.max_seconds = 7;
\set VERBOSITY terse
SELECT wt_version() IS NOT NULL AS loaded;
\set VERBOSITY default
SHOW watertight.max_seconds;
\c - :superuser
SET watertight.max_memory = 0;
SELECT wt_is_valid(ewkb) FROM large;
SET watertight.max_memory = -1;
RESET watertight.max_memory;
DROP TABLE large, large_blob;
DROP ROLE visitor;

-- A query on few solids does not switch JIT on.
SET jit = on;
CREATE TEMP TABLE few AS SELECT ewkb FROM solids, generate_series(1, 200);
ANALYZE few;
CREATE FUNCTION plan(query text) RETURNS SETOF text LANGUAGE plpgsql AS $$
  BEGIN RETURN QUERY EXECUTE 'EXPLAIN ' || query; END $$;
SELECT count(*) AS jit_lines FROM plan('SELECT count(*) FROM few WHERE wt_is_valid(ewkb)') p
  WHERE p ~ 'JIT';
