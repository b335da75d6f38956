// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/text/indexed_text.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <numeric>

#include "formats/text/number_style.h"
#include "formats/text/text_layout.h"

namespace watertight::formats {
namespace {

/// The bytes that stand for something else in an indexed form.
constexpr char kVertexMark = 1;      // the coordinates of the next vertex of the file
constexpr char kTextVertexMark = 2;  // a vertex of the file that stays text
constexpr char kCornerMark = 3;      // the number of the next corner
constexpr char kTextCornerMark = 4;  // the next corner, whose number stays text
constexpr char kEscapeMark = 5;      // the byte after it is a byte of the text
constexpr std::string_view kIndexedMarks = "\x01\x02\x03\x04\x05";

constexpr std::uint64_t kNoNumber = std::uint64_t{0} - 1;

/// The corners of solids in order, and their different points by first use, of all solids in one
/// row.
class MeshPoints {
 public:
  explicit MeshPoints(DocumentSolids solids) {
    for (const Solid* solid : solids) add(*solid);
  }

  std::size_t point_count() const { return points_.size(); }
  /// One of the coordinates of a point.
  VertexCoordinate coordinate(std::size_t point, int axis) const {
    return {points_[point].first, points_[point].second, axis};
  }
  /// Corner -> point.
  std::span<const std::size_t> corners() const { return corners_; }

 private:
  void add(const Solid& solid) {
    const auto vertices = solid.vertices();
    std::vector<Index> order(vertices.size());
    std::iota(order.begin(), order.end(), Index{0});
    std::ranges::sort(order, [&](Index a, Index b) {
      return vertices[a] != vertices[b] ? vertices[a] < vertices[b] : a < b;
    });
    std::vector<Index> first(vertices.size());  // vertex -> the first one of the same point
    for (std::size_t i = 0; i < order.size(); ++i) {
      const bool is_same = i > 0 && vertices[order[i]] == vertices[order[i - 1]];
      first[order[i]] = is_same ? first[order[i - 1]] : order[i];
    }
    std::vector<std::size_t> point_of(vertices.size(), kNoNumber);
    for (Index ring = 0; ring < solid.ring_count(); ++ring) {
      for (const Index vertex : solid.ring(ring)) {
        std::size_t& point = point_of[first[vertex]];
        if (point == kNoNumber) {
          point = points_.size();
          points_.emplace_back(&solid, first[vertex]);
        }
        corners_.push_back(point);
      }
    }
  }

  std::vector<std::pair<const Solid*, Index>> points_;
  std::vector<std::size_t> corners_;
};

std::string bytes_of_number(std::uint32_t number) {
  ByteWriter writer;
  writer.u32(number);
  return std::string(as_text(writer.bytes()));
}

/// A point as three floats.
std::string floats_of_point(const MeshPoints& mesh, std::size_t point) {
  std::string bytes;
  for (int axis = 0; axis < 3; ++axis) {
    const auto value = static_cast<float>(mesh.coordinate(point, axis).value());
    bytes += bytes_of_number(std::bit_cast<std::uint32_t>(value));
  }
  return bytes;
}

/// The predictions, which the writer and the reader teach in the same way.
struct MeshPredictions {
  std::size_t point = 0;  // the likely point of the next vertex
  std::uint64_t number;   // of the next vertex of the file
  bool is_binary;
  std::size_t corner = 0;                // the next corner
  std::vector<std::uint64_t> number_of;  // point -> number in the file
  std::array<NumberStyle, 3> styles;
  std::string gap = " ";  // between coordinates

  MeshPredictions(std::uint64_t first_number, bool has_bytes, std::size_t points)
      : number(first_number), is_binary(has_bytes), number_of(points, kNoNumber) {}

