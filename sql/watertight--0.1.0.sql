-- SPDX-License-Identifier: GPL-3.0-or-later
-- A solid that is undecided (a helper crashed or reached its limits) raises 57014 and a limit
-- raises 54000: every value that these functions return is final, so they are IMMUTABLE.
-- Costs are a tenth of what is measured, in units of 0.1 microseconds: parallel plans begin at some
-- 40 solids, while JIT compilation (jit_above_cost), of which they gain nothing, begins at 4,000.
\echo Use "CREATE EXTENSION watertight" to load this file. \quit

CREATE FUNCTION wt_version() RETURNS text
  AS 'MODULE_PATHNAME', 'wt_version' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE;
COMMENT ON FUNCTION wt_version() IS 'version of the extension''s library';

CREATE FUNCTION wt_validate(ewkb bytea) RETURNS jsonb
  AS 'MODULE_PATHNAME', 'wt_validate' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 10000;
COMMENT ON FUNCTION wt_validate(bytea) IS
  'report on a solid (EWKB POLYHEDRALSURFACE Z or SOLID Z): verdict and all findings with places, at the default tolerances';

CREATE FUNCTION wt_is_valid(ewkb bytea) RETURNS boolean
  AS 'MODULE_PATHNAME', 'wt_is_valid' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 10000;
COMMENT ON FUNCTION wt_is_valid(bytea) IS
  'whether a solid (EWKB POLYHEDRALSURFACE Z or SOLID Z) is valid at the default tolerances';

CREATE FUNCTION wt_encode(ewkb bytea) RETURNS bytea
  AS 'MODULE_PATHNAME', 'wt_encode' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 10000;
COMMENT ON FUNCTION wt_encode(bytea) IS
  'the blob of a valid solid (EWKB); an invalid one is an error with its findings as detail';

CREATE FUNCTION wt_decode(blob bytea) RETURNS bytea
  AS 'MODULE_PATHNAME', 'wt_decode' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 1000;
COMMENT ON FUNCTION wt_decode(bytea) IS
  'EWKB of a blob: POLYHEDRALSURFACE Z, or SOLID Z when the solid has cavities; PostGIS reads the former';

CREATE FUNCTION wt_info(blob bytea) RETURNS jsonb
  AS 'MODULE_PATHNAME', 'wt_info' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 100;
COMMENT ON FUNCTION wt_info(bytea) IS
  'header, counts and sizes of the parts of a blob';
