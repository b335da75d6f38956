\set VERBOSITY default
-- A cylinder of radius 1 and height 2 between two circles.
CREATE TABLE breps AS SELECT name, jsonb_build_object('type', 'BRep', 'srid', 7415, 'solids', jsonb_build_array(solid)) AS brep
FROM (VALUES
  ('cylinder', '{"vertices":[[1,0,0],[1,0,2]],
     "edges":[{"vertices":[0,0],"curve":{"type":"circle","radius":1}},{"vertices":[1,1],"curve":{"type":"circle","origin":[0,0,2],"radius":1}}],
     "faces":[{"loops":[[-1]]},{"loops":[[1]]},{"surface":{"type":"cylinder","radius":1},"loops":[[0],[-2]]}]}'::jsonb),
  ('open', '{"vertices":[[1,0,0],[1,0,2]],
     "edges":[{"vertices":[0,0],"curve":{"type":"circle","radius":1}},{"vertices":[1,1],"curve":{"type":"circle","origin":[0,0,2],"radius":1}}],
     "faces":[{"loops":[[1]]},{"surface":{"type":"cylinder","radius":1},"loops":[[0],[-2]]}]}'),
  ('helicoid', '{"vertices":[[1,0,0],[1,0,2]],
     "edges":[{"vertices":[0,0],"curve":{"type":"circle","radius":1}},{"vertices":[1,1],"curve":{"type":"circle","origin":[0,0,2],"radius":1}}],
     "faces":[{"loops":[[-1]]},{"loops":[[1]]},{"surface":{"type":"helicoid"},"loops":[[0],[-2]]}]}')) v(name, solid);
SELECT chord, abs(wt_volume(wt_solid(wt_tessellate(brep, chord))) - 2 * pi()) < 6 * pi() * chord AS is_near,
       wt_srid(wt_solid(wt_tessellate(brep, chord))) AS srid
FROM breps, (VALUES (0.1), (0.01), (0.001)) c(chord) WHERE name = 'cylinder' ORDER BY chord;
SELECT wt_tessellate(brep) = wt_tessellate(brep, 0.01) AS by_default FROM breps WHERE name = 'cylinder';
-- Errors say what is wrong, and where.
SELECT wt_tessellate(brep) FROM breps WHERE name = 'open';
SELECT wt_tessellate(brep) FROM breps WHERE name = 'helicoid';
SELECT wt_tessellate(brep, 0) FROM breps WHERE name = 'cylinder';
SELECT wt_tessellate(brep, 'NaN') FROM breps WHERE name = 'cylinder';
SELECT wt_tessellate(jsonb_set(brep, '{solids,0,edges,1,vertices,0}', '7')) FROM breps WHERE name = 'cylinder';
SELECT wt_tessellate(jsonb_set(brep, '{solids}', '[]')) FROM breps WHERE name = 'cylinder';
SELECT wt_tessellate('{"type":"Solid"}');
SELECT wt_tessellate(NULL) IS NULL AS null_is_null;
