-- The helper processes: needed for a solid whose boundary no Delaunay tetrahedralization holds
-- (Schoenhardt's polyhedron), they may crash or hang.
\getenv folder PG_ABS_BUILDDIR
CREATE FUNCTION schoenhardt() RETURNS bytea LANGUAGE sql IMMUTABLE AS $$
  SELECT surface(ARRAY[
    polygon((a0 || c0 || b0)::float8[]), polygon((a1 || b1 || c1)::float8[]),
    polygon((a0 || b0 || a1)::float8[]), polygon((b0 || b1 || a1)::float8[]),
    polygon((b0 || c0 || b1)::float8[]), polygon((c0 || c1 || b1)::float8[]),
    polygon((c0 || a0 || c1)::float8[]), polygon((a0 || a1 || c1)::float8[])])
  FROM (SELECT ARRAY[1000, 0, 0] AS a0, ARRAY[-500, 866, 0] AS b0, ARRAY[-500, -866, 0] AS c0,
               ARRAY[866, -500, 1000] AS a1, ARRAY[0, 1000, 1000] AS b1,
               ARRAY[-866, -500, 1000] AS c1) v $$;
SELECT wt_is_valid(schoenhardt()), wt_info(wt_encode(schoenhardt()))->>'vertices' AS vertices;
SELECT wt_encode(wt_decode(wt_encode(schoenhardt()))) = wt_encode(schoenhardt()) AS stable;

\set crashing :folder /crashing
SET watertight.libexec = :'crashing';
\set VERBOSITY sqlstate
SELECT wt_is_valid(schoenhardt());
SELECT wt_encode(schoenhardt());
SELECT wt_validate(schoenhardt());
\set VERBOSITY default
-- Calls that need no helper are not touched by it.
SELECT wt_is_valid(ewkb) FROM solids WHERE name = 'hollow';

\set hanging :folder /hanging
SET watertight.libexec = :'hanging';
CREATE TEMP TABLE clock AS SELECT clock_timestamp() AS start;
SET statement_timeout = '300ms';
SELECT wt_is_valid(schoenhardt());
RESET statement_timeout;
SELECT clock_timestamp() - start < interval '10 s' AS ended_soon FROM clock;

RESET watertight.libexec;
SELECT wt_is_valid(schoenhardt());

