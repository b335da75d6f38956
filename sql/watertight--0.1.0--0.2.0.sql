-- SPDX-License-Identifier: GPL-3.0-or-later
-- Rules per call and as settings, and solids of pages. A function that takes rules depends on its arguments alone, so it is
-- IMMUTABLE; wt_rules() reads the settings, so it is STABLE, and no index or generated column can depend
-- on them. Nothing of 0.1.0 changes: a call without rules has the default ones in every session.
\echo Use "ALTER EXTENSION watertight UPDATE" to load this file. \quit

CREATE FUNCTION wt_rules(planarity float8 DEFAULT NULL, planarity_angle float8 DEFAULT NULL,
                         proof text DEFAULT NULL, strict boolean DEFAULT NULL) RETURNS jsonb
  AS 'MODULE_PATHNAME', 'wt_rules' LANGUAGE C STABLE PARALLEL SAFE;
COMMENT ON FUNCTION wt_rules(float8, float8, text, boolean) IS
  'rules for wt_validate, wt_is_valid and wt_encode: planarity (metres), planarity_angle (degrees), proof, strict; a rule that is not given is that of the setting watertight.NAME';

CREATE FUNCTION wt_rules_of(blob bytea) RETURNS jsonb
  AS 'MODULE_PATHNAME', 'wt_rules_of' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 100;
COMMENT ON FUNCTION wt_rules_of(bytea) IS
  'the rules under which the solid of a blob was accepted, as the blob states them';

CREATE FUNCTION wt_validate(ewkb bytea, rules jsonb) RETURNS jsonb
  AS 'MODULE_PATHNAME', 'wt_validate' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 10000;
COMMENT ON FUNCTION wt_validate(bytea, jsonb) IS
  'report on a solid (EWKB POLYHEDRALSURFACE Z or SOLID Z) by these rules; those that are not stated are the default ones';

CREATE FUNCTION wt_is_valid(ewkb bytea, rules jsonb) RETURNS boolean
  AS 'MODULE_PATHNAME', 'wt_is_valid' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 10000;
COMMENT ON FUNCTION wt_is_valid(bytea, jsonb) IS
  'whether a solid (EWKB POLYHEDRALSURFACE Z or SOLID Z) is valid by these rules; those that are not stated are the default ones';

CREATE FUNCTION wt_encode(ewkb bytea, rules jsonb) RETURNS bytea
  AS 'MODULE_PATHNAME', 'wt_encode' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 10000;
COMMENT ON FUNCTION wt_encode(bytea, jsonb) IS
  'the blob of a solid (EWKB) that is valid by these rules, which the blob states; an invalid one is an error with its findings as detail';

CREATE FUNCTION wt_blob(page bytea, slot integer) RETURNS bytea
  AS 'MODULE_PATHNAME', 'wt_blob' LANGUAGE C IMMUTABLE STRICT PARALLEL SAFE COST 5000;
COMMENT ON FUNCTION wt_blob(bytea, integer) IS
  'the blob of a solid of a page, counted from 0, as the view watertight.solid has them';
