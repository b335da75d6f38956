// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <catch2/catch_test_macros.hpp>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>

#include "geometry/lattice/lattice.h"
#include "tests/unit/geometry/solids.h"

namespace watertight::test {
namespace {

GridNumber decimal(std::string_view text) {
  const auto number = geometry::parse_decimal(text);
  INFO(text);
  REQUIRE(number.has_value());
  return *number;
}

ErrorCode refusal(std::string_view text) {
  const auto number = geometry::parse_decimal(text);
  INFO(text);
  REQUIRE_FALSE(number.has_value());
  return number.error().code;
}

double read_back(const std::string& text) {
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  REQUIRE(code == std::errc{});
  REQUIRE(end == text.data() + text.size());
  return value;
}

using Integers = std::vector<std::array<std::int64_t, 3>>;
using Doubles = std::vector<std::array<double, 3>>;

geometry::Transform transform_of(std::string_view scale,
                                 std::array<std::string_view, 3> translate) {
  geometry::Transform transform;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    transform.scale[axis] = decimal(scale);
    transform.translate[axis] = decimal(translate[axis]);
  }
  return transform;
}

}  // namespace

TEST_CASE("decimals are parsed exactly and normalized") {
  CHECK(decimal("0") == GridNumber{0, 0});
  CHECK(decimal("-0.000e-900") == GridNumber{0, 0});
  CHECK(decimal("84616.468") == GridNumber{84616468, -3});
  CHECK(decimal("-12.50e3") == GridNumber{-125, 2});
  CHECK(decimal("+.5") == GridNumber{5, -1});
  CHECK(decimal("7.") == GridNumber{7, 0});
  CHECK(decimal("1E+2") == GridNumber{1, 2});
  CHECK(decimal("123456789012345678") == GridNumber{123456789012345678, 0});
  CHECK(decimal("0.1234567890123456780000000000000") == GridNumber{123456789012345678, -18});
  CHECK(decimal("1000000000000000000000000000000") == GridNumber{1, 30});
  CHECK(decimal("0.000000000000000000000000000000000001") == GridNumber{1, -36});
}

TEST_CASE("text that is no decimal, too long or out of range is refused") {
  for (const char* text : {"", "-", ".", "e5", "1e", "1e+", "nan", "inf", "0x10", "1..2", "1 ",
                           " 1", "1,5", "--1", "1e5.0", "1-"}) {
    CHECK(refusal(text) == ErrorCode::malformed);
  }
  CHECK(refusal("1234567890123456789") == ErrorCode::limit_exceeded);
  CHECK(refusal("1.000000000000000000000001") == ErrorCode::limit_exceeded);
  CHECK(refusal("1e999") == ErrorCode::limit_exceeded);
  CHECK(refusal("1e-999999999999999999999999") == ErrorCode::limit_exceeded);
}

TEST_CASE("shortest decimals read back as the double they came from") {
  CHECK(geometry::shortest_decimal(0.0) == GridNumber{0, 0});
  CHECK(geometry::shortest_decimal(-0.0) == GridNumber{0, 0});
  CHECK(geometry::shortest_decimal(0.1) == GridNumber{1, -1});
  CHECK(geometry::shortest_decimal(1e22) == GridNumber{1, 22});
  CHECK(geometry::shortest_decimal(std::numeric_limits<double>::max()) ==
        GridNumber{17976931348623157, 292});
  CHECK(geometry::shortest_decimal(std::numeric_limits<double>::denorm_min()) ==
        GridNumber{5, -324});
}

