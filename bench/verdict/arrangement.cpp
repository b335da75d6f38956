// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/verdict/arrangement.h"

#include <algorithm>

#include "bench/verdict/plane_arrangement.h"

namespace watertight::verdict {
namespace {

Vector normal_of(const Piece& piece) {
  Vector sum{0, 0, 0};
  const std::vector<Vector>& ring = piece.rings.front();
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    const Vector part = cross(difference(ring[i], ring[0]), difference(ring[i + 1], ring[0]));
    for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += part[axis];
  }
  return sum;
}

/// The points p with dot(normal, p) == offset. The first coordinate of the normal that is not zero
/// is 1, so that equal planes have equal members.
struct Plane {
  Vector normal;
  Number offset;
  friend bool operator<(const Plane& a, const Plane& b) {
    return a.normal != b.normal ? a.normal < b.normal : a.offset < b.offset;
  }
  int axis() const { return sgn(normal[0]) != 0 ? 0 : sgn(normal[1]) != 0 ? 1 : 2; }
  Number height(const Vector& p) const { return dot(normal, p) - offset; }
};

Plane plane_of(const Piece& piece) {
  Plane plane{normal_of(piece), 0};
  const Number first = plane.normal[static_cast<std::size_t>(plane.axis())];
  for (Number& coordinate : plane.normal) coordinate /= first;
  plane.offset = dot(plane.normal, piece.rings.front().front());
  return plane;
}

Number turn(const Vector& a, const Vector& b, const Vector& c, int axis) {
  const auto u = static_cast<std::size_t>((axis + 1) % 3);
  const auto v = static_cast<std::size_t>((axis + 2) % 3);
  return (b[u] - a[u]) * (c[v] - a[v]) - (b[v] - a[v]) * (c[u] - a[u]);
}

struct Bounds {
  Vector low;
  Vector high;
  void include(const Vector& p) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (p[axis] < low[axis]) low[axis] = p[axis];
      if (p[axis] > high[axis]) high[axis] = p[axis];
    }
  }
  bool meets(const Bounds& other) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (high[axis] < other.low[axis] || other.high[axis] < low[axis]) return false;
    }
    return true;
  }
};

Bounds bounds_of(const Piece& piece) {
  Bounds bounds{piece.rings.front().front(), piece.rings.front().front()};
  for (const auto& ring : piece.rings) {
    for (const Vector& p : ring) bounds.include(p);
  }
  return bounds;
}

/// A plane and everything along which it is cut.
struct PlaneInput {
  Plane plane;
  Bounds bounds;
  std::vector<std::size_t> pieces;
  std::set<Segment> segments;
  std::set<std::size_t> points;
};

class Arranger {
 public:
  explicit Arranger(const std::vector<Piece>& pieces) : pieces_(pieces) {
    for (const Piece& piece : pieces) bounds_.push_back(bounds_of(piece));
  }

  Complex arrange() {
    collect_planes();
    for (PlaneInput& input : planes_) cut(input);
    for (const PlaneInput& input : planes_) add_cells(input);
    complex_.points = table_.points();
    return std::move(complex_);
  }

