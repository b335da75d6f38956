// SPDX-License-Identifier: GPL-3.0-or-later
//
// Files of the command line: read whole, written atomically; "-" is standard input or output.
#pragma once

#include <memory>
#include <string>

#include "formats/feature_reader.h"
#include "pipeline/pipeline.h"

namespace watertight {

/// Errors: unavailable naming the file and the system's reason; limit_exceeded.
Result<Bytes> read_file(const std::string& path, const Limits& limits);

/// Writes beside the target and renames, so that nobody sees half a file and a failure leaves the
/// old one. Errors: unavailable with the reason.
Status write_file(const std::string& path, ByteView bytes);

/// A file that is written piece by piece, with the promises of write_file().
class FileWriter {
 public:
  /// Errors: unavailable with the reason.
  static Result<FileWriter> open(const std::string& target);
  FileWriter(FileWriter&&) noexcept;
  FileWriter& operator=(FileWriter&&) = delete;
  ~FileWriter();  // without commit(), leaves what was there before

  Status write(std::string_view text);
  /// Errors: unavailable; then the old file is still there.
  Status commit();

 private:
  struct State;
  explicit FileWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Whether writing the one would destroy the other. Devices and pipes can be written many times.
bool is_same_file(const std::string& a, const std::string& b);

/// What an input file was.
enum class InputKind : std::uint8_t { document, container, blob };

struct Input {
  InputKind kind = InputKind::document;
  Document document;
};

/// Reads a document of any format, a Watertight file or a bare blob, told apart by content and
/// name. Errors: those of the readers.
Result<Input> load_input(const std::string& path, ByteView bytes, const ReadOptions& options);

/// No command reads page files by themselves: they are parts of Watertight files.
Error page_file_error();

/// A document that is read feature by feature; Watertight files and bare blobs are read whole.
struct OpenedInput {
  FeatureReader reader;
  std::optional<std::uint64_t> bytes;  // of the file, when it has a size
};

/// Errors: unavailable with the reason; those of the readers.
Result<OpenedInput> open_input(const std::string& path, const ReadOptions& options);

/// The format that an output file's name asks for. Errors: unsupported naming the known endings.
Result<Format> format_of_name(const std::string& path);

}  // namespace watertight
