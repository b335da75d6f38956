// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/smooth/collar.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string_view>

namespace watertight::repair {
namespace {

using geometry::operator-;
using geometry::Vector3;

/// The first ring goes on across creases, so that it is whole around each vertex of the border.
constexpr double kAnyCosine = -2;
constexpr double kSharpCosine = -0.17364817766693036;  // of 100 degrees

/// The same triangle with its smallest vertex first.
Triangle turned_to_smallest(Triangle t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

/// Grows the collar from the triangles on the border across edges that are not sharp.
class CollarMaker {
 public:
  CollarMaker(const EditedSolid& solid, const ShellSurface& surface, const HoleLoops& loops,
              const CollarOptions& options)
      : solid_(solid), surface_(surface), loops_(loops), options_(options) {}

  std::variant<Collar, Refused> make() {
    for (const Ring& loop : loops_) {
      for (std::size_t i = 0; i < loop.size(); ++i) {
        if (auto refused = start_at(loop[i], loop[(i + 1) % loop.size()])) return *refused;
      }
    }
    const double crease = std::cos(options_.crease_degrees * std::numbers::pi / 180);
    for (int ring = 1; ring <= options_.rings; ++ring) {
      if (ring > 1) rings_of_vertices_ = numbered_by_ring(ring - 1);
      grow(ring - 1, ring == 1 ? kAnyCosine : crease);
      if (triangles_.size() > options_.most_triangles)
        return Refused{
            SmoothRefusal::too_large,
            "the collar has more than " + std::to_string(options_.most_triangles) + " triangles"};
      if (ring > 1) continue;
      if (auto refused = check_fans()) return *refused;
    }
    Collar collar = numbered();
    collar.sharp_vertex = sharp_vertex_;
    return collar;
  }

 private:
  std::optional<Refused> start_at(Index from, Index to) {
    const Index third = surface_.third(to, from);
    if (third == kNone)
      return Refused{SmoothRefusal::border_not_manifold,
                     "the facet at the edge from vertex " + std::to_string(from) + " to " +
                         std::to_string(to) + " has no triangles"};
    if (!rings_of_vertices_.emplace(from, 0).second)
      return Refused{SmoothRefusal::border_not_manifold,
                     "the border passes vertex " + std::to_string(from) + " more than once"};
    add(turned_to_smallest({to, from, third}));
    return std::nullopt;
  }

  Vector3 place(Index vertex) const { return metres_of(solid_, vertex, surface_.units()); }

  bool add(const Triangle& t) {
    if (!triangles_.insert(t).second) return false;
    open_.push_back(t);
    return true;
  }

  /// Adds triangles at vertices of a ring, across edges that are not sharp.
  void grow(int ring, double least_cosine) {
    open_.assign(triangles_.begin(), triangles_.end());
    const auto is_at_ring = [&](Index vertex) {
      const auto found = rings_of_vertices_.find(vertex);
      return found != rings_of_vertices_.end() && found->second <= ring;
    };
    while (!open_.empty() && triangles_.size() <= options_.most_triangles) {
      const Triangle t = open_.back();
      open_.pop_back();
      for (std::size_t i = 0; i < 3; ++i) {
        const Index from = t[i];
        const Index to = t[(i + 1) % 3];
        if (!is_at_ring(from) && !is_at_ring(to)) continue;
        const Index third = surface_.third(to, from);
        if (third == kNone) continue;
        if (cosine_at_edge(place(from), place(to), place(t[(i + 2) % 3]), place(third)) <
            least_cosine)
          continue;
        add(turned_to_smallest({to, from, third}));
      }
    }
  }

  std::map<Index, int> numbered_by_ring(int ring) const {
    std::map<Index, int> rings = rings_of_vertices_;
    for (const Triangle& t : triangles_) {
      for (const Index vertex : t) rings.emplace(vertex, ring);
    }
    return rings;
  }

  /// Refuses a vertex of the border around which the triangles are not connected; notes one at
  /// which they turn too much.
  std::optional<Refused> check_fans() {
    std::map<Index, std::size_t> corners;
    std::map<std::pair<Index, Index>, Index> thirds;  // of directed edges
    for (const Triangle& t : triangles_) {
      for (std::size_t i = 0; i < 3; ++i) {
        ++corners[t[i]];
        thirds[{t[i], t[(i + 1) % 3]}] = t[(i + 2) % 3];
      }
    }
    std::map<Index, std::size_t> inner_edges;
    for (const auto& [edge, third] : thirds) {
      const auto& [from, to] = edge;
      const auto other = thirds.find({to, from});
      if (other == thirds.end()) continue;
      ++inner_edges[from];
      const bool is_sharp =
          rings_of_vertices_.contains(from) &&
          cosine_at_edge(place(from), place(to), place(third), place(other->second)) < kSharpCosine;
      if (is_sharp && sharp_vertex_ == kNone) sharp_vertex_ = from;
    }
    for (const auto& [vertex, ring] : rings_of_vertices_) {
      if (corners[vertex] == inner_edges[vertex] + 1) continue;
      return Refused{SmoothRefusal::border_not_manifold,
                     "the facets around vertex " + std::to_string(vertex) +
                         " of the border are not connected there"};
    }
    return std::nullopt;
  }

  Collar numbered() const {
    Collar collar;
    std::map<Index, Index> number_of;
    const auto number = [&](Index vertex) {
      const auto [found, is_new] =
          number_of.emplace(vertex, static_cast<Index>(collar.vertices.size()));
      if (is_new) collar.vertices.push_back(vertex);
      return found->second;
    };
    for (const Ring& loop : loops_) {
      Ring& own = collar.loops.emplace_back();
      for (const Index vertex : loop) own.push_back(number(vertex));
    }
    for (const auto& [a, b, c] : triangles_) {
      Triangle& own = collar.triangles.emplace_back();
      own[0] = number(a);
      own[1] = number(b);
      own[2] = number(c);
    }
    return collar;
  }

  const EditedSolid& solid_;
  const ShellSurface& surface_;
  const HoleLoops& loops_;
  const CollarOptions& options_;
  std::map<Index, int> rings_of_vertices_;
  std::set<Triangle> triangles_;
  Index sharp_vertex_ = kNone;
  std::vector<Triangle> open_;
};

}  // namespace

std::string_view to_string(SmoothRefusal refusal) {
  switch (refusal) {
    case SmoothRefusal::border_not_manifold:
      return "border_not_manifold";
    case SmoothRefusal::too_sharp:
      return "too_sharp";
    case SmoothRefusal::not_flattenable:
      return "not_flattenable";
    case SmoothRefusal::too_large:
      return "too_large";
    case SmoothRefusal::patch_crosses:
      return "patch_crosses";
    case SmoothRefusal::not_valid:
      return "not_valid";
  }
  return "";
}

std::variant<Collar, Refused> collar_of(const EditedSolid& solid, const ShellSurface& surface,
                                        const HoleLoops& loops, const CollarOptions& options) {
  return CollarMaker(solid, surface, loops, options).make();
}

double cosine_at_edge(const Vector3& from, const Vector3& to, const Vector3& left,
                      const Vector3& right) {
  const Vector3 along = to - from;
  const Vector3 one = geometry::cross(along, left - from);
  const Vector3 other = geometry::cross(right - from, along);
  const double size = geometry::length(one) * geometry::length(other);
  return size > 0 ? std::clamp(geometry::dot(one, other) / size, -1.0, 1.0) : 1;
}

}  // namespace watertight::repair
