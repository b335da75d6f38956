-- The functions of the extension, and their answers for a few solids.
SELECT wt_version();
SELECT p.oid::regprocedure AS function, provolatile, proisstrict, proparallel, procost,
       obj_description(p.oid, 'pg_proc') IS NOT NULL AS has_comment
FROM pg_proc p JOIN pg_depend d ON d.objid = p.oid AND d.deptype = 'e'
JOIN pg_extension e ON e.oid = d.refobjid AND e.extname = 'watertight'
ORDER BY p.oid::regprocedure::text;

-- Solids built by hand, big-endian.
CREATE FUNCTION polygon(points float8[]) RETURNS bytea LANGUAGE sql IMMUTABLE AS $$
  SELECT '\x0080000003'::bytea || int4send(1) || int4send(cardinality(points) / 3 + 1)
    || string_agg(float8send(points[(i % cardinality(points)) + 1]), '' ORDER BY i)
  FROM generate_series(0, cardinality(points) + 2) i $$;
CREATE FUNCTION surface(facets bytea[], srid int DEFAULT 0) RETURNS bytea LANGUAGE sql IMMUTABLE AS $$
  SELECT CASE WHEN srid = 0 THEN '\x008000000f'::bytea ELSE '\x00a000000f'::bytea || int4send(srid) END
    || int4send(cardinality(facets)) || (SELECT string_agg(f, '' ORDER BY i)
                                         FROM unnest(facets) WITH ORDINALITY u (f, i)) $$;
CREATE FUNCTION solid(shells bytea[]) RETURNS bytea LANGUAGE sql IMMUTABLE AS $$
  SELECT '\x0080000065'::bytea || int4send(cardinality(shells)) || string_agg(s, '' ORDER BY i)
  FROM unnest(shells) WITH ORDINALITY u (s, i) $$;
-- The facets of an axis-parallel cube from a to b, seen counter-clockwise from outside.
CREATE FUNCTION cube_facets(a float8, b float8) RETURNS bytea[] LANGUAGE sql IMMUTABLE AS $$
  SELECT ARRAY[polygon(ARRAY[a,a,a, a,b,a, b,b,a, b,a,a]), polygon(ARRAY[a,a,b, b,a,b, b,b,b, a,b,b]),
               polygon(ARRAY[a,a,a, b,a,a, b,a,b, a,a,b]), polygon(ARRAY[a,b,a, a,b,b, b,b,b, b,b,a]),
               polygon(ARRAY[a,a,a, a,a,b, a,b,b, a,b,a]), polygon(ARRAY[b,a,a, b,b,a, b,b,b, b,a,b])] $$;
-- The same seen from inside: the boundary of a cavity.
CREATE FUNCTION cavity_facets(a float8, b float8) RETURNS bytea[] LANGUAGE sql IMMUTABLE AS $$
  SELECT ARRAY[polygon(ARRAY[b,a,a, b,b,a, a,b,a, a,a,a]), polygon(ARRAY[a,b,b, b,b,b, b,a,b, a,a,b]),
               polygon(ARRAY[a,a,b, b,a,b, b,a,a, a,a,a]), polygon(ARRAY[b,b,a, b,b,b, a,b,b, a,b,a]),
               polygon(ARRAY[a,b,a, a,b,b, a,a,b, a,a,a]), polygon(ARRAY[b,a,b, b,b,b, b,b,a, b,a,a])] $$;

CREATE TABLE solids (name text PRIMARY KEY, ewkb bytea NOT NULL);
INSERT INTO solids VALUES
  ('cube', surface(cube_facets(0, 1))),
  ('open', surface((cube_facets(0, 1))[1:5])),
  ('hollow', solid(ARRAY[surface(cube_facets(0, 10)), surface(cavity_facets(2, 3))])),
  ('inside out', surface(cavity_facets(0, 1))),
  ('cavity outside', solid(ARRAY[surface(cube_facets(0, 10)), surface(cavity_facets(12, 13))]));
\getenv folder PG_ABS_SRCDIR
\set file :folder /sql/postgis.inc
\i :file

SELECT name, wt_is_valid(ewkb) FROM solids ORDER BY name;
SELECT name, wt_validate(ewkb)->'validity' AS validity, wt_validate(ewkb)->'all_errors' AS errors
FROM solids ORDER BY name;
-- The report has no times: equal solids have equal reports.
WITH one AS MATERIALIZED (SELECT name, wt_validate(ewkb) AS report FROM solids),
  other AS MATERIALIZED (SELECT name, wt_validate(ewkb) AS report FROM solids ORDER BY name DESC)
SELECT bool_and(one.report = other.report) AS same FROM one JOIN other USING (name);
SELECT count(*) FROM solids WHERE wt_validate(ewkb)::text ~ 'seconds|time|accepted';
SELECT wt_validate(NULL), wt_is_valid(NULL), wt_encode(NULL), wt_decode(NULL), wt_info(NULL);

-- No setting changes a verdict; the only one is for superusers.
CREATE ROLE visitor;
SET ROLE visitor;
SET watertight.libexec = '/somewhere';
RESET ROLE;
DROP ROLE visitor;
