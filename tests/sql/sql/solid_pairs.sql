-- Solids beside others, and solids for other programs. The table town is that of solid.sql.
\set VERBOSITY terse
CREATE TABLE boxes AS SELECT i AS id, wt_translate(shape, x, y, z) AS shape FROM town,
  (VALUES (0, 0::float8, 0::float8, 0::float8), (1, 1, 0, 0), (2, 1, 0.5, 0.25), (3, 1.03, 0, 0), (4, 4, 5, 0), (5, 0.5, 0, 0)) AS v (i, x, y, z)
  WHERE name = 'cube';

-- Party walls: in one plane, or within a tolerance; the order of the solids does not matter.
SELECT a.id, b.id, wt_shared_area(a.shape, b.shape), wt_shared_area(a.shape, b.shape, 0.03), wt_shared_area(a.shape, b.shape) = wt_shared_area(b.shape, a.shape) AS same
  FROM boxes a JOIN boxes b ON a.id < b.id ORDER BY 1, 2;
SELECT wt_shared_area(shape, shape, tolerance => -1) FROM boxes WHERE id = 0;
SELECT wt_shared_area(shape, shape, 'nan') FROM boxes WHERE id = 0;
SELECT wt_shared_area(a.shape, b.shape) FROM town a, town b WHERE a.name = 'cube' AND b.name = 'postgis cube';

-- Distances; 0 where there is a common point.
SELECT a.id, b.id, wt_distance(a.shape, b.shape), (wt_distance(a.shape, b.shape) = 0) = wt_intersects(a.shape, b.shape) AS agrees
  FROM boxes a JOIN boxes b ON a.id < b.id ORDER BY 1, 2;
SELECT wt_distance(shape, 4, 5, 1), wt_distance(shape, 0.5, 0.5, 0.5), wt_distance(shape, 1, 1, 1.25) FROM boxes WHERE id = 0;
SELECT wt_distance(shape, 1, 'infinity', 1) FROM boxes WHERE id = 0;
SELECT wt_distance(a.shape, b.shape) FROM town a, town b WHERE a.name = 'cube' AND b.name = 'postgis cube';

-- Lines of sight.
SELECT id, wt_intersects_segment(shape, -1, 0.5, 0.5, 9, 0.5, 0.5) AS through, wt_intersects_segment(shape, 0.5, 0.5, 0.5, 0.6, 0.5, 0.5) AS inside,
  wt_intersects_segment(shape, -1, 1, 1, 9, 1, 1) AS along, wt_intersects_segment(shape, -1, 1, 1.0001, 9, 1, 1.0001) AS above FROM boxes ORDER BY id;
SELECT wt_intersects_segment(shape, 0, 0, 0, 0, 0, 'nan') FROM boxes WHERE id = 0;

-- Parts of a building that share interior (601).
SELECT f->>'code' AS code, f->'place'->>'solid' AS first, f->'other'->>'solid' AS second, (f->>'measured')::float8 AS depth, f->>'unit' AS unit
  FROM (SELECT wt_check_parts(shape ORDER BY id) AS findings FROM boxes WHERE id IN (0, 1, 5)) AS c, jsonb_array_elements(findings) AS f ORDER BY 2, 3;
SELECT wt_check_parts(shape) FROM boxes WHERE id IN (0, 1, 4);
SELECT wt_check_parts(shape) FROM boxes WHERE id > 100;
SELECT wt_check_parts(shape) FROM town WHERE name IN ('cube', 'postgis cube');

-- Documents. An array of solids becomes one.
SELECT wt_as_obj(shape) FROM boxes WHERE id = 0;
SELECT wt_as_cityjson(shape, 'a "cube"') FROM boxes WHERE id = 3;
SELECT d->>'type' AS type, jsonb_object_agg(o.key, jsonb_array_length(o.value->'geometry'->0->'boundaries'->0)) AS facets, jsonb_array_length(d->'vertices') AS vertices
  FROM (SELECT wt_cityjson_of(array_agg(shape ORDER BY id), array_agg('b' || id ORDER BY id))::jsonb AS d FROM boxes) AS c, jsonb_each(d->'CityObjects') AS o GROUP BY d;
