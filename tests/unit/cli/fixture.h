// SPDX-License-Identifier: GPL-3.0-or-later
//
// Runs the executable in a folder of its own, for the tests of the command line.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <catch2/catch_test_macros.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/files.h"

namespace watertight::test {

struct Ran {
  int status = -1;
  std::string output;  // standard output and standard error together
};

/// A folder of its own, in which the executable runs.
class Fixture {
 public:
  Fixture() {
    std::string name = (std::filesystem::temp_directory_path() / "watertight-cli-XXXXXX").string();
    REQUIRE(::mkdtemp(name.data()) != nullptr);
    folder = name;
  }
  ~Fixture() {
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
  }
  Fixture(const Fixture&) = delete;
  Fixture& operator=(const Fixture&) = delete;

  Ran run(const std::string& arguments) const {
    const std::string command = "cd " + folder.string() + " && env -u WATERTIGHT_DATABASE_URL " +
                                test::program_path("watertight") + " " + arguments + " 2>&1";
    FILE* pipe = ::popen(command.c_str(), "r");
    REQUIRE(pipe != nullptr);
    Ran ran;
    std::array<char, 4096> buffer{};
    for (std::size_t count = 0; (count = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
      ran.output.append(buffer.data(), count);
    }
    const int status = ::pclose(pipe);
    ran.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    INFO(arguments << "\n" << ran.output);
    return ran;
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder / name, std::ios::binary) << text;
  }
  std::string read(const std::string& name) const { return read_text(folder / name); }
  std::filesystem::path folder;
};

}  // namespace watertight::test
