// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/text/kept_text.h"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "base/checksum.h"
#include "formats/text/indexed_text.h"
#include "formats/text/number_style.h"
#include "formats/text/text_layout.h"

namespace watertight::formats {
namespace {

enum class Kind : std::uint8_t {
  whole = 0,
  rings = 1,
  written = 2,
  written_with_layout = 3,
  indices = 4
};

/// The bytes that stand for positions in the kept text.
constexpr char kWholeRing = 1;      // all positions of the next ring
constexpr char kFirstPosition = 2;  // the first position of the next ring
constexpr char kNextPosition = 3;   // the next position of the same ring
constexpr char kEscape = 4;         // the byte after it is a byte of the text
constexpr char kFloatRing = 5;      // all positions of the next ring as 32-bit floats
constexpr std::string_view kMarks = "\x01\x02\x03\x04\x05";

/// A ring as it is written. `flags` is a sum of the values below.
struct RingForm {
  static constexpr std::uint8_t kReversed = 1;
  static constexpr std::uint8_t kYFirst = 2;
  static constexpr std::uint8_t kOpen = 4;  // the last position does not repeat the first

  Index solid = 0;
  Index ring = 0;
  std::uint8_t flags = 0;
  friend bool operator==(const RingForm&, const RingForm&) = default;
};

/// The places between numbers.
enum class Gap : std::uint8_t { before_first, between_axes, between_positions, after_last };
constexpr std::size_t kGaps = 4;

/// The positions of a ring as little-endian 32-bit floats.
std::string floats_of(const Solid& solid, Index ring) {
  ByteWriter writer;
  for (const Index vertex : solid.ring(ring)) {
    for (const double value : solid.world(vertex)) {
      writer.u32(std::bit_cast<std::uint32_t>(static_cast<float>(value)));
    }
  }
  return std::string(as_text(writer.bytes()));
}

/// The predictions, which the writer and the reader of a kept text teach in the same way.
class Predictions {
 public:
  explicit Predictions(DocumentSolids solids) : solids_(solids) {}

  /// The ring that likely follows the last one; there may be no such ring.
  RingForm next_ring() const { return next_; }
  void use_ring(const RingForm& form) {
    current_ = next_ = form;
    position_ = 0;
    if (++next_.ring < solids_[form.solid]->ring_count()) return;
    next_.ring = 0;
    ++next_.solid;
  }
  bool is_ring(const RingForm& form) const {
    return form.solid < solids_.size() && form.ring < solids_[form.solid]->ring_count() &&
           !solids_[form.solid]->ring(form.ring).empty();
  }
  std::string floats_of_ring(const RingForm& form) const {
    return floats_of(*solids_[form.solid], form.ring);
  }
  bool has_ring() const { return current_.has_value(); }
  /// The ring that was used last. Requires has_ring().
  const RingForm& ring() const { return *current_; }
  /// The number of vertices of a ring. Requires is_ring(form).
  std::size_t size_of(const RingForm& form) const {
    return solids_[form.solid]->ring(form.ring).size();
  }
  std::uint64_t position() const { return position_; }
  void advance() { ++position_; }

  /// The coordinate of the present position that stands at place `place` (0 to 2) of its numbers.
  VertexCoordinate coordinate(std::size_t place) const {
    const Solid& solid = *solids_[ring().solid];
    const auto ring_vertices = solid.ring(ring().ring);
    const std::size_t size = ring_vertices.size();
    std::size_t at = position_ % size;
    if ((ring().flags & RingForm::kReversed) != 0 && at > 0) at = size - at;
    return {&solid, ring_vertices[at], static_cast<int>(axis(place))};
  }
  NumberStyle& style(std::size_t place) { return styles_[axis(place)]; }
  std::string& gap(Gap gap) { return gaps_[static_cast<std::size_t>(gap)]; }

 private:
  std::size_t axis(std::size_t place) const {
    const bool is_exchanged = (ring().flags & RingForm::kYFirst) != 0 && place < 2;
    return is_exchanged ? 1 - place : place;
  }

