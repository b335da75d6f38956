-- Input that is not what it claims to be: an error each time, and the connection goes on.
\set VERBOSITY sqlstate
SELECT wt_validate('');
SELECT wt_is_valid('garbage');
SELECT wt_encode('\xdeadbeef');
SELECT wt_decode('');
SELECT wt_decode('garbage');
SELECT wt_info('\x00');
-- A point, and a surface without z.
SELECT wt_validate('\x0101000000000000000000f03f000000000000f03f');
SELECT wt_validate('\x010f00000000000000');
-- More polygons than there are bytes.
SELECT wt_validate('\x010f000080ffffffff');
-- Not a number.
SELECT wt_validate(surface(ARRAY[polygon(ARRAY['NaN', 0, 0, 1, 0, 0, 0, 1, 0]::float8[])]));
\set VERBOSITY default

-- Every truncated prefix and every single changed byte of blobs and of EWKB.
CREATE FUNCTION outcome(function text, argument bytea) RETURNS text LANGUAGE plpgsql AS $$
DECLARE state text;
BEGIN
  EXECUTE format('SELECT %s($1)', function) USING argument;
  RETURN 'value';
EXCEPTION WHEN OTHERS THEN
  GET STACKED DIAGNOSTICS state = RETURNED_SQLSTATE;
  RETURN state;
END $$;
SELECT DISTINCT outcome('wt_decode', substring(blob FOR length)) AS truncated_blob
FROM (SELECT wt_encode(ewkb) AS blob FROM solids WHERE wt_is_valid(ewkb)) encoded,
     generate_series(0, octet_length(blob) - 1) length ORDER BY 1;
SELECT DISTINCT outcome('wt_is_valid', substring(ewkb FOR length)) AS truncated_ewkb
FROM solids, generate_series(0, octet_length(ewkb) - 1) length ORDER BY 1;
SELECT count(*) FILTER (WHERE outcome NOT IN ('value', '22P03', '0A000', '54000')) AS unexpected
FROM (SELECT outcome('wt_decode', set_byte(blob, i, get_byte(blob, i) # (1 << (i % 8)))) AS outcome
      FROM (SELECT wt_encode(ewkb) AS blob FROM solids WHERE name = 'hollow') encoded,
           generate_series(0, octet_length(blob) - 1) i) mutated;

-- Ten thousand errors leave neither a broken connection nor memory behind.
DO $$
DECLARE before bigint; after bigint;
BEGIN
  FOR i IN 1..1000 LOOP PERFORM outcome('wt_encode', '\x010f000080ffffffff'); END LOOP;
  SELECT sum(used_bytes) INTO before FROM pg_backend_memory_contexts;
  FOR i IN 1..10000 LOOP PERFORM outcome('wt_encode', '\x010f000080ffffffff'); END LOOP;
  SELECT sum(used_bytes) INTO after FROM pg_backend_memory_contexts;
  IF after > before + 1000000 THEN RAISE 'memory grew from % to %', before, after; END IF;
END $$;
SELECT wt_is_valid(ewkb) FROM solids WHERE name = 'cube';
