// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "formats/document.h"
#include "samples.h"

namespace watertight::test_city_json_errors {
namespace {

using test::kTwoBuildings;
using test::part_of;
using test::read;

Error error_of(const std::string& text, Format format = Format::city_json) {
  const auto document = read(text, format);
  REQUIRE_FALSE(document);
  CHECK_FALSE(document.error().message.empty());
  return document.error();
}

std::string with_object(const std::string& object) {
  return R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],)"
         R"("translate":[0,0,0]},"CityObjects":{"a":)" +
         object + R"(},"vertices":[[0,0,0],[1,0,0],[0,1,0],[0,0,1]]})";
}

std::string with_boundaries(const std::string& boundaries) {
  return with_object(R"({"type":"Building","geometry":[{"type":"Solid","lod":"1","boundaries":)" +
                     boundaries + "}]}");
}

TEST_CASE("every truncation of a document is an error") {
  for (std::size_t size = 0; size < kTwoBuildings.size(); ++size) {
    CHECK_FALSE(read(kTwoBuildings.substr(0, size), Format::city_json));
    CHECK_FALSE(read(kTwoBuildings.substr(0, size), Format::city_json_seq));
  }
}

TEST_CASE("syntax errors name the byte") {
  CHECK(error_of(R"({"type":"CityJSON",})").byte_offset == 19);
  CHECK(error_of("{\"type\":\"City\xFFJSON\"}").byte_offset == 13);
  CHECK(error_of(kTwoBuildings + "x").byte_offset == kTwoBuildings.size());
  CHECK(error_of("").code == ErrorCode::malformed);
}

TEST_CASE("nothing hides behind a NUL byte") {
  const Error error = error_of(kTwoBuildings + std::string("\0rest", 5));
  CHECK(error.code == ErrorCode::malformed);
  CHECK(error.byte_offset == kTwoBuildings.size());
}

TEST_CASE("a syntax error does not repeat megabytes of input") {
  CHECK(error_of("[1" + std::string(1 << 20, '0') + "]").message.size() < 400);
  CHECK(error_of("{\"\xC3\xA9" + std::string(1 << 20, 'x')).message.size() < 400);
}

TEST_CASE("content errors name the place by JSON Pointer") {
  CHECK(error_of(R"({"version":"2.0"})").pointer == "/type");
  CHECK(error_of(R"({"type":"CityJSON"})").pointer == "/version");
  CHECK(error_of(R"({"type":"CityJSON","version":"3.0"})").code == ErrorCode::unsupported);
  CHECK(error_of(R"({"type":"CityJSON","version":"1.0"})").pointer == "/CityObjects");
  CHECK(error_of(R"({"type":"CityJSON","version":"1.0","CityObjects":{}})").pointer == "/vertices");
  // Faults of one object do not keep the others from being read.
  CHECK(part_of(with_object("1")).pointer == "/CityObjects/a");
  CHECK(part_of(with_object("{}")).pointer == "/CityObjects/a");
  CHECK(part_of(with_object(R"({"type":"Road","geometry":{}})")).pointer ==
        "/CityObjects/a/geometry");
  CHECK(part_of(with_object(R"({"type":"Road","geometry":[{}]})")).pointer ==
        "/CityObjects/a/geometry/0");
  CHECK(part_of(with_object(R"({"type":"Road","geometry":[{"type":"Solid"}]})")).pointer ==
        "/CityObjects/a/geometry/0");
}

