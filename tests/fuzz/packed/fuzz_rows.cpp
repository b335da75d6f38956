// SPDX-License-Identifier: GPL-3.0-or-later
//
// libFuzzer harness of the reader of a feature's row in a store. The input is a dictionary (the
// number of its bytes in two bytes before it), the packed solids (the same), and the text. The row
// is read as it is, the text taken as packed bytes; and once more with the text packed by the
// harness, so that the parser of reports and solids is reached. Each must give a document, which is
// written or refused, or an Error.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "packing/text_dictionary.h"
#include "pipeline/pipeline.h"
#include "store/rows/packed_solids.h"
#include "tests/fuzz/fuzz_formats.h"

namespace {

using namespace watertight;

constexpr std::string_view kHeader =
    R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],"translate":[0,0,0]},)"
    R"("CityObjects":{},"vertices":[]})";
constexpr std::string_view kId = "house-1";
constexpr std::uint64_t kMostSolids = 10'000;  // that a row states

template <class Value>
bool has_value_or_message(const Result<Value>& result) {
  fuzz::require(result || !result.error().message.empty());
  return result.has_value();
}

ByteView part(ByteReader& reader) {
  const std::size_t size = reader.u16();
  return reader.take(std::min(size, reader.remaining()));
}

/// The dictionary of a row; null without one or for bytes that are none.
packing::DictionaryPointer dictionary_of(ByteView bytes) {
  if (bytes.empty()) return nullptr;
  auto dictionary = packing::TextDictionary::of({bytes.begin(), bytes.end()});
  return has_value_or_message(dictionary) ? *std::move(dictionary) : nullptr;
}

/// Gives the row the solids of the bytes, whose number is not among them, if they are few.
void take_solids(StoredFeature& row, ByteView packed) {
  for (const std::uint64_t number : {1U, 2U, 3U, 100U}) {
    if (has_value_or_message(store::unpack_solids(row, number, packed))) return;
  }
  StoredFeature other;
  other.id = row.id;
  has_value_or_message(store::unpack_solids(other, kMostSolids, packed));
  row.solids.clear();
  row.page.clear();
}

void read(const StoredFeature& row) {
  const Limits limits = fuzz::small_limits();
  const auto feature = pipeline::unpack(row, limits);
  if (!has_value_or_message(feature)) return;
  fuzz::require(feature->skeleton.size() <= limits.bytes);
  const auto document = pipeline::decode_feature(*feature, limits);
  if (!has_value_or_message(document)) return;
  has_value_or_message(formats::write_document(*document, document->format));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ByteReader reader(ByteView(data, size));
  StoredFeature row;
  row.id = kId;
  row.format = "city-json-seq";
  row.header = std::string(kHeader);
  row.skeleton.dictionary = dictionary_of(part(reader));
  take_solids(row, part(reader));
  const ByteView text = reader.take(reader.remaining());
  row.skeleton.bytes.assign(text.begin(), text.end());
  read(row);
  row.skeleton.bytes = *packing::pack(as_text(text), row.skeleton.dictionary.get());
  const auto back = packing::unpack(row.skeleton.bytes, row.skeleton.dictionary.get(), text.size());
  fuzz::require(back.has_value() && *back == as_text(text));
  read(row);
  return 0;
}
