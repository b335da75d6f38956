-- An index on boxes gives what a look at every row gives.
CREATE TABLE field AS
  SELECT i, format('POLYHEDRALSURFACE Z (((%1$s %2$s 0,%1$s %4$s 0,%3$s %2$s 0,%1$s %2$s 0)),((%1$s %2$s 0,%3$s %2$s 0,%1$s %2$s %5$s,%1$s %2$s 0)),((%1$s %2$s 0,%1$s %2$s %5$s,%1$s %4$s 0,%1$s %2$s 0)),((%3$s %2$s 0,%1$s %4$s 0,%1$s %2$s %5$s,%3$s %2$s 0)))',
    x, y, x + 1 + i % 7, y + 1 + i % 5, 1 + i % 11)::solid AS shape
  FROM (SELECT i, (i * 7919) % 1000 AS x, (i * 104729) % 997 AS y FROM generate_series(1, 3000) AS i) AS places;
CREATE INDEX field_box ON field USING gist (shape);
ANALYZE field;
CREATE TABLE windows AS SELECT i, wt_box(i * 30, i * 20, -1, i * 30 + 60, i * 20 + 90, i % 9) AS box FROM generate_series(0, 30) AS i;
CREATE FUNCTION answers() RETURNS TABLE (question text, answer text) LANGUAGE sql AS $$
  SELECT '&&', md5(string_agg(format('%s %s', w.i, f.i), ',' ORDER BY w.i, f.i)) FROM windows w JOIN field f ON f.shape && w.box
  UNION ALL SELECT '@>', md5(string_agg(format('%s %s', w.i, f.i), ',' ORDER BY w.i, f.i)) FROM windows w JOIN field f ON f.shape @> wt_box(wt_bound(w.box, 1), wt_bound(w.box, 2), 0, wt_bound(w.box, 1), wt_bound(w.box, 2), 0)
  UNION ALL SELECT '<@', md5(string_agg(format('%s %s', w.i, f.i), ',' ORDER BY w.i, f.i)) FROM windows w JOIN field f ON f.shape <@ w.box
  UNION ALL SELECT 'solids &&', md5(string_agg(format('%s %s', a.i, b.i), ',' ORDER BY a.i, b.i)) FROM field a JOIN field b ON a.shape && b.shape WHERE a.i < 300
  UNION ALL SELECT 'solids <@', md5(string_agg(format('%s %s', a.i, b.i), ',' ORDER BY a.i, b.i)) FROM field a JOIN field b ON a.shape <@ b.shape WHERE a.i < 300
  UNION ALL SELECT '<->', md5(string_agg(d::text, ',' ORDER BY w.i, d)) FROM windows w, LATERAL (SELECT f.shape <-> w.box AS d FROM field f ORDER BY f.shape <-> w.box LIMIT 20) AS near
$$;
SET enable_seqscan = off;
EXPLAIN (COSTS OFF) SELECT i FROM field WHERE shape && 'BOX3D(0 0 0,50 50 5)'::wt_box;
EXPLAIN (COSTS OFF) SELECT i FROM field ORDER BY shape <-> 'BOX3D(0 0 0,50 50 5)'::wt_box LIMIT 5;
CREATE TABLE by_index AS SELECT * FROM answers();
RESET enable_seqscan;
SET enable_indexscan = off;
SET enable_bitmapscan = off;
SELECT question, answer IS NOT NULL AND answer = (SELECT answer FROM by_index b WHERE b.question = a.question) AS same FROM answers() a;
RESET enable_indexscan;
RESET enable_bitmapscan;
-- A box on the left, and an index on ranges of pages, give the same.
SELECT count(*) AS different FROM windows w JOIN field f ON f.i <= 400
WHERE ((f.shape && w.box) <> (w.box && f.shape)) OR ((f.shape @> w.box) <> (w.box <@ f.shape)) OR ((f.shape <@ w.box) <> (w.box @> f.shape))
  OR ((f.shape <-> w.box) <> (w.box <-> f.shape)) OR ((f.shape && w.box) <> (wt_bbox(f.shape) && w.box))
  OR ((f.shape @> w.box) <> (wt_bbox(f.shape) @> w.box)) OR ((f.shape <@ w.box) <> (wt_bbox(f.shape) <@ w.box))
  OR ((f.shape <-> w.box) <> (wt_bbox(f.shape) <-> w.box));
SET enable_seqscan = off;
EXPLAIN (COSTS OFF) SELECT i FROM field WHERE 'BOX3D(0 0 0,50 50 5)'::wt_box && shape;
CREATE TABLE sorted AS SELECT i, shape FROM field UNION ALL SELECT i + 10000, NULL FROM field WHERE i < 50 ORDER BY 1;
CREATE INDEX sorted_range ON sorted USING brin (shape) WITH (pages_per_range = 2);
INSERT INTO sorted SELECT i + 3000, shape FROM field WHERE i % 3 = 0;
EXPLAIN (COSTS OFF) SELECT i FROM sorted WHERE shape && 'BOX3D(0 0 0,50 50 5)'::wt_box;
CREATE TABLE by_range AS
  SELECT w.i AS w, f.i, kind FROM windows w, unnest('{&&,@>,<@}'::text[]) AS kind, LATERAL (
    SELECT i FROM sorted WHERE kind = '&&' AND shape && w.box
    UNION ALL SELECT i FROM sorted WHERE kind = '@>' AND shape @> wt_box(wt_bound(w.box, 1), wt_bound(w.box, 2), 0, wt_bound(w.box, 1), wt_bound(w.box, 2), 0)
    UNION ALL SELECT i FROM sorted WHERE kind = '<@' AND shape <@ w.box) AS f;
