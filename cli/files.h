// SPDX-License-Identifier: GPL-3.0-or-later
//
// Files of the command line: read whole, written atomically; "-" is standard input or output.
#pragma once

#include <string>

#include "pipeline/pipeline.h"

namespace watertight {

/// Errors: unavailable naming the file and the system's reason; limit_exceeded.
Result<Bytes> read_file(const std::string& path, const Limits& limits);

/// Writes beside the target and renames, so that nobody sees half a file and a failure leaves the
/// old one. Errors: unavailable naming the file and the reason.
Status write_file(const std::string& path, ByteView bytes);

/// What an input file was.
enum class InputKind : std::uint8_t { document, container, blob };

struct Input {
  InputKind kind = InputKind::document;
  Document document;
};

/// Reads a document of any format, a Watertight file or a bare blob, told apart by content and
/// name. Errors: those of the readers.
Result<Input> load_input(const std::string& path, ByteView bytes, const ReadOptions& options);

/// The format that an output file's name asks for. Errors: unsupported naming the known endings.
Result<Format> format_of_name(const std::string& path);

}  // namespace watertight
