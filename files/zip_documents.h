// SPDX-License-Identifier: GPL-3.0-or-later
//
// The documents in a zip archive, as inputs.
#pragma once

#include <string>
#include <vector>

#include "files/files.h"

namespace watertight::files {

/// Whether a file is a zip archive, by its first bytes. False for one that cannot be read.
bool is_zip(const std::string& path);

/// The documents of an archive: its members with a known ending, or its only member whatever the
/// name; in byte order of their names.
struct ZipDocuments {
  std::vector<InputFile> inputs;
  std::size_t skipped = 0;  // members that are no documents
};

/// The documents of the archive in a file. `name` stands for the file in messages. Errors:
/// unavailable; those of archives::zip_members().
Result<ZipDocuments> documents_of_zip(const std::string& path, const std::string& name);

/// The only document of an archive that is read from a pipe, and so whole. Errors: those of the
/// source and of documents_of_zip(); unsupported if there are several.
Result<InputFile> only_member(const ByteSource& source);

}  // namespace watertight::files
