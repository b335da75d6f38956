// SPDX-License-Identifier: GPL-3.0-or-later
//
// The kinds of input files: a document of any format, a Watertight file or a blob.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/bytes.h"
#include "cli/files.h"
#include "formats/feature_reader.h"
#include "pipeline/pipeline.h"

namespace watertight::cli {

enum class InputKind : std::uint8_t {
  document,
  container,  // a Watertight file
  blob,       // a blob, or a page, which no command reads by itself
  page_file   // a part of a Watertight file; no command reads one by itself
};

/// The kind by the first 8 bytes, whatever the name and however damaged the rest is.
InputKind kind_of_input(ByteView bytes);

struct Input {
  InputKind kind = InputKind::document;
  Document document;
};

/// Reads an input. Errors: those of the readers; unsupported for page files.
Result<Input> load_input(const std::string& path, ByteView bytes,
                         const formats::ReadOptions& options);

/// The error for a page file.
Error page_file_error();

/// A document that is read feature by feature; Watertight files and blobs are read whole.
struct OpenedInput {
  formats::FeatureReader reader;
  std::optional<std::uint64_t> bytes;  // the size of the file, if it has one
};

/// A file of which only the kind is known.
struct FoundInput {
  InputKind kind = InputKind::document;
  formats::ByteSource source;          // all bytes of the file
  std::optional<std::uint64_t> bytes;  // the size of the file, if it has one
};

/// Finds the kind of an opened file. Errors: those of its source.
Result<FoundInput> find_input(OpenedFile file);

/// Opens an input. Errors: unavailable with the reason; those of the readers.
Result<OpenedInput> open_input(const std::string& path, const formats::ReadOptions& options);
Result<OpenedInput> open_input(const std::string& path, FoundInput input,
                               const formats::ReadOptions& options);

/// The format that an output file's name asks for. Errors: unsupported naming the known endings.
Result<Format> format_of_name(const std::string& path);

}  // namespace watertight::cli
