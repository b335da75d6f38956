// SPDX-License-Identifier: GPL-3.0-or-later
//
// Bezier patches as text: the number of patches; for each its two degrees, then its control points,
// row by row, the points of a row along the second degree. Patches meet where the control points of
// their sides are equal. The format has no unit: metres.
#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "formats/curved/curved_files.h"
#include "formats/curved/curved_solid.h"
#include "formats/mesh/mesh_text.h"
#include "formats/text/numbers.h"
#include "geometry/placement.h"
#include "surfaces/curves/nurbs.h"

namespace watertight::formats {
namespace {

using surfaces::BezierCurve;
using surfaces::BezierPatch;
using surfaces::Curve;
using surfaces::EdgeLoop;
using surfaces::OrientedEdge;
using surfaces::Surface;
using surfaces::Vector3;

using Side = std::vector<Vector3>;  // the control points of a side of a patch

class BptReader {
 public:
  BptReader(std::string_view text, const ReadOptions& options)
      : lines_(text), bytes_(text.size()), options_(options) {}

  Result<Document> read() {
    if (!lines_.next()) return lines_.ended("the number of patches");
    const auto patches = unsigned_word(lines_.words()[0]);
    if (!patches) return wrong(0, "the number of patches should stand here");
    solid_.shells.emplace_back();
    for (std::uint64_t i = 0; i < *patches; ++i) {
      if (!lines_.next()) return lines_.ended("patch " + std::to_string(i));
      if (solid_.faces.size() >= options_.limits.facets) {
        return Error{ErrorCode::limit_exceeded,
                     "more patches than the limit of " + std::to_string(options_.limits.facets),
                     lines_.line().offset,
                     {}};
      }
      if (Status status = patch(i); !status) return status.error();
    }
    Document document;
    document.format = Format::bpt;
    if (lines_.next()) document.notes.push_back("text after the last patch skipped");
    if (solid_.faces.empty()) document.notes.push_back("the file has no patches");
    Feature& feature = document.features.emplace_back();
    std::uint64_t budget = options_.limits.claimed_by(bytes_);
    Status status =
        add_curved_solid(std::move(solid_), {{}, 0, SolidSource{"", "BezierPatches", "", 0, 0, ""}},
                         options_, budget, feature);
    if (!status) return status.error();
    return document;
  }

 private:
  Error wrong(std::size_t word, std::string message) const {
    return error_at(lines_.line(), lines_.words()[word], std::move(message));
  }

  Result<std::size_t> degree(std::size_t word) const {
    if (word >= lines_.words().size()) return wrong(0, "a patch begins with its two degrees");
    const auto degree = unsigned_word(lines_.words()[word]);
    if (!degree || *degree == 0 || *degree > surfaces::kMostDegree) {
      return wrong(word, "a degree is a number from 1 to " + std::to_string(surfaces::kMostDegree));
    }
    return static_cast<std::size_t>(*degree);
  }

  Result<Vector3> point() const {
    if (lines_.words().size() != 3) return wrong(0, "a control point has three coordinates");
    Vector3 place{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto number = exact_number(lines_.words()[axis]);
      if (!number) return wrong(axis, number.error().message);
      place[axis] = geometry::rounded(number->value);
    }
    return place;
  }

  Status patch(std::uint64_t number) {
    const auto rows = degree(0);
    if (!rows) return rows.error();
    const auto columns = degree(1);
    if (!columns) return columns.error();
    BezierPatch patch{*columns + 1, {}};
    std::vector<Vector3> points;
    for (std::size_t i = 0; i < (*rows + 1) * (*columns + 1); ++i) {
      if (!lines_.next()) return lines_.ended("a control point of patch " + std::to_string(number));
      const auto place = point();
      if (!place) return place.error();
      points.push_back(*place);
      patch.points.push_back(surfaces::weighted(*place, 1));
    }
    return add_face(number, std::move(patch), points);
  }

  /// The sides of a patch, in the order and direction in which they turn left around (u, v).
  static std::array<Side, 4> sides_of(const BezierPatch& patch,
                                      const std::vector<Vector3>& points) {
    const std::size_t columns = patch.columns;
    const std::size_t rows = patch.rows();
    std::array<Side, 4> sides;
    for (std::size_t i = 0; i < columns; ++i) {
      sides[0].push_back(points[i]);
      sides[2].push_back(points[rows * columns - 1 - i]);
    }
    for (std::size_t k = 0; k < rows; ++k) {
      sides[1].push_back(points[(k + 1) * columns - 1]);
      sides[3].push_back(points[(rows - 1 - k) * columns]);
    }
    return sides;
  }

  Status add_face(std::uint64_t number, BezierPatch patch, const std::vector<Vector3>& points) {
    const std::array<Side, 4> sides = sides_of(patch, points);
    const auto is_same = [&](std::size_t a, std::size_t b) {
      return std::equal(sides[a].begin(), sides[a].end(), sides[b].rbegin(), sides[b].rend());
    };
    surfaces::BoundaryFace face;
    face.name = "patch " + std::to_string(number);
    face.surface = Surface{{0, 1}, {0, 1}, {std::move(patch)}, {is_same(1, 3), is_same(0, 2)}, {}};
    EdgeLoop& loop = face.loops.emplace_back();
    for (const Side& side : sides) {
      if (std::all_of(side.begin(), side.end(), [&](const Vector3& p) { return p == side[0]; })) {
        continue;  // a pole
      }
      loop.push_back(edge_of(side));
    }
    if (loop.empty()) face.unreadable = "the patch has no sides";
    solid_.shells[0].push_back(static_cast<Index>(solid_.faces.size()));
    solid_.faces.push_back(std::move(face));
    return Done{};
  }

  Index vertex_of(const Vector3& place) {
    const auto [found, is_new] =
        vertices_.emplace(place, static_cast<Index>(solid_.vertices.size()));
    if (is_new) solid_.vertices.push_back(place);
    return found->second;
  }

  OrientedEdge edge_of(const Side& side) {
    const Side back(side.rbegin(), side.rend());
    const bool is_forward = side <= back;
    const auto [found, is_new] =
        edges_.emplace(is_forward ? side : back, static_cast<Index>(solid_.edges.size()));
    if (is_new) {
      BezierCurve curve;
      for (const Vector3& place : found->first)
        curve.points.push_back(surfaces::weighted(place, 1));
      const Index start = vertex_of(found->first.front());
      const Index end = vertex_of(found->first.back());
      solid_.edges.push_back({start, end, Curve{{0, 1}, {std::move(curve)}, start == end}, true});
    }
    return {found->second, is_forward};
  }

  TextLines lines_;
  std::size_t bytes_;
  const ReadOptions& options_;
  surfaces::BoundaryRepresentation solid_;
  std::map<Vector3, Index> vertices_;
  std::map<Side, Index> edges_;  // the lesser of a side and its reverse -> edge
};

}  // namespace

Result<Document> read_bpt(std::string_view text, const ReadOptions& options) {
  return BptReader(text, options).read();
}

}  // namespace watertight::formats
