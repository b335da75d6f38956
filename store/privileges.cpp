// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <grp.h>
#include <pwd.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <string>

#include "store/cluster_files.h"
#include "store/private_cluster.h"

namespace watertight::store {
namespace {

constexpr const char* kUser = "watertight";

struct User {
  uid_t uid = 0;
  gid_t gid = 0;
};

Result<User> find_user() {
  std::array<char, 4096> buffer{};
  passwd entry{};
  passwd* found = nullptr;
  errno = getpwnam_r(kUser, &entry, buffer.data(), buffer.size(), &found);
  if (errno != 0) return system_error("look up the user 'watertight'");
  if (found == nullptr || found->pw_uid == 0) {
    return Error{ErrorCode::unavailable,
                 "root may not run the database, and there is no user 'watertight' to run it as; "
                 "create one with: useradd --system --user-group --no-create-home "
                 "--shell /usr/sbin/nologin watertight"};
  }
  return User{found->pw_uid, found->pw_gid};
}

/// Gives the directory (not its contents) to the user. The directory must be the user's already, or
/// root's and empty, so that a mistyped path cannot give /etc away.
Status hand_over(const std::string& directory, const User& user) {
  std::error_code failure;
  std::filesystem::create_directories(directory, failure);
  const int folder = open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return system_error("open " + directory);
  struct stat status {};
  fstat(folder, &status);
  Status result = Done{};
  if (status.st_uid != user.uid) {
    const bool empty = std::filesystem::is_empty(directory, failure) && !failure;
    if (status.st_uid != 0 || !empty) {
      result = Error{ErrorCode::invalid_argument,
                     directory + " does not belong to the user 'watertight' and is not empty"};
    } else if (fchown(folder, user.uid, user.gid) != 0 || fchmod(folder, 0700) != 0) {
      result = system_error("hand over " + directory);
    }
  }
  close(folder);
  return result;
}

}  // namespace

Status forbid_new_privileges() {
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return system_error("forbid new privileges");
  return Done{};
}

Status drop_root_privileges(const std::string& directory) {
  if (geteuid() != 0) return Done{};
  const Result<User> user = find_user();
  if (!user) return user.error();
  if (Status handed = hand_over(directory, *user); !handed) return handed;
  if (initgroups(kUser, user->gid) != 0 || setgid(user->gid) != 0 || setuid(user->uid) != 0) {
    return system_error("become the user 'watertight'");
  }
  // The process must not be able to become root again.
  if (setuid(0) == 0 || geteuid() != user->uid) {
    return Error{ErrorCode::unavailable, "the system did not let go of root"};
  }
  if (access(directory.c_str(), R_OK | W_OK | X_OK) != 0) {
    return system_error("use " + directory + " as the user 'watertight'");
  }
  return Done{};
}

}  // namespace watertight::store
