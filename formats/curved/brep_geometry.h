// SPDX-License-Identifier: GPL-3.0-or-later
//
// Curves and surfaces in JSON (docs/formats.md, "Boundary representations in JSON"). Internal to
// formats/curved/.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "formats/text/json.h"
#include "surfaces/curves/pieces.h"

namespace watertight::formats {

/// A JSON value with its JSON Pointer. Errors of its functions: malformed with the pointer.
struct BrepValue {
  const Json& json;
  std::string pointer;

  Error wrong(std::string message) const;
  bool has(std::string_view key) const { return find_member(json, key) != nullptr; }
  Result<BrepValue> member(std::string_view key) const;
  /// An array, with at least `fewest` values.
  Result<BrepValue> array(std::string_view key, std::size_t fewest = 0) const;
  BrepValue at(std::size_t index) const;

  Result<double> number() const;
  Result<double> positive(std::string_view key) const;
  Result<surfaces::Vector3> point() const;
  Result<std::vector<double>> numbers() const;
  /// A member that is true or false; false if there is none.
  Result<bool> flag(std::string_view key) const;
  /// A whole number from `low` to `high`.
  Result<std::int64_t> whole(std::int64_t low, std::int64_t high) const;
};

/// Errors of both: malformed, limit_exceeded for a degree that is too high; unsupported for a kind
/// that is not known.
Result<surfaces::Curve> curve_in(const BrepValue& from);
Result<surfaces::Surface> surface_in(const BrepValue& from);

}  // namespace watertight::formats