SELECT wt_cityjson_of(array_agg(shape), ARRAY['one']) FROM boxes;
SELECT wt_cityjson_of(array_agg(shape), ARRAY['one', NULL]) FROM boxes WHERE id < 2;
SELECT wt_as_obj(shape) FROM town WHERE name = 'hollow';
SELECT encode(substr(wt_as_glb(shape), 1, 4), 'escape') AS magic, length(wt_as_glb(shape)) > 1000 AS has_triangles FROM town WHERE name = 'hollow';
SELECT name, encode(substr(wt_boundary(shape), 1, 5), 'hex') AS head, wt_facet_count(shape) AS facets FROM town ORDER BY name;

-- Tetrahedra fill the volume.
SELECT name, round(sum(abs((b[1]-a[1])*((c[2]-a[2])*(d[3]-a[3])-(c[3]-a[3])*(d[2]-a[2])) + (b[2]-a[2])*((c[3]-a[3])*(d[1]-a[1])-(c[1]-a[1])*(d[3]-a[3]))
    + (b[3]-a[3])*((c[1]-a[1])*(d[2]-a[2])-(c[2]-a[2])*(d[1]-a[1]))))::numeric / 6, 9) = round(wt_volume(shape)::numeric, 9) AS filled
  FROM town, LATERAL wt_tetrahedra(shape) GROUP BY name, wt_volume(shape) ORDER BY name;

-- Pages give blobs back.
SELECT count(*) AS solids, bool_and(wt_blob(page, (n - 1)::int) = wt_blob_of(shape)) AS same, max(length(page)) < sum(length(wt_blob_of(shape))) AS smaller
  FROM (SELECT wt_page_agg(shape ORDER BY id) AS page FROM boxes WHERE id IN (0, 1, 4)) AS p,
    (SELECT row_number() OVER (ORDER BY id) AS n, shape FROM boxes WHERE id IN (0, 1, 4)) AS b;
SELECT wt_page_agg(shape) IS NULL AS has_no_page FROM boxes WHERE id = 0;

-- Other reference systems: there and back, to a tenth of a millimetre.
SELECT wt_srid(moved), round(wt_volume(moved)::numeric, 12) AS cubic_degrees, abs(wt_volume(wt_transform(moved, 7415)) - wt_volume(shape)) < 1e-3 AS same_volume
  FROM (SELECT shape, wt_transform(wt_translate(shape, 84000, 445000, 0), 4979) AS moved FROM town WHERE name = 'postgis cube') AS m;
SELECT wt_transform(shape, 28992) FROM boxes WHERE id = 0;
SELECT wt_transform(shape, 999999) FROM town WHERE name = 'postgis cube';
SELECT wt_transform(shape, 0) FROM town WHERE name = 'postgis cube';

-- A column is judged again: damaged blobs among good ones.
SELECT count(*) AS findings FROM wt_recheck('town', 'shape');
CREATE TABLE blobs (id integer, blob bytea) PARTITION BY LIST (id);
CREATE TABLE blobs_1 PARTITION OF blobs FOR VALUES IN (1, 2);
CREATE TABLE blobs_2 PARTITION OF blobs FOR VALUES IN (3, 4);
INSERT INTO blobs SELECT 1, wt_blob_of(shape) FROM town WHERE name = 'hollow'
  UNION ALL SELECT 2, overlay(wt_blob_of(shape) placing '\xff'::bytea from 12) FROM town WHERE name = 'hollow'
  UNION ALL SELECT 3, NULL UNION ALL SELECT 4, '\x5754'::bytea;
SELECT part, place, code, name, message FROM wt_recheck('blobs', 'blob');
SELECT * FROM wt_recheck('blobs', 'none');
SELECT * FROM wt_recheck('blobs', 'id');
DROP TABLE blobs;
DROP TABLE boxes;
