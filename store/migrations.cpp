// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/migrations.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "store/attributes/attribute_schema.h"
#include "store/rows/city_view.h"
#include "store/rows/page_schema.h"

namespace watertight::store {
namespace {

struct Migration {
  const char* name;
  const char* statements[48];
};

constexpr Migration kMigrations[] = {
    {"collections, features, solids",
     {
         R"(CREATE TABLE watertight.document_header (
              digest bytea PRIMARY KEY,
              content bytea NOT NULL))",
         R"(COMMENT ON TABLE watertight.document_header IS
              'What features of one document share, once each; digest is SHA-256 of content')",
         R"(CREATE TABLE watertight.collection (
              id text COLLATE "C" PRIMARY KEY CHECK (id ~ '^[A-Za-z0-9_.-]{1,64}$'),
              srid bigint NOT NULL,
              header bytea NOT NULL REFERENCES watertight.document_header,
              created timestamptz NOT NULL DEFAULT now()))",
         // One sequence for all features: a version is never used twice, not even by a feature that
         // was deleted and stored again, so an old ETag can never match a new feature.
         R"(CREATE SEQUENCE watertight.feature_version)",
         R"(CREATE TABLE watertight.feature (
              collection text COLLATE "C" NOT NULL REFERENCES watertight.collection,
              id text COLLATE "C" NOT NULL CHECK (id <> ''),
              version bigint NOT NULL DEFAULT nextval('watertight.feature_version'),
              type text NOT NULL,
              format text NOT NULL,
              srid bigint NOT NULL,
              header bytea NOT NULL REFERENCES watertight.document_header,
              skeleton bytea NOT NULL,
              solids bigint NOT NULL,
              blob_bytes bigint NOT NULL,
              min_x double precision, min_y double precision, min_z double precision,
              max_x double precision, max_y double precision, max_z double precision,
              PRIMARY KEY (collection, id),
              CHECK (num_nulls(min_x, min_y, min_z, max_x, max_y, max_z) IN (0, 6)),
              CHECK (min_x <= max_x AND min_y <= max_y AND min_z <= max_z)))",
         R"(COMMENT ON TABLE watertight.feature IS
              'One city object (or geometry): its document without the solids, and their box')",
         // The index finds candidates in x and y; the query compares the six numbers exactly.
         R"(CREATE INDEX feature_box ON watertight.feature
              USING gist (box(point(max_x, max_y), point(min_x, min_y))) WHERE min_x IS NOT NULL)",
         R"(CREATE INDEX feature_header ON watertight.feature (header))",
         R"(CREATE TABLE watertight.solid (
              collection text COLLATE "C" NOT NULL,
              feature text COLLATE "C" NOT NULL,
              object_id text COLLATE "C" NOT NULL,
              geometry bigint NOT NULL,
              ordinal bigint NOT NULL,
              position bigint NOT NULL,
              lod text NOT NULL,
              blob bytea NOT NULL,
              measures jsonb,
              report jsonb,
              PRIMARY KEY (collection, feature, object_id, geometry, ordinal),
              FOREIGN KEY (collection, feature) REFERENCES watertight.feature ON DELETE CASCADE))",
         R"(ALTER TABLE watertight.solid ALTER COLUMN blob SET STORAGE EXTERNAL)",
         R"(COMMENT ON TABLE watertight.solid IS
              'The valid solids of a feature as blobs (wt_decode), in the order of position')",
         // A write leaves its token here: a writer whose connection was lost during COMMIT can find
         // out whether the commit happened. Rows older than a day are removed.
         R"(CREATE TABLE watertight.write_receipt (
              token bytea PRIMARY KEY,
              written timestamptz NOT NULL DEFAULT now()))",
         R"(CREATE INDEX write_receipt_age ON watertight.write_receipt (written))",
     }},
    {"an index of boxes whose areas stay in range",
     {
         // PostgreSQL multiplies the sides of the boxes in an index page, and refuses products that
         // overflow or underflow: one box of 1e200 or 1e-200 would refuse every later feature. So
         // the index holds each box rounded outwards to multiples of 2^-20, within +-1e18.
         R"(CREATE FUNCTION watertight.index_box(min_x double precision, min_y double precision,
                                                 max_x double precision, max_y double precision)
              RETURNS box LANGUAGE sql IMMUTABLE PARALLEL SAFE
              RETURN box(
                point(ceil(least(greatest(max_x, -1e18::float8), 1e18::float8) * 1048576) / 1048576,
                      ceil(least(greatest(max_y, -1e18::float8), 1e18::float8) * 1048576) / 1048576),
                point(floor(least(greatest(min_x, -1e18::float8), 1e18::float8) * 1048576) / 1048576,
                      floor(least(greatest(min_y, -1e18::float8), 1e18::float8) * 1048576)
                        / 1048576)))",
         R"(DROP INDEX watertight.feature_box)",
         // The index finds candidates in x and y; the query compares the six numbers exactly.
         R"(CREATE INDEX feature_box ON watertight.feature
              USING gist (watertight.index_box(min_x, min_y, max_x, max_y))
              WHERE min_x IS NOT NULL)",
     }},
    {"an index of features by place",
     {
         // store/rows/place.h defines the place number. Features that were stored before this step
         // get the place number of features without a box.
         R"(ALTER TABLE watertight.feature ADD COLUMN place bigint NOT NULL
              DEFAULT 9223372036854775807)",
         R"(COMMENT ON COLUMN watertight.feature.place IS
              'Number of the box''s centre along a Hilbert curve: the order of exports')",
         R"(CREATE INDEX feature_place ON watertight.feature (collection, place, id))",
     }},
    {"counts of collections, kept by every write",
     {
         R"(ALTER TABLE watertight.collection
              ADD COLUMN features bigint NOT NULL DEFAULT 0,
              ADD COLUMN solids bigint NOT NULL DEFAULT 0,
              ADD COLUMN blob_bytes bigint NOT NULL DEFAULT 0,
              ADD COLUMN min_x double precision, ADD COLUMN min_y double precision,
              ADD COLUMN min_z double precision, ADD COLUMN max_x double precision,
              ADD COLUMN max_y double precision, ADD COLUMN max_z double precision)",
         // Writers add rows here instead of updating one row of the collection, for which they
         // would wait until the writer before has committed.
         R"(CREATE TABLE watertight.collection_change (
              collection text COLLATE "C" NOT NULL,
              features bigint NOT NULL,
              solids bigint NOT NULL,
              blob_bytes bigint NOT NULL,
              min_x double precision, min_y double precision, min_z double precision,
              max_x double precision, max_y double precision, max_z double precision))",
         R"(COMMENT ON TABLE watertight.collection_change IS
              'What writes have added to the counts and boxes of collections since these were last brought up to date')",
         R"(CREATE INDEX collection_change_collection
              ON watertight.collection_change (collection))",
         R"(CREATE FUNCTION watertight.note_added() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN
              INSERT INTO watertight.collection_change
                SELECT collection, count(*), sum(solids), sum(blob_bytes),
                       min(min_x), min(min_y), min(min_z), max(max_x), max(max_y), max(max_z)
                FROM added GROUP BY collection;
              RETURN NULL; END $$)",
         R"(CREATE FUNCTION watertight.note_removed() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN
              INSERT INTO watertight.collection_change
                SELECT collection, -count(*), -sum(solids), -sum(blob_bytes)
                FROM removed GROUP BY collection;
              RETURN NULL; END $$)",
         R"(CREATE TRIGGER feature_added AFTER INSERT ON watertight.feature
              REFERENCING NEW TABLE AS added FOR EACH STATEMENT
              EXECUTE FUNCTION watertight.note_added())",
         R"(CREATE TRIGGER feature_replaced_by AFTER UPDATE ON watertight.feature
              REFERENCING NEW TABLE AS added FOR EACH STATEMENT
              EXECUTE FUNCTION watertight.note_added())",
         R"(CREATE TRIGGER feature_replaced AFTER UPDATE ON watertight.feature
              REFERENCING OLD TABLE AS removed FOR EACH STATEMENT
              EXECUTE FUNCTION watertight.note_removed())",
         R"(CREATE TRIGGER feature_removed AFTER DELETE ON watertight.feature
              REFERENCING OLD TABLE AS removed FOR EACH STATEMENT
              EXECUTE FUNCTION watertight.note_removed())",
         R"(INSERT INTO watertight.collection_change
              SELECT collection, count(*), sum(solids), sum(blob_bytes),
                     min(min_x), min(min_y), min(min_z), max(max_x), max(max_y), max(max_z)
              FROM watertight.feature GROUP BY collection)",
         // For the documents of a collection, found by one probe each.
         R"(CREATE INDEX feature_document ON watertight.feature (collection, format, header))",
     }},
    {"ids that URLs can name",
     {
         // Clients of HTTP take "." and ".." out of a path, even when they are encoded.
         R"(INSERT INTO watertight.feature (collection, id, type, format, srid, header, skeleton,
                solids, blob_bytes, min_x, min_y, min_z, max_x, max_y, max_z, place)
              SELECT collection, replace(id, '.', '%2E'), type, format, srid, header, skeleton,
                solids, blob_bytes, min_x, min_y, min_z, max_x, max_y, max_z, place
              FROM watertight.feature WHERE id IN ('.', '..'))",
         R"(UPDATE watertight.solid SET feature = replace(feature, '.', '%2E')
              WHERE feature IN ('.', '..'))",
         R"(DELETE FROM watertight.feature WHERE id IN ('.', '..'))",
     }},
    {"names of collections beside their keys",
     {
         // Features refer to the key, so that a name can change or go without a change of any
         // feature.
         R"(ALTER TABLE watertight.collection DROP CONSTRAINT collection_id_check,
              ADD COLUMN name text COLLATE "C" CHECK (name ~ '^[A-Za-z0-9_.-]{1,64}$'))",
         R"(UPDATE watertight.collection SET name = id)",
         R"(CREATE UNIQUE INDEX collection_name ON watertight.collection (name))",
         R"(CREATE SEQUENCE watertight.collection_key)",
         R"(COMMENT ON COLUMN watertight.collection.id IS
              'What features refer to: the first name of the collection, or # and a number where that was taken')",
         R"(COMMENT ON COLUMN watertight.collection.name IS
              'The id that clients use. NULL: the collection was removed, its rows are being deleted')",
     }},
    {"states of collections",
     {
         // With the number of the pending changes added, `changes` grows with each transaction that
         // changes features; `generation` tells apart collections that had a name in turn.
         R"(ALTER TABLE watertight.collection
              ADD COLUMN generation bigint NOT NULL DEFAULT nextval('watertight.feature_version'),
              ADD COLUMN changes bigint NOT NULL DEFAULT 0)",
     }},
    {"solids that are not proven",
     {
         R"(ALTER TABLE watertight.solid ALTER COLUMN blob DROP NOT NULL)",
         R"(ALTER TABLE watertight.feature
              ADD COLUMN unproven bigint NOT NULL DEFAULT 0,
              ADD COLUMN is_proven boolean NOT NULL DEFAULT true,
              ADD COLUMN findings jsonb)",
         R"(COMMENT ON COLUMN watertight.feature.findings IS
              'The groups of solids in which a defect was found. NULL: none')",
         R"(CREATE INDEX feature_not_proven ON watertight.feature (collection, id)
              WHERE NOT is_proven)",
         R"(ALTER TABLE watertight.collection
              ADD COLUMN unproven bigint NOT NULL DEFAULT 0,
              ADD COLUMN unproven_features bigint NOT NULL DEFAULT 0,
              ADD COLUMN policy smallint NOT NULL DEFAULT 0 CHECK (policy BETWEEN 0 AND 2))",
         R"(COMMENT ON COLUMN watertight.collection.policy IS
              'A document with features that are not valid is 0: refused; 1: stored without them; 2: stored as it came')",
         R"(ALTER TABLE watertight.collection_change
              ADD COLUMN unproven bigint NOT NULL DEFAULT 0,
              ADD COLUMN unproven_features bigint NOT NULL DEFAULT 0)",
         R"(CREATE OR REPLACE FUNCTION watertight.note_added() RETURNS trigger LANGUAGE plpgsql
              AS $$ BEGIN
              INSERT INTO watertight.collection_change (collection, features, solids, blob_bytes,
                  unproven, unproven_features, min_x, min_y, min_z, max_x, max_y, max_z)
                SELECT collection, count(*), sum(solids), sum(blob_bytes), sum(unproven),
                       count(*) FILTER (WHERE NOT is_proven),
                       min(min_x), min(min_y), min(min_z), max(max_x), max(max_y), max(max_z)
                FROM added GROUP BY collection;
              RETURN NULL; END $$)",
         R"(CREATE OR REPLACE FUNCTION watertight.note_removed() RETURNS trigger LANGUAGE plpgsql
              AS $$ BEGIN
              INSERT INTO watertight.collection_change (collection, features, solids, blob_bytes,
                  unproven, unproven_features)
                SELECT collection, -count(*), -sum(solids), -sum(blob_bytes), -sum(unproven),
                       -count(*) FILTER (WHERE NOT is_proven)
                FROM removed GROUP BY collection;
              RETURN NULL; END $$)",
         R"(COMMENT ON COLUMN watertight.solid.blob IS
              'NULL: the solid is not proven to be valid; the skeleton of its feature has it as it came')",
     }},
    {"rows without waste",
     {
         // The rows of the old tables move to the new ones afterwards, some at a time
         // (store/moved_rows.h).
         "ALTER TABLE watertight.document_header RENAME TO old_header",
         "ALTER TABLE watertight.collection RENAME TO old_collection",
         "ALTER TABLE watertight.feature RENAME TO old_feature",
         "ALTER TABLE watertight.solid RENAME TO old_solid",
         "ALTER INDEX watertight.collection_pkey RENAME TO old_collection_pkey",
         R"(DROP INDEX watertight.feature_box, watertight.feature_header, watertight.feature_place,
              watertight.feature_document, watertight.feature_not_proven,
              watertight.collection_name)",
         "DROP TABLE watertight.collection_change",
         "DROP FUNCTION watertight.note_added() CASCADE",
         "DROP FUNCTION watertight.note_removed() CASCADE",
         "DROP SEQUENCE watertight.collection_key",
         R"(CREATE TABLE watertight.document (
              key integer GENERATED BY DEFAULT AS IDENTITY PRIMARY KEY,
              digest bytea NOT NULL UNIQUE,
              content bytea NOT NULL))",
         R"(COMMENT ON TABLE watertight.document IS
              'What features of one document share, once each; digest is SHA-256 of content')",
         R"(CREATE TABLE watertight.collection (
              key integer GENERATED BY DEFAULT AS IDENTITY PRIMARY KEY,
              name text COLLATE "C" UNIQUE CHECK (name ~ '^[A-Za-z0-9_.-]{1,64}$'),
              srid bigint NOT NULL,
              document integer NOT NULL REFERENCES watertight.document,
              created timestamptz NOT NULL DEFAULT now(),
              features bigint NOT NULL DEFAULT 0,
              solids bigint NOT NULL DEFAULT 0,
              blob_bytes bigint NOT NULL DEFAULT 0,
              unproven bigint NOT NULL DEFAULT 0,
              unproven_features bigint NOT NULL DEFAULT 0,
              min_x double precision, min_y double precision, min_z double precision,
              max_x double precision, max_y double precision, max_z double precision,
              generation bigint NOT NULL DEFAULT nextval('watertight.feature_version'),
              changes bigint NOT NULL DEFAULT 0,
              policy smallint NOT NULL DEFAULT 0 CHECK (policy BETWEEN 0 AND 2)))",
         R"(COMMENT ON COLUMN watertight.collection.name IS
              'The id that clients use. NULL: the collection was removed, its rows are being deleted')",
         R"(COMMENT ON COLUMN watertight.collection.policy IS
              'A document with features that are not valid is 0: refused; 1: stored without them; 2: stored as it came')",
         R"(CREATE TABLE watertight.kind (
              key integer GENERATED BY DEFAULT AS IDENTITY PRIMARY KEY,
              collection integer NOT NULL REFERENCES watertight.collection,
              document integer NOT NULL REFERENCES watertight.document,
              format text NOT NULL,
              type text NOT NULL,
              UNIQUE (collection, document, format, type)))",
         R"(COMMENT ON TABLE watertight.kind IS
              'What many features of a collection have in common, once each; rows never change')",
         R"(CREATE TABLE watertight.dictionary (
              key integer GENERATED BY DEFAULT AS IDENTITY PRIMARY KEY,
              collection integer NOT NULL REFERENCES watertight.collection,
              digest bytea NOT NULL,
              content bytea NOT NULL,
              created timestamptz NOT NULL DEFAULT now(),
              UNIQUE (collection, digest)))",
         R"(COMMENT ON TABLE watertight.dictionary IS
              'With which texts of features are compressed; rows never change, the one with the highest key is used')",
         // The columns are in an order that needs no padding. Nothing is NULL but the box, so that
         // rows have no bitmap of nulls.
         R"(CREATE TABLE watertight.feature_row (
              version bigint NOT NULL DEFAULT nextval('watertight.feature_version'),
              place bigint NOT NULL,
              min_x double precision, min_y double precision, min_z double precision,
              max_x double precision, max_y double precision, max_z double precision,
              collection integer NOT NULL REFERENCES watertight.collection,
              kind integer NOT NULL REFERENCES watertight.kind,
              dictionary integer NOT NULL,
              solids integer NOT NULL,
              blob_bytes integer NOT NULL,
              unproven integer NOT NULL,
              is_proven boolean NOT NULL,
              id text COLLATE "C" NOT NULL CHECK (id <> ''),
              packed_solids bytea NOT NULL,
              packed_text bytea NOT NULL,
              CHECK (num_nulls(min_x, min_y, min_z, max_x, max_y, max_z) IN (0, 6)),
              CHECK (min_x <= max_x AND min_y <= max_y AND min_z <= max_z)))",
         R"(ALTER TABLE watertight.feature_row ALTER COLUMN packed_solids SET STORAGE EXTERNAL,
              ALTER COLUMN packed_text SET STORAGE EXTERNAL)",
         R"(COMMENT ON TABLE watertight.feature_row IS
              'One city object (or geometry). The views feature and solid show what is in it')",
         R"(COMMENT ON COLUMN watertight.feature_row.place IS
              'Number of the box''s centre along a Hilbert curve: the order of exports')",
         R"(COMMENT ON COLUMN watertight.feature_row.dictionary IS
              'The key of the dictionary of packed_text; 0: none')",
         // A hash of 8 bytes stands for the id in the index; two ids of one collection with one
         // hash are refused (feature_writes.cpp).
         R"(CREATE UNIQUE INDEX feature_id
              ON watertight.feature_row (collection, hashtextextended(id, 0)))",
         R"(CREATE INDEX feature_place ON watertight.feature_row (collection, place))",
         R"(CREATE INDEX feature_kind ON watertight.feature_row (kind))",
         R"(CREATE INDEX feature_not_proven
              ON watertight.feature_row (collection, hashtextextended(id, 0))
              WHERE NOT is_proven)",
         // The index finds candidates in x and y; the query compares the six numbers exactly.
         R"(CREATE INDEX feature_box ON watertight.feature_row
              USING gist (watertight.index_box(min_x, min_y, max_x, max_y))
              WHERE min_x IS NOT NULL)",
         R"(CREATE TABLE watertight.collection_change (
              collection integer NOT NULL,
              features bigint NOT NULL,
              solids bigint NOT NULL,
              blob_bytes bigint NOT NULL,
              unproven bigint NOT NULL,
              unproven_features bigint NOT NULL,
              min_x double precision, min_y double precision, min_z double precision,
              max_x double precision, max_y double precision, max_z double precision))",
         R"(COMMENT ON TABLE watertight.collection_change IS
              'What writes have added to the counts and boxes of collections since these were last brought up to date')",
         R"(CREATE INDEX collection_change_collection
              ON watertight.collection_change (collection))",
         R"(CREATE FUNCTION watertight.note_added() RETURNS trigger LANGUAGE plpgsql
              AS $$ BEGIN
              INSERT INTO watertight.collection_change (collection, features, solids, blob_bytes,
                  unproven, unproven_features, min_x, min_y, min_z, max_x, max_y, max_z)
                SELECT collection, count(*), sum(solids), sum(blob_bytes), sum(unproven),
                       count(*) FILTER (WHERE NOT is_proven),
                       min(min_x), min(min_y), min(min_z), max(max_x), max(max_y), max(max_z)
                FROM added GROUP BY collection;
              RETURN NULL; END $$)",
         R"(CREATE FUNCTION watertight.note_removed() RETURNS trigger LANGUAGE plpgsql
              AS $$ BEGIN
              INSERT INTO watertight.collection_change (collection, features, solids, blob_bytes,
                  unproven, unproven_features)
                SELECT collection, -count(*), -sum(solids), -sum(blob_bytes), -sum(unproven),
                       -count(*) FILTER (WHERE NOT is_proven)
                FROM removed GROUP BY collection;
              RETURN NULL; END $$)",
         R"(CREATE TRIGGER feature_added AFTER INSERT ON watertight.feature_row
              REFERENCING NEW TABLE AS added FOR EACH STATEMENT
              EXECUTE FUNCTION watertight.note_added())",
         R"(CREATE TRIGGER feature_replaced_by AFTER UPDATE ON watertight.feature_row
              REFERENCING NEW TABLE AS added FOR EACH STATEMENT
              EXECUTE FUNCTION watertight.note_added())",
         R"(CREATE TRIGGER feature_replaced AFTER UPDATE ON watertight.feature_row
              REFERENCING OLD TABLE AS removed FOR EACH STATEMENT
              EXECUTE FUNCTION watertight.note_removed())",
         R"(CREATE TRIGGER feature_removed AFTER DELETE ON watertight.feature_row
              REFERENCING OLD TABLE AS removed FOR EACH STATEMENT
              EXECUTE FUNCTION watertight.note_removed())",
         R"(CREATE VIEW watertight.feature AS
              SELECT c.name AS collection, f.id, f.version, k.type, k.format, c.srid,
                     d.digest AS header, f.solids, f.blob_bytes, f.min_x, f.min_y, f.min_z,
                     f.max_x, f.max_y, f.max_z, f.place, f.unproven, f.is_proven
              FROM watertight.feature_row f
              JOIN watertight.collection c ON c.key = f.collection
              JOIN watertight.kind k ON k.key = f.kind
              JOIN watertight.document d ON d.key = k.document)",
         // store/rows/packed_solids.h has the format.
         R"(CREATE FUNCTION watertight.unpacked_solids(id text, number integer, packed bytea)
              RETURNS TABLE ("position" integer, object_id text, geometry bigint, ordinal bigint,
                             lod text, blob bytea)
              LANGUAGE plpgsql IMMUTABLE PARALLEL SAFE AS $$
              DECLARE
                lods constant text[] := '{"",0,1,2,3,4,0.0,0.1,0.2,0.3,1.0,1.1,1.2,1.3,2.0,2.1,2.2,2.3,3.0,3.1,3.2,3.3}';
                own constant bytea := convert_to(id, 'UTF8');
                objects text[]; geometries bigint[]; ordinals bigint[]; levels text[];
                lengths integer[]; object text := id; geometry_now bigint := -1;
                here integer := 0; flags integer; numbers bigint[]; wanted integer; value bigint;
                shift integer; byte integer;
              BEGIN
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
                FOR i IN 1 .. number LOOP
                  "position" := i - 1; object_id := objects[i]; geometry := geometries[i];
                  ordinal := ordinals[i]; lod := levels[i];
                  blob := CASE WHEN lengths[i] IS NOT NULL
                            THEN substring(packed FROM here + 1 FOR lengths[i]) END;
                  here := here + coalesce(lengths[i], 0);
                  RETURN NEXT;
                END LOOP;
              END $$)",
         R"(CREATE VIEW watertight.solid AS
              SELECT c.name AS collection, f.id AS feature, s.object_id, s.geometry, s.ordinal,
                     s."position", s.lod, s.blob
              FROM watertight.feature_row f
              JOIN watertight.collection c ON c.key = f.collection
              CROSS JOIN LATERAL watertight.unpacked_solids(f.id, f.solids, f.packed_solids) s)",
         R"(COMMENT ON VIEW watertight.solid IS
              'The solids of features, valid ones as blobs (wt_decode). A solid without a blob is not proven')",
         R"(INSERT INTO watertight.document (digest, content)
              SELECT digest, content FROM watertight.old_header)",
         R"(INSERT INTO watertight.collection (name, srid, document, created, generation, changes,
                policy)
              SELECT name, srid, (SELECT key FROM watertight.document WHERE digest = header),
                created, generation, changes, policy
              FROM watertight.old_collection WHERE name IS NOT NULL)",
     }},
};
// The step after those of kMigrations: all rows are in the new tables (moved_rows.h).
constexpr std::int64_t kMoved = std::size(kMigrations) + 1;
// The steps after that.
struct LaterMigration {
  const char* name;
  std::span<const char* const> statements;
};
constexpr const char* kRulesSchema[] = {
    "ALTER TABLE watertight.collection ADD COLUMN rules text NOT NULL DEFAULT ''",
    "COMMENT ON COLUMN watertight.collection.rules IS"
    " 'The rules by which solids are judged in writes, lines NAME=VALUE'"};
