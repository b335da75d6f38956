// SPDX-License-Identifier: GPL-3.0-or-later
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <vector>

#include "workers/worker_pool.h"

namespace watertight::workers {
namespace {

bool is_executable_file(const std::string& path) {
  struct stat status {};
  return stat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode) &&
         access(path.c_str(), X_OK) == 0;
}

}  // namespace

Result<std::string> find_helper(const std::string& name) {
  if (name.empty() || name.find('/') != std::string::npos) {
    return Error{ErrorCode::invalid_argument,
                 "'" + name + "' is not the name of a helper executable"};
  }
  std::vector<std::filesystem::path> folders;
  if (const char* folder = std::getenv("WATERTIGHT_LIBEXEC"); folder != nullptr && *folder == '/') {
    folders.emplace_back(folder);
  }
  std::error_code failed;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", failed);
  if (!failed) {
    folders.push_back(self.parent_path());
    folders.push_back(self.parent_path().parent_path() / "libexec" / "watertight");
  }
  folders.emplace_back(WATERTIGHT_LIBEXEC_FOLDER);
  std::string looked;
  for (const std::filesystem::path& folder : folders) {
    const std::string path = (folder / name).string();
    if (is_executable_file(path)) return path;
    looked += (looked.empty() ? "" : ", ") + folder.string();
  }
  return Error{ErrorCode::unavailable, "helper executable " + name + " is in none of " + looked};
}

}  // namespace watertight::workers
