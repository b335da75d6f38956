// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/gml/city/values.h"

#include <algorithm>
#include <array>
#include <utility>

#include "formats/gml/city/names.h"
#include "formats/gml/elements.h"
#include "formats/text/numbers.h"

namespace watertight::formats {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Whether JSON spells a number like this: -?(0|[1-9]d*)(.d+)?([eE][+-]?d+)?
bool is_json_number(std::string_view text) {
  const auto skip_digits = [&] {
    const std::size_t before = text.size();
    while (!text.empty() && is_digit(text.front())) text.remove_prefix(1);
    return before > text.size();
  };
  if (text.starts_with('-')) text.remove_prefix(1);
  if (text.size() > 1 && text[0] == '0' && is_digit(text[1])) return false;
  if (!skip_digits()) return false;
  if (text.starts_with('.')) {
    text.remove_prefix(1);
    if (!skip_digits()) return false;
  }
  if (text.starts_with('e') || text.starts_with('E')) {
    text.remove_prefix(1);
    if (text.starts_with('-') || text.starts_with('+')) text.remove_prefix(1);
    if (!skip_digits()) return false;
  }
  return text.empty();
}

Json numbers_of(std::string_view text) {
  Json list = Json::array();
  while (!(text = without_blanks(text)).empty()) {
    const std::string_view word = text.substr(0, text.find_first_of(" \t\r\n"));
    text.remove_prefix(word.size());
    list.push_back(ValueReader::number_of(word));
  }
  return list;
}

// The attributes of XML that are no content: declarations of schemas, and links' kind.
bool is_bookkeeping(std::string_view space, std::string_view name) {
  return space == "http://www.w3.org/2001/XMLSchema-instance" ||
         (space == kXlinkSpace && name != "href");
}

// The most different attributes of XML for the elements of one name. Others are losses.
constexpr std::size_t kMostBeside = 16;

struct GenericKind {
  std::string_view element;
  bool is_number;
  std::string_view type;  // where JSON cannot say it
};
constexpr std::array kGenerics{
    GenericKind{"stringAttribute", false, ""}, GenericKind{"intAttribute", true, ""},
    GenericKind{"doubleAttribute", true, ""},  GenericKind{"dateAttribute", false, "date"},
    GenericKind{"uriAttribute", false, "uri"}, GenericKind{"measureAttribute", true, ""},
    GenericKind{"StringAttribute", false, ""}, GenericKind{"IntAttribute", true, ""},
    GenericKind{"DoubleAttribute", true, ""},  GenericKind{"DateAttribute", false, "date"},
    GenericKind{"UriAttribute", false, "uri"}, GenericKind{"MeasureAttribute", true, ""},
    GenericKind{"CodeAttribute", false, ""},
};

bool is_generic_set(std::string_view name) {
  return name == "genericAttributeSet" || name == "GenericAttributeSet";
}

}  // namespace

bool is_generic_attribute(std::string_view name) {
  return name == "genericAttribute" || is_generic_set(name) ||
         std::any_of(kGenerics.begin(), kGenerics.end(),
                     [&](const GenericKind& kind) { return kind.element == name; });
}

void ObjectBuilder::add(std::string key, Json value, std::string_view prefix) {
  while (!numbers_.emplace(key, keys_.size()).second) key.insert(0, prefix.empty() ? "_" : prefix);
  keys_.push_back(std::move(key));
  values_.push_back(std::move(value));
}

Json ObjectBuilder::take() {
  numbers_.clear();
  return make_object(keys_, values_);
}

Json ValueReader::number_of(std::string_view text) {
  if (is_json_number(text)) {
    return Json::binary(std::vector<std::uint8_t>(text.begin(), text.end()));
  }
  return std::string(text);
}

Json ValueReader::scalar(Index element) const {
  const std::string_view text = tree_.text(element);
  const std::string_view name = tree_.name(element);
  if (is_list_property(name)) return numbers_of(text);
  if (is_boolean_property(name) && (text == "true" || text == "1")) return true;
  if (is_boolean_property(name) && (text == "false" || text == "0")) return false;
  if (is_number_property(name) || tree_.find_attribute(element, "", "uom") != kNone) {
    return number_of(text);
  }
  return std::string(text);
}

// A property with children. An object in it shows by "type"; several make a list.
Json ValueReader::structure(Index element) {
  std::vector<Index> properties;
  Json objects = Json::array();
  for (Index i = tree_[element].first_child; i != kNone; i = tree_[i].next) {
    const std::string_view name = tree_.name(i);
    // Geometry within structured values has no place; the list of losses names it.
    if (tree_.is_gml(i) && geometry_kind(name)) continue;
    if (!is_object_name(name) || tree_[i].first_child == kNone) {
      properties.push_back(i);
      continue;
    }
    marks_.mark(i);
    ObjectBuilder object;
    object.add("type", std::string(name), "");
    if (!tree_.id(i).empty()) {
      object.add("id", std::string(tree_.id(i)), "");
      marks_.mark_attribute(tree_.id_attribute(i));
    }
    Json own = structure(i);
    if (own.is_object()) {
      for (auto& [key, value] : own.get_ref<Json::object_t&>()) {
        object.add(key, std::move(value), "property:");
      }
    } else if (!own.is_null()) {
      object.add("value", std::move(own), "property:");
    }
    objects.push_back(object.take());
  }
  ObjectBuilder members;
  marks_.mark_text(element);
  if (!tree_.text(element).empty()) members.add("text", std::string(tree_.text(element)), "");
  add_properties(properties, members);
  if (members.is_empty()) {
    if (objects.empty()) return nullptr;
    return objects.size() == 1 ? std::move(objects[0]) : objects;
  }
  if (!objects.empty()) members.add("values", std::move(objects), "property:");
  return members.take();
}