  void use_vertex(std::size_t used) {
    number_of[used] = number++;
    point = used + 1;
  }
  /// The likely number of the next corner, which must not be beyond the last one; "" if unknown.
  std::string corner_text(const MeshPoints& mesh) const {
    const std::uint64_t known = number_of[mesh.corners()[corner]];
    if (known == kNoNumber) return {};
    return is_binary ? bytes_of_number(static_cast<std::uint32_t>(known)) : std::to_string(known);
  }
};

/// The three numbers of a vertex and the texts between them; nothing if there is something else.
struct VertexText {
  std::array<std::string_view, 3> numbers;
  std::array<std::string_view, 2> gaps;
};

std::optional<VertexText> vertex_text(std::string_view text) {
  constexpr std::string_view kBlanks = " \t";
  VertexText vertex;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t end = std::min(text.find_first_of(kBlanks), text.size());
    if (end == 0) return std::nullopt;
    vertex.numbers[i] = text.substr(0, end);
    text.remove_prefix(end);
    if (i == 2) break;
    const std::size_t blanks = std::min(text.find_first_not_of(kBlanks), text.size());
    vertex.gaps[i] = text.substr(0, blanks);
    text.remove_prefix(blanks);
  }
  return text.empty() ? std::optional(vertex) : std::nullopt;
}

class IndexedWriter {
 public:
  IndexedWriter(std::string_view text, const IndexedPlaces& places, DocumentSolids solids)
      : text_(text),
        places_(places),
        mesh_(solids),
        predictions_(places.first_number, places.is_binary, mesh_.point_count()) {}

  std::optional<Bytes> write() {
    if (!find_points()) return std::nullopt;
    std::uint64_t at = 0;
    std::size_t vertex = 0;
    for (const IndexedPlace& place : places_.places) {
      literal(text_.substr(at, place.at - at));
      at = place.at + place.size;
      const std::string_view own = text_.substr(place.at, place.size);
      if (place.kind == IndexedPlace::Kind::corner) {
        corner(own);
      } else {
        add_vertex(own, point_of_[vertex++]);
      }
    }
    literal(text_.substr(at));
    return std::move(*this).finish();
  }

 private:
  /// Finds the point of each vertex of the file by the corners that use it. False if the corners
  /// are not as many as those of the solids.
  bool find_points() {
    const auto is_corner = [](const IndexedPlace& place) {
      return place.kind == IndexedPlace::Kind::corner;
    };
    const auto corners = static_cast<std::size_t>(std::ranges::count_if(places_.places, is_corner));
    if (corners != mesh_.corners().size()) return false;
    point_of_.assign(places_.places.size() - corners, kNoNumber);
    std::vector<bool> is_named(mesh_.point_count(), false);
    std::size_t next = 0;
    for (const IndexedPlace& place : places_.places) {
      if (!is_corner(place)) continue;
      const std::size_t point = mesh_.corners()[next++];
      const std::uint64_t number = number_at(place);
      const bool is_vertex =
          number >= places_.first_number && number - places_.first_number < point_of_.size();
      if (!is_vertex || is_named[point]) continue;
      std::size_t& its = point_of_[number - places_.first_number];
      if (its != kNoNumber) continue;
      its = point;
      is_named[point] = true;
    }
    return true;
  }

  /// The number that a corner has in the text; kNoNumber if it is no plain one.
  std::uint64_t number_at(const IndexedPlace& place) const {
    const std::string_view own = text_.substr(place.at, place.size);
    if (places_.is_binary) return ByteReader(as_bytes(own)).u32();
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(own.data(), own.data() + own.size(), number);
    return error == std::errc{} && end == own.data() + own.size() ? number : kNoNumber;
  }

  void literal(std::string_view text) {
    for (const char c : text) {
      if (kIndexedMarks.find(c) != std::string_view::npos) kept_ += kEscapeMark;
      kept_ += c;
    }
  }

  void add_vertex(std::string_view text, std::size_t point) {
    const auto vertex = vertex_text(text);
    const bool is_known =
        point != kNoNumber &&
        (places_.is_binary ? floats_of_point(mesh_, point) == text : vertex.has_value());
    if (!is_known) {
      kept_ += kTextVertexMark;
      literal(text);
      ++predictions_.number;
      return;
    }
    kept_ += kVertexMark;
    order_.zigzag(static_cast<std::int64_t>(point) - static_cast<std::int64_t>(predictions_.point));
    for (std::size_t i = 0; i < 3 && !places_.is_binary; ++i) {
      if (i > 0) add_likely(gaps_, predictions_.gap, vertex->gaps[i - 1]);
      add_number(numbers_, predictions_.styles[i], mesh_.coordinate(point, static_cast<int>(i)),
                 vertex->numbers[i]);
    }
    predictions_.use_vertex(point);
  }

  void corner(std::string_view digits) {
    const bool is_likely = predictions_.corner_text(mesh_) == digits;
    kept_ += is_likely ? kCornerMark : kTextCornerMark;
    if (!is_likely) literal(digits);
    ++predictions_.corner;
  }

