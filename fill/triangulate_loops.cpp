// SPDX-License-Identifier: GPL-3.0-or-later
#include "fill/triangulate_loops.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "delaunay/canonical_delaunay.h"
#include "fill/optimum.h"
#include "geometry/predicates/predicates.h"

namespace watertight::fill {
namespace {

using Triples = std::vector<std::array<Vertex, 3>>;

constexpr std::size_t kMostVertices = 65'000;
constexpr std::size_t kBytesPerTriangle = 24;  // of candidates, with their list

Error invalid(std::string message) { return {ErrorCode::invalid_argument, std::move(message)}; }

/// The points of the loops, sorted; a vertex is a place in this list.
struct Sorted {
  std::vector<Index> points;               // vertex -> point
  std::vector<Point> places;               // vertex -> coordinates
  std::vector<std::vector<Vertex>> loops;  // each from its smallest vertex on, sorted
  std::vector<std::size_t> loop_of;        // sorted loop -> loop
};

bool are_finite(const Point& point) {
  return std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z);
}

Status check(std::span<const Point> points, std::span<const Loop> loops,
             const FillOptions& options) {
  if (loops.empty()) return invalid("a filling needs a loop");
  if (loops.size() > kMostLoops) {
    return Error{ErrorCode::limit_exceeded, "a hole of more than 6 loops is not filled optimally"};
  }
  std::size_t count = 0;
  for (const Loop& loop : loops) {
    if (loop.size() < 3) return invalid("a loop has fewer than 3 points");
    const bool is_in_range =
        std::ranges::all_of(loop, [&](Index point) { return point < points.size(); });
    if (!is_in_range) return invalid("a loop names a point that does not exist");
    const bool is_finite =
        std::ranges::all_of(loop, [&](Index point) { return are_finite(points[point]); });
    if (!is_finite) return invalid("a coordinate is not a finite number");
    count += loop.size();
  }
  if (count > kMostVertices) {
    return Error{ErrorCode::limit_exceeded, "a hole of more than 65,000 points is not filled"};
  }
  const bool has_facets = !options.behind.empty();
  for (std::size_t i = 0; i < loops.size() && has_facets; ++i) {
    if (options.behind.size() != loops.size() || options.behind[i].size() != loops[i].size()) {
      return invalid("the facets behind the loops do not match their edges");
    }
    const bool is_finite = std::ranges::all_of(options.behind[i], [](const geometry::Vector3& v) {
      return are_finite({v[0], v[1], v[2]});
    });
    if (!is_finite) return invalid("the direction of a facet is not finite");
  }
  return Done{};
}

bool are_on_one_line(std::span<const Point> places) {
  return std::ranges::all_of(places, [&](const Point& place) {
    return place == places[0] || place == places[1] ||
           geometry::are_collinear(places[0], places[1], place);
  });
}

Result<Sorted> sorted(std::span<const Point> points, std::span<const Loop> loops) {
  Sorted result;
  for (const Loop& loop : loops) {
    result.points.insert(result.points.end(), loop.begin(), loop.end());
  }
  std::ranges::sort(result.points, {}, [&](Index point) { return points[point]; });
  for (const Index point : result.points) {
    if (!result.places.empty() && result.places.back() == points[point]) {
      return invalid("a point is twice in the loops");
    }
    result.places.push_back(points[point]);
  }
  if (are_on_one_line(result.places)) return invalid("the points of the loops are on one line");
  std::vector<std::pair<std::vector<Vertex>, std::size_t>> numbered;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    std::vector<Vertex> vertices;
    for (const Index point : loops[i]) {
      const auto found = std::ranges::lower_bound(result.places, points[point]);
      vertices.push_back(static_cast<Vertex>(found - result.places.begin()));
    }
    std::rotate(vertices.begin(), std::ranges::min_element(vertices), vertices.end());
    numbered.emplace_back(std::move(vertices), i);
  }
  std::ranges::sort(numbered);
  for (auto& [vertices, loop] : numbered) {
    result.loops.push_back(std::move(vertices));
    result.loop_of.push_back(loop);
  }
  return result;
}

