// SPDX-License-Identifier: GPL-3.0-or-later
//
// libFuzzer harness of the reader of Watertight files. The input is read twice: as a file, with its
// last four bytes replaced by the right checksum; and as the only part of a file (the length of the
// texts in two bytes, the texts, the page file and the blobs). The harness compresses the texts of
// that part itself, so that the parser of the bytes after them is reached. The reader must return
// the documents or an Error, and a document must be written or refused with an Error.
#include <algorithm>

#include "base/checksum.h"
#include "formats/text/packed_text.h"
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

/// A whole file of the given texts, pages and blobs, without the checksum.
Bytes around(ByteView data) {
  ByteReader reader(data);
  const std::size_t size = reader.u16();
  const ByteView texts = reader.take(std::min(size, reader.remaining()));
  const auto packed = formats::pack_text(as_text(texts));
  fuzz::require(packed.has_value());
  constexpr std::uint8_t kStart[] = {0x89, 'W', 'T', 'F', '\r', '\n', 0x1A, '\n', 1};
  ByteWriter writer;
  writer.append(kStart);
  writer.varint(packed->bytes.size());
  writer.append(packed->bytes);
  writer.append(reader.take(reader.remaining()));
  writer.u8(0);  // the mark after the last part
  writer.u32(0);
  return std::move(writer).bytes();
}

void check(ByteView bytes) {
  const auto info = pipeline::describe_container(bytes, fuzz::small_limits());
  if (!info) return fuzz::require(!info.error().message.empty());
  const auto documents = pipeline::decode_container(bytes, fuzz::small_limits());
  if (!documents) return fuzz::require(!documents.error().message.empty());
  fuzz::require(documents->size() == info->formats.size());
  for (const Document& document : *documents) {
    const auto written = formats::write_document(document, document.format);
    if (!written) fuzz::require(!written.error().message.empty());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  check(with_checksum(ByteView(data, size)));
  check(with_checksum(around(ByteView(data, size))));
  return 0;
}
