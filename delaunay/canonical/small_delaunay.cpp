// SPDX-License-Identifier: GPL-3.0-or-later
//
// The algorithm makes a tetrahedralization of the sphere: beside the tetrahedra there is an
// infinite cell for each face of the hull, whose last vertex is the infinite one. A finite cell is
// positively oriented. An infinite cell would be positively oriented if a point beyond its face
// replaced the infinite vertex.
//
// Coplanar points need no rule of their own. A point in the plane of a hull face is in conflict
// with the infinite cell there exactly if it is in conflict with the finite cell behind the face:
// both depend on the face's (perturbed) circle only.
#include "delaunay/canonical/small_delaunay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "delaunay/cancellation.h"
#include "delaunay/canonical/canonical_order.h"
#include "delaunay/canonical/grid_predicates.h"
#include "delaunay/canonical/insertion_order.h"

namespace watertight::delaunay {
namespace {

constexpr double kSide = 1 << 30;
/// The most cells: the four sides of each cell are numbered by an Index.
constexpr std::size_t kMostCells = kNone / 4;
constexpr double kLargestInteger = 9007199254740992.0;

/// One side of a cell: the face opposite to vertex `corner`, as 4 cell + corner.
using Side = Index;
Index cell_of(Side side) { return side >> 2; }
std::size_t corner_of(Side side) { return side & 3; }
Side side_of(Index cell, std::size_t corner) { return 4 * cell + static_cast<Index>(corner); }

/// Corner -> the three other corners of a cell.
constexpr std::array<std::array<std::size_t, 3>, 4> kOthers{
    {{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}}};

/// Rims up to this many vertices are linked by a table; kSmallRim is their number of faces (Euler).
constexpr std::size_t kRimVertices = 64;
constexpr std::size_t kSmallRim = 2 * (kRimVertices - 2);

struct Cell {
  geometry::Tetrahedron vertices{kNone, kNone, kNone, kNone};
  /// The neighbour's side across each side of this cell.
  std::array<Side, 4> neighbors{kNone, kNone, kNone, kNone};
};

class SmallDelaunay {
 public:
  SmallDelaunay(std::vector<Point> points, const Point& extent)
      : points_(std::move(points)), infinite_(static_cast<Index>(points_.size())), signs_(extent) {
    // 6.8 tetrahedra per point are usual; freed cells are used again.
    cells_.reserve(8 * points_.size() + 64);
    cavity_.reserve(64);
    rim_.reserve(kSmallRim);
    marks_.reserve(8 * points_.size() + 64);
    labels_.resize(points_.size() + 1, kNone);
    new_cell({infinite_, infinite_, infinite_, infinite_});
  }

  /// Makes the first cell of four points of positive orientation, and its infinite neighbours.
  void start(const geometry::Tetrahedron& corners);

  /// Inserts a point and adds the work to `steps`. Returns false if an earlier point is equal.
  bool insert(Index vertex, std::size_t& steps);

  std::size_t cell_count() const { return cells_.size() - free_.size() - 1; }
  /// Returns the result and frees the cells.
  CanonicalDelaunay list();
  const GridPredicates& signs() const { return signs_; }
  const Point& point(Index vertex) const { return points_[vertex]; }

 private:
  bool is_infinite(const Cell& cell) const { return cell.vertices[3] == infinite_; }
  std::array<const Point*, 4> corners_of(const Cell& cell) const {
    return {&points_[cell.vertices[0]], &points_[cell.vertices[1]], &points_[cell.vertices[2]],
            &points_[cell.vertices[3]]};
  }
  /// The orientation of the cell if the point took the place of the vertex at `corner`.
  int side(const Cell& cell, std::size_t corner, const Point& p) const {
    std::array<const Point*, 4> t{};
    for (std::size_t i = 0; i < 4; ++i) t[i] = i == corner ? &p : &points_[cell.vertices[i]];
    return signs_.orientation(*t[0], *t[1], *t[2], *t[3]);
  }
  Index new_cell(const geometry::Tetrahedron& vertices);
  Index locate(const Point& p, std::size_t& steps) const;
  bool is_in_conflict(Index cell, const Point& p) const;
  void find_conflicts(Index first, const Point& p);
  void fill_cavity(Index vertex);
  void link_small_rim();
  void link_large_rim();

