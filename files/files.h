// SPDX-License-Identifier: GPL-3.0-or-later
//
// Files: read whole or in pieces, written atomically; "-" is standard input or
// output.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "archives/zip.h"
#include "base/byte_source.h"
#include "base/bytes.h"
#include "base/limits.h"
#include "base/result.h"

namespace watertight::files {

/// A file, standard input or a member of an archive, read piece by piece.
struct OpenedFile {
  ByteSource source;
  std::optional<std::uint64_t> bytes;  // the size of the file, if it has one
  bool is_member = false;              // of an archive
};

/// The bytes of a file in any order. Errors: unavailable with the system's reason.
Result<archives::RandomBytes> open_random(const std::string& path);

/// An input of a run: a file, a file in a folder or a member of a zip archive.
struct InputFile {
  std::string name;      // for messages and reports: "town.zip/a.city.json", "-"
  std::string file;      // the path of the file that holds it
  std::string relative;  // the name below the argument of the command line that stands for it
  /// Opens it. Errors: unavailable with the system's reason; those of the archive.
  std::function<Result<OpenedFile>()> open;
};

/// Opens a file for reading. Errors: unavailable with the system's reason.
Result<OpenedFile> open_file(const std::string& path);

/// Inputs of which each is opened when its turn comes, or, for a program that gives up its rights
/// meanwhile, as many as it may have open at once beforehand.
class EarlyFiles {
 public:
  EarlyFiles() = default;
  /// `inputs` must outlive the object.
  EarlyFiles(std::span<const InputFile> inputs, bool opens_early);

  /// The input of this number; call once. Errors: those of InputFile::open, and that there were too
  /// many files to open this one beforehand.
  Result<OpenedFile> take(std::size_t number);

 private:
  std::span<const InputFile> inputs_;
  std::vector<Result<OpenedFile>> early_;
  bool opens_early_ = false;
};

/// Reads a source to its end. Errors: those of the source; limit_exceeded.
Result<Bytes> read_all(const ByteSource& source, const Limits& limits);

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

}  // namespace watertight::files
