// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "formats/attributes/patch_attributes.h"
#include "tests/random.h"

namespace watertight::test_patch_attributes {
namespace {

using formats::merge_patch;
using formats::patch_attributes;
using Json = nlohmann::json;

std::string merged(std::string_view target, std::string_view patch) {
  const auto text = merge_patch(target, patch);
  REQUIRE(text);
  return *text;
}

// RFC 7396, appendix A, as far as both are objects.
TEST_CASE("a merge patch does what its standard says") {
  const char* cases[][3] = {
      {R"({"a":"b"})", R"({"a":"c"})", R"({"a":"c"})"},
      {R"({"a":"b"})", R"({"b":"c"})", R"({"a":"b","b":"c"})"},
      {R"({"a":"b"})", R"({"a":null})", R"({})"},
      {R"({"a":"b","b":"c"})", R"({"a":null})", R"({"b":"c"})"},
      {R"({"a":["b"]})", R"({"a":"c"})", R"({"a":"c"})"},
      {R"({"a":"c"})", R"({"a":["b"]})", R"({"a":["b"]})"},
      {R"({"a":{"b":"c"}})", R"({"a":{"b":"d","c":null}})", R"({"a":{"b":"d"}})"},
      {R"({"a":[{"b":"c"}]})", R"({"a":[1]})", R"({"a":[1]})"},
      {R"({"e":null})", R"({"a":1})", R"({"e":null,"a":1})"},
      {R"({})", R"({"a":{"bb":{"ccc":null}}})", R"({"a":{"bb":{}}})"},
      {R"({"a":"foo"})", R"({"a":{"b":null,"c":1}})", R"({"a":{"c":1}})"}};
  for (const auto& [target, patch, result] : cases) {
    INFO(target << " with " << patch);
    CHECK(merged(target, patch) == result);
  }
}

TEST_CASE("what a patch does not name keeps its bytes") {
  const std::string target =
      " { \"x\" : 1.50 , \"deep\":{\"y\":1e3,\"z\":[ 1,2 ]}, \"\\u0061b\": \"},]\\\"\" } ";
  CHECK(merged(target, R"({"n":1})") ==
        "{\"x\":1.50,\"deep\":{\"y\":1e3,\"z\":[ 1,2 ]},\"ab\":\"},]\\\"\",\"n\":1}");
  CHECK(merged(target, R"({"deep":{"y":null},"ab":2})") ==
        R"({"x":1.50,"deep":{"z":[ 1,2 ]},"ab":2})");
  CHECK(merged(R"({"a":1,"b":2,"a":3})", R"({"a":4})") == R"({"a":4,"b":2})");
}

TEST_CASE("a patch is an object, and so is what it changes") {
  for (const char* wrong : {"", "[]", "1", "null", "{", "{\"a\":}", "\"{\""}) {
    INFO(wrong);
    CHECK_FALSE(merge_patch("{}", wrong));
    CHECK_FALSE(merge_patch(wrong, "{}"));
  }
}

std::string nested(std::string_view open, std::string_view close, int levels) {
  std::string text = "{\"a\":";
  for (int i = 0; i < levels; ++i) text += open;
  text += '1';
  for (int i = 0; i < levels; ++i) text += close;
  return text + "}";
}

TEST_CASE("a patch that is nested too deep is refused") {
  for (const auto& [open, close] : {std::pair{"{\"b\":", "}"}, std::pair{"[", "]"}}) {
    CHECK(merge_patch("{}", nested(open, close, 60)));
    for (const int levels : {70, 200'000}) {
      const auto refused = merge_patch("{}", nested(open, close, levels));
      REQUIRE_FALSE(refused);
      CHECK(refused.error().code == ErrorCode::limit_exceeded);
    }
  }
}

/// A random value; objects and arrays only while `depth` lasts.
Json random_value(test::Random& random, int depth) {
  switch (random.below(depth > 0 ? 6 : 4)) {
    case 0:
      return nullptr;
    case 1:
      return static_cast<int>(random.below(100));
    case 2:
      return "a\"}{\\ " + std::to_string(random.below(10));
    case 3:
      return random.below(2) == 0;
    case 4: {
      Json list = Json::array();
      for (std::size_t i = random.below(3); i > 0; --i)
        list.push_back(random_value(random, depth - 1));
      return list;
    }
    default: {
      Json object = Json::object();
      for (std::size_t i = random.below(4); i > 0; --i) {
        object[std::string(1, static_cast<char>('a' + random.below(4)))] =
            random_value(random, depth - 1);
      }
      return object;
    }
  }
}

TEST_CASE("a patched text says what the library makes of the values") {
  test::Random random(7396);
  int objects = 0;
  while (objects < 2000) {
    Json target = random_value(random, 4);
    const Json patch = random_value(random, 4);
    if (!target.is_object() || !patch.is_object()) continue;
    ++objects;
    const std::string text = merged(target.dump(random.below(2) == 0 ? -1 : 2), patch.dump());
    target.merge_patch(patch);
    CHECK(Json::parse(text) == target);
  }
}

TEST_CASE("attributes of one object of a feature are changed") {
  const std::string feature =
      R"({"type":"CityJSONFeature","id":"a","CityObjects":{"a":{"type":"Building","attributes":{"n":1.0}},)"
      R"("b":{"type":"BuildingPart","parents":["a"]}},"vertices":[]})";
  CHECK(
      *patch_attributes(feature, "a", R"({"m":2})") ==
      R"({"type":"CityJSONFeature","id":"a","CityObjects":{"a":{"type":"Building","attributes":{"n":1.0,"m":2}},)"
      R"("b":{"type":"BuildingPart","parents":["a"]}},"vertices":[]})");
  const auto added = patch_attributes(feature, "b", R"({"m":2,"none":null})");
  REQUIRE(added);
  CHECK(Json::parse(*added)["CityObjects"]["b"]["attributes"] == Json{{"m", 2}});
  CHECK(patch_attributes(feature, "c", "{}").error().code == ErrorCode::not_found);
  CHECK_FALSE(patch_attributes("solid", "a", "{}"));
  CHECK_FALSE(patch_attributes(feature, "a", "[]"));
}

}  // namespace
}  // namespace watertight::test_patch_attributes
