// SPDX-License-Identifier: GPL-3.0-or-later
//
// libFuzzer harness of the GML reader. A document that it reads must be writable in other formats,
// and the written texts must be readable.
#include <algorithm>

#include "fuzz_formats.h"

namespace watertight::fuzz {

void check_submitted(const SubmittedSolid& submitted) {
  const Solid& solid = submitted.solid;
  require(submitted.unreadable.empty() || solid.shell_count() == 0);
  require(submitted.facet_lines.size() == solid.facet_count());
  require(submitted.ring_lines.size() == solid.ring_count());
  require(submitted.ring_ids.empty() || submitted.ring_ids.size() == solid.ring_count());
  require(submitted.facet_ids.empty() || submitted.facet_ids.size() == solid.facet_count());
  require(std::is_sorted(submitted.unclosed_rings.begin(), submitted.unclosed_rings.end()));
  for (const Index ring : submitted.unclosed_rings) require(ring < solid.ring_count());
  for (const Index vertex : submitted.rounded) require(vertex < solid.vertex_count());
}

void check_written(const Document& document, Format format) {
  const auto written = formats::write_document(document, format);
  if (!written) {
    const bool is_unreadable = written.error().code == ErrorCode::malformed;
    require(is_unreadable || written.error().code == ErrorCode::unsupported);
    return;
  }
  formats::ReadOptions options;
  options.limits.bytes = 1U << 26U;  // numbers with large exponents are printed with many digits
  const auto again = formats::read_document(*written, format, options);
  require(again || document.features.empty());
}

}  // namespace watertight::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace watertight;
  formats::ReadOptions options;
  options.limits = fuzz::small_limits();
  const auto document = formats::read_document(ByteView(data, size), Format::gml, options);
  if (!document) {
    fuzz::require(!document.error().message.empty());
    return 0;
  }
  for (const Feature& feature : document->features) {
    for (const SubmittedSolid& solid : feature.solids) fuzz::check_submitted(solid);
  }
  for (const SubmittedSolid& solid : document->templates) fuzz::check_submitted(solid);
  fuzz::check_kept(ByteView(data, size), Format::gml);
  fuzz::check_written(*document, Format::ewkb);
  fuzz::check_written(*document, Format::city_json);
  fuzz::check_written(*document, Format::gml);
  return 0;
}