constexpr LaterMigration kLaterMigrations[] = {{"chosen attributes", kAttributeSchema},
                                               {"pages of solids", kPageSchema},
                                               {"rules of collections", kRulesSchema}};
constexpr std::int64_t kNewest = kMoved + std::size(kLaterMigrations);

// The number of the lock is "watertig" in ASCII; any number will do that no other program locks.
// The session has it until the last step is done.
constexpr const char* kLock = "SELECT pg_advisory_lock(x'7761746572746967'::bigint)";
constexpr const char* kUnlock = "SELECT pg_advisory_unlock(x'7761746572746967'::bigint)";

/// The highest migration that was applied; 0 when there is none.
Result<std::int64_t> applied(DatabaseSession& connection) {
  const Result<Rows> known =
      connection.run("SELECT 1::int8 WHERE to_regclass('watertight.migration') IS NOT NULL");
  if (!known) return known.error();
  if (known->size() == 0) return std::int64_t{0};
  const Result<Rows> rows =
      connection.run("SELECT coalesce(max(number), 0)::int8 FROM watertight.migration");
  if (!rows) return rows.error();
  return rows->int8(0, 0);
}

Error newer(std::int64_t found) {
  return {ErrorCode::unsupported, "the database has schema " + std::to_string(found) +
                                      ", this program knows " + std::to_string(kNewest) +
                                      ": use the program that made it, or a newer one"};
}

