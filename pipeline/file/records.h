// SPDX-License-Identifier: GPL-3.0-or-later
//
// The frame of a Watertight file (docs/format-file.md): a head, then records, of which each is
// added at the end and never changed. The last record is a commit; it counts with all before it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/bytes.h"
#include "base/result.h"

namespace watertight::pipeline {

/// The first bytes of a Watertight file. Like those of PNG they have a byte above 127, and line
/// ends that a text-mode transfer would change.
inline constexpr std::uint8_t kContainerMagic[8] = {0x89, 'W', 'T', 'F', '\r', '\n', 0x1A, '\n'};
/// The version of the layout. Versions 1 and 2 were never released.
inline constexpr std::uint8_t kContainerVersion = 3;

enum class RecordKind : std::uint8_t { block, documents, index, commit };

/// The error malformed at a byte of a file.
Error malformed_file(std::string message, std::uint64_t offset);

/// A piece of a file.
struct Extent {
  std::uint64_t offset = 0;
  std::uint64_t size = 0;
  std::uint64_t end() const { return offset + size; }
  friend bool operator==(const Extent&, const Extent&) = default;
};

/// A record and where it stands.
struct Record {
  RecordKind kind = RecordKind::block;
  Extent extent;     // with kind, length and checksum
  ByteView payload;  // its contents, in the bytes that were read
};

/// Magic and version: the first bytes of a file.
Bytes file_head();
/// True if the bytes start like a Watertight file of any version.
bool is_container(ByteView bytes);
/// Ok for the first bytes of a file of this version. Errors: malformed; unsupported.
Status check_head(ByteView bytes);

/// A record with its frame.
Bytes write_record(RecordKind kind, ByteView payload);
/// The record at the front of `bytes`, which stand at `offset` in the file. Errors: malformed, with
/// the offset in the file, also when its checksum differs.
Result<Record> read_record(ByteView bytes, std::uint64_t offset);

/// The size of the commit at the end of `tail`, as its last bytes state it; nullopt if they do not.
/// The bytes of a commit may be anything, so only read_record() tells whether there is one.
std::optional<std::uint64_t> size_of_last_commit(ByteView tail);

/// The records of a file up to the last commit, and the reason why the walk ended before the end of
/// the file, if it did.
struct Walk {
  std::vector<Record> records;
  std::uint64_t committed = 0;  // the end of the last commit, 0 without one
  std::optional<Error> torn;
};
/// Walks over a whole file. Cost: linear; every checksum is verified.
Walk walk_records(ByteView file);

}  // namespace watertight::pipeline
