// SPDX-License-Identifier: GPL-3.0-or-later
//
// Filters as SQL. For postgres_store.cpp and the files of this folder only.
#pragma once

#include <string>

#include "store/connection.h"
#include "store/filter.h"

namespace watertight::store {

/// A clause of a WHERE that selects the features `f` for which a filter is true; $1 is the
/// collection. Adds its parameters, the first of which is $`next`, and counts `next` up. The texts
/// of the filter are parameters only.
std::string filter_clause(const Filter& filter, int& next, Parameters& parameters);

/// The clause of a comparison of the column of a value `v` with a parameter, which it adds.
std::string value_clause(Comparison comparison, const AttributeValue& value, int& next,
                         Parameters& parameters);

}  // namespace watertight::store
