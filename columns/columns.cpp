// SPDX-License-Identifier: GPL-3.0-or-later
#include "columns/columns.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <optional>
#include <type_traits>
#include <utility>

#include "columns/mark_coder.h"
#include "columns/models/context_mixer.h"
#include "columns/models/number_form.h"
#include "columns/models/string_coder.h"
#include "columns/paths/json_path.h"
#include "columns/paths/json_tokens.h"
#include "columns/paths/table_path.h"
#include "columns/paths/xml_path.h"
#include "columns/paths/xml_tokens.h"
#include "columns/plain_texts.h"
#include "columns/rings/position_coder.h"
#include "columns/rings/ring_coder.h"
#include "columns/rings/vertex_coder.h"
#include "columns/value_coder.h"

namespace watertight::columns {

// The files of columns/models/ (watertight_embed).
extern const ByteView kJsonExample;
extern const ByteView kXmlExample;

namespace {

constexpr int kTextKindBits = 2;
constexpr std::size_t kJsonExamples = 4;  // the first of examples()
constexpr Hash kBytesColumn = 0x42595445;

/// A whole number as it is written: without point, sign or zeros in front.
std::optional<std::int64_t> whole_number(std::string_view text) {
  return number_in(NumberForm{NumberForm::Kind::short_trimmed, 0}, text);
}

/// Texts with the words of the formats (docs/format-columns.md, "Examples"), from which every coder
/// learns first: so small texts take few bytes too.
std::vector<Text> examples() {
  std::vector<Text> texts;
  std::string_view lines = as_text(kJsonExample);
  for (std::size_t end = lines.find('\n'); end != std::string_view::npos; end = lines.find('\n')) {
    texts.push_back({TextKind::json, lines.substr(0, end)});
    lines.remove_prefix(end + 1);
  }
  texts.push_back({TextKind::xml, as_text(kXmlExample)});
  texts.push_back({TextKind::table, "documents\n1\t0\ncity-json\ngml\ncity-json-seq\n"});
  texts.push_back({TextKind::table,
                   "features\n0\texample-1\tBuilding\t7415\t0\t0\t1\t2\n"
                   "0\texample-2\tBuilding\t7415\t0\t0\t1\t1\n0\t\tCityJSON\t0\t0\t0\t1\t1\n"});
  texts.push_back({TextKind::table,
                   "solids\nexample-1\t1.2\t0\t0\t0\t\nexample-1\t2.2\t1\t0\t0\t\n"
                   "example-2\t2\t0\t0\t0\t\nexample-2\t2\t0\t0\t1\t302\n"});
  return texts;
}

/// Writes texts to a stream, or reads them from it.
class TextCoder {
 public:
  /// A coder that has learned from the examples of the format. Cost: a copy of some megabytes.
  static TextCoder after_examples() {
    static const TextCoder kCoder = [] {
      TextCoder coder(kLarge);
      coder.learn(examples(), 1, 8);
      return coder;
    }();
    return kCoder;
  }
  /// A coder for single texts, which has learned from the JSON examples of the format.
  static TextCoder for_single_texts() {
    static const TextCoder kCoder = [] {
      TextCoder coder(kSmall);
      const std::vector<Text> all = examples();
      coder.learn(std::span(all).first(kJsonExamples), 1, 8);
      return coder;
    }();
    return kCoder;
  }
  /// A coder that has learned nothing. For tests.
  static TextCoder unlearned(bool is_for_single_texts) {
    return TextCoder(is_for_single_texts ? kSmall : kLarge);
  }

