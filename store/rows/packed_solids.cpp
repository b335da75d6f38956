// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/rows/packed_solids.h"

#include <algorithm>
#include <array>
#include <string>

namespace watertight::store {
namespace {

// The list never changes: rows refer to it.
constexpr std::array<std::string_view, 22> kLods{
    "",    "0",   "1",   "2",   "3",   "4",   "0.0", "0.1", "0.2", "0.3", "1.0",
    "1.1", "1.2", "1.3", "2.0", "2.1", "2.2", "2.3", "3.0", "3.1", "3.2", "3.3"};
constexpr std::uint8_t kOtherLod = 31;
constexpr std::uint8_t kLodBits = 31;
constexpr std::uint8_t kHasBlob = 32;
constexpr std::uint8_t kHasObject = 64;
constexpr std::uint8_t kHasNumbers = 128;

/// The facts that are expected of the next solid.
struct Expected {
  std::string_view object;
  std::uint64_t geometry = 0;
};

bool is_begin_of_character(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U;
}

/// The length of the common start of two ids, in whole characters.
std::size_t shared_bytes(std::string_view id, std::string_view object) {
  const auto [end, other] = std::mismatch(id.begin(), id.end(), object.begin(), object.end());
  auto bytes = static_cast<std::size_t>(end - id.begin());
  const auto is_whole = [&] {
    return (bytes == id.size() || is_begin_of_character(id[bytes])) &&
           (bytes == object.size() || is_begin_of_character(object[bytes]));
  };
  while (!is_whole()) --bytes;
  return bytes;
}

void write_text(ByteWriter& writer, std::string_view text) {
  writer.varint(text.size());
  writer.append(as_bytes(text));
}

std::string_view read_text(ByteReader& reader) {
  return as_text(reader.take(static_cast<std::size_t>(reader.varint())));
}

void write_facts(ByteWriter& writer, std::string_view id, const StoredSolid& solid,
                 Expected& expected) {
  const auto lod = std::find(kLods.begin(), kLods.end(), solid.lod);
  const bool has_object = solid.object_id != expected.object;
  if (has_object) expected = {solid.object_id, 0};
  const bool has_numbers = solid.geometry != expected.geometry || solid.ordinal != 0;
  std::uint8_t flags =
      lod == kLods.end() ? kOtherLod : static_cast<std::uint8_t>(lod - kLods.begin());
  if (solid.is_proven) flags |= kHasBlob;
  if (has_object) flags |= kHasObject;
  if (has_numbers) flags |= kHasNumbers;
  writer.u8(flags);
  if (lod == kLods.end()) write_text(writer, solid.lod);
  if (has_object) {
    const std::size_t shared = shared_bytes(id, solid.object_id);
    writer.varint(shared);
    write_text(writer, std::string_view(solid.object_id).substr(shared));
  }
  if (has_numbers) {
    writer.varint(solid.geometry);
    writer.varint(solid.ordinal);
  }
  if (solid.is_proven) writer.varint(solid.blob.size());
  expected.geometry = std::uint64_t{solid.geometry} + 1;
}

/// The lengths of blobs that were read are bounded by the bytes that are left.
struct Facts {
  StoredSolid solid;
  std::uint64_t blob = 0;
};

Facts read_facts(ByteReader& reader, std::string_view id, const Facts* before) {
  Facts facts;
  StoredSolid& solid = facts.solid;
  const std::uint8_t flags = reader.u8();
  const std::uint8_t lod = flags & kLodBits;
  if (lod == kOtherLod) solid.lod = read_text(reader);
  if (lod < kLods.size()) solid.lod = kLods[lod];
  solid.object_id = before == nullptr ? std::string(id) : before->solid.object_id;
  std::uint64_t geometry = before == nullptr ? 0 : std::uint64_t{before->solid.geometry} + 1;
  if ((flags & kHasObject) != 0) {
    solid.object_id = id.substr(0, static_cast<std::size_t>(reader.varint()));
    solid.object_id += read_text(reader);
    geometry = 0;
  }
  if ((flags & kHasNumbers) != 0) {
    geometry = reader.varint();
    solid.ordinal = static_cast<std::uint32_t>(reader.varint());
  }
  solid.geometry = static_cast<std::uint32_t>(geometry);
  solid.is_proven = (flags & kHasBlob) != 0;
  if (solid.is_proven) facts.blob = reader.varint();
  return facts;
}

}  // namespace

Bytes pack_solids(const FeatureRecord& feature) {
  ByteWriter writer;
  if (!feature.page.empty()) writer.u8(kPageMark);
  Expected expected{feature.id, 0};
  for (const StoredSolid& solid : feature.solids) {
    write_facts(writer, feature.id, solid, expected);
  }
  for (const StoredSolid& solid : feature.solids) writer.append(solid.blob);
  writer.append(feature.page);
  return std::move(writer).bytes();
}

Status unpack_solids(FeatureRecord& feature, std::uint64_t number, ByteView packed) {
  const bool has_page = !packed.empty() && packed.front() == kPageMark;
  ByteReader reader(packed.subspan(has_page ? 1 : 0));
  std::vector<Facts> all;
  // The id of one solid may be that of many: without its limit, memory would grow with the square
  // of the bytes.
  bool is_good = true;
  for (std::uint64_t i = 0; i < number && is_good; ++i) {
    all.push_back(read_facts(reader, feature.id, all.empty() ? nullptr : &all.back()));
    is_good = !reader.failed() && all.back().solid.object_id.size() <= kLongestId;
  }
  feature.solids.clear();
  for (Facts& facts : all) {
    const ByteView blob = reader.take(static_cast<std::size_t>(facts.blob));
    facts.solid.blob.assign(blob.begin(), blob.end());
    feature.solids.push_back(std::move(facts.solid));
  }
  const ByteView page = has_page ? reader.take(reader.remaining()) : ByteView();
  feature.page.assign(page.begin(), page.end());
  if (!is_good || reader.failed() || reader.remaining() > 0 || has_page == page.empty()) {
    return Error{ErrorCode::malformed, "the solids of a stored feature are damaged"};
  }
  return Done{};
}

}  // namespace watertight::store
