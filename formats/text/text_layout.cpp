// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/text/text_layout.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "base/checksum.h"

namespace watertight::formats {
namespace {

/// Layouts of the form `long_tokens`, with a size and 64 bits of the hash, were stored before.
enum class Kind : std::uint8_t { long_tokens = 0, whole_text = 1, tokens = 2 };

/// The bytes between tokens: white space, those of a byte order mark, and the record separator.
constexpr std::string_view kBlanks = " \t\r\n\xEF\xBB\xBF\x1E";
constexpr std::string_view kMarks = "{}[]:,";
constexpr std::string_view kLineFeed = "\n";

constexpr std::array<bool, 256> table_of(std::string_view set) {
  std::array<bool, 256> table{};
  for (const char c : set) table[static_cast<unsigned char>(c)] = true;
  return table;
}
constexpr auto kIsBlank = table_of(kBlanks);
constexpr auto kIsMark = table_of(kMarks);
constexpr auto kEndsWord = table_of(" \t\r\n{}[]:,\"");

bool is_in(const std::array<bool, 256>& set, char c) { return set[static_cast<unsigned char>(c)]; }

/// One token and the bytes before it; the token is empty at the end of the text.
struct Token {
  std::string_view gap;
  std::string_view text;
};

/// Cuts a text into tokens. A text that is not JSON gives arbitrary tokens.
class Tokens {
 public:
  explicit Tokens(std::string_view text) : rest_(text) {}

  Token next() {
    std::size_t start = 0;
    while (start < rest_.size() && is_in(kIsBlank, rest_[start])) ++start;
    Token token{rest_.substr(0, start), {}};
    rest_.remove_prefix(start);
    token.text = rest_.substr(0, length());
    rest_.remove_prefix(token.text.size());
    return token;
  }

 private:
  std::size_t length() const {
    if (rest_.empty()) return 0;
    if (is_in(kIsMark, rest_[0])) return 1;
    std::size_t end = 1;
    if (rest_[0] != '"') {
      while (end < rest_.size() && !is_in(kEndsWord, rest_[end])) ++end;
      return end;
    }
    while (end < rest_.size() && rest_[end] != '"') end += rest_[end] == '\\' ? 2 : 1;
    return std::min(end + 1, rest_.size());
  }
  std::string_view rest_;
};

bool is_number(std::string_view token) {
  return !token.empty() && (token[0] == '-' || (token[0] >= '0' && token[0] <= '9'));
}

/// The number of digits after the point.
std::size_t decimals_of(std::string_view number) {
  const std::size_t point = number.find('.');
  return point == std::string_view::npos ? 0 : number.size() - point - 1;
}

void append_with_decimals(std::string& out, std::string_view number, std::size_t decimals) {
  out += number;
  if (decimals == 0) return;
  const std::size_t present = decimals_of(number);
  if (present >= decimals || number.find_first_of("eE") != std::string_view::npos) return;
  if (present == 0) out += '.';
  out.append(decimals - present, '0');
}

/// The characters that a writer escapes though JSON does not ask for it.
struct Escapes {
  bool non_ascii = false;
  bool slashes = false;
};

void append_escape(std::string& out, std::uint32_t unit) {
  static constexpr std::string_view kHex = "0123456789abcdef";
  out += "\\u";
  for (int shift = 12; shift >= 0; shift -= 4) out += kHex[(unit >> shift) & 15U];
}

/// The code point of the character that starts at `at`, which moves to the character's last byte.
/// Requires UTF-8; the number for other bytes is arbitrary.
std::uint32_t code_point(std::string_view text, std::size_t& at) {
  const auto first = static_cast<unsigned char>(text[at]);
  const std::size_t more = first >= 0xF0 ? 3 : first >= 0xE0 ? 2 : 1;
  std::uint32_t value = first & (0x3FU >> more);
  for (std::size_t i = 0; i < more && at + 1 < text.size(); ++i) {
    value = (value << 6U) | (static_cast<unsigned char>(text[++at]) & 0x3FU);
  }
  return value;
}

void append_with_escapes(std::string& out, std::string_view token, Escapes escapes) {
  for (std::size_t i = 0; i < token.size(); ++i) {
    const auto byte = static_cast<unsigned char>(token[i]);
    if (escapes.slashes && byte == '/') {
      out += "\\/";
    } else if (escapes.non_ascii && byte >= 0x80) {
      const std::uint32_t value = code_point(token, i);
      if (value >= 0x10000) append_escape(out, 0xD800 + ((value - 0x10000) >> 10U));
      append_escape(out, value >= 0x10000 ? 0xDC00 + ((value - 0x10000) & 0x3FFU) : value);
    } else {
      out += token[i];
    }
  }
}

/// Predicts the next gap and the next spelling. describe_layout() and apply_layout() teach it in
/// the same way.
class Predictor {
 public:
  Predictor() : gaps_(kKinds * kKinds * (kDepths + 1)) {}

