// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/file/id_pages.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "base/checksum.h"

namespace watertight::pipeline {
namespace {

constexpr std::size_t kLeastPageBytes = 4096;
constexpr std::size_t kRootBytes = 5;   // of a page in the commit
constexpr std::size_t kEntryBytes = 3;  // of an entry, about
constexpr unsigned kFreeBits = 7;

/// The bytes of a page: some KiB; more where there are so many pages that their list would be
/// longer than a page.
std::size_t page_bytes(std::size_t entries) {
  const double total = static_cast<double>(kEntryBytes * entries);
  return std::max(kLeastPageBytes, static_cast<std::size_t>(std::sqrt(total * kRootBytes)));
}

}  // namespace

std::uint64_t id_hash(std::string_view id) {
  // The first bits of FNV-1a hardly depend on the last bytes; these are the last steps of
  // MurmurHash3, which spread every bit over all.
  std::uint64_t hash = content_hash(as_bytes(id));
  hash ^= hash >> 33U;
  hash *= 0xFF51AFD7ED558CCDU;
  hash ^= hash >> 33U;
  hash *= 0xC4CEB9FE1A85EC53U;
  hash ^= hash >> 33U;
  return hash;
}

std::uint64_t cut_hash(std::uint64_t hash, std::uint8_t bits) {
  return bits == 0 ? 0 : hash >> (64U - bits);
}

std::uint8_t bits_for(std::size_t entries) {
  const unsigned bits = static_cast<unsigned>(std::bit_width(entries)) + kFreeBits;
  return static_cast<std::uint8_t>(std::min(bits, 64U));
}

std::vector<WrittenIdPage> write_id_pages(std::span<const IdEntry> entries) {
  const std::size_t most = page_bytes(entries.size());
  std::vector<WrittenIdPage> pages;
  ByteWriter writer;
  std::uint64_t last = 0;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const IdEntry& entry = entries[i];
    // Entries of one hash stay in one page.
    const bool is_new = i == 0 || (writer.size() >= most && entry.hash != last);
    if (is_new) {
      if (i > 0) pages.back().payload = std::exchange(writer, {}).bytes();
      pages.push_back({{}, entry.hash});
      last = entry.hash;
    }
    writer.varint(entry.hash - last);
    writer.varint(entry.block);
    last = entry.hash;
  }
  if (!pages.empty()) pages.back().payload = std::move(writer).bytes();
  return pages;
}

Result<std::vector<IdEntry>> read_id_page(ByteView payload, const IdPage& page, std::uint8_t bits,
                                          std::uint64_t blocks) {
  const std::uint64_t largest = cut_hash(~std::uint64_t{0}, bits);
  ByteReader reader(payload);
  std::vector<IdEntry> entries;
  std::uint64_t last = page.first;
  bool is_good = last <= largest;
  while (is_good && reader.remaining() > 0) {
    const std::uint64_t step = reader.varint();
    const IdEntry entry{last + step, reader.varint()};
    is_good = !reader.failed() && step <= largest - last && entry.block < blocks &&
              (entries.empty() ? step == 0 : entries.back() < entry);
    last = entry.hash;
    entries.push_back(entry);
  }
  if (is_good && !entries.empty()) return entries;
  return Error{ErrorCode::malformed, "malformed index of ids", page.extent.offset, {}};
}

}  // namespace watertight::pipeline