  DocumentSolids solids_;
  RingForm next_;
  std::optional<RingForm> current_;
  std::uint64_t position_ = 0;
  std::array<NumberStyle, 3> styles_;
  std::array<std::string, kGaps> gaps_{"", " ", " ", ""};
};

Gap gap_before(std::size_t number) {
  if (number == 0) return Gap::before_first;
  return number % 3 == 0 ? Gap::between_positions : Gap::between_axes;
}

struct Number {
  std::string_view gap;
  std::string_view text;
};

/// The numbers of a text and what stands between them; the last element has the rest as its gap.
std::vector<Number> numbers_of(std::string_view text) {
  std::vector<Number> numbers;
  for (;;) {
    const std::size_t start = std::min(text.find_first_of("+-.0123456789"), text.size());
    const std::size_t end = std::min(text.find_first_not_of("+-.0123456789eE", start), text.size());
    numbers.push_back({text.substr(0, start), text.substr(start, end - start)});
    if (start == text.size()) return numbers;
    text.remove_prefix(end);
  }
}

class Writer {
 public:
  Writer(std::string_view text, DocumentSolids solids) : source_(text), predictions_(solids) {
    kept_.reserve(text.size() / 2);
  }

  void literal(std::string_view text) {
    while (!text.empty()) {
      const std::size_t plain = std::min(text.find_first_of(kMarks), text.size());
      kept_ += text.substr(0, plain);
      text.remove_prefix(plain);
      if (text.empty()) return;
      kept_ += kEscape;
      kept_ += text[0];
      text.remove_prefix(1);
    }
  }

  void ring(const RingText& ring) {
    const std::string_view text = source_.substr(ring.at, ring.size);
    if (ring.is_binary) {
      float_ring(ring, text);
      return;
    }
    const std::vector<Number> numbers = numbers_of(text);
    const std::size_t count = numbers.size() - 1;
    if (!(ring.is_whole ? begin_ring(ring, count) : begin_position(ring, count))) {
      literal(text);
      return;
    }
    for (std::size_t i = 0; i < count; ++i) {
      add_likely(gaps_, predictions_.gap(gap_before(i)), numbers[i].gap);
      add_number(numbers_, predictions_.style(i % 3), predictions_.coordinate(i % 3),
                 numbers[i].text);
      if (i % 3 == 2) predictions_.advance();
    }
    add_likely(gaps_, predictions_.gap(Gap::after_last), numbers.back().gap);
  }

  Bytes finish() && {
    ByteWriter writer;
    for (ExceptionWriter* exceptions : {&rings_, &gaps_, &numbers_}) {
      const Bytes bytes = std::move(*exceptions).finish();
      writer.varint(bytes.size());
      writer.append(bytes);
    }
    writer.append(as_bytes(kept_));
    return std::move(writer).bytes();
  }

 private:
  static RingForm form_of(const RingText& ring) {
    const int flags =
        (ring.is_reversed ? RingForm::kReversed : 0) + (ring.is_y_first ? RingForm::kYFirst : 0);
    return {ring.solid, ring.ring, static_cast<std::uint8_t>(flags)};
  }

  void float_ring(const RingText& ring, std::string_view bytes) {
    const RingForm form = form_of(ring);
    if (!predictions_.is_ring(form) || predictions_.floats_of_ring(form) != bytes) {
      literal(bytes);
      return;
    }
    add_ring(form);
    kept_ += kFloatRing;
  }

  bool begin_ring(const RingText& ring, std::size_t count) {
    RingForm form = form_of(ring);
    if (!predictions_.is_ring(form)) return false;
    const std::size_t size = predictions_.size_of(form);
    if (count == 3 * size) form.flags |= RingForm::kOpen;
    if (count != 3 * size && count != 3 * (size + 1)) return false;
    add_ring(form);
    kept_ += kWholeRing;
    return true;
  }

  bool begin_position(const RingText& ring, std::size_t count) {
    const RingForm form = form_of(ring);
    if (count != 3 || !predictions_.is_ring(form)) return false;
    if (ring.position == 0) {
      add_ring(form);
      kept_ += kFirstPosition;
      return true;
    }
    const bool is_next = predictions_.has_ring() && predictions_.ring() == form &&
                         predictions_.position() == ring.position;
    if (is_next) kept_ += kNextPosition;
    return is_next;
  }

