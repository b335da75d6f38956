-- The type solid: it holds valid solids only.
CREATE TABLE town (name text PRIMARY KEY, shape solid);
INSERT INTO town SELECT name, wt_solid(ewkb) FROM solids WHERE wt_is_valid(ewkb);
SELECT name, wt_volume(shape) AS volume, round(wt_area(shape)::numeric, 6) AS area, wt_srid(shape) AS srid, wt_bbox(shape) AS bbox,
       wt_vertex_count(shape) AS vertices, wt_facet_count(shape) AS facets, wt_shell_count(shape) AS shells, wt_genus(shape) AS genus
FROM town ORDER BY name;

-- Text is the blob; text, bytes and WKT lead back to the same solid.
SELECT name, shape::text = encode(wt_encode(ewkb), 'hex') AS blob,
       shape::text::solid = shape AS by_text, shape::bytea::solid = shape AS by_bytes,
       wt_solid(wt_as_ewkb(shape)) = shape AS by_ewkb, wt_as_text(shape)::solid = shape AS by_wkt,
       encode(ewkb, 'hex')::solid = shape AS by_hex_ewkb, wt_as_ewkb(shape) = ewkb AS same_ewkb,
       shape::bytea = wt_blob_of(shape) AS bytes, shape::jsonb = wt_info(shape::bytea) AS info,
       wt_solid_rules(shape) = wt_rules_of(shape::bytea) AS rules
FROM town JOIN solids USING (name) ORDER BY name;

-- Bytes are read as PostgreSQL writes them, too.
SELECT bool_and(ewkb::text::solid = shape AND (shape::bytea)::text::solid = shape) AS is_same FROM town JOIN solids USING (name);
SELECT '\x5'::solid;
SELECT '\x5g'::solid;
SELECT '\x'::solid;

-- Parts between heights.
SELECT name, wt_volume(part) AS volume, wt_facet_count(part) AS facets, wt_srid(part) = wt_srid(shape) AS same_srid
FROM town, unnest(wt_clip_z(shape, 0.25 * wt_bound(wt_bbox(shape), 6) + 0.75 * wt_bound(wt_bbox(shape), 3), 'Infinity')) AS part ORDER BY name;
SELECT name, cardinality(wt_clip_z(shape, '-Infinity', 'Infinity')) AS all, (wt_clip_z(shape, '-Infinity', 'Infinity'))[1] = shape AS is_same,
  cardinality(wt_clip_z(shape, 1e6, 2e6)) AS none FROM town ORDER BY name;
SELECT wt_clip_z(shape, 2, 2) FROM town LIMIT 1;
SELECT wt_clip_z(shape, 'NaN', 2) FROM town LIMIT 1;

-- Rules stay with the value, and come back with it.
SELECT wt_solid_rules(warped)->>'planarity' AS planarity, wt_solid_rules(warped::text::solid)->>'planarity' AS again
FROM (SELECT wt_solid(ewkb, '{"planarity": 0.5, "proof": "boundary"}') AS warped FROM solids WHERE name = 'cube') AS one;

-- An invalid solid has no value. The errors say what is wrong and where.
INSERT INTO town SELECT 'open', ewkb::solid FROM solids WHERE name = 'open';
SELECT 'POLYHEDRALSURFACE Z (((0 0 0,0 1 0,1 1 0,1 0 0,0 0 0)))'::solid;
\set VERBOSITY sqlstate
SELECT ewkb::solid FROM solids WHERE name = 'open';
SELECT '5754'::solid;
\set VERBOSITY default
SELECT wt_try_solid(ewkb) IS NULL AS is_null FROM solids WHERE name = 'open';
SELECT wt_try_solid(ewkb, '{"planarity": 0.5}') IS NULL AS is_null FROM solids WHERE name IN ('open', 'cube') ORDER BY name;
SELECT wt_try_solid(NULL) IS NULL AND wt_solid(NULL) IS NULL AND wt_volume(NULL) IS NULL AS is_null;
SELECT ''::solid;
SELECT '5754'::solid;
SELECT '575401'::solid;
SELECT 'POINT Z (1 2 3)'::solid;
SELECT 'POLYHEDRALSURFACE Z (((nan 0 0,0 1 0,1 1 0,1 0 0,nan 0 0)))'::solid;
SELECT 'POLYHEDRALSURFACE Z (((0 0 0,0 1 0'::solid;
SELECT '\x57540101'::bytea::solid;
SELECT (overlay(shape::bytea placing '\xff'::bytea from 12))::solid FROM town WHERE name = 'cube';
SELECT (substring(shape::bytea from 1 for 20))::solid FROM town WHERE name = 'cube';
SELECT wt_solid(ewkb, '{"colour": 1}') FROM solids WHERE name = 'cube';
SELECT wt_try_solid('\x00');
UPDATE town SET shape = 'POLYHEDRALSURFACE Z EMPTY' WHERE name = 'cube';

