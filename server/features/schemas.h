// SPDX-License-Identifier: GPL-3.0-or-later
//
// Properties of features as JSON Schemas (OGC API - Common, part 3: schemas). Internal to server/.
#pragma once

#include "server/json_answers.h"

namespace watertight::server {

/// The JSON types of the values of a chosen attribute.
Json json_types(const store::ChosenAttribute& attribute);

}  // namespace watertight::server
