// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests that hostile documents and careless command lines do not harm the terminal or files.
#include <sys/wait.h>

#include <catch2/catch_test_macros.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "cli/terminal/printable.h"
#include "tests/files.h"

namespace watertight {
namespace {

namespace fs = std::filesystem;

const std::string kTriangle = "o a\x1b[31mb\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "watertight-out-XXXXXX").string();
    REQUIRE(::mkdtemp(name.data()) != nullptr);
    path_ = name;
    std::ofstream(path_ / "in.obj", std::ios::binary) << kTriangle;
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  /// Runs the command; returns its exit status. Standard output and error go to the file "printed".
  int run(const std::string& arguments) const {
    const std::string command = "cd " + path_.string() + " && " + test::program_path("watertight") +
                                " " + arguments + " > printed 2>&1";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string read(const std::string& name) const { return test::read_text(path_ / name); }
  bool has(const std::string& name) const { return fs::exists(path_ / name); }

 private:
  fs::path path_;
};

TEST_CASE("bytes that a terminal would obey are replaced, the others stay") {
  const std::string mark = "\xEF\xBF\xBD";
  CHECK(cli::printable("Gebäude 1, 高い") == "Gebäude 1, 高い");
  CHECK(cli::printable("a\x1b[31mb\x07") == "a" + mark + "[31mb" + mark);
  CHECK(cli::printable("a\r\nb\tc\x7f") == "a" + mark + mark + "b" + mark + "c" + mark);
  CHECK(cli::printable("a\xC2\x9B"
                       // The control sequence introducer of the C1 set.
                       "31mb") == "a" + mark + "31mb");
  CHECK(cli::printable("a\x9B"
                       "31mb\xFF") == "a" + mark + "31mb" + mark);  // not UTF-8
  CHECK(cli::printable("a\xE2\x80\xAE"
                       "b\xE2\x81\xA6"
                       "c") == "a" + mark + "b" + mark + "c");
  CHECK(cli::printable("1\xC2\xA0m \xE2\x80\x93 2") == "1\xC2\xA0m \xE2\x80\x93 2");
  CHECK(cli::printable("\xE2\x80").find('\xE2') == std::string::npos);
}

TEST_CASE("ids with escape sequences do not reach the terminal") {
  const Folder folder;
  CHECK(folder.run("validate in.obj") == 1);
  CHECK(folder.read("printed").find('\x1b') == std::string::npos);
  CHECK(folder.read("printed").find("[31mb") != std::string::npos);
}

TEST_CASE("a report that would replace an input or another report is refused") {
  const Folder folder;
  CHECK(folder.run("validate in.obj --report in.obj") == 2);
  CHECK(folder.run("validate in.obj --html ./in.obj") == 2);
  CHECK(folder.read("in.obj") == kTriangle);
  CHECK(folder.run("validate in.obj --report same --geojson ./same") == 2);
  CHECK_FALSE(folder.has("same"));
  CHECK(folder.run("validate in.obj --report - --html -") == 2);
  CHECK(folder.read("printed").find("standard output: ") != std::string::npos);
  CHECK(folder.run("validate in.obj --report /dev/null --html /dev/null") == 1);
  CHECK(folder.run("validate in.obj --report r.json --html r.html") == 1);
}

TEST_CASE("an interior shell that cannot be read is named") {
  const Folder folder;
  CHECK(folder.run("validate in.obj --interior-shell missing.obj") == 2);
  CHECK(folder.read("printed").find("--interior-shell missing.obj: No such file") !=
        std::string::npos);
}

#ifndef __SANITIZE_ADDRESS__  // the sanitizer takes terabytes of address space
TEST_CASE("more jobs than there is memory for threads do not crash the program") {
  const Folder folder;
  const int status = folder.run("--version && ulimit -v 600000 && " +
                                test::program_path("watertight") + " validate -j 256 in.obj");
  INFO(folder.read("printed"));
  CHECK((status == 1 || status == 2));
}
#endif

}  // namespace
}  // namespace watertight
