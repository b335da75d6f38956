// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/file/records.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "base/checksum.h"

namespace watertight::pipeline {
namespace {

constexpr std::size_t kMagicBytes = sizeof(kContainerMagic);
constexpr std::size_t kChecksumBytes = 4;
constexpr std::size_t kVarintBytes = 10;  // the most bytes of a varint
constexpr std::uint64_t kKinds = 4;

/// The checksum of a record starts with the head of the file, so that no version takes a record of
/// another for its own.
std::uint32_t checksum_of(ByteView record) {
  static const std::uint32_t head = crc32c(file_head());
  return crc32c(record, head);
}

/// A varint whose bytes stand in reverse order, so that it can be read from its end.
Bytes reversed_varint(std::uint64_t value) {
  ByteWriter writer;
  writer.varint(value);
  Bytes bytes = std::move(writer).bytes();
  std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

}  // namespace

Error malformed_file(std::string message, std::uint64_t offset) {
  return {ErrorCode::malformed, std::move(message), offset, {}};
}

Bytes file_head() {
  Bytes head(std::begin(kContainerMagic), std::end(kContainerMagic));
  head.push_back(kContainerVersion);
  return head;
}

bool is_container(ByteView bytes) {
  return bytes.size() >= kMagicBytes &&
         std::equal(std::begin(kContainerMagic), std::end(kContainerMagic), bytes.begin());
}

Status check_head(ByteView bytes) {
  if (!is_container(bytes)) return malformed_file("not a Watertight file", 0);
  if (bytes.size() == kMagicBytes) return malformed_file("truncated Watertight file", bytes.size());
  const std::uint8_t version = bytes[kMagicBytes];
  if (version == kContainerVersion) return Done{};
  return Error{ErrorCode::unsupported,
               std::string("Watertight file of version ") + std::to_string(version) +
                   "; this program reads version " + std::to_string(kContainerVersion),
               kMagicBytes,
               {}};
}

Bytes write_record(RecordKind kind, ByteView payload) {
  ByteWriter writer;
  writer.varint(kKinds * payload.size() + static_cast<std::uint64_t>(kind));
  writer.append(payload);
  writer.u32(checksum_of(writer.bytes()));
  if (kind == RecordKind::commit) writer.append(reversed_varint(writer.size()));
  return std::move(writer).bytes();
}

Result<Record> read_record(ByteView bytes, std::uint64_t offset) {
  ByteReader reader(bytes);
  const std::uint64_t head = reader.varint();
  const std::uint64_t size = head / kKinds;
  Record record;
  record.kind = static_cast<RecordKind>(head % kKinds);
  if (reader.failed() || size > reader.remaining() || reader.remaining() - size < kChecksumBytes) {
    return malformed_file("truncated record of a Watertight file", offset);
  }
  record.payload = reader.take(static_cast<std::size_t>(size));
  const std::size_t checked = reader.position();
  if (reader.u32() != checksum_of(bytes.first(checked))) {
    return malformed_file("damaged record of a Watertight file: its checksum differs", offset);
  }
  record.extent = {offset, reader.position()};
  if (record.kind != RecordKind::commit) return record;
  const Bytes mark = reversed_varint(record.extent.size);
  const ByteView found = reader.take(std::min(mark.size(), reader.remaining()));
  if (!std::equal(mark.begin(), mark.end(), found.begin(), found.end())) {
    return malformed_file("damaged commit of a Watertight file: its length differs",
                          offset + record.extent.size);
  }
  record.extent.size += mark.size();
  return record;
}

std::optional<std::uint64_t> size_of_last_commit(ByteView tail) {
  Bytes last(
      tail.begin() + static_cast<std::ptrdiff_t>(tail.size() - std::min(tail.size(), kVarintBytes)),
      tail.end());
  std::reverse(last.begin(), last.end());
  ByteReader reader(last);
  const std::uint64_t size = reader.varint();
  if (reader.failed() || size > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
  return size + reader.position();
}

Walk walk_records(ByteView file) {
  Walk walk;
  std::vector<Record> open;  // since the last commit
  std::uint64_t offset = std::min(kMagicBytes + 1, file.size());
  while (offset < file.size()) {
    const auto record = read_record(file.subspan(static_cast<std::size_t>(offset)), offset);
    if (!record) {
      walk.torn = record.error();
      return walk;
    }
    open.push_back(*record);
    offset = record->extent.end();
    if (record->kind != RecordKind::commit) continue;
    walk.records.insert(walk.records.end(), open.begin(), open.end());
    walk.committed = offset;
    open.clear();
  }
  if (walk.committed < file.size() || walk.committed == 0) {
    walk.torn = malformed_file("truncated Watertight file: no commit ends it", file.size());
  }
  return walk;
}

}  // namespace watertight::pipeline
