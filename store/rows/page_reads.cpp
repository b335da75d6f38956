// SPDX-License-Identifier: GPL-3.0-or-later
//
// Pages of features: in the order of the hashes of their ids, or by the values of an attribute.
#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "store/attributes/attribute_rows.h"
#include "store/attributes/filter_rows.h"
#include "store/rows/feature_rows.h"

namespace watertight::store {
namespace {

constexpr const char* kSummaryColumns =
    "SELECT f.id, k.type, f.version, f.solids::int8, f.blob_bytes::int8,"
    " min_x, min_y, min_z, max_x, max_y, max_z, f.unproven::int8, f.is_proven::int::int8";
constexpr int kSummaryColumnCount = 13;

/// The tables and the WHERE clause of a query: $1 is the collection and, if there is a box, $2 ...
/// $7 are its smallest and largest coordinates. The index of boxes finds candidates in x and y;
/// PostgreSQL's box operator is generous by 1e-6, so none is missed. The comparison of the six
/// numbers decides. For a small box the added 0 keeps PostgreSQL from narrowing the candidates
/// down by an index that holds all features of the collection; for a larger one PostgreSQL chooses
/// between place and id; for a box around everything a search by place would save nothing.
std::string matching(const FeatureQuery& query) {
  constexpr const char* kFeatures =
      " watertight.feature_row f JOIN watertight.kind k ON k.key = f.kind WHERE ";
  constexpr const char* kOfCollection = "= (SELECT key FROM watertight.collection WHERE name = $1)";
  constexpr const char* kCandidates =
      " AND watertight.index_box(min_x, min_y, max_x, max_y)"
      " && watertight.index_box($2, $3, $5, $6)";
  constexpr const char* kInBox =
      " AND min_x IS NOT NULL AND min_x <= $5 AND min_y <= $6 AND min_z <= $7"
      " AND max_x >= $2 AND max_y >= $3 AND max_z >= $4";
  constexpr double kSmall = 1.0 / 16;
  const bool is_small = query.box && query.share < kSmall;
  std::string clauses = kFeatures;
  clauses.append(is_small ? "f.collection + 0 " : "f.collection ").append(kOfCollection);
  if (query.box && query.share < 1) clauses.append(kCandidates);
  if (query.box) clauses.append(kInBox);
  if (query.is_proven) clauses.append(*query.is_proven ? " AND is_proven" : " AND NOT is_proven");
  return clauses;
}

/// The parameters of matching(): $1 is the collection and, if there is a box, $2 ... $7 are its
/// smallest and largest coordinates.
Parameters filter_parameters(const FeatureQuery& query) {
  Parameters parameters;
  parameters.text(query.collection);
  if (query.box) {
    for (const double value : query.box->min) parameters.float8(value);
    for (const double value : query.box->max) parameters.float8(value);
  }
  return parameters;
}

Result<Rows> summary_rows(DatabaseSession& connection, const FeatureQuery& query,
                          std::int64_t limit) {
  Parameters parameters = filter_parameters(query);
  // In order of the hashes of ids, which are unique in a collection and in an index.
  const int next = query.box ? 8 : 2;
  std::string rest;
  if (!query.after.empty()) {
    rest = " AND hashtextextended(f.id, 0) > hashtextextended($" + std::to_string(next) + ", 0)";
    parameters.text(query.after);
  }
  rest += " ORDER BY hashtextextended(f.id, 0) LIMIT $";
  rest += std::to_string(query.after.empty() ? next : next + 1);
  parameters.int8(limit);
  int own = query.after.empty() ? next + 1 : next + 2;  // the number of the next parameter
  std::string clauses;
  if (query.filter) clauses = " AND " + filter_clause(*query.filter, own, parameters);
  rest = clauses + attribute_clauses(query.where, own, parameters) + rest;
  const std::string statement =
      std::string(kSummaryColumns).append(" FROM").append(matching(query)).append(rest);
  // A query of attributes is planned for its values.
  return query.where.empty() && !query.filter ? connection.ask(statement, parameters)
                                              : connection.run(statement, parameters);
}

FeatureSummary summary_of(const Rows& rows, int row) {
  FeatureSummary summary;
  summary.id = rows.text(row, 0);
  summary.type = rows.text(row, 1);
  summary.version = static_cast<std::uint64_t>(rows.int8(row, 2));
  summary.solids = static_cast<std::uint64_t>(rows.int8(row, 3));
  summary.blob_bytes = static_cast<std::uint64_t>(rows.int8(row, 4));
  summary.box = box_of(rows, row, 5);
  summary.unproven = static_cast<std::uint64_t>(rows.int8(row, 11));
  summary.is_proven = rows.int8(row, 12) != 0;
  return summary;
}

/// The kinds of values in a sorted list, in the order in which they come; then features without.
constexpr std::array<std::pair<char, const char*>, 3> kValueKinds{
    {{'n', "number"}, {'t', "text"}, {'b', "truth"}}};
constexpr std::array<const char*, 3> kValueTypes = {"numeric", "text", "boolean"};

/// Whether a text is a number as PostgreSQL writes it.
bool is_number_text(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789.-") == std::string_view::npos &&
         text.find_first_of("0123456789") != std::string_view::npos &&
         text.rfind('-') != text.size() - 1 &&
         (text.rfind('-') == 0 || text.rfind('-') == std::string_view::npos) &&
         std::count(text.begin(), text.end(), '.') <= 1;
}

/// The place in a sorted list after which a page starts.
struct SortPlace {
  std::size_t kind = 0;  // index in kValueKinds; their number for features without a value
  std::string value;     // as text; none at the start of the list
  std::string id;        // "" at the start
};

std::string to_string(const SortPlace& place) {
  const bool has_value = place.kind < kValueKinds.size();
  std::string text(1, has_value ? kValueKinds[place.kind].first : '-');
  return text.append(std::to_string(place.value.size()))
      .append(":")
      .append(place.value)
      .append(place.id);
}

Result<SortPlace> sort_place(const std::string& text) {
  const Error wrong{ErrorCode::invalid_argument, "a sorted page cannot start there"};
  SortPlace place;
  if (text.empty()) return place;
  while (place.kind < kValueKinds.size() && kValueKinds[place.kind].first != text[0]) ++place.kind;
  if (place.kind == kValueKinds.size() && text[0] != '-') return wrong;
  std::size_t length = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data() + 1, end, length);
  if (error != std::errc{} || rest == end || *rest != ':') return wrong;
  const std::string_view after(rest + 1, static_cast<std::size_t>(end - rest - 1));
  if (length > after.size()) return wrong;
  place.value = after.substr(0, length);
  place.id = after.substr(length);
  const AttributeValue value{
      place.kind == 0 ? AttributeValue::Type::number : AttributeValue::Type::text, place.value};
  const bool is_number = place.kind != 0 || is_number_text(place.value);
  const bool is_truth = place.kind != 2 || place.value == "true" || place.value == "false";
  if (!is_possible_id(place.id) || !is_kept(value) || !is_number || !is_truth) return wrong;
  return place;
}

/// Writes the statement for the part of a sorted list that has the values of one kind, or none.
class SortedStatement {
 public:
  SortedStatement(const FeatureQuery& query, const SortPlace& after)
      : query_(query), after_(after), parameters_(filter_parameters(query)) {
    next_ = query.box ? 8 : 2;
  }