Borders borders_of(const Sorted& sorted, std::span<const Point> points, std::span<const Loop> loops,
                   const FillOptions& options) {
  Borders borders;
  const std::size_t n = sorted.places.size();
  for (const Point& place : sorted.places) {
    geometry::Vector3 metres = geometry::difference(place, sorted.places[0]);
    for (std::size_t axis = 0; axis < 3; ++axis) metres[axis] *= options.metres_per_unit[axis];
    borders.places.push_back(metres);
  }
  borders.next.resize(n);
  borders.loop.resize(n);
  borders.position.resize(n);
  borders.behind.resize(n);
  for (std::size_t i = 0; i < sorted.loops.size(); ++i) {
    const std::vector<Vertex>& vertices = sorted.loops[i];
    borders.lengths.push_back(static_cast<std::uint32_t>(vertices.size()));
    for (std::size_t at = 0; at < vertices.size(); ++at) {
      borders.next[vertices[at]] = vertices[(at + 1) % vertices.size()];
      borders.loop[vertices[at]] = static_cast<std::uint8_t>(i);
      borders.position[vertices[at]] = static_cast<std::uint32_t>(at);
    }
    if (options.behind.empty()) continue;
    const Loop& loop = loops[sorted.loop_of[i]];
    for (std::size_t at = 0; at < loop.size(); ++at) {
      const auto found = std::ranges::lower_bound(sorted.places, points[loop[at]]);
      const auto vertex = static_cast<std::size_t>(found - sorted.places.begin());
      borders.behind[vertex] = options.behind[sorted.loop_of[i]][at];
    }
  }
  return borders;
}

bool may_use(const Sorted& sorted, const std::array<Vertex, 3>& triple,
             const FillOptions& options) {
  if (!options.is_allowed) return true;
  const auto& [a, b, c] = triple;
  return options.is_allowed({sorted.points[a], sorted.points[b], sorted.points[c]});
}

Result<Triples> all_triples(const Sorted& sorted, const FillOptions& options) {
  const std::size_t n = sorted.places.size();
  if (n * (n - 1) * (n - 2) / 6 * kBytesPerTriangle > options.max_bytes) {
    return Error{ErrorCode::limit_exceeded, "the hole is too large for all triangles"};
  }
  Triples triples;
  for (std::size_t a = 0; a < n; ++a) {
    if (options.is_cancelled && options.is_cancelled()) {
      return Error{ErrorCode::cancelled, "the filling of a hole was cancelled"};
    }
    for (std::size_t b = a + 1; b < n; ++b) {
      for (std::size_t c = b + 1; c < n; ++c) {
        if (geometry::are_collinear(sorted.places[a], sorted.places[b], sorted.places[c])) continue;
        const std::array<Vertex, 3> triple{static_cast<Vertex>(a), static_cast<Vertex>(b),
                                           static_cast<Vertex>(c)};
        if (may_use(sorted, triple, options)) triples.push_back(triple);
      }
    }
  }
  return triples;
}

Result<Triples> delaunay_triples(const Sorted& sorted, const FillOptions& options) {
  const std::uint64_t most_tetrahedra = options.max_bytes / kBytesPerTriangle;
  auto delaunay =
      delaunay::canonical_delaunay(sorted.places, most_tetrahedra, options.is_cancelled);
  if (!delaunay) return std::move(delaunay).error();
  Triples triples;
  for (const Triangle& face : delaunay->faces) {
    const std::array<Vertex, 3> triple{static_cast<Vertex>(face[0]), static_cast<Vertex>(face[1]),
                                       static_cast<Vertex>(face[2])};
    if (may_use(sorted, triple, options)) triples.push_back(triple);
  }
  return triples;
}

