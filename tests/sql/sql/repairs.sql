-- Invalid solids made valid, and those that are not.
SELECT name, wt_is_valid(ewkb) AS valid, wt_repair_report(ewkb)->>'outcome' AS by_default,
       wt_repair_report(ewkb, 'all') - 'holes' AS by_all
FROM solids ORDER BY name;
SELECT wt_repair_report(ewkb, 'fill')->'holes' AS holes FROM solids WHERE name = 'open';
-- A smooth patch, or a filling and why there is none.
SELECT wt_repair_report(ewkb, 'smooth')->'holes'->0->'not_smooth'->>'reason' AS reason,
       wt_is_valid(wt_repair(ewkb, 'smooth')) AS valid
FROM solids WHERE name = 'open';
-- A valid solid stays as it is, byte for byte; a repaired one is valid, and stays then.
SELECT name, wt_repair(ewkb) = ewkb AS same FROM solids WHERE wt_is_valid(ewkb) ORDER BY name;
SELECT name, wt_is_valid(wt_repair(ewkb, 'all')) AS valid,
       wt_repair(wt_repair(ewkb, 'all'), 'all') = wt_repair(ewkb, 'all') AS stays,
       wt_volume(wt_solid(wt_repair(ewkb, 'all'))) AS volume
FROM solids WHERE name IN ('open', 'inside out') ORDER BY name;
-- No remedy that was asked for mends it: an error with the findings.
SELECT wt_repair(ewkb) FROM solids WHERE name = 'open';
SELECT wt_repair(ewkb, 'all') FROM solids WHERE name = 'cavity outside';
-- Arguments that are wrong.
SELECT wt_repair(ewkb, 'glue') FROM solids WHERE name = 'open';
SELECT wt_repair(ewkb, '') FROM solids WHERE name = 'open';
SELECT wt_repair(ewkb, 'weld', -1) FROM solids WHERE name = 'open';
SELECT wt_repair(ewkb, 'weld', 'NaN') FROM solids WHERE name = 'open';
SELECT wt_repair('\x0102'::bytea);
SELECT wt_repair(NULL) IS NULL AS none;
