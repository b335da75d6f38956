// SPDX-License-Identifier: GPL-3.0-or-later
//
// The endings of the names of files.
#pragma once

#include <string>
#include <string_view>

namespace watertight::files {

/// Whether the ending of a name is that of a document, a Watertight file, or one of these
/// compressed by gzip or Zstandard.
bool is_document_name(std::string_view name);

/// A name without an ending that says that the file is compressed: ".gz", ".zst", ...; "a.tar" for
/// "a.tgz".
std::string name_without_compression(std::string_view name);

}  // namespace watertight::files
