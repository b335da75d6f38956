// SPDX-License-Identifier: GPL-3.0-or-later
#include "spline/knot_clouds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <utility>

#include "geometry/predicates/turn.h"

namespace watertight::spline {
namespace {

constexpr int kTriesAtARadius = 50;
constexpr int kMostHalvings = 20;

Point minus(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y, 0}; }
double cross(const Point& a, const Point& b) { return a.x * b.y - a.y * b.x; }
double length(const Point& a) { return std::sqrt(a.x * a.x + a.y * a.y); }

/// Numbers that are the same on every machine.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// From low to high.
  double between(double low, double high) {
    constexpr double kStep = 1.0 / 9007199254740992.0;
    return low + (high - low) * (static_cast<double>(engine_() >> 11U) * kStep);
  }

  /// Of length 1.
  Point direction() {
    for (;;) {
      const Point p{between(-1, 1), between(-1, 1), 0};
      const double size = length(p);
      if (size > 0.1 && size <= 1) return {p.x / size, p.y / size, 0};
    }
  }

 private:
  std::mt19937_64 engine_;
};

/// The directions between two, counter-clockwise from the first, at most half a turn.
class Sector {
 public:
  /// Left of a direction.
  explicit Sector(const Point& along) : from_(along), to_{-along.x, -along.y, 0} {}

  /// Keeps what is left of a direction too; false if that is nothing.
  bool cut(const Point& along) {
    const double from_side = cross(along, from_);
    const double to_side = cross(along, to_);
    if (from_side == 0 && to_side == 0) return along.x * from_.x + along.y * from_.y > 0;
    if (from_side <= 0 && to_side <= 0) return false;
    if (from_side < 0) from_ = along;
    if (to_side < 0) to_ = {-along.x, -along.y, 0};
    return true;
  }

  Point any(Random& random) const {
    const double from_size = length(from_);
    const double to_size = length(to_);
    const Point from{from_.x / from_size, from_.y / from_size, 0};
    const Point to{to_.x / to_size, to_.y / to_size, 0};
    const double share = random.between(0.2, 0.8);
    Point chosen{from.x + share * (to.x - from.x), from.y + share * (to.y - from.y), 0};
    if (from.x * to.x + from.y * to.y < -0.5) {  // wide: over the direction in the middle
      chosen.x += to.y - from.y;
      chosen.y += from.x - to.x;
    }
    const double size = length(chosen);
    return {chosen.x / size, chosen.y / size, 0};
  }

 private:
  Point from_;
  Point to_;
};

struct OtherCorners {
  Index second;
  Index third;
};

class CloudMaker {
 public:
  CloudMaker(std::span<const Point> vertices, std::span<const Triangle> triangles,
             std::span<const Point> fixed, std::span<const SideRule> rules,
             const CloudOptions& options)
      : vertices_(vertices.begin(), vertices.end()),
        degree_(static_cast<std::size_t>(options.degree)),
        options_(options),
        random_(options.seed),
        around_(vertices.size()),
        rules_(vertices.size()),
        placed_(vertices.size(), 0),
        clouds_(vertices.size() * degree_) {
    std::ranges::copy(fixed, clouds_.begin());
    std::fill_n(placed_.begin(), fixed.size() / degree_, degree_);
    for (const Triangle& t : triangles) {
      for (std::size_t j = 0; j < 3; ++j) around_[t[j]].push_back({t[(j + 1) % 3], t[(j + 2) % 3]});
    }
    find_borders(triangles);
    for (const SideRule& rule : rules) rules_[rule.vertex].push_back({rule.from, rule.to});
  }

  Result<std::vector<Point>> make() {
    for (Index vertex = 0; vertex < vertices_.size(); ++vertex) {
      while (placed_[vertex] < degree_) {
        if (!place_next(vertex)) {
          return Error{ErrorCode::malformed,
                       "the knots of vertex " + std::to_string(vertex) + " find no place"};
        }
      }
    }
    return std::move(clouds_);
  }

