// SPDX-License-Identifier: GPL-3.0-or-later
//
// The store that a command works on. For serve, ingest, export and collections.
#pragma once

#include <memory>
#include <string>

#include "base/result.h"
#include "cli/commands.h"
#include "store/private_cluster.h"

namespace watertight::cli {

/// A connection string, with the private cluster behind it if there is one.
struct OpenedStore {
  std::unique_ptr<store::PrivateCluster> cluster;
  std::string connection;
};

/// Starts the private cluster if one is chosen; root becomes the system user `watertight` before.
/// Errors: those of drop_root_privileges() and PrivateCluster::start().
Result<OpenedStore> open_store(const StoreChoice& choice);

}  // namespace watertight::cli