TEST_CASE("boundaries that are not nested indices are unreadable parts") {
  const std::string at = "/CityObjects/a/geometry/0/boundaries";
  CHECK(part_of(with_boundaries("[[[[0,1,4]]]]")).pointer == at + "/0/0/0/2");
  CHECK(part_of(with_boundaries("[[[[0,1,-1]]]]")).pointer == at + "/0/0/0/2");
  CHECK(part_of(with_boundaries("[[[[0,1.5]]]]")).pointer == at + "/0/0/0/1");
  CHECK(part_of(with_boundaries("[[[[0,null]]]]")).pointer == at + "/0/0/0/1");
  CHECK(part_of(with_boundaries("[[[0,1,2]]]")).pointer == at + "/0/0/0");
  CHECK(part_of(with_boundaries("[[[[[0,1,2]]]]]")).pointer == at + "/0/0/0/0");
  CHECK(part_of(with_boundaries("[[[[4294967295]]]]")).pointer == at + "/0/0/0/0");
  CHECK(error_of(with_boundaries("0")).pointer == "/CityObjects/a/geometry/0");
  CHECK(error_of(with_boundaries(R"({"solid":0})")).pointer == "/CityObjects/a/geometry/0");
}

TEST_CASE("unreadable parts come back as they came, in whole documents and in features") {
  for (const char* boundaries :
       {"[[[[0,1,4]]]]", "[[[[0,1,-1]]]]", "[[[[0,1.50]]]]", "[[[[0,null]]]]", "[[[0,1,2]]]",
        "[[[[4294967295]]]]", R"("text")", R"([{"solid":0},[],[[7]]])", "1.0"}) {
    const std::string text = with_boundaries(boundaries);
    CAPTURE(text);
    for (const bool is_split : {false, true}) {
      const auto document = read(text, Format::city_json, is_split);
      REQUIRE(document);
      REQUIRE(document->features.size() == 1);
      CHECK(document->features[0].unreadable.size() == 1);
      CHECK(document->features[0].solids.empty());
      const auto again = formats::write_document(*document, Format::city_json);
      REQUIRE(again);
      const std::string kept = std::string("\"boundaries\":") + boundaries + "}";
      CHECK(as_text(*again).find(kept) != std::string_view::npos);
      if (!is_split) CHECK(as_text(*again) == text);
    }
  }
}

TEST_CASE("empty boundaries, facets and rings are left to the validator") {
  for (const char* boundaries : {"[]", "[[]]", "[[[]]]", "[[[[]]]]", "[[[[0]]]]"}) {
    const std::string text = with_boundaries(boundaries);
    const auto document = read(text, Format::city_json, false);
    REQUIRE(document);
    CHECK(document->features[0].solids.size() == 1);
    const auto again = formats::write_document(*document, Format::city_json);
    REQUIRE(again);
    CHECK(as_text(*again) == text);
  }
}