  std::vector<Point> points_;
  Index infinite_;
  GridPredicates signs_;
  std::vector<Cell> cells_;
  /// Cell -> 2 r if it is in conflict with the point of round r, 2 r + 1 if it is not; other marks
  /// are from earlier rounds.
  std::vector<Index> marks_;
  std::vector<Index> free_;
  Index round_ = 0;
  Index last_ = 0;
  std::vector<Index> cavity_;
  /// The sides of the cavity's cells towards cells outside the cavity; later the same sides of the
  /// new cells.
  std::vector<Side> rim_;
  /// vertex -> its row in the table of link_small_rim(); kNone outside that function.
  std::vector<Index> labels_;
};

void SmallDelaunay::start(const geometry::Tetrahedron& corners) {
  // Cell i lacks the i-th of the four corners and the infinite vertex; all cells are neighbours.
  const auto& [a, b, c, d] = corners;
  const std::array<std::array<std::size_t, 4>, 5> labels{
      {{3, 1, 2, 4}, {0, 3, 2, 4}, {0, 1, 3, 4}, {1, 0, 2, 4}, {0, 1, 2, 3}}};
  const std::array<Index, 5> vertices{a, b, c, d, infinite_};
  for (const auto& label : labels) {
    last_ =
        new_cell({vertices[label[0]], vertices[label[1]], vertices[label[2]], vertices[label[3]]});
  }
  for (std::size_t i = 0; i < 5; ++i) {
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const std::size_t j = labels[i][corner];
      const auto across = std::find(labels[j].begin(), labels[j].end(), i) - labels[j].begin();
      cells_[1 + i].neighbors[corner] =
          side_of(static_cast<Index>(1 + j), static_cast<std::size_t>(across));
    }
  }
}

Index SmallDelaunay::new_cell(const geometry::Tetrahedron& vertices) {
  if (free_.empty()) {
    cells_.push_back({vertices});
    marks_.push_back(0);
    return static_cast<Index>(cells_.size() - 1);
  }
  const Index cell = free_.back();
  free_.pop_back();
  cells_[cell] = {vertices};
  return cell;
}

/// Walks through faces that the point lies beyond. The walk does not run in a circle, since the
/// cells are Delaunay. Returns a finite cell that contains the point, or an infinite cell whose
/// face the point lies beyond.
Index SmallDelaunay::locate(const Point& p, std::size_t& steps) const {
  Index at = is_infinite(cells_[last_]) ? cell_of(cells_[last_].neighbors[3]) : last_;
  std::size_t entry = 4;
  while (true) {
    ++steps;
    const Cell& cell = cells_[at];
    if (is_infinite(cell)) return at;
    std::size_t exit = 0;
    while (exit < 4 && (exit == entry || side(cell, exit, p) >= 0)) ++exit;
    if (exit == 4) return at;
    at = cell_of(cell.neighbors[exit]);
    entry = corner_of(cell.neighbors[exit]);
  }
}

bool SmallDelaunay::is_in_conflict(Index cell, const Point& p) const {
  if (is_infinite(cells_[cell])) {
    const int beyond = side(cells_[cell], 3, p);
    if (beyond != 0) return beyond > 0;
    cell = cell_of(cells_[cell].neighbors[3]);
    if (marks_[cell] / 2 == round_) return marks_[cell] % 2 == 0;
  }
  return signs_.is_in_perturbed_sphere(corners_of(cells_[cell]), p);
}

/// Finds all cells in conflict with a point from one of them: they are connected.
void SmallDelaunay::find_conflicts(Index first, const Point& p) {
  ++round_;
  cavity_.clear();
  rim_.clear();
  cavity_.push_back(first);
  marks_[first] = 2 * round_;
  for (std::size_t i = 0; i < cavity_.size(); ++i) {
    const Index cell = cavity_[i];
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const Index next = cell_of(cells_[cell].neighbors[corner]);
      if (marks_[next] / 2 != round_) {
        const bool is_conflict = is_in_conflict(next, p);
        marks_[next] = 2 * round_ + (is_conflict ? 0 : 1);
        if (is_conflict) cavity_.push_back(next);
      }
      if (marks_[next] % 2 != 0) rim_.push_back(side_of(cell, corner));
    }
  }
}

/// Replaces the cavity by a cell between the vertex and each face of its rim. The vertex takes the
/// place of the corner inside the cavity, so that infinite vertices stay last and orientations stay
/// right.
void SmallDelaunay::fill_cavity(Index vertex) {
  for (Side& side : rim_) {
    const std::size_t corner = corner_of(side);
    geometry::Tetrahedron vertices = cells_[cell_of(side)].vertices;
    vertices[corner] = vertex;
    const Side outside = cells_[cell_of(side)].neighbors[corner];
    last_ = new_cell(vertices);
    cells_[last_].neighbors[corner] = outside;
    side = side_of(last_, corner);
    cells_[cell_of(outside)].neighbors[corner_of(outside)] = side;
  }
  if (rim_.size() <= kSmallRim) {
    link_small_rim();
  } else {
    link_large_rim();
  }
  for (const Index cell : cavity_) {
    cells_[cell].vertices[3] = infinite_;  // marks the cell as not finite
    free_.push_back(cell);
  }
}

