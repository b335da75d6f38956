// SPDX-License-Identifier: GPL-3.0-or-later
//
// A CityJSON that a file has as one feature, so that its bytes come back.
#pragma once

#include "formats/city_json/city_json.h"

namespace watertight::pipeline {

/// Whether a feature is a CityJSON as a whole.
bool is_whole_model(const Feature& feature);

/// Its features, as a reader of its text finds them. Errors: those of the writer and the reader of
/// CityJSON.
Result<Document> split_model(const formats::CityHeader& header, const Feature& model,
                             const Limits& limits);

}  // namespace watertight::pipeline
