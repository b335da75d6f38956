// SPDX-License-Identifier: GPL-3.0-or-later
//
// City models as CityGML 2.0 with GML 3.1.1, which more programs read than any other version.
// docs/formats.md has the mapping.
#pragma once

#include <string>

#include "base/result.h"
#include "formats/document.h"

namespace watertight::formats {

/// The CityGML of a document that is a city model (CityJSON, CityJSONSeq). Coordinates keep their
/// digits. Comments at its end name the parts for which CityGML 2.0 has no place. Errors: those of
/// write_feature(); limit_exceeded for coordinates that spread over more than 2^53 steps. Cost: n
/// log n.
Result<std::string> write_city_gml(const Document& document);

}  // namespace watertight::formats
