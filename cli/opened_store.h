// SPDX-License-Identifier: GPL-3.0-or-later
//
// The store that a command works on. For serve, ingest, export and collections.
#pragma once

#include <memory>
#include <string>

#include "base/result.h"
#include "cli/commands.h"
#include "server/serve.h"
#include "store/private_cluster.h"
#include "store/solid_store.h"

namespace watertight::cli {

/// A database, with the private cluster behind it if there is one.
struct OpenedDatabase {
  std::unique_ptr<store::PrivateCluster> cluster;
  std::string connection;
  std::string data_directory;  // of the cluster
};

/// Gives up the rights that only root has, and those that the program never needs: with a data
/// directory, root becomes the system user `watertight`. To be called before the first thread
/// starts. Errors: those of drop_root_privileges() and forbid_new_privileges().
Status give_up_rights(const StoreChoice& choice);

/// Starts the private cluster if one is chosen; a signal ends that. Errors: those of
/// PrivateCluster::start().
Result<OpenedDatabase> open_database(const StoreChoice& choice, const server::StopSignals& signals);

/// A store for a command that ends by itself. The cluster outlives the store.
struct OpenedStore {
  std::unique_ptr<store::PrivateCluster> cluster;
  std::unique_ptr<SolidStore> store;
};

/// Gives up rights, starts the private cluster if one is chosen, and opens the store. Errors: those
/// of the functions above and of open_postgres_store(); cancelled by a signal.
Result<OpenedStore> open_store(const StoreChoice& choice);

}  // namespace watertight::cli