/// Links the new cells: two of them are neighbours if their faces in the rim share an edge. A table
/// with a row and a column for each vertex of the rim finds them. An empty entry stands for cell 0,
/// which is never in use, so that writing to it does no harm.
void SmallDelaunay::link_small_rim() {
  std::array<Side, kRimVertices * kRimVertices> table;
  Index labels = 0;
  for (const Side side : rim_) {
    const Cell& cell = cells_[cell_of(side)];
    for (const std::size_t other : kOthers[corner_of(side)]) {
      Index& label = labels_[cell.vertices[other]];
      if (label == kNone) label = labels++;
    }
  }
  std::fill_n(table.begin(), labels * labels, Side{0});
  for (const Side side : rim_) {
    Cell& cell = cells_[cell_of(side)];
    const auto& others = kOthers[corner_of(side)];
    for (std::size_t i = 0; i < 3; ++i) {
      const Index a = labels_[cell.vertices[others[(i + 1) % 3]]];
      const Index b = labels_[cell.vertices[others[(i + 2) % 3]]];
      Side& met = table[std::min(a, b) * labels + std::max(a, b)];
      const Side own = side_of(cell_of(side), others[i]);
      cell.neighbors[others[i]] = met;
      cells_[cell_of(met)].neighbors[corner_of(met)] = own;
      met = own;
    }
  }
  for (const Side side : rim_) {
    for (const Index vertex : cells_[cell_of(side)].vertices) labels_[vertex] = kNone;
  }
}

/// Links the new cells as link_small_rim() does, by sorting the edges of the rim.
void SmallDelaunay::link_large_rim() {
  std::vector<std::pair<std::uint64_t, Side>> edges;
  edges.reserve(3 * rim_.size());
  for (const Side side : rim_) {
    const Cell& cell = cells_[cell_of(side)];
    const auto& others = kOthers[corner_of(side)];
    for (std::size_t i = 0; i < 3; ++i) {
      const Index a = cell.vertices[others[(i + 1) % 3]];
      const Index b = cell.vertices[others[(i + 2) % 3]];
      edges.emplace_back(std::uint64_t{std::min(a, b)} << 32 | std::max(a, b),
                         side_of(cell_of(side), others[i]));
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i + 1 < edges.size(); i += 2) {
    const Side one = edges[i].second;
    const Side other = edges[i + 1].second;
    cells_[cell_of(one)].neighbors[corner_of(one)] = other;
    cells_[cell_of(other)].neighbors[corner_of(other)] = one;
  }
}

bool SmallDelaunay::insert(Index vertex, std::size_t& steps) {
  const Point& p = points_[vertex];
  const Index at = locate(p, steps);
  if (!is_infinite(cells_[at])) {
    for (const Index corner : cells_[at].vertices) {
      if (points_[corner] == p) return false;
    }
  }
  find_conflicts(at, p);
  steps += cavity_.size() + rim_.size();
  fill_cavity(vertex);
  return true;
}

CanonicalDelaunay SmallDelaunay::list() {
  std::vector<geometry::Tetrahedron> tetrahedra;
  std::vector<ListedFace> faces;
  tetrahedra.reserve(cell_count());
  faces.reserve(2 * cell_count());
  for (Index i = 0; i < cells_.size(); ++i) {
    const Cell& cell = cells_[i];
    if (is_infinite(cell)) continue;
    tetrahedra.push_back(cell.vertices);
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const Side across = cell.neighbors[corner];
      const Cell& neighbor = cells_[cell_of(across)];
      if (is_infinite(neighbor)) {
        faces.push_back(face_opposite(cell.vertices, corner, kNone));
      } else if (cell_of(across) > i) {
        faces.push_back(face_opposite(cell.vertices, corner, neighbor.vertices[corner_of(across)]));
      }
    }
  }
  std::vector<Cell>().swap(cells_);  // frees the cells before the sorting, which takes as much
                                     // memory
  return list_canonically(std::move(tetrahedra), std::move(faces), infinite_);
}

Error equal_points() {
  return Error{ErrorCode::invalid_argument,
               "two points of a Delaunay tetrahedralization are equal"};
}

bool has_equal_points(std::vector<Point> points) {
  std::sort(points.begin(), points.end());
  return std::adjacent_find(points.begin(), points.end()) != points.end();
}

