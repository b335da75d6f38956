// SPDX-License-Identifier: GPL-3.0-or-later
//
// The coordinates (u, v) of a place on a surface.
#pragma once

#include <optional>
#include <vector>

#include "surfaces/curves/pieces.h"

namespace watertight::surfaces {

struct Inverted {
  Parameters at{};
  double gap = 0;                        // the distance of the place from the surface
  std::optional<std::size_t> pole = {};  // the place is this pole of Inverter::poles()
};

/// Finds nearest points by steps of Gauss and Newton, from the coordinates of a neighbour if these
/// lead to a point within the tolerance, else from the nearest of a net of points. Cost: some ten
/// points of the surface with a neighbour, some hundred without.
class Inverter {
 public:
  Inverter(const Surface& surface, double tolerance);
  /// `known_gap` is a distance from the surface that other points of the same loops have.
  Inverted invert(const Vector3& place, const std::optional<Parameters>& neighbour,
                  double known_gap = 0) const;
  const std::vector<Pole>& poles() const { return poles_; }

 private:
  struct Sample {
    Parameters at{};
    Vector3 place{};
  };
  Inverted approach(const Vector3& place, Parameters from) const;
  Parameters within(Parameters at) const;

  const Surface& surface_;
  double tolerance_;
  std::vector<Pole> poles_;
  std::vector<Sample> net_;
};

}  // namespace watertight::surfaces