  void add_ring(const RingForm& form) {
    const RingForm likely = predictions_.next_ring();
    if (form == likely) {
      rings_.expected();
    } else {
      ByteWriter writer;
      writer.zigzag(std::int64_t{form.solid} - likely.solid);
      writer.zigzag(std::int64_t{form.ring} - likely.ring);
      writer.u8(form.flags);
      rings_.exception(as_text(writer.bytes()));
    }
    predictions_.use_ring(form);
  }

  std::string_view source_;
  Predictions predictions_;
  std::string kept_;
  ExceptionWriter rings_;
  ExceptionWriter gaps_;
  ExceptionWriter numbers_;
};

Error does_not_fit() {
  return Error{ErrorCode::malformed, "the text of the document and its solids do not fit"};
}

class Reader {
 public:
  Reader(ByteReader& bytes, DocumentSolids solids, std::uint64_t size)
      : predictions_(solids),
        rings_(take_list(bytes)),
        gaps_(take_list(bytes)),
        numbers_(take_list(bytes)),
        kept_(as_text(bytes.take(bytes.remaining()))),
        is_readable_(!bytes.failed()),
        size_(size) {}

  Result<std::string> read() {
    bool fits = is_readable_;
    while (fits && !kept_.empty()) {
      const std::size_t plain = std::min(kept_.find_first_of(kMarks), kept_.size());
      text_ += kept_.substr(0, plain);
      kept_.remove_prefix(plain);
      if (kept_.empty()) break;
      const char mark = kept_[0];
      kept_.remove_prefix(1);
      fits = text_.size() <= size_ && (mark == kEscape ? take_escaped() : take_ring(mark));
    }
    if (!fits || !rings_.is_finished() || !gaps_.is_finished() || !numbers_.is_finished()) {
      return does_not_fit();
    }
    return std::move(text_);
  }

 private:
  bool take_escaped() {
    if (kept_.empty()) return false;
    text_ += kept_[0];
    kept_.remove_prefix(1);
    return true;
  }

  bool take_ring(char mark) {
    if (mark == kNextPosition) return predictions_.has_ring() && take_positions(1);
    RingForm form = predictions_.next_ring();
    std::string_view exception;
    if (rings_.next(exception)) {
      ByteReader reader(as_bytes(exception));
      form.solid = static_cast<Index>(form.solid + static_cast<std::uint64_t>(reader.zigzag()));
      form.ring = static_cast<Index>(form.ring + static_cast<std::uint64_t>(reader.zigzag()));
      form.flags = reader.u8();
      if (reader.failed() || reader.remaining() > 0) return false;
    }
    if (!predictions_.is_ring(form)) return false;
    predictions_.use_ring(form);
    if (mark == kFirstPosition) return take_positions(1);
    if (mark == kFloatRing) {
      text_ += predictions_.floats_of_ring(form);
      return text_.size() <= size_;
    }
    const bool is_open = (form.flags & RingForm::kOpen) != 0;
    return take_positions(predictions_.size_of(form) + (is_open ? 0 : 1));
  }

  bool take_positions(std::size_t count) {
    for (std::size_t i = 0; i < 3 * count; ++i) {
      append_likely(gaps_, predictions_.gap(gap_before(i)), text_);
      append_number(numbers_, predictions_.style(i % 3), predictions_.coordinate(i % 3), text_);
      if (i % 3 == 2) predictions_.advance();
      if (text_.size() > size_) return false;
    }
    append_likely(gaps_, predictions_.gap(Gap::after_last), text_);
    return true;
  }