DROP INDEX sorted_range;
RESET enable_seqscan;
SELECT kind, count(*) > 0 AS some, bool_and(CASE kind WHEN '&&' THEN shape && box WHEN '<@' THEN shape <@ box
    ELSE shape @> wt_box(wt_bound(box, 1), wt_bound(box, 2), 0, wt_bound(box, 1), wt_bound(box, 2), 0) END) AS right,
  count(*) = (SELECT count(*) FROM windows w JOIN sorted s ON CASE kind WHEN '&&' THEN shape && box WHEN '<@' THEN shape <@ box
    ELSE shape @> wt_box(wt_bound(box, 1), wt_bound(box, 2), 0, wt_bound(box, 1), wt_bound(box, 2), 0) END) AS all
FROM by_range r JOIN windows w ON w.i = r.w JOIN sorted s ON s.i = r.i GROUP BY kind ORDER BY kind;
DROP TABLE sorted, by_range;
-- After ANALYZE, estimates of rows are near the numbers of rows, also where towns are far apart.
CREATE FUNCTION is_near(query text) RETURNS boolean LANGUAGE plpgsql AS $$
DECLARE
  plan json;
  estimated float8;
  counted bigint;
BEGIN
  EXECUTE 'EXPLAIN (FORMAT JSON) ' || query INTO plan;
  estimated := (plan->0->'Plan'->>'Plan Rows')::float8;
  EXECUTE 'SELECT count(*) FROM (' || query || ') AS q' INTO counted;
  IF estimated NOT BETWEEN counted / 2.0 AND greatest(counted, 1) * 2.0 THEN
    RAISE NOTICE '% rows are estimated, there are %', estimated, counted;
    RETURN false;
  END IF;
  RETURN true;
END $$;
CREATE TABLE towns AS
  SELECT i, wt_translate(shape, i % 3 * 1e6, 0, i % 3 * 1000) AS shape FROM field UNION ALL SELECT -i, NULL FROM field WHERE i <= 1000;
CREATE TABLE moved AS
  SELECT wt_translate(shape, abs(hashint4(i) % 1000), abs(hashint4(-i) % 1000), 0) AS shape FROM field WHERE i % 3 = 0;
ANALYZE towns, moved;
SELECT query, is_near('SELECT FROM towns AS a ' || query) FROM unnest(ARRAY[
  'WHERE shape && wt_box(0, 0, 0, 200, 200, 100)',
  'WHERE shape && wt_box(1e6, 0, 0, 1.001e6, 1000, 2000)',
  'WHERE shape && wt_box(1.0001e6, 500, 1000, 1.0003e6, 600, 1002)',
  'WHERE shape && wt_box(5e5, 0, 0, 6e5, 1000, 2000)',
  'WHERE shape && wt_box(2e6, 0, 0, 2.0005e6, 500, 1000)',
  'WHERE shape <@ wt_box(2e6, 0, 0, 2.0005e6, 500, 3000)',
  'WHERE shape <@ wt_box(2e6, 0, 0, 2.0005e6, 500, 1999)',
  'WHERE shape @> wt_box(1, 1, 0, 900, 900, 1)',
  'WHERE shape && NULL::wt_box',
  'WHERE shape && (SELECT shape FROM towns WHERE i = 1)',
  'JOIN moved AS b ON a.shape && b.shape']) AS query;
SELECT is_near(format('SELECT FROM towns WHERE shape && %L::solid', (SELECT shape FROM towns WHERE i = 5))) AS near_a_solid;
CREATE TABLE little AS SELECT shape FROM towns WHERE i = 1;
ANALYZE little;
SELECT is_near('SELECT FROM little WHERE shape && wt_box(0, 0, 0, 1e5, 1e5, 1e5)') AS one_row;
UPDATE little SET shape = NULL;
ANALYZE little;
SELECT is_near('SELECT FROM little WHERE shape && wt_box(0, 0, 0, 1e5, 1e5, 1e5)') AS no_solid;
DROP TABLE little, moved, towns;
-- Rows that come and go.
DELETE FROM field WHERE i % 3 = 0;
INSERT INTO field SELECT i + 10000, shape FROM field WHERE i % 5 = 0;
UPDATE field SET shape = (SELECT shape FROM field WHERE i = 1) WHERE i BETWEEN 100 AND 130;
VACUUM field;
TRUNCATE by_index;
SET enable_seqscan = off;
INSERT INTO by_index SELECT * FROM answers();
RESET enable_seqscan;
SET enable_indexscan = off;
SET enable_bitmapscan = off;
SELECT question, answer IS NOT NULL AND answer = (SELECT answer FROM by_index b WHERE b.question = a.question) AS same FROM answers() a;
RESET enable_indexscan;
RESET enable_bitmapscan;
-- Values that lie outside of the row are read in part.
SELECT attstorage, atttypid::regtype FROM pg_attribute WHERE attrelid = 'field'::regclass AND attname = 'shape';
-- In a parallel plan.
ALTER TABLE field SET (parallel_workers = 2);
SET parallel_setup_cost = 0;
SET parallel_tuple_cost = 0;
SET min_parallel_table_scan_size = 0;
EXPLAIN (COSTS OFF) SELECT count(*), sum(wt_volume(shape)), wt_extent(shape) FROM field;
SELECT count(*), sum(wt_volume(shape)) > 0 AS volume, wt_extent(shape) FROM field;
DROP TABLE field CASCADE;