/// The hole without one edge of a loop: the one with the fewest candidates. Nothing if an edge of a
/// loop has none.
std::optional<Domain> start_of(const Borders& borders, const Candidates& candidates) {
  std::optional<Span> best;
  for (std::size_t vertex = 0; vertex < borders.size(); ++vertex) {
    const auto tail = static_cast<Vertex>(vertex);
    const Vertex head = borders.next[vertex];
    const EdgeNumber edge = candidates.edge(tail, head);
    if (edge == kNoEdge) return std::nullopt;
    if (best && candidates.thirds(best->edge).size() <= candidates.thirds(edge).size()) continue;
    best = Span{tail, head, kNoVertex, Sense::forward, edge};
  }
  Domain start;
  start.size = 1;
  start.spans[0] = *best;
  const unsigned all = (1U << borders.lengths.size()) - 1;
  start.untouched = static_cast<std::uint8_t>(all & ~(1U << borders.loop[best->tail]));
  return start;
}

/// Sums up angles and areas of a filling.
void measure(const Borders& borders, const Candidates& candidates,
             std::span<const std::array<Vertex, 3>> triangles, LoopFill& fill) {
  std::map<EdgeNumber, Turn> open;
  std::uint64_t angles = 0;
  std::uint64_t areas = 0;
  const auto add = [&](EdgeNumber edge, Turn turn) {
    const auto [other, is_first] = open.emplace(edge, turn);
    if (!is_first) angles += turn_between(other->second + kHalfTurn, turn);
  };
  for (const auto& triangle : triangles) {
    areas += candidates.area(triangle[0], triangle[1], triangle[2]);
    for (std::size_t i = 0; i < 3; ++i) {
      const Vertex a = triangle[i];
      const Vertex b = triangle[(i + 1) % 3];
      const EdgeNumber edge = candidates.edge(a, b);
      add(edge, candidates.turn(edge, a, b, triangle[(i + 2) % 3]));
    }
  }
  for (std::size_t vertex = 0; vertex < borders.size(); ++vertex) {
    if (borders.behind[vertex] == geometry::Vector3{}) continue;
    const EdgeNumber edge = candidates.edge(static_cast<Vertex>(vertex), borders.next[vertex]);
    add(edge, candidates.turn_of(edge, borders.behind[vertex]));
  }
  fill.angle = radians(angles);
  fill.area = static_cast<double>(areas) * candidates.area_unit();
}

}  // namespace

Result<LoopFill> triangulate_loops(std::span<const Point> points, std::span<const Loop> loops,
                                   const FillOptions& options) {
  if (const Status status = check(points, loops, options); !status) return status.error();
  auto vertices = sorted(points, loops);
  if (!vertices) return std::move(vertices).error();
  const Borders borders = borders_of(*vertices, points, loops, options);
  auto triples = options.space == CandidateSpace::all ? all_triples(*vertices, options)
                                                      : delaunay_triples(*vertices, options);
  if (!triples) return std::move(triples).error();
  const Candidates candidates(borders, *triples);
  LoopFill fill;
  fill.candidates = triples->size();
  *triples = {};
  const std::optional<Domain> start = start_of(borders, candidates);
  if (!start) {
    return Error{ErrorCode::not_found, "no candidate triangle has one of the edges of the hole"};
  }
  const bool has_angles = options.objective == Objective::angle;
  Optimum optimum(borders, candidates, {options.has_both_senses, has_angles},
                  options.keeps_all_sets);
  const std::size_t own_bytes = std::min(candidates.bytes(), options.max_bytes);
  auto triangles = optimum.triangulate(
      *start, {options.max_domains, options.max_bytes - own_bytes, options.is_cancelled});
  if (!triangles) return std::move(triangles).error();
  WATERTIGHT_ASSERT(triangles->size() == borders.size() + 2 * loops.size() - 4);
  measure(borders, candidates, *triangles, fill);
  fill.domains = optimum.table().domain_count();
  fill.weak_sets = optimum.table().set_count();
  fill.bytes = candidates.bytes() + optimum.table().bytes();
  for (const auto& [a, b, c] : *triangles) {
    Triangle& triangle = fill.triangles.emplace_back();
    triangle = {vertices->points[a], vertices->points[b], vertices->points[c]};
    std::rotate(triangle.begin(), std::ranges::min_element(triangle), triangle.end());
  }
  std::ranges::sort(fill.triangles);
  return fill;
}

}  // namespace watertight::fill
