// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/metamorphic/oracle.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Nef_polyhedron_3.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/helpers.h>

#include <array>
#include <map>

namespace watertight {
namespace {

namespace PMP = CGAL::Polygon_mesh_processing;

template <class Kernel>
struct Soup {
  std::vector<typename Kernel::Point_3> points;
  std::vector<std::array<std::size_t, 3>> triangles;
};

/// The soup of a shell, with only the vertices that the shell uses.
template <class Kernel>
Soup<Kernel> soup_of(std::span<const Point> vertices, const ShellTriangles& shell,
                     bool is_turned = false) {
  Soup<Kernel> soup;
  std::map<Index, std::size_t> number;
  for (const Triangle& t : shell) {
    std::array<std::size_t, 3> corners{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [place, is_new] = number.emplace(t[i], soup.points.size());
      const Point& p = vertices[t[i]];
      if (is_new) soup.points.emplace_back(p.x, p.y, p.z);
      corners[i] = place->second;
    }
    if (is_turned) std::swap(corners[1], corners[2]);
    soup.triangles.push_back(corners);
  }
  return soup;
}

using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
using Nef = CGAL::Nef_polyhedron_3<Exact>;

Nef nef_of(std::span<const Point> vertices, const ShellTriangles& shell, bool is_turned) {
  Soup<Exact> soup = soup_of<Exact>(vertices, shell, is_turned);
  CGAL::Surface_mesh<Exact::Point_3> mesh;
  PMP::polygon_soup_to_polygon_mesh(soup.points, soup.triangles, mesh);
  return Nef(mesh);
}

bool share_area(const Nef& a, const Nef& b) {
  return (a.boundary() * b.boundary()).number_of_facets() > 0;
}

std::size_t marked_volumes(const Nef& nef) {
  std::size_t count = 0;
  for (auto volume = nef.volumes_begin(); volume != nef.volumes_end(); ++volume) {
    if (volume->mark()) ++count;
  }
  return count;
}

}  // namespace

ShellFacts ask_pmp(std::span<const Point> vertices, const ShellTriangles& shell) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  Soup<Kernel> soup = soup_of<Kernel>(vertices, shell);
  ShellFacts facts;
  facts.meets_itself = PMP::does_triangle_soup_self_intersect(soup.points, soup.triangles);
  facts.is_mesh = PMP::is_polygon_soup_a_polygon_mesh(soup.triangles);
  if (!facts.is_mesh) return facts;
  using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
  Mesh mesh;
  PMP::polygon_soup_to_polygon_mesh(soup.points, soup.triangles, mesh);
  facts.is_closed = CGAL::is_closed(mesh);
  const auto part = mesh.add_property_map<Mesh::Face_index, std::size_t>("f:part", 0).first;
  facts.components = PMP::connected_components(mesh, part);
  if (!facts.is_closed || facts.meets_itself) return facts;
  facts.bounds_volume = PMP::does_bound_a_volume(mesh);
  facts.is_outward = facts.components == 1 && PMP::is_outward_oriented(mesh);
  return facts;
}

NefFacts ask_nef(std::span<const Point> vertices, std::span<const ShellTriangles> shells) {
  const Nef outer = nef_of(vertices, shells[0], false);
  std::vector<Nef> cavities;
  for (std::size_t i = 1; i < shells.size(); ++i) {
    cavities.push_back(nef_of(vertices, shells[i], true));
  }
  NefFacts facts{true, true, 0};
  Nef rest = outer.interior();
  for (std::size_t i = 0; i < cavities.size(); ++i) {
    if (!(cavities[i].interior() - outer).is_empty() || share_area(cavities[i], outer)) {
      facts.cavities_inside = false;
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (!(cavities[i].interior() * cavities[j].interior()).is_empty() ||
          share_area(cavities[i], cavities[j])) {
        facts.cavities_apart = false;
      }
    }
    rest = rest - cavities[i].closure();
  }
  facts.interior_parts = marked_volumes(rest);
  return facts;
}

}  // namespace watertight
