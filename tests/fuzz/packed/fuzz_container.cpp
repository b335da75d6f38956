// SPDX-License-Identifier: GPL-3.0-or-later
//
// libFuzzer harness of the reader of Watertight files. The input is read twice: as a file whose
// records get the right checksums; and as the only block of a file (the length of the texts in two
// bytes; the texts, with record separators (0x1E) between them and the letter of its kind before
// each; the page file and the blobs). The harness packs the texts of that block itself, so that the
// parser of the tables and of the bytes after the texts is reached. The reader must return the
// documents or an Error, also when it reads the file in ranges, and a document must be written or
// refused with an Error. What adds to the file must give a file that can be read, or an Error.
#include <algorithm>
#include <string_view>
#include <vector>

#include "columns/columns.h"
#include "pipeline/container.h"
#include "pipeline/file/selection.h"
#include "tests/fuzz/fuzz_formats.h"

namespace {

using namespace watertight;
using pipeline::RecordKind;

/// The records of a file, each with the right checksum.
Bytes with_checksums(ByteView bytes) {
  constexpr std::size_t kHead = 9;
  constexpr std::size_t kChecksum = 4;
  ByteWriter writer;
  writer.append(pipeline::file_head());
  ByteReader reader(bytes.subspan(std::min(kHead, bytes.size())));
  while (reader.remaining() > 0 && !reader.failed()) {
    const std::uint64_t head = reader.varint();
    const auto kind = static_cast<RecordKind>(head % 4);
    const ByteView payload = reader.take(
        static_cast<std::size_t>(std::min<std::uint64_t>(head / 4, reader.remaining())));
    const Bytes record = pipeline::write_record(kind, payload);
    writer.append(record);
    reader.take(std::min(kChecksum, reader.remaining()));
    std::size_t end = kind == RecordKind::commit ? 1 : 0;  // the bytes of its length
    while (end > 0 && end < 10 && record.size() >> (7 * end) > 0) ++end;
    reader.take(std::min(end, reader.remaining()));
  }
  return std::move(writer).bytes();
}

/// Texts with separators between them, each after the letter of its kind.
std::vector<columns::Text> texts_in(std::string_view bytes) {
  std::vector<columns::Text> texts;
  while (!bytes.empty()) {
    const std::string_view text = bytes.substr(0, bytes.find('\x1E'));
    bytes.remove_prefix(std::min(text.size() + 1, bytes.size()));
    const char kind = text.empty() ? 'b' : text[0];
    texts.push_back({kind == 'j'   ? columns::TextKind::json
                     : kind == 'x' ? columns::TextKind::xml
                     : kind == 't' ? columns::TextKind::table
                                   : columns::TextKind::bytes,
                     text.substr(std::min<std::size_t>(1, text.size()))});
  }
  return texts;
}

/// A whole file of the given texts, pages and blobs.
Bytes around(ByteView data) {
  ByteReader reader(data);
  const std::size_t size = reader.u16();
  const ByteView texts = reader.take(std::min(size, reader.remaining()));
  const Bytes packed = columns::pack_texts(texts_in(as_text(texts)));
  ByteWriter block;
  block.varint(packed.size());
  block.append(packed);
  block.append(reader.take(reader.remaining()));
  ByteWriter writer;
  writer.append(pipeline::file_head());
  writer.append(pipeline::write_record(RecordKind::block, block.bytes()));
  writer.append(pipeline::write_record(RecordKind::commit, {}));
  return std::move(writer).bytes();
}

template <class Value>
bool has_value_or_message(const Result<Value>& result) {
  fuzz::require(result || !result.error().message.empty());
  return result.has_value();
}

pipeline::FileBytes in_ranges(ByteView bytes) {
  return {bytes.size(), [bytes](std::uint64_t offset, std::uint64_t size) -> Result<Bytes> {
            fuzz::require(offset <= bytes.size() && size <= bytes.size() - offset);
            const ByteView part =
                bytes.subspan(static_cast<std::size_t>(offset), static_cast<std::size_t>(size));
            return Bytes(part.begin(), part.end());
          }};
}

/// Reads parts of the file by its index, and adds to it.
void check_ranges(ByteView bytes) {
  const Limits limits = fuzz::small_limits();
  auto file =
      pipeline::ContainerFile::open(in_ranges(bytes), limits, pipeline::TornTail::leave_out);
  if (!has_value_or_message(file)) return;
  fuzz::require(file->committed() <= bytes.size());
  has_value_or_message(pipeline::select_ids(*file, {"a", "b10001"}, limits));
  has_value_or_message(pipeline::select_box(*file, {{0, 0, 0}, {1e6, 1e6, 1e6}}, limits));
  auto writer = pipeline::ContainerWriter::append(*file);
  if (!has_value_or_message(writer)) return;
  pipeline::EncodedFeature feature;
  feature.id = "new";
  feature.format = "off";
  fuzz::require(writer->add(std::move(feature)).has_value());
  const auto added = std::move(*writer).finish();
  fuzz::require(added.has_value());
  Bytes longer(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(file->committed()));
  longer.insert(longer.end(), added->begin(), added->end());
  auto again = pipeline::ContainerFile::open(in_ranges(longer), limits);
  fuzz::require(again.has_value());
  const auto found = pipeline::select_ids(*again, {"new"}, limits);
  has_value_or_message(found);
}

void check(ByteView bytes) {
  const auto info = pipeline::describe_container(bytes, fuzz::small_limits());
  check_ranges(bytes);
  if (!has_value_or_message(info)) return;
  const auto documents = pipeline::decode_container(bytes, fuzz::small_limits());
  if (!has_value_or_message(documents)) return;
  fuzz::require(documents->size() == info->formats.size());
  for (const Document& document : *documents) {
    has_value_or_message(formats::write_document(document, document.format));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  check(with_checksums(ByteView(data, size)));
  check(around(ByteView(data, size)));
  return 0;
}