TEST_CASE("an element of vertices that is no vertex is a fault of what uses it") {
  // Vertices 0 to 2 are good; objects a and b use vertices 0, 1, 2 and 3, and "c" the good ones.
  const auto with_vertex = [](const std::string& vertex) {
    const std::string good = R"({"type":"Building","geometry":[{"type":"Solid","lod":"1",)"
                             R"("boundaries":[[[[0,1,2]]]]}]})";
    return R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],)"
           R"("translate":[0,0,0]},"CityObjects":{"a":{"type":"Building","geometry":[)"
           R"({"type":"Solid","lod":"1","boundaries":[[[[0,1,3]]]]}]},"b":{"type":"Road",)"
           R"("geometry":[{"type":"MultiSurface","lod":"1","boundaries":[[[0,3,1]]]}]},"c":)" +
           good + R"(},"vertices":[[0,0,0],[1,0,0],[0,1,0],)" + vertex + "]}";
  };
  const auto place_of = [](const formats::Feature& feature) -> std::string {
    REQUIRE(feature.unreadable.size() == 1);
    const Error& error = feature.unreadable[0].error;
    CHECK(error.pointer.ends_with(feature.id == "a" ? "/boundaries/0/0/0/2" : "/boundaries/0/0/1"));
    CHECK(error.message.starts_with("vertex 3 is none: "));
    const std::size_t at = error.message.find("(at /vertices/3");
    REQUIRE(at != std::string::npos);
    return error.message.substr(at + 15, error.message.size() - at - 16);
  };
  struct Fault {
    std::string vertex, place;
  };
  for (const auto& [vertex, place] : std::vector<Fault>{
           {"[1,2]", "/2"},
           {"[]", "/0"},
           {"[1,2,3,4]", "/3"},
           {"[1,2,3,[4],5]", "/3"},
           {"7", ""},
           {"7.25", ""},
           {"null", ""},
           {"true", ""},
           {R"("text")", ""},
           {"{}", ""},
           {R"({"x":[1,{"y":2}],"z":3})", ""},
           {"[[1]]", "/0"},
           {"[1,[[]],3]", "/1"},
           {R"([1,2,"3"])", "/2"},
           {R"([1,{"y":[2]},3])", "/1"},
           {"[1,2,3.5]", "/2"},
           {"[18446744073709551616,0,0]", "/0"},
           {"[18446744073709551615,0,0]", "/0"},
           {"[0,-9223372036854775809,0]", "/1"},
           {"[0,0,1e300]", "/2"},
       }) {
    CAPTURE(vertex);
    for (const bool is_split : {false, true}) {
      const std::string text = with_vertex(vertex);
      formats::ReadOptions options;
      options.split_features = is_split;
      options.keep_text = !is_split;
      const auto document = formats::read_document(as_bytes(text), Format::city_json, options);
      REQUIRE(document);
      const auto again = formats::write_document(*document, Format::city_json);
      REQUIRE(again);
      CHECK(nlohmann::json::parse(as_text(*again))
                .dump()
                .find(nlohmann::json::parse(vertex).dump()) != std::string::npos);
      if (!is_split) {
        CHECK(as_text(*again) == text);
        CHECK(document->features[0].solids.size() == 1);
        continue;
      }
      REQUIRE(document->features.size() == 3);
      CHECK(place_of(document->features[0]) == place);
      CHECK(place_of(document->features[1]) == place);
      CHECK(document->features[2].unreadable.empty());
      CHECK(document->features[2].solids.size() == 1);
    }
  }
  CHECK(read(with_vertex("[1.0,2e2,-3]"), Format::city_json)->features[0].unreadable.empty());
  CHECK(error_of(with_vertex("[1e400,0,0]")).code == ErrorCode::malformed);
  CHECK(error_of(with_vertex("[1,{\"x\":1,\"x\":2},3]")).pointer == "/vertices/3/1/x");
}

TEST_CASE("a transform needs six numbers and positive scales") {
  const auto with_transform = [](const std::string& transform) {
    return R"({"type":"CityJSON","version":"2.0","transform":)" + transform +
           R"(,"CityObjects":{},"vertices":[]})";
  };
  CHECK(error_of(with_transform(R"({"scale":[1,1,1]})")).pointer == "/transform/translate");
  CHECK(error_of(with_transform(R"({"scale":[1,1],"translate":[0,0,0]})")).pointer ==
        "/transform/scale");
  CHECK(error_of(with_transform(R"({"scale":[1,0,1],"translate":[0,0,0]})")).pointer ==
        "/transform/scale/1");
  CHECK(error_of(with_transform(R"({"scale":[1,1,-1],"translate":[0,0,0]})")).pointer ==
        "/transform/scale/2");
  CHECK(error_of(with_transform(R"({"scale":[1,1,1],"translate":[0,"0",0]})")).pointer ==
        "/transform/translate/1");
}

TEST_CASE("a key that occurs twice is an error") {
  CHECK(error_of(with_object(R"({"type":"Road","type":"Road"})")).pointer == "/CityObjects/a/type");
  CHECK(error_of(with_object(R"({"type":"Road","x":[{"y":{"z":1,"q":2,"z":1}}]})")).pointer ==
        "/CityObjects/a/x/0/y/z");
}

