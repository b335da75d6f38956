// SPDX-License-Identifier: GPL-3.0-or-later
//
// Solids of STEP and IFC files as boundary representations. Both name the same entities: IFC
// writes IFCADVANCEDFACE(...), STEP ADVANCED_FACE('name', ...). Internal to formats/.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "formats/part21/part21.h"
#include "surfaces/boundary_representation.h"
#include "surfaces/curves/elementary.h"

namespace watertight::formats {

/// An entity with the name and the values that IFC has for it: "ADVANCEDFACE"; a complex instance
/// of a B-spline becomes one entity, and a record of several.
struct PlainEntity {
  std::uint64_t id = 0;
  std::size_t offset = 0;
  std::string type;
  std::vector<StepValue> values;
  bool is_step = false;
};

/// Reads instances as plain entities, and the numbers, points and axes in them. Errors of all
/// functions: malformed with the byte offset of the instance; limit_exceeded.
class EntityReader {
 public:
  explicit EntityReader(const Part21& file) : file_(file) {}

  Result<PlainEntity> entity(std::uint64_t id) const;
  /// The entity to which a value refers.
  Result<PlainEntity> entity(const PlainEntity& from, std::size_t value) const;
  Result<double> number(const PlainEntity& from, std::size_t value) const;
  Result<std::uint64_t> reference(const PlainEntity& from, std::size_t value) const;
  Result<std::vector<std::uint64_t>> references(const PlainEntity& from, std::size_t value) const;
  Result<std::vector<double>> numbers(const PlainEntity& from, std::size_t value) const;
  bool has(const PlainEntity& from, std::size_t value) const;

  /// The coordinates of a CARTESIANPOINT or DIRECTION; a third one that is missing is 0.
  Result<surfaces::Vector3> triple(std::uint64_t id) const;
  /// The frame of an AXIS2PLACEMENT3D or 2D.
  Result<surfaces::Frame> frame(std::uint64_t id) const;

  Error error(const PlainEntity& from, const std::string& message) const;
  const Part21& file() const { return file_; }

 private:
  const Part21& file_;
};

/// The name of an entity without "IFC" and underscores.
std::string plain_type(std::string_view type);
bool is_solid_type(std::string_view plain);

/// A solid, in the units of the file.
struct ReadBoundary {
  surfaces::BoundaryRepresentation solid;
  std::vector<std::string> notes;
};

/// Reads one solid: (FACETED, MANIFOLD SOLID, ADVANCED) BREP, with voids or without,
/// POLYGONALFACESET, TRIANGULATEDFACESET. `radians` is the unit of angles. A face that cannot be
/// read stays as one that is unreadable. Errors: malformed, limit_exceeded; unsupported for other
/// entities. Cost: linear.
Result<ReadBoundary> read_boundary(const Part21& file, std::uint64_t id, double radians,
                                   const Limits& limits);

}  // namespace watertight::formats