 private:
  void collect_planes() {
    std::map<Plane, std::size_t> numbers;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const Plane plane = plane_of(pieces_[i]);
      const auto [place, is_new] = numbers.emplace(plane, planes_.size());
      if (is_new) planes_.push_back({plane, bounds_[i], {}, {}, {}});
      PlaneInput& input = planes_[place->second];
      input.pieces.push_back(i);
      input.bounds.include(bounds_[i].low);
      input.bounds.include(bounds_[i].high);
    }
  }

  void add_segment(PlaneInput& input, const Vector& a, const Vector& b) {
    const std::size_t i = table_.number_of(a);
    const std::size_t j = table_.number_of(b);
    if (i != j) input.segments.insert({std::min(i, j), std::max(i, j)});
  }

  void cut(PlaneInput& input) {
    const std::set<std::size_t> own(input.pieces.begin(), input.pieces.end());
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      if (own.count(i) != 0) {
        for (const auto& ring : pieces_[i].rings) {
          for (std::size_t k = 0; k < ring.size(); ++k) {
            add_segment(input, ring[k], ring[(k + 1) % ring.size()]);
          }
        }
      } else if (bounds_[i].meets(input.bounds)) {
        cut_by(input, pieces_[i]);
      }
    }
  }

  /// The points in which the rings of a piece meet the plane, in order along their common line.
  static std::vector<Vector> meeting_points(const Plane& plane, const Piece& piece) {
    std::set<Vector> found;
    for (const auto& ring : piece.rings) {
      std::vector<Number> heights;
      for (const Vector& p : ring) heights.push_back(plane.height(p));
      for (std::size_t k = 0; k < ring.size(); ++k) {
        const std::size_t after = (k + 1) % ring.size();
        if (sgn(heights[k]) == 0) found.insert(ring[k]);
        if (sgn(heights[k]) * sgn(heights[after]) < 0) {
          found.insert(
              verdict::between(ring[k], ring[after], heights[k] / (heights[k] - heights[after])));
        }
      }
    }
    return {found.begin(), found.end()};
  }

  /// Adds the intersection of the plane with a piece of another plane.
  void cut_by(PlaneInput& input, const Piece& piece) {
    const std::vector<Vector> along = meeting_points(input.plane, piece);
    const int axis = along.empty() ? 0 : dropped_axis(piece);
    for (std::size_t k = 0; k < along.size(); ++k) {
      input.points.insert(table_.number_of(along[k]));
      if (k + 1 == along.size()) break;
      const Vector middle = verdict::between(along[k], along[k + 1], Number(1, 2));
      if (locate_in(piece, middle, axis) != Side::outside) {
        add_segment(input, along[k], along[k + 1]);
      }
    }
  }

  std::size_t edge_number(std::size_t from, std::size_t to) {
    const Segment segment{std::min(from, to), std::max(from, to)};
    const auto [place, is_new] = edges_.emplace(segment, complex_.edges.size());
    if (is_new) complex_.edges.push_back(segment);
    return place->second;
  }

  void add_cells(const PlaneInput& input) {
    const int axis = input.plane.axis();
    const PlaneArrangement plane(table_, axis, input.segments, input.points);
    std::vector<std::size_t> number(plane.region_count(), kUnbounded);
    for (std::size_t region = 0; region < plane.region_count(); ++region) {
      Region cell;
      cell.sample = plane.sample(region);
      for (const std::size_t piece : input.pieces) {
        if (locate_in(pieces_[piece], cell.sample, axis) == Side::inside) {
          cell.facets.push_back(pieces_[piece].facet);
        }
      }
      if (cell.facets.empty()) continue;
      std::sort(cell.facets.begin(), cell.facets.end());
      cell.sample[static_cast<std::size_t>(axis)] -=
          input.plane.height(cell.sample) / input.plane.normal[static_cast<std::size_t>(axis)];
      number[region] = complex_.regions.size();
      complex_.regions.push_back(std::move(cell));
    }
    add_boundaries(plane, number);
  }

  void add_boundaries(const PlaneArrangement& plane, const std::vector<std::size_t>& number) {
    const auto& half_edges = plane.half_edges();
    for (const PlaneArrangement::HalfEdge& half_edge : half_edges) {
      if (half_edge.region == kUnbounded || number[half_edge.region] == kUnbounded) continue;
      const std::size_t region = number[half_edge.region];
      const std::size_t edge = edge_number(half_edge.from, half_edge.to);
      complex_.regions[region].edges.push_back(edge);
      const std::size_t after = edge_number(half_edge.to, half_edges[half_edge.next].to);
      complex_.corners.push_back({half_edge.to, {edge, after}, region});
    }
    for (const auto& [point, region] : plane.lone_points()) {
      if (number[region] != kUnbounded) {
        complex_.lone_points.push_back({point, number[region]});
      }
    }
  }

  const std::vector<Piece>& pieces_;
  std::vector<Bounds> bounds_;
  std::vector<PlaneInput> planes_;
  PointTable table_;
  std::map<Segment, std::size_t> edges_;
  Complex complex_;
};

}  // namespace

Complex arrange(const std::vector<Piece>& pieces) { return Arranger(pieces).arrange(); }

int dropped_axis(const Piece& piece) {
  const Vector normal = normal_of(piece);
  return sgn(normal[0]) != 0 ? 0 : sgn(normal[1]) != 0 ? 1 : 2;
}

Side locate_in(const Piece& piece, const Vector& p, int axis) {
  const auto u = static_cast<std::size_t>((axis + 1) % 3);
  const auto v = static_cast<std::size_t>((axis + 2) % 3);
  bool is_inside = false;
  for (const auto& ring : piece.rings) {
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Vector& a = ring[k];
      const Vector& b = ring[(k + 1) % ring.size()];
      const bool a_above = a[v] > p[v];
      const bool b_above = b[v] > p[v];
      if (a_above == b_above && a[v] != p[v] && b[v] != p[v]) continue;
      const int side = sgn(turn(a, b, p, axis));
      if (side == 0 && sgn((a[u] - p[u]) * (b[u] - p[u])) <= 0 &&
          sgn((a[v] - p[v]) * (b[v] - p[v])) <= 0) {
        return Side::boundary;
      }
      if (a_above != b_above && (side > 0) == b_above) is_inside = !is_inside;
    }
  }
  return is_inside ? Side::inside : Side::outside;
}

std::size_t complement_components(const Complex& complex) {
  // The columns of the boundary map after reduction; each has a last edge that no other has.
  std::map<std::size_t, std::set<std::size_t>> reduced;
  std::size_t cycles = 0;
  for (const Region& region : complex.regions) {
    std::set<std::size_t> column;
    const auto flip = [&column](std::size_t edge) {
      if (!column.insert(edge).second) column.erase(edge);
    };
    for (const std::size_t edge : region.edges) flip(edge);
    while (!column.empty()) {
      const auto place = reduced.find(*column.rbegin());
      if (place == reduced.end()) break;
      for (const std::size_t edge : place->second) flip(edge);
    }
    if (column.empty()) {
      ++cycles;
    } else {
      const std::size_t last = *column.rbegin();
      reduced.emplace(last, std::move(column));
    }
  }
  return 1 + cycles;
}

}  // namespace watertight::verdict
