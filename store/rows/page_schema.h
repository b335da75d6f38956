// SPDX-License-Identifier: GPL-3.0-or-later
//
// The statements that let SQL read the pages of solids in rows: a step of store/migrations.cpp.
#pragma once

namespace watertight::store {

inline constexpr const char* kPageSchema[] = {
    // store/rows/packed_solids.h has the format.
    R"(CREATE FUNCTION watertight.stored_solids(id text, number integer, packed bytea)
         RETURNS TABLE ("position" integer, object_id text, geometry bigint, ordinal bigint,
                        lod text, is_proven boolean, blob bytea, page bytea, slot integer)
         LANGUAGE plpgsql IMMUTABLE PARALLEL SAFE AS $$
         DECLARE
           lods constant text[] := '{"",0,1,2,3,4,0.0,0.1,0.2,0.3,1.0,1.1,1.2,1.3,2.0,2.1,2.2,2.3,3.0,3.1,3.2,3.3}';
           own constant bytea := convert_to(id, 'UTF8');
           objects text[]; geometries bigint[]; ordinals bigint[]; levels text[];
           lengths integer[]; object text := id; geometry_now bigint := -1;
           here integer := 0; flags integer; numbers bigint[]; wanted integer; value bigint;
           shift integer; byte integer; has_page boolean := false; slots integer := 0;
         BEGIN
           IF length(packed) > 0 AND get_byte(packed, 0) = 30 THEN
             has_page := true; here := 1;
           END IF;
           FOR i IN 1 .. number LOOP
             flags := get_byte(packed, here); here := here + 1;
             -- the numbers of this solid: lod, object (2), geometry, ordinal, blob
             numbers := '{}';
             FOR part IN 1 .. 6 LOOP
               wanted := CASE part WHEN 1 THEN (flags & 31 = 31)::int
                 WHEN 6 THEN (flags & 32 > 0)::int
                 WHEN 4 THEN (flags & 128 > 0)::int WHEN 5 THEN (flags & 128 > 0)::int
                 ELSE (flags & 64 > 0)::int END;
               value := 0; shift := 0;
               IF wanted = 1 THEN
                 LOOP
                   byte := get_byte(packed, here); here := here + 1;
                   value := value | ((byte & 127)::bigint << shift); shift := shift + 7;
                   EXIT WHEN byte < 128;
                 END LOOP;
               END IF;
               numbers := numbers || value;
               IF part = 1 THEN
                 levels[i] := lods[(flags & 31) + 1];
                 IF wanted = 1 THEN
                   levels[i] := convert_from(substring(packed FROM here + 1 FOR value::int), 'UTF8');
                   here := here + value::int;
                 END IF;
               ELSIF part = 3 AND wanted = 1 THEN
                 object := convert_from(substring(own FROM 1 FOR numbers[2]::int)
                   || substring(packed FROM here + 1 FOR value::int), 'UTF8');
                 here := here + value::int; geometry_now := -1;
               END IF;
             END LOOP;
             geometry_now := CASE WHEN flags & 128 > 0 THEN numbers[4] ELSE geometry_now + 1 END;
             objects[i] := object; geometries[i] := geometry_now;
             ordinals[i] := numbers[5];
             lengths[i] := CASE WHEN flags & 32 > 0 THEN numbers[6] END;
           END LOOP;
           -- the page stands behind the blobs
           value := here + coalesce((SELECT sum(l) FROM unnest(lengths) l), 0);
           FOR i IN 1 .. number LOOP
             "position" := i - 1; object_id := objects[i]; geometry := geometries[i];
             ordinal := ordinals[i]; lod := levels[i]; is_proven := lengths[i] IS NOT NULL;
             blob := NULL; page := NULL; slot := NULL;
             IF has_page AND lengths[i] = 0 THEN
               page := substring(packed FROM value::int + 1); slot := slots; slots := slots + 1;
             ELSIF is_proven THEN
               blob := substring(packed FROM here + 1 FOR lengths[i]);
               here := here + lengths[i];
             END IF;
             RETURN NEXT;
           END LOOP;
         END $$)",
    R"(CREATE OR REPLACE VIEW watertight.solid AS
         SELECT c.name AS collection, f.id AS feature, s.object_id, s.geometry, s.ordinal,
                s."position", s.lod, s.blob, s.is_proven, s.page, s.slot
         FROM watertight.feature_row f
         JOIN watertight.collection c ON c.key = f.collection
         CROSS JOIN LATERAL watertight.stored_solids(f.id, f.solids, f.packed_solids) s)",
    "DROP FUNCTION watertight.unpacked_solids",
    R"(COMMENT ON VIEW watertight.solid IS
         'The solids of features. A proven one has a blob, or is number slot (from 0) of a page: coalesce(blob, wt_blob(page, slot))')",
};

}  // namespace watertight::store