  Predictions predictions_;
  ExceptionReader rings_;
  ExceptionReader gaps_;
  ExceptionReader numbers_;
  std::string_view kept_;
  bool is_readable_;
  std::uint64_t size_;
  std::string text_;
};

Bytes with_head(Kind kind, ByteView bytes, ByteView content) {
  ByteWriter writer;
  writer.u8(static_cast<std::uint8_t>(kind));
  writer.u64(content_hash(bytes));
  writer.varint(bytes.size());
  writer.append(content);
  return std::move(writer).bytes();
}

Result<Bytes> bytes_of_kind(Kind kind, ByteReader& reader, DocumentSolids solids, ByteView written,
                            std::uint64_t size) {
  switch (kind) {
    case Kind::rings: {
      const auto text = Reader(reader, solids, size).read();
      if (!text) return text.error();
      return Bytes(text->begin(), text->end());
    }
    case Kind::written:
      return Bytes(written.begin(), written.end());
    case Kind::written_with_layout: {
      const auto text = apply_layout(as_text(written), reader.take(reader.remaining()), size);
      if (!text) return text.error();
      return Bytes(text->begin(), text->end());
    }
    case Kind::indices: {
      const auto text = text_of_indexed_form(reader.take(reader.remaining()), solids, size);
      if (!text) return text.error();
      return Bytes(text->begin(), text->end());
    }
    case Kind::whole:
      break;
  }
  const ByteView whole = reader.take(reader.remaining());
  return Bytes(whole.begin(), whole.end());
}

}  // namespace

std::vector<const Solid*> solids_of(const Document& document) {
  std::vector<const Solid*> solids;
  for (const Feature& feature : document.features) {
    for (const SubmittedSolid& submitted : feature.solids) solids.push_back(&submitted.solid);
  }
  return solids;
}

Bytes keep_with_rings(ByteView bytes, std::span<const RingText> rings, DocumentSolids solids) {
  const std::string_view text = as_text(bytes);
  Writer writer(text, solids);
  std::uint64_t at = 0;
  for (const RingText& ring : rings) {
    writer.literal(text.substr(at, ring.at - at));
    writer.ring(ring);
    at = ring.at + ring.size;
  }
  writer.literal(text.substr(at));
  return with_head(Kind::rings, bytes, std::move(writer).finish());
}

Bytes keep_as_written(ByteView bytes, ByteView written) {
  if (std::equal(bytes.begin(), bytes.end(), written.begin(), written.end())) {
    return with_head(Kind::written, bytes, {});
  }
  const Bytes layout = describe_layout(as_text(written), as_text(bytes));
  if (layout.size() >= bytes.size()) return keep_whole(bytes);
  return with_head(Kind::written_with_layout, bytes, layout);
}

std::optional<Bytes> keep_with_indices(ByteView bytes, const IndexedPlaces& places,
                                       DocumentSolids solids) {
  const auto form = indexed_form(as_text(bytes), places, solids);
  if (!form) return std::nullopt;
  return with_head(Kind::indices, bytes, *form);
}

Bytes keep_whole(ByteView bytes) { return with_head(Kind::whole, bytes, bytes); }

bool needs_written(ByteView kept) {
  if (kept.empty()) return false;
  return kept[0] == static_cast<std::uint8_t>(Kind::written) ||
         kept[0] == static_cast<std::uint8_t>(Kind::written_with_layout);
}

Result<Bytes> restored_bytes(ByteView kept, DocumentSolids solids, ByteView written,
                             std::uint64_t most_bytes) {
  ByteReader reader(kept);
  const std::uint8_t kind = reader.u8();
  const std::uint64_t hash = reader.u64();
  const std::uint64_t size = reader.varint();
  if (reader.failed() || kind > static_cast<std::uint8_t>(Kind::indices)) {
    return does_not_fit();
  }
  if (size > most_bytes) {
    return Error{ErrorCode::limit_exceeded, "a document of " + std::to_string(size) +
                                                " bytes; the limit is " +
                                                std::to_string(most_bytes)};
  }
  auto bytes = bytes_of_kind(static_cast<Kind>(kind), reader, solids, written, size);
  if (!bytes) return bytes;
  if (bytes->size() != size || content_hash(*bytes) != hash) {
    return Error{ErrorCode::malformed,
                 "the document is not the one that was stored: its hash differs"};
  }
  return bytes;
}

}  // namespace watertight::formats
