// SPDX-License-Identifier: GPL-3.0-or-later
//
// Decides how two triangles meet, by orientation predicates alone: exactly, for any finite doubles.
// For the self-intersection rule and the certificate.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "geometry/point.h"

namespace watertight::geometry {

/// The kind of the common part of two triangles. The triangles of a boundary may meet in the first
/// three ways; each of the others is an intersection in the sense of Verbree and Si 2008, section
/// 3.2: the common part is not a vertex or an edge of both. The values are ordered by severity.
enum class ContactClass : std::uint8_t {
  disjoint = 0,
  shared_vertex,     // the common part is one vertex of both triangles (one index)
  shared_edge,       // the common part is one edge of both triangles (two indices)
  vertex_vertex,     // touching: two vertices of different index have equal coordinates
  vertex_edge,       // touching: a vertex inside an edge
  vertex_face,       // touching: a vertex inside the other triangle
  edge_edge,         // touching: two edges cross at one point inside both edges
  edge_overlap,      // touching: edges overlap along a segment
  edge_face,         // touching: an edge, or a part of it, lies inside the other triangle
  crossing,          // the insides cross along a segment
  coplanar_overlap,  // the insides share an area
  duplicate          // both triangles have the same three points
};

/// The class as lower-case words, e.g. "vertex-edge".
std::string_view to_string(ContactClass contact);

/// True for a contact that the triangles of a boundary must not have.
inline bool is_intersection(ContactClass contact) { return contact > ContactClass::shared_edge; }

/// Classifies two triangles. Vertices with one index are one vertex; equal points under different
/// indices touch. Symmetric in the triangles, and independent of the order of their vertices.
/// Requires indices in range and two triangles that are not degenerate (three different indices
/// of points that are not on one line).
/// Cost: at most 10 orientation tests; 1 for triangles with a common edge.
/// Source: Verbree and Si 2008, section 3.2, after Guigue and Devillers 2003.
ContactClass classify_contact(std::span<const Point> points, const Triangle& first,
                              const Triangle& second);

/// A point that both triangles contain: the mean of the corners of their common part, computed in
/// exact rationals and rounded once to the nearest doubles. For reports only, never for decisions.
/// Requires two triangles that are not degenerate and not disjoint. Cost: some 50 microseconds.
Point contact_witness(std::span<const Point> points, const Triangle& first, const Triangle& second);

}  // namespace watertight::geometry
