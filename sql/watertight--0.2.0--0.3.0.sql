-- SPDX-License-Identifier: GPL-3.0-or-later
-- The type solid, which holds valid solids only, the type wt_box, and an index on boxes.
-- Costs are as in version 0.1.0: a tenth of what is measured, in units of 0.1 microseconds.
\echo Use "ALTER EXTENSION watertight UPDATE" to load this file. \quit

CREATE TYPE solid;
CREATE FUNCTION wt_solid_in(cstring) RETURNS solid
  AS 'MODULE_PATHNAME', 'wt_solid_in' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 10000;
CREATE FUNCTION wt_solid_out(solid) RETURNS cstring
  AS 'MODULE_PATHNAME', 'wt_solid_out' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 2;
CREATE FUNCTION wt_solid_recv(internal) RETURNS solid
  AS 'MODULE_PATHNAME', 'wt_solid_recv' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 10000;
CREATE FUNCTION wt_solid_send(solid) RETURNS bytea
  AS 'MODULE_PATHNAME', 'wt_solid_blob' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 2;
CREATE FUNCTION wt_solid_analyze(internal) RETURNS boolean
  AS 'MODULE_PATHNAME', 'wt_solid_analyze' LANGUAGE C STRICT;
COMMENT ON FUNCTION wt_solid_analyze(internal) IS 'makes ANALYZE keep where the boxes of a column are';
-- Blobs are compressed already, so values that are too long for a row are moved out as they are.
CREATE TYPE solid (INPUT = wt_solid_in, OUTPUT = wt_solid_out, RECEIVE = wt_solid_recv, SEND = wt_solid_send,
  ANALYZE = wt_solid_analyze, INTERNALLENGTH = variable, ALIGNMENT = int4, STORAGE = external);
COMMENT ON TYPE solid IS
  'a valid closed solid: text is its blob in hexadecimal digits; reads blobs, EWKB and WKT, and refuses what is invalid';
COMMENT ON FUNCTION wt_solid_in(cstring) IS 'solid of a blob or EWKB in hexadecimal digits, or of WKT';
COMMENT ON FUNCTION wt_solid_out(solid) IS 'blob of a solid in hexadecimal digits';
COMMENT ON FUNCTION wt_solid_recv(internal) IS 'solid of a blob or EWKB';
COMMENT ON FUNCTION wt_solid_send(solid) IS 'blob of a solid';

CREATE TYPE wt_box;
CREATE FUNCTION wt_box_in(cstring) RETURNS wt_box
  AS 'MODULE_PATHNAME', 'wt_box_in' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
CREATE FUNCTION wt_box_out(wt_box) RETURNS cstring
  AS 'MODULE_PATHNAME', 'wt_box_out' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
CREATE FUNCTION wt_box_recv(internal) RETURNS wt_box
  AS 'MODULE_PATHNAME', 'wt_box_recv' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
CREATE FUNCTION wt_box_send(wt_box) RETURNS bytea
  AS 'MODULE_PATHNAME', 'wt_box_send' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
CREATE TYPE wt_box (INPUT = wt_box_in, OUTPUT = wt_box_out, RECEIVE = wt_box_recv, SEND = wt_box_send,
  INTERNALLENGTH = 48, ALIGNMENT = double);
COMMENT ON TYPE wt_box IS 'a closed box, as PostGIS writes one: BOX3D(x y z,x y z)';
COMMENT ON FUNCTION wt_box_in(cstring) IS 'box of BOX3D(x y z,x y z)';
COMMENT ON FUNCTION wt_box_out(wt_box) IS 'text of a box';
COMMENT ON FUNCTION wt_box_recv(internal) IS 'box of six numbers';
COMMENT ON FUNCTION wt_box_send(wt_box) IS 'a box as six numbers';
CREATE FUNCTION wt_box(min_x float8, min_y float8, min_z float8, max_x float8, max_y float8, max_z float8) RETURNS wt_box
  AS 'MODULE_PATHNAME', 'wt_box_make' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
COMMENT ON FUNCTION wt_box(float8, float8, float8, float8, float8, float8) IS 'box between two corners';
CREATE FUNCTION wt_bound(box wt_box, number integer) RETURNS float8
  AS 'MODULE_PATHNAME', 'wt_box_bound' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
COMMENT ON FUNCTION wt_bound(wt_box, integer) IS
  'bound of a box by its number: 1, 2, 3 are the least x, y, z, and 4, 5, 6 the largest';

-- Solids of other values, and back.
CREATE FUNCTION wt_solid(bytes bytea) RETURNS solid
  AS 'MODULE_PATHNAME', 'wt_solid_of_bytes' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 10000;
COMMENT ON FUNCTION wt_solid(bytea) IS
  'solid of EWKB (POLYHEDRALSURFACE Z or SOLID Z) by the default rules, or of a blob by the rules that it states; an invalid one is an error with its findings';
CREATE FUNCTION wt_solid(bytes bytea, rules jsonb) RETURNS solid
  AS 'MODULE_PATHNAME', 'wt_solid_of_bytes' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 10000;
COMMENT ON FUNCTION wt_solid(bytea, jsonb) IS
  'solid of EWKB by these rules, which the value keeps; those that are not stated are the default ones';
CREATE FUNCTION wt_try_solid(bytes bytea) RETURNS solid
  AS 'MODULE_PATHNAME', 'wt_try_solid' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 10000;
COMMENT ON FUNCTION wt_try_solid(bytea) IS
  'wt_solid, but NULL for an invalid solid; bytes that cannot be read, and undecided solids, are errors';
CREATE FUNCTION wt_try_solid(bytes bytea, rules jsonb) RETURNS solid
  AS 'MODULE_PATHNAME', 'wt_try_solid' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 10000;
COMMENT ON FUNCTION wt_try_solid(bytea, jsonb) IS
  'wt_solid by these rules, but NULL for an invalid solid; bytes that cannot be read, and undecided solids, are errors';
CREATE FUNCTION wt_blob_of(solid solid) RETURNS bytea
  AS 'MODULE_PATHNAME', 'wt_solid_blob' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
COMMENT ON FUNCTION wt_blob_of(solid) IS 'blob of a solid';
CREATE FUNCTION wt_as_ewkb(solid solid) RETURNS bytea
  AS 'MODULE_PATHNAME', 'wt_solid_ewkb' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 50;
COMMENT ON FUNCTION wt_as_ewkb(solid) IS
  'EWKB of a solid: POLYHEDRALSURFACE Z, or SOLID Z when it has cavities; PostGIS reads the former';
