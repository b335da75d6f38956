// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/opened_store.h"

#include <filesystem>
#include <system_error>
#include <utility>

#include "cli/terminal/printable.h"
#include "pipeline/stored/attributes.h"

namespace watertight::cli {
namespace {

std::string directory_of(const StoreChoice& choice) {
  std::error_code error;
  return std::filesystem::absolute(choice.data_directory, error).string();
}

void tell(const std::string& sentence) {
  server::write_unless_full("watertight: store: " + printable(sentence) + "\n");
}

}  // namespace

Status give_up_rights(const StoreChoice& choice) {
  if (choice.database_url.empty()) {
    if (Status dropped = store::drop_root_privileges(directory_of(choice)); !dropped)
      return dropped;
  }
  return store::forbid_new_privileges();
}

Result<OpenedDatabase> open_database(const StoreChoice& choice,
                                     const server::StopSignals& signals) {
  OpenedDatabase opened;
  if (!choice.database_url.empty()) {
    opened.connection = choice.database_url;
    return opened;
  }
  store::ClusterOptions options;
  options.data_directory = directory_of(choice);
  options.is_cancelled = [&signals] { return signals.is_requested(); };
  options.tell = tell;
  auto cluster = store::PrivateCluster::start(options);
  if (!cluster) return std::move(cluster).error();
  opened.connection = (*cluster)->connection();
  opened.data_directory = options.data_directory;
  opened.cluster = *std::move(cluster);
  return opened;
}

Result<OpenedStore> open_store(const StoreChoice& choice) {
  if (Status given_up = give_up_rights(choice); !given_up) return std::move(given_up).error();
  const server::StopSignals signals;
  auto database = open_database(choice, signals);
  if (!database) return std::move(database).error();
  auto store = store::open_postgres_store(
      database->connection, 4, [&signals] { return signals.is_requested(); }, tell,
      pipeline::read_attributes);
  if (signals.is_requested()) return Error{ErrorCode::cancelled, "stopped before the work began"};
  if (!store) return std::move(store).error();
  return OpenedStore{std::move(database->cluster), *std::move(store)};
}

}  // namespace watertight::cli
