// SPDX-License-Identifier: GPL-3.0-or-later
//
// Files of the command line: read whole or in pieces, written atomically; "-" is standard input or
// output.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/bytes.h"
#include "base/limits.h"
#include "base/result.h"
#include "formats/feature_reader.h"

namespace watertight::cli {

/// A file or standard input, read piece by piece.
struct OpenedFile {
  formats::ByteSource source;
  std::optional<std::uint64_t> bytes;  // the size of the file, if it has one
};

/// Opens a file for reading. Errors: unavailable with the system's reason.
Result<OpenedFile> open_file(const std::string& path);

/// Files of which each is opened when its turn comes, or, for a program that gives up its rights
/// meanwhile, as many as it may have open at once beforehand.
class EarlyFiles {
 public:
  EarlyFiles() = default;
  /// `paths` must outlive the object.
  EarlyFiles(std::span<const std::string> paths, bool opens_early);

  /// The file of this number; call once. Errors: those of open_file(), and that there were too many
  /// files to open this one beforehand.
  Result<OpenedFile> take(std::size_t number);

 private:
  std::span<const std::string> paths_;
  std::vector<Result<OpenedFile>> early_;
  bool opens_early_ = false;
};

/// Reads a source to its end. Errors: those of the source; limit_exceeded.
Result<Bytes> read_all(const formats::ByteSource& source, const Limits& limits);

/// Reads a whole file. Errors: those of open_file() and read_all().
Result<Bytes> read_file(const std::string& path, const Limits& limits);

/// Writes a new file beside the target and renames it, so that nobody sees half a file and a
/// failure leaves the old file. Errors: unavailable with the reason.
Status write_file(const std::string& path, ByteView bytes);

/// A file that is written piece by piece, with the promises of write_file().
class FileWriter {
 public:
  /// Starts to write a file. Errors: unavailable with the reason.
  static Result<FileWriter> open(const std::string& target);
  /// Writes to an open file, which it closes. Another process gives the file its name.
  static FileWriter to(int descriptor);
  FileWriter(FileWriter&&) noexcept;
  FileWriter& operator=(FileWriter&&) = delete;
  ~FileWriter();  // without commit(), the old file stays

  Status write(std::string_view text);
  /// Puts the new file in the place of the old one. Errors: unavailable; then the old file is still
  /// there.
  Status commit();
  /// The file, for another process that writes it.
  int descriptor() const;

 private:
  struct State;
  explicit FileWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// The name of file `number` of an output: "town.city.jsonl", "town-2.city.jsonl", ...
std::string numbered_name(const std::string& output, std::size_t number);

/// Whether writing one file would destroy the other. Devices and pipes can be written many times.
bool is_same_file(const std::string& a, const std::string& b);

}  // namespace watertight::cli