  /// Codes one text and returns it. The stream fails when all texts that are read have more bytes
  /// than allow().
  std::string code(EntropyStream& stream, const Text& text) {
    stream_ = &stream;
    return code_text(text);
  }
  /// Learns from texts by reading them: so what it knows does not depend on who wrote them.
  void learn_packed(EntropyStream& stream, std::uint64_t count) {
    for (std::uint64_t i = 0; i < count && !stream.failed(); ++i) code(stream, {});
    end_learning(8, 64);
    values_.make_indexes();
  }
  /// Makes this copy of a coder that has not changed since equal to it again: cheaper than another
  /// copy, which has some megabytes.
  void revert(const TextCoder& original) {
    stream_ = nullptr;
    left_ = original.left_;
    is_over_limit_ = original.is_over_limit_;
    mixer_.revert(original.mixer_);
    json_path_ = original.json_path_;
    xml_path_ = original.xml_path_;
    table_path_ = original.table_path_;
    marks_.revert(original.marks_);
    strings_.revert(original.strings_);
    values_.revert(original.values_);
    rings_ = original.rings_;
    vertices_ = original.vertices_;
    positions_ = original.positions_;
    last_value_ = original.last_value_;
    last_text_ = original.last_text_;
  }
  void allow(std::uint64_t most_bytes) { left_ = most_bytes; }
  bool is_over_limit() const { return is_over_limit_ || strings_.is_over_limit(); }

 private:
  /// The sizes of its tables.
  struct Sizes {
    int counter_bits;
    int slot_bits;
  };
  static constexpr Sizes kLarge{18, 16};
  static constexpr Sizes kSmall{17, 14};  // so that it is copied in a moment
  explicit TextCoder(const Sizes& sizes)
      : mixer_(sizes.counter_bits), marks_(sizes.slot_bits), values_(sizes.slot_bits) {}

  /// Learns from texts; what was learned counts as so few answers and decisions then.
  void learn(std::span<const Text> texts, std::uint32_t most_answers, std::uint32_t most_mixed) {
    auto measured = EntropyStream::meter();
    for (const Text& text : texts) code(measured, text);
    end_learning(most_answers, most_mixed);
  }
  void end_learning(std::uint32_t most_answers, std::uint32_t most_mixed) {
    mixer_.soften(most_answers, most_mixed);
    restart();
    json_path_.restart();
    xml_path_.restart();
  }
  void restart() {
    marks_.restart();
    values_.restart();
    rings_.restart();
    vertices_.restart(0);
    last_value_ = 0;
  }

  std::string code_text(const Text& text) {
    const auto kind = static_cast<TextKind>(mixer_.symbol(
        *stream_, Question::text_kind, {1}, kTextKindBits, static_cast<std::uint32_t>(text.kind)));
    switch (kind) {
      case TextKind::bytes:
        return code_bytes(text.text);
      case TextKind::json:
        return code_tokens<JsonPath, JsonTokens>(json_path_, text.text);
      case TextKind::table:
        return code_tokens<TablePath, TableTokens>(table_path_, text.text);
      case TextKind::xml:
        return code_tokens<XmlPath, XmlTokens>(xml_path_, text.text);
    }
    stream_->fail();
    return {};
  }

  std::size_t most_bytes() const {
    return static_cast<std::size_t>(
        std::min<std::uint64_t>(left_, std::numeric_limits<std::size_t>::max()));
  }
  /// Appends to a text that is read.
  void append(std::string& out, std::string_view more) {
    if (!stream_->is_reading() || stream_->failed()) return;
    if (more.size() > left_) {
      is_over_limit_ = true;
      stream_->fail();
      return;
    }
    left_ -= more.size();
    out += more;
  }

  std::string code_bytes(std::string_view text) {
    Place place;
    place.column = kBytesColumn;
    std::string out;
    append(out, values_.code(*stream_, mixer_, strings_, place, text, most_bytes()));
    return out;
  }

  template <class Path, class Tokens>
  std::string code_tokens(Path& path, std::string_view text) {
    Tokens tokens(text);
    path.restart();
    restart();
    std::string out;
    while (!stream_->failed()) {
      const bool is_reading = stream_->is_reading();
      const std::size_t size = out.size();
      const Mark mark = marks_.code(*stream_, mixer_, strings_, path.place(), last_value_,
                                    is_reading ? Mark{} : tokens.next_mark(), most_bytes());
      append(out, mark.text);
      if (mark.is_last) break;
      path.follow(mark.text);
      const std::string_view value =
          code_value(path.place(), is_reading ? std::string_view() : tokens.next_value());
      append(out, value);
      if constexpr (std::is_same_v<Path, XmlPath>) path.follow_value(value);
      // A mark and its value are never both empty, so time is bounded by the bytes that are made.
      if (is_reading && out.size() == size) stream_->fail();
    }
    return out;
  }

