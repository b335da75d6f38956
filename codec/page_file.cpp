// SPDX-License-Identifier: GPL-3.0-or-later
//
// Layout: the magic and the version (5 bytes), the pages, the index, the CRC-32C of the index (4
// bytes), the length of the index (4 bytes), the magic again (4 bytes).
#include "codec/page_file.h"

#include <algorithm>
#include <string>
#include <utility>

#include "base/checksum.h"
#include "codec/encode_boundary.h"
#include "codec/page/container.h"
#include "codec/page/solid_coder.h"

namespace watertight::codec {
namespace {

constexpr std::uint8_t kPageMagic[4] = {'W', 'T', 'P', 'F'};
constexpr std::size_t kHeadBytes = 5;
constexpr std::size_t kTailBytes = 12;
// The largest number of pages that wait for more solids at a time, one for each frame.
constexpr std::size_t kMaxOpenPages = 16;

bool has_magic(ByteView bytes) {
  return std::equal(std::begin(kPageMagic), std::end(kPageMagic), bytes.begin());
}

Error malformed(const char* what) {
  return {ErrorCode::malformed, std::string("the page file ") + what};
}

}  // namespace

struct PageFileWriter::OpenPage {
  Frame frame;
  std::vector<OrientedBoundary> solids;
  std::vector<std::uint64_t> numbers;
};

PageFileWriter::PageFileWriter(std::size_t page_solids, EncodeOptions options)
    : page_solids_(std::clamp<std::size_t>(page_solids, 1, kMaxPageSolids)), options_(options) {
  ByteWriter writer;
  writer.append(kPageMagic);
  writer.u8(kFormatVersion);
  written_ = std::move(writer).bytes();
}

PageFileWriter::~PageFileWriter() = default;
PageFileWriter::PageFileWriter(PageFileWriter&&) noexcept = default;
PageFileWriter& PageFileWriter::operator=(PageFileWriter&&) noexcept = default;

Status PageFileWriter::close(OpenPage& page) {
  std::vector<const OrientedBoundary*> solids;
  for (const OrientedBoundary& boundary : page.solids) solids.push_back(&boundary);
  auto bytes = encode_boundaries(solids, page.frame.acceptance, options_);
  if (!bytes) return bytes.error();
  written_.insert(written_.end(), bytes->begin(), bytes->end());
  index_.push_back({bytes->size(), std::move(page.numbers)});
  return Done{};
}

Status PageFileWriter::add(const ValidSolid& solid) {
  return add(solid.boundary(), solid.acceptance());
}

Status PageFileWriter::add_blob(ByteView blob, const Limits& limits) {
  auto decoded = decode(blob, limits);
  if (!decoded) return std::move(decoded).error();
  const auto boundary = OrientedBoundary::make(std::move(decoded->solid));
  if (!boundary) return boundary.error();
  return add(*boundary, decoded->info.acceptance);
}

Status PageFileWriter::add(const OrientedBoundary& boundary, const Acceptance& acceptance) {
  const Frame frame = frame_of(boundary.solid(), acceptance);
  auto page = std::find_if(open_.begin(), open_.end(),
                           [&](const OpenPage& other) { return other.frame == frame; });
  if (page == open_.end()) {
    if (open_.size() == kMaxOpenPages) {
      if (auto status = close(open_.front()); !status) return status;
      open_.erase(open_.begin());
    }
    open_.push_back(OpenPage{frame, {}, {}});
    page = open_.end() - 1;
  }
  page->solids.push_back(boundary);
  page->numbers.push_back(count_++);
  if (page->solids.size() < page_solids_) return Done{};
  const Status status = close(*page);
  open_.erase(page);
  return status;
}

void PageFileWriter::add_page(ByteView page, std::uint64_t solids) {
  Entry& entry = index_.emplace_back(Entry{page.size(), {}});
  for (std::uint64_t i = 0; i < solids; ++i) entry.numbers.push_back(count_++);
  written_.insert(written_.end(), page.begin(), page.end());
}

Bytes PageFileWriter::take() { return std::exchange(written_, {}); }

Result<Bytes> PageFileWriter::finish() && {
  for (OpenPage& page : open_) {
    if (auto status = close(page); !status) return status.error();
  }
  ByteWriter index;
  index.varint(count_);
  index.varint(index_.size());
  for (const Entry& entry : index_) {
    index.varint(entry.bytes);
    index.varint(entry.numbers.size());
    // The gaps between the numbers are almost always 0.
    std::uint64_t next = 0;
    for (const std::uint64_t number : entry.numbers) {
      index.varint(number - next);
      next = number + 1;
    }
  }
  ByteWriter tail;
  tail.append(index.bytes());
  tail.u32(crc32c(index.bytes()));
  tail.u32(static_cast<std::uint32_t>(index.size()));
  tail.append(kPageMagic);
  Bytes result = std::move(written_);
  result.insert(result.end(), tail.bytes().begin(), tail.bytes().end());
  return result;
}

bool is_page_file(ByteView bytes) { return bytes.size() >= kHeadBytes && has_magic(bytes); }

Result<PageFileReader> PageFileReader::open(ByteView file, const Limits& limits) {
  if (file.size() < kHeadBytes + kTailBytes || !has_magic(file) || !has_magic(file.last(4))) {
    return malformed("is truncated or is not a page file");
  }
  if (file[4] != kFormatVersion) {
    return Error{ErrorCode::unsupported, "page file of version " + std::to_string(file[4])};
  }
  ByteReader tail(file.last(kTailBytes));
  const std::uint32_t sum = tail.u32();
  const std::uint32_t size = tail.u32();
  const ByteView body = file.subspan(kHeadBytes, file.size() - kHeadBytes - kTailBytes);
  if (size > body.size()) return malformed("has an index longer than the file");
  const ByteView index = body.last(size);
  if (crc32c(index) != sum) return malformed("has a damaged index");
  ByteReader reader(index);
  PageFileReader result;
  result.limits_ = limits;
  const std::uint64_t count = reader.varint();
  const std::uint64_t pages = reader.varint();
  if (reader.failed() || count > index.size() || pages > index.size()) {
    return malformed("has an index that counts more pages or solids than it can hold");
  }
  result.slot_of_.assign(count, PageSlot{pages, 0});
  ByteReader page_bytes(body.first(body.size() - size));
  for (std::uint64_t page = 0; page < pages; ++page) {
    const std::uint64_t size_of_page = reader.varint();
    const std::uint64_t solids = reader.varint();
    if (reader.failed() || size_of_page > page_bytes.remaining() || solids == 0 ||
        solids > kMaxPageSolids) {
      return malformed("has an index that does not fit its pages");
    }
    result.pages_.push_back(page_bytes.take(static_cast<std::size_t>(size_of_page)));
    std::vector<std::uint64_t>& numbers = result.numbers_.emplace_back();
    std::uint64_t next = 0;
    for (std::uint64_t slot = 0; slot < solids; ++slot) {
      const std::uint64_t gap = reader.varint();
      if (gap >= count || next + gap >= count || result.slot_of_[next + gap].page != pages) {
        return malformed(
            "has an index with a number of a solid that is out of range or that is there twice");
      }
      next += gap;
      result.slot_of_[next] = {page, slot};
      numbers.push_back(next++);
    }
  }
  const bool all_listed = std::all_of(result.slot_of_.begin(), result.slot_of_.end(),
                                      [&](const PageSlot& found) { return found.page != pages; });
  if (reader.failed() || reader.remaining() != 0 || page_bytes.remaining() != 0 || !all_listed) {
    return malformed("has an index that does not fit its pages");
  }
  return result;
}

Result<std::vector<PageFileReader::NumberedSolid>> PageFileReader::page(std::size_t page) const {
  auto decoded = decode_page(pages_[page], limits_);
  if (!decoded) return decoded.error();
  if (decoded->size() != numbers_[page].size()) {
    return malformed("has a page of another size than its index says");
  }
  std::vector<NumberedSolid> solids;
  for (std::size_t slot = 0; slot < decoded->size(); ++slot) {
    solids.push_back({numbers_[page][slot], std::move((*decoded)[slot])});
  }
  return solids;
}

Result<Decoded> PageFileReader::solid(std::uint64_t number) const {
  if (number >= size()) {
    return Error{ErrorCode::invalid_argument,
                 "solid " + std::to_string(number) + " of " + std::to_string(size())};
  }
  const PageSlot& found = slot_of_[number];
  auto solids = page(found.page);
  if (!solids) return solids.error();
  return std::move((*solids)[found.slot].decoded);
}

}  // namespace watertight::codec
