// SPDX-License-Identifier: GPL-3.0-or-later
//
// libFuzzer harness of the writing of a feature whose skeleton came from outside (a damaged store):
// the writer must return an Error or a text, for a fixed pair of solids.
#include <algorithm>
#include <string>

#include "formats/city_json/city_json.h"
#include "fuzz_formats.h"

namespace {

using namespace watertight;

constexpr std::string_view kHeader =
    R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],"translate":[0,0,0]},)"
    R"("CityObjects":{},"vertices":[]})";
constexpr std::string_view kFeature =
    R"({"type":"CityJSONFeature","id":"a","CityObjects":{"a":{"type":"Building","geometry":[)"
    R"({"type":"MultiSolid","lod":"1","boundaries":[[[[[0,2,1]],[[0,1,3]]]],[[[[1,2,3]]]]]}]}},)"
    R"("vertices":[[0,0,0],[9,0,0],[0,9,0],[0,0,9],[5,5,5]]})";

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto header = formats::read_city_json_header(kHeader);
  static const auto feature = formats::read_city_json_feature(*header, kFeature);
  fuzz::require(feature.has_value());
  Feature changed = *feature;
  // The input is a skeleton, perhaps followed by a line feed and a layout.
  const std::uint8_t* end = std::find(data, data + size, '\n');
  changed.skeleton.assign(data, end);
  if (end != data + size) changed.layout.assign(end + 1, data + size);
  if (changed.skeleton.empty()) changed.skeleton = feature->skeleton;
  const auto text = formats::write_city_json_feature(*header, changed);
  if (!text) fuzz::require(!text.error().message.empty());
  return 0;
}
