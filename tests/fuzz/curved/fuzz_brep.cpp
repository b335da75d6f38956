// SPDX-License-Identifier: GPL-3.0-or-later
//
// libFuzzer harness of the reader of boundary representations in JSON: it must return an Error with
// a message, or a document whose solids another format can take and give back.
#include "../fuzz_formats.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace watertight;
  fuzz::check_read_only(ByteView(data, size), Format::brep);
  return 0;
}
