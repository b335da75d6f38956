// SPDX-License-Identifier: GPL-3.0-or-later
//
// A file without a name, for more bytes than memory should hold.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "base/bytes.h"
#include "base/result.h"

namespace watertight {

/// Bytes in a file that vanishes with this object or its process. Several threads may read() at
/// once, but not while another appends.
class TemporaryFile {
 public:
  /// A new, empty file in the folder for temporary files (TMPDIR, else /tmp). Errors: unavailable
  /// with the system's reason.
  static Result<TemporaryFile> make();
  /// The same, for a library that writes files by their name: the file has a name while `open`
  /// gets it. After the library's last write call measure(). Errors: besides, those of `open`.
  static Result<TemporaryFile> make(const std::function<Status(const std::string& path)>& open);
  ~TemporaryFile();
  TemporaryFile(TemporaryFile&& other) noexcept
      : descriptor_(std::exchange(other.descriptor_, -1)), size_(other.size_) {}
  TemporaryFile& operator=(TemporaryFile&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    std::swap(size_, other.size_);
    return *this;
  }

  /// Adds bytes at the end. Errors: unavailable, when the disk is full for example; the file is of
  /// no more use then.
  Status append(ByteView bytes);
  /// The `count` bytes from `offset` on, which must be there. Errors: unavailable.
  Result<Bytes> read(std::uint64_t offset, std::size_t count) const;
  std::uint64_t size() const { return size_; }
  /// Learns how long the file has become by the writes of others. Errors: unavailable.
  Status measure();

 private:
  explicit TemporaryFile(int descriptor) : descriptor_(descriptor) {}

  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace watertight