CREATE FUNCTION wt_as_text(solid solid) RETURNS text
  AS 'MODULE_PATHNAME', 'wt_solid_wkt' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 50;
COMMENT ON FUNCTION wt_as_text(solid) IS 'WKT of a solid: POLYHEDRALSURFACE Z, or SOLID Z when it has cavities';
CREATE FUNCTION wt_as_obj(solid solid) RETURNS text
  AS 'MODULE_PATHNAME', 'wt_solid_obj' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 100;
COMMENT ON FUNCTION wt_as_obj(solid) IS 'OBJ document of a solid; facets with holes are triangles, cavities are an error';
CREATE FUNCTION wt_as_cityjson(solid solid, id text DEFAULT 'solid') RETURNS text
  AS 'MODULE_PATHNAME', 'wt_solid_city_json' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 300;
COMMENT ON FUNCTION wt_as_cityjson(solid, text) IS 'CityJSON document of a solid, as a city object of this id';
CREATE FUNCTION wt_cityjson_of(solids solid[], ids text[]) RETURNS text
  AS 'MODULE_PATHNAME', 'wt_solid_city_json_of_array' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 10000;
COMMENT ON FUNCTION wt_cityjson_of(solid[], text[]) IS
  'CityJSON document of many solids, each a city object with the id of the same number: wt_cityjson_of(array_agg(solid), array_agg(id))';
CREATE FUNCTION wt_as_glb(solid solid) RETURNS bytea
  AS 'MODULE_PATHNAME', 'wt_solid_glb' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 300;
COMMENT ON FUNCTION wt_as_glb(solid) IS
  'binary glTF of a solid, in metres from the low corner of its box; facets look like roofs, walls or grounds by their tilt';
CREATE FUNCTION wt_boundary(solid solid) RETURNS bytea
  AS 'MODULE_PATHNAME', 'wt_solid_boundary' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 50;
COMMENT ON FUNCTION wt_boundary(solid) IS
  'EWKB of the facets of a solid, cavities included, as a MULTIPOLYGON Z, for programs that know no solids';
CREATE FUNCTION wt_tetrahedra(solid solid, OUT tetrahedron integer, OUT a float8[], OUT b float8[], OUT c float8[],
    OUT d float8[]) RETURNS SETOF record
  AS 'MODULE_PATHNAME', 'wt_solid_tetrahedra' LANGUAGE C STABLE STRICT PARALLEL SAFE COST 10000 ROWS 100;
COMMENT ON FUNCTION wt_tetrahedra(solid) IS
  'the tetrahedra that fill a solid, from its constrained Delaunay tetrahedralization, made and certified again';
-- The aggregates below gather solids in an array, without NULL.
CREATE FUNCTION wt_append(solids solid[], solid solid) RETURNS solid[]
  AS 'array_append' LANGUAGE internal IMMUTABLE STRICT PARALLEL SAFE;
COMMENT ON FUNCTION wt_append(solid[], solid) IS 'the array with a solid more, for aggregates';
CREATE FUNCTION wt_page_of(solids solid[]) RETURNS bytea
  AS 'MODULE_PATHNAME', 'wt_solid_page' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 10000;
COMMENT ON FUNCTION wt_page_of(solid[]) IS
  'page of the blobs of up to 256 solids on one grid, from which wt_blob gives them back; NULL where a page is not smaller than the blobs';
CREATE AGGREGATE wt_page_agg(solid) (SFUNC = wt_append, STYPE = solid[], INITCOND = '{}', FINALFUNC = wt_page_of);
COMMENT ON AGGREGATE wt_page_agg(solid) IS 'page of the blobs of solids, in their order; NULL where there is none (wt_page_of)';
CREATE FUNCTION wt_check_parts_of(solids solid[]) RETURNS jsonb
  AS 'MODULE_PATHNAME', 'wt_solid_parts' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 10000;
COMMENT ON FUNCTION wt_check_parts_of(solid[]) IS
  'findings about solids as the parts of one building: those that share interior (601), named by their numbers, from 0';
CREATE AGGREGATE wt_check_parts(solid) (SFUNC = wt_append, STYPE = solid[], INITCOND = '{}', FINALFUNC = wt_check_parts_of);
COMMENT ON AGGREGATE wt_check_parts(solid) IS
  'findings about the parts of a building: those that share interior (601), named by their numbers, from 0';
CREATE FUNCTION wt_translate(solid solid, x float8, y float8, z float8) RETURNS solid
  AS 'MODULE_PATHNAME', 'wt_solid_translate' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 1000;
COMMENT ON FUNCTION wt_translate(solid, float8, float8, float8) IS
  'the solid moved, without rounding; an error where its coordinates would have to be rounded';
CREATE FUNCTION wt_clip_z(solid solid, low float8, high float8) RETURNS solid[]
  AS 'MODULE_PATHNAME', 'wt_solid_clip_z' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 10000;
COMMENT ON FUNCTION wt_clip_z(solid, float8, float8) IS
  'the parts of a solid between two heights; new corners are rounded, and each part is judged anew';
CREATE FUNCTION wt_transform(solid solid, srid integer) RETURNS solid
  AS 'MODULE_PATHNAME', 'wt_solid_transform' LANGUAGE C STABLE STRICT PARALLEL SAFE COST 10000;
COMMENT ON FUNCTION wt_transform(solid, integer) IS
  'the solid in another EPSG system: x and y by PROJ, rounded to 0.0001 units or 1e-9 degrees, z as it is; judged anew';
CREATE FUNCTION wt_solid_info(solid solid) RETURNS jsonb
  AS 'MODULE_PATHNAME', 'wt_solid_info' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 100;
COMMENT ON FUNCTION wt_solid_info(solid) IS 'header, counts and sizes of the parts of the blob of a solid';
CREATE FUNCTION wt_solid_rules(solid solid) RETURNS jsonb
  AS 'MODULE_PATHNAME', 'wt_solid_rules' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 100;
COMMENT ON FUNCTION wt_solid_rules(solid) IS 'the rules under which a solid was accepted, as its value states them';
CREATE CAST (bytea AS solid) WITH FUNCTION wt_solid(bytea);
CREATE CAST (solid AS bytea) WITH FUNCTION wt_blob_of(solid);
CREATE CAST (solid AS jsonb) WITH FUNCTION wt_solid_info(solid);

-- Measures. The first four stand in the value; the others take its coordinates.
CREATE FUNCTION wt_volume(solid solid) RETURNS float8
  AS 'MODULE_PATHNAME', 'wt_solid_volume' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
