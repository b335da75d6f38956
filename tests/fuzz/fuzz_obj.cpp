// SPDX-License-Identifier: GPL-3.0-or-later
//
// libFuzzer harness of the OBJ reader and writer.
#include "fuzz_formats.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace watertight;
  fuzz::check_reader(ByteView(data, size), Format::obj, true);
  return 0;
}
