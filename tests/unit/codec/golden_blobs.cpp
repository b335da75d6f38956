// SPDX-License-Identifier: GPL-3.0-or-later
#include "golden_blobs.h"

#include "codec/encode_boundary.h"
#include "generated_solids.h"

namespace watertight::generated {
namespace {

/// A tower with a pointed roof: a vertex with sixteen facets around it.
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

}  // namespace

std::vector<Golden> version_0_goldens() {
  Random random(1);
  const Acceptance stated{{0.001, 5, 0.0005}, Proof::boundary, 1};
  const OrientedBoundary terrain = random_terrain(random, 4);
  const OrientedBoundary doubles = random_doubles(random, 2);
  return {{"box-raw", 105, box(), {}, Mode::raw},
          {"box-bitmap", 76, box(), {}, Mode::bitmap},
          {"box-canonical", 70, box(), {}, Mode::bitmap, false},
          {"holes-in-facets", 492, pierced_block(3), {}, Mode::bitmap},
          {"hole-touches-ring", 99, block_with_touching_hole(), {}, Mode::bitmap},
          {"cavity", 168, box_with_cavities(2), {}, Mode::bitmap},
          {"shells-touch-at-edge", 101, boxes_touching_at_edge(), {}, Mode::bitmap},
          {"schoenhardt-steiner", 124, schoenhardt(), {}, Mode::bitmap, true, true},
          {"schoenhardt-unrecovered", 96, schoenhardt(), {}, Mode::bitmap},
          {"terrain-unrecovered", 358, terrain, {}, Mode::bitmap, false},
          {"terrain-shuffled", 419, shuffled(terrain, random), {}, Mode::automatic},
          {"doubles-raw", 530, doubles, {}, Mode::raw},
          {"doubles-bitmap", 471, doubles, {}, Mode::bitmap},
          {"stated-tolerances", 329, torus(8, 4), stated, Mode::bitmap, false}};
}

std::vector<Golden> goldens() {
  std::vector<Golden> all = version_0_goldens();
  for (Golden& golden : all) golden.size = 0;
  Random random(2);
  const auto add = [&](const std::string& name, const OrientedBoundary& boundary) {
    for (const Mode mode : {Mode::walk, Mode::polygon, Mode::parallelogram}) {
      Golden golden{name + "-" + std::string(to_string(mode)), 0, boundary, {}, mode};
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
  // Traced in docs/format.md: with the neutral set of priors they never change.
  const auto add_neutral = [&](const char* name, const OrientedBoundary& boundary, Mode mode) {
    all.push_back({name, 0, boundary, {}, mode});
    all.back().models = 0;
  };
  add_neutral("box-neutral", box(), Mode::polygon);
  add_neutral("box-walk-neutral", box(), Mode::walk);
  add_neutral("schoenhardt-parallelogram-neutral", schoenhardt(), Mode::parallelogram);
  return all;
}

Result<Bytes> encode_golden(const Golden& golden) {
  const Certificate certificate = schoenhardt_certificate();
  EncodeOptions options{.mode = golden.mode, .keep_order = golden.keep_order};
  options.models = golden.models;
  if (golden.with_steiner) options.certificate = &certificate;
  return encode_boundary(golden.boundary, golden.acceptance, options);
}

}  // namespace watertight::generated