TEST_CASE("nesting and size are limited") {
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += '[';
  CHECK(error_of(deep).code == ErrorCode::limit_exceeded);
  CHECK(error_of(with_boundaries(deep)).code == ErrorCode::limit_exceeded);
  formats::ReadOptions options;
  options.limits.bytes = 10;
  const auto document = formats::read_document(as_bytes(kTwoBuildings), Format::city_json, options);
  REQUIRE_FALSE(document);
  CHECK(document.error().code == ErrorCode::limit_exceeded);
  options.limits = {};
  options.limits.vertices = 3;
  const auto small = formats::read_document(as_bytes(kTwoBuildings), Format::city_json, options);
  REQUIRE_FALSE(small);
  CHECK(small.error().code == ErrorCode::limit_exceeded);
}

TEST_CASE("a city object that is its own ancestor is an unreadable part") {
  const std::string text =
      R"({"type":"CityJSON","version":"1.1","transform":{"scale":[1,1,1],"translate":[0,0,0]},)"
      R"("CityObjects":{"a":{"type":"BuildingPart","parents":["b"]},)"
      R"("b":{"type":"BuildingPart","parents":["a"]}},"vertices":[]})";
  CHECK(part_of(text).pointer == "/CityObjects/a/parents");
}

TEST_CASE("coordinates that had to be rounded are not written on the grid they came from") {
  const auto document = formats::read_document(
      as_bytes(
          R"({"type":"CityJSON","version":"2.0","transform":{"scale":[0.001,0.001,0.001],)"
          R"("translate":[9007199254740993935109.076729,36718248634.330447258,0.0]},"CityObjects":{},"vertices":[]})"
          "\n"
          R"({"type":"CityJSONFeature","id":"a","CityObjects":{"a":{"type":"Building",)"
          R"("geometry":[{"type":"Solid","lod":"1","boundaries":)"
          R"([[[[0,2,1]],[[0,1,3]],[[1,2,3]],[[2,0,3]]]]}]}},)"
          R"("vertices":[[1798,33,506480],[-12579,-268,521778],[-31320,-667,521721],[-31500,6285,512841]]})"
          "\n"),
      Format::city_json_seq);
  REQUIRE(document);
  CHECK_FALSE(document->features[0].solids[0].rounded.empty());
  const auto written = formats::write_document(*document, Format::city_json_seq);
  REQUIRE_FALSE(written);
  CHECK(written.error().code == ErrorCode::unsupported);
}

TEST_CASE("errors in a sequence name line, byte and pointer") {
  const auto document = read(kTwoBuildings, Format::city_json);
  REQUIRE(document);
  const auto bytes = formats::write_document(*document, Format::city_json_seq);
  REQUIRE(bytes);
  const std::string text(as_text(*bytes));
  const std::size_t second = text.find('\n') + 1;

  const Error no_header = error_of(text.substr(second), Format::city_json_seq);
  CHECK(no_header.pointer == "/type");
  CHECK(no_header.message.starts_with("line 1: "));

  std::string broken = text;
  broken[second + 10] = '\x01';
  const Error syntax = error_of(broken, Format::city_json_seq);
  CHECK(syntax.message.starts_with("line 2: "));
  CHECK(syntax.byte_offset == second + 10);

  std::string renamed = text;
  renamed.replace(renamed.find("\"id\":\"a\""), 8, "\"id\":\"z\"");
  const auto unnamed = read(renamed, Format::city_json_seq);
  REQUIRE(unnamed);
  REQUIRE(unnamed->features.size() == 2);
  CHECK(unnamed->features[0].id == "z");
  REQUIRE(unnamed->features[0].unreadable.size() == 1);
  CHECK(unnamed->features[0].unreadable[0].error.pointer == "/id");
  CHECK(unnamed->features[0].solids.size() == document->features[0].solids.size());
  CHECK(unnamed->features[1].unreadable.empty());
  CHECK(error_of("", Format::city_json_seq).code == ErrorCode::malformed);
  CHECK(error_of("\n \n", Format::city_json_seq).code == ErrorCode::malformed);
}

}  // namespace
}  // namespace watertight::test_city_json_errors
