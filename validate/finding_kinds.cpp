// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/finding_kinds.h"

#include <algorithm>
#include <array>

#include "validate/groups.h"

namespace watertight::validate {
namespace {

constexpr Severity kError = Severity::error;
constexpr Severity kWarning = Severity::warning;

constexpr std::array kKinds{
    FindingKind{101, "TOO_FEW_POINTS", kError, "a ring has fewer than three points",
                "Drop the ring, or restore the points that were lost.", true},
    FindingKind{102, "CONSECUTIVE_POINTS_SAME", kError, "a ring has the same point twice in a row",
                "Keep one of the equal points.", true},
    FindingKind{103, "RING_NOT_CLOSED", kError, "a ring does not end where it starts",
                "Repeat the first point of the ring at its end.", true},
    FindingKind{104, "RING_SELF_INTERSECTION", kError, "a ring meets itself or has no area",
                "Put the points in order, or split a ring that touches itself.", false},
    FindingKind{201, "INTERSECTION_RINGS", kError, "two rings of a facet meet",
                "Cut or join the openings so that rings have single points in common at most.",
                false},
    FindingKind{202, "DUPLICATED_RINGS", kError, "two rings of a facet are the same",
                "Remove one of the two rings.", true},
    FindingKind{203, "NON_PLANAR_POLYGON_DISTANCE_PLANE", kError,
                "a point is too far from its facet's plane",
                "Move the point onto the plane, or split the facet into planar parts.", false},
    FindingKind{204, "NON_PLANAR_POLYGON_NORMALS_DEVIATION", kError,
                "the directions of two triangles of a facet differ too much",
                "Move the vertex onto the plane, or make the fold a facet of its own.", false},
    FindingKind{205, "POLYGON_INTERIOR_DISCONNECTED", kError, "the interior of a facet is in parts",
                "Write each part as a facet of its own.", true},
    FindingKind{206, "INNER_RING_OUTSIDE", kError,
                "an interior ring lies outside the exterior ring",
                "Move the ring to its facet, or make the outermost ring the first.", false},
    FindingKind{207, "INNER_RINGS_NESTED", kError, "an interior ring lies inside another",
                "Make the island a facet of its own.", false},
    FindingKind{208, "ORIENTATION_RINGS_SAME", kError,
                "an interior ring turns the same way as the exterior ring",
                "Reverse the interior ring.", true},
    FindingKind{300, "NOT_VALID_2_MANIFOLD", kError,
                "a shell has only one side: its facets cannot be turned alike",
                "Find the strip of facets that joins inside and outside, and rebuild it.", false},
    FindingKind{301, "TOO_FEW_POLYGONS", kError, "a shell has fewer than four facets",
                "Complete the shell or remove it.", false},
    FindingKind{
        302, "SHELL_NOT_CLOSED", kError, "a shell has open edges",
        "Add the missing facet, or insert the missing vertex on the other side of the edge.",
        false},
    FindingKind{303, "NON_MANIFOLD_CASE", kError, "an edge or a vertex is not 2-manifold",
                "Write parts that touch as solids of their own, and remove inner walls.", false},
    FindingKind{305, "MULTIPLE_CONNECTED_COMPONENTS", kError, "a shell is in parts",
                "Write each part as a solid of its own, or as an inner shell if it is a cavity.",
                false},
    FindingKind{306, "SHELL_SELF_INTERSECTION", kError, "two facets of a shell intersect",
                "Cut both facets where they meet and drop the parts inside.", false},
    FindingKind{307, "POLYGON_WRONG_ORIENTATION", kError, "a facet is turned over",
                "Reverse all rings of the facet.", true},
    FindingKind{401, "INTERSECTION_SHELLS", kError, "two shells intersect or share a face",
                "Join cavities that meet, or move them apart.", false},
    FindingKind{402, "DUPLICATED_SHELLS", kError, "two shells are the same",
                "Remove one of the two shells.", true},
    FindingKind{403, "INNER_SHELL_OUTSIDE", kError,
                "an inner shell lies outside the exterior shell",
                "Write it as a solid of its own, or make the exterior shell the first.", false},
    FindingKind{404, "SOLID_INTERIOR_DISCONNECTED", kError, "the interior of the solid is in parts",
                "Write each part as a solid of its own, or open the connection.", false},
    FindingKind{405, "WRONG_ORIENTATION_SHELL", kError, "a shell's normals point the wrong way",
                "Reverse every ring of the shell.", true},
    FindingKind{501, "INTERSECTION_SOLIDS", kError, "two members of a composite solid overlap",
                "Cut one of the two so that they share a face at most.", false},
    FindingKind{502, "DUPLICATED_SOLIDS", kError, "two members of a composite solid are the same",
                "Remove one of the two solids.", true},
    FindingKind{503, "DISCONNECTED_SOLIDS", kError,
                "no common faces connect all members of a composite solid",
                "Write the separate parts as a multi solid.", false},
    FindingKind{601, "BUILDINGPARTS_OVERLAP", kError, "two parts of a building overlap",
                "Cut one of the two so that they share a face at most.", false},
    FindingKind{701, "CELLS_OVERLAP", kError, "two cells of an indoor model overlap",
                "Cut one of the two so that they share a face at most.", false},
    FindingKind{702, "DUAL_VERTEX_OUTSIDE_CELL", kError,
                "the state of a cell lies outside the cell",
                "Move the state into its cell, or link it to the cell in which it lies.", false},
    FindingKind{703, "PRIMAL_DUAL_XLINKS_ERROR", kError,
                "a reference between cells, states and transitions is wrong",
                "Let the cell and its state refer to each other, and the transition to two states.",
                false},
    FindingKind{704, "PRIMAL_DUAL_ADJACENCIES_INCONSISTENT", kError,
                "a transition joins two cells that do not touch",
                "Remove the transition, or close the gap between the two cells.", false},
    FindingKind{801, "NEAR_DUPLICATE_VERTICES", kWarning, "two vertices are nearly the same",
                "Merge the vertices, or ask for a snap tolerance.", false},
    FindingKind{802, "UNUSED_VERTICES", kWarning, "a vertex is used by no ring",
                "Remove the vertices.", true},
    FindingKind{803, "SLIVER_FACET", kWarning, "a facet is very narrow",
                "Merge the two long sides of the facet.", false},
    FindingKind{804, "TRIANGULATION_DEPENDENT_FACET", kWarning,
                "another diagonal of a facet that is not exactly planar changes the verdict",
                "Split the facet into triangles, so that every reader sees the same surface.",
                false},
    FindingKind{805, "COORDINATES_ROUNDED", kWarning, "source digits did not fit and were rounded",
                "Write fewer digits, or shift the origin.", false},
    FindingKind{806, "ZERO_VOLUME", kWarning, "a closed shell encloses no volume",
                "Remove the shell, or restore its lost thickness.", false},
    FindingKind{901, "INVALID_INPUT_FILE", kError, "the input could not be read",
                "Mend the input at the place that the message names.", false},
    FindingKind{902, "EMPTY_PRIMITIVE", kError, "the solid has no facets",
                "Remove the geometry, or restore its facets.", false},
    FindingKind{903, "WRONG_INPUT_PARAMETERS", kError,
                "a parameter of the validation has a value that is not allowed",
                "State a parameter within its range.", false},
    FindingKind{904, "FORMAT_NOT_SUPPORTED", kError, "the format of the input cannot be read",
                "Convert the input to a format that can be read.", false},
};

}  // namespace

std::span<const FindingKind> finding_kinds() { return kKinds; }

const FindingKind* find_kind(int code) {
  const auto place = std::lower_bound(kKinds.begin(), kKinds.end(), code,
                                      [](const FindingKind& kind, int c) { return kind.code < c; });
  return place != kKinds.end() && place->code == code ? &*place : nullptr;
}

std::string_view finding_name(int code) {
  const FindingKind* kind = find_kind(code);
  return kind == nullptr ? std::string_view{} : kind->name;
}

int finding_level(int code) {
  if (code >= 900) return 0;
  if (code >= 800) return 9;  // warnings
  return code / 100;
}

std::string_view to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::valid:
      return "valid";
    case Verdict::invalid:
      return "invalid";
    case Verdict::undecided:
      break;
  }
  return "undecided";
}

std::string_view to_string(GroupKind kind) {
  switch (kind) {
    case GroupKind::composite_solid:
      return "composite_solid";
    case GroupKind::building_parts:
      return "building_parts";
    case GroupKind::indoor_cells:
      break;
  }
  return "indoor_cells";
}

std::string_view to_string(Severity severity) {
  return severity == Severity::error ? "error" : "warning";
}

std::set<int> error_codes(std::span<const Finding> findings) {
  std::set<int> codes;
  for (const Finding& finding : findings) {
    if (finding.severity == Severity::error) codes.insert(finding.code);
  }
  return codes;
}

}  // namespace watertight::validate
