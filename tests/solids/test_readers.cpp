// SPDX-License-Identifier: GPL-3.0-or-later
//
// Documents that other validators misread or that make them crash: each test states the reader's
// error, or the verdict of reader and validator together.
#include <catch2/catch_test_macros.hpp>
#include <string>

#include "formats/document.h"
#include "tests/solids/shape.h"
#include "validate/certify.h"

using namespace watertight;

namespace {

const std::string kVertices =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n";
const std::string kFacets = "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t place = text.find(from);
  REQUIRE(place != std::string::npos);
  return text.replace(place, from.size(), to);
}

bool is_refused(const std::string& text, Format format) {
  const auto document = formats::read_document(as_bytes(text), format);
  if (document) return false;
  CHECK_FALSE(document.error().message.empty());
  return true;
}

/// The codes of the errors of the first solid; {-1} if the document is refused or holds no solid;
/// {901} if a part of the first feature cannot be read.
std::set<int> codes_of(const std::string& text, Format format) {
  const auto document = formats::read_document(as_bytes(text), format);
  if (!document || document->features.empty()) return {-1};
  if (!document->features[0].unreadable.empty()) return {901};
  if (document->features[0].solids.empty()) return {-1};
  CertifyOptions options;
  options.proof = Proof::boundary;
  return solids::codes_of(certify(document->features[0].solids[0].solid, nullptr, options).report,
                          Severity::error);
}

const std::string kOff =
    "OFF\n8 6 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
    "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n";

std::string city_json(const std::string& geometry) {
  return R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],"translate":[0,0,0]},)"
         R"("CityObjects":{"a":{"type":"Building","geometry":[)" +
         geometry +
         R"(]}},"vertices":[[0,0,0],[1,0,0],[1,1,0],[0,1,0],[0,0,1],[1,0,1],[1,1,1],[0,1,1]]})";
}

const std::string kCube =
    R"({"type":"Solid","lod":"1","boundaries":[[[[0,3,2,1]],[[4,5,6,7]],[[0,1,5,4]],[[1,2,6,5]],)"
    R"([[2,3,7,6]],[[3,0,4,7]]]]})";

}  // namespace

TEST_CASE("OBJ: numbers that are none, short lines and wrong indices are refused, not guessed") {
  CHECK(codes_of(kVertices + kFacets, Format::obj).empty());
  CHECK(is_refused(replaced(kVertices, "v 1 1 1", "v nan 1 1") + kFacets, Format::obj));
  CHECK(is_refused(replaced(kVertices, "v 1 1 1", "v inf 1 1") + kFacets, Format::obj));
  CHECK(is_refused(replaced(kVertices, "v 1 1 1", "v 1 1") + kFacets, Format::obj));
  CHECK(is_refused(kVertices + replaced(kFacets, "f 5 6 7 8", "f 5 6 7 9"), Format::obj));
  CHECK(is_refused(kVertices + replaced(kFacets, "f 5 6 7 8", "f 5 6 7 0"), Format::obj));
}

TEST_CASE("OBJ: negative indices count from the end") {
  const std::string facets =
      "f -8 -5 -6 -7\nf -4 -3 -2 -1\nf -8 -7 -3 -4\nf -7 -6 -2 -3\nf -6 -5 -1 -2\nf -5 -8 -4 -1\n";
  CHECK(codes_of(kVertices + facets, Format::obj).empty());
  CHECK(is_refused(kVertices + replaced(facets, "f -8", "f -9"), Format::obj));
}

TEST_CASE("OFF: comments are passed over, indices are checked, a far unused vertex is harmless") {
  CHECK(codes_of(kOff, Format::off).empty());
  CHECK(codes_of(replaced(kOff, "OFF\n", "OFF # a cube\n# of unit size\n"), Format::off).empty());
  CHECK(codes_of(replaced(kOff, "1 1 1\n", "1 1 1 # the last but one\n"), Format::off).empty());
  CHECK(is_refused(replaced(kOff, "4 4 5 6 7", "4 4 5 6 8"), Format::off));
  CHECK(is_refused(replaced(kOff, "4 4 5 6 7", "4 4 5 6 -1"), Format::off));
  CHECK(is_refused(kOff.substr(0, kOff.size() - 12), Format::off));
  const std::string far =
      replaced(replaced(kOff, "8 6 0", "9 6 0"), "4 0 3 2 1", "-1e16 0 0\n4 0 3 2 1");
  CHECK(codes_of(far, Format::off).empty());
}

TEST_CASE("CityJSON: wrong indices are 901; a missing lod and empty arrays are read") {
  const std::set<int> unreadable{901};
  CHECK(codes_of(city_json(kCube), Format::city_json).empty());
  for (const char* wrong : {"4,5,6,8", "4,5,6,-1", "4,5,6,7.5"}) {
    CHECK(codes_of(city_json(replaced(kCube, "4,5,6,7", wrong)), Format::city_json) == unreadable);
  }
  CHECK(codes_of(city_json(replaced(kCube, R"("lod":"1",)", "")), Format::city_json).empty());
  // A facet without a ring and a ring without a point each leave the shell open.
  CHECK(codes_of(city_json(replaced(kCube, "[[4,5,6,7]]", "[]")), Format::city_json) ==
        std::set<int>{101, 302});
  CHECK(codes_of(city_json(replaced(kCube, "[[4,5,6,7]]", "[[]]")), Format::city_json) ==
        std::set<int>{101, 302});
  CHECK(codes_of(city_json(R"({"type":"Solid","lod":"1","boundaries":[]})"), Format::city_json) ==
        std::set<int>{902});
  CHECK(codes_of(city_json(R"({"type":"Solid","lod":"1","boundaries":[[]]})"), Format::city_json) ==
        std::set<int>{902});
}

TEST_CASE("CityJSON: an instance of a template that is not there is 901") {
  const std::string instance = R"({"type":"GeometryInstance","template":3,"boundaries":[0],)"
                               R"("transformationMatrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]})";
  CHECK(codes_of(city_json(instance), Format::city_json) == std::set<int>{901});
}
