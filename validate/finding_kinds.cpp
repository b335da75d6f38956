// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/finding_kinds.h"

#include <algorithm>
#include <array>

namespace watertight {
namespace {

constexpr Severity kError = Severity::error;
constexpr Severity kWarning = Severity::warning;

constexpr std::array kKinds{
    FindingKind{101, "TOO_FEW_POINTS", kError, "a ring has fewer than three points"},
    FindingKind{102, "CONSECUTIVE_POINTS_SAME", kError, "a ring repeats a point in a row"},
    FindingKind{104, "RING_SELF_INTERSECTION", kError, "a ring meets itself or has no area"},
    FindingKind{201, "INTERSECTION_RINGS", kError, "two rings of a facet meet"},
    FindingKind{202, "DUPLICATED_RINGS", kError, "two rings of a facet are the same"},
    FindingKind{203, "NON_PLANAR_POLYGON_DISTANCE_PLANE", kError,
                "a point is too far from its facet's plane"},
    FindingKind{204, "NON_PLANAR_POLYGON_NORMALS_DEVIATION", kError,
                "two triangles of a facet face too different ways"},
    FindingKind{205, "POLYGON_INTERIOR_DISCONNECTED", kError,
                "the interior of a facet is in parts"},
    FindingKind{206, "INNER_RING_OUTSIDE", kError,
                "an interior ring lies outside the exterior ring"},
    FindingKind{207, "INNER_RINGS_NESTED", kError, "an interior ring lies inside another"},
    FindingKind{208, "ORIENTATION_RINGS_SAME", kError,
                "an interior ring turns the same way as the exterior ring"},
    FindingKind{301, "TOO_FEW_POLYGONS", kError, "a shell has fewer than four facets"},
    FindingKind{302, "SHELL_NOT_CLOSED", kError, "a shell has open edges"},
    FindingKind{303, "NON_MANIFOLD_CASE", kError, "an edge or a vertex is not 2-manifold"},
    FindingKind{305, "MULTIPLE_CONNECTED_COMPONENTS", kError, "a shell is in parts"},
    FindingKind{306, "SHELL_SELF_INTERSECTION", kError, "two facets of a shell intersect"},
    FindingKind{307, "POLYGON_WRONG_ORIENTATION", kError, "a facet is turned over"},
    FindingKind{401, "INTERSECTION_SHELLS", kError, "two shells intersect or share a face"},
    FindingKind{402, "DUPLICATED_SHELLS", kError, "two shells are the same"},
    FindingKind{403, "INNER_SHELL_OUTSIDE", kError,
                "an inner shell lies outside the exterior shell"},
    FindingKind{404, "SOLID_INTERIOR_DISCONNECTED", kError,
                "the interior of the solid is in parts"},
    FindingKind{405, "WRONG_ORIENTATION_SHELL", kError, "a shell's normals point the wrong way"},
    FindingKind{801, "NEAR_DUPLICATE_VERTICES", kWarning, "two vertices are nearly the same"},
    FindingKind{802, "UNUSED_VERTICES", kWarning, "a vertex is used by no ring"},
    FindingKind{803, "SLIVER_FACET", kWarning, "a facet is very narrow"},
    FindingKind{805, "COORDINATES_ROUNDED", kWarning, "source digits did not fit and were rounded"},
    FindingKind{902, "EMPTY_PRIMITIVE", kError, "the solid has no facets"},
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
  if (code >= 800) return 9;
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

std::string_view to_string(Severity severity) {
  return severity == Severity::error ? "error" : "warning";
}

}  // namespace watertight
