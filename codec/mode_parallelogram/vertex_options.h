// SPDX-License-Identifier: GPL-3.0-or-later
//
// The options with which mode parallelogram codes the vertices of one solid.
#pragma once

#include <array>

#include "codec/mode_parallelogram/axis_places.h"

namespace watertight::codec::parallelogram {

/// The options that a writer chooses for each solid. All but `naming_weight` are in the stream.
struct VertexOptions {
  bool has_repeats = false;  // true: a decision says whether a coordinate repeats one nearby
  bool has_guesses = false;  // true: each tip names the guess that it is coded from
  std::array<AxisPlaces, 3> places{};
  /// Writer only: the weight, in the choice of a guess, of the bits that name it (0.5 or 1).
  double naming_weight = 0.5;
};

}  // namespace watertight::codec::parallelogram
