// SPDX-License-Identifier: GPL-3.0-or-later
// The only file of the tests that holds absolute paths, so that a compiler's cache serves each
// checkout.
#include "tests/files.h"

namespace watertight::test {

std::string source_path(const std::string& path) {
  return std::string(WATERTIGHT_SOURCES "/") + path;
}

std::string program_path(const std::string& name) {
  return std::string(WATERTIGHT_PROGRAMS "/") + name;
}

}  // namespace watertight::test