Status run_all(DatabaseSession& connection, std::span<const char* const> statements) {
  for (const char* statement : statements) {
    if (statement == nullptr) break;
    if (const Result<Rows> done = connection.run(statement); !done) return done.error();
  }
  return Done{};
}

Status record(DatabaseSession& connection, std::int64_t number, const char* name) {
  const Result<Rows> done =
      connection.run("INSERT INTO watertight.migration (number, name) VALUES ($1, $2)",
                     Parameters().int8(number).text(name));
  if (!done) return done.error();
  return Done{};
}

/// Applies the missing steps of kMigrations in one transaction.
Status change_schema(DatabaseSession& connection) {
  for (const char* statement :
       {"BEGIN", "CREATE SCHEMA IF NOT EXISTS watertight",
        "CREATE TABLE IF NOT EXISTS watertight.migration (number bigint PRIMARY KEY,"
        " name text NOT NULL, applied timestamptz NOT NULL DEFAULT now())"}) {
    if (const Result<Rows> done = connection.run(statement); !done) return done.error();
  }
  const Result<std::int64_t> found = applied(connection);
  if (!found) return found.error();
  if (*found > kNewest) return newer(*found);
  for (std::int64_t number = *found + 1; number < kMoved; ++number) {
    const Migration& migration = kMigrations[number - 1];
    if (const Status done = run_all(connection, migration.statements); !done) return done;
    if (const Status done = record(connection, number, migration.name); !done) return done;
  }
  if (const Result<Rows> done = connection.run("COMMIT"); !done) return done.error();
  return Done{};
}

