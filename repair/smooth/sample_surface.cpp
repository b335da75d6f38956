// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/smooth/sample_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>

#include "geometry/vector3.h"
#include "spline/plane/conformal_map.h"

namespace watertight::repair {
namespace {

using geometry::operator+;
using geometry::operator-;
using geometry::operator*;
using geometry::Vector3;
using Edge = std::pair<Index, Index>;

constexpr int kMostRounds = 8;          // of halving edges
constexpr std::size_t kBulgeParts = 8;  // of an edge of the border, at which the surface is known

Edge edge_of(Index a, Index b) { return std::minmax(a, b); }
Vector3 vector_of(const Point& p) { return {p.x, p.y, p.z}; }
Point middle_of(const Point& a, const Point& b) { return {(a.x + b.x) / 2, (a.y + b.y) / 2, 0}; }

/// Triangles in the plane at whose vertices the surface is sampled.
struct Samples {
  std::vector<Point> places;
  std::vector<Triangle> triangles;
  std::vector<spline::SurfacePoint> values;
};

/// Divides triangles at the vertices that stand in the middle of their edges.
class EdgeHalver {
 public:
  EdgeHalver(Samples& samples, std::map<Edge, Index> middles)
      : samples_(samples), middles_(std::move(middles)) {}

  void run() {
    const std::vector<Triangle> before = std::move(samples_.triangles);
    samples_.triangles.clear();
    for (const Triangle& t : before) divide(t);
  }

 private:
  Index middle(Index a, Index b) const {
    const auto found = middles_.find(edge_of(a, b));
    return found == middles_.end() ? geometry::kNone : found->second;
  }

