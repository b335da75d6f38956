// SPDX-License-Identifier: GPL-3.0-or-later
// The values of chosen attributes as rows. Each function is a part of a transaction that the caller
// begins and ends. For postgres_store.cpp and the files of this folder only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "store/connection.h"
#include "store/rows/feature_rows.h"
#include "store/rows/shared_rows.h"
#include "store/solid_store.h"

namespace watertight::store {

/// Replaces the values of all chosen attributes for features of one collection that were written in
/// this transaction. Requires the gate of the collection. Errors: those of the reader; unsupported
/// without one.
Status write_attributes(DatabaseSession& connection, std::string_view collection,
                        FeatureRefs features, const AttributeReader& reader);

/// The clauses of a WHERE that select the features `f` for which all conditions hold; $1 is the
/// collection. Adds its parameters, the first of which is $`next`.
std::string attribute_clauses(std::span<const AttributeCondition> conditions, int next,
                              Parameters& parameters);

/// Ok when all attributes are chosen and complete. Errors: invalid_argument.
Status check_names(DatabaseSession& connection, const std::string& collection,
                   std::span<const std::string> names);

/// Errors: not_found.
Result<std::vector<ChosenAttribute>> read_attributes(DatabaseSession& connection,
                                                     const std::string& collection);

/// Adds and removes names of a collection. Waits for its writers. Errors: not_found,
/// invalid_argument.
Result<Done> choose_attributes(DatabaseSession& connection, const std::string& collection,
                               const AttributeChange& change);

/// Keeps the values of some more features for the attributes that are least complete. Returns the
/// share of the features that have them; 1 when all attributes are complete.
Result<double> fill_attributes(DatabaseSession& connection, const std::string& collection,
                               SharedRows& shared, const AttributeReader& reader);

/// Deletes some values of an attribute that is not chosen any more. False when there is none.
Result<bool> purge_attributes(DatabaseSession& connection);

}  // namespace watertight::store
