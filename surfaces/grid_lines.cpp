// SPDX-License-Identifier: GPL-3.0-or-later
#include "surfaces/grid_lines.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace watertight::surfaces {
namespace {

constexpr std::size_t kFewestCells = 16;  // along u and along v, of few pieces
constexpr std::size_t kMostCells = 4;     // of a piece, along u and along v, of the surface
constexpr double kMostAspect = 8;         // of a cell
constexpr double kGridShare = 0.8;        // of the chord: the rest is for triangles across cells
constexpr double kNegligible = 0.01;      // of the chord
constexpr double kLeastCell = 1e-6;       // of the box

/// Where cells begin and end: at the ends of the box, at the breaks of the surface, and between.
std::vector<double> cell_ends(const Surface& surface, std::size_t axis, const ParameterBox& box) {
  std::vector<double> ends{box.low[axis]};
  const double least = kLeastCell * (box.high[axis] - box.low[axis]);
  const std::vector<double>& breaks = surface.breaks(static_cast<int>(axis));
  const double period = surface.period(static_cast<int>(axis));
  // A box on a surface that closes may begin before the first break and reach over the last one.
  const double shift =
      period > 0 ? period * std::floor((box.low[axis] - breaks.front()) / period) : 0;
  for (int turn = 0; turn <= (period > 0 ? 2 : 0); ++turn) {
    for (const double at : breaks) {
      const double place = at + shift + period * turn;
      if (place > ends.back() + least && place < box.high[axis] - least) ends.push_back(place);
    }
  }
  ends.push_back(box.high[axis]);
  const std::size_t pieces = ends.size() - 1;
  const std::size_t parts =
      std::clamp((kFewestCells + pieces - 1) / pieces, std::size_t{1}, kMostCells);
  std::vector<double> all{ends.front()};
  for (std::size_t i = 0; i < pieces; ++i) {
    for (std::size_t part = 1; part <= parts; ++part) {
      const double share = static_cast<double>(part) / static_cast<double>(parts);
      all.push_back(part == parts ? ends[i + 1] : ends[i] + share * (ends[i + 1] - ends[i]));
    }
  }
  return all;
}

/// The parts of the second derivatives that stand on the surface, the largest in a cell.
SecondDerivatives bend_of(const Surface& surface, const ParameterBox& cell) {
  const double u = (cell.high[0] - cell.low[0]) / 2;
  const double v = (cell.high[1] - cell.low[1]) / 2;
  std::array<std::array<SurfacePoint, 3>, 3> net;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < 3; ++i) {
      net[k][i] = point_at(surface, {cell.low[0] + u * static_cast<double>(i),
                                     cell.low[1] + v * static_cast<double>(k)});
    }
  }
  const Vector3 across = cross(net[1][1].along_u, net[1][1].along_v);
  const double size = length(across);
  const auto standing = [&](const Vector3& second) {
    return size > 0 ? std::abs(dot(second, across)) / size : length(second);
  };
  SecondDerivatives most;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3 by_u = net[i][0].place + net[i][2].place - net[i][1].place * 2.0;
    const Vector3 by_v = net[0][i].place + net[2][i].place - net[1][i].place * 2.0;
    if (u > 0) most.uu = std::max(most.uu, standing(by_u) / (u * u));
    if (v > 0) most.vv = std::max(most.vv, standing(by_v) / (v * v));
  }
  if (u > 0 && v > 0) {
    most.uv = std::max(standing(net[2][1].along_u + net[0][1].along_u * -1.0) / (2 * v),
                       standing(net[1][2].along_v + net[1][0].along_v * -1.0) / (2 * u));
  }
  return most;
}

