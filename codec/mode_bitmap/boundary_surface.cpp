// SPDX-License-Identifier: GPL-3.0-or-later
//
// Based on: Verbree & Si 2008, section 4.1, composition steps 5 and 7.
// Departures: the paper composes triangles; here the facets' polygons come back, by one flag per
// edge, and Steiner vertices leave the rings.
#include "codec/mode_bitmap/boundary_surface.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

namespace watertight::codec::bitmap {
namespace {

struct EdgeUse {
  Index from;
  Index to;
  Index triangle;
  Index corner;  // the vertex off the edge
};

Index other_of(const Joint& joint, Index triangle) {
  return joint.triangles[0] == triangle ? joint.triangles[1] : joint.triangles[0];
}

/// True if the triangle, in its own direction, has the edge from -> to.
bool runs_forward(const Triangle& t, Index from, Index to) {
  return (t[0] == from && t[1] == to) || (t[1] == from && t[2] == to) ||
         (t[2] == from && t[0] == to);
}

}  // namespace

BoundarySurface::BoundarySurface(std::span<const Triangle> triangles, Index vertex_count)
    : triangles_(triangles.begin(), triangles.end()), vertex_count_(vertex_count) {
  find_joints();
  find_components();
}

void BoundarySurface::find_joints() {
  std::vector<EdgeUse> uses;
  uses.reserve(triangles_.size() * 3);
  for (Index i = 0; i < triangles_.size(); ++i) {
    const auto& [a, b, c] = triangles_[i];
    uses.push_back({a, b, i, c});
    uses.push_back({a, c, i, b});
    uses.push_back({b, c, i, a});
  }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& l, const EdgeUse& r) {
    return std::tie(l.from, l.to, l.triangle) < std::tie(r.from, r.to, r.triangle);
  });
  joints_of_.assign(triangles_.size(), {});
  for (std::size_t begin = 0; begin < uses.size();) {
    std::size_t end = begin;
    while (end < uses.size() && uses[end].from == uses[begin].from &&
           uses[end].to == uses[begin].to) {
      ++end;
    }
    if (end - begin == 2) {
      const EdgeUse& first = uses[begin];
      const EdgeUse& second = uses[begin + 1];
      const auto joint = static_cast<Index>(joints_.size());
      joints_.push_back(
          {first.from, first.to, {first.triangle, second.triangle}, {first.corner, second.corner}});
      joints_of_[first.triangle].push_back(joint);
      joints_of_[second.triangle].push_back(joint);
    }
    begin = end;
  }
}

void BoundarySurface::find_components() {
  component_of_.assign(triangles_.size(), kNone);
  std::vector<Index> stack;
  for (Index first = 0; first < triangles_.size(); ++first) {
    if (component_of_[first] != kNone) continue;
    const Index component = component_count();
    component_first_.push_back(first);
    component_of_[first] = component;
    stack.push_back(first);
    while (!stack.empty()) {
      const Index triangle = stack.back();
      stack.pop_back();
      for (const Index joint : joints_of_[triangle]) {
        const Index next = other_of(joints_[joint], triangle);
        if (component_of_[next] != kNone) continue;
        component_of_[next] = component;
        stack.push_back(next);
      }
    }
  }
}

void BoundarySurface::set_interior(std::vector<bool> is_interior) {
  is_interior_ = std::move(is_interior);
  facet_of_.assign(triangles_.size(), kNone);
  facet_first_.clear();
  std::vector<Index> stack;
  for (Index first = 0; first < triangles_.size(); ++first) {
    if (facet_of_[first] != kNone) continue;
    const Index facet = facet_count();
    facet_first_.push_back(first);
    facet_of_[first] = facet;
    stack.push_back(first);
    while (!stack.empty()) {
      const Index triangle = stack.back();
      stack.pop_back();
      for (const Index joint : joints_of_[triangle]) {
        const Index next = other_of(joints_[joint], triangle);
        if (!is_interior_[joint] || facet_of_[next] != kNone) continue;
        facet_of_[next] = facet;
        stack.push_back(next);
      }
    }
  }
}

Status BoundarySurface::orient(const std::vector<bool>& is_flipped) {
  turned_ = triangles_;
  std::vector<bool> is_turned(triangles_.size(), false);
  std::vector<Index> stack;
  for (Index component = 0; component < component_count(); ++component) {
    const Index first = component_first_[component];
    if (is_flipped[component]) std::swap(turned_[first][1], turned_[first][2]);
    is_turned[first] = true;
    stack.push_back(first);
    while (!stack.empty()) {
      const Index triangle = stack.back();
      stack.pop_back();
      for (const Index index : joints_of_[triangle]) {
        const Joint& joint = joints_[index];
        const Index next = other_of(joint, triangle);
        const bool is_same = runs_forward(turned_[triangle], joint.from, joint.to) ==
                             runs_forward(turned_[next], joint.from, joint.to);
        if (is_turned[next]) {
          if (!is_same) continue;
          return Error{ErrorCode::malformed, "the marked faces form a surface without two sides"};
        }
        if (is_same) std::swap(turned_[next][1], turned_[next][2]);
        is_turned[next] = true;
        stack.push_back(next);
      }
    }
  }
  return Done{};
}

