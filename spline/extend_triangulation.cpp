// SPDX-License-Identifier: GPL-3.0-or-later
#include "spline/extend_triangulation.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "geometry/predicates/turn.h"
#include "spline/plane/point_buckets.h"

namespace watertight::spline {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
struct FaceInfo {
  int nesting = -1;  // how many polygons are around; -1 if that is not known
};
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<Index, Kernel>;
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<FaceInfo, Kernel,
                                              CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Cdt = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
    CGAL::No_constraint_intersection_requiring_constructions_tag>;

double distance(const Point& a, const Point& b) {
  const double x = a.x - b.x;
  const double y = a.y - b.y;
  return std::sqrt(x * x + y * y);
}

Error polygon_error(std::size_t polygon, const std::string& what) {
  return Error{ErrorCode::malformed, "polygon " + std::to_string(polygon) + " " + what};
}

/// The triangulation of a region while it gets more vertices.
class Region {
 public:
  Status add_polygons(std::span<const std::vector<Point>> polygons) {
    for (std::size_t p = 0; p < polygons.size(); ++p) {
      if (Status added = add_polygon(polygons[p], p); !added) return added;
    }
    try {
      for (std::size_t p = 0; p < polygons.size(); ++p) {
        if (!constrain(polygons[p].size(), p))
          return polygon_error(p, "touches a vertex of another polygon or of itself");
      }
    } catch (const Cdt::Intersection_of_constraints_exception&) {
      return polygon_error(constrained_, "crosses another polygon or itself");
    }
    // A later edge can have divided an earlier one.
    for (std::size_t p = 0; p < polygons.size(); ++p) {
      if (!has_all_edges(polygons[p].size(), p))
        return polygon_error(p, "touches a vertex of another polygon or of itself");
    }
    return Done{};
  }

  /// Rounds of new vertices until no centroid is far enough from all others.
  Status refine(const ExtendOptions& options) {
    for (;;) {
      const std::vector<Candidate> accepted = accepted_candidates(options);
      if (accepted.empty()) return Done{};
      if (vertices_.size() + accepted.size() > options.most_vertices) {
        return Error{
            ErrorCode::limit_exceeded,
            "the region needs more than " + std::to_string(options.most_vertices) + " vertices"};
      }
      std::size_t added = 0;
      for (const Candidate& candidate : accepted) added += insert(candidate) ? 1 : 0;
      if (added == 0) return Done{};
    }
  }

  std::vector<Triangle> triangles() {
    mark_nesting();
    std::vector<Triangle> triangles;
    for (auto face = cdt_.finite_faces_begin(); face != cdt_.finite_faces_end(); ++face) {
      if (face->info().nesting % 2 != 1) continue;
      Triangle t{face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()};
      std::rotate(t.begin(), std::ranges::min_element(t), t.end());
      triangles.push_back(t);
    }
    std::ranges::sort(triangles);
    return triangles;
  }

  const std::vector<Point>& vertices() const { return vertices_; }

 private:
  struct Candidate {
    Point place;
    double scale;
  };

  Status add_polygon(const std::vector<Point>& polygon, std::size_t number) {
    if (polygon.size() < 3) return polygon_error(number, "has fewer than three vertices");
    starts_.push_back(vertices_.size());
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Point& point = polygon[i];
      if (!std::isfinite(point.x) || !std::isfinite(point.y))
        return polygon_error(number, "has a vertex that is not finite");
      const auto handle = cdt_.insert({point.x, point.y}, hint());
      if (cdt_.number_of_vertices() == vertices_.size())
        return polygon_error(number, "has a vertex that is there already");
      handle->info() = static_cast<Index>(vertices_.size());
      handles_.push_back(handle);
      vertices_.push_back(point);
      const Point& last = polygon[(i + polygon.size() - 1) % polygon.size()];
      const Point& next = polygon[(i + 1) % polygon.size()];
      scales_.push_back((distance(last, point) + distance(point, next)) / 2);
    }
    return Done{};
  }

  std::pair<Cdt::Vertex_handle, Cdt::Vertex_handle> edge(std::size_t polygon, std::size_t i,
                                                         std::size_t size) const {
    return {handles_[starts_[polygon] + i], handles_[starts_[polygon] + (i + 1) % size]};
  }

  bool constrain(std::size_t size, std::size_t polygon) {
    constrained_ = polygon;
    for (std::size_t i = 0; i < size; ++i) {
      const auto [a, b] = edge(polygon, i, size);
      cdt_.insert_constraint(a, b);
    }
    return has_all_edges(size, polygon);
  }

  bool has_all_edges(std::size_t size, std::size_t polygon) const {
    for (std::size_t i = 0; i < size; ++i) {
      const auto [a, b] = edge(polygon, i, size);
      Cdt::Face_handle face;
      int place = 0;
      if (!cdt_.is_edge(a, b, face, place) || !face->is_constrained(place)) return false;
    }
    return true;
  }

  Cdt::Face_handle hint() const {
    return handles_.empty() ? Cdt::Face_handle() : handles_.back()->face();
  }

  /// Counts for each face the polygons around it, from outside inwards.
  void mark_nesting() {
    for (auto face = cdt_.all_faces_begin(); face != cdt_.all_faces_end(); ++face)
      face->info().nesting = -1;
    std::vector<Cdt::Face_handle> level{cdt_.infinite_face()};
    for (int nesting = 0; !level.empty(); ++nesting) {
      std::vector<Cdt::Face_handle> inner;
      while (!level.empty()) {
        const Cdt::Face_handle face = level.back();
        level.pop_back();
        if (face->info().nesting >= 0) continue;
        face->info().nesting = nesting;
        for (int i = 0; i < 3; ++i) {
          const Cdt::Face_handle other = face->neighbor(i);
          if (other->info().nesting < 0) (face->is_constrained(i) ? inner : level).push_back(other);
        }
      }
      level = std::move(inner);
    }
  }

