// SPDX-License-Identifier: GPL-3.0-or-later
//
// libFuzzer harness of texts packed by column. The input is read as packed bytes, which must give
// texts within the limit or an Error; and it is packed itself, as each kind of text, and must come
// back.
#include <string>
#include <vector>

#include "columns/columns.h"
#include "fuzz_formats.h"

namespace {

using namespace watertight;
using columns::TextKind;

constexpr std::uint64_t kMostBytes = 100'000;

/// Packed examples, from which a coder learns, or an Error.
void learn_from(ByteView bytes) {
  const auto examples = columns::Examples::of(bytes, kMostBytes);
  if (!examples) {
    fuzz::require(!examples.error().message.empty());
    return;
  }
  const Bytes packed = (*examples)->pack({TextKind::json, as_text(bytes)});
  const auto back = (*examples)->unpack(packed, bytes.size());
  fuzz::require(back.has_value() && *back == as_text(bytes));
}

void read_as_packed(ByteView bytes) {
  learn_from(bytes);
  const auto texts = columns::unpack_texts(bytes, kMostBytes);
  if (!texts) {
    fuzz::require(!texts.error().message.empty());
    return;
  }
  std::size_t size = 0;
  for (const std::string& text : *texts) size += text.size();
  fuzz::require(size <= kMostBytes);
}

void pack_and_read(ByteView bytes) {
  std::vector<columns::Text> texts;
  for (const TextKind kind : {TextKind::json, TextKind::xml, TextKind::table, TextKind::bytes}) {
    texts.push_back({kind, as_text(bytes)});
  }
  const auto back = columns::unpack_texts(columns::pack_texts(texts), 4 * bytes.size());
  fuzz::require(back.has_value() && back->size() == texts.size());
  for (const std::string& text : *back) fuzz::require(text == as_text(bytes));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const ByteView bytes(data, size);
  read_as_packed(bytes);
  pack_and_read(bytes);
  return 0;
}
