// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/attributes/filter_rows.h"

#include <algorithm>

namespace watertight::store {
namespace {

using Kind = Filter::Kind;

/// How a clause is used: where false and unknown mean the same, or where they differ.
enum class Logic : std::uint8_t { two_valued, three_valued };

const char* sign_of(Comparison comparison) {
  switch (comparison) {
    case Comparison::equal:
      return " = ";
    case Comparison::different:
      return " <> ";
    case Comparison::less:
      return " < ";
    case Comparison::at_most:
      return " <= ";
    case Comparison::greater:
      return " > ";
    case Comparison::at_least:
      return " >= ";
  }
  return " = ";
}

class Writer {
 public:
  Writer(int& next, Parameters& parameters) : next_(next), parameters_(parameters) {}

  std::string clause(const Filter& filter, Logic logic) {
    switch (filter.kind) {
      case Kind::all:
        return joined(filter, " AND ", "true", logic);
      case Kind::any:
        return joined(filter, " OR ", "false", logic);
      case Kind::no:
        return std::string("(NOT ")
            .append(clause(filter.parts.front(), Logic::three_valued))
            .append(")");
      case Kind::is_null:
        return std::string("(NOT EXISTS (SELECT").append(of_attribute(filter.name)).append("))");
      case Kind::box:
        return box(filter.box);
      case Kind::constant:
        return filter.truth ? "true" : "false";
      case Kind::compare:
      case Kind::between:
      case Kind::like:
        break;
    }
    // The parameters are numbered in the order in which they are added.
    const std::string values = of_attribute(filter.name);
    const std::string condition = on_values(filter);
    std::string text = "(";
    if (logic == Logic::two_valued) {
      return text.append("EXISTS (SELECT")
          .append(values)
          .append(" AND ")
          .append(condition)
          .append("))");
    }
    text.append("SELECT bool_or(coalesce(").append(condition).append(", false))");
    return text.append(values).append(")");
  }

 private:
  std::string parameter() { return std::string("$").append(std::to_string(next_++)); }

  std::string joined(const Filter& filter, const char* word, const char* neutral, Logic logic) {
    std::string text = "(";
    text += neutral;
    for (const Filter& part : filter.parts) text.append(word).append(clause(part, logic));
    return text.append(")");
  }

  /// The values of an attribute in the feature.
  std::string of_attribute(const std::string& name) {
    parameters_.text(name);
    return " FROM watertight.attribute_value v WHERE v.feature = hashtextextended(f.id, 0)"
           " AND v.attribute = (SELECT n.key FROM watertight.attribute_name n"
           " JOIN watertight.collection o ON o.key = n.collection"
           " WHERE o.name = $1 AND n.is_complete AND n.name = " +
           parameter() + ")";
  }

  std::string on_values(const Filter& filter) {
    if (filter.kind == Kind::like) {
      if (!is_kept(filter.values.front())) return "false";  // no feature has such a text
      parameters_.text(filter.values.front().text);
      return std::string("v.text LIKE ").append(parameter());
    }
    if (filter.kind == Kind::between) {
      const std::string low =
          value_clause(Comparison::at_least, filter.values[0], next_, parameters_);
      const std::string high =
          value_clause(Comparison::at_most, filter.values[1], next_, parameters_);
      return std::string("(").append(low).append(" AND ").append(high).append(")");
    }
    std::string text = "(false";
    for (const AttributeValue& value : filter.values) {
      text.append(" OR ").append(value_clause(filter.comparison, value, next_, parameters_));
    }
    return text + ")";
  }

  /// The index finds candidates in x and y, as for FeatureQuery::box.
  std::string box(const StoredBox& box) {
    for (const double value : box.min) parameters_.float8(value);
    for (const double value : box.max) parameters_.float8(value);
    std::array<std::string, 6> at;
    for (std::string& each : at) each = parameter();
    std::string text =
        "(min_x IS NOT NULL AND watertight.index_box(min_x, min_y, max_x, max_y)"
        " && watertight.index_box(";
    text.append(at[0]).append(", ").append(at[1]).append(", ").append(at[3]).append(", ");
    text.append(at[4]).append(")");
    constexpr std::array kComparisons = {" AND max_x >= ", " AND max_y >= ", " AND max_z >= ",
                                         " AND min_x <= ", " AND min_y <= ", " AND min_z <= "};
    for (std::size_t i = 0; i < at.size(); ++i) text.append(kComparisons[i]).append(at[i]);
    return text.append(")");
  }

  int& next_;
  Parameters& parameters_;
};

void add_names(const Filter& filter, std::vector<std::string>& names) {
  const bool is_new = std::find(names.begin(), names.end(), filter.name) == names.end();
  if (!filter.name.empty() && is_new) names.push_back(filter.name);
  for (const Filter& part : filter.parts) add_names(part, names);
}

/// The number of conditions and values in a tree; nothing if it is too deep.
std::optional<std::size_t> size_of(const Filter& filter, std::size_t depth) {
  if (depth == 0) return std::nullopt;
  std::size_t size = 1 + filter.values.size();
  for (const Filter& part : filter.parts) {
    const auto more = size_of(part, depth - 1);
    if (!more) return std::nullopt;
    size += *more;
  }
  return size;
}

}  // namespace

Filter filter_of(std::span<const AttributeCondition> conditions) {
  Filter filter{Filter::Kind::all};
  for (const AttributeCondition& condition : conditions) {
    filter.parts.push_back(
        {Filter::Kind::compare, {}, condition.name, condition.comparison, condition.values});
  }
  return filter;
}

std::vector<std::string> names_in(const Filter& filter) {
  std::vector<std::string> names;
  add_names(filter, names);
  return names;
}

Status check_filter(const Filter& filter) {
  const auto size = size_of(filter, kDeepestFilter);
  if (size && *size <= kMostFilterParts) return Done{};
  return Error{ErrorCode::limit_exceeded, "a filter has at most " +
                                              std::to_string(kMostFilterParts) +
                                              " conditions and values, nested at most " +
                                              std::to_string(kDeepestFilter) + " times"};
}

std::string value_clause(Comparison comparison, const AttributeValue& value, int& next,
                         Parameters& parameters) {
  using Type = AttributeValue::Type;
  if (!is_kept(value)) return "false";  // no feature has it
  parameters.text(value.text);
  const std::string number = std::to_string(next++);
  std::string text = value.type == Type::number  ? "v.number"
                     : value.type == Type::truth ? "v.truth"
                                                 : "v.text";
  text.append(sign_of(comparison));
  text.append(value.type == Type::text ? "watertight.attribute_text($" : "($").append(number);
  return text.append(value.type == Type::number  ? "::numeric)"
                     : value.type == Type::truth ? "::boolean)"
                                                 : ")");
}

std::string filter_clause(const Filter& filter, int& next, Parameters& parameters) {
  return Writer(next, parameters).clause(filter, Logic::two_valued);
}

}  // namespace watertight::store
