-- The view over the tables of the service: what it is made of. docs/sql.md has it at work.
SELECT wt_make_city_view();
-- Semantic surfaces of the facets, through all shells of a solid.
SELECT wt_stored_semantics('{"type": "Solid", "semantics": {"surfaces": [{"type": "A"}, {"type": "B"}], "values": [[0, 1, null], [1]]}}', 0);
SELECT number, wt_stored_semantics('{"type": "MultiSolid", "semantics": {"surfaces": [{"type": "A"}, {"type": "B"}], "values": [[[0]], [[1, null]], null]}}', number)
FROM generate_series(0, 3) number;
-- Semantics that say nothing, or nonsense.
SELECT geometry, wt_stored_semantics(geometry::jsonb, 0) FROM (VALUES ('{"type": "Solid"}'), ('[]'), ('null'), ('{"semantics": 5}'),
  ('{"type": "Solid", "semantics": {"surfaces": [], "values": [null]}}'), ('{"type": "Solid", "semantics": {"surfaces": [], "values": [[7]]}}'),
  ('{"type": "Solid", "semantics": {"values": 5}}'), ('{"type": "Solid", "semantics": {"surfaces": 1, "values": [["x"]]}}')) v (geometry);
-- Texts that are damaged.
SELECT wt_stored_model('', '', 'a');
SELECT wt_stored_model('\x00', '', 'a');
SELECT wt_stored_model('\xffffffffffffffff', '', 'a');
SELECT wt_stored_model('\x0102030405060708090a', '\x0102', 'a');
SELECT wt_stored_model(NULL, '', 'a') IS NULL;
SELECT wt_stored_repair('\x0102030405060708090a', '\x0102', 'a', 0);
SELECT wt_stored_repair(NULL, '', 'a', 0) IS NULL;