-- What is invalid stands beside, with its findings.
CREATE TABLE refused AS
  SELECT s.name AS solid, f.* FROM solids s, LATERAL wt_findings(s.ewkb) f WHERE wt_try_solid(s.ewkb) IS NULL;
SELECT solid, code, severity, shell, facet, other_facet, witness, measured, "limit", unit, message FROM refused ORDER BY solid, code, facet LIMIT 4;
SELECT code, severity FROM solids AS s, LATERAL wt_findings(ewkb, '{"planarity": 0.5}') WHERE s.name = 'open' ORDER BY code;

-- Equality, order and hash go by the solid, not by where its rings begin.
CREATE TABLE turned (shape solid);
INSERT INTO turned VALUES
  ('POLYHEDRALSURFACE Z (((0 0 0,0 1 0,1 0 0,0 0 0)),((0 0 0,1 0 0,0 0 1,0 0 0)),((0 0 0,0 0 1,0 1 0,0 0 0)),((1 0 0,0 1 0,0 0 1,1 0 0)))'),
  ('POLYHEDRALSURFACE Z (((0 1 0,0 0 1,1 0 0,0 1 0)),((1 0 0,0 0 0,0 1 0,1 0 0)),((1 0 0,0 0 1,0 0 0,1 0 0)),((0 0 1,0 1 0,0 0 0,0 0 1)))'),
  ('SRID=28992;POLYHEDRALSURFACE Z (((0 0 0,0 1 0,1 0 0,0 0 0)),((0 0 0,1 0 0,0 0 1,0 0 0)),((0 0 0,0 0 1,0 1 0,0 0 0)),((1 0 0,0 1 0,0 0 1,1 0 0)))');
SELECT count(*), count(DISTINCT shape), count(DISTINCT shape::text) AS texts FROM turned;
SELECT count(*) FROM turned a JOIN turned b ON a.shape = b.shape;
SELECT bool_and((a.shape < b.shape)::int + (a.shape = b.shape)::int + (a.shape > b.shape)::int = 1
                AND (a.shape <= b.shape) = NOT (a.shape > b.shape) AND (a.shape >= b.shape) = NOT (a.shape < b.shape)
                AND (a.shape <> b.shape) = NOT (a.shape = b.shape)) AS is_order
FROM (SELECT shape FROM town UNION ALL SELECT shape FROM turned) a, (SELECT shape FROM town UNION ALL SELECT shape FROM turned) b;
CREATE UNIQUE INDEX one_solid ON town (shape);
INSERT INTO town SELECT 'again', shape FROM town WHERE name = 'cube';
SET enable_hashagg = off;
SELECT count(*) FROM (SELECT shape FROM turned GROUP BY shape) g;
RESET enable_hashagg;

-- Binary transfer.
CREATE TABLE copied (LIKE town);
\copy town TO 'town.binary' (FORMAT binary)
\copy copied FROM 'town.binary' (FORMAT binary)
SELECT count(*) FROM copied JOIN town USING (name) WHERE copied.shape = town.shape AND copied.shape::text = town.shape::text;
SELECT (SELECT count(*) FROM copied) = (SELECT count(*) FROM town) AS complete;
\! rm town.binary
DROP TABLE copied;

-- Boxes.
SELECT 'BOX3D(1 2 3,4 5 6)'::wt_box, '( 1 2 3 , 4 5 6 )'::wt_box, wt_box(0, 0, 0, 1, 1, 1), wt_bound(wt_box(1, 2, 3, 4, 5, 6), 5);
SELECT 'BOX3D(1 2 3,4 5)'::wt_box;
SELECT 'BOX3D(1 2 3,0 5 6)'::wt_box;
SELECT 'BOX3D(1 2 nan,4 5 6)'::wt_box;
SELECT 'BOX3D(1 2 3,4 5 6) and more'::wt_box;
SELECT wt_box(0, 0, 'infinity', 1, 1, 1);
SELECT wt_bound(wt_box(1, 2, 3, 4, 5, 6), 7);
SELECT wt_extent(shape), wt_extent(shape) FILTER (WHERE false) FROM turned;
SELECT a.name, a.shape && b.shape AS overlaps, a.shape @> b.shape AS contains, a.shape <@ b.shape AS within, a.shape <-> b.shape AS distance
FROM town a, town b WHERE b.name = 'cube' AND a.name IN ('cube', 'hollow', 'pierced') ORDER BY a.name;

