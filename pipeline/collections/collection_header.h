// SPDX-License-Identifier: GPL-3.0-or-later
//
// The header under which a CityJSONFeature alone belongs to a collection.
#pragma once

#include <string>

#include "store/solid_store.h"

namespace watertight::pipeline {

/// The one header of the features of a collection, "" when there is none or no collection. Errors:
/// conflict when the features have several headers, as a feature alone would be read wrongly; those
/// of the store.
Result<std::string> collection_header(SolidStore& store, const std::string& collection);

}  // namespace watertight::pipeline
