// SPDX-License-Identifier: GPL-3.0-or-later
//
// libFuzzer harness of texts packed by column. The input is read as packed bytes, which must give
// texts within the limit or an Error; and it is packed itself, as a text of a kind that its length
// chooses, and must come back. Then one of the packed bytes is changed and they are read again: so
// the reader is reached without packed bytes among the seeds.
#include <algorithm>
#include <string>
#include <vector>

#include "columns/columns.h"
#include "tests/fuzz/fuzz_formats.h"

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

Bytes pack_and_read(ByteView bytes) {
  const std::vector<columns::Text> texts{{static_cast<TextKind>(bytes.size() % 4), as_text(bytes)}};
  Bytes packed = columns::pack_texts(texts);
  const auto back = columns::unpack_texts(packed, bytes.size());
  fuzz::require(back.has_value() && back->size() == 1 && back->front() == as_text(bytes));
  return packed;
}

/// Changes a byte that the last bytes of the input choose.
void damage(Bytes& packed, ByteView by) {
  ByteReader reader(by);
  const std::size_t at = reader.u16() % packed.size();
  packed[at] ^= static_cast<std::uint8_t>(reader.u8() | 1U);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const ByteView bytes(data, size);
  read_as_packed(bytes);
  Bytes packed = pack_and_read(bytes);
  damage(packed, bytes.last(std::min<std::size_t>(size, 3)));
  read_as_packed(packed);
  return 0;
}
