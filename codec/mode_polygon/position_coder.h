// SPDX-License-Identifier: GPL-3.0-or-later
//
// Codes the positions of the vertices of a walked surface in mode `polygon`: columns by vertical
// edges, walls and right angles, heights by planes and levels (docs/format-polygon.md). For the
// mode only.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <utility>
#include <vector>

#include "codec/entropy/context.h"
#include "codec/mode_polygon/plane_geometry.h"
#include "codec/mode_polygon/surface.h"

namespace watertight::codec::polygon {

inline constexpr std::int64_t kCoordinateLimit = std::int64_t{1} << 53;
inline constexpr int kCoordinateBits = 55;
inline constexpr std::size_t kFanLimit = 12;    // the most corners of a vertex that predictions use
inline constexpr std::size_t kLevelLimit = 12;  // the most heights that are remembered
inline constexpr std::uint32_t kHeightLimit = 6;  // the most heights that are offered
inline constexpr int kRankBits = 12;              // the most bits of the rank of a known column

// Fixed by the format (docs/format-polygon.md, "Positions").
inline constexpr double kCrossing = 0.03;       // least squared sine between two walls that cross
inline constexpr double kPerpendicular = 0.25;  // least squared sine between two edges that cross
// The number of columns of the page that are compared before and after the prediction, and the
// number of them that are offered: for the first vertex of a solid, then for all others.
inline constexpr std::size_t kFirstWindow = 2048;
inline constexpr std::size_t kFirstOffered = 2048;
inline constexpr std::size_t kWindow = 64;
inline constexpr std::size_t kOffered = 16;
inline constexpr std::uint64_t kAcrossWeight = 4;  // the weight of the part of an offset across

using Kind = FacetPlane::Kind;
inline constexpr std::uint32_t kPlaneKinds = 4;

/// The way in which the base of a column was found.
enum class PredictionFrame : std::uint8_t { start, bare, edge, corner, closing, wall, walls };
inline constexpr std::uint32_t kFrames = 7;
inline constexpr std::size_t kDirectionLimit = 8;
/// The squared sine of the greatest angle between two edges of one direction.
inline constexpr double kDirectionSlack = 0.003 * 0.003;

/// True if `edge` has the direction of `line`, up to kDirectionSlack or two grid steps.
inline bool is_along(Flat edge, Flat line) {
  const double off = cross(edge, line);
  const double length = dot(line, line);
  return off * off <= length * std::max(kDirectionSlack * dot(edge, edge), 4.0);
}

inline Flat quarter_turned(Flat vector) { return {-vector.y, vector.x}; }

struct Neighbor {
  Index vertex = kNone;
  Index facet = kNone;        // the facet left of the edge to this neighbour
  Index other_facet = kNone;  // the facet right of that edge
  Context<3> relation{2U};    // 0: before in the ring, 1: after in it, 2: another neighbour
};

struct Prediction {
  PredictionFrame frame = PredictionFrame::start;
  GridColumn base{};
  Flat direction{};
  bool is_steady = false;  // the direction is that of a longer edge
};

inline std::uint32_t bits_of(std::int64_t value) {
  return static_cast<std::uint32_t>(
      std::bit_width(static_cast<std::uint64_t>(value < 0 ? -value : value)));
}

/// The bit length of the greater coordinate of a vector, in grid steps.
inline std::uint32_t length_bits(Flat vector) {
  return std::max(bits_of(to_whole(vector.x)), bits_of(to_whole(vector.y)));
}

inline GridColumn column_of(const GridPoint& point) { return {point[0], point[1]}; }

/// `same_as[v]` is the first vertex at the same position, or v itself. (A vertex of the solid where
/// several fans meet is one vertex of the surface for each fan.)
struct CodedPositions {
  std::vector<GridPoint> points;
  std::vector<Index> same_as;
};

/// Codes the position of each vertex of `surface` in turn. `truth` is empty when reading, else it
/// has the positions.
class PositionCoder {
 public:
  PositionCoder(EntropyStream& stream, ModelBank& models, const PageMemory& memory,
                const PolygonSurface& surface, std::span<const GridPoint> truth)
      : stream_(stream), models_(models), memory_(memory), surface_(surface), truth_(truth) {
    planes_.resize(surface.facet_count());
    uprights_.assign(surface.facet_count(), 0);
    has_upright_.assign(surface.vertex_count(), 0);
    turns_.assign(surface.vertex_count(), 0);
    in_known_column_.assign(surface.vertex_count(), 0);
  }

  /// Errors: malformed, or not_encodable when writing, if a coordinate is 2^53 or more. Cost:
  /// linear; compares at most 128 columns of the page for each vertex, 4096 for the first.
  Result<CodedPositions> run();

 private:
  void find_copies();
  bool code_copy(Index vertex);
  void code_vertex(Index vertex);
  void look_around(Index vertex);
  bool code_upright(Index vertex);
  void code_column(Index vertex);
  bool code_known_column(const Prediction& prediction);
  void code_offset(const Prediction& prediction);
  GridColumn code_residual(const Prediction& prediction, const GridColumn& truth);
  void code_first(std::uint32_t axis);
  Prediction predicted_column(Index vertex) const;
  bool predict_on_walls(Prediction& prediction) const;
  void code_height(Index vertex);
  bool code_height_on_planes(Index vertex);
  void code_other_height();
  void remember_direction(Index vertex);
  bool follow_direction(Flat& direction) const;
  void remember_height(std::int64_t height);
  void learn(Index vertex);

  bool is_known(Index vertex) const { return vertex < current_; }
  Flat flat(Index vertex) const {
    const GridPoint& point = points_[vertex];
    return {static_cast<double>(point[0] - points_[0][0]),
            static_cast<double>(point[1] - points_[0][1])};
  }
  GridPoint& point() { return points_[current_]; }
  std::int64_t truth_at(std::size_t axis) const {
    return truth_.empty() ? 0 : truth_[current_][axis];
  }

  EntropyStream& stream_;
  ModelBank& models_;
  const PageMemory& memory_;
  const PolygonSurface& surface_;
  std::span<const GridPoint> truth_;

  std::vector<GridPoint> points_;
  std::vector<Index> same_as_;
  bool has_copies_ = false;
  std::vector<FacetPlane> planes_;
  std::vector<std::uint8_t> uprights_;     // facet -> number of known vertical edges, at most 2
  std::vector<std::uint8_t> has_upright_;  // vertex -> number of known vertical edges, at most 2
  std::vector<std::uint8_t> in_known_column_;  // vertex -> 1 if coded by a column of the page
  Index last_top_ = kNone;                     // the last vertex coded in the column of a neighbour
  std::uint32_t known_columns_ = 0;  // the number of vertices coded by a column of the page
  std::vector<Flat> directions_;     // the long edges, one for each direction
  /// vertex -> how its offset turned (docs/format-polygon.md): 0 if none was coded, 1 if along is
  /// not negative, 2 if along is negative, 3 if the offset is nearly all across.
  std::vector<std::uint8_t> turns_;
  std::vector<std::int64_t> levels_;  // the last heights, the latest first

  // The vertex that is being coded, and the known vertices around it.
  Index current_ = 0;
  Index before_ = kNone;  // the vertex before in the ring that created current_, or kNone
  Index after_ = kNone;
  Index before_two_ = kNone;
  Index after_two_ = kNone;
  std::uint32_t ring_size_ = 0;
  Context<2> in_first_facet_{false};
  std::vector<Neighbor> neighbors_;
  std::vector<Index> facets_;  // the facets around current_
  Index below_ = kNone;        // the neighbour in the same column, or kNone
};

}  // namespace watertight::codec::polygon
