// SPDX-License-Identifier: GPL-3.0-or-later
//
// libFuzzer harness of the reader of Watertight files. The input's last four bytes are replaced by
// the right checksum, so that what is behind it is reached. The document or an Error must come out,
// and a document must be written or refused with an Error.
#include "base/checksum.h"
#include "fuzz_formats.h"
#include "pipeline/container.h"

namespace {

using namespace watertight;

Bytes with_checksum(ByteView bytes) {
  if (bytes.size() < 4) return {bytes.begin(), bytes.end()};
  ByteWriter writer;
  writer.append(bytes.first(bytes.size() - 4));
  writer.u32(crc32c(writer.bytes()));
  return std::move(writer).bytes();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Bytes bytes = with_checksum(ByteView(data, size));
  const auto features = read_container(bytes, fuzz::small_limits());
  if (!features) {
    fuzz::require(!features.error().message.empty());
    return 0;
  }
  const auto document = decode_container(bytes, fuzz::small_limits());
  if (!document) {
    fuzz::require(!document.error().message.empty());
    return 0;
  }
  fuzz::require(document->features.size() == features->size());
  const auto written = write_document(*document, document->format);
  if (!written) fuzz::require(!written.error().message.empty());
  return 0;
}
