// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/file/commit.h"

#include <array>
#include <cmath>
#include <utility>

namespace watertight::pipeline {
namespace {

void write_extent(ByteWriter& writer, const Extent& extent) {
  writer.varint(extent.size);
  if (extent.size > 0) writer.varint(extent.offset);
}

Extent read_extent(ByteReader& reader) {
  Extent extent;
  extent.size = reader.varint();
  if (extent.size > 0) extent.offset = reader.varint();
  return extent;
}

void write_box(ByteWriter& writer, const FlatBox& box) {
  for (const double value : {box.min[0], box.min[1], box.max[0], box.max[1]}) writer.f64(value);
}

FlatBox read_box(ByteReader& reader) {
  FlatBox box;
  for (double* value : {&box.min[0], &box.min[1], &box.max[0], &box.max[1]}) *value = reader.f64();
  return box;
}

bool is_box(const FlatBox& box) {
  for (std::size_t axis = 0; axis < 2; ++axis) {
    if (!std::isfinite(box.min[axis]) || !std::isfinite(box.max[axis])) return false;
    if (box.min[axis] > box.max[axis]) return false;
  }
  return true;
}

/// Whether an extent ends before the commit.
bool is_before(const Extent& extent, std::uint64_t offset) {
  return extent.offset <= offset && extent.size <= offset - extent.offset;
}

}  // namespace

Bytes write_commit(const Commit& commit) {
  ByteWriter writer;
  writer.varint(commit.features);
  writer.varint(commit.solids);
  write_extent(writer, commit.documents);
  write_extent(writer, commit.deleted);
  writer.varint(commit.block_pages.size());
  for (const BlockPage& page : commit.block_pages) {
    write_extent(writer, page.extent);
    writer.varint(page.blocks);
    writer.u8(page.box ? 1 : 0);
    if (page.box) write_box(writer, *page.box);
  }
  writer.varint(commit.ids.pages.size());
  if (commit.ids.pages.empty()) return std::move(writer).bytes();
  writer.u8(commit.ids.bits);
  writer.varint(commit.ids.pages.front().extent.offset);
  std::uint64_t first = 0;
  for (const IdPage& page : commit.ids.pages) {
    writer.varint(page.extent.size);
    writer.varint(page.first - first);
    first = page.first;
  }
  return std::move(writer).bytes();
}

Result<Commit> read_commit(ByteView payload, std::uint64_t offset) {
  ByteReader reader(payload);
  bool is_good = true;
  Commit commit;
  commit.features = reader.varint();
  commit.solids = reader.varint();
  commit.documents = read_extent(reader);
  commit.deleted = read_extent(reader);
  is_good = is_before(commit.documents, offset) && is_before(commit.deleted, offset);
  const std::uint64_t block_pages = reader.varint();
  std::uint64_t end = 0;  // of the page before: no two pages have the same bytes
  for (std::uint64_t i = 0; i < block_pages && is_good && !reader.failed(); ++i) {
    BlockPage& page = commit.block_pages.emplace_back();
    page.extent = read_extent(reader);
    page.blocks = reader.varint();
    const std::uint8_t has_box = reader.u8();
    if (has_box != 0) page.box = read_box(reader);
    is_good = page.extent.size > 0 && is_before(page.extent, offset) && page.extent.offset >= end &&
              page.blocks > 0 && page.blocks <= page.extent.size && has_box <= 1 &&
              (!page.box || is_box(*page.box));
    if (is_good) end = page.extent.end();
  }
  const std::uint64_t id_pages = is_good ? reader.varint() : 0;
  std::uint64_t start = 0;
  if (id_pages > 0) {
    commit.ids.bits = reader.u8();
    start = reader.varint();
    is_good = commit.ids.bits <= 64 && start <= offset;
  }
  std::uint64_t first = 0;
  for (std::uint64_t i = 0; i < id_pages && is_good && !reader.failed(); ++i) {
    IdPage& page = commit.ids.pages.emplace_back();
    page.extent = {start, reader.varint()};
    const std::uint64_t step = reader.varint();
    page.first = first + step;
    is_good = page.extent.size > 0 && is_before(page.extent, offset) && page.first >= first &&
              (i == 0 || step > 0);
    first = page.first;
    start += page.extent.size;
  }
  if (is_good && !reader.failed() && reader.remaining() == 0) return commit;
  return Error{ErrorCode::malformed, "malformed commit of a Watertight file", offset, {}};
}

Bytes write_deleted(const std::vector<DeletedFeature>& deleted) {
  ByteWriter writer;
  DeletedFeature last;
  for (const DeletedFeature& one : deleted) {
    const bool is_same = one.block == last.block;
    writer.varint(one.block - last.block);
    writer.varint(is_same ? one.feature - last.feature : one.feature);
    last = one;
  }
  return std::move(writer).bytes();
}

Result<std::vector<DeletedFeature>> read_deleted(ByteView payload, std::uint64_t offset) {
  ByteReader reader(payload);
  std::vector<DeletedFeature> deleted;
  DeletedFeature last;
  while (reader.remaining() > 0 && !reader.failed()) {
    DeletedFeature one;
    const std::uint64_t step = reader.varint();
    const std::uint64_t feature = reader.varint();
    one.block = last.block + step;
    one.feature = step == 0 ? last.feature + feature : feature;
    const bool is_ascending = deleted.empty() || last < one;
    if (reader.failed() || one.block < last.block || !is_ascending) {
      return Error{ErrorCode::malformed,
                   "malformed list of deleted features",
                   offset + reader.position(),
                   {}};
    }
    deleted.push_back(one);
    last = one;
  }
  return deleted;
}

}  // namespace watertight::pipeline