TEST_CASE("CityJSON integers and the doubles of the same decimals are the same lattice points") {
  const Integers integers{{0, 0, 0}, {12345, 6789, 3001}, {-17, 40, 12}, {5, 5, 5}};
  const geometry::Transform transform =
      transform_of("0.001", {"84616.468", "447422.999", "-0.293"});
  const auto from_integers = geometry::lattice_of_integers(integers, transform);
  REQUIRE(from_integers.has_value());
  const Doubles doubles{{84616.468, 447422.999, -0.293},
                        {84628.813, 447429.788, 2.708},
                        {84616.451, 447423.039, -0.281},
                        {84616.473, 447423.004, -0.288}};
  const auto from_doubles = geometry::lattice_of_doubles(doubles);
  REQUIRE(from_doubles.has_value());
  CHECK(from_integers->lattice == from_doubles->lattice);
  CHECK(from_integers->points == from_doubles->points);
  CHECK(from_integers->lattice.step[0] == GridNumber{1, -3});
  CHECK(from_integers->lattice.origin[0] == GridNumber{84616451, -3});
  CHECK(from_integers->points[1] == Point{12362, 6789, 3001});
  CHECK(from_integers->rounded.empty());
  const auto back =
      geometry::integers_under(from_doubles->lattice, from_doubles->points, transform);
  REQUIRE(back.has_value());
  CHECK(*back == integers);
}

TEST_CASE("random transforms and integers give the lattice of their doubles and return") {
  Random random(7);
  for (int round = 0; round < 300; ++round) {
    const auto places = static_cast<std::int32_t>(random.between(0, 4));
    geometry::Transform transform;
    Integers integers(5);
    Doubles doubles(5);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      transform.scale[axis] = {1, -places};
      transform.translate[axis] = decimal(std::to_string(random.between(-900000, 900000)) + "." +
                                          std::to_string(random.between(0, 999)));
      Lattice grid;
      grid.step[axis] = transform.scale[axis];
      grid.origin[axis] = transform.translate[axis];
      for (std::size_t i = 0; i < integers.size(); ++i) {
        integers[i][axis] = random.between(-100000, 100000);
        doubles[i][axis] = read_back(
            grid.world_text(static_cast<double>(integers[i][axis]), static_cast<int>(axis)));
      }
    }
    const auto left = geometry::lattice_of_integers(integers, transform);
    const auto right = geometry::lattice_of_doubles(doubles);
    REQUIRE(left.has_value());
    REQUIRE(right.has_value());
    REQUIRE(left->lattice == right->lattice);
    REQUIRE(left->points == right->points);
    const auto back = geometry::integers_under(left->lattice, left->points, transform);
    REQUIRE(back.has_value());
    REQUIRE(*back == integers);
    for (std::size_t i = 0; i < doubles.size(); ++i) {
      REQUIRE(left->lattice.world(left->points[i]) == doubles[i]);
    }
  }
}

TEST_CASE("the step is the largest common power of ten of the distances from the origin") {
  const auto points = geometry::lattice_of_doubles(Doubles{{100.5, 7, 0}, {1100.5, 7, 20}});
  REQUIRE(points.has_value());
  CHECK(points->lattice.step == std::array{GridNumber{1, 1}, GridNumber{1, 1}, GridNumber{1, 1}});
  CHECK(points->points[1] == Point{100, 0, 2});
  CHECK(points->lattice.world(points->points[1]) == std::array<double, 3>{1100.5, 7, 20});
}

TEST_CASE("no points and equal points have step one") {
  const auto none = geometry::lattice_of_doubles(Doubles{});
  REQUIRE(none.has_value());
  CHECK(none->lattice == Lattice{});
  const auto one = geometry::lattice_of_doubles(Doubles{{0.25, -3, 1e30}, {0.25, -3, 1e30}});
  REQUIRE(one.has_value());
  CHECK(one->lattice.step == Lattice{}.step);
  CHECK(one->lattice.world(one->points[1]) == std::array<double, 3>{0.25, -3, 1e30});
}

TEST_CASE("source digits return as text") {
  const std::vector<std::array<std::string, 3>> texts{{"84616.468", "-0.001", "12"},
                                                      {"84617.5", "447422.12", "-7.25"},
                                                      {"0", "1000000", "0.000001"}};
  std::vector<std::array<GridNumber, 3>> numbers;
  for (const auto& text : texts) {
    numbers.push_back({decimal(text[0]), decimal(text[1]), decimal(text[2])});
  }
  const auto points = geometry::lattice_of_decimals(numbers);
  REQUIRE(points.has_value());
  CHECK(points->rounded.empty());
  for (std::size_t i = 0; i < texts.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      CHECK(points->lattice.world_text(points->points[i][axis], axis) ==
            texts[i][static_cast<std::size_t>(axis)]);
    }
  }
}

