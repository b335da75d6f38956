// SPDX-License-Identifier: GPL-3.0-or-later
//
// The values of chosen attributes: written with their features, and in queries.
#include "store/attributes/attribute_rows.h"

#include <algorithm>
#include <charconv>

#include "store/attributes/attribute_values.h"
#include "store/attributes/filter_rows.h"

namespace watertight::store {
namespace {

// The bytes of the values in one statement.
constexpr std::size_t kStatementBytes = 16ULL << 20;

constexpr const char* kChosen = R"(
  SELECT n.key::int8, n.name FROM watertight.attribute_name n
  JOIN watertight.collection c ON c.key = n.collection
  WHERE c.name = $1 AND n.name IS NOT NULL ORDER BY n.name)";

constexpr const char* kDeleteValues = R"(
  DELETE FROM watertight.attribute_value v USING unnest($1::text[]) AS u (id)
  WHERE v.feature = hashtextextended(u.id, 0) AND v.attribute = ANY ($2::int8[]))";

constexpr const char* kInsertValues = R"(
  INSERT INTO watertight.attribute_value (feature, attribute, object, number, text, truth)
  SELECT hashtextextended(i, 0), a, nullif(o, ''), CASE WHEN t = 0 THEN v::numeric END,
    CASE WHEN t = 1 THEN CASE WHEN octet_length(v) <= 1000 THEN v
                         ELSE watertight.attribute_text(v) END END,
    CASE WHEN t = 2 THEN v = 'true' END
  FROM unnest($1::text[], $2::int8[], $3::text[], $4::int8[], $5::text[]) AS u (i, a, o, t, v))";

/// The object of a value as attribute_value.object has it; "" for NULL.
std::string object_text(const std::string& object, const std::string& feature) {
  if (object == feature) return {};
  const bool follows = object.starts_with(feature);
  return std::string(1, follows ? '+' : '=').append(object, follows ? feature.size() : 0);
}

/// The columns of kInsertValues.
struct ValueColumns {
  std::vector<std::string_view> feature, value;
  std::vector<std::string> objects;
  std::vector<std::int64_t> attribute, type;
  std::vector<FeatureAttribute> kept;
  std::size_t bytes = 0;

  void add(const StoredFeature& of, std::int64_t key, FeatureAttribute attribute_of) {
    feature.push_back(of.id);
    attribute.push_back(key);
    objects.push_back(object_text(attribute_of.object, of.id));
    type.push_back(static_cast<std::int64_t>(attribute_of.value.type));
    bytes += of.id.size() + objects.back().size() + attribute_of.value.text.size() + 64;
    kept.push_back(std::move(attribute_of));
  }
  void send(DatabaseSession& connection) {
    if (kept.empty()) return;
    for (const FeatureAttribute& one : kept) value.push_back(one.value.text);
    const std::vector<std::string_view> object(objects.begin(), objects.end());
    Parameters parameters;
    parameters.text_array(feature).int8_array(attribute).text_array(object).int8_array(type);
    connection.send(kInsertValues, parameters.text_array(value));
    *this = {};
  }
};

/// A value that the store keeps has no exponent beyond kLargestExponent.
bool is_small_exponent(std::string_view number) {
  const std::size_t e = number.find_first_of("eE");
  if (e == std::string_view::npos) return true;
  std::string_view digits = number.substr(e + 1);
  if (digits.starts_with('+')) digits.remove_prefix(1);
  std::int64_t exponent = 0;
  const char* const end = digits.data() + digits.size();
  const auto [rest, error] = std::from_chars(digits.data(), end, exponent);
  return error == std::errc{} && rest == end && exponent >= -kLargestExponent &&
         exponent <= kLargestExponent;
}

Error not_chosen(const std::string& collection, const std::string& name) {
  return {ErrorCode::invalid_argument,
          "the attribute '" + name + "' of collection '" + collection +
              "' is not chosen to be queried (watertight collections attributes)"};
}

}  // namespace

Status check_attribute_name(const std::string& name) {
  if (!name.empty() && name.size() <= kLongestAttributeName && is_plain_utf8(name)) {
    return Done{};
  }
  return Error{ErrorCode::invalid_argument,
               "the name of an attribute has 1 to 1024 bytes of UTF-8 without NUL"};
}

bool is_kept(const AttributeValue& value) {
  if (value.type != AttributeValue::Type::number) return is_plain_utf8(value.text);
  return value.text.size() <= kLongestNumber && is_small_exponent(value.text);
}

Status write_values(DatabaseSession& connection, FeatureRefs features, const AttributeKeys& chosen,
                    const AttributeReader& reader) {
  if (!reader) {
    return Error{ErrorCode::unsupported,
                 "this program does not read attributes, and the collection has chosen some"};
  }
  std::vector<std::string_view> ids;
  for (const StoredFeature* feature : features) ids.push_back(feature->id);
  connection.send(kDeleteValues, Parameters().text_array(ids).int8_array(chosen.keys));
  ValueColumns columns;
  for (const StoredFeature* feature : features) {
    auto values = reader(*feature, chosen.names);
    if (!values) return std::move(values).error();
    for (FeatureAttribute& value : *values) {
      if (!is_kept(value.value) || !is_plain_utf8(value.object)) continue;
      const std::int64_t key = chosen.keys[value.name];
      columns.add(*feature, key, std::move(value));
      if (columns.bytes >= kStatementBytes) columns.send(connection);
    }
  }
  columns.send(connection);
  if (const auto done = connection.results(); !done) return done.error();
  return Done{};
}

Status write_attributes(DatabaseSession& connection, std::string_view collection,
                        FeatureRefs features, const AttributeReader& reader) {
  const Result<Rows> rows = connection.ask(kChosen, Parameters().text(collection));
  if (!rows) return rows.error();
  AttributeKeys chosen;
  for (int row = 0; row < rows->size(); ++row) {
    chosen.keys.push_back(rows->int8(row, 0));
    chosen.names.emplace_back(rows->text(row, 1));
  }
  if (chosen.keys.empty()) return Done{};
  return write_values(connection, features, chosen, reader);
}

std::string attribute_clauses(std::span<const AttributeCondition> conditions, int next,
                              Parameters& parameters) {
  std::string clauses;
  for (const AttributeCondition& condition : conditions) {
    const Filter filter{
        Filter::Kind::compare, {}, condition.name, condition.comparison, condition.values};
    clauses.append(" AND ").append(filter_clause(filter, next, parameters));
  }
  return clauses;
}

Status check_names(DatabaseSession& connection, const std::string& collection,
                   std::span<const std::string> names) {
  if (names.empty()) return Done{};
  const auto chosen = read_attributes(connection, collection);
  if (!chosen) return chosen.error();
  for (const std::string& name : names) {
    const auto found = std::find_if(chosen->begin(), chosen->end(),
                                    [&](const ChosenAttribute& one) { return one.name == name; });
    if (found == chosen->end()) return not_chosen(collection, name);
    if (found->is_complete()) continue;
    return Error{ErrorCode::invalid_argument, "the attribute '" + name + "' of collection '" +
                                                  collection +
                                                  "' cannot be queried yet: its values are being "
                                                  "filled in"};
  }
  return Done{};
}

}  // namespace watertight::store