COMMENT ON FUNCTION wt_volume(solid) IS
  'volume in cubic units of the reference system: the exact value, rounded once';
CREATE FUNCTION wt_area(solid solid) RETURNS float8
  AS 'MODULE_PATHNAME', 'wt_solid_area' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
COMMENT ON FUNCTION wt_area(solid) IS 'area of all facets in square units of the reference system';
CREATE FUNCTION wt_srid(solid solid) RETURNS integer
  AS 'MODULE_PATHNAME', 'wt_solid_srid' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
COMMENT ON FUNCTION wt_srid(solid) IS 'EPSG code of the reference system; 0: not stated';
CREATE FUNCTION wt_box(solid solid) RETURNS wt_box
  AS 'MODULE_PATHNAME', 'wt_solid_box' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
COMMENT ON FUNCTION wt_box(solid) IS
  'box of a solid, rounded outward to single precision, by which the operators and the index go';
CREATE FUNCTION wt_bbox(solid solid) RETURNS wt_box
  AS 'MODULE_PATHNAME', 'wt_solid_bbox' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 100;
COMMENT ON FUNCTION wt_bbox(solid) IS 'box of the vertices of a solid';
CREATE FUNCTION wt_vertex_count(solid solid) RETURNS integer
  AS 'MODULE_PATHNAME', 'wt_solid_vertex_count' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 100;
COMMENT ON FUNCTION wt_vertex_count(solid) IS 'number of vertices';
CREATE FUNCTION wt_facet_count(solid solid) RETURNS integer
  AS 'MODULE_PATHNAME', 'wt_solid_facet_count' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 100;
COMMENT ON FUNCTION wt_facet_count(solid) IS 'number of facets';
CREATE FUNCTION wt_shell_count(solid solid) RETURNS integer
  AS 'MODULE_PATHNAME', 'wt_solid_shell_count' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 100;
COMMENT ON FUNCTION wt_shell_count(solid) IS 'number of shells: one more than there are cavities';
CREATE FUNCTION wt_genus(solid solid) RETURNS bigint
  AS 'MODULE_PATHNAME', 'wt_solid_genus' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 100;
COMMENT ON FUNCTION wt_genus(solid) IS 'number of tunnels of all shells together';

CREATE FUNCTION wt_centroid(solid solid) RETURNS float8[]
  AS 'MODULE_PATHNAME', 'wt_solid_centroid' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 300;
COMMENT ON FUNCTION wt_centroid(solid) IS 'centre of mass: x, y and z, each the exact one, rounded once';
CREATE FUNCTION wt_volume_below(solid solid, height float8) RETURNS float8
  AS 'MODULE_PATHNAME', 'wt_solid_volume_below' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 300;
COMMENT ON FUNCTION wt_volume_below(solid, float8) IS
  'volume of the part of a solid below a height: the exact value, rounded once';
CREATE FUNCTION wt_contains(solid solid, x float8, y float8, z float8) RETURNS boolean
  AS 'MODULE_PATHNAME', 'wt_solid_contains_place' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 100;
COMMENT ON FUNCTION wt_contains(solid, float8, float8, float8) IS
  'whether a place is inside a solid or on its boundary, decided exactly; a place in a cavity is not inside';
CREATE FUNCTION wt_overlaps(solid, solid) RETURNS boolean
  AS 'MODULE_PATHNAME', 'wt_solid_overlaps' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 1000;
COMMENT ON FUNCTION wt_overlaps(solid, solid) IS 'whether a point is inside both solids, decided exactly';
CREATE FUNCTION wt_intersects(solid, solid) RETURNS boolean
  AS 'MODULE_PATHNAME', 'wt_solid_intersects' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 1000;
COMMENT ON FUNCTION wt_intersects(solid, solid) IS
  'whether two solids have a point in common, on their boundaries too, decided exactly';
CREATE FUNCTION wt_shares_area(solid, solid) RETURNS boolean
  AS 'MODULE_PATHNAME', 'wt_solid_shares_area' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 1000;
COMMENT ON FUNCTION wt_shares_area(solid, solid) IS
  'whether the boundaries of two solids have an area in common, and no point is inside both (a party wall), decided exactly';
CREATE FUNCTION wt_shared_area(solid, solid, tolerance float8 DEFAULT 0) RETURNS float8
  AS 'MODULE_PATHNAME', 'wt_solid_shared_area' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 1000;
COMMENT ON FUNCTION wt_shared_area(solid, solid, float8) IS
  'area in which two solids stand wall to wall (party walls): in exactly the same plane, or at most the tolerance apart';
CREATE FUNCTION wt_distance(solid, solid) RETURNS float8
  AS 'MODULE_PATHNAME', 'wt_solid_distance' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 1000;
COMMENT ON FUNCTION wt_distance(solid, solid) IS
  'least distance of two solids; 0 exactly if they have a point in common';
CREATE FUNCTION wt_distance(solid solid, x float8, y float8, z float8) RETURNS float8
  AS 'MODULE_PATHNAME', 'wt_solid_distance_of_place' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 300;
COMMENT ON FUNCTION wt_distance(solid, float8, float8, float8) IS
  'least distance of a solid from a place; 0 exactly if the place is inside or on the boundary';
CREATE FUNCTION wt_intersects_segment(solid solid, x1 float8, y1 float8, z1 float8, x2 float8, y2 float8, z2 float8)
  RETURNS boolean
  AS 'MODULE_PATHNAME', 'wt_solid_meets_segment' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 300;
COMMENT ON FUNCTION wt_intersects_segment(solid, float8, float8, float8, float8, float8, float8) IS
  'whether the segment between two places has a point in common with a solid, decided exactly (a line of sight)';
CREATE FUNCTION wt_faces(solid solid, OUT shell integer, OUT facet integer, OUT area float8, OUT normal float8[],
    OUT tilt float8, OUT azimuth float8, OUT centroid float8[], OUT planarity float8, OUT rings integer)
  RETURNS SETOF record
  AS 'MODULE_PATHNAME', 'wt_solid_faces' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 200 ROWS 20;
COMMENT ON FUNCTION wt_faces(solid) IS
  'facets of a solid, counted from 0: area, normal, tilt (degrees: 0 a flat roof, 90 a wall), azimuth (clockwise from north, NULL without), centroid, planarity (largest distance of a corner from the fitted plane), rings';

-- Repair.
CREATE FUNCTION wt_repair(ewkb bytea, remedies text DEFAULT 'rings,orientation,junctions', weld float8 DEFAULT 0) RETURNS bytea
  AS 'MODULE_PATHNAME', 'wt_repair' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 20000;