  /// Moves to the gap before `token`; gap() is then its likely text.
  void move_to(std::string_view token) {
    const std::size_t kind = kind_of(token);
    if (kind == kind_of("}") || kind == kind_of("]")) depth_ = depth_ > 0 ? depth_ - 1 : 0;
    const std::size_t pair = (last_kind_ * kKinds + kind) * (kDepths + 1);
    at_depth_ = pair + std::min(depth_, kDepths - 1);
    at_any_depth_ = pair + kDepths;
    if (kind == kind_of("{") || kind == kind_of("[")) ++depth_;
    last_kind_ = kind;
  }
  std::string_view gap() const {
    const Place& place = gaps_[at_depth_];
    return place.is_known ? place.text : gaps_[at_any_depth_].text;
  }
  void learn_gap(std::string_view gap) {
    gaps_[at_depth_] = gaps_[at_any_depth_] = Place{true, gap};
  }

  /// True if the likely spelling of a token is certainly the token itself.
  bool keeps(std::string_view token) const {
    if (is_number(token)) return decimals_[place()] == 0;
    return !token.starts_with('"') || (!escapes_.non_ascii && !escapes_.slashes);
  }
  void append_spelling(std::string& out, std::string_view token) const {
    if (is_number(token)) {
      append_with_decimals(out, token, decimals_[place()]);
    } else if (token.starts_with('"') && (escapes_.non_ascii || escapes_.slashes)) {
      append_with_escapes(out, token, escapes_);
    } else {
      out += token;
    }
  }
  /// Learns that `text`, which was not predicted, stands for `token` of the plain text.
  void learn_spelling(std::string_view token, std::string_view text) {
    if (is_number(token)) {
      if (text.starts_with(token)) decimals_[place()] = decimals_of(text);
      return;
    }
    for (const Escapes escapes :
         {Escapes{false, false}, Escapes{true, false}, Escapes{false, true}, Escapes{true, true}}) {
      std::string spelling;
      append_with_escapes(spelling, token, escapes);
      if (spelling == text) {
        escapes_ = escapes;
        return;
      }
    }
  }

 private:
  static constexpr std::size_t kKinds = 8;    // the marks, a value, start or end of the text
  static constexpr std::size_t kDepths = 32;  // all greater depths count as one
  struct Place {
    bool is_known = false;
    std::string_view text;
  };

  static constexpr std::array<std::uint8_t, 256> kKindOfByte = [] {
    std::array<std::uint8_t, 256> kinds{};
    kinds.fill(static_cast<std::uint8_t>(kMarks.size()));
    for (std::size_t i = 0; i < kMarks.size(); ++i) {
      kinds[static_cast<unsigned char>(kMarks[i])] = static_cast<std::uint8_t>(i);
    }
    return kinds;
  }();
  static std::size_t kind_of(std::string_view token) {
    if (token.empty()) return kMarks.size() + 1;
    return kKindOfByte[static_cast<unsigned char>(token[0])];
  }
  std::size_t place() const { return std::min(depth_, kDepths - 1); }