Index BoundarySurface::half_edge_of(Index triangle, Index corner_vertex) const {
  const Triangle& t = turned_[triangle];
  // The half-edge opposite a corner starts at the next corner.
  const Index corner = t[0] == corner_vertex ? 0 : t[1] == corner_vertex ? 1 : 2;
  return triangle * 3 + (corner + 1) % 3;
}

std::vector<Index> BoundarySurface::interior_twins() const {
  std::vector<Index> twin(triangles_.size() * 3, kNone);
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    if (!is_interior_[i]) continue;
    const Joint& joint = joints_[i];
    const Index first = half_edge_of(joint.triangles[0], joint.corners[0]);
    const Index second = half_edge_of(joint.triangles[1], joint.corners[1]);
    twin[first] = second;
    twin[second] = first;
  }
  return twin;
}

std::vector<std::vector<VertexRing>> BoundarySurface::rings_of_facets() const {
  const std::vector<Index> twin = interior_twins();
  std::vector<std::vector<VertexRing>> rings(facet_count());
  std::vector<bool> is_done(twin.size(), false);
  for (Index half_edge = 0; half_edge < twin.size(); ++half_edge) {
    if (twin[half_edge] != kNone || is_done[half_edge]) continue;
    walk_rings(half_edge, twin, is_done, rings[facet_of_[half_edge / 3]]);
  }
  for (auto& facet : rings) std::sort(facet.begin(), facet.end());
  return rings;
}

/// Follows the edge of a facet from one of its half-edges until the walk closes. At a vertex the
/// walk turns through the facet's triangles to the next half-edge that has no twin. It cannot turn
/// for ever: each step of a turn can be undone, and undoing them leads back to the half-edge
/// without twin at which the turn began.
void BoundarySurface::walk_rings(Index start, const std::vector<Index>& twin,
                                 std::vector<bool>& is_done, std::vector<VertexRing>& rings) const {
  std::vector<Index> walk;
  Index half_edge = start;
  do {
    is_done[half_edge] = true;
    walk.push_back(vertex_at(half_edge));
    half_edge = next_of(half_edge);
    while (twin[half_edge] != kNone) half_edge = next_of(twin[half_edge]);
  } while (half_edge != start);

  // The walk is split at vertices that come twice: a loop that closes on the stack is a ring of its
  // own.
  std::vector<Index> sorted = walk;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end()) {
    close_ring(walk, rings);
    return;
  }
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  std::vector<bool> is_on_stack(sorted.size(), false);
  const auto place_of = [&](Index vertex) {
    return static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), vertex) -
                                    sorted.begin());
  };
  std::vector<Index> stack;
  for (const Index vertex : walk) {
    if (is_on_stack[place_of(vertex)]) {
      std::size_t begin = stack.size() - 1;
      while (stack[begin] != vertex) --begin;
      close_ring(std::span<const Index>(stack).subspan(begin), rings);
      for (std::size_t i = begin + 1; i < stack.size(); ++i)
        is_on_stack[place_of(stack[i])] = false;
      stack.resize(begin);
    }
    is_on_stack[place_of(vertex)] = true;
    stack.push_back(vertex);
  }
  close_ring(stack, rings);
}

void BoundarySurface::close_ring(std::span<const Index> walk,
                                 std::vector<VertexRing>& rings) const {
  VertexRing ring;
  for (const Index vertex : walk) {
    if (vertex < vertex_count_) ring.push_back(vertex);
  }
  std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
  rings.push_back(std::move(ring));
}

SolidArrays BoundarySurface::assemble(const std::vector<std::vector<VertexRing>>& rings,
                                      Index exterior_component,
                                      const std::vector<Index>& exterior_ring) const {
  std::vector<std::vector<Index>> facets_of(component_count());
  for (Index facet = 0; facet < facet_count(); ++facet) {
    facets_of[component_of_[facet_first_[facet]]].push_back(facet);
  }
  SolidArrays arrays;
  const auto add_ring = [&](const VertexRing& ring) {
    arrays.ring_vertices.insert(arrays.ring_vertices.end(), ring.begin(), ring.end());
    arrays.end_ring();
  };
  const auto add_shell = [&](Index component) {
    for (const Index facet : facets_of[component]) {
      const auto& all = rings[facet];
      if (!all.empty()) add_ring(all[exterior_ring[facet]]);
      for (Index i = 0; i < all.size(); ++i) {
        if (i != exterior_ring[facet]) add_ring(all[i]);
      }
      arrays.end_facet();
    }
    arrays.end_shell();
  };
  if (component_count() > 0) add_shell(exterior_component);
  for (Index component = 0; component < component_count(); ++component) {
    if (component != exterior_component) add_shell(component);
  }
  return arrays;
}

}  // namespace watertight::codec::bitmap