COMMENT ON FUNCTION wt_repair(bytea, text, float8) IS
  'the solid (EWKB), made valid by these remedies (rings, orientation, junctions, weld, facets, fill, or all) where it is not valid; vertices are welded at most so many metres away';
CREATE FUNCTION wt_repair_report(ewkb bytea, remedies text DEFAULT 'rings,orientation,junctions', weld float8 DEFAULT 0) RETURNS jsonb
  AS 'MODULE_PATHNAME', 'wt_repair_report' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 20000;
COMMENT ON FUNCTION wt_repair_report(bytea, text, float8) IS
  'what wt_repair does to a solid (EWKB): outcome, remedies, counts of changes, holes';

-- Curved solids.
CREATE FUNCTION wt_tessellate(brep jsonb, chord float8 DEFAULT 0.01) RETURNS bytea
  AS 'MODULE_PATHNAME', 'wt_tessellate' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 50000;
COMMENT ON FUNCTION wt_tessellate(jsonb, float8) IS
  'a valid polyhedron (EWKB) of one curved solid, given by its vertices, edges and faces (a boundary representation in JSON); its triangles are at most chord metres off the curved faces';

-- Findings as rows. The bodies are parsed here, so that they work in any schema and under any search path.
CREATE TYPE wt_finding AS (code integer, name text, severity text, shell integer, facet integer, other_facet integer,
  witness float8[], measured float8, "limit" float8, unit text, message text);
COMMENT ON TYPE wt_finding IS 'a finding about a solid; facets count from 0, the witness is a place';
CREATE FUNCTION wt_findings_of(report jsonb) RETURNS SETOF wt_finding
  LANGUAGE sql IMMUTABLE STRICT PARALLEL SAFE COST 10 ROWS 3
BEGIN ATOMIC
  SELECT (f->>'code')::integer, f->>'name', f->>'severity', (f->'place'->>'shell')::integer,
    (f->'place'->>'facet')::integer, (f->'other'->>'facet')::integer,
    CASE WHEN f ? 'witness' THEN ARRAY[(f->'witness'->>0)::float8, (f->'witness'->>1)::float8, (f->'witness'->>2)::float8] END,
    (f->>'measured')::float8, (f->>'limit')::float8, f->>'unit', f->>'text'
  FROM jsonb_array_elements((report->'errors') || (report->'warnings')) AS f;
END;
COMMENT ON FUNCTION wt_findings_of(jsonb) IS 'findings of a report of wt_validate as rows, errors first';
CREATE FUNCTION wt_findings(ewkb bytea) RETURNS SETOF wt_finding
  LANGUAGE sql IMMUTABLE STRICT PARALLEL SAFE COST 10000 ROWS 3
BEGIN ATOMIC
  SELECT f.* FROM wt_findings_of(wt_validate(ewkb)) AS f;
END;
COMMENT ON FUNCTION wt_findings(bytea) IS 'findings about a solid (EWKB) as rows, errors first';
CREATE FUNCTION wt_findings(ewkb bytea, rules jsonb) RETURNS SETOF wt_finding
  LANGUAGE sql IMMUTABLE STRICT PARALLEL SAFE COST 10000 ROWS 3
BEGIN ATOMIC
  SELECT f.* FROM wt_findings_of(wt_validate(ewkb, rules)) AS f;
END;
COMMENT ON FUNCTION wt_findings(bytea, jsonb) IS
  'findings about a solid (EWKB) by these rules as rows, errors first';

-- The body finds the extension's schema by name, because a dynamic statement is parsed when it runs.
CREATE FUNCTION wt_recheck(relation regclass, column_name name)
  RETURNS TABLE (part regclass, place tid, code integer, name text, facet integer, witness float8[], message text)
  LANGUAGE plpgsql STABLE STRICT PARALLEL SAFE COST 1000000 ROWS 10 AS $$
DECLARE
  home constant text := (SELECT pg_catalog.quote_ident(n.nspname) FROM pg_catalog.pg_extension AS e
    JOIN pg_catalog.pg_namespace AS n ON n.oid = e.extnamespace WHERE e.extname = 'watertight');
  blob bytea;
