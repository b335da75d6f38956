// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/unit/spline/scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "geometry/lattice/lattice.h"
#include "spline/extend_triangulation.h"
#include "spline/fit_surface.h"
#include "spline/knot_clouds.h"

namespace watertight::samples {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

double length(const Point& p) { return std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z); }
Point minus(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

Polygon circle(int edges, double radius, const Point& center = {}) {
  Polygon polygon;
  for (int i = 0; i < edges; ++i) {
    const double angle = kTurn * i / edges;
    polygon.push_back(
        {center.x + radius * std::cos(angle), center.y + radius * std::sin(angle), 0});
  }
  return polygon;
}

/// The points of an edge but its last one.
void append_edge(Polygon& polygon, const Point& from, const Point& to, int parts) {
  for (int i = 0; i < parts; ++i) {
    const double share = static_cast<double>(i) / parts;
    polygon.push_back({from.x + share * (to.x - from.x), from.y + share * (to.y - from.y), 0});
  }
}

/// Places in a triangle, on its border and inside.
void append_samples(const spline::DomainArrays& arrays, Index triangle,
                    const Scene::Embedding& embedding, std::vector<spline::FitPoint>& points) {
  constexpr int kSteps = 5;
  const auto& [a, b, c] = arrays.triangles[triangle];
  const Point& p = arrays.vertices[a];
  const Point& q = arrays.vertices[b];
  const Point& r = arrays.vertices[c];
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; i + j <= kSteps; ++j) {
      const double s = static_cast<double>(i) / kSteps;
      const double t = static_cast<double>(j) / kSteps;
      const Point u{p.x + s * (q.x - p.x) + t * (r.x - p.x),
                    p.y + s * (q.y - p.y) + t * (r.y - p.y), 0};
      points.push_back({triangle, u, embedding(u)});
    }
  }
}

std::vector<Point> places_at(const Polygon& polygon, const Scene::Embedding& embedding) {
  std::vector<Point> places;
  for (const Point& u : polygon) places.push_back(embedding(u));
  return places;
}

/// The walls from a border down to a height, and nothing else. The border runs as seen from above,
/// counter-clockwise.
void append_walls(const std::vector<Point>& border, double height,
                  std::vector<std::vector<std::vector<Point>>>& facets) {
  for (std::size_t i = 0; i < border.size(); ++i) {
    const Point& a = border[i];
    const Point& b = border[(i + 1) % border.size()];
    facets.push_back({{{a.x, a.y, height}, {b.x, b.y, height}, b, a}});
  }
}

std::vector<Point> at_height(std::vector<Point> places, double height) {
  for (Point& p : places) p.z = height;
  return places;
}

std::vector<Point> reversed(std::vector<Point> places) {
  std::ranges::reverse(places);
  return places;
}

/// A pipe around an island: its ring in the plane lies between two radii around a centre, and the
/// outer circle of the ring is its end at `start`, the inner one that at `start` + `height`.
struct Pipe {
  Point center;
  double radius = 0.5;
  double start = 0;
  double height = 0;

  static constexpr double kOuter = 0.55;
  static constexpr double kInner = 0.35;
  static constexpr int kEdges = 20;

  Polygon outer() const { return circle(kEdges, kOuter, center); }
  Polygon inner() const { return circle(kEdges, kInner, center); }
  Point operator()(const Point& u) const {
    const Point way = minus(u, center);
    const double distance = length(way);
    const double share = (kOuter - distance) / (kOuter - kInner);
    return {center.x + radius * way.x / distance, center.y + radius * way.y / distance,
            start + height * share};
  }
  /// The end on a plane exactly.
  std::vector<Point> end() const { return at_height(places_at(inner(), *this), start + height); }
};

}  // namespace

Status Scene::add_triangles(std::span<const Polygon> polygons, double density) {
  spline::ExtendOptions options;
  options.density = density;
  const auto mesh = spline::extend_triangulation(polygons, options);
  if (!mesh) return mesh.error();
  std::map<Point, Index> number_of;
  for (Index v = 0; v < arrays_.vertices.size(); ++v) number_of.emplace(arrays_.vertices[v], v);
  std::vector<Index> numbers;
  for (const Point& place : mesh->vertices) {
    const auto [found, is_new] =
        number_of.emplace(place, static_cast<Index>(arrays_.vertices.size()));
    if (is_new) arrays_.vertices.push_back(place);
    numbers.push_back(found->second);
  }
  for (const auto& [a, b, c] : mesh->triangles)
    arrays_.triangles.push_back({numbers[a], numbers[b], numbers[c]});
  return Done{};
}