TEST_CASE("a scale that is no power of ten is the step where that keeps coordinates compact") {
  // Coordinates in feet, given in metres: in steps of 1e-7 they would exceed 2^30, in steps of
  // 3.048e-4 not.
  const Integers integers{{0, 0, 0}, {1'000'001, 999'999, 31'234}};
  const geometry::Transform transform = transform_of("3.048e-4", {"0", "0", "0"});
  const auto points = geometry::lattice_of_integers(integers, transform);
  REQUIRE(points.has_value());
  CHECK(points->lattice.kind == LatticeKind::decimal);
  CHECK(points->lattice.step[0] == transform.scale[0]);
  CHECK(points->points[1] == Point{1'000'001, 999'999, 31'234});
  CHECK(points->lattice.world_text(1'000'001, 0) == "304.8003048");
  const auto back = geometry::integers_under(points->lattice, points->points, transform);
  REQUIRE(back.has_value());
  CHECK(*back == integers);
  // Small coordinates stay compact with a power of ten, which is then the step, as for doubles.
  const auto close = geometry::lattice_of_integers(Integers{{0, 0, 0}, {7, 9, 11}}, transform);
  REQUIRE(close.has_value());
  CHECK(close->lattice.step[0] == GridNumber{1, -7});
  CHECK(close->points[1] == Point{21336, 27432, 33528});
}

TEST_CASE("degrees beside metres keep their precision and compact coordinates") {
  const Doubles doubles{{4.35712345, 52.01161234, -0.25}, {4.35812346, 52.01261235, 110.123}};
  const auto points = geometry::lattice_of_doubles(doubles);
  REQUIRE(points.has_value());
  CHECK(points->lattice.kind == LatticeKind::decimal);
  CHECK(points->lattice.step ==
        std::array{GridNumber{1, -8}, GridNumber{1, -8}, GridNumber{1, -3}});
  CHECK(points->points[1] == Point{100001, 100001, 110373});
  CHECK(points->lattice.world(points->points[1]) == doubles[1]);
}

