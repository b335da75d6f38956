// SPDX-License-Identifier: GPL-3.0-or-later
//
// The payload of a commit: the counts of a file and the roots of its index (docs/format-file.md,
// "Commit"). A file that is read whole has an empty one.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "pipeline/file/block_pages.h"
#include "pipeline/file/id_pages.h"
#include "pipeline/file/records.h"

namespace watertight::pipeline {

struct Commit {
  std::uint64_t features = 0;  // without those that are deleted
  std::uint64_t solids = 0;    // those of these features
  Extent documents;            // the record of all documents; size 0: they are in the first block
  Extent deleted;              // the record of deleted features; size 0: none is
  std::vector<BlockPage> block_pages;  // in the order of their blocks; none: walk over the records
  IdPages ids;
};

Bytes write_commit(const Commit& commit);
/// Reads a commit that stands at `offset`. Each extent ends before it. Errors: malformed.
Result<Commit> read_commit(ByteView payload, std::uint64_t offset);

/// A feature that is deleted: the number of its block, and its index in the block.
struct DeletedFeature {
  std::uint64_t block = 0;
  std::uint64_t feature = 0;
  friend auto operator<=>(const DeletedFeature&, const DeletedFeature&) = default;
};
/// The payload of the record of deleted features, which are ascending.
Bytes write_deleted(const std::vector<DeletedFeature>& deleted);
/// Errors: malformed, with an offset from `offset` on.
Result<std::vector<DeletedFeature>> read_deleted(ByteView payload, std::uint64_t offset);

}  // namespace watertight::pipeline
