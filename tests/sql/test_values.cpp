// SPDX-License-Identifier: GPL-3.0-or-later
//
// Values of the type `solid`: what stands in them, and what is refused.
#include <catch2/catch_test_macros.hpp>
#include <cstdlib>
#include <cstring>
#include <random>
#include <string>

#include "codec/encode_boundary.h"
#include "formats/ewkb.h"
#include "sql/bridge.h"
#include "sql/solid_value.h"

namespace watertight {
namespace {

using Function = void (*)(const wt_job*, wt_reply*) noexcept;

struct Answer {
  std::string state;
  bool is_invalid = false;
  Bytes bytes;
};

Answer ask(Function function, ByteView bytes) {
  wt_reply reply{};
  const wt_job job{bytes.data(), bytes.size(), nullptr, nullptr, 0, 64, nullptr, 0};
  function(&job, &reply);
  Answer answer{reply.failure.sqlstate, reply.failure.is_invalid,
                Bytes(reply.bytes, reply.bytes + reply.size)};
  wt_reply_clear(&reply);
  return answer;
}

/// A box of `size` metres at a place, with three decimals; `is_inward` turns its facets over.
std::string box_wkt(double x, double y, double z, double size, bool is_inward = false) {
  const auto corner = [&](int i) {
    const double place[3] = {x + (i & 1) * size, y + (i >> 1 & 1) * size, z + (i >> 2) * size};
    std::string text;
    for (const double number : place) {
      text.append(text.empty() ? "" : " ").append(std::to_string(number));
    }
    return text;
  };
  std::string wkt = "POLYHEDRALSURFACE Z (";
  for (const auto& facet :
       {std::array{0, 2, 3, 1}, std::array{4, 5, 7, 6}, std::array{0, 1, 5, 4},
        std::array{2, 6, 7, 3}, std::array{0, 4, 6, 2}, std::array{1, 3, 7, 5}}) {
    wkt.append(wkt.back() == '(' ? "((" : ",((");
    for (int i = 0; i < 5; ++i) {
      const auto at = static_cast<std::size_t>(is_inward ? (8 - i) % 4 : i % 4);
      wkt.append(i == 0 ? "" : ",").append(corner(facet[at]));
    }
    wkt.append("))");
  }
  return wkt.append(")");
}

Bytes value_of(const std::string& wkt) {
  const Answer answer = ask(wt_bridge_solid_of_wkt, as_bytes(wkt));
  INFO(wkt);
  REQUIRE(answer.state.empty());
  return answer.bytes;
}

ByteView blob_in(const Bytes& value) { return ByteView(value).subspan(WATERTIGHT_SOLID_BLOB); }

template <class Number>
Number number_at(const Bytes& value, std::size_t offset) {
  Number number{};
  std::memcpy(&number, value.data() + offset, sizeof number);
  return number;
}

/// The blob of a boundary that nobody judged.
Bytes unjudged_blob(const std::string& wkt) {
  const auto submitted = formats::read_wkt(wkt);
  REQUIRE(submitted);
  const auto boundary = OrientedBoundary::make(submitted->solid);
  REQUIRE(boundary);
  return *codec::encode_boundary(*boundary, Acceptance{});
}

int order_of(const Bytes& left, const Bytes& right) {
  wt_reply reply{};
  const ByteView blob = blob_in(left);
  const ByteView other = blob_in(right);
  const wt_job job{blob.data(), blob.size(), nullptr, nullptr, 0, 0, nullptr, 0};
  const int order = wt_bridge_compare(&job, other.data(), other.size(), &reply);
  CHECK(reply.failure.sqlstate[0] == '\0');
  wt_reply_clear(&reply);
  return order;
}

}  // namespace

TEST_CASE("a value has its facts at their places, and its box is rounded outward") {
  const Bytes value = value_of("SRID=7415;" + box_wkt(84616.123, 447001.377, -0.7, 3.001));
  CHECK(value[0] == WATERTIGHT_SOLID_LAYOUT);
  CHECK(number_at<std::uint32_t>(value, WATERTIGHT_SOLID_SRID) == 7415);
  CHECK(number_at<double>(value, WATERTIGHT_SOLID_VOLUME) == 27.027009001);
  CHECK(std::abs(number_at<double>(value, WATERTIGHT_SOLID_AREA) - 6 * 3.001 * 3.001) < 1e-12);
  const double exact[6] = {84616.123, 447001.377, -0.7, 84619.124, 447004.378, 2.301};
  for (std::size_t i = 0; i < 6; ++i) {
    const double bound = number_at<float>(value, WATERTIGHT_SOLID_BOX + 4 * i);
    INFO(i);
    CHECK((i < 3 ? bound <= exact[i] : bound >= exact[i]));
    CHECK(std::abs(bound - exact[i]) < 0.05);
  }
}

TEST_CASE("a value is made again from its blob") {
  const Bytes value = value_of(box_wkt(1, 2, 3, 4.5));
  const Answer again = ask(wt_bridge_solid, blob_in(value));
  REQUIRE(again.state.empty());
  CHECK(again.bytes == value);
}

TEST_CASE("a blob whose solid is not valid is refused, though it decodes") {
  const Bytes inward = unjudged_blob(box_wkt(0, 0, 0, 1, true));
  REQUIRE(decode(inward));
  CHECK(ask(wt_bridge_solid, inward).state == "22023");
  // Two boxes that cross, as one shell.
  std::string crossing = box_wkt(0, 0, 0, 2);
  crossing.pop_back();
  crossing += "," + box_wkt(1, 1, 1, 2).substr(std::strlen("POLYHEDRALSURFACE Z ("));
  const Bytes blob = unjudged_blob(crossing);
  REQUIRE(decode(blob));
  const Answer refused = ask(wt_bridge_solid, blob);
  CHECK(refused.state == "22023");
  CHECK(refused.is_invalid);
}

TEST_CASE("a blob that states rules of no version is refused") {
  const auto submitted = formats::read_wkt(box_wkt(0, 0, 0, 1));
  const auto boundary = OrientedBoundary::make(submitted->solid);
  Acceptance later;
  later.rule_set = 999;
  Acceptance loose;
  loose.tolerances.planarity_metres = 1e300;
  CHECK(ask(wt_bridge_solid, *codec::encode_boundary(*boundary, later)).state == "0A000");
  CHECK(ask(wt_bridge_solid, *codec::encode_boundary(*boundary, loose)).state == "22023");
}

TEST_CASE("solids have one order, whatever the order of their parts") {
  const std::string one = box_wkt(0, 0, 0, 1);
  std::string turned = one;  // the first facet last
  const std::size_t start = turned.find("(((") + 1;
  const std::size_t end = turned.find("))") + 3;
  const std::string facet = turned.substr(start, end - 1 - start);
  turned =
      "POLYHEDRALSURFACE Z (" + turned.substr(end, turned.size() - end - 1) + "," + facet + ")";
  const std::vector<Bytes> values{value_of(one), value_of(turned), value_of(box_wkt(0, 0, 0, 2)),
                                  value_of(box_wkt(0, 0, 0.5, 1)), value_of("SRID=7415;" + one)};
  CHECK(blob_in(values[0]).size() > 0);
  CHECK(order_of(values[0], values[1]) == 0);
  CHECK(number_at<std::uint64_t>(values[0], WATERTIGHT_SOLID_HASH) ==
        number_at<std::uint64_t>(values[1], WATERTIGHT_SOLID_HASH));
  for (std::size_t i = 1; i < values.size(); ++i) {
    for (std::size_t j = 1; j < values.size(); ++j) {
      CHECK(order_of(values[i], values[j]) == -order_of(values[j], values[i]));
      CHECK((order_of(values[i], values[j]) == 0) == (i == j));
    }
  }
}

TEST_CASE("bytes from anywhere are a value or a failure") {
  std::mt19937_64 random(1);
  const Bytes value = value_of(box_wkt(5, 6, 7, 2.25));
  const Bytes blob(blob_in(value).begin(), blob_in(value).end());
  const Bytes ewkb = formats::write_ewkb(formats::read_wkt(box_wkt(5, 6, 7, 2.25))->solid);
  const char* asked = std::getenv("WATERTIGHT_HOSTILE_VALUES");
  const long rounds = asked != nullptr ? std::atol(asked) : 4000;
  for (long i = 0; i < rounds; ++i) {
    Bytes bytes = i % 2 == 0 ? blob : ewkb;
    const std::size_t changes = 1 + random() % 3;
    for (std::size_t k = 0; k < changes; ++k) {
      bytes[random() % bytes.size()] ^= static_cast<std::uint8_t>(1U << random() % 8);
    }
    if (random() % 4 == 0) bytes.resize(random() % (bytes.size() + 1));
    if (i % 16 == 0) {  // bytes that never were a solid
      bytes.resize(random() % 200);
      for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    }
    const Answer answer = ask(wt_bridge_solid, bytes);
    CHECK((answer.state.empty() ? answer.bytes.size() > WATERTIGHT_SOLID_BLOB
                                : answer.bytes.empty()));
  }
}

TEST_CASE("the facets of a solid add up to its area, and their normals point outward") {
  const Bytes value = value_of(box_wkt(10, 20, 30, 4));
  const Answer answer = ask(wt_bridge_faces, blob_in(value));
  REQUIRE(answer.state.empty());
  REQUIRE(answer.bytes.size() == 6 * sizeof(wt_face));
  double area = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    const auto face = number_at<wt_face>(answer.bytes, i * sizeof(wt_face));
    area += face.area;
    const double middle[3] = {12, 22, 32};
    double outward = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      outward += face.normal[axis] * (face.centroid[axis] - middle[axis]);
    }
    CHECK(outward == 2);
    CHECK(face.planarity == 0);
    CHECK(face.tilt == (i == 0 ? 180 : i == 1 ? 0 : 90));
  }
  CHECK(area == 96);
}

}  // namespace watertight