  Bytes finish() && {
    ByteWriter writer;
    writer.varint(2 * places_.first_number + (places_.is_binary ? 1 : 0));
    for (const Bytes& list :
         {std::move(order_).bytes(), std::move(gaps_).finish(), std::move(numbers_).finish()}) {
      writer.varint(list.size());
      writer.append(list);
    }
    writer.append(as_bytes(kept_));
    return std::move(writer).bytes();
  }

  std::string_view text_;
  const IndexedPlaces& places_;
  MeshPoints mesh_;
  MeshPredictions predictions_;
  std::vector<std::size_t> point_of_;  // vertex of the file -> point
  std::string kept_;
  ByteWriter order_;
  ExceptionWriter gaps_;
  ExceptionWriter numbers_;
};

class IndexedReader {
 public:
  IndexedReader(ByteReader& bytes, DocumentSolids solids, std::uint64_t most_bytes)
      : mesh_(solids),
        head_(bytes.varint()),
        predictions_(head_ / 2, head_ % 2 == 1, mesh_.point_count()),
        order_(take_list(bytes)),
        gaps_(take_list(bytes)),
        numbers_(take_list(bytes)),
        kept_(as_text(bytes.take(bytes.remaining()))),
        is_readable_(!bytes.failed()),
        most_bytes_(most_bytes) {}

  std::optional<std::string> read() {
    bool fits = is_readable_;
    while (fits && !kept_.empty()) {
      const std::size_t plain = std::min(kept_.find_first_of(kIndexedMarks), kept_.size());
      text_ += kept_.substr(0, plain);
      kept_.remove_prefix(plain);
      if (kept_.empty()) break;
      const char mark = kept_[0];
      kept_.remove_prefix(1);
      fits = text_.size() <= most_bytes_ && take(mark);
    }
    const bool is_finished = order_.remaining() == 0 && !order_.failed() && gaps_.is_finished() &&
                             numbers_.is_finished();
    return fits && is_finished ? std::optional(std::move(text_)) : std::nullopt;
  }

 private:
  bool take(char mark) {
    switch (mark) {
      case kVertexMark:
        return take_vertex();
      case kTextVertexMark:
        ++predictions_.number;
        return true;
      case kCornerMark:
      case kTextCornerMark:
        return take_corner(mark == kCornerMark);
      default:
        if (kept_.empty()) return false;
        text_ += kept_[0];
        kept_.remove_prefix(1);
        return true;
    }
  }

  bool take_vertex() {
    const std::uint64_t point = predictions_.point + static_cast<std::uint64_t>(order_.zigzag());
    if (order_.failed() || point >= mesh_.point_count()) return false;
    if (predictions_.is_binary) text_ += floats_of_point(mesh_, point);
    for (std::size_t i = 0; i < 3 && !predictions_.is_binary; ++i) {
      if (i > 0) append_likely(gaps_, predictions_.gap, text_);
      append_number(numbers_, predictions_.styles[i], mesh_.coordinate(point, static_cast<int>(i)),
                    text_);
    }
    predictions_.use_vertex(point);
    return true;
  }

  bool take_corner(bool is_likely) {
    if (predictions_.corner >= mesh_.corners().size()) return false;
    if (is_likely) {
      const std::string digits = predictions_.corner_text(mesh_);
      if (digits.empty()) return false;
      text_ += digits;
    }
    ++predictions_.corner;
    return true;
  }

  MeshPoints mesh_;
  std::uint64_t head_;  // twice the first number, and 1 for bytes
  MeshPredictions predictions_;
  ByteReader order_;
  ExceptionReader gaps_;
  ExceptionReader numbers_;
  std::string_view kept_;
  bool is_readable_;
  std::uint64_t most_bytes_;
  std::string text_;
};

}  // namespace

std::optional<Bytes> indexed_form(std::string_view text, const IndexedPlaces& places,
                                  DocumentSolids solids) {
  return IndexedWriter(text, places, solids).write();
}

Result<std::string> text_of_indexed_form(ByteView form, DocumentSolids solids,
                                         std::uint64_t most_bytes) {
  ByteReader reader(form);
  auto text = IndexedReader(reader, solids, most_bytes).read();
  if (!text) return Error{ErrorCode::malformed, "the text of the mesh and its solids do not fit"};
  return *std::move(text);
}

}  // namespace watertight::formats
