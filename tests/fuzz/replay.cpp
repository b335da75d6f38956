// SPDX-License-Identifier: GPL-3.0-or-later
//
// Main function of a fuzzing harness in builds without libFuzzer: runs the harness once on each
// named file and on each file below a named folder. A violated requirement aborts the program, and
// so does an unreadable file; without any input the exit status is 1.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/files.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_of(const fs::path& path) {
  if (!fs::is_directory(path)) return {path};
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(path)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

void replay(const fs::path& path) {
  const watertight::Bytes bytes = watertight::test::read_bytes(path);
  std::printf("%s: %zu bytes\n", path.c_str(), bytes.size());
  // So that the last printed line names the input at which the program aborted.
  std::fflush(stdout);
  LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
}

}  // namespace

int main(int argument_count, char** arguments) {
  std::size_t count = 0;
  for (int i = 1; i < argument_count; ++i) {
    for (const fs::path& path : files_of(arguments[i])) {
      replay(path);
      ++count;
    }
  }
  std::printf("%zu inputs\n", count);
  return count == 0 ? 1 : 0;
}