/// Applies the steps of kLaterMigrations after `found` in one transaction.
Status change_moved(DatabaseSession& connection, std::int64_t found) {
  if (const Result<Rows> begun = connection.run("BEGIN"); !begun) return begun.error();
  for (std::int64_t number = std::max(found, kMoved) + 1; number <= kNewest; ++number) {
    const LaterMigration& migration = kLaterMigrations[number - kMoved - 1];
    if (Status done = run_all(connection, migration.statements); !done) return done;
    if (Status done = record(connection, number, migration.name); !done) return done;
  }
  if (const Result<Rows> done = connection.run("COMMIT"); !done) return done.error();
  return Done{};
}

Status migrate_locked(DatabaseSession& connection, const Tell& tell) {
  if (Status changed = change_schema(connection); !changed) return changed;
  const Result<std::int64_t> found = applied(connection);
  if (!found) return found.error();
  if (*found < kMoved) {
    Status moved = move_rows(connection, tell, [](DatabaseSession& session) {
      return record(session, kMoved, "rows moved");
    });
    if (!moved) return moved;
  }
  if (*found == kNewest) return Done{};  // another instance was first
  return change_moved(connection, *found);
}

Status update_schema(DatabaseSession& connection, const Tell& tell) {
  const Result<std::int64_t> found = applied(connection);
  if (!found) return found.error();
  if (*found == kNewest) return Done{};
  if (*found > kNewest) return newer(*found);
  if (const Result<Rows> locked = connection.run(kLock); !locked) return locked.error();
  Status done = migrate_locked(connection, tell);
  if (!done) {
    if (!connection.is_lost()) connection.roll_back();
    if (!connection.is_lost()) static_cast<void>(connection.run(kUnlock));
    return done;
  }
  if (const Result<Rows> unlocked = connection.run(kUnlock); !unlocked) return unlocked.error();
  return done;
}

}  // namespace

Status migrate(DatabaseSession& connection, const Tell& tell) {
  if (Status updated = update_schema(connection, tell); !updated) return updated;
  if (const Result<Rows> made = connection.run(kMakeCityView); !made) return made.error();
  return Done{};
}

Status check_schema(DatabaseSession& connection) {
  const Result<std::int64_t> found = applied(connection);
  if (!found) return found.error();
  if (*found > kNewest) return newer(*found);
  if (*found < kNewest) return Error{ErrorCode::unavailable, "the database schema is not current"};
  return Done{};
}

}  // namespace watertight::store
