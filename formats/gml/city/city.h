// SPDX-License-Identifier: GPL-3.0-or-later
//
// CityGML 1.0, 2.0 and 3.0 as CityJSON 2.0: types, ids, hierarchy, LoD, attributes, semantics of
// surfaces, addresses, appearance. docs/formats.md has the mapping.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/bytes.h"
#include "base/limits.h"
#include "base/result.h"
#include "formats/document.h"

namespace watertight::formats {

/// Elements or attributes of a GML document that its CityJSON does not have.
struct GmlLoss {
  std::string path;  // "Building/lod2TerrainIntersection"; "Polygon/@gml:id" for an attribute,
                     // "Polygon/text()" for text
  std::uint64_t count = 0;
};

struct GmlCityModel {
  Document model;               // city_json; its notes name the losses too
  std::vector<GmlLoss> losses;  // in order of their paths
};

/// Whether the members of a CityObjectGroup are its children, and so one feature with it, or stand
/// alone, each a feature as in read_gml().
enum class GroupMembers : std::uint8_t { with_group, alone };

/// The city model of a GML document, with the solids of read_gml() in the same order of facets,
/// rings and vertices. Objects need not own solids. Errors: malformed, unsupported, limit_exceeded
/// with byte offset and line (XML); unsupported when the document has several
/// reference systems. Coordinates that no grid of 2^53 steps holds are rounded, and a note says so.
/// Geometry that cannot be read is a loss. Cost: n log n; memory proportional to the document.
Result<GmlCityModel> city_model_of_gml(ByteView bytes, const Limits& limits,
                                       GroupMembers members = GroupMembers::with_group);

/// Gives a document of read_gml() the header of its city model and its features their skeletons, so
/// that a store can return them as CityJSON. The solids of a feature come into the order of the
/// city model. A feature whose solids are not those of the city model gets no skeleton, and a
/// document without city model no header; a note says so. Groups are not kept. Cost: that of
/// city_model_of_gml().
void keep_city_model(Document& document, ByteView bytes, const Limits& limits);

}  // namespace watertight::formats
