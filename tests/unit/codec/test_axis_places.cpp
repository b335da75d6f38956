// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests the places of coordinates in mode parallelogram: the kind that is suggested, the round
// trip, the gain in size, and damaged data.
#include <algorithm>
#include <array>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <map>
#include <vector>

#include "codec/mode_parallelogram/axis_places.h"
#include "codec/page/modes.h"
#include "codec/page/writer_choice.h"
#include "geometry/canonical_form.h"
#include "tests/generated/generated_solids.h"
#include "tests/unit/codec/integer_modes.h"

namespace watertight {
namespace {

using Kind = codec::parallelogram::AxisPlaces::Kind;

Bytes write(const codec::parallelogram::AxisPlaces& places) {
  codec::ModelBank& models = test::new_models(codec::parallelogram::model_layout());
  codec::EntropyStream stream = codec::EntropyStream::writer();
  REQUIRE(codec::parallelogram::AxisPlaces::code(stream, models, Kind::every, places, {}));
  return std::move(stream).finish();
}

Result<codec::parallelogram::AxisPlaces> read(ByteView bytes, const Limits& limits = {}) {
  codec::ModelBank& models = test::new_models(codec::parallelogram::model_layout());
  codec::EntropyStream stream = codec::EntropyStream::reader(bytes);
  return codec::parallelogram::AxisPlaces::code(stream, models, Kind::every, {}, limits);
}

/// Checks that each value has a place that gives the value back, and that places ascend with
/// values.
void check_values(const codec::parallelogram::AxisPlaces& places,
                  std::vector<std::int64_t> values) {
  std::sort(values.begin(), values.end());
  std::int64_t before = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::int64_t place = places.place_of(values[i]);
    CHECK(places.value_of(place) == values[i]);
    if (i > 0 && values[i] != values[i - 1]) CHECK(place > before);
    before = place;
  }
}

/// Checks that places of this kind are suggested for the values and give them back, also after a
/// round trip. Returns the places that were read back.
codec::parallelogram::AxisPlaces check_suggestion(const std::vector<std::int64_t>& values,
                                                  Kind kind) {
  const codec::parallelogram::AxisPlaces places = codec::parallelogram::AxisPlaces::suggest(values);
  REQUIRE(places.kind() == kind);
  check_values(places, values);
  const auto back = read(write(places));
  REQUIRE(back);
  CHECK(back->kind() == kind);
  check_values(*back, values);
  return *back;
}

std::vector<std::int64_t> steps(double step, double offset, int count) {
  generated::Random random(5);
  std::vector<std::int64_t> values{0};
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<double>(random.below(600)) - 200;
    values.push_back(static_cast<std::int64_t>(std::floor(k * step + offset)));
  }
  return values;
}

codec::IntegerSolid gridded_torus() {
  const geometry::CanonicalSolid canonical = geometry::canonical_form(generated::torus(16, 16));
  const auto gridded = codec::grid_solid(canonical.boundary.solid());
  REQUIRE(gridded);
  return gridded->solid;
}

template <class Change>
codec::IntegerSolid changed(codec::IntegerSolid solid, const Change& change) {
  for (codec::GridPoint& vertex : solid.vertices) {
    for (std::int64_t& coordinate : vertex) coordinate = change(coordinate);
  }
  return solid;
}

/// Writes a solid and reads it back. Returns the bytes.
Bytes round_trip(const codec::IntegerSolid& solid) {
  codec::ModelBank& models = test::new_models(codec::parallelogram::model_layout());
  codec::EntropyStream writer = codec::EntropyStream::writer();
  codec::IntegerSolid source = solid;
  codec::WriterChoice choice;
  REQUIRE(codec::parallelogram::code_solid(writer, models, {}, source, choice, {}));
  const Bytes bytes = std::move(writer).finish();
  codec::ModelBank again(codec::parallelogram::model_layout());
  codec::EntropyStream reader = codec::EntropyStream::reader(bytes);
  codec::IntegerSolid back;
  REQUIRE(codec::parallelogram::code_solid(reader, again, {}, back, choice, {}));
  CHECK(reader.is_finished());
  const auto triangles_of = [](const codec::IntegerSolid& s) {
    std::vector<std::array<codec::GridPoint, 3>> result;
    for (std::size_t i = 0; i < s.ring_vertices.size(); i += 3) {
      std::array<codec::GridPoint, 3> t{s.vertices[s.ring_vertices[i]],
                                        s.vertices[s.ring_vertices[i + 1]],
                                        s.vertices[s.ring_vertices[i + 2]]};
      std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
      result.push_back(t);
    }
    std::sort(result.begin(), result.end());
    return result;
  };
  CHECK(triangles_of(back) == triangles_of(solid));
  return bytes;
}

