// SPDX-License-Identifier: GPL-3.0-or-later
//
// The numbered steps that bring a database to the schema this program works with. All objects are
// in the schema `watertight`. A released step is never changed; a later step corrects it.
#pragma once

#include "base/result.h"
#include "store/connection.h"

namespace watertight::store {

/// Applies the missing migrations in one transaction, under an advisory lock, so that any number of
/// instances may start at the same time. Needs no right to create anything when none is missing.
/// Errors: unsupported when the database was migrated by a newer program; unavailable.
Status migrate(DatabaseSession& connection);

/// Ok when the schema is the one of this program. Errors: unavailable, unsupported.
Status check_schema(DatabaseSession& connection);

}  // namespace watertight::store
