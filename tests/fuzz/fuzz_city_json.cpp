// SPDX-License-Identifier: GPL-3.0-or-later
//
// libFuzzer harness of the CityJSON reader and writer, for a whole document and for one split into
// features.
#include "fuzz_formats.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace watertight;
  fuzz::check_reader(ByteView(data, size), Format::city_json, false);
  fuzz::check_reader(ByteView(data, size), Format::city_json, true);
  return 0;
}