TEST_CASE("values of even steps are suggested as steps and come back") {
  for (const double step : {8.36, 10.0, 1274.999, 1e9 / 3}) {
    check_suggestion(steps(step, 0.3, 400), Kind::stepped);
  }
}

TEST_CASE("few uneven values are suggested as a list and come back") {
  generated::Random random(9);
  std::vector<std::int64_t> some{0, -5, 3, 90000};
  for (int i = 0; i < 20; ++i)
    some.push_back(static_cast<std::int64_t>(random.below(70000)) - 9000);
  std::vector<std::int64_t> values;
  for (int i = 0; i < 400; ++i) values.push_back(some[random.below(some.size())]);
  const codec::parallelogram::AxisPlaces places = check_suggestion(values, Kind::listed);
  CHECK_FALSE(places.value_of(-1));
  CHECK_FALSE(places.value_of(1000));
}

TEST_CASE("nothing is suggested for values all over their range") {
  generated::Random random(10);
  std::vector<std::int64_t> values;
  for (int i = 0; i < 300; ++i) values.push_back(static_cast<std::int64_t>(random.below(1000000)));
  CHECK(codec::parallelogram::AxisPlaces::suggest(values).kind() == Kind::every);
  CHECK(codec::parallelogram::AxisPlaces::suggest({}).kind() == Kind::every);
  CHECK(codec::parallelogram::AxisPlaces::suggest({0, 0, 0}).kind() == Kind::every);
  CHECK(read(write({}))->kind() == Kind::every);
}

TEST_CASE("a solid on a grid finer than its source takes less than one anywhere on the grid") {
  generated::Random bump(7);
  const codec::IntegerSolid coarse = changed(gridded_torus(), [&](std::int64_t c) {
    return 20 * c + static_cast<std::int64_t>(bump.below(18));
  });
  const codec::IntegerSolid fine = changed(coarse, [](std::int64_t c) {
    return static_cast<std::int64_t>(std::floor(8.36 * static_cast<double>(c) + 0.5));
  });
  generated::Random random(3);
  const codec::IntegerSolid anywhere =
      changed(fine, [&](std::int64_t c) { return c + static_cast<std::int64_t>(random.below(8)); });
  CHECK(10 * round_trip(fine).size() < 9 * round_trip(anywhere).size());
}

TEST_CASE("a solid of few distinct coordinates is smaller than one of many") {
  generated::Random random(12);
  const codec::IntegerSolid solid = gridded_torus();
  std::map<std::int64_t, std::int64_t> values;
  for (const codec::GridPoint& vertex : solid.vertices) {
    for (const std::int64_t c : vertex) values[c] = 0;
  }
  std::int64_t last = 0;
  for (auto& [coordinate, value] : values) {
    last += 2000 + static_cast<std::int64_t>(random.below(3000));
    value = last;
  }
  const codec::IntegerSolid few =
      changed(solid, [&](std::int64_t coordinate) { return values[coordinate]; });
  const codec::IntegerSolid many = changed(
      few, [&](std::int64_t c) { return c + static_cast<std::int64_t>(random.below(2000)); });
  CHECK(10 * round_trip(few).size() < 7 * round_trip(many).size());
}

TEST_CASE("lists that are too long or too wide are refused") {
  std::vector<std::int64_t> values;
  for (std::int64_t i = 0; i < 400; ++i) values.push_back(i % 40 * (i % 40) * 77);
  const codec::parallelogram::AxisPlaces places = codec::parallelogram::AxisPlaces::suggest(values);
  REQUIRE(places.kind() == Kind::listed);
  Limits few;
  few.vertices = 20;
  CHECK_FALSE(read(write(places), few));
  few.vertices = 60;
  CHECK(read(write(places), few));
}

TEST_CASE("random bytes make no endless or unsound places") {
  generated::Random random(11);
  Limits limits;
  limits.vertices = 2000;
  int sound = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    Bytes noise(random.below(60));
    for (auto& byte : noise) byte = static_cast<std::uint8_t>(random.next());
    const auto places = read(noise, limits);
    if (!places || places->kind() == Kind::every) continue;
    ++sound;
    const auto low = places->value_of(0);
    const auto high = places->value_of(1);
    if (low && high) CHECK(*low < *high);
    for (const double at : {-9e15, -3.5, 0.0, 1e9, 9e15}) {
      const double position = places->position_of(at);
      CHECK(std::abs(position) <= 1e16);
      CHECK(places->spread_of(at, 10) >= 0);
      (void)places->value_of(static_cast<std::int64_t>(position));
    }
  }
  CHECK(sound > 0);
}

}  // namespace
}  // namespace watertight