  Result<std::vector<Point>> move_vertices() {
    for (Index vertex = 0; vertex < vertices_.size(); ++vertex) {
      if (placed_[vertex] > 0 || !rules_[vertex].empty() || move_off_lines(vertex)) continue;
      return Error{ErrorCode::malformed,
                   "vertex " + std::to_string(vertex) + " is near a line through two knots"};
    }
    return std::move(vertices_);
  }

 private:
  struct Line {
    Point from;
    Point to;
  };

  /// Border edges have a triangle on their left side only; knots go to the right.
  void find_borders(std::span<const Triangle> triangles) {
    std::set<std::pair<Index, Index>> edges;
    for (const Triangle& t : triangles) {
      for (std::size_t j = 0; j < 3; ++j) edges.emplace(t[j], t[(j + 1) % 3]);
    }
    for (const auto& [a, b] : edges) {
      if (edges.contains({b, a})) continue;
      for (const Index vertex : {a, b}) rules_[vertex].push_back({vertices_[b], vertices_[a]});
    }
  }

  const Point& knot(Index vertex, std::size_t l) const {
    return l == 0 ? vertices_[vertex] : clouds_[vertex * degree_ + l - 1];
  }

  std::optional<Sector> sector_of(Index vertex) const {
    std::optional<Sector> sector;
    for (const Line& line : rules_[vertex]) {
      const Point along = minus(line.to, line.from);
      if (!sector) {
        sector.emplace(along);
      } else if (!sector->cut(along)) {
        return std::nullopt;
      }
    }
    return sector;
  }

  double shortest_edge(Index vertex) const {
    double shortest = 0;
    for (const auto& [second, third] : around_[vertex]) {
      for (const Index other : {second, third}) {
        const double own = length(minus(vertices_[other], vertices_[vertex]));
        if (shortest == 0 || own < shortest) shortest = own;
      }
    }
    return shortest > 0 ? shortest : 1;  // a vertex of no triangle: its knots are in no function
  }

  bool place_next(Index vertex) {
    const std::optional<Sector> sector = sector_of(vertex);
    if (!sector && !rules_[vertex].empty()) return false;
    const std::size_t l = placed_[vertex] + 1;
    double radius = options_.radius * shortest_edge(vertex) * static_cast<double>(l) /
                    static_cast<double>(degree_);
    double clearance = options_.clearance;
    for (int halving = 0; halving <= kMostHalvings; ++halving, radius /= 2, clearance /= 2) {
      for (int attempt = 0; attempt < kTriesAtARadius; ++attempt) {
        const Point direction = sector ? sector->any(random_) : random_.direction();
        const Point& center = vertices_[vertex];
        const Point place{center.x + radius * direction.x, center.y + radius * direction.y, 0};
        if (!obeys_rules(vertex, place) || !keeps_triangles(vertex, place) ||
            is_near_a_line(vertex, l, place, clearance * radius))
          continue;
        clouds_[vertex * degree_ + l - 1] = place;
        placed_[vertex] = l;
        return true;
      }
    }
    return false;
  }

  bool move_off_lines(Index vertex) {
    constexpr double kFarthest = 0.05;  // of the shortest edge
    const Point old = vertices_[vertex];
    const double shortest = shortest_edge(vertex);
    const double least = options_.clearance * options_.radius * shortest;
    for (int attempt = 0; attempt < kTriesAtARadius; ++attempt) {
      const Point& place = vertices_[vertex];
      if (keeps_triangles(vertex, place) && !is_near_a_line(vertex, 0, place, least)) return true;
      const Point direction = random_.direction();
      const double way = random_.between(0, kFarthest) * shortest;
      vertices_[vertex] = {old.x + way * direction.x, old.y + way * direction.y, 0};
    }
    return false;
  }

  bool obeys_rules(Index vertex, const Point& place) const {
    return std::ranges::all_of(rules_[vertex], [&](const Line& line) {
      return geometry::turn(line.from, line.to, place) > 0;
    });
  }