Status Scene::add_old(std::span<const Polygon> polygons, const Embedding& embedding) {
  if (Status added = add_triangles(polygons, 1); !added) return added;
  embedding_of_.resize(arrays_.triangles.size(), embeddings_.size());
  embeddings_.push_back(embedding);
  old_triangles_ = arrays_.triangles.size();
  return Done{};
}

Status Scene::fit(std::span<const FreeBorder> free_borders) {
  std::vector<spline::SideRule> rules;
  for (const auto& [from, to] : free_borders) {
    for (const Index vertex : numbers_of({from, to})) rules.push_back({vertex, from, to});
  }
  auto clouds = spline::make_clouds(arrays_.vertices, arrays_.triangles, {}, rules);
  if (!clouds) return std::move(clouds).error();
  arrays_.clouds = *std::move(clouds);
  const auto old = domain();
  if (!old) return old.error();
  std::vector<spline::FitPoint> points;
  for (Index t = 0; t < old_triangles_; ++t)
    append_samples(arrays_, t, embeddings_[embedding_of_[t]], points);
  auto fitted = spline::fit_surface(*old, points);
  if (!fitted) return std::move(fitted).error();
  coefficients_ = std::move(fitted->coefficients);
  fit_distance_ = fitted->largest_distance;
  return Done{};
}

Status Scene::add_hole(std::span<const Polygon> polygons, double density) {
  FilledHole hole;
  const std::size_t before = arrays_.triangles.size();
  const std::vector<Point> old_clouds = arrays_.clouds;
  if (Status added = add_triangles(polygons, density); !added) return added;
  for (std::size_t t = before; t < arrays_.triangles.size(); ++t)
    hole.triangles.push_back(static_cast<Index>(t));
  auto moved = spline::move_off_lines(arrays_.vertices, arrays_.triangles, old_clouds);
  if (!moved) return std::move(moved).error();
  arrays_.vertices = *std::move(moved);
  auto clouds = spline::make_clouds(arrays_.vertices, arrays_.triangles, old_clouds);
  if (!clouds) return std::move(clouds).error();
  arrays_.clouds = *std::move(clouds);
  const auto whole = domain();
  if (!whole) return whole.error();
  coefficients_.resize(whole->function_count());
  auto plate = spline::least_thin_plate(*whole, hole.triangles, coefficients_);
  if (!plate) return std::move(plate).error();
  coefficients_ = plate->coefficients;
  hole.plate = *std::move(plate);
  holes_.push_back(std::move(hole));
  return Done{};
}

std::vector<Point> Scene::places() const {
  std::vector<Point> places(arrays_.vertices.size());
  std::vector<bool> is_known(places.size(), false);
  for (std::size_t t = 0; t < old_triangles_; ++t) {
    for (const Index v : arrays_.triangles[t]) {
      places[v] = embeddings_[embedding_of_[t]](arrays_.vertices[v]);
      is_known[v] = true;
    }
  }
  const auto whole = domain();
  spline::BasisEvaluator evaluator(*whole);
  for (Index t = 0; t < arrays_.triangles.size(); ++t) {
    for (const Index v : arrays_.triangles[t]) {
      if (is_known[v]) continue;
      is_known[v] = true;
      places[v] =
          spline::sum_of(evaluator.in_triangle(t, arrays_.vertices[v]), coefficients_).value;
    }
  }
  return places;
}

std::vector<Index> Scene::numbers_of(const Polygon& polygon) const {
  std::vector<Index> numbers;
  for (const Point& u : polygon) {
    const auto found = std::ranges::find(arrays_.vertices, u);
    numbers.push_back(static_cast<Index>(found - arrays_.vertices.begin()));
  }
  return numbers;
}

Result<ClosedScene> cone_cap(int edges) {
  ClosedScene closed{"cone cap", {}, {}};
  const Polygon outer = circle(2 * edges, 2);
  const Polygon inner = circle(edges, 1);
  const auto cone = [](const Point& u) { return Point{u.x, u.y, 2 - length(u)}; };
  Status made = closed.scene.add_old(std::vector<Polygon>{outer, inner}, cone);
  if (made) made = closed.scene.fit();
  if (made) made = closed.scene.add_hole(std::vector<Polygon>{inner});
  if (!made) return std::move(made).error();
  const std::vector<Point> rim = at_height(places_at(outer, cone), 0);
  append_walls(rim, -1, closed.closing);
  closed.closing.push_back({reversed(at_height(rim, -1))});
  return closed;
}