  std::vector<Place> gaps_;
  std::array<std::size_t, kDepths> decimals_{};
  Escapes escapes_;
  std::size_t last_kind_ = kMarks.size() + 1;
  std::size_t depth_ = 0;
  std::size_t at_depth_ = 0;
  std::size_t at_any_depth_ = 0;
};

bool is_mark(std::string_view token) { return !token.empty() && is_in(kIsMark, token[0]); }

/// Writes the exceptions in gaps and spellings; false when the texts have other tokens.
bool describe_tokens(std::string_view plain, std::string_view text, ExceptionWriter& gaps,
                     ExceptionWriter& spellings) {
  Tokens plain_tokens(plain);
  Tokens text_tokens(text);
  Predictor predictor;
  std::string spelling;
  for (;;) {
    const std::string_view ours = plain_tokens.next().text;
    const Token token = text_tokens.next();
    if ((is_mark(ours) || is_mark(token.text) || ours.empty() || token.text.empty()) &&
        ours != token.text) {
      return false;
    }
    predictor.move_to(ours);
    if (predictor.gap() == token.gap) {
      gaps.expected();
    } else {
      gaps.exception(token.gap);
      predictor.learn_gap(token.gap);
    }
    if (ours.empty()) return true;
    if (is_mark(ours)) continue;
    spelling.clear();
    predictor.append_spelling(spelling, ours);
    if (spelling == token.text) {
      spellings.expected();
    } else {
      spellings.exception(token.text);
      predictor.learn_spelling(ours, token.text);
    }
  }
}

/// False only if no byte of a gap stands outside the strings of a text. Such a text without
/// exceptions is the text itself.
bool may_have_gaps(std::string_view text) {
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (is_in(kIsBlank, text[at])) return true;
    if (text[at] != '"') continue;
    for (++at; at < text.size() && text[at] != '"'; ++at) at += text[at] == '\\' ? 1 : 0;
  }
  return false;
}

Error does_not_fit() { return Error{ErrorCode::malformed, "layout and document do not fit"}; }

/// The text of a layout of tokens. Errors: malformed; `too_long` beyond `size` bytes.
Result<std::string> apply_to_tokens(std::string_view plain, ByteReader& reader, std::uint64_t size,
                                    const Error& too_long) {
  const std::uint64_t gap_bytes = reader.varint();
  if (reader.failed() || gap_bytes > reader.remaining()) return does_not_fit();
  ExceptionReader gaps(reader.take(static_cast<std::size_t>(gap_bytes)));
  ExceptionReader spellings(reader.take(reader.remaining()));
  if (gaps.is_finished() && spellings.is_finished() && !may_have_gaps(plain)) {
    return plain.size() > size ? Result<std::string>(too_long) : std::string(plain);
  }
  Tokens tokens(plain);
  Predictor predictor;
  std::string text;
  text.reserve(std::min<std::uint64_t>(size, 2 * plain.size()));
  // Tokens that stand in `plain` one after the other as they are to be written, which is so for
  // nearly all of a compact text; they are copied together.
  std::string_view run;
  const auto end_run = [&] { text += std::exchange(run, {}); };
  for (;;) {
    const std::string_view token = tokens.next().text;
    predictor.move_to(token);
    std::string_view other;
    if (gaps.next(other)) predictor.learn_gap(other);
    const std::string_view gap = predictor.gap();
    if (gap.size() > size - text.size() - run.size()) return too_long;
    if (!gap.empty()) {
      end_run();
      text += gap;
    }
    if (token.empty()) break;
    if (!is_mark(token) && spellings.next(other)) {
      predictor.learn_spelling(token, other);
      end_run();
      text += other;
    } else if (!is_mark(token) && !predictor.keeps(token)) {
      end_run();
      predictor.append_spelling(text, token);
    } else if (!run.empty() && run.data() + run.size() == token.data()) {
      run = {run.data(), run.size() + token.size()};
    } else {
      end_run();
      run = token;
    }
    if (text.size() + run.size() > size) return too_long;
  }
  end_run();
  if (!gaps.is_finished() || !spellings.is_finished()) return does_not_fit();
  return text;
}

}  // namespace

