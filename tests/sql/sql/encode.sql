-- Encode, decode and what an invalid solid gives instead.
-- Same bytes for the same solid; the decoded solid has the same blob; polygons return as they were.
SELECT name, wt_encode(ewkb) = wt_encode(wt_decode(wt_encode(ewkb))) AS stable,
       wt_is_valid(wt_decode(wt_encode(ewkb))) AS valid,
       octet_length(wt_encode(ewkb)) < octet_length(ewkb) AS smaller
FROM solids WHERE wt_is_valid(ewkb) ORDER BY name;
-- EWKB that PostGIS wrote comes back as PostGIS writes it, byte for byte.
SELECT name, wt_decode(wt_encode(ewkb)) = ewkb AS identical
FROM solids WHERE name IN ('postgis cube', 'pierced') ORDER BY name;
SELECT name, info->>'version' AS version, info->>'srid' AS srid, info->>'shells' AS shells,
       info->>'facets' AS facets, info->>'rings' AS rings, info->>'vertices' AS vertices,
       info->'lattice' AS lattice, (info->>'bytes')::int = octet_length(blob) AS bytes
FROM (SELECT name, wt_encode(ewkb) AS blob, wt_info(wt_encode(ewkb)) AS info
      FROM solids WHERE wt_is_valid(ewkb)) encoded ORDER BY name;
-- An invalid solid is an error whose detail names the findings.
CREATE FUNCTION refusal(ewkb bytea) RETURNS text LANGUAGE plpgsql AS $$
DECLARE message text; state text; detail text;
BEGIN
  PERFORM wt_encode(ewkb);
  RETURN 'no error';
EXCEPTION WHEN OTHERS THEN
  GET STACKED DIAGNOSTICS state = RETURNED_SQLSTATE, message = MESSAGE_TEXT,
    detail = PG_EXCEPTION_DETAIL;
  RETURN state || ' ' || message || ': ' || substring(detail FROM '^error [0-9]+ [A-Z_]+');
END $$;
SELECT name, refusal(ewkb) FROM solids ORDER BY name;

-- In a parallel plan.
CREATE TABLE many AS SELECT i, ewkb FROM solids, generate_series(1, 200) i WHERE name = 'hollow';
ALTER TABLE many SET (parallel_workers = 2);
SET parallel_setup_cost = 0;
SET parallel_tuple_cost = 0;
SET min_parallel_table_scan_size = 0;
EXPLAIN (COSTS OFF) SELECT count(*) FROM many WHERE wt_is_valid(ewkb);
SELECT count(*) FROM many WHERE wt_is_valid(ewkb);
SELECT count(DISTINCT wt_encode(ewkb)) FROM many;
DROP TABLE many;
