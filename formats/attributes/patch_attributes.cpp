// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/attributes/patch_attributes.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

namespace watertight::formats {
namespace {

using Json = nlohmann::ordered_json;

/// A member of an object: its name, and its value as text.
struct Member {
  std::string name;
  std::string_view value;
};

std::size_t after_blanks(std::string_view text, std::size_t at) {
  return std::min(text.find_first_not_of(" \t\r\n", at), text.size());
}

/// The end of the string that starts at `at`.
std::size_t end_of_string(std::string_view text, std::size_t at) {
  for (++at; at < text.size() && text[at] != '"'; ++at) {
    if (text[at] == '\\') ++at;
  }
  return std::min(at + 1, text.size());
}

/// The end of the value that starts at `at`, in a text that is JSON.
std::size_t end_of_value(std::string_view text, std::size_t at) {
  std::size_t depth = 0;
  while (at < text.size()) {
    const char c = text[at];
    if (c == '"') {
      at = end_of_string(text, at);
    } else {
      if (depth == 0 && (c == ',' || c == '}' || c == ']')) return at;
      if (c == '{' || c == '[') ++depth;
      if (c == '}' || c == ']') --depth;
      ++at;
    }
    if (depth == 0 && (c == '"' || c == '}' || c == ']')) return at;
  }
  return at;
}

std::string_view without_blanks_at_end(std::string_view text) {
  return text.substr(0, text.find_last_not_of(" \t\r\n") + 1);
}

/// The members of an object that is JSON, in order.
std::vector<Member> members_of(std::string_view object) {
  std::vector<Member> members;
  std::size_t at = after_blanks(object, after_blanks(object, 0) + 1);
  while (at < object.size() && object[at] == '"') {
    const std::size_t end = end_of_string(object, at);
    std::string name = Json::parse(object.substr(at, end - at)).get<std::string>();
    const std::size_t value = after_blanks(object, after_blanks(object, end) + 1);
    at = end_of_value(object, value);
    members.push_back({std::move(name), without_blanks_at_end(object.substr(value, at - value))});
    at = after_blanks(object, at);
    if (at < object.size() && object[at] == ',') at = after_blanks(object, at + 1);
  }
  return members;
}

/// The value of a member, of the last of that name as readers take it.
std::optional<std::string_view> value_of(std::string_view object, std::string_view name) {
  std::optional<std::string_view> found;
  for (const Member& member : members_of(object)) {
    if (member.name == name) found = member.value;
  }
  return found;
}

std::string text_of(const std::vector<Member>& members) {
  std::string text = "{";
  for (const Member& member : members) {
    if (text.size() > 1) text += ',';
    text.append(Json(member.name).dump()).append(":").append(member.value);
  }
  return text += '}';
}

/// The value of a member that a patch adds or replaces: of an object without members that are null.
Json without_nulls(const Json& value) {
  if (!value.is_object()) return value;
  Json kept = Json::object();
  for (const auto& [name, member] : value.items()) {
    if (!member.is_null()) kept[name] = without_nulls(member);
  }
  return kept;
}

std::string merged(std::string_view target, const Json& patch) {
  std::vector<Member> members = members_of(target);
  std::vector<std::string> texts;  // what members refer to
  texts.reserve(patch.size());
  for (const auto& [name, change] : patch.items()) {
    const auto same = [&name = name](const Member& member) { return member.name == name; };
    const auto found = std::find_if(members.begin(), members.end(), same);
    const bool is_merged =
        found != members.end() && change.is_object() && found->value.starts_with('{');
    if (!change.is_null()) {
      texts.push_back(is_merged ? merged(found->value, change) : without_nulls(change).dump());
    }
    if (found != members.end() && !change.is_null()) {
      found->value = texts.back();
      members.erase(std::remove_if(found + 1, members.end(), same), members.end());
    } else if (change.is_null()) {
      members.erase(std::remove_if(members.begin(), members.end(), same), members.end());
    } else {
      members.push_back({name, texts.back()});
    }
  }
  return text_of(members);
}

/// `text` with `part`, a view into it, replaced.
std::string replaced(std::string_view text, std::string_view part, std::string_view by) {
  const auto at = static_cast<std::size_t>(part.data() - text.data());
  std::string out(text.substr(0, at));
  return out.append(by).append(text.substr(at + part.size()));
}

bool is_object(std::string_view text) {
  return Json::accept(text) && text.substr(after_blanks(text, 0)).starts_with('{');
}

}  // namespace

Result<std::string> merge_patch(std::string_view target, std::string_view patch) {
  if (!is_object(target) || !is_object(patch)) {
    return Error{ErrorCode::malformed, "a merge patch is a JSON object, and changes one"};
  }
  bool is_deep = false;
  const auto limit = [&is_deep](int depth, Json::parse_event_t, Json&) {
    is_deep = is_deep || depth > kDeepestPatch;
    return !is_deep;
  };
  const Json change = Json::parse(patch, limit);
  if (is_deep) {
    return Error{ErrorCode::limit_exceeded,
                 "the patch is nested deeper than " + std::to_string(kDeepestPatch) + " levels"};
  }
  return merged(target, change);
}

Result<std::string> patch_attributes(std::string_view feature, const std::string& object,
                                     std::string_view patch) {
  if (!is_object(feature)) return Error{ErrorCode::malformed, "the feature is no JSON object"};
  const auto objects = value_of(feature, "CityObjects");
  const auto own = objects && objects->starts_with('{') ? value_of(*objects, object) : std::nullopt;
  if (!own || !own->starts_with('{')) {
    return Error{ErrorCode::not_found, "the feature has no city object '" + object + "'"};
  }
  if (const auto attributes = value_of(*own, "attributes")) {
    const auto changed = merge_patch(*attributes, patch);
    if (!changed) return changed.error();
    return replaced(feature, *attributes, *changed);
  }
  const auto added = merge_patch("{}", patch);
  if (!added) return added.error();
  const std::string with_attributes = merged(*own, Json{{"attributes", Json::parse(*added)}});
  return replaced(feature, *own, with_attributes);
}

}  // namespace watertight::formats
