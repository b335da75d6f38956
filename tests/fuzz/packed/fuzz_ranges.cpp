// SPDX-License-Identifier: GPL-3.0-or-later
//
// libFuzzer harness of the reader of Watertight files by ranges. A file with several blocks and an
// index is made; the input is added (XOR) to the bytes of its index and its commits, and each
// record gets the right checksum. The first byte chooses what the callback does wrong: it fails, or
// gives a byte less, at some call. The reader must give features or an Error, ask for nothing
// outside of the file, and hold no more than the file allows.
#include <algorithm>
#include <string>
#include <vector>

#include "formats/document.h"
#include "pipeline/container.h"
#include "pipeline/file/selection.h"
#include "tests/fuzz/fuzz_formats.h"

namespace {

using namespace watertight;
using pipeline::ContainerFile;
using pipeline::RecordKind;

constexpr int kBlocks = 5;

std::string box_line(int number) {
  const std::string id = std::string("b").append(std::to_string(number));
  const std::string x = std::to_string(10 * number);
  const std::string y = std::to_string(10 * number + 5);
  std::string vertices;
  for (const char* const z : {"0", "5"}) {
    for (const auto& [a, b] :
         {std::pair(x, x), std::pair(y, x), std::pair(y, y), std::pair(x, y)}) {
      if (!vertices.empty()) vertices += ',';
      vertices.append("[").append(a).append(",").append(b).append(",").append(z).append("]");
    }
  }
  std::string line = R"({"type":"CityJSONFeature","id":")";
  line.append(id).append(R"(","CityObjects":{")").append(id);
  line +=
      R"(":{"type":"Building","geometry":[{"type":"Solid","lod":"1","boundaries":[[[[0,3,2,1]],)";
  line += "[[4,5,6,7]],[[0,1,5,4]],[[1,2,6,5]],[[2,3,7,6]],[[3,0,4,7]]]]}]}},\"vertices\":[";
  return line.append(vertices).append("]}\n");
}

/// The file that grows by a block and is whole after each.
Bytes town() {
  Bytes file;
  for (int i = 0; i < kBlocks; ++i) {
    std::string text =
        R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],"translate":[0,0,0]},)";
    text.append("\"CityObjects\":{},\"vertices\":[]}\n").append(box_line(i));
    auto document = formats::read_document(as_bytes(text), Format::city_json_seq, {});
    fuzz::require(document.has_value());
    auto encoded = pipeline::encode_document(*std::move(document), nullptr, {});
    fuzz::require(encoded.has_value());
    if (i == 0) {
      file = *pipeline::write_container(encoded->document);
      continue;
    }
    auto opened = ContainerFile::open(file, {});
    fuzz::require(opened.has_value());
    auto writer = pipeline::ContainerWriter::append(*opened);
    fuzz::require(writer.has_value());
    if (i == 2) writer->remove({0, 0}, 1);
    fuzz::require(writer->add(encoded->document.features.front()).has_value());
    const Bytes added = *std::move(*writer).finish();
    file.insert(file.end(), added.begin(), added.end());
  }
  return file;
}

/// The file with the input added to the payloads of index and commits.
Bytes changed(ByteView changes) {
  static const Bytes kTown = town();
  static const pipeline::Walk kWalk = pipeline::walk_records(kTown);
  ByteReader reader(changes);
  ByteWriter writer;
  writer.append(pipeline::file_head());
  for (const pipeline::Record& record : kWalk.records) {
    Bytes payload(record.payload.begin(), record.payload.end());
    const bool is_index = record.kind == RecordKind::index || record.kind == RecordKind::commit;
    if (is_index) {
      const ByteView by = reader.take(std::min(payload.size(), reader.remaining()));
      for (std::size_t i = 0; i < by.size(); ++i) payload[i] ^= by[i];
    }
    // What is left of the input makes the last payload longer.
    if (&record == &kWalk.records.back()) {
      const ByteView rest = reader.take(reader.remaining());
      payload.insert(payload.end(), rest.begin(), rest.end());
    }
    writer.append(pipeline::write_record(record.kind, payload));
  }
  return std::move(writer).bytes();
}

/// A callback whose call number `wrong` fails, or gives a byte less.
pipeline::FileBytes served(ByteView bytes, int wrong, bool is_short) {
  return {bytes.size(),
          [bytes, wrong, is_short, calls = 0](std::uint64_t offset,
                                              std::uint64_t size) mutable -> Result<Bytes> {
            fuzz::require(offset <= bytes.size() && size <= bytes.size() - offset);
            const bool is_wrong = ++calls == wrong;
            if (is_wrong && !is_short) return Error{ErrorCode::unavailable, "gone"};
            ByteView part =
                bytes.subspan(static_cast<std::size_t>(offset), static_cast<std::size_t>(size));
            if (is_wrong && !part.empty()) part = part.first(part.size() - 1);
            return Bytes(part.begin(), part.end());
          }};
}

template <class Value>
void require_message(const Result<Value>& result) {
  fuzz::require(result || !result.error().message.empty());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const Limits limits = fuzz::small_limits();
  const Bytes bytes = changed(ByteView(data, size).subspan(1));
  auto file = ContainerFile::open(served(bytes, data[0] % 16, data[0] >= 128), limits,
                                  pipeline::TornTail::leave_out);
  require_message(file);
  if (!file) return 0;
  require_message(pipeline::select_ids(*file, {"b1", "b3", "b9"}, limits));
  require_message(pipeline::select_box(*file, {{12, 12, 0}, {33, 33, 9}}, limits));
  require_message(pipeline::decode_container(*file, limits));
  require_message(pipeline::ContainerWriter::append(*file));
  return 0;
}
