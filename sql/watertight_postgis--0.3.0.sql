-- SPDX-License-Identifier: GPL-3.0-or-later
-- Casts between solids and geometries of PostGIS. The bodies are parsed here, so that they work in any schema
-- and under any search path.
\echo Use "CREATE EXTENSION watertight_postgis" to load this file. \quit

CREATE FUNCTION wt_solid_of_geometry(geom geometry) RETURNS solid
  LANGUAGE sql IMMUTABLE STRICT PARALLEL SAFE COST 10000
  RETURN wt_solid(ST_AsEWKB(geom));
COMMENT ON FUNCTION wt_solid_of_geometry(geometry) IS
  'solid of a POLYHEDRALSURFACE Z or TIN Z by the default rules; an invalid one is an error with its findings';
CREATE FUNCTION wt_geometry(solid solid) RETURNS geometry
  LANGUAGE sql IMMUTABLE STRICT PARALLEL SAFE COST 60
  RETURN ST_GeomFromEWKB(wt_as_ewkb(solid));
COMMENT ON FUNCTION wt_geometry(solid) IS
  'POLYHEDRALSURFACE Z of a solid; PostGIS has no geometry for one with cavities, which is an error';
CREATE CAST (geometry AS solid) WITH FUNCTION wt_solid_of_geometry(geometry) AS ASSIGNMENT;
CREATE CAST (solid AS geometry) WITH FUNCTION wt_geometry(solid) AS ASSIGNMENT;

CREATE FUNCTION wt_box_of_box3d(box box3d) RETURNS wt_box LANGUAGE sql IMMUTABLE STRICT PARALLEL SAFE
  RETURN wt_box(ST_XMin(box), ST_YMin(box), ST_ZMin(box), ST_XMax(box), ST_YMax(box), ST_ZMax(box));
COMMENT ON FUNCTION wt_box_of_box3d(box3d) IS 'the same box, for the operators of solids';
CREATE CAST (box3d AS wt_box) WITH FUNCTION wt_box_of_box3d(box3d) AS ASSIGNMENT;