TEST_CASE("integers whose transform leaves the doubles are refused") {
  const geometry::Transform transform = transform_of("1e300", {"0", "0", "0"});
  CHECK(geometry::lattice_of_integers(Integers{{0, 0, 0}, {100'000'000, 1, 1}}, transform));
  const auto beyond =
      geometry::lattice_of_integers(Integers{{0, 0, 0}, {1, 1'000'000'000, 1}}, transform);
  REQUIRE_FALSE(beyond);
  CHECK(beyond.error().code == ErrorCode::limit_exceeded);
}

TEST_CASE("seventeen-digit scales keep the integers, and an origin that is too long is rounded") {
  const geometry::Transform transform =
      transform_of("0.00012345678901234567", {"84616.468", "447422.999", "-0.293"});
  const Integers from_zero{{0, 0, 0}, {1'000'003, 999'999, 31'234}, {7, 9, 11}};
  const auto exact = geometry::lattice_of_integers(from_zero, transform);
  REQUIRE(exact.has_value());
  CHECK(exact->lattice.kind == LatticeKind::decimal);
  CHECK(exact->rounded.empty());
  CHECK(exact->points[1] == Point{1'000'003, 999'999, 31'234});
  CHECK(exact->lattice.world_text(1'000'003, 0) == "84739.92515938271270703701");
  const auto back = geometry::integers_under(exact->lattice, exact->points, transform);
  REQUIRE(back.has_value());
  CHECK(*back == from_zero);

  const Integers shifted{{-1'234'567, 0, 0}, {1'000'003, 999'999, 31'234}};
  const auto moved = geometry::lattice_of_integers(shifted, transform);
  REQUIRE(moved.has_value());
  CHECK_FALSE(exact->is_origin_rounded);
  CHECK(moved->is_origin_rounded);
  CHECK(moved->rounded.empty());
  CHECK(moved->lattice.step[0] == transform.scale[0]);
  CHECK(moved->points[1] == Point{2'234'570, 999'999, 31'234});
  // 84616.468 - 1234567 * 0.00012345678901234567 = 84464.05232235939544322511
  CHECK(moved->lattice.origin[0] == GridNumber{844640523223593954, -13});
  CHECK(moved->lattice.origin[1] == GridNumber{447422999, -3});
  const auto integers = geometry::integers_under(moved->lattice, moved->points, transform);
  REQUIRE(integers.has_value());
  CHECK(*integers == shifted);
  // A point between those of the grid has no integers under the transform.
  const std::vector<Point> between{{0.5, 0, 0}};
  CHECK_FALSE(geometry::integers_under(moved->lattice, between, transform));
  Lattice beside = moved->lattice;
  beside.origin[0].mantissa += 1;
  CHECK_FALSE(geometry::integers_under(beside, moved->points, transform));
}

TEST_CASE("a rounded origin gives the integers back wherever it lies, or the points are rounded") {
  Random random(20);
  int moved = 0;
  int rounded = 0;
  for (int i = 0; i < 2000; ++i) {
    geometry::Transform transform;
    Integers integers(4);
    const std::int64_t reach = std::int64_t{1} << random.between(8, 62);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      transform.scale[axis] = {random.between(1, 999'999'999'999'999'999),
                               static_cast<std::int32_t>(random.between(-22, -10))};
      transform.translate[axis] = {random.between(-999'999'999'999, 999'999'999'999),
                                   static_cast<std::int32_t>(random.between(-9, -3))};
      const std::int64_t first = random.between(-reach, reach);
      for (auto& vertex : integers) vertex[axis] = first + random.between(0, 100'000);
    }
    const auto points = geometry::lattice_of_integers(integers, transform);
    REQUIRE(points);
    if (!points->rounded.empty()) {
      CHECK_FALSE(points->is_origin_rounded);
      ++rounded;
      continue;
    }
    moved += points->is_origin_rounded ? 1 : 0;
    const auto back = geometry::integers_under(points->lattice, points->points, transform);
    REQUIRE(back);
    CHECK(*back == integers);
  }
  CHECK(moved > 500);
  CHECK(rounded > 100);
}

TEST_CASE("transforms that make no sense are refused") {
  const Integers integers{{0, 0, 0}, {1, 1, 1}};
  geometry::Transform transform;
  transform.scale[1] = {0, 0};
  REQUIRE_FALSE(geometry::lattice_of_integers(integers, transform).has_value());
  CHECK(geometry::lattice_of_integers(integers, transform).error().code == ErrorCode::malformed);
  transform.scale[1] = {-1, -3};
  CHECK_FALSE(geometry::lattice_of_integers(integers, transform).has_value());
  transform.scale[1] = {1, 2'000'000'000};
  CHECK_FALSE(geometry::lattice_of_integers(integers, transform).has_value());
  const Integers wide{{-std::numeric_limits<std::int64_t>::max(), 0, 0},
                      {std::numeric_limits<std::int64_t>::max(), 1, 0},
                      {1, 3, 4}};
  const auto result = geometry::lattice_of_integers(wide, geometry::Transform{});
  REQUIRE_FALSE(result.has_value());
  CHECK(result.error().code == ErrorCode::limit_exceeded);
}

TEST_CASE(
    "doubles without a common decimal grid fall back to a binary one and then to themselves") {
  const double third = 1.0 / 3.0;
  const Doubles noisy{{third, 100.0 + third, 0.1}, {1000 * third, 1.5, 7}, {0, 0, 0}};
  const auto binary = geometry::lattice_of_doubles(noisy);
  REQUIRE(binary.has_value());
  CHECK(binary->rounded.empty());
  for (std::size_t i = 0; i < noisy.size(); ++i) {
    CHECK(binary->lattice.world(binary->points[i]) == noisy[i]);
  }
  const Doubles dyadic{
      {std::ldexp(1.0, -60), 0, 0}, {std::ldexp(7.0, -55), std::ldexp(3.0, -50), 0}, {0, 0, 0}};
  const auto powers = geometry::lattice_of_doubles(dyadic);
  REQUIRE(powers.has_value());
  CHECK(powers->lattice.kind == LatticeKind::binary);
  CHECK(powers->lattice.world(powers->points[1]) == dyadic[1]);

  const Doubles spread{{1e-300, 1e300, third}, {-1e300, 7, 0.1}};
  const auto plain = geometry::lattice_of_doubles(spread);
  REQUIRE(plain.has_value());
  CHECK(plain->lattice.kind == LatticeKind::float64);
  CHECK(plain->points[0] == Point{1e-300, 1e300, third});
  CHECK(plain->lattice.world_text(third, 2) == "0.3333333333333333");

  const double infinity = std::numeric_limits<double>::infinity();
  CHECK_FALSE(geometry::lattice_of_doubles(Doubles{{0, infinity, 0}}).has_value());
  CHECK_FALSE(geometry::lattice_of_doubles(Doubles{{0, 0, std::nan("")}}).has_value());
}

TEST_CASE("decimals that fit no grid are rounded and listed") {
  const std::vector<std::array<GridNumber, 3>> numbers{
      {decimal("123456789.123456789"), decimal("0"), decimal("0")},
      {decimal("0.5"), decimal("1"), decimal("2")},
      {decimal("0.25"), decimal("1"), decimal("2")}};
  const auto points = geometry::lattice_of_decimals(numbers);
  REQUIRE(points.has_value());
  CHECK(points->rounded == std::vector<Index>{0});
  CHECK(points->lattice.world(points->points[0])[0] == 123456789.123456789);
  const std::vector<std::array<GridNumber, 3>> huge{
      {GridNumber{999, 307}, GridNumber{1, -300}, GridNumber{}}, {GridNumber{1, 0}}, {}};
  CHECK_FALSE(geometry::lattice_of_decimals(huge).has_value());
}

TEST_CASE("world coordinates are correctly rounded") {
  Random random(3);
  for (int round = 0; round < 3000; ++round) {
    Lattice lattice;
    lattice.step[0] = {1, static_cast<std::int32_t>(random.between(-25, 5))};
    lattice.origin[0] = {random.between(-999'999'999'999'999'999, 999'999'999'999'999'999),
                         static_cast<std::int32_t>(random.between(-30, 10))};
    const auto coordinate = static_cast<double>(random.below(std::uint64_t{1} << 53U));
    const std::string text = lattice.world_text(coordinate, 0);
    INFO(text);
    REQUIRE(lattice.world(coordinate, 0) == read_back(text));
  }
}

TEST_CASE("world coordinates of points between the grid are correctly rounded") {
  Lattice lattice;
  lattice.step[0] = {1, -3};
  lattice.origin[0] = {84616468, -3};
  CHECK(lattice.world(0.5, 0) == 84616.4685);
  CHECK(lattice.world(0.25, 0) == 84616.46825);
  CHECK(lattice.world_text(0.25, 0) == "84616.46825");
  CHECK(lattice.scale(0) == 0.001);
  lattice.kind = LatticeKind::binary;
  CHECK(lattice.world(0.5, 0) == 84616468.0 / 8 + 0.5 / 8);
}

TEST_CASE("integers under a transform refuse points off its grid") {
  Lattice lattice;
  lattice.step[0] = lattice.step[1] = lattice.step[2] = {1, -3};
  geometry::Transform transform;
  transform.scale = {GridNumber{1, -2}, GridNumber{1, -2}, GridNumber{1, -2}};
  const std::vector<Point> on{{10, 20, 30}};
  const std::vector<Point> off{{10, 20, 31}};
  const auto integers = geometry::integers_under(lattice, on, transform);
  REQUIRE(integers.has_value());
  CHECK((*integers)[0] == std::array<std::int64_t, 3>{1, 2, 3});
  CHECK_FALSE(geometry::integers_under(lattice, off, transform).has_value());
  transform.scale[0] = {};
  CHECK_FALSE(geometry::integers_under(lattice, on, transform).has_value());
}

}  // namespace watertight::test
