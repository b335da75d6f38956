// SPDX-License-Identifier: GPL-3.0-or-later
//
// The rules, one function per group. Each looks at an examined solid and adds findings; none
// depends on another having passed, but for what it says. Order of calls: as listed. Internal to
// validate/.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/cancel.h"
#include "delaunay/shell_contacts.h"
#include "validate/examined_solid.h"

namespace watertight::validate {

/// 902.
void check_not_empty(ExaminedSolid& examined);
/// 101, 102, 104 and, because they come out of the same search, 201, 202, 206, 207.
void check_rings(ExaminedSolid& examined);
/// 103: rings that the reader found open.
void check_closed_rings(ExaminedSolid& examined, std::span<const Index> unclosed);
/// 203, 204, 205, 208. Returns why a facet could not be measured, "" if all were.
std::string check_facets(ExaminedSolid& examined);

/// The facts about a shell's topology that check_shells establishes.
struct ShellTopology {
  bool is_closed = false;    // every edge is met exactly twice
  bool is_manifold = false;  // every edge and every vertex is as in a 2-manifold
  bool is_oriented = false;  // neighbouring facets turn the same way
  bool is_connected = false;
  bool is_sound() const { return is_closed && is_manifold && is_oriented && is_connected; }
};

/// 300, 301, 302, 303, 305, 307.
std::vector<ShellTopology> check_shells(ExaminedSolid& examined);
/// 402. Returns for each shell the earlier shell that equals it, or kNone.
std::vector<Index> check_duplicate_shells(ExaminedSolid& examined);

/// Two shells, the smaller first.
using ShellPair = std::pair<Index, Index>;

/// Triangles of different facets that intersect and make a finding.
struct TrianglePair {
  Index first_facet = 0;  // the smaller
  Index second_facet = 0;
  Index first = 0;  // triangle of first_facet
  Index second = 0;
};

struct ShellContacts {
  std::vector<ShellPair> intersecting;  // shells whose facets cross or overlap; sorted
  std::vector<bool> is_touching;        // shell -> whether it has a point in common with another
  std::string incomplete;               // why the search did not finish; "" when it did
  std::vector<TrianglePair> found;  // all pairs of triangles of the facets with a finding; sorted
};

/// 306 and 401: facets that intersect. Facets of different shells may touch in points and edges;
/// duplicate shells are not compared with each other.
ShellContacts check_intersections(ExaminedSolid& examined, const std::vector<Index>& duplicate_of,
                                  const CancelPoll& cancel, unsigned threads);
/// Warning 804: facets that are not exactly planar, where another diagonal would make or undo a
/// finding 306 or 401.
void check_diagonals(ExaminedSolid& examined, const ShellContacts& contacts);
/// 401 (shells that cross in vertices and edges, nested cavities), 403, 405; warning 806. Returns
/// "" if it is known of each shell where it lies to the others, else the reason why it is not
/// known.
std::string check_solid(ExaminedSolid& examined, const std::vector<ShellTopology>& shells,
                        const std::vector<Index>& duplicate_of, const ShellContacts& contacts);
/// 404, and warning 804 where another diagonal makes or undoes it. Requires sound shells that
/// passed every other rule. False if it could not be decided: where the divided triangles form no
/// complex, as when edges of shells cross in a point that is no vertex.
bool check_interior(ExaminedSolid& examined, const delaunay::ContactTriangles& contacts);
/// Warnings: 801, 802 (with those that the reader left out), 803.
void check_vertices(ExaminedSolid& examined, const geometry::UnusedVertices& left_out);
/// Warning 805: vertices that the reader rounded.
void check_rounded(ExaminedSolid& examined, std::span<const Index> rounded);
/// Warning 805 of a solid that was moved as a whole.
void report_rounded_origin(ExaminedSolid& examined);

/// The codes that val3dity, which stops at the first level that fails, would give.
std::vector<int> first_level_codes(const std::vector<Finding>& findings);

}  // namespace watertight::validate
