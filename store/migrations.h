// SPDX-License-Identifier: GPL-3.0-or-later
//
// The numbered steps that bring a database to the schema this program works with. All objects are
// in the schema `watertight`. A released step is never changed; a later step corrects it.
#pragma once

#include "base/result.h"
#include "store/connection.h"
#include "store/moved_rows.h"

namespace watertight::store {

/// Applies the missing migrations, under an advisory lock, so that any number of instances may
/// start at the same time: the schema in one transaction, then the rows of old tables in many; a
/// call that was broken off is continued by the next one. Needs no right to create anything when
/// none is missing. Then the view watertight.city is made where it can be (rows/city_view.h).
/// `tell` (may be empty) takes sentences about the progress. Errors: unsupported when the database
/// was migrated by a newer program; unavailable; those of move_rows().
Status migrate(DatabaseSession& connection, const Tell& tell = {});

/// Ok when the schema is the one of this program. Errors: unavailable, unsupported.
Status check_schema(DatabaseSession& connection);

}  // namespace watertight::store
