// SPDX-License-Identifier: GPL-3.0-or-later
//
// Moves materials, textures and texture vertices of CityJSON from a document into a feature that
// uses them, and from features into one document. Internal to formats/.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "formats/text/json.h"

namespace watertight::formats {

/// A growing list of distinct JSON values.
class DistinctValues {
 public:
  /// The index of `value`, which is appended if it is new.
  std::size_t position_of(const Json& value);
  Json take() { return Json(std::move(values_)); }
  bool is_empty() const { return values_.empty(); }

 private:
  Json::array_t values_;
  std::unordered_map<std::string, std::size_t> position_;  // the index in values_, by the text of
                                                           // the value
};

/// An index that refers to nothing.
inline constexpr std::uint32_t kDangling = 0xFFFFFFFF;

/// Collects the materials, textures and texture vertices to which geometries refer, and renumbers
/// the references.
class AppearanceCollector {
 public:
  /// Takes over all values of `appearance` in their order, so that references to them keep their
  /// numbers (unless a value occurs twice). `appearance` is null when the document has none.
  void include(const Json* appearance);

  /// Makes `geometry`, whose indices refer to `source`, refer to this collection. An index that
  /// refers to nothing becomes kDangling, which refers to nothing in any list.
  /// Errors, after all other indices are changed: malformed for the first such index (JSON Pointer
  /// within the geometry).
  Status adopt(Json& geometry, const Json* source);

  /// The `appearance` object, null when nothing was collected. `themes` gives the members that are
  /// not lists (default themes), or is null.
  Json take(const Json* themes);

 private:
  DistinctValues materials_;
  DistinctValues textures_;
  DistinctValues texture_vertices_;
};

}  // namespace watertight::formats