namespace {

/// A rectangle whose near side is turned towards the origin, tilted about the line through its
/// point nearest to the origin.
struct Tilted {
  double direction = 0;  // in which it lies, an angle
  double near = 0;       // distance of that line
  double slope = 0;      // an angle; positive falls

  Point at(double along, double across) const {
    return {along * std::cos(direction) - across * std::sin(direction),
            along * std::sin(direction) + across * std::cos(direction), 0};
  }
  Point operator()(const Point& u) const {
    const double along = u.x * std::cos(direction) + u.y * std::sin(direction);
    const double across = u.y * std::cos(direction) - u.x * std::sin(direction);
    Point p = at(near + (along - near) * std::cos(slope), across);
    p.z = -(along - near) * std::sin(slope);
    return p;
  }
};

constexpr int kSideParts = 6;
constexpr int kNearParts = 5;

/// The pieces of the border of a rectangle: its near side, its far one and those between, which run
/// away from the origin on the right and towards it on the left.
struct Sides {
  Polygon right;  // from near to far, both ends
  Polygon far;    // from right to left, likewise
  Polygon left;   // from far to near
  Polygon near;   // from left to right; a single point where a corner is near

  Polygon border() const {
    Polygon all;
    for (const Polygon* side : {&right, &far, &left, &near})
      all.insert(all.end(), side->begin(), side->end() - (side->size() > 1 ? 1 : 0));
    if (near.size() == 1) all.pop_back();  // it is the first point too
    return all;
  }
};

Polygon edge(const Point& from, const Point& to, int parts) {
  Polygon points;
  append_edge(points, from, to, parts);
  points.push_back(to);
  return points;
}

Sides rectangle(const Tilted& place, double width, double depth) {
  const double half = width / 2;
  const Point a = place.at(place.near, -half);
  const Point b = place.at(place.near + depth, -half);
  const Point c = place.at(place.near + depth, half);
  const Point d = place.at(place.near, half);
  return {edge(a, b, kSideParts), edge(b, c, kNearParts), edge(c, d, kSideParts),
          edge(d, a, kNearParts)};
}

/// A square with a corner towards the origin. Its far side is the two sides that meet in the far
/// corner.
Sides corner(const Tilted& place, double side) {
  const double half = side / std::numbers::sqrt2;
  const Point a = place.at(place.near, 0);
  const Point b = place.at(place.near + half, -half);
  const Point c = place.at(place.near + 2 * half, 0);
  const Point d = place.at(place.near + half, half);
  Sides sides{edge(a, b, kSideParts), edge(b, c, kSideParts), edge(d, a, kSideParts), {a}};
  sides.far.pop_back();
  append_edge(sides.far, c, d, kSideParts);
  sides.far.push_back(d);
  return sides;
}

Polygon reversed_polygon(Polygon polygon) {
  std::ranges::reverse(polygon);
  return polygon;
}

/// The blend between the left side of one piece and the right side of the next one,
/// counter-clockwise; `outer` and `inner` get its free sides, ends included.
Result<Polygon> blend_between(const Sides& one, const Sides& next, Polygon& outer, Polygon& inner) {
  const Polygon away = reversed_polygon(one.left);    // from near to far
  const Polygon back = reversed_polygon(next.right);  // from far to near
  auto border = spline::complete_boundary(std::vector<Polygon>{back, away});
  if (!border) return border;
  // The pieces come in their order: back, the near side, away, the far side.
  const auto end_of_back = border->begin() + static_cast<std::ptrdiff_t>(back.size()) - 1;
  const auto start_of_away = std::ranges::find(*border, away.front());
  const auto end_of_away = start_of_away + static_cast<std::ptrdiff_t>(away.size()) - 1;
  inner.assign(end_of_back, start_of_away + 1);
  outer.assign(end_of_away, border->end());
  outer.push_back(border->front());
  return border;
}

}  // namespace