/// Values between the ends of cells so that no step within a cell is longer than that of the cell.
std::vector<double> lines_of(const std::vector<double>& ends, const std::vector<double>& steps,
                             std::size_t most) {
  std::vector<double> sums{0};  // steps from the first end
  for (std::size_t i = 0; i < steps.size(); ++i) {
    sums.push_back(sums.back() + (steps[i] > 0 ? (ends[i + 1] - ends[i]) / steps[i] : 0));
  }
  const double count = std::min(std::ceil(sums.back()), static_cast<double>(most));
  std::vector<double> lines;
  std::size_t cell = 0;
  for (double i = 1; i < count; ++i) {
    const double at = sums.back() * (i / count);
    while (cell + 2 < sums.size() && sums[cell + 1] < at) ++cell;
    const double line = ends[cell] + (at - sums[cell]) * steps[cell];
    if (line > ends.front() && line < ends.back() && (lines.empty() || line > lines.back())) {
      lines.push_back(line);
    }
  }
  return lines;
}

}  // namespace

GridLines grid_lines(const Surface& surface, const ParameterBox& box, const Parameters& scale,
                     double chord, std::size_t most) {
  const std::array<std::vector<double>, 2> ends{cell_ends(surface, 0, box),
                                                cell_ends(surface, 1, box)};
  const std::array<double, 2> size{box.high[0] - box.low[0], box.high[1] - box.low[1]};
  std::array<std::vector<double>, 2> bends;  // of the columns by u twice, of the rows by v twice
  for (std::size_t axis = 0; axis < 2; ++axis) bends[axis].assign(ends[axis].size() - 1, 0);
  SecondDerivatives largest;
  for (std::size_t k = 0; k + 1 < ends[1].size(); ++k) {
    for (std::size_t i = 0; i + 1 < ends[0].size(); ++i) {
      const SecondDerivatives bend =
          bend_of(surface, {{ends[0][i], ends[1][k]}, {ends[0][i + 1], ends[1][k + 1]}});
      bends[0][i] = std::max(bends[0][i], bend.uu);
      bends[1][k] = std::max(bends[1][k], bend.vv);
      largest = {std::max(largest.uu, bend.uu), std::max(largest.uv, bend.uv),
                 std::max(largest.vv, bend.vv)};
    }
  }
  // Each term of the error that matters gets an equal share of the chord.
  const double least = kNegligible * chord;
  const bool has_twist = largest.uv * size[0] * size[1] / 4 > least;
  const double terms = (largest.uu * size[0] * size[0] / 8 > least ? 1.0 : 0.0) +
                       (has_twist ? 1.0 : 0.0) +
                       (largest.vv * size[1] * size[1] / 8 > least ? 1.0 : 0.0);
  const double share = kGridShare * chord / std::max(terms, 1.0);
  const auto step_for = [&](double bend, std::size_t axis) {
    return bend > 0 ? std::min(size[axis], std::sqrt(8 * share / bend)) : size[axis];
  };
  std::array<double, 2> longest{step_for(largest.uu, 0), step_for(largest.vv, 1)};
  // The twist bounds the product: both steps shrink to the same length.
  const double most_product = has_twist ? 4 * share / largest.uv : longest[0] * longest[1];
  if (longest[0] * longest[1] > most_product) {
    const double side = std::sqrt(most_product * scale[0] * scale[1]);
    const double u = std::min(longest[0], side / scale[0]);
    const double v = std::min(longest[1], most_product / u);
    longest = {std::min(longest[0], most_product / v), v};
  } else {
    longest = size;
  }
  // Long thin triangles are hard to certify.
  longest[0] = std::min(longest[0], kMostAspect * step_for(largest.vv, 1) * scale[1] / scale[0]);
  longest[1] = std::min(longest[1], kMostAspect * step_for(largest.uu, 0) * scale[0] / scale[1]);
  std::array<std::vector<double>, 2> steps;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    for (const double bend : bends[axis]) {
      steps[axis].push_back(std::min(step_for(bend, axis), longest[axis]));
    }
  }
  return {lines_of(ends[0], steps[0], most), lines_of(ends[1], steps[1], most)};
}

}  // namespace watertight::surfaces
