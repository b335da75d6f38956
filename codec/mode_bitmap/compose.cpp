// SPDX-License-Identifier: GPL-3.0-or-later
//
// Based on: Verbree & Si 2008, section 4.1, composition steps 1-7.
// Departures: those of the decomposition (codec/mode_bitmap/decompose.cpp).
#include "codec/mode_bitmap/compose.h"

#include <algorithm>
#include <iterator>

#include "codec/mode_bitmap/decompose.h"
#include "codec/mode_bitmap/face_marks.h"
#include "codec/mode_bitmap/facet_structure.h"
#include "codec/sections/coordinates.h"
#include "codec/sections/facet_listing.h"

namespace watertight::codec::bitmap {

Result<Nodes> read_nodes(const BitmapSections& sections, const Limits& limits) {
  auto vertices = read_vertices(sections.vertices, limits);
  if (!vertices) return vertices.error();
  Nodes nodes;
  nodes.points = std::move(vertices).value();
  nodes.vertex_count = static_cast<Index>(nodes.points.size());
  if (sections.steiner.empty()) return nodes;
  auto steiner = read_steiner_vertices(sections.steiner, limits);
  if (!steiner) return steiner.error();
  if (steiner->empty()) {
    return Error{ErrorCode::malformed, "a section of Steiner vertices is empty"};
  }
  nodes.points.insert(nodes.points.end(), steiner->begin(), steiner->end());
  return nodes;
}

Result<delaunay::CanonicalDelaunay> create_delaunay(const Nodes& nodes, const Limits& limits) {
  if (!has_storable_delaunay(nodes.points)) {
    return Error{ErrorCode::malformed, "coordinates outside the range of mode bitmap"};
  }
  auto delaunay = delaunay::canonical_delaunay(
      nodes.points, storable_tetrahedra(nodes.points.size()), limits.poll());
  if (!delaunay) return Error{ErrorCode::malformed, delaunay.error().message};
  if (delaunay->tetrahedra.empty()) {
    return Error{ErrorCode::malformed, "the vertices of a bitmap blob span no volume"};
  }
  return delaunay;
}

Result<std::vector<bool>> read_bitmap(const BitmapSections& sections,
                                      const delaunay::CanonicalDelaunay& delaunay) {
  return read_marks(sections.bitmap, sections.bitmap_coding, delaunay);
}

std::vector<Triangle> create_surface(const delaunay::CanonicalDelaunay& delaunay,
                                     const std::vector<bool>& marks) {
  std::vector<Triangle> surface;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    if (marks[i]) surface.push_back(delaunay.faces[i]);
  }
  return surface;
}

Result<std::vector<Triangle>> read_unrecovered_faces(const BitmapSections& sections,
                                                     std::size_t point_count) {
  if (sections.unrecovered.empty()) return std::vector<Triangle>{};
  auto faces = read_face_list(sections.unrecovered, point_count);
  if (faces && faces->empty()) {
    return Error{ErrorCode::malformed, "a section of unrecovered faces is empty"};
  }
  return faces;
}

Result<SolidArrays> complete_boundary(const BitmapSections& sections, const Nodes& nodes,
                                      std::vector<Triangle> surface,
                                      const std::vector<Triangle>& unrecovered,
                                      const Limits& limits) {
  if (sections.lists_facets) {
    return read_facet_listing(sections.facets, nodes.vertex_count, limits);
  }
  const auto middle = static_cast<std::ptrdiff_t>(surface.size());
  surface.insert(surface.end(), unrecovered.begin(), unrecovered.end());
  std::inplace_merge(surface.begin(), surface.begin() + middle, surface.end());
  if (std::adjacent_find(surface.begin(), surface.end()) != surface.end()) {
    return Error{ErrorCode::malformed, "an unrecovered face is a marked Delaunay face"};
  }
  return read_facet_structure(sections.facets, sections.facet_coding, nodes.points, surface,
                              nodes.vertex_count);
}

Result<Composition> compose(const BitmapSections& sections, const Limits& limits) {
  auto nodes = read_nodes(sections, limits);
  if (!nodes) return nodes.error();
  auto delaunay = create_delaunay(*nodes, limits);
  if (!delaunay) return delaunay.error();
  auto marks = read_bitmap(sections, *delaunay);
  if (!marks) return marks.error();
  std::vector<Triangle> surface = create_surface(*delaunay, *marks);
  auto unrecovered = read_unrecovered_faces(sections, nodes->points.size());
  if (!unrecovered) return unrecovered.error();

  Composition result;
  result.counts = {static_cast<Index>(nodes->points.size()) - nodes->vertex_count,
                   static_cast<Index>(delaunay->faces.size()), static_cast<Index>(surface.size()),
                   static_cast<Index>(unrecovered->size())};
  auto arrays = complete_boundary(sections, *nodes, std::move(surface), *unrecovered, limits);
  if (!arrays) return arrays.error();
  result.arrays = std::move(arrays).value();
  nodes->points.resize(nodes->vertex_count);
  result.arrays.vertices = std::move(nodes->points);
  return result;
}

}  // namespace watertight::codec::bitmap