void ExceptionWriter::exception(std::string_view text) {
  writer_.varint(run_);
  writer_.varint(text.size());
  writer_.append(as_bytes(text));
  run_ = 0;
}

void ExceptionReader::start_run() {
  is_last_run_ = reader_.remaining() == 0;
  if (!is_last_run_) run_ = reader_.varint();
}

bool ExceptionReader::next(std::string_view& text) {
  if (is_last_run_ || reader_.failed()) return false;
  if (run_ > 0) {
    --run_;
    return false;
  }
  const std::uint64_t size = reader_.varint();
  if (size > reader_.remaining()) {
    reader_.take(reader_.remaining() + 1);  // makes the reader fail
    return false;
  }
  text = as_text(reader_.take(static_cast<std::size_t>(size)));
  start_run();
  return !reader_.failed();
}

void FramingWriter::gap(std::string_view text, bool is_last) {
  const std::string_view likely = is_last ? kLineFeed : std::string_view(likely_);
  if (text == likely) {
    gaps_.expected();
  } else {
    gaps_.exception(text);
  }
  likely_ = is_first_ ? kLineFeed : text;
  is_first_ = false;
}

std::string_view FramingReader::next_gap(bool is_last) {
  std::string_view text = is_last ? kLineFeed : likely_;
  gaps_.next(text);
  likely_ = is_first_ ? kLineFeed : text;
  is_first_ = false;
  return text;
}

bool holds_whole_text(ByteView layout) {
  return !layout.empty() && layout[0] == static_cast<std::uint8_t>(Kind::whole_text);
}

Bytes describe_layout(std::string_view plain, std::string_view text) {
  ExceptionWriter gaps;
  ExceptionWriter spellings;
  const bool has_same_tokens = describe_tokens(plain, text, gaps, spellings);
  const std::uint64_t hash = content_hash(as_bytes(text));
  ByteWriter writer;
  writer.u8(static_cast<std::uint8_t>(has_same_tokens ? Kind::tokens : Kind::whole_text));
  if (!has_same_tokens) {
    writer.u64(hash);
    writer.varint(text.size());
    writer.append(as_bytes(text));
    return std::move(writer).bytes();
  }
  writer.u16(static_cast<std::uint16_t>(hash));
  const Bytes gap_bytes = std::move(gaps).finish();
  writer.varint(gap_bytes.size());
  writer.append(gap_bytes);
  writer.append(std::move(spellings).finish());
  return std::move(writer).bytes();
}

namespace {

Error too_long(std::uint64_t most_bytes) {
  return Error{ErrorCode::limit_exceeded,
               "a document of more than " + std::to_string(most_bytes) + " bytes"};
}

Error another_text() {
  return Error{ErrorCode::malformed,
               "the document is not the one that was stored: its hash differs"};
}

}  // namespace

Result<std::string> apply_layout(std::string_view plain, ByteView layout,
                                 std::uint64_t most_bytes) {
  ByteReader reader(layout);
  const std::uint8_t kind = reader.u8();
  if (kind == static_cast<std::uint8_t>(Kind::tokens)) {
    const std::uint16_t hash = reader.u16();
    auto text = apply_to_tokens(plain, reader, most_bytes, too_long(most_bytes));
    if (!text) return text;
    if (static_cast<std::uint16_t>(content_hash(as_bytes(*text))) != hash) return another_text();
    return text;
  }
  const std::uint64_t hash = reader.u64();
  const std::uint64_t size = reader.varint();
  if (reader.failed() || kind > static_cast<std::uint8_t>(Kind::whole_text)) return does_not_fit();
  if (size > most_bytes) return too_long(most_bytes);
  auto text = static_cast<Kind>(kind) == Kind::whole_text
                  ? Result<std::string>(std::string(as_text(reader.take(reader.remaining()))))
                  : apply_to_tokens(plain, reader, size, does_not_fit());
  if (!text) return text;
  if (text->size() != size || content_hash(as_bytes(*text)) != hash) return another_text();
  return text;
}

}  // namespace watertight::formats
