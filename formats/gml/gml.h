// SPDX-License-Identifier: GPL-3.0-or-later
//
// GML 3.1.1 and 3.2 solids, alone or in features: CityGML 1 to 3, IndoorGML, any application
// schema. docs/formats.md lists what is read and what is refused. Internal to formats/.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "base/bytes.h"
#include "base/limits.h"
#include "base/result.h"
#include "formats/document.h"
#include "formats/gml/shapes.h"

namespace watertight::formats {

/// Reads a feature per top-level object that owns a solid, with the solids of its descendants.
/// Errors: malformed, unsupported, limit_exceeded; with byte offset, line, and gml:id where there
/// is one. Cost: n log n in the gml:ids, else linear; xlinks may not repeat more geometry than a
/// document of this size could write out.
Result<Document> read_gml(ByteView bytes, const ReadOptions& options);

/// The elements of a solid.
struct GmlSolidElements {
  std::vector<Index> facets;       // the node of each facet
  std::vector<GmlMember> members;  // one for each facet
  std::vector<GmlRing> rings;      // one for each ring of the solid
  bool is_y_first = false;         // positions are written y, x, z
};

/// A document with the elements of its solids, in the order of the solids of all features.
struct GmlElements {
  GmlModel model;
  std::vector<GmlSolidElements> solids;
  Document document;
};
/// Reads a document as read_gml() does, without its text.
Result<GmlElements> read_gml_elements(ByteView bytes, const ReadOptions& options);

/// The EPSG code of an srsName, 0 when there is none. Known are "EPSG:25832", URNs and URLs of the
/// OGC (of a compound system the first, horizontal code), and the codes of the German survey
/// ("urn:adv:crs:ETRS89_UTM32*DE_DHHN2016_NH").
std::uint32_t srid_of_srs_name(std::string_view name);

/// Whether positions under this srsName have their axes in the order of the authority: a URN or URL
/// of the OGC's definitions, or one of the German survey, whose names of geographic systems state
/// it. Other forms ("EPSG:4326", ".../gml/srs/epsg.xml#4326") mean x, y.
bool is_in_order_of_authority(std::string_view name);

}  // namespace watertight::formats
