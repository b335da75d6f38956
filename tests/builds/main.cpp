// SPDX-License-Identifier: GPL-3.0-or-later
//
// build_fingerprint [DOCUMENT...]: prints hashes of blobs, reports and verdicts. Two builds of the
// program agree if their lines agree. Exit status: 0, or 1 if a part does not work. A file that
// cannot be read ends the program by an exception.
#include "tests/builds/fingerprint.h"

int main(int count, char** arguments) {
  using namespace watertight::builds;
#if WATERTIGHT_WITH_SERVER
  if (!serve_leaving_clients()) return 1;
#endif
  print_blob_hashes();
  const bool is_good =
      print_meshes() && print_fillings() && print_splines() && print_documents({arguments + 1, static_cast<std::size_t>(count - 1)});
  return is_good ? 0 : 1;
}
