// SPDX-License-Identifier: GPL-3.0-or-later
//
// libFuzzer harness of the codec's round trip. The bytes are the choices of a generator, which
// fills cells of a small grid, moves corners of the grid, merges or splits coplanar facets, and
// chooses a lattice. Every generated solid must come back in every mode that takes it.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "tests/generated/round_trip.h"

namespace {

using namespace watertight;

class Choices {
 public:
  Choices(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  std::uint32_t below(std::uint32_t limit) { return byte() % limit; }
  std::int64_t number() {
    std::uint64_t value = 0;
    const std::uint32_t bytes = below(7);
    for (std::uint32_t i = 0; i < bytes; ++i) value = value << 8U | byte();
    return (value & 1U) != 0 ? -static_cast<std::int64_t>(value >> 1U)
                             : static_cast<std::int64_t>(value >> 1U);
  }
  bool is_over() const { return next_ >= size_; }

 private:
  std::uint32_t byte() { return next_ < size_ ? data_[next_++] : 0U; }
  const std::uint8_t* data_;
  std::size_t size_;
  std::size_t next_ = 0;
};

Lattice chosen_lattice(Choices& choices) {
  Lattice lattice;
  const std::uint32_t kind = choices.below(8);
  if (kind == 0) {
    lattice.kind = LatticeKind::float64;
    return lattice;
  }
  if (kind == 1) lattice.kind = LatticeKind::binary;
  for (GridNumber& step : lattice.step) {
    step = {1, -static_cast<std::int32_t>(choices.below(10))};
  }
  for (GridNumber& origin : lattice.origin) {
    origin = {choices.number() * 10 + 1, -static_cast<std::int32_t>(choices.below(12))};
    if (lattice.kind == LatticeKind::binary) origin.mantissa |= 1;
  }
  return lattice;
}

/// The surface of the chosen cells of a grid whose corners may lie anywhere.
SolidArrays chosen_cells(Choices& choices) {
  constexpr std::uint32_t kMost = 4;
  const std::array<std::uint32_t, 3> size{1 + choices.below(kMost), 1 + choices.below(kMost),
                                          1 + choices.below(kMost)};
  std::array<bool, kMost * kMost * kMost> is_full{};
  const auto index = [&](std::array<std::uint32_t, 3> c) {
    return (c[0] * kMost + c[1]) * kMost + c[2];
  };
  const auto has = [&](std::array<std::uint32_t, 3> c) {
    return c[0] < size[0] && c[1] < size[1] && c[2] < size[2] && is_full[index(c)];
  };
  for (std::uint32_t x = 0; x < size[0]; ++x) {
    for (std::uint32_t y = 0; y < size[1]; ++y) {
      for (std::uint32_t z = 0; z < size[2]; ++z) {
        is_full[index({x, y, z})] = choices.below(2) == 0;
      }
    }
  }
  is_full[0] = true;
  SolidArrays arrays;
  constexpr std::uint32_t kCorners = kMost + 1;
  std::array<Index, kCorners * kCorners * kCorners> number{};
  number.fill(kNone);
  const std::uint32_t scale = 1U << choices.below(20);
  const auto vertex = [&](std::array<std::uint32_t, 3> p) {
    Index& known = number[(p[0] * kCorners + p[1]) * kCorners + p[2]];
    if (known != kNone) return known;
    known = static_cast<Index>(arrays.vertices.size());
    Point point;
    for (int axis = 0; axis < 3; ++axis) {
      point[axis] = static_cast<double>(p[static_cast<std::size_t>(axis)] * scale);
      if (choices.below(4) == 3) point[axis] += static_cast<double>(choices.number());
    }
    arrays.vertices.push_back(point);
    return known;
  };
  const std::uint32_t triangles = choices.below(3);
  for (std::uint32_t cell = 0; cell < is_full.size(); ++cell) {
    const std::array<std::uint32_t, 3> c{cell / (kMost * kMost), cell / kMost % kMost,
                                         cell % kMost};
    if (!has(c)) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const std::uint32_t up : {0U, 1U}) {
        std::array<std::uint32_t, 3> corner = c;
        corner[axis] += up == 1 ? 1U : ~0U;
        if (has(corner)) continue;
        corner = c;
        corner[axis] += up;
        std::array<Index, 4> ring{};
        const std::size_t u = (axis + 1) % 3;
        const std::size_t v = (axis + 2) % 3;
        for (std::uint32_t k = 0; k < 4; ++k) {
          std::array<std::uint32_t, 3> p = corner;
          const std::uint32_t turn = up == 1 ? k : 3 - k;
          p[u] += turn == 1 || turn == 2 ? 1U : 0U;
          p[v] += turn >= 2 ? 1U : 0U;
          ring[k] = vertex(p);
        }
        if (triangles == 0 || (triangles == 1 && choices.below(2) == 0)) {
          generated::add_facet(arrays, {{ring[0], ring[1], ring[2]}});
          generated::add_facet(arrays, {{ring[0], ring[2], ring[3]}});
        } else {
          generated::add_facet(arrays, {{ring[0], ring[1], ring[2], ring[3]}});
        }
        if (choices.below(16) == 15) arrays.end_shell();
      }
    }
  }
  if (arrays.shell_offsets.back() + 1 < arrays.facet_offsets.size()) arrays.end_shell();
  return arrays;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Choices choices(data, size);
  const Lattice lattice = chosen_lattice(choices);
  const std::uint32_t srid = choices.below(256);
  auto solid = Solid::make(chosen_cells(choices), lattice, srid);
  if (!solid) return 0;
  const auto boundary = OrientedBoundary::make(std::move(solid).value());
  if (!boundary) return 0;
  generated::RoundTrips trips;
  trips.check_all_modes("this input", *boundary, {});
  for (const std::string& failure : trips.failures()) std::fprintf(stderr, "%s\n", failure.c_str());
  if (!trips.failures().empty()) std::abort();
  return 0;
}
