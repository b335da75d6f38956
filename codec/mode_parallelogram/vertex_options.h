// SPDX-License-Identifier: GPL-3.0-or-later
//
// How the vertices of one solid are coded in mode parallelogram.
#pragma once

#include <array>

#include "codec/mode_parallelogram/axis_places.h"

namespace watertight::codec::parallelogram {

/// The writer chooses these for each solid. All but `naming_weight` are in the stream.
struct VertexOptions {
  bool has_repeats = false;  // coordinates of vertices nearby come again
  bool has_guesses = false;  // each tip names the guess that it is coded from
  std::array<AxisPlaces, 3> places{};
  /// Writer only: the weight, in the choice of a guess, of the bits that name it (0.5 or 1).
  double naming_weight = 0.5;
};

}  // namespace watertight::codec::parallelogram
