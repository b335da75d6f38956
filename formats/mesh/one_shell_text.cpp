// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/mesh/one_shell_text.h"

#include <utility>

namespace watertight::formats {

OneShellText::OneShellText(Format format, std::string_view text, const Limits& limits)
    : lines_(text), limits_(limits), size_(text.size()) {
  document_.format = format;
}

Error OneShellText::wrong(std::size_t word, std::string message) const {
  return error_at(lines_.line(), lines_.words()[word], std::move(message));
}

Result<std::uint64_t> OneShellText::count(std::size_t word, const std::string& what,
                                          std::uint64_t most) const {
  if (word >= lines_.words().size()) return wrong(0, "the number of " + what + " is missing");
  const auto value = unsigned_word(lines_.words()[word]);
  if (!value) return wrong(word, "not a number of " + what);
  if (*value > size_) return wrong(word, "more " + what + " than the file has bytes");
  if (*value > most) {
    return Error{ErrorCode::limit_exceeded,
                 std::to_string(*value) + ' ' + what + "; the limit is " + std::to_string(most),
                 lines_.line().offset};
  }
  return *value;
}

Result<Document> OneShellText::finish(std::string geometry_type) {
  return one_shell_document(std::move(document_), std::move(geometry_type), std::move(arrays_),
                            vertices_, limits_);
}

}  // namespace watertight::formats
