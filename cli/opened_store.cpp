// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/opened_store.h"

#include <filesystem>
#include <system_error>
#include <utility>

namespace watertight::cli {

Result<OpenedStore> open_store(const StoreChoice& choice) {
  OpenedStore opened;
  if (!choice.database_url.empty()) {
    opened.connection = choice.database_url;
    return opened;
  }
  std::error_code error;
  const std::string directory = std::filesystem::absolute(choice.data_directory, error).string();
  const Status status = store::drop_root_privileges(directory);
  if (!status) return status.error();
  store::ClusterOptions options;
  options.data_directory = directory;
  auto cluster = store::PrivateCluster::start(options);
  if (!cluster) return std::move(cluster).error();
  opened.connection = (*cluster)->connection();
  opened.cluster = *std::move(cluster);
  return opened;
}

}  // namespace watertight::cli
