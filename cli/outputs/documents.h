// SPDX-License-Identifier: GPL-3.0-or-later
//
// Documents as files of a command's output.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "cli/summary.h"
#include "formats/document.h"

namespace watertight::cli {

/// Writes each document to a file of its own, OUT, OUT-2, ..., in the format of its ending; writes
/// none if one cannot be converted or written (if a rename fails in the end, the files before it
/// stay). Standard output gets `standard`, without it the format of the document. The documents
/// were read from `input`, which the message about a failed conversion names.
Exit save_documents(std::span<const Document> documents, const std::string& input,
                    const std::string& output, std::optional<Format> standard = {});

/// Writes one document to a file in the format of its ending. Errors: those of writing and of
/// converting; invalid_argument for an ending of no format.
Status save_document(const Document& document, const std::string& output);

}  // namespace watertight::cli