Json ValueReader::value_of(Index element) {
  marks_.mark(element);
  marks_.mark_text(element);
  if (tree_[element].first_child == kNone) {
    if (tree_.text(element).empty() && !tree_.href(element).empty()) return nullptr;
    return scalar(element);
  }
  return structure(element);
}

void ValueReader::add_properties(const std::vector<Index>& properties, ObjectBuilder& object) {
  std::map<std::string_view, std::size_t> numbers;
  std::vector<std::vector<Index>> groups;
  for (const Index property : properties) {
    const auto [place, is_new] = numbers.emplace(tree_.name(property), groups.size());
    if (is_new) groups.emplace_back();
    groups[place->second].push_back(property);
  }
  for (const std::vector<Index>& group : groups) {
    const std::string name(tree_.name(group.front()));
    Json values = Json::array();
    std::map<std::string_view, Json> beside;  // the XML attributes of each element of the group
    for (std::size_t i = 0; i < group.size(); ++i) {
      const TreeElement& own = tree_[group[i]];
      for (Index k = own.first_attribute; k < own.first_attribute + own.attribute_count; ++k) {
        if (is_bookkeeping(tree_.attribute_space(k), tree_.attribute_name(k))) continue;
        // Each list has an entry for every element of the group: only so many lists are linear.
        if (beside.size() >= kMostBeside && !beside.contains(tree_.attribute_name(k))) continue;
        Json& list = beside.emplace(tree_.attribute_name(k), Json::array()).first->second;
        while (list.size() < i) list.push_back(nullptr);
        list.push_back(std::string(tree_.attribute_value(k)));
        marks_.mark_attribute(k);
      }
      values.push_back(value_of(group[i]));
    }
    const bool is_one = group.size() == 1;
    const bool is_nothing =
        std::all_of(values.begin(), values.end(), [](const Json& v) { return v.is_null(); });
    if (!is_nothing || beside.empty()) {
      object.add(name, is_one ? std::move(values[0]) : std::move(values), "property:");
    }
    for (auto& [attribute, list] : beside) {
      while (list.size() < group.size()) list.push_back(nullptr);
      std::string key = name;
      key.append("_").append(attribute);
      object.add(std::move(key), is_one ? std::move(list[0]) : std::move(list), "property:");
    }
  }
}

// One generic attribute: <stringAttribute name="n"><value>v</value></stringAttribute> or
// <StringAttribute><name>n</name><value>v</value></StringAttribute>.
ValueReader::Generic ValueReader::generic(Index element) {
  marks_.mark(element);
  Generic found;
  const Index attribute = tree_.find_attribute(element, "", "name");
  const Index name = tree_.child(element, "name");
  if (attribute != kNone) {
    found.name = tree_.attribute_value(attribute);
    marks_.mark_attribute(attribute);
  } else if (name != kNone) {
    found.name = tree_.text(name);
    marks_.mark(name);
  }
  const auto* const kind =
      std::find_if(kGenerics.begin(), kGenerics.end(),
                   [&](const GenericKind& known) { return known.element == tree_.name(element); });
  if (kind == kGenerics.end()) {
    std::vector<Index> members;
    for (const Index member : tree_.children(element)) {
      if (member != name) members.push_back(member);
    }
    ObjectBuilder set;
    add_generics(members, set);
    found.value = set.take();
    const Index space = tree_.find_attribute(element, "", "codeSpace");
    if (space != kNone) {
      found.space = tree_.attribute_value(space);
      marks_.mark_attribute(space);
    }
    return found;
  }
  found.type = kind->type;
  const Index value = tree_.child(element, "value");
  if (value == kNone) return found;
  marks_.mark(value);
  const std::string_view text = tree_.text(value);
  found.value = kind->is_number ? number_of(text) : Json(std::string(text));
  const Index uom = tree_.find_attribute(value, "", "uom");
  const Index space = tree_.find_attribute(value, "", "codeSpace");
  if (space != kNone) found.space = tree_.attribute_value(space);
  marks_.mark_attribute(space);
  if (uom == kNone) return found;
  marks_.mark_attribute(uom);
  Json measure = Json::object();
  append_member(measure, "value", std::move(found.value));
  append_member(measure, "uom", std::string(tree_.attribute_value(uom)));
  found.value = std::move(measure);
  return found;
}

void ValueReader::add_generics(const std::vector<Index>& elements, ObjectBuilder& object) {
  std::vector<Index> generics;
  for (const Index element : elements) {
    if (tree_.name(element) != "genericAttribute") {
      generics.push_back(element);
      continue;
    }
    marks_.mark(element);
    for (const Index value : tree_.children(element)) generics.push_back(value);
  }
  std::map<std::string, std::size_t> numbers;
  std::vector<std::vector<Generic>> groups;
  for (const Index element : generics) {
    if (!is_generic_attribute(tree_.name(element))) continue;
    Generic own = generic(element);
    const auto [place, is_new] = numbers.emplace(own.name, groups.size());
    if (is_new) groups.emplace_back();
    groups[place->second].push_back(std::move(own));
  }
  for (std::vector<Generic>& group : groups) {
    const std::string name = group.front().name;
    const std::string type = group.front().type;
    const std::string space = group.front().space;
    Json values = Json::array();
    for (Generic& own : group) values.push_back(std::move(own.value));
    object.add(name, group.size() == 1 ? std::move(values[0]) : std::move(values), "generic:");
    if (!type.empty()) object.add(name + "_type", type, "generic:");
    if (!space.empty()) object.add(name + "_codeSpace", space, "generic:");
  }
}

}  // namespace watertight::formats
