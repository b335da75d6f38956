// SPDX-License-Identifier: GPL-3.0-or-later
//
// The common part of the readers of OFF and POLY: texts that state how many elements follow, and
// hold one shell. Internal to formats/.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "formats/mesh/mesh_text.h"
#include "formats/surface.h"

namespace watertight::formats {

class OneShellText {
 protected:
  OneShellText(Format format, std::string_view text, const Limits& limits);

  /// The error malformed, at word number `word` of the line.
  Error wrong(std::size_t word, std::string message) const;
  /// Reads word number `word` of the line as the number of `what`, each of which takes at least a
  /// byte. Errors: malformed; limit_exceeded above `most`.
  Result<std::uint64_t> count(std::size_t word, const std::string& what,
                              std::uint64_t most = ~0ULL) const;
  /// The document of all that was read.
  Result<Document> finish(std::string geometry_type);

  TextLines lines_;
  const Limits& limits_;
  DecimalVertices vertices_;
  SolidArrays arrays_;
  Document document_;  // format and notes of the document

 private:
  std::size_t size_;  // the size of the file in bytes
};

}  // namespace watertight::formats
