// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/mesh/ply_header.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "formats/mesh/mesh_text.h"

namespace watertight::formats {
namespace {

struct NamedType {
  std::string_view name;
  PlyType type;
};
constexpr std::array kTypes{
    NamedType{"char", PlyType::int8},      NamedType{"int8", PlyType::int8},
    NamedType{"uchar", PlyType::uint8},    NamedType{"uint8", PlyType::uint8},
    NamedType{"short", PlyType::int16},    NamedType{"int16", PlyType::int16},
    NamedType{"ushort", PlyType::uint16},  NamedType{"uint16", PlyType::uint16},
    NamedType{"int", PlyType::int32},      NamedType{"int32", PlyType::int32},
    NamedType{"uint", PlyType::uint32},    NamedType{"uint32", PlyType::uint32},
    NamedType{"float", PlyType::float32},  NamedType{"float32", PlyType::float32},
    NamedType{"double", PlyType::float64}, NamedType{"float64", PlyType::float64},
};

std::optional<PlyType> type_named(std::string_view name) {
  const auto* found = std::find_if(kTypes.begin(), kTypes.end(),
                                   [name](const NamedType& type) { return type.name == name; });
  if (found == kTypes.end()) return std::nullopt;
  return found->type;
}

class HeaderReader {
 public:
  explicit HeaderReader(std::string_view text) : text_(text) {}

  Result<PlyHeader> read() {
    if (!next_line() || words_.size() != 1 || words_[0] != "ply") {
      return Error{ErrorCode::malformed, "the first line is not 'ply'", 0};
    }
    bool has_format = false;
    while (next_line()) {
      if (words_.empty() || words_[0] == "comment" || words_[0] == "obj_info") continue;
      if (words_[0] == "end_header") {
        if (!has_format) return wrong(0, "the header states no format");
        header_.data_begin = at_;
        return std::move(header_);
      }
      if (words_[0] == "format") has_format = true;
      if (auto status = statement(); !status) return status.error();
    }
    return Error{ErrorCode::malformed, "the file ends before 'end_header'", text_.size()};
  }

 private:
  bool next_line() {
    if (at_ >= text_.size()) return false;
    const std::size_t end = text_.find('\n', at_);
    if (end == std::string_view::npos) return false;
    line_ = {text_.substr(at_, end - at_), at_, line_.number + 1};
    at_ = end + 1;
    words_of(line_.text, words_);
    return true;
  }

  Error wrong(std::size_t word, std::string message) const {
    return error_at(line_, words_[word], std::move(message));
  }

  Status statement() {
    if (words_[0] == "format") return format();
    if (words_[0] == "element") return element();
    if (words_[0] == "property") return property();
    return wrong(0, "not a statement of a PLY header");
  }

  Status format() {
    constexpr std::array<std::string_view, 3> kEncodings{"ascii", "binary_little_endian",
                                                         "binary_big_endian"};
    if (words_.size() != 3) return wrong(0, "a format needs an encoding and a version");
    const auto* found = std::find(kEncodings.begin(), kEncodings.end(), words_[1]);
    if (found == kEncodings.end() || words_[2] != "1.0") {
      return Error{ErrorCode::unsupported,
                   "only ascii, binary_little_endian and binary_big_endian 1.0 are read",
                   line_.offset};
    }
    header_.encoding = static_cast<PlyEncoding>(found - kEncodings.begin());
    return Done{};
  }

  Status element() {
    if (words_.size() != 3) return wrong(0, "an element needs a name and a number");
    const auto count = unsigned_word(words_[2]);
    if (!count) return wrong(2, "not a number of elements");
    for (const PlyElement& other : header_.elements) {
      if (other.name == words_[1]) return wrong(1, "the element occurs twice");
    }
    header_.elements.push_back({std::string(words_[1]), *count, {}, line_.offset});
    return Done{};
  }

  Status property() {
    if (header_.elements.empty()) return wrong(0, "a property without element");
    const bool is_list = words_.size() > 1 && words_[1] == "list";
    if (words_.size() != (is_list ? 5U : 3U)) {
      return wrong(0, "a property needs its types and a name");
    }
    PlyProperty property;
    const std::size_t type_word = is_list ? 3 : 1;
    const auto type = type_named(words_[type_word]);
    if (!type) return wrong(type_word, "not a type of PLY");
    property.type = *type;
    if (is_list) {
      const auto length = type_named(words_[2]);
      if (!length || !is_integer(*length)) return wrong(2, "not an integer type of PLY");
      property.list_length = *length;
    }
    property.name = words_.back();
    header_.elements.back().properties.push_back(std::move(property));
    return Done{};
  }

  std::string_view text_;
  std::size_t at_ = 0;
  TextLine line_;
  std::vector<std::string_view> words_;
  PlyHeader header_;
};

}  // namespace

std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
      return 1;
    case PlyType::int16:
    case PlyType::uint16:
      return 2;
    case PlyType::int32:
    case PlyType::uint32:
    case PlyType::float32:
      return 4;
    case PlyType::float64:
      break;
  }
  return 8;
}

bool is_integer(PlyType type) { return type != PlyType::float32 && type != PlyType::float64; }

std::optional<std::size_t> PlyElement::property(std::string_view name_to_find) const {
  for (std::size_t i = 0; i < properties.size(); ++i) {
    if (properties[i].name == name_to_find) return i;
  }
  return std::nullopt;
}

Result<PlyHeader> read_ply_header(ByteView bytes) { return HeaderReader(as_text(bytes)).read(); }

}  // namespace watertight::formats
