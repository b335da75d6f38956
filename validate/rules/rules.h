// SPDX-License-Identifier: GPL-3.0-or-later
//
// The rules, several in each function. A function examines a solid and adds findings; it requires
// that others have passed only where its comment says so. The functions are called in the order of
// this file. Internal to validate/.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/cancel.h"
#include "delaunay/shell_contacts.h"
#include "validate/examined_solid.h"

namespace watertight::validate {

/// Rule 902.
void check_not_empty(ExaminedSolid& examined);
/// Rules 101, 102, 104, 201, 202, 206 and 207.
void check_rings(ExaminedSolid& examined);
/// Rule 103. `unclosed` are the rings that the reader found open.
void check_closed_rings(ExaminedSolid& examined, std::span<const Index> unclosed);
/// Rules 203, 204, 205 and 208. Returns the reason why a facet could not be measured, "" if all
/// facets were measured.
std::string check_facets(ExaminedSolid& examined);

/// The facts that check_shells() finds about the topology of a shell.
struct ShellTopology {
  bool is_closed = false;    // every edge is met exactly twice
  bool is_manifold = false;  // no edge is met more than twice, and each vertex has one fan
  bool is_oriented = false;  // neighbouring facets turn the same way
  bool is_connected = false;
  bool is_sound() const { return is_closed && is_manifold && is_oriented && is_connected; }
};

/// Rules 300, 301, 302, 303, 305 and 307.
std::vector<ShellTopology> check_shells(ExaminedSolid& examined);
/// Rule 402. Returns for each shell the first shell that equals it, or kNone.
std::vector<Index> check_duplicate_shells(ExaminedSolid& examined);

/// Two shells, the smaller first.
using ShellPair = std::pair<Index, Index>;

/// Triangles of different facets that intersect and make a finding.
struct TrianglePair {
  Index first_facet = 0;   // the smaller facet
  Index second_facet = 0;  // the larger facet
  Index first = 0;         // a triangle of first_facet
  Index second = 0;        // a triangle of second_facet
};

struct ShellContacts {
  std::vector<ShellPair> intersecting;  // shells whose facets cross or overlap; sorted
  std::vector<bool> is_touching;        // shell -> whether it has a point in common with another
  std::string incomplete;               // the reason why the search did not finish, or ""
  std::vector<TrianglePair> found;  // all pairs of triangles of the facets with a finding; sorted
};

/// Rules 306 and 401: facets that intersect. Facets of different shells may touch in points and
/// edges; duplicate shells are not compared with each other.
ShellContacts check_intersections(ExaminedSolid& examined, const std::vector<Index>& duplicate_of,
                                  const CancelPoll& cancel, unsigned threads);
/// Warning 804: facets that are not exactly planar, where another diagonal would make or undo a
/// finding 306 or 401.
void check_diagonals(ExaminedSolid& examined, const ShellContacts& contacts);
/// Rules 401 (shells that cross in vertices and edges, nested cavities), 403 and 405; warning 806.
/// Returns the reason why a shell could not be located in or beside another, "" if all were
/// located.
std::string check_solid(ExaminedSolid& examined, const std::vector<ShellTopology>& shells,
                        const std::vector<Index>& duplicate_of, const ShellContacts& contacts);
/// Rule 404, and warning 804 where another diagonal makes or undoes a finding 404. Requires sound
/// shells that passed every other rule. False if 404 could not be decided because the divided
/// triangles form no complex, as when edges of shells cross in a point that is no vertex.
bool check_interior(ExaminedSolid& examined, const delaunay::ContactTriangles& contacts);
/// Warnings 801, 802 and 803. `left_out` are the unused vertices that the reader left out.
void check_vertices(ExaminedSolid& examined, const geometry::UnusedVertices& left_out);
/// Warning 805 for vertices that the reader rounded.
void check_rounded(ExaminedSolid& examined, std::span<const Index> rounded);
/// Warning 805 for a solid whose origin was rounded, so that all of its points moved together.
void report_rounded_origin(ExaminedSolid& examined);

/// The codes that val3dity would report, which stops at the first level that fails; sorted.
std::vector<int> first_level_codes(const std::vector<Finding>& findings);

}  // namespace watertight::validate
