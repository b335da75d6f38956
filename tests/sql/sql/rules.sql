-- Rules per call, as settings, and in blobs.
-- A box of 10 m whose roof has one corner 0.1 m too high: 25 mm from its plane.
CREATE FUNCTION warped() RETURNS bytea LANGUAGE sql IMMUTABLE AS $$
  SELECT surface(ARRAY[
    polygon(ARRAY[0,0,0, 0,10,0, 10,10,0, 10,0,0]), polygon(ARRAY[0,0,10, 10,0,10, 10,10,10.1, 0,10,10]),
    polygon(ARRAY[0,0,0, 10,0,0, 10,0,10, 0,0,10]), polygon(ARRAY[0,10,0, 0,10,10, 10,10,10.1, 10,10,0]),
    polygon(ARRAY[0,0,0, 0,0,10, 0,10,10, 0,10,0]), polygon(ARRAY[10,0,0, 10,10,0, 10,10,10.1, 10,0,10])]) $$;
SELECT wt_is_valid(warped()), wt_is_valid(warped(), '{}'), wt_is_valid(warped(), '{"planarity": 0.05}'),
       wt_is_valid(warped(), wt_rules(planarity => 0.05)),
       wt_is_valid(warped(), wt_rules(planarity => 0.05, planarity_angle => 0.1));
SELECT wt_validate(warped(), rules)->'all_errors' AS errors, wt_validate(warped(), rules)->'parameters' AS parameters
FROM unnest(ARRAY['{}', '{"planarity": 0.05}', '{"planarity": 0.05, "proof": "boundary", "strict": true}']::jsonb[]) rules;

-- The blob states the rules, and they judge the solid again.
CREATE TABLE kept AS SELECT wt_encode(warped(), wt_rules(planarity => 0.05, proof => 'boundary')) AS blob;
SELECT wt_rules_of(blob), wt_info(blob)->'acceptance' AS acceptance,
       wt_is_valid(wt_decode(blob)) AS by_default, wt_is_valid(wt_decode(blob), wt_rules_of(blob)) AS by_its_rules,
       wt_encode(wt_decode(blob), wt_rules_of(blob)) = blob AS same
FROM kept;
SELECT wt_encode(warped());

-- Settings are the rules of wt_rules() alone: a call without rules answers the same in every session.
SET watertight.planarity = 0.05;
SET watertight.planarity_angle = 5;
SET watertight.proof = boundary;
SET watertight.strict = on;
SELECT wt_rules(), wt_rules(planarity => 0.2, proof => 'tetrahedralization', strict => false);
SELECT wt_is_valid(warped()), wt_is_valid(warped(), '{}'), wt_is_valid(warped(), wt_rules());
RESET watertight.planarity;
RESET watertight.planarity_angle;
RESET watertight.proof;
RESET watertight.strict;
SELECT wt_rules();
SELECT name, setting, min_val, max_val, enumvals, context FROM pg_settings
WHERE name ~ '^watertight.(planarity|planarity_angle|proof|strict)$' ORDER BY name;
-- Anybody may set them, before the library is loaded too.
CREATE ROLE visitor LOGIN;
\set superuser :USER
\c - visitor
SET watertight.planarity = 0.03;
SELECT wt_rules()->'planarity' AS planarity;
\c - :superuser
DROP ROLE visitor;

-- Bad rules.
SELECT wt_version() IS NOT NULL AS loaded;
\set VERBOSITY default
SET watertight.planarity = 0;
SET watertight.planarity_angle = 91;
SET watertight.proof = hope;
SET watertight.overlap = 1;
SELECT wt_rules(planarity => -1);
SELECT wt_rules(planarity => 'NaN');
SELECT wt_rules(planarity_angle => 'Infinity');
SELECT wt_rules(proof => 'hope');
SELECT wt_is_valid(warped(), '{"planarity": 1e9}');
SELECT wt_is_valid(warped(), '{"planarity": "0.05"}');
SELECT wt_is_valid(warped(), '{"planarity": null}');
SELECT wt_is_valid(warped(), '{"proof": 1}');
SELECT wt_is_valid(warped(), '{"strict": "yes"}');
SELECT wt_is_valid(warped(), '{"overlap": 0.1}');
SELECT wt_is_valid(warped(), '{"rule_set": 2}');
SELECT wt_is_valid(warped(), '[0.05]');
SELECT wt_is_valid(warped(), '0.05');
SELECT wt_is_valid(warped(), '{"planarity": 1e400}');
SELECT wt_is_valid(warped(), NULL), wt_rules(NULL) IS NOT NULL AS takes_settings;

-- Stated rules may be in indexes, constraints and generated columns; settings may not.
CREATE TABLE shapes (
  id int PRIMARY KEY, ewkb bytea CHECK (wt_is_valid(ewkb, '{"planarity": 0.05}')),
  blob bytea GENERATED ALWAYS AS (wt_encode(ewkb, '{"planarity": 0.05}')) STORED);
CREATE INDEX shapes_flat ON shapes (id) WHERE wt_is_valid(ewkb);
INSERT INTO shapes SELECT 1, warped() UNION ALL SELECT 2, ewkb FROM solids WHERE name = 'cube';
SELECT id, wt_rules_of(blob)->'planarity' AS planarity FROM shapes ORDER BY id;
SET enable_seqscan = off;
EXPLAIN (COSTS OFF) SELECT id FROM shapes WHERE wt_is_valid(ewkb);
SELECT id FROM shapes WHERE wt_is_valid(ewkb);
RESET enable_seqscan;
CREATE INDEX ON shapes (wt_is_valid(ewkb, wt_rules()));
ALTER TABLE shapes ADD other bytea GENERATED ALWAYS AS (wt_encode(ewkb, wt_rules())) STORED;

-- In a parallel plan the workers have the rules of the session.
CREATE TABLE much AS SELECT warped() AS ewkb FROM generate_series(1, 200);
ALTER TABLE much SET (parallel_workers = 2);
SET parallel_setup_cost = 0;
SET parallel_tuple_cost = 0;
SET min_parallel_table_scan_size = 0;
SET watertight.planarity = 0.05;
EXPLAIN (COSTS OFF) SELECT count(*) FROM much WHERE wt_is_valid(ewkb, wt_rules());
SELECT count(*) FROM much WHERE wt_is_valid(ewkb, wt_rules());
DROP TABLE much;