BEGIN
  FOR part, place, blob IN EXECUTE pg_catalog.format(
    'SELECT tableoid::regclass, ctid, %1$I::bytea FROM %2$s WHERE %1$I IS NOT NULL', column_name, relation)
  LOOP
    BEGIN
      RETURN QUERY EXECUTE pg_catalog.format(
        'SELECT $1, $2, f.code, f.name, f.facet, f.witness, f.message
         FROM %1$s.wt_findings(%1$s.wt_decode($3), %1$s.wt_rules_of($3)) AS f WHERE f.severity = $4', home)
        USING part, place, blob, 'error';
    EXCEPTION WHEN data_exception THEN
      code := NULL; name := NULL; facet := NULL; witness := NULL; message := SQLERRM;
      RETURN NEXT;
    END;
  END LOOP;
END $$;
COMMENT ON FUNCTION wt_recheck(regclass, name) IS
  'judges the solids or blobs of a column again, tetrahedralization included, by the rules that they state; a row for each error and for each blob that cannot be read';

-- Order and equality, by canonical forms.
CREATE FUNCTION wt_solid_lt(solid, solid) RETURNS boolean
  AS 'MODULE_PATHNAME', 'wt_solid_lt' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
CREATE FUNCTION wt_solid_le(solid, solid) RETURNS boolean
  AS 'MODULE_PATHNAME', 'wt_solid_le' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
CREATE FUNCTION wt_solid_eq(solid, solid) RETURNS boolean
  AS 'MODULE_PATHNAME', 'wt_solid_eq' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
CREATE FUNCTION wt_solid_ne(solid, solid) RETURNS boolean
  AS 'MODULE_PATHNAME', 'wt_solid_ne' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
CREATE FUNCTION wt_solid_ge(solid, solid) RETURNS boolean
  AS 'MODULE_PATHNAME', 'wt_solid_ge' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
CREATE FUNCTION wt_solid_gt(solid, solid) RETURNS boolean
  AS 'MODULE_PATHNAME', 'wt_solid_gt' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
CREATE FUNCTION wt_solid_cmp(solid, solid) RETURNS integer
  AS 'MODULE_PATHNAME', 'wt_solid_cmp' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
CREATE FUNCTION wt_solid_hash(solid) RETURNS integer
  AS 'MODULE_PATHNAME', 'wt_solid_hash' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
CREATE FUNCTION wt_solid_hash_extended(solid, bigint) RETURNS bigint
  AS 'MODULE_PATHNAME', 'wt_solid_hash_extended' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
COMMENT ON FUNCTION wt_solid_lt(solid, solid) IS 'implementation of the operator <';
COMMENT ON FUNCTION wt_solid_le(solid, solid) IS 'implementation of the operator <=';
COMMENT ON FUNCTION wt_solid_eq(solid, solid) IS 'implementation of the operator =';
COMMENT ON FUNCTION wt_solid_ne(solid, solid) IS 'implementation of the operator <>';
COMMENT ON FUNCTION wt_solid_ge(solid, solid) IS 'implementation of the operator >=';
COMMENT ON FUNCTION wt_solid_gt(solid, solid) IS 'implementation of the operator >';
COMMENT ON FUNCTION wt_solid_cmp(solid, solid) IS 'below, at or above 0, for indexes';
COMMENT ON FUNCTION wt_solid_hash(solid) IS 'hash of the canonical form, for indexes';
COMMENT ON FUNCTION wt_solid_hash_extended(solid, bigint) IS 'hash of the canonical form and a number, for indexes';
CREATE OPERATOR < (LEFTARG = solid, RIGHTARG = solid, FUNCTION = wt_solid_lt, COMMUTATOR = >, NEGATOR = >=,
  RESTRICT = scalarltsel, JOIN = scalarltjoinsel);
CREATE OPERATOR <= (LEFTARG = solid, RIGHTARG = solid, FUNCTION = wt_solid_le, COMMUTATOR = >=, NEGATOR = >,
  RESTRICT = scalarlesel, JOIN = scalarlejoinsel);
CREATE OPERATOR = (LEFTARG = solid, RIGHTARG = solid, FUNCTION = wt_solid_eq, COMMUTATOR = =, NEGATOR = <>,
  RESTRICT = eqsel, JOIN = eqjoinsel, HASHES, MERGES);
CREATE OPERATOR <> (LEFTARG = solid, RIGHTARG = solid, FUNCTION = wt_solid_ne, COMMUTATOR = <>, NEGATOR = =,
  RESTRICT = neqsel, JOIN = neqjoinsel);
CREATE OPERATOR >= (LEFTARG = solid, RIGHTARG = solid, FUNCTION = wt_solid_ge, COMMUTATOR = <=, NEGATOR = <,
  RESTRICT = scalargesel, JOIN = scalargejoinsel);
CREATE OPERATOR > (LEFTARG = solid, RIGHTARG = solid, FUNCTION = wt_solid_gt, COMMUTATOR = <, NEGATOR = <=,
  RESTRICT = scalargtsel, JOIN = scalargtjoinsel);
CREATE OPERATOR CLASS solid_ops DEFAULT FOR TYPE solid USING btree AS
  OPERATOR 1 <, OPERATOR 2 <=, OPERATOR 3 =, OPERATOR 4 >=, OPERATOR 5 >, FUNCTION 1 wt_solid_cmp(solid, solid);
CREATE OPERATOR CLASS solid_hash_ops DEFAULT FOR TYPE solid USING hash AS
  OPERATOR 1 =, FUNCTION 1 wt_solid_hash(solid), FUNCTION 2 wt_solid_hash_extended(solid, bigint);

-- Boxes of solids.
CREATE FUNCTION wt_boxes_overlap(solid, solid) RETURNS boolean
  AS 'MODULE_PATHNAME', 'wt_box_overlaps_solid' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
CREATE FUNCTION wt_boxes_overlap(solid, wt_box) RETURNS boolean
  AS 'MODULE_PATHNAME', 'wt_box_overlaps_box' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
CREATE FUNCTION wt_box_contains(solid, solid) RETURNS boolean
  AS 'MODULE_PATHNAME', 'wt_box_contains_solid' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
CREATE FUNCTION wt_box_contains(solid, wt_box) RETURNS boolean
  AS 'MODULE_PATHNAME', 'wt_box_contains_box' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
CREATE FUNCTION wt_box_within(solid, solid) RETURNS boolean
  AS 'MODULE_PATHNAME', 'wt_box_within_solid' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
CREATE FUNCTION wt_box_within(solid, wt_box) RETURNS boolean
  AS 'MODULE_PATHNAME', 'wt_box_within_box' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
CREATE FUNCTION wt_box_distance(solid, solid) RETURNS float8
  AS 'MODULE_PATHNAME', 'wt_box_distance_solid' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
CREATE FUNCTION wt_box_distance(solid, wt_box) RETURNS float8
  AS 'MODULE_PATHNAME', 'wt_box_distance_box' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
COMMENT ON FUNCTION wt_boxes_overlap(solid, solid) IS 'implementation of the operator &&';
COMMENT ON FUNCTION wt_boxes_overlap(solid, wt_box) IS 'implementation of the operator &&';
COMMENT ON FUNCTION wt_box_contains(solid, solid) IS 'implementation of the operator @>';
COMMENT ON FUNCTION wt_box_contains(solid, wt_box) IS 'implementation of the operator @>';
COMMENT ON FUNCTION wt_box_within(solid, solid) IS 'implementation of the operator <@';
COMMENT ON FUNCTION wt_box_within(solid, wt_box) IS 'implementation of the operator <@';
COMMENT ON FUNCTION wt_box_distance(solid, solid) IS 'implementation of the operator <->';
COMMENT ON FUNCTION wt_box_distance(solid, wt_box) IS 'implementation of the operator <->';
CREATE FUNCTION wt_boxes_overlap(wt_box, solid) RETURNS boolean
  AS 'MODULE_PATHNAME', 'wt_box_overlaps_of_box_solid' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
COMMENT ON FUNCTION wt_boxes_overlap(wt_box, solid) IS 'implementation of the operator &&';
CREATE FUNCTION wt_boxes_overlap(wt_box, wt_box) RETURNS boolean
  AS 'MODULE_PATHNAME', 'wt_box_overlaps_of_box_box' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
COMMENT ON FUNCTION wt_boxes_overlap(wt_box, wt_box) IS 'implementation of the operator &&';
CREATE FUNCTION wt_box_contains(wt_box, solid) RETURNS boolean
  AS 'MODULE_PATHNAME', 'wt_box_contains_of_box_solid' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
COMMENT ON FUNCTION wt_box_contains(wt_box, solid) IS 'implementation of the operator @>';
CREATE FUNCTION wt_box_contains(wt_box, wt_box) RETURNS boolean
  AS 'MODULE_PATHNAME', 'wt_box_contains_of_box_box' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
COMMENT ON FUNCTION wt_box_contains(wt_box, wt_box) IS 'implementation of the operator @>';
CREATE FUNCTION wt_box_within(wt_box, solid) RETURNS boolean
  AS 'MODULE_PATHNAME', 'wt_box_within_of_box_solid' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
COMMENT ON FUNCTION wt_box_within(wt_box, solid) IS 'implementation of the operator <@';
CREATE FUNCTION wt_box_within(wt_box, wt_box) RETURNS boolean
  AS 'MODULE_PATHNAME', 'wt_box_within_of_box_box' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
COMMENT ON FUNCTION wt_box_within(wt_box, wt_box) IS 'implementation of the operator <@';
CREATE FUNCTION wt_box_distance(wt_box, solid) RETURNS float8
  AS 'MODULE_PATHNAME', 'wt_box_distance_of_box_solid' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
COMMENT ON FUNCTION wt_box_distance(wt_box, solid) IS 'implementation of the operator <->';
CREATE FUNCTION wt_box_distance(wt_box, wt_box) RETURNS float8
  AS 'MODULE_PATHNAME', 'wt_box_distance_of_box_box' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
COMMENT ON FUNCTION wt_box_distance(wt_box, wt_box) IS 'implementation of the operator <->';
CREATE FUNCTION wt_box_overlaps_sel(internal, oid, internal, integer) RETURNS float8
  AS 'MODULE_PATHNAME', 'wt_box_overlaps_sel' LANGUAGE C STABLE STRICT PARALLEL SAFE;
CREATE FUNCTION wt_box_overlaps_joinsel(internal, oid, internal, smallint, internal) RETURNS float8
  AS 'MODULE_PATHNAME', 'wt_box_overlaps_joinsel' LANGUAGE C STABLE STRICT PARALLEL SAFE;
CREATE FUNCTION wt_box_contains_sel(internal, oid, internal, integer) RETURNS float8
  AS 'MODULE_PATHNAME', 'wt_box_contains_sel' LANGUAGE C STABLE STRICT PARALLEL SAFE;
CREATE FUNCTION wt_box_contains_joinsel(internal, oid, internal, smallint, internal) RETURNS float8
  AS 'MODULE_PATHNAME', 'wt_box_contains_joinsel' LANGUAGE C STABLE STRICT PARALLEL SAFE;
CREATE FUNCTION wt_box_within_sel(internal, oid, internal, integer) RETURNS float8
  AS 'MODULE_PATHNAME', 'wt_box_within_sel' LANGUAGE C STABLE STRICT PARALLEL SAFE;
CREATE FUNCTION wt_box_within_joinsel(internal, oid, internal, smallint, internal) RETURNS float8
  AS 'MODULE_PATHNAME', 'wt_box_within_joinsel' LANGUAGE C STABLE STRICT PARALLEL SAFE;
COMMENT ON FUNCTION wt_box_overlaps_sel(internal, oid, internal, integer) IS 'estimate of the rows that && selects';
COMMENT ON FUNCTION wt_box_overlaps_joinsel(internal, oid, internal, smallint, internal) IS 'estimate of the pairs that && joins';
COMMENT ON FUNCTION wt_box_contains_sel(internal, oid, internal, integer) IS 'estimate of the rows that @> selects';
COMMENT ON FUNCTION wt_box_contains_joinsel(internal, oid, internal, smallint, internal) IS 'estimate of the pairs that @> joins';
COMMENT ON FUNCTION wt_box_within_sel(internal, oid, internal, integer) IS 'estimate of the rows that <@ selects';
COMMENT ON FUNCTION wt_box_within_joinsel(internal, oid, internal, smallint, internal) IS 'estimate of the pairs that <@ joins';
CREATE OPERATOR && (LEFTARG = solid, RIGHTARG = solid, FUNCTION = wt_boxes_overlap, COMMUTATOR = &&,
  RESTRICT = wt_box_overlaps_sel, JOIN = wt_box_overlaps_joinsel);
CREATE OPERATOR && (LEFTARG = solid, RIGHTARG = wt_box, FUNCTION = wt_boxes_overlap, COMMUTATOR = &&,
  RESTRICT = wt_box_overlaps_sel, JOIN = wt_box_overlaps_joinsel);
CREATE OPERATOR @> (LEFTARG = solid, RIGHTARG = solid, FUNCTION = wt_box_contains, COMMUTATOR = <@,
  RESTRICT = wt_box_contains_sel, JOIN = wt_box_contains_joinsel);
CREATE OPERATOR @> (LEFTARG = solid, RIGHTARG = wt_box, FUNCTION = wt_box_contains, COMMUTATOR = <@,
  RESTRICT = wt_box_contains_sel, JOIN = wt_box_contains_joinsel);
CREATE OPERATOR <@ (LEFTARG = solid, RIGHTARG = solid, FUNCTION = wt_box_within, COMMUTATOR = @>,
  RESTRICT = wt_box_within_sel, JOIN = wt_box_within_joinsel);
CREATE OPERATOR <@ (LEFTARG = solid, RIGHTARG = wt_box, FUNCTION = wt_box_within, COMMUTATOR = @>,
  RESTRICT = wt_box_within_sel, JOIN = wt_box_within_joinsel);
CREATE OPERATOR <-> (LEFTARG = solid, RIGHTARG = solid, FUNCTION = wt_box_distance, COMMUTATOR = <->);
CREATE OPERATOR <-> (LEFTARG = solid, RIGHTARG = wt_box, FUNCTION = wt_box_distance, COMMUTATOR = <->);
CREATE OPERATOR && (LEFTARG = wt_box, RIGHTARG = solid, FUNCTION = wt_boxes_overlap, COMMUTATOR = &&,
  RESTRICT = wt_box_overlaps_sel, JOIN = wt_box_overlaps_joinsel);
CREATE OPERATOR && (LEFTARG = wt_box, RIGHTARG = wt_box, FUNCTION = wt_boxes_overlap, COMMUTATOR = &&,
  RESTRICT = wt_box_overlaps_sel, JOIN = wt_box_overlaps_joinsel);
CREATE OPERATOR @> (LEFTARG = wt_box, RIGHTARG = solid, FUNCTION = wt_box_contains, COMMUTATOR = <@,
  RESTRICT = wt_box_contains_sel, JOIN = wt_box_contains_joinsel);
CREATE OPERATOR @> (LEFTARG = wt_box, RIGHTARG = wt_box, FUNCTION = wt_box_contains, COMMUTATOR = <@,
  RESTRICT = wt_box_contains_sel, JOIN = wt_box_contains_joinsel);
CREATE OPERATOR <@ (LEFTARG = wt_box, RIGHTARG = solid, FUNCTION = wt_box_within, COMMUTATOR = @>,
  RESTRICT = wt_box_within_sel, JOIN = wt_box_within_joinsel);
CREATE OPERATOR <@ (LEFTARG = wt_box, RIGHTARG = wt_box, FUNCTION = wt_box_within, COMMUTATOR = @>,
  RESTRICT = wt_box_within_sel, JOIN = wt_box_within_joinsel);
CREATE OPERATOR <-> (LEFTARG = wt_box, RIGHTARG = solid, FUNCTION = wt_box_distance, COMMUTATOR = <->);
CREATE OPERATOR <-> (LEFTARG = wt_box, RIGHTARG = wt_box, FUNCTION = wt_box_distance, COMMUTATOR = <->);
COMMENT ON OPERATOR && (solid, solid) IS 'the boxes have a point in common';
COMMENT ON OPERATOR && (solid, wt_box) IS 'the boxes have a point in common';
COMMENT ON OPERATOR @> (solid, solid) IS 'the left box contains the right one';
COMMENT ON OPERATOR @> (solid, wt_box) IS 'the left box contains the right one';
COMMENT ON OPERATOR <@ (solid, solid) IS 'the left box is within the right one';
COMMENT ON OPERATOR <@ (solid, wt_box) IS 'the left box is within the right one';
COMMENT ON OPERATOR <-> (solid, solid) IS 'distance of the boxes';
COMMENT ON OPERATOR <-> (solid, wt_box) IS 'distance of the boxes';
COMMENT ON OPERATOR && (wt_box, solid) IS 'the boxes have a point in common';
COMMENT ON OPERATOR && (wt_box, wt_box) IS 'the boxes have a point in common';
COMMENT ON OPERATOR @> (wt_box, solid) IS 'the left box contains the right one';
COMMENT ON OPERATOR @> (wt_box, wt_box) IS 'the left box contains the right one';
COMMENT ON OPERATOR <@ (wt_box, solid) IS 'the left box is within the right one';
COMMENT ON OPERATOR <@ (wt_box, wt_box) IS 'the left box is within the right one';
COMMENT ON OPERATOR <-> (wt_box, solid) IS 'distance of the boxes';
COMMENT ON OPERATOR <-> (wt_box, wt_box) IS 'distance of the boxes';

CREATE FUNCTION wt_gist_consistent(internal, solid, smallint, oid, internal) RETURNS boolean
  AS 'MODULE_PATHNAME', 'wt_gist_consistent' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
CREATE FUNCTION wt_gist_union(internal, internal) RETURNS wt_box
  AS 'MODULE_PATHNAME', 'wt_gist_union' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
CREATE FUNCTION wt_gist_compress(internal) RETURNS internal
  AS 'MODULE_PATHNAME', 'wt_gist_compress' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
CREATE FUNCTION wt_gist_penalty(internal, internal, internal) RETURNS internal
  AS 'MODULE_PATHNAME', 'wt_gist_penalty' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
CREATE FUNCTION wt_gist_picksplit(internal, internal) RETURNS internal
  AS 'MODULE_PATHNAME', 'wt_gist_picksplit' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
CREATE FUNCTION wt_gist_same(wt_box, wt_box, internal) RETURNS internal
  AS 'MODULE_PATHNAME', 'wt_gist_same' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
CREATE FUNCTION wt_gist_distance(internal, solid, smallint, oid, internal) RETURNS float8
  AS 'MODULE_PATHNAME', 'wt_gist_distance' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
COMMENT ON FUNCTION wt_gist_consistent(internal, solid, smallint, oid, internal) IS 'for the index on boxes';
COMMENT ON FUNCTION wt_gist_union(internal, internal) IS 'for the index on boxes';
COMMENT ON FUNCTION wt_gist_compress(internal) IS 'for the index on boxes';
COMMENT ON FUNCTION wt_gist_penalty(internal, internal, internal) IS 'for the index on boxes';
COMMENT ON FUNCTION wt_gist_picksplit(internal, internal) IS 'for the index on boxes';
COMMENT ON FUNCTION wt_gist_same(wt_box, wt_box, internal) IS 'for the index on boxes';
COMMENT ON FUNCTION wt_gist_distance(internal, solid, smallint, oid, internal) IS 'for the index on boxes';
-- A number of an operator with a box on its right is 20 more than that with a solid (sql/module/box_index.c).
CREATE OPERATOR CLASS solid_box_ops DEFAULT FOR TYPE solid USING gist AS
  OPERATOR 3 && (solid, solid), OPERATOR 23 && (solid, wt_box),
  OPERATOR 7 @> (solid, solid), OPERATOR 27 @> (solid, wt_box),
  OPERATOR 8 <@ (solid, solid), OPERATOR 28 <@ (solid, wt_box),
  OPERATOR 15 <-> (solid, solid) FOR ORDER BY float_ops, OPERATOR 35 <-> (solid, wt_box) FOR ORDER BY float_ops,
  FUNCTION 1 wt_gist_consistent(internal, solid, smallint, oid, internal),
  FUNCTION 2 wt_gist_union(internal, internal),
  FUNCTION 3 wt_gist_compress(internal),
  FUNCTION 5 wt_gist_penalty(internal, internal, internal),
  FUNCTION 6 wt_gist_picksplit(internal, internal),
  FUNCTION 7 wt_gist_same(wt_box, wt_box, internal),
  FUNCTION 8 wt_gist_distance(internal, solid, smallint, oid, internal),
  STORAGE wt_box;

CREATE FUNCTION wt_box_extend(wt_box, solid) RETURNS wt_box
  AS 'MODULE_PATHNAME', 'wt_box_extend' LANGUAGE C IMMUTABLE PARALLEL SAFE;
CREATE FUNCTION wt_box_union(wt_box, wt_box) RETURNS wt_box
  AS 'MODULE_PATHNAME', 'wt_box_union' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
COMMENT ON FUNCTION wt_box_extend(wt_box, solid) IS 'box around a box and that of a solid, for wt_extent';
COMMENT ON FUNCTION wt_box_union(wt_box, wt_box) IS 'box around two boxes';
CREATE AGGREGATE wt_extent(solid) (SFUNC = wt_box_extend, STYPE = wt_box, COMBINEFUNC = wt_box_union, PARALLEL = safe);
COMMENT ON AGGREGATE wt_extent(solid) IS 'box around the boxes of solids';

-- BRIN keeps one box for a range of pages: for tables in the order of places, as exports and files are.
CREATE FUNCTION wt_brin_add(internal, internal, internal, internal) RETURNS boolean
  AS 'MODULE_PATHNAME', 'wt_box_brin_add' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
COMMENT ON FUNCTION wt_brin_add(internal, internal, internal, internal) IS 'for the index on ranges of pages';
CREATE OPERATOR CLASS solid_range_ops DEFAULT FOR TYPE solid USING brin AS
  OPERATOR 3 && (solid, solid), OPERATOR 3 && (solid, wt_box), OPERATOR 3 && (wt_box, solid), OPERATOR 3 && (wt_box, wt_box),
  OPERATOR 7 @> (solid, solid), OPERATOR 7 @> (solid, wt_box), OPERATOR 7 @> (wt_box, solid), OPERATOR 7 @> (wt_box, wt_box),
  OPERATOR 8 <@ (solid, solid), OPERATOR 8 <@ (solid, wt_box), OPERATOR 8 <@ (wt_box, solid), OPERATOR 8 <@ (wt_box, wt_box),
  FUNCTION 1 brin_inclusion_opcinfo(internal),
  FUNCTION 2 wt_brin_add(internal, internal, internal, internal),
  FUNCTION 3 brin_inclusion_consistent(internal, internal, internal),
  FUNCTION 4 brin_inclusion_union(internal, internal, internal),
  FUNCTION 11 wt_box_union(wt_box, wt_box),
  STORAGE wt_box;

-- The tables of the service as one view.
CREATE FUNCTION wt_stored_model(packed bytea, dictionary bytea, id text) RETURNS jsonb
  AS 'MODULE_PATHNAME', 'wt_solid_stored_model' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 200;
COMMENT ON FUNCTION wt_stored_model(bytea, bytea, text) IS
  'city model, without its coordinates, of the text of a feature that the service has stored; for the view watertight.city';
CREATE FUNCTION wt_stored_repair(packed bytea, dictionary bytea, id text, "position" int) RETURNS jsonb
  AS 'MODULE_PATHNAME', 'wt_solid_stored_repair' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 200;
COMMENT ON FUNCTION wt_stored_repair(bytea, bytea, text, int) IS
  'how a solid of a feature that the service has stored was repaired; NULL for one that came so; for the view watertight.city';
CREATE FUNCTION wt_stored_semantics(geometry jsonb, ordinal bigint) RETURNS jsonb
  LANGUAGE sql IMMUTABLE STRICT PARALLEL SAFE COST 200
  RETURN (
    SELECT jsonb_agg(coalesce(geometry #> ARRAY['semantics', 'surfaces', facet.number], 'null'::jsonb) ORDER BY shell.place, facet.place)
    FROM (SELECT geometry #> CASE geometry ->> 'type' WHEN 'Solid' THEN ARRAY['semantics', 'values']
                               ELSE ARRAY['semantics', 'values', ordinal::text] END AS shells) solid
    -- A shell whose values are null does not say how many facets it has.
    CROSS JOIN LATERAL jsonb_array_elements(
      CASE WHEN jsonb_typeof(solid.shells) = 'array' AND NOT jsonb_path_exists(solid.shells, 'strict $[*] ? (@.type() != "array")')
        THEN solid.shells END) WITH ORDINALITY AS shell(numbers, place)
    CROSS JOIN LATERAL jsonb_array_elements_text(shell.numbers) WITH ORDINALITY AS facet(number, place));
COMMENT ON FUNCTION wt_stored_semantics(jsonb, bigint) IS
  'semantic surfaces of the facets of a solid, of its geometry in a city model; for the view watertight.city';
CREATE FUNCTION wt_make_city_view() RETURNS void LANGUAGE plpgsql SET client_min_messages = warning AS $$
  DECLARE
    here regnamespace := (SELECT extnamespace FROM pg_extension WHERE extname = 'watertight');
    casts regnamespace := (SELECT extnamespace FROM pg_extension WHERE extname = 'watertight_postgis');
  BEGIN
    IF to_regclass('watertight.feature_row') IS NULL THEN
      RAISE 'there are no tables of the service in this database' USING ERRCODE = 'undefined_table',
        HINT = 'watertight serve and watertight ingest make them in the database that --database-url names.';
    END IF;
    EXECUTE 'DROP VIEW IF EXISTS watertight.city';
    EXECUTE format($view$
      CREATE VIEW watertight.city AS
        SELECT c.name AS collection, f.id AS feature, f.version, s.object_id AS object,
               m.model #>> ARRAY['CityObjects', s.object_id, 'type'] AS type, s.lod, s.geometry AS geometry_number, s.ordinal,
               s.is_proven, %1$s.wt_stored_repair(f.packed_text, coalesce(d.content, ''), f.id, s."position") AS repair,
               coalesce(m.model #> ARRAY['CityObjects', f.id, 'attributes'], '{}')
                 || coalesce(m.model #> ARRAY['CityObjects', s.object_id, 'attributes'], '{}') AS attributes,
               %1$s.wt_stored_semantics(m.model #> ARRAY['CityObjects', s.object_id, 'geometry', s.geometry::text], s.ordinal) AS semantics,
               %1$s.wt_box(f.min_x, f.min_y, f.min_z, f.max_x, f.max_y, f.max_z) AS feature_box, v.solid%2$s
        FROM watertight.feature_row f
        JOIN watertight.collection c ON c.key = f.collection
        LEFT JOIN watertight.dictionary d ON d.key = f.dictionary
        CROSS JOIN LATERAL (SELECT %1$s.wt_stored_model(f.packed_text, coalesce(d.content, ''), f.id) AS model OFFSET 0) m
        CROSS JOIN LATERAL watertight.stored_solids(f.id, f.solids, f.packed_solids) s
        CROSS JOIN LATERAL (SELECT %1$s.wt_solid(coalesce(s.blob, %1$s.wt_blob(s.page, s.slot))) AS solid OFFSET 0) v
      $view$, here,
      CASE WHEN casts IS NULL THEN ''
        ELSE format(', CASE WHEN %s.wt_shell_count(v.solid) = 1 THEN %s.wt_geometry(v.solid) END AS geometry', here, casts) END);
    EXECUTE $comment$COMMENT ON VIEW watertight.city IS
      'The solids that the service has stored, with type, attributes and semantic surfaces. Its columns stay; the tables may change'$comment$;
  END $$;
COMMENT ON FUNCTION wt_make_city_view() IS
  'makes the view watertight.city over the tables of the service, with the column geometry where watertight_postgis is installed';
