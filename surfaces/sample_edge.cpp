// SPDX-License-Identifier: GPL-3.0-or-later
#include "surfaces/sample_edge.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "surfaces/curves/elementary.h"

namespace watertight::surfaces {
namespace {

constexpr double kMostParts = 1e9;
constexpr double kFewestParts = 2;   // of a piece that is no line: no chord spans a quarter turn
constexpr int kDeepestHalving = 40;  // halvings of a part whose chord is too far

/// Adds the inner points of a part whose chords are near enough, from its start.
Status add_chords(const BezierCurve& part, double chord, int depth, std::size_t most,
                  std::vector<Vector3>& points) {
  if (depth == kDeepestHalving || chord_error_bound(part) <= chord) return Done{};
  if (points.size() >= most) {
    return Error{ErrorCode::limit_exceeded,
                 "an edge needs more than " + std::to_string(most) + " points for this chord",
                 {},
                 {}};
  }
  const BezierCurve first = part_of(part, 0, 0.5);
  if (Status status = add_chords(first, chord, depth + 1, most, points); !status) return status;
  points.push_back(first.points.back().place());
  return add_chords(part_of(part, 0.5, 1), chord, depth + 1, most, points);
}

Status add_piece(const BezierCurve& piece, double chord, std::size_t most,
                 std::vector<Vector3>& points) {
  const double error = chord_error_bound(piece);
  const double wanted = error == 0 ? 1 : std::max(kFewestParts, std::sqrt(error / chord));
  const double parts = std::ceil(std::min(wanted, kMostParts));
  for (double i = 0; i < parts; ++i) {
    const BezierCurve part = part_of(piece, i / parts, i + 1 == parts ? 1 : (i + 1) / parts);
    if (i > 0) points.push_back(part.points.front().place());
    if (Status status = add_chords(part, chord, 0, most, points); !status) return status;
    if (points.size() > most) return add_chords(piece, 0, 0, most, points);
  }
  return Done{};
}

}  // namespace

Result<EdgePoints> sample_edge(const BoundaryRepresentation& solid, Index edge, double chord,
                               std::size_t most) {
  const BoundaryEdge& source = solid.edges[edge];
  if (source.curve.pieces.empty()) return EdgePoints{};
  const Vector3& start = solid.vertices[source.start];
  const Vector3& end = solid.vertices[source.end];
  const Curve curve = source.is_along_curve ? source.curve : reversed(source.curve);
  double from = nearest_parameter(curve, start);
  double to = nearest_parameter(curve, end);
  EdgePoints result;
  result.gap = std::max(length(point_at(curve, from).place - start),
                        length(point_at(curve, to).place - end));
  if (source.start == source.end && !curve.is_closed) {
    from = curve.breaks.front();
    to = curve.breaks.back();
  }
  // A curve whose ends are one point may be given as open, and an edge may start at either end.
  const bool is_backward = !curve.is_closed && to < from;
  const Curve part = is_backward ? reversed(part_of(curve, to, from)) : part_of(curve, from, to);
  // An edge shorter than rounding has no piece.
  for (std::size_t i = 0; i < part.pieces.size(); ++i) {
    if (i > 0) result.inner.push_back(part.pieces[i].points.front().place());
    if (Status status = add_piece(part.pieces[i], chord, most, result.inner); !status) {
      return status.error();
    }
  }
  return result;
}

}  // namespace watertight::surfaces