  std::vector<Candidate> accepted_candidates(const ExtendOptions& options) {
    std::vector<Candidate> accepted;
    std::vector<Candidate> candidates;
    double largest = 0;
    for (const Triangle& t : triangles()) {
      const auto& [a, b, c] = t;
      const Candidate candidate{{(vertices_[a].x + vertices_[b].x + vertices_[c].x) / 3,
                                 (vertices_[a].y + vertices_[b].y + vertices_[c].y) / 3, 0},
                                (scales_[a] + scales_[b] + scales_[c]) / 3};
      const bool is_far = std::ranges::all_of(t, [&](Index corner) {
        const double way = distance(candidate.place, vertices_[corner]);
        return way >= options.density * candidate.scale && way >= options.density * scales_[corner];
      });
      if (!is_far) continue;
      candidates.push_back(candidate);
      largest = std::max(largest, options.regularity * candidate.scale);
    }
    PointBuckets buckets(largest);
    for (const Candidate& candidate : candidates) {
      const bool is_far = buckets.all_near(candidate.place, [&](std::size_t other) {
        const double way = distance(candidate.place, accepted[other].place);
        return way >= options.regularity * candidate.scale &&
               way >= options.regularity * accepted[other].scale;
      });
      if (!is_far) continue;
      buckets.add(candidate.place, accepted.size());
      accepted.push_back(candidate);
    }
    return accepted;
  }

  /// False if the rounded centroid is not inside of the region's triangles any more.
  bool insert(const Candidate& candidate) {
    const Cdt::Point place(candidate.place.x, candidate.place.y);
    Cdt::Locate_type type{};
    int i = 0;
    const Cdt::Face_handle face = cdt_.locate(place, type, i, hint());
    const bool is_free = type == Cdt::FACE || (type == Cdt::EDGE && !face->is_constrained(i));
    if (!is_free) return false;
    const auto handle = cdt_.insert(place, type, face, i);
    handle->info() = static_cast<Index>(vertices_.size());
    handles_.push_back(handle);
    vertices_.push_back(candidate.place);
    scales_.push_back(candidate.scale);
    return true;
  }

  Cdt cdt_;
  std::vector<Point> vertices_;
  std::vector<double> scales_;  // of vertices
  std::vector<Cdt::Vertex_handle> handles_;
  std::vector<std::size_t> starts_;  // of polygons among the vertices
  std::size_t constrained_ = 0;      // the polygon whose edges are being inserted
};

/// Moves each new vertex to the middle of its neighbours, one after another, where no triangle
/// turns over.
void smooth(ExtendedTriangulation& mesh, std::size_t first_new) {
  std::vector<std::vector<std::pair<Index, Index>>> around(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t j = 0; j < 3; ++j) around[t[j]].emplace_back(t[(j + 1) % 3], t[(j + 2) % 3]);
  }
  for (std::size_t v = first_new; v < mesh.vertices.size(); ++v) {
    Point middle;
    for (const auto& [second, third] : around[v]) {  // each neighbour is the second of one triangle
      middle.x += mesh.vertices[second].x / static_cast<double>(around[v].size());
      middle.y += mesh.vertices[second].y / static_cast<double>(around[v].size());
    }
    const bool keeps = std::ranges::all_of(around[v], [&](const auto& others) {
      return geometry::turn(middle, mesh.vertices[others.first], mesh.vertices[others.second]) > 0;
    });
    if (keeps) mesh.vertices[v] = middle;
  }
}

}  // namespace

Result<ExtendedTriangulation> extend_triangulation(std::span<const std::vector<Point>> polygons,
                                                   const ExtendOptions& options) {
  if (!(options.density > 0) || !(options.regularity > 0)) {
    return Error{ErrorCode::invalid_argument, "density and regularity must be positive"};
  }
  Region region;
  if (Status added = region.add_polygons(polygons); !added) return added.error();
  const std::size_t first_new = region.vertices().size();
  if (Status refined = region.refine(options); !refined) return refined.error();
  ExtendedTriangulation mesh{region.vertices(), region.triangles()};
  for (int round = 0; round < options.smoothing_rounds; ++round) smooth(mesh, first_new);
  return mesh;
}

Result<std::vector<Point>> complete_boundary(std::span<const std::vector<Point>> pieces) {
  std::vector<Point> polygon;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    const std::vector<Point>& piece = pieces[p];
    if (piece.size() < 2)
      return Error{ErrorCode::malformed,
                   "piece " + std::to_string(p) + " has fewer than two points"};
    polygon.insert(polygon.end(), piece.begin(), piece.end());
    const std::vector<Point>& next = pieces[(p + 1) % pieces.size()];
    if (next.size() < 2) continue;  // is an error in its turn
    const Point& from = piece.back();
    const Point& to = next.front();
    const double mean = (distance(piece[piece.size() - 2], from) + distance(to, next[1])) / 2;
    const double length = distance(from, to);
    if (!(length > mean)) continue;
    const double parts = std::round(length / mean);
    if (!(parts <= 1e6))
      return Error{ErrorCode::malformed,
                   "the edge after piece " + std::to_string(p) + " is too long for its neighbours"};
    for (double part = 1; part < parts; ++part) {
      const double share = part / parts;
      polygon.push_back({from.x + share * (to.x - from.x), from.y + share * (to.y - from.y), 0});
    }
  }
  return polygon;
}

}  // namespace watertight::spline
