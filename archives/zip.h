// SPDX-License-Identifier: GPL-3.0-or-later
//
// The members of a zip archive (also zip64): stored or deflated, not encrypted. Nothing is ever
// extracted to a file.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "archives/expansion.h"

namespace watertight::archives {

/// The bytes of an archive in any order.
struct RandomBytes {
  std::uint64_t size = 0;
  /// Fills the span from an offset on and returns the number of bytes; 0 at the end.
  std::function<Result<std::size_t>(std::uint64_t offset, std::span<std::uint8_t>)> read;
};

/// A file in an archive. Names are bytes from outside: they can be anything but "".
struct ZipMember {
  std::string name;
  std::uint64_t size = 0;  // expanded, as the archive says
  // Where the archive lists the member; opaque.
  std::uint64_t place = 0;
  std::uint64_t number = 0;
};

/// The files of an archive in its order, without folders. Errors: those of `bytes`; malformed for
/// an archive without list of members (truncated) or without members, or with two of one name.
/// Cost: linear in the list.
Result<std::vector<ZipMember>> zip_members(const RandomBytes& bytes);

/// The expanded bytes of all members of an archive that were read so far, against one limit.
class ExpansionCount {
 public:
  ExpansionCount(const ExpansionLimit& limit, std::uint64_t archive_bytes)
      : limit_(limit), archive_bytes_(archive_bytes) {}
  /// Ok if so many bytes more are within the limit. Errors: limit_exceeded.
  Status add(std::uint64_t bytes);

 private:
  ExpansionLimit limit_;
  std::uint64_t archive_bytes_;
  std::uint64_t given_ = 0;
};

/// A source of the expanded bytes of a member, verified at the end. Errors: unsupported for an
/// encrypted member or another method of compression, malformed; the source has malformed and
/// limit_exceeded. Memory: 100 KiB. Not thread-safe, also not with other sources of one `count`.
Result<ByteSource> open_member(RandomBytes bytes, const ZipMember& member,
                               std::shared_ptr<ExpansionCount> count);

}  // namespace watertight::archives