  Result<Rows> run(DatabaseSession& connection, std::int64_t limit) {
    parameters_.text(query_.sort->name);
    attribute_ =
        "(SELECT n.key FROM watertight.attribute_name n JOIN watertight.collection o ON"
        " o.key = n.collection WHERE o.name = $1 AND n.is_complete AND n.name = ";
    attribute_.append(parameter()).append(")");
    const bool has_values = after_.kind < kValueKinds.size();
    std::string statement = kSummaryColumns;
    if (has_values) statement.append(", ").append(column("v")).append("::text");
    statement.append(" FROM");
    if (has_values) statement.append(" watertight.attribute_value v CROSS JOIN");
    statement.append(matching(query_));
    if (query_.filter) {
      statement.append(" AND ").append(filter_clause(*query_.filter, next_, parameters_));
    }
    statement.append(attribute_clauses(query_.where, next_, parameters_));
    // Values of the kinds that came before take a feature out of this part.
    for (std::size_t kind = 0; kind < after_.kind; ++kind) {
      statement.append(without("w.", kValueKinds[kind].second, " IS NOT NULL"));
    }
    statement.append(has_values ? of_values() : of_others());
    parameters_.int8(limit);
    statement.append(" LIMIT ").append(parameter());
    return connection.run(statement, parameters_);
  }

 private:
  std::string parameter() { return std::string("$").append(std::to_string(next_++)); }
  std::string column(const char* table) const {
    return std::string(table).append(".").append(kValueKinds[after_.kind].second);
  }
  /// A clause: the feature has no value `w` of which this holds.
  std::string without(const char* prefix, const std::string& name, const std::string& rest) const {
    return std::string(
               " AND NOT EXISTS (SELECT FROM watertight.attribute_value w WHERE w.feature ="
               " hashtextextended(f.id, 0) AND w.attribute = ")
        .append(attribute_)
        .append(" AND ")
        .append(prefix)
        .append(name)
        .append(rest)
        .append(")");
  }

