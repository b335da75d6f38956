// SPDX-License-Identifier: GPL-3.0-or-later
//
// Moves the features of the tables before schema 9 into those of today, some at a time.
#pragma once

#include <functional>

#include "base/result.h"
#include "store/connection.h"
#include "store/solid_store.h"

namespace watertight::store {

/// Moves all features, in transactions of some hundred; what was moved stays moved when it is
/// broken off, and the next call goes on. Versions stay. Then drops the old tables and runs
/// `finish`, in one transaction. Requires that no other session does the same. Errors: those of the
/// session; malformed, which names a feature whose text cannot be read.
Status move_rows(DatabaseSession& connection, const Tell& tell,
                 const std::function<Status(DatabaseSession&)>& finish);

}  // namespace watertight::store
