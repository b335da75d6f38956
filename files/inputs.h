// SPDX-License-Identifier: GPL-3.0-or-later
//
// The kinds of input files: a document of any format, a Watertight file or a blob.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/bytes.h"
#include "files/files.h"
#include "formats/feature_reader.h"
#include "pipeline/pipeline.h"

namespace watertight::files {

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

/// Reads a document; its name decides on the format. Errors: those of the readers; unsupported for
/// page files.
Result<Input> load_input(const std::string& name, ByteView bytes,
                         const formats::ReadOptions& options);

/// The error for a page file.
Error page_file_error();

/// A document that is read feature by feature; Watertight files and blobs are read whole.
struct OpenedInput {
  formats::FeatureReader reader;
  std::optional<std::uint64_t> bytes;  // the size of the file, if it has one
};

/// A file of which only the kind is known. A compressed one is expanded while it is read.
struct FoundInput {
  InputKind kind = InputKind::document;
  ByteSource source;                   // all bytes, expanded
  std::optional<std::uint64_t> bytes;  // their number, if it is known
  std::string name;  // decides on the format: without the ending of a compression; "" for "-"
};

/// Finds the kind of an opened input. Errors: those of its source; unsupported for an archive in an
/// archive, a tar archive, and a zip of several documents that is no file.
Result<FoundInput> find_input(OpenedFile file, const std::string& name);

/// Opens an input. Errors: unavailable with the reason; those of find_input() and of the readers.
Result<OpenedInput> open_input(const InputFile& input, const formats::ReadOptions& options);
/// `lone_header` is for a CityJSONFeature alone, as in FeatureReader::open().
Result<OpenedInput> open_input(FoundInput input, const formats::ReadOptions& options,
                               const formats::FeatureReader::HeaderFinder& lone_header = {});

/// An input with all its bytes.
struct WholeInput {
  std::string name;  // as FoundInput::name
  Bytes bytes;       // expanded
};
/// Reads an input whole. Errors: those of find_input(); limit_exceeded.
Result<WholeInput> read_whole(const InputFile& input, const Limits& limits);

/// The format that an output file's name asks for. Errors: unsupported naming the known endings.
Result<Format> format_of_name(const std::string& path);

}  // namespace watertight::files
