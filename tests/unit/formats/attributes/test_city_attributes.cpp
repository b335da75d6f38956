// SPDX-License-Identifier: GPL-3.0-or-later
//
// The values of attributes in the skeletons of features.
#include <catch2/catch_test_macros.hpp>
#include <string>
#include <vector>

#include "formats/attributes/city_attributes.h"

namespace watertight::test_city_attributes {
namespace {

using Type = AttributeValue::Type;

std::string skeleton(const std::string& attributes, const std::string& of_part = "{}") {
  std::string text = R"({"type":"CityJSONFeature","id":"b","CityObjects":{"b":{"type":"Building",)"
                     R"("attributes":)";
  text.append(attributes).append(R"(},"p":{"type":"BuildingPart","attributes":)");
  return text.append(of_part).append("}}}");
}

/// "object name type text" of each value, with the type as a number.
std::vector<std::string> values(const std::string& text, const std::vector<std::string>& names) {
  std::vector<std::string> found;
  for (const formats::ObjectAttribute& one : formats::attribute_values(text, names)) {
    std::string& value = found.emplace_back(one.object);
    value.append(" ").append(names.at(one.name)).append(" ");
    value.append(std::to_string(static_cast<int>(one.value.type)));
    value.append(" ").append(one.value.text);
  }
  return found;
}

}  // namespace

TEST_CASE("attributes of all objects have values with their JSON types and all digits") {
  const std::string text =
      skeleton(R"({"n":9007199254740993,"m":1.50,"s":"\u00fc \ud83c\udfe0","t":true,"x":null})",
               R"({"n":123456789012345678901234567890,"m":-0.0,"other":1})");
  CHECK(values(text, {"m", "n", "s", "t", "x"}) ==
        std::vector<std::string>{"b n 0 9007199254740993", "b m 0 1.50",
                                 "b s 1 \xC3\xBC \xF0\x9F\x8F\xA0", "b t 2 true",
                                 "p n 0 123456789012345678901234567890", "p m 0 -0.0"});
  CHECK(values(text, {}).empty());
  CHECK(values(text, {"missing"}).empty());
}

TEST_CASE("a path names a member of an object, or an attribute with dots, and arrays have values") {
  const std::string text = skeleton(
      R"({"a":{"b":{"c":1},"d":[1,"x",null,[2],{"e":3}]},"a.b.c":2,"empty":{},"list":[]})");
  CHECK(values(text, {"a", "a.b", "a.b.c", "a.d", "a.d.e"}) ==
        std::vector<std::string>{"b a.b.c 0 1", "b a.d 0 1", "b a.d 1 x", "b a.b.c 0 2"});
  std::vector<std::string> names;
  for (const formats::AttributeName& one : formats::attribute_names(text)) {
    std::string& name = names.emplace_back(one.name);
    name.append(one.type ? std::to_string(static_cast<int>(*one.type)) : "-");
  }
  CHECK(names == std::vector<std::string>{"a.b.c0", "a.d0", "a.d1", "a.b.c0", "list-"});
}

TEST_CASE("texts that are no skeletons have no attributes") {
  for (const char* text :
       {"", "{", "[]", "1", R"({"CityObjects":[]})", R"({"CityObjects":{"a":1}})",
        R"({"CityObjects":{"a":{"attributes":3}}})"}) {
    CHECK(values(text, {"n"}).empty());
    CHECK(formats::attribute_names(text).empty());
  }
}

TEST_CASE("ten thousand attributes are looked up in one pass") {
  std::string attributes = "{";
  std::vector<std::string> names;
  for (int i = 10000; i < 20000; ++i) {
    names.push_back(std::string("a").append(std::to_string(i)));
    attributes.append(i > 10000 ? ",\"" : "\"").append(names.back()).append("\":");
    attributes.append(std::to_string(i));
  }
  const auto found = formats::attribute_values(skeleton(attributes + "}"), names);
  REQUIRE(found.size() == names.size());
  CHECK(found[1234].value.text == "11234");
}

TEST_CASE("a feature has a bounded number of values, and no long path or id is copied") {
  std::string list = "[0";
  for (int i = 1; i < 20'000; ++i) list += ",1";
  const std::string many = skeleton("{\"a\":" + list + "]}");
  CHECK(formats::attribute_values(many, std::vector<std::string>{"a"}).size() ==
        formats::kMostAttributeValues);
  const std::string path(formats::kLongestAttributePath + 1, 'x');
  const std::string longer = skeleton("{\"" + path + "\":1,\"y\":2}");
  CHECK(formats::attribute_names(longer).size() == 1);
  std::string of_long_id = skeleton("{\"y\":1}", "{\"y\":2}");
  of_long_id.replace(of_long_id.find("\"p\""), 3, "\"" + path + "\"");
  CHECK(values(of_long_id, {"y"}) == std::vector<std::string>{"b y 0 1"});
}

}  // namespace watertight::test_city_attributes