  void divide(Triangle t) {
    // The edge with a middle that follows one without comes first.
    for (int turn = 0; turn < 3; ++turn) {
      const bool starts = middle(t[0], t[1]) != kNone && middle(t[2], t[0]) == kNone;
      if (starts) break;
      std::rotate(t.begin(), t.begin() + 1, t.end());
    }
    const auto [a, b, c] = t;
    const Index ab = middle(a, b);
    const Index bc = middle(b, c);
    const Index ca = middle(c, a);
    auto& out = samples_.triangles;
    if (ab == kNone) {
      out.push_back(t);
    } else if (bc == kNone) {
      out.push_back({a, ab, c});
      out.push_back({ab, b, c});
    } else if (ca == kNone) {
      out.push_back({ab, b, bc});
      out.push_back({a, ab, bc});
      out.push_back({a, bc, c});
    } else {
      out.insert(out.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
  }

  Samples& samples_;
  std::map<Edge, Index> middles_;
};

class Sampler {
 public:
  Sampler(const SampledHole& hole, SmoothPatch& patch) : hole_(hole), patch_(patch) {
    const auto& arrays = hole.surface.domain().arrays();
    const auto border = static_cast<Index>(hole.border.size());
    samples_.places.assign(arrays.vertices.begin(),
                           arrays.vertices.begin() + static_cast<std::ptrdiff_t>(border));
    samples_.places.insert(samples_.places.end(),
                           arrays.vertices.begin() + static_cast<std::ptrdiff_t>(hole.first_new),
                           arrays.vertices.end());
    for (std::size_t i = hole.collar_triangles; i < arrays.triangles.size(); ++i) {
      Triangle t = arrays.triangles[i];
      for (Index& corner : t) {
        if (corner >= border) corner = border + corner - static_cast<Index>(hole.first_new);
      }
      samples_.triangles.push_back(t);
    }
  }

  bool evaluate() {
    const std::size_t known = samples_.values.size();
    for (const auto& value : hole_.surface.values(std::span(samples_.places).subspan(known), 2)) {
      if (!value) return false;
      samples_.values.push_back(*value);
    }
    return true;
  }

  /// Halves inner edges that are too far from the surface. False if there is none.
  bool refine(double chord) {
    std::vector<Edge> inner;
    std::vector<Point> middles;
    for (const auto& [edge, count] : edge_uses()) {
      if (count < 2) continue;
      inner.push_back(edge);
      middles.push_back(middle_of(samples_.places[edge.first], samples_.places[edge.second]));
    }
    const auto values = hole_.surface.values(middles);
    std::map<Edge, Index> halved;
    for (std::size_t i = 0; i < inner.size(); ++i) {
      if (!values[i]) continue;
      const Vector3 a = vector_of(samples_.values[inner[i].first].value);
      const Vector3 b = vector_of(samples_.values[inner[i].second].value);
      const Vector3 c = vector_of(values[i]->value);
      const Vector3 way{c[0] - (a[0] + b[0]) / 2, c[1] - (a[1] + b[1]) / 2,
                        c[2] - (a[2] + b[2]) / 2};
      if (!(geometry::length(way) > chord)) continue;
      halved.emplace(inner[i], static_cast<Index>(samples_.places.size()));
      samples_.places.push_back(middles[i]);
    }
    if (halved.empty()) return false;
    EdgeHalver(samples_, std::move(halved)).run();
    return true;
  }

  std::size_t new_vertices() const { return samples_.places.size() - hole_.border.size(); }

  /// Moves the samples so that those on the border are its vertices.
  Status finish() {
    std::vector<Point> differences;
    for (std::size_t i = 0; i < hole_.border.size(); ++i) {
      const Vector3 way = vector_of(samples_.values[i].value) - hole_.border[i];
      differences.push_back({way[0], way[1], way[2]});
      patch_.measures.border_distance =
          std::max(patch_.measures.border_distance, geometry::length(way));
    }
    const auto spread =
        spline::spread_inward(differences, samples_.places.size(), samples_.triangles);
    if (!spread) return spread.error();
    const std::vector<Bulge> bulges = border_bulges();
    for (std::size_t i = hole_.border.size(); i < samples_.places.size(); ++i) {
      Vector3 at = vector_of(samples_.values[i].value) - vector_of((*spread)[i]);
      for (const Bulge& bulge : bulges) at = at - bulge.at(samples_.places[i]);
      patch_.new_vertices.push_back(at);
    }
    patch_.triangles = std::move(samples_.triangles);
    return Done{};
  }

  void measure() {
    SmoothMeasures& measures = patch_.measures;
    measures.vertices = patch_.new_vertices.size();
    bool is_first = true;
    for (std::size_t i = hole_.border.size(); i < samples_.values.size(); ++i) {
      const double curvature = spline::gaussian_curvature(samples_.values[i]);
      if (!std::isfinite(curvature)) continue;
      measures.least_curvature =
          is_first ? curvature : std::min(measures.least_curvature, curvature);
      measures.largest_curvature =
          is_first ? curvature : std::max(measures.largest_curvature, curvature);
      is_first = false;
    }
    measure_jumps();
  }

 private:
  /// How many triangles have each edge: one at the border, else two.
  std::map<Edge, int> edge_uses() const {
    std::map<Edge, int> uses;
    for (const Triangle& t : samples_.triangles) {
      for (std::size_t i = 0; i < 3; ++i) ++uses[edge_of(t[i], t[(i + 1) % 3])];
    }
    return uses;
  }

  /// The way of the surface along an edge of the border from the straight edge.
  struct Bulge {
    Point from;
    Point to;
    std::array<Vector3, kBulgeParts + 1> ways{};  // at equal steps, 0 at both ends

    Point place(std::size_t step) const {
      const double t = static_cast<double>(step) / kBulgeParts;
      return {from.x * (1 - t) + to.x * t, from.y * (1 - t) + to.y * t, 0};
    }

    /// What it adds at a place: all of it on the edge, less away from it, nothing at its length.
    Vector3 at(const Point& place) const {
      const Vector3 along = geometry::difference(to, from);
      const Vector3 seen = geometry::difference(place, from);
      const double squared = geometry::dot(along, along);
      const double t = std::clamp(geometry::dot(seen, along) / squared, 0.0, 1.0);
      const double away = geometry::length(seen - along * t) / std::sqrt(squared);
      if (!(away < 1)) return {};
      const double step = t * kBulgeParts;
      const auto part = std::min(static_cast<std::size_t>(step), kBulgeParts - 1);
      const double rest = step - static_cast<double>(part);
      const Vector3 way = ways[part] * (1 - rest) + ways[part + 1] * rest;
      return way * ((1 - away) * (1 - away));
    }
  };

  std::vector<Bulge> border_bulges() const {
    std::vector<Bulge> bulges;
    for (const auto& [edge, count] : edge_uses()) {
      if (count > 1) continue;
      Bulge bulge{samples_.places[edge.first], samples_.places[edge.second]};
      std::vector<Point> places;
      for (std::size_t i = 1; i < kBulgeParts; ++i) places.push_back(bulge.place(i));
      const auto values = hole_.surface.values(places);
      for (std::size_t i = 1; i < kBulgeParts; ++i) {
        if (!values[i - 1]) continue;
        const double t = static_cast<double>(i) / kBulgeParts;
        bulge.ways[i] = vector_of(values[i - 1]->value) -
                        (vector_of(samples_.values[edge.first].value) * (1 - t) +
                         vector_of(samples_.values[edge.second].value) * t);
      }
      bulges.push_back(bulge);
    }
    return bulges;
  }

  static Vector3 normal_of(const spline::SurfacePoint& at) {
    return geometry::cross(vector_of(at.first[0]), vector_of(at.first[1]));
  }

  /// The surface as the limit from both sides in the middle of the border's edges.
  void measure_jumps() {
    const auto& arrays = hole_.surface.domain().arrays();
    std::map<Edge, Index> sides;
    for (Index t = 0; t < hole_.collar_triangles; ++t) {
      const Triangle& corners = arrays.triangles[t];
      for (std::size_t i = 0; i < 3; ++i) sides[{corners[i], corners[(i + 1) % 3]}] = t;
    }
    spline::BasisEvaluator evaluator(hole_.surface.domain());
    const auto at = [&](Index triangle, const Point& u) {
      return spline::sum_of(evaluator.in_triangle(triangle, u, 1), hole_.surface.coefficients());
    };
    for (auto t = static_cast<Index>(hole_.collar_triangles); t < arrays.triangles.size(); ++t) {
      const Triangle& corners = arrays.triangles[t];
      for (std::size_t i = 0; i < 3; ++i) {
        const auto beyond = sides.find({corners[(i + 1) % 3], corners[i]});
        if (beyond == sides.end()) continue;
        const Point u =
            middle_of(arrays.vertices[corners[i]], arrays.vertices[corners[(i + 1) % 3]]);
        add_jump(at(t, u), at(beyond->second, u));
      }
    }
  }

  void add_jump(const spline::SurfacePoint& one, const spline::SurfacePoint& other) {
    SmoothMeasures& measures = patch_.measures;
    measures.value_jump = std::max(measures.value_jump,
                                   geometry::length(vector_of(one.value) - vector_of(other.value)));
    const Vector3 a = normal_of(one);
    const Vector3 b = normal_of(other);
    const double angle = std::atan2(geometry::length(geometry::cross(a, b)), geometry::dot(a, b));
    measures.normal_jump = std::max(measures.normal_jump, angle * 180 / std::numbers::pi);
  }

  const SampledHole& hole_;
  SmoothPatch& patch_;
  Samples samples_;
};

}  // namespace

std::optional<Refused> sample(const SampledHole& hole, double chord_metres,
                              std::size_t most_vertices, SmoothPatch& patch) {
  Sampler sampler(hole, patch);
  const Refused outside{SmoothRefusal::not_flattenable, "a sample lies outside of the domain"};
  if (!sampler.evaluate()) return outside;
  for (int round = 0; round < kMostRounds; ++round) {
    if (!sampler.refine(chord_metres)) break;
    if (sampler.new_vertices() > most_vertices) {
      return Refused{SmoothRefusal::too_large,
                     "the patch needs more than " + std::to_string(most_vertices) + " vertices"};
    }
    if (!sampler.evaluate()) return outside;
  }
  if (const Status finished = sampler.finish(); !finished)
    return Refused{SmoothRefusal::not_flattenable, finished.error().message};
  sampler.measure();
  return std::nullopt;
}

}  // namespace watertight::repair
