// SPDX-License-Identifier: GPL-3.0-or-later
//
// The properties of features as a table of EXT_structural_metadata. Internal to tiles/.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "tiles/feature_mesh.h"

namespace watertight::tiles {

/// A column of the table.
struct PropertyColumn {
  std::string id;    // as the extension allows it
  std::string name;  // of the attribute
  bool is_number = false;
  std::vector<double> numbers;         // of each feature, if it is one
  std::string text;                    // the texts of all features, else
  std::vector<std::uint32_t> offsets;  // of each text, and the end of the last one
};

/// The value of a number that a feature does not have.
inline constexpr double kNoNumber = -1.7976931348623157e308;
/// The most columns of a table; attributes beyond are left out.
inline constexpr std::size_t kMostColumns = 256;

/// The columns: id and type, then the attributes in the order in which features have them.
std::vector<PropertyColumn> property_columns(std::span<const FeatureMesh* const> features);

/// The class of the columns (schema.classes).
nlohmann::ordered_json property_class(std::span<const PropertyColumn> columns);

}  // namespace watertight::tiles
