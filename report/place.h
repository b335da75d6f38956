// SPDX-License-Identifier: GPL-3.0-or-later
//
// The findings of the solids and groups of a feature, and their places. Internal to report/.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/pipeline.h"
#include "validate/report_json.h"

namespace watertight::report {

/// A finding with the solids that its places are in.
struct PlacedFinding {
  const Finding* finding = nullptr;
  Index solid = kNone;        // index in InspectedFeature::solids, for Finding::place
  Index other_solid = kNone;  // index in InspectedFeature::solids, for Finding::other
  const pipeline::InspectedGroup* group = nullptr;  // null: a finding about one solid
};

/// The findings in order of solids, then groups. A finding about a whole group is placed in its
/// first member.
std::vector<PlacedFinding> findings_of(const pipeline::InspectedFeature& feature);

/// The solid with index `solid` that was submitted, or null for kNone.
const Solid* submitted_solid(const pipeline::InspectedFeature& feature, Index solid);

/// The point at which to look: the witness, else the vertex, else the middle of the facet's
/// exterior ring, else nullopt. World coordinates.
std::optional<std::array<double, 3>> point_of(const pipeline::InspectedFeature& feature,
                                              const PlacedFinding& placed);

/// A place in a solid as words: "shell 1 facet 5 ring 2 vertex 7". The shell is left out where the
/// solid has only one and a facet is named, or where the solid is unknown (null).
std::string place_words(const Place& place, const Solid* solid);

/// A text of a document, with "..." after 300 bytes. Findings of one solid all have its name: so
/// their memory stays in proportion to the document, however long the name is.
std::string shortened(std::string_view text);

/// val3dity's path of a solid: "coid=b|geom=0|solid=1".
std::string solid_id(const SolidSource& source);

/// The options with which places in a solid of a feature are written.
validate::ReportJsonOptions json_options_of(const SolidSource& source, Index solid);

/// The JSON Pointer of a place in the document, "" when there is none.
std::string pointer_of(const pipeline::InspectedFeature& feature, Index solid, const Place& place);

/// The name of a reference system in documents, "urn:ogc:def:crs:EPSG::7415"; "" for 0.
std::string crs_name(std::uint32_t srid);

/// val3dity's name for a format: "CityJSON", "OBJ", ...
std::string_view format_name(Format format);

}  // namespace watertight::report