Result<ClosedScene> five_sided_hole() {
  ClosedScene closed{"five-sided hole", {}, {}};
  Scene& scene = closed.scene;
  constexpr double kAside = kTurn * 105 / 360;
  const std::array<Tilted, 3> places{
      {{kTurn / 4, 1, -0.8}, {kTurn / 4 + kAside, 1, 0.8}, {kTurn / 4 - kAside, 1, 0.8}}};
  const std::array<Sides, 3> sides{corner(places[0], 1.6), rectangle(places[1], 1.6, 2),
                                   rectangle(places[2], 1.6, 2)};
  for (std::size_t i = 0; i < 3; ++i) {
    if (Status added = scene.add_old(std::vector<Polygon>{sides[i].border()}, places[i]); !added)
      return std::move(added).error();
  }
  std::vector<Scene::FreeBorder> free_borders;
  for (std::size_t i = 0; i < 3; ++i) {
    const Sides& next = sides[(i + 1) % 3];
    free_borders.push_back({sides[i].left.back(), next.right.front()});
    free_borders.push_back({next.right.back(), sides[i].left.front()});
  }
  if (Status fitted = scene.fit(free_borders); !fitted) return std::move(fitted).error();
  std::array<Polygon, 3> outer;
  std::array<Polygon, 3> inner;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto border = blend_between(sides[i], sides[(i + 1) % 3], outer[i], inner[i]);
    if (!border) return border.error();
    if (Status added = scene.add_hole(std::vector<Polygon>{*border}); !added)
      return std::move(added).error();
  }
  // The hole runs along the near side of each piece and the inner side of each blend.
  Polygon hole;
  Polygon around;
  for (std::size_t i = 0; i < 3; ++i) {
    const Polygon near = reversed_polygon(sides[i].near);
    hole.insert(hole.end(), near.begin(), near.end() - (near.size() > 1 ? 1 : 0));
    const Polygon side = reversed_polygon(inner[i]);
    hole.insert(hole.end(), side.begin() + (near.size() > 1 ? 0 : 1), side.end() - 1);
    around.insert(around.end(), sides[i].far.begin(), sides[i].far.end() - 1);
    around.insert(around.end(), outer[i].begin(), outer[i].end() - 1);
  }
  if (Status added = scene.add_hole(std::vector<Polygon>{hole}, 0.8); !added)
    return std::move(added).error();
  const std::vector<Point> all = scene.places();
  std::vector<Point> rim;
  for (const Index v : scene.numbers_of(around)) rim.push_back(all[v]);
  constexpr double kGround = -4;
  append_walls(rim, kGround, closed.closing);
  closed.closing.push_back({reversed(at_height(rim, kGround))});
  return closed;
}

Result<ClosedScene> tee_joint() {
  ClosedScene closed{"tee joint", {}, {}};
  constexpr double kHalf = 1.8;  // of the pipe's length
  constexpr int kAround = 24;
  constexpr int kAlong = 14;
  const auto pipe = [](const Point& u) { return Point{std::sin(u.x), u.y, std::cos(u.x)}; };
  const double half_turn = kTurn / 2;
  Polygon sheet;
  append_edge(sheet, {-half_turn, -kHalf, 0}, {half_turn, -kHalf, 0}, kAround);
  append_edge(sheet, {half_turn, -kHalf, 0}, {half_turn, kHalf, 0}, kAlong);
  append_edge(sheet, {half_turn, kHalf, 0}, {-half_turn, kHalf, 0}, kAround);
  append_edge(sheet, {-half_turn, kHalf, 0}, {-half_turn, -kHalf, 0}, kAlong);
  const Polygon opening = circle(24, 1);
  const Pipe upper{{0, 0, 0}, 0.5, 1.5, 0.4};
  Status made = closed.scene.add_old(std::vector<Polygon>{sheet, opening}, pipe);
  if (made) made = closed.scene.add_old(std::vector<Polygon>{upper.outer(), upper.inner()}, upper);
  if (made) made = closed.scene.fit();
  if (made) made = closed.scene.add_hole(std::vector<Polygon>{opening, upper.outer()}, 0.8);
  if (!made) return std::move(made).error();
  std::vector<Point> front;
  std::vector<Point> back;
  for (int i = 0; i < kAround; ++i) {
    front.push_back(pipe(sheet[static_cast<std::size_t>(i)]));
    back.push_back(pipe(sheet[static_cast<std::size_t>(kAround + kAlong + i)]));
  }
  closed.closing.push_back({reversed(std::move(front))});
  closed.closing.push_back({reversed(std::move(back))});
  closed.closing.push_back({upper.end()});
  return closed;
}

