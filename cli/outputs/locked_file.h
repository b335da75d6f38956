// SPDX-License-Identifier: GPL-3.0-or-later
//
// A Watertight file that one process at a time adds to.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "pipeline/file/file_bytes.h"

namespace watertight::cli {

class LockedFile {
 public:
  /// Opens a file for reading and writing, and locks it (flock) against others that do so. Errors:
  /// unavailable with the system's reason, or because another process has the lock.
  static Result<LockedFile> open(const std::string& path);

  /// The file as it is now, to be read; valid as long as this object.
  pipeline::FileBytes bytes() const;
  /// Cuts the file off at `end` and adds two parts. The second is written when the first is safe on
  /// the disk, and is safe itself when this returns. Errors: unavailable; what was before `end` is
  /// as it was then, and the file is torn after it.
  Status add(std::uint64_t end, ByteView records, ByteView commit);

 private:
  class Descriptor;
  explicit LockedFile(std::shared_ptr<Descriptor> file) : file_(std::move(file)) {}
  std::shared_ptr<Descriptor> file_;
};

}  // namespace watertight::cli
