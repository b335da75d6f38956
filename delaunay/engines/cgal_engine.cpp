// SPDX-License-Identifier: GPL-3.0-or-later
//
// Makes constrained Delaunay tetrahedralizations by CGAL. Only this translation unit includes
// CGAL's function for it, which takes a minute and 1.8 GB to compile.
// Based on: Si & Shewchuk, "Incrementally constructing and updating constrained Delaunay
// tetrahedralizations with finite-precision coordinates" (2015), as CGAL 6.1 implements it.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/make_conforming_constrained_Delaunay_triangulation_3.h>
#include <CGAL/property_map.h>

#include <algorithm>
#include <map>

#include "delaunay/engines/engine.h"

namespace watertight::delaunay {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using EngineResult = CGAL::Conforming_constrained_Delaunay_triangulation_3<Kernel>;
using EngineTriangulation = EngineResult::Triangulation;

Point to_point(const Kernel::Point_3& p) { return {p.x(), p.y(), p.z()}; }

/// Numbers the engine's vertices: the input's by their coordinates, which the engine does not
/// change, the Steiner points after these in the order of their coordinates.
class Numbering {
 public:
  Numbering(const EngineTriangulation& triangulation, const std::vector<Point>& vertices) {
    result_.points = vertices;
    result_.input_count = static_cast<Index>(vertices.size());
    for (Index i = 0; i < vertices.size(); ++i) number_.emplace(vertices[i], i);
    std::vector<Point> steiner;
    for (auto v = triangulation.finite_vertices_begin(); v != triangulation.finite_vertices_end();
         ++v) {
      if (!number_.contains(to_point(v->point()))) steiner.push_back(to_point(v->point()));
    }
    std::sort(steiner.begin(), steiner.end());
    for (const Point& p : steiner) {
      number_.emplace(p, static_cast<Index>(result_.points.size()));
      result_.points.push_back(p);
    }
  }

  template <class VertexHandle>
  Index operator()(VertexHandle vertex) const {
    return number_.at(to_point(vertex->point()));
  }
  Tetrahedralization& result() { return result_; }

 private:
  std::map<Point, Index> number_;
  Tetrahedralization result_;
};

/// `facet_of_constraint` maps the engine's constraint numbers to facets; null if they are equal.
Tetrahedralization collect(const EngineResult& engine, const std::vector<Point>& vertices,
                           const std::vector<Index>* facet_of_constraint) {
  const EngineTriangulation& triangulation = engine.triangulation();
  Numbering number(triangulation, vertices);
  Tetrahedralization& result = number.result();
  for (auto c = triangulation.finite_cells_begin(); c != triangulation.finite_cells_end(); ++c) {
    result.tetrahedra.push_back(
        {number(c->vertex(0)), number(c->vertex(1)), number(c->vertex(2)), number(c->vertex(3))});
  }
  for (auto f = triangulation.finite_facets_begin(); f != triangulation.finite_facets_end(); ++f) {
    if (!engine.is_facet_constrained(*f)) continue;
    ConstrainedFace& face = result.constrained.emplace_back();
    std::size_t used = 0;
    for (int corner = 0; corner < 4; ++corner) {
      if (corner != f->second) face.vertices[used++] = number(f->first->vertex(corner));
    }
    std::sort(face.vertices.begin(), face.vertices.end());
    const auto constraint = static_cast<std::size_t>(engine.face_constraint_index(*f));
    face.facet = facet_of_constraint == nullptr ? static_cast<Index>(constraint)
                                                : facet_of_constraint->at(constraint);
  }
  std::sort(result.constrained.begin(), result.constrained.end());
  return std::move(result);
}

}  // namespace

CdtAnswer constrained_delaunay(const CdtJob& job) {
  std::vector<Kernel::Point_3> points;
  for (const Point& p : job.complex.vertices) points.emplace_back(p.x, p.y, p.z);
  std::vector<std::vector<std::size_t>> triangles;
  for (const Triangle& t : job.complex.triangles) triangles.push_back({t[0], t[1], t[2]});
  CdtAnswer answer;
  if (job.constraints == Constraints::patches) {
    const std::vector<std::size_t> patches(job.complex.facet_of.begin(),
                                           job.complex.facet_of.end());
    const EngineResult engine = CGAL::make_conforming_constrained_Delaunay_triangulation_3(
        points, triangles, CGAL::parameters::plc_face_id(CGAL::make_property_map(patches)));
    answer.tetrahedralization = collect(engine, job.complex.vertices, nullptr);
  } else {
    const EngineResult engine =
        CGAL::make_conforming_constrained_Delaunay_triangulation_3(points, triangles);
    answer.tetrahedralization = collect(engine, job.complex.vertices, &job.complex.facet_of);
  }
  return answer;
}

}  // namespace watertight::delaunay
