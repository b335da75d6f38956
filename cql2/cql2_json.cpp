// SPDX-License-Identifier: GPL-3.0-or-later
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "cql2/cql2.h"
#include "cql2/parts.h"

namespace watertight::cql2 {
namespace {

using Json = nlohmann::json;
using store::Filter;
using Kind = Filter::Kind;

/// Reads one expression after the other, and knows where it is.
class Reader {
 public:
  Result<Filter> expression(const Json& json, const std::string& pointer, std::size_t depth) const {
    if (depth == 0) {
      return Error{ErrorCode::limit_exceeded, "filter: nested too deep", {}, pointer};
    }
    if (json.is_boolean()) {
      Filter constant;
      constant.truth = json.get<bool>();
      return constant;
    }
    if (!json.is_object() || !json.contains("op") || !json["op"].is_string() ||
        !json.contains("args") || !json["args"].is_array()) {
      return wrong("an expression is {\"op\": ..., \"args\": [...]}, true or false", pointer);
    }
    const std::string op = json["op"].get<std::string>();
    const Json& args = json["args"];
    const std::string at = pointer + "/args";
    if (op == "and" || op == "or") return joined(op == "and", args, at, depth);
    if (op == "not") {
      if (args.size() != 1) return wrong("not has one argument", at);
      auto part = expression(args[0], at + "/0", depth - 1);
      if (!part) return part;
      return negated(*std::move(part));
    }
    if (op == "s_intersects") return place(args, at);
    return predicate(op, args, at);
  }

 private:
  static Error wrong(const std::string& message, const std::string& pointer) {
    return {ErrorCode::malformed, "filter: " + message, {}, pointer};
  }

  Result<Filter> joined(bool is_and, const Json& args, const std::string& at,
                        std::size_t depth) const {
    if (args.size() < 2) return wrong("and and or have two arguments or more", at);
    Filter filter{is_and ? Kind::all : Kind::any};
    for (std::size_t i = 0; i < args.size(); ++i) {
      auto part = expression(args[i], at + "/" + std::to_string(i), depth - 1);
      if (!part) return part;
      filter.parts.push_back(*std::move(part));
    }
    return filter;
  }

  static Result<std::string> property(const Json& args, const std::string& at) {
    if (args.empty() || !args[0].is_object() || !args[0].contains("property") ||
        !args[0]["property"].is_string()) {
      return wrong("the first argument is {\"property\": NAME}", at + "/0");
    }
    return args[0]["property"].get<std::string>();
  }

  static Result<AttributeValue> literal(const Json& json, const std::string& at) {
    using Type = AttributeValue::Type;
    if (json.is_number()) return AttributeValue{Type::number, json.dump()};
    if (json.is_boolean()) return AttributeValue{Type::truth, json.dump()};
    if (json.is_string()) return AttributeValue{Type::text, json.get<std::string>()};
    if (json.is_object() && json.size() == 1) {
      const auto member = json.items().begin();
      const bool is_date = member.key() == "date" || member.key() == "timestamp";
      if (is_date && member.value().is_string() && is_instant(member.value().get<std::string>())) {
        return AttributeValue{Type::text, member.value().get<std::string>()};
      }
    }
    return wrong(
        "a value is a number, a text, true, false, {\"date\": ...} or {\"timestamp\": ...}", at);
  }

  /// Adds the literals among some arguments.
  static Status add_literals(const Json& args, std::size_t first, const std::string& at,
                             Filter& filter) {
    for (std::size_t i = first; i < args.size(); ++i) {
      auto value = literal(args[i], at + "/" + std::to_string(i));
      if (!value) return std::move(value).error();
      filter.values.push_back(*std::move(value));
    }
    return Done{};
  }

  static Result<Filter> predicate(const std::string& op, const Json& args, const std::string& at) {
    auto name = property(args, at);
    if (!name) return std::move(name).error();
    const auto compared = comparison_named(op);
    Filter filter{Kind::compare, {}, *std::move(name)};
    std::size_t wanted = 2;
    if (compared) {
      filter.comparison = *compared;
    } else if (op == "isNull") {
      filter.kind = Kind::is_null;
      wanted = 1;
    } else if (op == "between") {
      filter.kind = Kind::between;
      wanted = 3;
    } else if (op == "like") {
      filter.kind = Kind::like;
    } else if (op != "in") {
      return Error{
          ErrorCode::unsupported, "filter: the operator '" + op + "' is not known here", {}, at};
    }
    if (args.size() != wanted) {
      return wrong(op + " has " + std::to_string(wanted) + " arguments", at);
    }
    const bool is_list = op == "in";
    if (is_list && !args[1].is_array()) return wrong("in has a list of values", at + "/1");
    const Status added =
        is_list ? add_literals(args[1], 0, at + "/1", filter) : add_literals(args, 1, at, filter);
    if (!added) return added.error();
    if (filter.kind == Kind::like) {
      const AttributeValue& pattern = filter.values.front();
      if (pattern.type != AttributeValue::Type::text || !is_pattern(pattern.text)) {
        return wrong("the pattern of like is a text that does not end with a backslash", at + "/1");
      }
    }
    return filter;
  }

  static Result<Filter> place(const Json& args, const std::string& at) {
    const auto name = property(args, at);
    if (!name) return name.error();
    const std::string second = at + "/1";
    if (args.size() != 2 || !args[1].is_object()) return wrong("a geometry is missing", second);
    const bool is_box = args[1].contains("bbox");
    const bool is_point =
        !is_box && args[1].value("type", Json()) == "Point" && args[1].contains("coordinates");
    if (!is_box && !is_point) {
      return Error{ErrorCode::unsupported,
                   "filter: the geometry can be {\"bbox\": [...]} or a Point",
                   {},
                   second};
    }
    const Json& list = args[1][is_box ? "bbox" : "coordinates"];
    std::vector<double> numbers;
    for (const Json& number : list) {
      if (!list.is_array() || !number.is_number() || numbers.size() == 6) {
        return wrong("coordinates are a list of numbers", second);
      }
      numbers.push_back(number.get<double>());
    }
    auto filter = is_box ? box_filter(numbers) : point_filter(numbers);
    if (!filter) return wrong(filter.error().message, second);
    return filter;
  }
};

}  // namespace

Result<Filter> read_json(std::string_view text) {
  const Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded()) return Error{ErrorCode::malformed, "filter: not JSON"};
  auto filter = Reader().expression(json, "", store::kDeepestFilter);
  if (!filter) return filter;
  if (Status checked = store::check_filter(*filter); !checked) return std::move(checked).error();
  return filter;
}

}  // namespace watertight::cql2