Result<ClosedScene> junction() {
  ClosedScene closed{"junction", {}, {}};
  const auto flat = [](const Point& u) { return u; };
  const Polygon outer = circle(48, 3.6);
  const Polygon rim = circle(40, 3);
  constexpr double kBottom = -1.4;
  std::vector<Pipe> pipes;
  std::vector<Polygon> hole{rim};
  Status made = closed.scene.add_old(std::vector<Polygon>{outer, rim}, flat);
  for (int i = 0; i < 3 && made; ++i) {
    const double angle = kTurn * i / 3;
    pipes.push_back({{1.6 * std::cos(angle), 1.6 * std::sin(angle), 0}, 0.5, -1, kBottom + 1});
    hole.push_back(pipes.back().outer());
    made = closed.scene.add_old(std::vector<Polygon>{pipes.back().outer(), pipes.back().inner()},
                                pipes.back());
  }
  if (made) made = closed.scene.fit();
  if (made) made = closed.scene.add_hole(hole);
  if (!made) return std::move(made).error();
  append_walls(outer, kBottom, closed.closing);
  std::vector<std::vector<Point>> bottom{reversed(at_height(outer, kBottom))};
  for (const Pipe& pipe : pipes) bottom.push_back(pipe.end());
  closed.closing.push_back(std::move(bottom));
  return closed;
}

Result<Solid> solid_of(const ClosedScene& scene) {
  constexpr double kSteps = 1e6;  // a unit has as many
  std::map<std::array<std::int64_t, 3>, Index> number_of;
  std::vector<std::array<std::int64_t, 3>> grid;
  const auto number = [&](const Point& p) {
    const std::array<std::int64_t, 3> place{std::llround(p.x * kSteps), std::llround(p.y * kSteps),
                                            std::llround(p.z * kSteps)};
    const auto [found, is_new] = number_of.emplace(place, static_cast<Index>(grid.size()));
    if (is_new) grid.push_back(place);
    return found->second;
  };
  SolidArrays arrays;
  const std::vector<Point> places = scene.scene.places();
  for (const Triangle& t : scene.scene.arrays().triangles) {
    for (const Index v : t) arrays.ring_vertices.push_back(number(places[v]));
    arrays.end_ring();
    arrays.end_facet();
  }
  for (const auto& facet : scene.closing) {
    for (const std::vector<Point>& ring : facet) {
      for (const Point& p : ring) arrays.ring_vertices.push_back(number(p));
      arrays.end_ring();
    }
    arrays.end_facet();
  }
  arrays.end_shell();
  geometry::Transform transform;
  transform.scale.fill({1, -6});
  const auto lattice = geometry::lattice_of_integers(grid, transform);
  if (!lattice) return lattice.error();
  arrays.vertices = lattice->points;
  return Solid::make(std::move(arrays), lattice->lattice, 0);
}

Jumps jumps_of(const Scene& scene) {
  const auto domain = scene.domain();
  const spline::DomainArrays& arrays = scene.arrays();
  std::map<std::pair<Index, Index>, Index> triangle_of;
  for (Index t = 0; t < arrays.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i)
      triangle_of[{arrays.triangles[t][i], arrays.triangles[t][(i + 1) % 3]}] = t;
  }
  spline::BasisEvaluator evaluator(*domain);
  const auto at = [&](Index triangle, const Point& u) {
    return spline::sum_of(evaluator.in_triangle(triangle, u, 1), scene.coefficients());
  };
  Jumps jumps;
  for (const auto& [edge, triangle] : triangle_of) {
    const auto other = triangle_of.find({edge.second, edge.first});
    if (other == triangle_of.end() || edge.first > edge.second) continue;
    const Point& a = arrays.vertices[edge.first];
    const Point& b = arrays.vertices[edge.second];
    for (const double share : {0.1, 0.5, 0.8}) {
      const Point u{a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), 0};
      const auto one = at(triangle, u);
      const auto two = at(other->second, u);
      jumps.value = std::max(jumps.value, length(minus(one.value, two.value)));
      for (std::size_t i = 0; i < 2; ++i)
        jumps.derivative = std::max(jumps.derivative, length(minus(one.first[i], two.first[i])));
    }
  }
  return jumps;
}

}  // namespace watertight::samples