/// True if three points lie on one line.
bool is_collinear(const Point& a, const Point& b, const Point& c) {
  const auto turn = [](double ux, double uy, double vx, double vy) {
    // Exact: 62-bit products of integers.
    return static_cast<std::int64_t>(ux) * static_cast<std::int64_t>(vy) ==
           static_cast<std::int64_t>(uy) * static_cast<std::int64_t>(vx);
  };
  return turn(b.x - a.x, b.y - a.y, c.x - a.x, c.y - a.y) &&
         turn(b.y - a.y, b.z - a.z, c.y - a.y, c.z - a.z) &&
         turn(b.z - a.z, b.x - a.x, c.z - a.z, c.x - a.x);
}

/// Moves four points that span a volume to the front of the order. Returns false if there are none.
bool move_simplex_to_front(const SmallDelaunay& delaunay, std::vector<Index>& order) {
  const auto point = [&](std::size_t place) -> const Point& {
    return delaunay.point(order[place]);
  };
  const auto find_next = [&](std::size_t place, auto is_usable) {
    std::size_t found = place;
    while (found < order.size() && !is_usable(point(found))) ++found;
    if (found == order.size()) return false;
    std::rotate(order.begin() + static_cast<std::ptrdiff_t>(place),
                order.begin() + static_cast<std::ptrdiff_t>(found),
                order.begin() + static_cast<std::ptrdiff_t>(found) + 1);
    return true;
  };
  return !order.empty() && find_next(1, [&](const Point& p) { return p != point(0); }) &&
         find_next(2, [&](const Point& p) { return !is_collinear(point(0), point(1), p); }) &&
         find_next(3, [&](const Point& p) {
           return delaunay.signs().orientation(point(0), point(1), point(2), p) != 0;
         });
}

Error too_many(std::uint64_t max_tetrahedra) {
  return Error{ErrorCode::limit_exceeded, "the Delaunay tetrahedralization has more than " +
                                              std::to_string(max_tetrahedra) + " tetrahedra"};
}

}  // namespace

bool is_small_grid(std::span<const Point> points) {
  for (const Point& p : points) {
    for (int axis = 0; axis < 3; ++axis) {
      if (!(std::abs(p[axis]) <= kLargestInteger)) return false;
      if (static_cast<double>(static_cast<std::int64_t>(p[axis])) != p[axis]) return false;
    }
  }
  const Box box = geometry::box_of(points);
  return box.is_empty() || (box.max.x - box.min.x < kSide && box.max.y - box.min.y < kSide &&
                            box.max.z - box.min.z < kSide);
}

Result<CanonicalDelaunay> small_delaunay(std::span<const Point> points,
                                         std::uint64_t max_tetrahedra,
                                         const CancelPoll& is_cancelled) {
  if (points.size() >= kMostCells / 4) {
    return Error{ErrorCode::limit_exceeded, "too many points for a Delaunay tetrahedralization"};
  }
  max_tetrahedra = std::min<std::uint64_t>(max_tetrahedra, kMostCells / 4);
  const Box box = geometry::box_of(points);
  std::vector<Point> relative;
  relative.reserve(points.size());
  for (const Point& p : points) {
    relative.push_back({p.x - box.min.x, p.y - box.min.y, p.z - box.min.z});
  }
  std::vector<Index> order = insertion_order(relative);
  SmallDelaunay delaunay(std::move(relative),
                         {box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z});
  if (!move_simplex_to_front(delaunay, order)) {
    if (has_equal_points({points.begin(), points.end()})) return equal_points();
    return CanonicalDelaunay{};
  }
  const bool is_positive =
      delaunay.signs().orientation(delaunay.point(order[0]), delaunay.point(order[1]),
                                   delaunay.point(order[2]), delaunay.point(order[3])) > 0;
  delaunay.start({order[is_positive ? 0 : 1], order[is_positive ? 1 : 0], order[2], order[3]});
  Cancellation cancellation(is_cancelled);
  for (std::size_t i = 4; i < order.size(); ++i) {
    std::size_t steps = 0;
    if (!delaunay.insert(order[i], steps)) return equal_points();
    // The count includes infinite cells: at most about as many as finite cells and 2 n.
    if (delaunay.cell_count() / 2 > max_tetrahedra) return too_many(max_tetrahedra);
    if (cancellation.is_due_and_wanted(steps)) {
      return Error{ErrorCode::cancelled, "cancelled by the caller"};
    }
  }
  CanonicalDelaunay result = delaunay.list();
  if (result.tetrahedra.size() > max_tetrahedra) return too_many(max_tetrahedra);
  return result;
}

}  // namespace watertight::delaunay