  std::string_view code_value(const Place& place, std::string_view text) {
    if (place.role == Role::vertex_index && place.is_in_array) {
      if (const auto coded = code_vertex_index(place, text)) return *coded;
    }
    if (place.role == Role::coordinate && vertices_.is_ready()) {
      if (auto coded = vertices_.code(*stream_, mixer_, rings_, text))
        return keep(*std::move(coded));
    }
    if (place.role == Role::position) {
      if (auto coded = positions_.code(*stream_, mixer_, place, text)) {
        values_.pass(std::nullopt);
        last_value_ = 0;
        return keep(*std::move(coded));
      }
    }
    const std::string_view value =
        values_.code(*stream_, mixer_, strings_, place, text, most_bytes());
    last_value_ = values_.last();
    if (place.role == Role::vertex_count) {
      vertices_.restart(static_cast<std::uint64_t>(whole_number(value).value_or(0)));
    }
    if (place.role == Role::vertex_run) vertices_.take_run(whole_number(value).value_or(-1));
    return value;
  }

  /// None for a value that is no index of a vertex.
  std::optional<std::string_view> code_vertex_index(const Place& place, std::string_view text) {
    auto vertex = stream_->is_reading() ? std::nullopt : whole_number(text);
    if (vertex && (*vertex < 0 || *vertex >= kMostVertexNumbers)) vertex.reset();
    const auto coded = rings_.code(*stream_, mixer_, place.index, vertex);
    if (!coded) return std::nullopt;
    values_.pass(*coded);
    last_value_ = 0;
    return keep(std::to_string(*coded));
  }

  std::string_view keep(std::string text) {
    last_text_ = std::move(text);
    return last_text_;
  }

