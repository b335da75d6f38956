// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <cstdlib>
#include <string>

#include "base/temporary_file.h"

namespace watertight {
namespace {

TEST_CASE("a temporary file gives back any part of what was added") {
  auto file = TemporaryFile::make();
  REQUIRE(file);
  const Bytes first(100'000, 1);
  const Bytes second(50, 2);
  REQUIRE(file->append(first));
  REQUIRE(file->append(second));
  CHECK(file->size() == 100'050);
  const auto across = file->read(99'990, 20);
  REQUIRE(across);
  CHECK(Bytes(across->begin(), across->begin() + 10) == Bytes(10, 1));
  CHECK(Bytes(across->begin() + 10, across->end()) == Bytes(10, 2));
  const TemporaryFile moved = *std::move(file);
  CHECK(moved.read(100'000, 50));
  CHECK_FALSE(moved.read(100'000, 51));
}

TEST_CASE("a folder for temporary files that does not exist is replaced by /tmp") {
  const char* const before = std::getenv("TMPDIR");
  const std::string kept = before == nullptr ? "" : before;
  ::setenv("TMPDIR", "/nowhere/at/all", 1);
  CHECK(TemporaryFile::make());
  if (before == nullptr) {
    ::unsetenv("TMPDIR");
  } else {
    ::setenv("TMPDIR", kept.c_str(), 1);
  }
}

}  // namespace
}  // namespace watertight
