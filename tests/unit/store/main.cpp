// SPDX-License-Identifier: GPL-3.0-or-later
//
// PostgreSQL refuses root: if the tests run as root, they change to an unprivileged user first.
#include <grp.h>
#include <pwd.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch_session.hpp>
#include <cstdio>
#include <cstdlib>

namespace {

bool become_unprivileged() {
  for (const char* name : {"postgres", "nobody"}) {
    const passwd* user = getpwnam(name);
    if (user == nullptr) continue;
    const uid_t uid = user->pw_uid;
    const gid_t gid = user->pw_gid;
    const char* shared = std::getenv("WATERTIGHT_TEST_CLUSTER");
    if (shared != nullptr && mkdir(shared, 0700) == 0 && chown(shared, uid, gid) != 0) return false;
    // A process that changed its user cannot be inspected, but the leak check at its end must
    // inspect it.
    return setgroups(0, nullptr) == 0 && setgid(gid) == 0 && setuid(uid) == 0 &&
           prctl(PR_SET_DUMPABLE, 1) == 0 && chdir("/") == 0;
  }
  return false;
}

}  // namespace

int main(int argc, char** argv) {
  if (geteuid() == 0 && !become_unprivileged()) {
    std::fputs("the store's tests need a user that is not root\n", stderr);
    return 1;
  }
  return Catch::Session().run(argc, argv);
}