  bool keeps_triangles(Index vertex, const Point& place) const {
    for (const auto& [second, third] : around_[vertex]) {
      for (std::size_t j = 0; j <= placed_[second]; ++j) {
        for (std::size_t k = 0; k <= placed_[third]; ++k) {
          if (geometry::turn(place, knot(second, j), knot(third, k)) <= 0) return false;
        }
      }
    }
    return true;
  }

  /// Whether a place for knot l is near a line through two knots with which it is in a function:
  /// the numbers of the last knots of the three corners sum up to at most the degree.
  bool is_near_a_line(Index vertex, std::size_t l, const Point& place, double distance) const {
    const auto is_near = [&](const Point& a, const Point& b) {
      return std::abs(twice_area(a, b, place)) < distance * length(minus(b, a));
    };
    for (std::size_t i = 0; i < l; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (is_near(knot(vertex, i), knot(vertex, j))) return true;
      }
    }
    for (const auto& [second, third] : around_[vertex]) {
      for (const Index other : {second, third}) {
        for (std::size_t j = 0; j <= placed_[other] && l + j <= degree_; ++j) {
          for (std::size_t i = 0; i < l; ++i) {
            if (is_near(knot(vertex, i), knot(other, j))) return true;
          }
          for (std::size_t i = 0; i < j; ++i) {
            if (is_near(knot(other, i), knot(other, j))) return true;
          }
        }
      }
      for (std::size_t j = 0; j <= placed_[second]; ++j) {
        for (std::size_t k = 0; k <= placed_[third] && l + j + k <= degree_; ++k) {
          if (is_near(knot(second, j), knot(third, k))) return true;
        }
      }
    }
    return false;
  }

  std::vector<Point> vertices_;
  std::size_t degree_;
  const CloudOptions& options_;
  Random random_;
  std::vector<std::vector<OtherCorners>> around_;
  std::vector<std::vector<Line>> rules_;
  std::vector<std::size_t> placed_;  // further knots that each vertex has
  std::vector<Point> clouds_;
};

Status check_input(std::span<const Point> vertices, std::span<const Triangle> triangles,
                   std::span<const Point> fixed, std::span<const SideRule> rules, int degree) {
  const bool is_degree_known = degree >= 1 && degree <= kMostDegree;
  if (!is_degree_known || fixed.size() % static_cast<std::size_t>(degree) != 0 ||
      fixed.size() / static_cast<std::size_t>(degree) > vertices.size()) {
    return Error{ErrorCode::malformed,
                 "the knots that are given do not fit the degree and the vertices"};
  }
  const auto is_there = [&](Index vertex) { return vertex < vertices.size(); };
  if (!std::ranges::all_of(rules, is_there, &SideRule::vertex)) {
    return Error{ErrorCode::malformed, "a rule is for a vertex that is not there"};
  }
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (std::ranges::all_of(triangles[t], is_there)) continue;
    return Error{ErrorCode::malformed,
                 "triangle " + std::to_string(t) + " has a corner that is no vertex"};
  }
  return Done{};
}

}  // namespace

Result<std::vector<Point>> make_clouds(std::span<const Point> vertices,
                                       std::span<const Triangle> triangles,
                                       std::span<const Point> fixed,
                                       std::span<const SideRule> rules,
                                       const CloudOptions& options) {
  if (Status checked = check_input(vertices, triangles, fixed, rules, options.degree); !checked)
    return checked.error();
  return CloudMaker(vertices, triangles, fixed, rules, options).make();
}

Result<std::vector<Point>> move_off_lines(std::span<const Point> vertices,
                                          std::span<const Triangle> triangles,
                                          std::span<const Point> fixed,
                                          const CloudOptions& options) {
  if (Status checked = check_input(vertices, triangles, fixed, {}, options.degree); !checked)
    return checked.error();
  return CloudMaker(vertices, triangles, fixed, {}, options).move_vertices();
}

}  // namespace watertight::spline