-- Facets.
SELECT facet, rings, round(area::numeric, 6) AS area, normal, tilt, azimuth, centroid, planarity FROM wt_faces((SELECT shape FROM town WHERE name = 'pierced')) ORDER BY facet;
SELECT name, round((sum(area) - wt_area(shape))::numeric, 9) AS difference, count(*) = wt_facet_count(shape) AS complete FROM town, wt_faces(shape) GROUP BY name, shape ORDER BY name;
SELECT round(tilt::numeric, 3) AS tilt, round(azimuth::numeric, 3) AS azimuth FROM wt_faces('POLYHEDRALSURFACE Z (((0 0 0,0 1 0,1 0 0,0 0 0)),((0 0 0,1 0 0,0 0 1,0 0 0)),((0 0 0,0 0 1,0 1 0,0 0 0)),((1 0 0,0 1 0,0 0 1,1 0 0)))') ORDER BY facet;
SELECT count(*) FROM wt_faces(NULL);

-- The centre of mass, and volumes below heights.
SELECT name, wt_centroid(shape), wt_volume_below(shape, -1) AS nothing, wt_volume_below(shape, 1) AS to_one, wt_volume_below(shape, 1e9) = wt_volume(shape) AS whole FROM town ORDER BY name;
SELECT wt_volume_below(shape, 'nan') FROM town WHERE name = 'cube';
SELECT wt_volume_below(shape, 'infinity') FROM town WHERE name = 'cube';

-- Places.
SELECT name, wt_contains(shape, 0.5, 0.5, 0.5) AS inside, wt_contains(shape, 1, 1, 1) AS corner, wt_contains(shape, 1, 0.25, 0.125) AS facet, wt_contains(shape, 1.0000000000000002, 0.5, 0.5) AS beside,
       wt_contains(shape, 2.5, 2.5, 2.5) AS in_cavity, wt_contains(shape, 2.5, 2.5, 2) AS on_cavity, wt_contains(shape, 5, 5, 1) AS below_cavity FROM town WHERE name IN ('cube', 'hollow') ORDER BY name;
SELECT wt_contains(shape, 84602.25, 447002.5, 1) AS in_tunnel, wt_contains(shape, 84601.25, 447002.5, 1) AS on_wall, wt_contains(shape, 84601, 447002.5, 1) AS inside FROM town WHERE name = 'pierced';
SELECT wt_contains(shape, 'nan', 0, 0) FROM town WHERE name = 'cube';
SELECT bool_and(wt_contains(shape, (centroid)[1], (centroid)[2], (centroid)[3])) AS centres_of_facets FROM town, wt_faces(shape) WHERE name = 'cube';

-- Moved solids.
SELECT name, wt_bbox(wt_translate(shape, 0.1, -0.2, 1e6)) AS bbox, wt_volume(wt_translate(shape, 0.1, 0.2, 0.3)) = wt_volume(shape) AS same_volume,
       wt_translate(wt_translate(shape, 0.1, 0.2, 0.3), -0.1, -0.2, -0.3) = shape AS back, wt_solid_rules(wt_translate(shape, 1, 2, 3)) = wt_solid_rules(shape) AS same_rules
FROM town ORDER BY name;
SELECT wt_translate(shape, 1e-300, 0, 0) FROM town WHERE name = 'cube';
SELECT wt_translate(shape, 'nan', 0, 0) FROM town WHERE name = 'cube';

-- How two solids meet.
CREATE TABLE pairs AS SELECT shape AS a, wt_translate(shape, x, y, z) AS b, x, y, z FROM town,
  (VALUES (0::float8, 0::float8, 0::float8), (0.5, 0, 0), (1, 0, 0), (1, 1, 0), (1, 1, 1), (1, 0.5, 0.25), (1.0001, 0, 0), (0.9999, 0, 0), (3, 0, 0)) AS v (x, y, z)
  WHERE name = 'cube';
SELECT x, y, z, wt_overlaps(a, b), wt_intersects(a, b), wt_shares_area(a, b), wt_overlaps(a, b) = wt_overlaps(b, a) AND wt_intersects(a, b) = wt_intersects(b, a) AND wt_shares_area(a, b) = wt_shares_area(b, a) AS symmetric FROM pairs ORDER BY x, y, z;
SELECT wt_overlaps(h.shape, wt_translate(c.shape, 2, 2, 2)) AS in_cavity, wt_shares_area(h.shape, wt_translate(c.shape, 2, 2, 2)) AS against_its_walls, wt_overlaps(h.shape, wt_translate(c.shape, 1.5, 2, 2)) AS through_its_wall
FROM town h, town c WHERE h.name = 'hollow' AND c.name = 'cube';
SELECT wt_overlaps(a.shape, b.shape) FROM town a, town b WHERE a.name = 'cube' AND b.name = 'postgis cube';
