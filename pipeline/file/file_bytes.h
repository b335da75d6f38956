// SPDX-License-Identifier: GPL-3.0-or-later
//
// The bytes of a file that is read in ranges: from a disk, a web server, a database.
#pragma once

#include <cstdint>
#include <functional>
#include <list>
#include <span>

#include "base/bytes.h"
#include "pipeline/file/records.h"

namespace watertight::pipeline {

/// A file in ranges. The callback returns exactly the bytes of the range, which is within `size`.
struct FileBytes {
  std::uint64_t size = 0;
  std::function<Result<Bytes>(std::uint64_t offset, std::uint64_t size)> read;
};

/// The ranges of a file that were read last, so that they are not read again.
class RangeCache {
 public:
  explicit RangeCache(FileBytes file) : file_(std::move(file)) {}
  /// A file that is in memory; `bytes` must outlive the object.
  explicit RangeCache(ByteView bytes);

  std::uint64_t size() const { return file_.size; }
  /// The number of bytes that were read so far.
  std::uint64_t bytes_read() const { return bytes_read_; }
  /// Whether all of the file is in memory: then what get() returns stays valid.
  bool has_all() const { return find({0, size()}) != nullptr; }

  /// The bytes of an extent within the file; valid until the next call of get() or fetch(). Errors:
  /// those of the callback; unavailable if it returns another number of bytes.
  Result<ByteView> get(const Extent& extent);
  /// Reads an extent and keeps it as long as this object lives. Errors: those of get().
  Result<ByteView> keep(const Extent& extent);
  /// Reads all these extents, in few requests: neighbours together, and at most `most_requests` as
  /// long as no more bytes between them are read than they have. They are kept until the next call.
  /// Errors: those of get().
  Status fetch(std::vector<Extent> extents, std::size_t most_requests);

 private:
  struct Range {
    Extent extent;
    Bytes bytes;
    ByteView view;
  };
  Result<Range> read(const Extent& extent);
  const Range* find(const Extent& extent) const;

  FileBytes file_;
  std::uint64_t bytes_read_ = 0;
  std::list<Range> kept_;
  std::list<Range> fetched_;
};

/// The ranges to read for these extents; see RangeCache::fetch(). Ascending, without overlap.
std::vector<Extent> joined_ranges(std::vector<Extent> extents, std::size_t most_requests);

}  // namespace watertight::pipeline
