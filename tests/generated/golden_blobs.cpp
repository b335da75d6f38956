// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/generated/golden_blobs.h"

#include <array>
#include <utility>

#include "codec/encode_boundary.h"
#include "tests/generated/generated_solids.h"
#include "tests/generated/generated_variety.h"

namespace watertight::generated {
namespace {

/// A tower with a pointed roof: its tip is a vertex with sixteen facets around it.
OrientedBoundary spire() {
  constexpr Index kSides = 16;
  constexpr int kX[kSides] = {50, 46, 35, 19, 0, -19, -35, -46, -50, -46, -35, -19, 0, 19, 35, 46};
  SolidArrays arrays;
  std::vector<Index> base;
  for (const double z : {0.0, 90.0}) {
    for (Index i = 0; i < kSides; ++i) {
      const int y = kX[(i + kSides - kSides / 4) % kSides];
      arrays.vertices.push_back({1000.0 + kX[i], 1000.0 + y, z});
    }
  }
  arrays.vertices.push_back({1000, 1000, 240});
  for (Index i = 0; i < kSides; ++i) {
    const Index j = (i + 1) % kSides;
    base.insert(base.begin(), i);
    add_facet(arrays, {{i, j, kSides + j, kSides + i}});
    add_facet(arrays, {{kSides + i, kSides + j, 2 * kSides}});
  }
  add_facet(arrays, {base});
  arrays.end_shell();
  return boundary_of(std::move(arrays));
}

void add_tetrahedron(SolidArrays& arrays, Point corner, double size, Turn turn) {
  const auto first = static_cast<Index>(arrays.vertices.size());
  for (int axis = -1; axis < 3; ++axis) {
    arrays.vertices.push_back(corner);
    if (axis >= 0) arrays.vertices.back()[axis] += size;
  }
  for (std::array<Index, 3> t : {std::array<Index, 3>{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}) {
    if (turn == Turn::inward) std::swap(t[1], t[2]);
    add_facet(arrays, {{first + t[0], first + t[1], first + t[2]}});
  }
  arrays.end_shell();
}

/// Three tetrahedra: an exterior shell with two cavities.
OrientedBoundary tetrahedron_with_cavities() {
  SolidArrays arrays;
  add_tetrahedron(arrays, {0, 0, 0}, 100, Turn::outward);
  add_tetrahedron(arrays, {11, 12, 13}, 10, Turn::inward);
  add_tetrahedron(arrays, {30, 31, 17}, 7, Turn::inward);
  return boundary_of(std::move(arrays));
}

/// An uneven torus of 8 x 8 vertices whose coordinates are multiples of 37 / 8, rounded down.
OrientedBoundary torus_on_coarse_steps() {
  const OrientedBoundary smooth = torus(8, 8);
  Random random(9);
  SolidArrays arrays;
  for (const Point& vertex : smooth.solid().vertices()) {
    Point& moved = arrays.vertices.emplace_back(vertex);
    for (int axis = 0; axis < 3; ++axis) {
      const auto coordinate = static_cast<std::int64_t>(vertex[axis]);
      const auto uneven = coordinate + static_cast<std::int64_t>(random.below(600));
      const std::int64_t step = uneven * 37 / 8;
      moved[axis] = static_cast<double>(step);
    }
  }
  for (Index facet = 0; facet < smooth.solid().facet_count(); ++facet) {
    const auto ring = smooth.solid().ring(facet);
    add_facet(arrays, {{ring.begin(), ring.end()}});
  }
  arrays.end_shell();
  return boundary_of(std::move(arrays));
}

/// A box whose lattice has an origin that is no multiple of its step.
OrientedBoundary box_with_far_origin() {
  Lattice lattice;
  lattice.step.fill(GridNumber{1, 0});
  lattice.origin[0] = GridNumber{7, -30};
  SolidArrays arrays;
  add_box(arrays, {0, 0, 0}, {3, 4, 5});
  return boundary_of(std::move(arrays), lattice, 7415);
}

/// A solid of generated_variety.h with about 4 to 60 vertices.
OrientedBoundary varied(std::uint64_t seed) {
  Random random(seed);
  const Index size = 4 + static_cast<Index>(random.below(40));
  return random_solid(random, size).boundary;
}

/// The golden solids in modes raw and bitmap.
std::vector<Golden> plain_goldens() {
  Random random(1);
  const Acceptance stated{{0.001, 5, 0.0005}, Proof::boundary, 1};
  const OrientedBoundary terrain = random_terrain(random, 4);
  const OrientedBoundary doubles = random_doubles(random, 2);
  return {{"box-raw", box(), {}, Mode::raw},
          {"box-bitmap", box(), {}, Mode::bitmap},
          {"box-canonical", box(), {}, Mode::bitmap, false},
          {"holes-in-facets", pierced_block(3), {}, Mode::bitmap},
          {"hole-touches-ring", block_with_touching_hole(), {}, Mode::bitmap},
          {"cavity", box_with_cavities(2), {}, Mode::bitmap},
          {"shells-touch-at-edge", boxes_touching_at_edge(), {}, Mode::bitmap},
          {"schoenhardt-steiner", schoenhardt(), {}, Mode::bitmap, true, true},
          {"schoenhardt-unrecovered", schoenhardt(), {}, Mode::bitmap},
          {"terrain-unrecovered", terrain, {}, Mode::bitmap, false},
          {"terrain-shuffled", shuffled(terrain, random), {}, Mode::automatic},
          {"doubles-raw", doubles, {}, Mode::raw},
          {"doubles-bitmap", doubles, {}, Mode::bitmap},
          {"stated-tolerances", torus(8, 4), stated, Mode::bitmap, false}};
}

}  // namespace

std::vector<Golden> goldens() {
  std::vector<Golden> all = plain_goldens();
  Random random(2);
  const auto add = [&](const std::string& name, const OrientedBoundary& boundary) {
    for (const Mode mode : {Mode::walk, Mode::polygon, Mode::parallelogram}) {
      Golden golden{name + "-" + std::string(codec::to_string(mode)), boundary, {}, mode};
      if (encode_golden(golden)) all.push_back(std::move(golden));
    }
  };
  add("box", box());
  add("holes", pierced_block(2));
  add("cavities", box_with_cavities(2));
  add("edge", boxes_touching_at_edge());
  add("torus", torus(9, 5));
  add("terrain", random_terrain(random, 5));
  add("spire", spire());
  // These solids use lines of the decoder that the other golden solids do not use.
  const auto add_one = [&](const std::string& name, const OrientedBoundary& boundary, Mode mode) {
    all.push_back({name + "-" + std::string(codec::to_string(mode)), boundary, {}, mode});
  };
  add_one("nested", tetrahedron_with_cavities(), Mode::parallelogram);
  add_one("coarse-torus", torus_on_coarse_steps(), Mode::parallelogram);
  add_one("far-origin", box_with_far_origin(), Mode::polygon);
  add_one("hole-touches-ring", block_with_touching_hole(), Mode::polygon);
  add_one("holes", pierced_block(2), Mode::raw);
  for (const std::uint64_t seed : {9U, 28U, 126U}) {
    add_one("varied-" + std::to_string(seed), varied(seed), Mode::polygon);
  }
  for (const std::uint64_t seed : {17U, 585U}) {
    add_one("varied-" + std::to_string(seed), varied(seed), Mode::walk);
  }
  add_one("saw", saw(kSawTeeth, Back::left), Mode::polygon);
  // docs/format.md shows traces of these blobs: with the neutral set of priors they never change.
  const auto add_neutral = [&](const char* name, const OrientedBoundary& boundary, Mode mode) {
    all.push_back({name, boundary, {}, mode});
    all.back().models = 0;
  };
  add_neutral("box-neutral", box(), Mode::polygon);
  add_neutral("box-walk-neutral", box(), Mode::walk);
  add_neutral("schoenhardt-parallelogram-neutral", schoenhardt(), Mode::parallelogram);
  return all;
}

Result<Bytes> encode_golden(const Golden& golden) {
  const delaunay::Certificate certificate = schoenhardt_certificate();
  EncodeOptions options{.mode = golden.mode, .keep_order = golden.keep_order};
  options.models = golden.models;
  if (golden.with_steiner) options.certificate = &certificate;
  return codec::encode_boundary(golden.boundary, golden.acceptance, options);
}

}  // namespace watertight::generated