  EntropyStream* stream_ = nullptr;
  std::uint64_t left_ = ~std::uint64_t{0};
  bool is_over_limit_ = false;
  ContextMixer mixer_;
  JsonPath json_path_;
  XmlPath xml_path_;
  TablePath table_path_;
  MarkCoder marks_;
  StringCoder strings_;
  ValueCoder values_;
  RingCoder rings_;
  VertexCoder vertices_;
  PositionCoder positions_;
  Hash last_value_ = 0;
  std::string last_text_;
};

// The head of packed texts is so many times their count, and their form.
constexpr std::uint64_t kForms = 4;
constexpr std::uint64_t kByColumn = 0;
constexpr std::uint64_t kPlain = 1;

// So many texts may be packed, and so many more for each byte: a text without bytes takes memory
// too.
constexpr std::uint64_t kFewTexts = std::uint64_t{1} << 18U;
constexpr std::uint64_t kMostTextsForAByte = 16;
bool is_too_many(std::uint64_t texts, ByteView bytes) {
  return texts > kFewTexts + kMostTextsForAByte * bytes.size();
}
constexpr std::size_t kLongText = std::size_t{1} << 20U;

Error over_limit(std::uint64_t most_bytes) {
  return {ErrorCode::limit_exceeded,
          "packed texts of more than " + std::to_string(most_bytes) + " bytes"};
}

Error damaged(const EntropyStream& stream) {
  return {ErrorCode::malformed, "packed texts that are damaged", stream.position(), {}};
}

}  // namespace

Error unknown_form(std::uint64_t form) {
  return {ErrorCode::unsupported, std::string("texts of form ")
                                      .append(std::to_string(form))
                                      .append(" are not known: a newer program wrote them")};
}

Bytes packed_examples(bool are_for_single_texts) {
  auto stream = EntropyStream::writer();
  TextCoder coder = TextCoder::unlearned(are_for_single_texts);
  const std::vector<Text> all = examples();
  for (const Text& text : std::span(all).first(are_for_single_texts ? kJsonExamples : all.size())) {
    coder.code(stream, text);
  }
  return std::move(stream).finish();
}

struct Examples::Learned {
  explicit Learned(TextCoder learned) : coder(std::move(learned)) {}
  TextCoder coder;
  /// A coder to be changed, which the thread uses again.
  TextCoder& copy() const {
    thread_local TextCoder own = coder;
    thread_local std::uint64_t copied = number;
    if (std::exchange(copied, number) == number) {
      own.revert(coder);
    } else {
      own = coder;
    }
    return own;
  }
  /// Gives back the memory of a long text.
  void forget(TextCoder& copied, std::size_t bytes) const {
    if (bytes > kLongText) copied = TextCoder(coder);
  }
  /// Differs from that of all others of the process.
  const std::uint64_t number = [] {
    static std::atomic<std::uint64_t> last = 0;
    return ++last;
  }();
};

Examples::Examples(std::unique_ptr<const Learned> learned) : learned_(std::move(learned)) {}
Examples::~Examples() = default;

Bytes Examples::pack_examples(std::span<const Text> texts) {
  auto stream = EntropyStream::writer();
  TextCoder coder = TextCoder::for_single_texts();
  for (const Text& text : texts) coder.code(stream, text);
  ByteWriter writer;
  writer.varint(texts.size());
  writer.append(std::move(stream).finish());
  return std::move(writer).bytes();
}

Result<std::shared_ptr<const Examples>> Examples::of(ByteView examples, std::uint64_t most_bytes) {
  ByteReader reader(examples);
  const std::uint64_t count = reader.varint();
  if (reader.failed() || is_too_many(count, examples)) return reader.error("examples");
  auto stream = EntropyStream::reader_without_costs(reader.take(reader.remaining()));
  TextCoder coder = TextCoder::for_single_texts();
  coder.allow(most_bytes);
  coder.learn_packed(stream, count);
  if (coder.is_over_limit()) return over_limit(most_bytes);
  if (!stream.is_finished()) return damaged(stream);
  coder.allow(~std::uint64_t{0});
  return std::shared_ptr<const Examples>(
      new Examples(std::make_unique<const Learned>(std::move(coder))));
}

Bytes Examples::pack(const Text& text) const {
  auto stream = EntropyStream::writer();
  TextCoder& coder = learned_->copy();
  coder.code(stream, text);
  learned_->forget(coder, text.text.size());
  return std::move(stream).finish();
}

Result<std::string> Examples::unpack(ByteView bytes, std::uint64_t most_bytes) const {
  auto stream = EntropyStream::reader_without_costs(bytes);
  TextCoder& coder = learned_->copy();
  coder.allow(most_bytes);
  std::string text = coder.code(stream, {});
  const bool is_over_limit = coder.is_over_limit();
  learned_->forget(coder, text.size());
  if (is_over_limit) return over_limit(most_bytes);
  if (!stream.is_finished()) return damaged(stream);
  return text;
}

Bytes pack_texts(std::span<const Text> texts) {
  auto stream = EntropyStream::writer();
  TextCoder coder = TextCoder::after_examples();
  for (const Text& text : texts) coder.code(stream, text);
  Bytes packed = std::move(stream).finish();
  auto plain = pack_plainly(texts, packed.size());
  const bool is_plain = plain && plain->size() < packed.size();
  ByteWriter writer;
  writer.varint(kForms * texts.size() + (is_plain ? kPlain : kByColumn));
  writer.append(is_plain ? *plain : packed);
  return std::move(writer).bytes();
}

Result<std::vector<std::string>> unpack_texts(ByteView bytes, std::uint64_t most_bytes) {
  ByteReader reader(bytes);
  const std::uint64_t head = reader.varint();
  const std::uint64_t count = head / kForms;
  const std::uint64_t form = head % kForms;
  if (!reader.failed() && form > kPlain) return unknown_form(form);
  if (reader.failed() || is_too_many(count, bytes)) return reader.error("texts");
  if (form == kPlain) return unpack_plainly(reader.take(reader.remaining()), count, most_bytes);
  auto stream = EntropyStream::reader_without_costs(reader.take(reader.remaining()));
  TextCoder coder = TextCoder::after_examples();
  coder.allow(most_bytes);
  std::vector<std::string> texts;
  for (std::uint64_t i = 0; i < count && !stream.failed(); ++i)
    texts.push_back(coder.code(stream, {}));
  if (coder.is_over_limit()) return over_limit(most_bytes);
  if (!stream.is_finished()) return damaged(stream);
  return texts;
}

}  // namespace watertight::columns
