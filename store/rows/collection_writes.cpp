// SPDX-License-Identifier: GPL-3.0-or-later
//
// Renames and removes collections. Features refer to the key of their collection, and clients know
// its name: a rename or a removal changes one row, whose lock it shares with no writer.
#include "store/rows/feature_rows.h"

namespace watertight::store {

void send_gate(DatabaseSession& connection, std::string_view collection, Gate gate) {
  // A number of its own for each name; two names with one number would only wait for each other.
  connection.send(gate == Gate::shared
                      ? "SELECT pg_advisory_xact_lock_shared(hashtextextended($1, 0))"
                      : "SELECT pg_advisory_xact_lock(hashtextextended($1, 0))",
                  Parameters().text(collection));
}

Result<std::string> hide_collection(DatabaseSession& connection, const std::string& id) {
  send_gate(connection, id, Gate::alone);
  const Result<Rows> rows = connection.ask(
      "UPDATE watertight.collection SET name = NULL WHERE name = $1 RETURNING key::text",
      Parameters().text(id));
  if (!rows) return rows.error();
  if (rows->size() == 0) return no_collection(id);
  return std::string(rows->text(0, 0));
}

Result<Done> rename_collection(DatabaseSession& connection, const std::string& id,
                               const std::string& new_id) {
  send_gate(connection, id, Gate::alone);
  const Result<Rows> rows =
      connection.ask("UPDATE watertight.collection SET name = $2 WHERE name = $1 RETURNING 1::int8",
                     Parameters().text(id).text(new_id));
  if (!rows && connection.state() == "23505") {
    return Error{ErrorCode::conflict, "there is a collection '" + new_id + "' already"};
  }
  if (!rows) return rows.error();
  if (rows->size() == 0) return no_collection(id);
  return Done{};
}

Result<Done> make_collection(DatabaseSession& connection, const std::string& id,
                             std::uint32_t srid) {
  send_gate(connection, id, Gate::alone);
  const Result<Rows> document = connection.ask(
      "INSERT INTO watertight.document (digest, content) SELECT sha256(''), ''"
      " WHERE NOT EXISTS (SELECT FROM watertight.document WHERE digest = sha256(''))"
      " ON CONFLICT DO NOTHING");
  if (!document) return document.error();
  const Result<Rows> rows = connection.ask(
      "INSERT INTO watertight.collection (name, srid, document)"
      " SELECT $1, $2, (SELECT key FROM watertight.document WHERE digest = sha256(''))"
      " ON CONFLICT DO NOTHING RETURNING 1::int8",
      Parameters().text(id).int8(srid));
  if (!rows) return rows.error();
  if (rows->size() == 0) {
    return Error{ErrorCode::conflict, "there is a collection '" + id + "' already"};
  }
  return Done{};
}

namespace {

/// Sets a column of a collection, by a statement that changes nothing if it has the value already.
Result<Done> set_column(DatabaseSession& connection, const std::string& id, const char* statement,
                        const Parameters& parameters) {
  send_gate(connection, id, Gate::shared);
  const Result<Rows> rows = connection.ask(statement, parameters);
  if (!rows) return rows.error();
  const Result<StoredCollection> found = read_collection(connection, id);
  if (!found) return found.error();
  return Done{};
}

}  // namespace

Result<Done> set_policy(DatabaseSession& connection, const std::string& id, Policy policy) {
  return set_column(connection, id,
                    "UPDATE watertight.collection SET policy = $2, changes = changes + 1"
                    " WHERE name = $1 AND policy <> $2 RETURNING 1::int8",
                    Parameters().text(id).int8(static_cast<std::int64_t>(policy)));
}

Result<Done> set_rules(DatabaseSession& connection, const std::string& id,
                       const std::string& rules) {
  return set_column(connection, id,
                    "UPDATE watertight.collection SET rules = $2, changes = changes + 1"
                    " WHERE name = $1 AND rules <> $2 RETURNING 1::int8",
                    Parameters().text(id).text(rules));
}

Result<std::string> read_hidden_collection(DatabaseSession& connection) {
  const Result<Rows> rows =
      connection.ask("SELECT key::text FROM watertight.collection WHERE name IS NULL LIMIT 1");
  if (!rows) return rows.error();
  return rows->size() == 0 ? std::string() : std::string(rows->text(0, 0));
}

Result<std::string> purge_step(DatabaseSession& connection, const std::string& key,
                               const std::string& after) {
  // In order of the hashes of ids, the order of an index.
  const Result<Rows> last = connection.ask(
      "WITH gone AS (DELETE FROM watertight.feature_row WHERE collection = $1::int4"
      " AND hashtextextended(id, 0) IN (SELECT hashtextextended(id, 0)"
      " FROM watertight.feature_row WHERE collection = $1::int4"
      " AND ($2 = '' OR hashtextextended(id, 0) > nullif($2, '')::int8)"
      " ORDER BY hashtextextended(id, 0) LIMIT 1000)"
      " RETURNING hashtextextended(id, 0) AS hash)"
      " SELECT max(hash)::text FROM gone HAVING count(*) > 0",
      Parameters().text(key).text(after));
  if (!last) return last.error();
  if (last->size() > 0) return std::string(last->text(0, 0));
  for (const char* statement :
       {"DELETE FROM watertight.collection_change WHERE collection = $1::int4",
        "DELETE FROM watertight.attribute_name WHERE collection = $1::int4",
        "DELETE FROM watertight.kind WHERE collection = $1::int4",
        "DELETE FROM watertight.dictionary WHERE collection = $1::int4",
        "DELETE FROM watertight.collection WHERE key = $1::int4 AND name IS NULL"}) {
    if (const Result<Rows> gone = connection.ask(statement, Parameters().text(key)); !gone) {
      return gone.error();
    }
  }
  return std::string();
}

}  // namespace watertight::store
