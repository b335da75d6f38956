-- The helper processes: needed for a solid whose proof the program does not find alone (Chazelle's
-- polyhedron), they may crash or hang.
\getenv folder PG_ABS_BUILDDIR
-- Chazelle's polyhedron: n ridges over n others, two units apart. It is sheared, so that it needs
-- more Steiner points than the program itself allows, and long, so that CGAL scales it first.
CREATE FUNCTION sheared(c float8[]) RETURNS float8[] LANGUAGE sql IMMUTABLE AS $$
  SELECT array_agg(v ORDER BY i, axis) FROM generate_series(1, array_length(c, 1), 3) i,
    LATERAL (VALUES (1, c[i] + 4 * c[i + 1]), (2, c[i + 1] + 4 * c[i + 2]),
                    (3, 4096 * c[i + 2])) corner (axis, v) $$;
CREATE FUNCTION triangle(a float8[], b float8[], c float8[]) RETURNS bytea LANGUAGE sql IMMUTABLE AS $$
  SELECT polygon(sheared(a || b || c)) $$;
CREATE FUNCTION chazelle(n int) RETURNS bytea LANGUAGE sql IMMUTABLE AS $$
  WITH size AS (SELECT 4.0 * n AS s, 128.0 * n * n AS h),
  -- The zigzag of each side: points beside the ridges, and their ends.
  zigzag AS (
    SELECT array_agg(c ORDER BY k DESC, o) FILTER (WHERE side = 1) AS front,
           array_agg(c ORDER BY k, o) FILTER (WHERE side = 2) AS back,
           array_agg(c ORDER BY k DESC, o) FILTER (WHERE side = 3) AS left_side,
           array_agg(c ORDER BY k, o) FILTER (WHERE side = 4) AS right_side
    FROM size, generate_series(0, 2 * n) k,
      LATERAL (VALUES (1, ARRAY[2 * k, 0, CASE k % 2 WHEN 0 THEN h ELSE 2 END]),
                      (2, ARRAY[2 * k, s, CASE k % 2 WHEN 0 THEN h ELSE 2 * k * s + 2 END]),
                      (3, ARRAY[0, 2 * k, CASE k % 2 WHEN 0 THEN -h ELSE 0 END]),
                      (4, ARRAY[s, 2 * k, CASE k % 2 WHEN 0 THEN -h ELSE 2 * k * s END])) v (side, p),
      LATERAL unnest(p) WITH ORDINALITY u (c, o)),
  facets AS (
    SELECT unnest(ARRAY[
      triangle(ARRAY[x - 2, 0, h], ARRAY[x, 0, 2], ARRAY[x, s, x * s + 2]),
      triangle(ARRAY[x - 2, 0, h], ARRAY[x, s, x * s + 2], ARRAY[x - 2, s, h]),
      triangle(ARRAY[x, 0, 2], ARRAY[x + 2, 0, h], ARRAY[x + 2, s, h]),
      triangle(ARRAY[x, 0, 2], ARRAY[x + 2, s, h], ARRAY[x, s, x * s + 2]),
      triangle(ARRAY[0, x, 0], ARRAY[s, x, s * x], ARRAY[s, x - 2, -h]),
      triangle(ARRAY[0, x - 2, -h], ARRAY[0, x, 0], ARRAY[s, x - 2, -h]),
      triangle(ARRAY[0, x + 2, -h], ARRAY[s, x + 2, -h], ARRAY[s, x, s * x]),
      triangle(ARRAY[0, x, 0], ARRAY[0, x + 2, -h], ARRAY[s, x, s * x])]) AS f
    FROM size, generate_series(2, 4 * n - 2, 4) x
    UNION ALL
    SELECT unnest(ARRAY[
      polygon(sheared((ARRAY[0, 0, -h, s, 0, -h] || front)::float8[])),
      polygon(sheared((ARRAY[s, s, -h, 0, s, -h] || back)::float8[])),
      polygon(sheared((ARRAY[0, 0, h, 0, s, h] || left_side)::float8[])),
      polygon(sheared((ARRAY[s, s, h, s, 0, h] || right_side)::float8[]))]) FROM size, zigzag)
  SELECT surface(array_agg(f)) FROM facets $$;
CREATE TABLE hard AS SELECT chazelle(6) AS ewkb;
SELECT wt_is_valid(ewkb), wt_info(wt_encode(ewkb))->>'vertices' AS vertices FROM hard;
SELECT wt_encode(wt_decode(wt_encode(ewkb))) = wt_encode(ewkb) AS stable FROM hard;

\set crashing :folder /crashing
SET watertight.libexec = :'crashing';
\set VERBOSITY sqlstate
SELECT wt_is_valid(ewkb) FROM hard;
SELECT wt_encode(ewkb) FROM hard;
SELECT wt_validate(ewkb) FROM hard;
\set VERBOSITY default
-- Calls that need no helper are not touched by it.
SELECT wt_is_valid(ewkb) FROM solids WHERE name = 'hollow';

\set hanging :folder /hanging
SET watertight.libexec = :'hanging';
CREATE TEMP TABLE clock AS SELECT clock_timestamp() AS start;
SET statement_timeout = '300ms';
SELECT wt_is_valid(ewkb) FROM hard;
RESET statement_timeout;
SELECT clock_timestamp() - start < interval '10 s' AS ended_soon FROM clock;

RESET watertight.libexec;
SELECT wt_is_valid(ewkb) FROM hard;