  /// Each feature at the place of its first value, after the place where the page starts.
  std::string of_values() {
    const bool is_down = query_.sort->is_descending;
    const std::string sign = is_down ? " > " : " < ";
    const std::string value = column("v");
    std::string text = " AND hashtextextended(f.id, 0) = v.feature AND v.attribute = ";
    text.append(attribute_).append(" AND ").append(value).append(" IS NOT NULL");
    const std::string name = kValueKinds[after_.kind].second;
    std::string earlier = sign;
    earlier.append(value);
    text.append(without("w.", name, earlier));
    std::string same = " = ";
    same.append(value).append(" AND w.ctid < v.ctid");
    text.append(without("w.", name, same));
    if (!after_.id.empty()) {
      parameters_.text(after_.value).text(after_.id);
      text.append(" AND (").append(value).append(", v.feature)").append(is_down ? " < " : " > ");
      text.append("(").append(parameter()).append("::").append(kValueTypes[after_.kind]);
      text.append(", hashtextextended(").append(parameter()).append(", 0))");
    }
    const char* order = is_down ? " DESC" : "";
    text.append(" ORDER BY ").append(value).append(order);
    return text.append(", v.feature").append(order);
  }

  std::string of_others() {
    std::string text;
    if (!after_.id.empty()) {
      parameters_.text(after_.id);
      text = " AND hashtextextended(f.id, 0) > hashtextextended(";
      text.append(parameter()).append(", 0)");
    }
    return text.append(" ORDER BY hashtextextended(f.id, 0)");
  }

  const FeatureQuery& query_;
  const SortPlace& after_;
  Parameters parameters_;
  int next_ = 2;
  std::string attribute_;  // its key, as SQL
};

/// Reads the features of a sorted page, and one more if there is one.
Result<std::vector<FeatureSummary>> sorted_features(DatabaseSession& connection,
                                                    const FeatureQuery& query, std::size_t limit) {
  auto place = sort_place(query.after);
  if (!place) return std::move(place).error();
  std::vector<FeatureSummary> features;
  for (; place->kind <= kValueKinds.size() && features.size() <= limit;
       place = SortPlace{place->kind + 1, "", ""}) {
    const auto wanted = static_cast<std::int64_t>(limit + 1 - features.size());
    const Result<Rows> rows = SortedStatement(query, *place).run(connection, wanted);
    if (!rows) return rows.error();
    for (int row = 0; row < rows->size(); ++row) {
      FeatureSummary summary = summary_of(*rows, row);
      const bool has_value = place->kind < kValueKinds.size();
      const std::string value(has_value ? rows->text(row, kSummaryColumnCount) : "");
      summary.cursor = to_string(SortPlace{place->kind, value, summary.id});
      features.push_back(std::move(summary));
    }
  }
  return features;
}

/// Reads the features of a page in the order of their hashes, and one more if there is one.
Result<std::vector<FeatureSummary>> hashed_features(DatabaseSession& connection,
                                                    const FeatureQuery& query, std::size_t limit) {
  const Result<Rows> rows = summary_rows(connection, query, static_cast<std::int64_t>(limit) + 1);
  if (!rows) return rows.error();
  std::vector<FeatureSummary> features;
  for (int row = 0; row < rows->size(); ++row) {
    features.push_back(summary_of(*rows, row));
    features.back().cursor = features.back().id;
  }
  return features;
}

}  // namespace

Result<FeaturePage> read_page(DatabaseSession& connection, const FeatureQuery& query) {
  const std::size_t limit = std::min(query.limit, kLargestPage);
  std::vector<std::string> names;
  if (query.filter) names = names_in(*query.filter);
  for (const AttributeCondition& condition : query.where) names.push_back(condition.name);
  if (query.sort) names.push_back(query.sort->name);
  // One feature more than asked for shows whether there is a next page.
  auto features = query.sort ? sorted_features(connection, query, limit)
                             : hashed_features(connection, query, limit);
  if (!features) return std::move(features).error();
  if (features->empty()) {
    const auto exists = key_of_collection(connection, query.collection);
    if (!exists) return exists.error();
  }
  if (Status able = check_names(connection, query.collection, names); !able) {
    return std::move(able).error();
  }
  FeaturePage page{*std::move(features), ""};
  const bool has_more = page.features.size() > limit;
  if (has_more) page.features.resize(limit);
  if (has_more && limit > 0) page.next = page.features.back().cursor;
  return page;
}

}  // namespace watertight::store
