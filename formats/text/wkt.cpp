// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <charconv>
#include <utility>

#include "formats/ewkb.h"
#include "formats/mesh/mesh_text.h"
#include "formats/surface.h"
#include "formats/text/numbers.h"

namespace watertight::formats {
namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }

// geometry := ["SRID=" number ";"] type ["Z"] ("EMPTY" | body)
// POLYHEDRALSURFACE and TIN: body := "(" polygon {"," polygon} ")"; SOLID has one more level.
class WktReader {
 public:
  WktReader(std::string_view text, const Limits& limits) : text_(text), limits_(limits) {}

  bool is_at_end() {
    while (at_ < text_.size() && (is_space(text_[at_]) || text_[at_] == ';')) ++at_;
    return at_ == text_.size();
  }
  std::size_t position() const { return at_; }

  Result<SubmittedSolid> read() {
    arrays_ = {};
    positions_.clear();
    rounded_.clear();
    srid_ = 0;
    if (auto status = read_srid(); !status) return status.error();
    std::string type = word();
    if (auto status = dimension(type); !status) return status.error();
    if (type != "POLYHEDRALSURFACE" && type != "SOLID" && type != "TIN") {
      return Error{
          ErrorCode::unsupported, "only POLYHEDRALSURFACE Z, SOLID Z and TIN Z are read", at_, {}};
    }
    if (is_empty_) {
      arrays_.end_shell();  // an empty exterior shell, as in every reader
    } else {
      auto status = type == "SOLID" ? list([this] { return shell(); }) : shell();
      if (!status) return status.error();
    }
    auto points = geometry::lattice_of_decimals(positions_);
    if (!points) return std::move(points).error();
    points->rounded.insert(points->rounded.end(), rounded_.begin(), rounded_.end());
    return solid_of_points(std::move(arrays_), *points, SolidSource{"", type + " Z", "", 0, 0, ""},
                           srid_, limits_);
  }

 private:
  Error wrong(std::string message) const {
    return Error{ErrorCode::malformed, std::move(message), at_, {}};
  }

  void skip_space() {
    while (at_ < text_.size() && is_space(text_[at_])) ++at_;
  }

  bool take(char c) {
    skip_space();
    if (at_ == text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }

  // The next letters of the text, in upper case.
  std::string word() {
    skip_space();
    std::string letters;
    while (at_ < text_.size() && is_letter(text_[at_]) && letters.size() < 40) {
      letters += static_cast<char>(text_[at_] & ~0x20);
      ++at_;
    }
    return letters;
  }

  Status read_srid() {
    const std::size_t start = at_;
    if (word() != "SRID") {
      at_ = start;
      return Done{};
    }
    if (!take('=')) return wrong("'=' expected after SRID");
    skip_space();
    const char* begin = text_.data() + at_;
    const auto [end, status] = std::from_chars(begin, text_.data() + text_.size(), srid_);
    if (status != std::errc() || srid_ > 999'999'999) return wrong("SRID is not a number");
    at_ += static_cast<std::size_t>(end - begin);
    if (!take(';')) return wrong("';' expected after SRID");
    return Done{};
  }

  // Reads "Z" and "EMPTY", and cuts a Z that is written with the type.
  Status dimension(std::string& type) {
    is_empty_ = false;
    bool has_z = false;
    if (type == "POLYHEDRALSURFACEZ" || type == "SOLIDZ" || type == "TINZ") {
      type.pop_back();
      has_z = true;
    }
    std::string next = word();
    if (!has_z && (next == "M" || next == "ZM")) {
      return Error{ErrorCode::unsupported, "measured coordinates (M) are not read", at_, {}};
    }
    if (!has_z && next == "Z") next = word();
    is_empty_ = next == "EMPTY";
    if (!next.empty() && !is_empty_) return wrong("unexpected word");
    return Done{};
  }

  // Reads "(" element {"," element} ")".
  template <class Element>
  Status list(Element element) {
    if (!take('(')) return wrong("'(' expected");
    do {
      if (auto status = element(); !status) return status;
    } while (take(','));
    if (!take(')')) return wrong("',' or ')' expected");
    return Done{};
  }

  Status shell() {
    auto status = list([this] { return polygon(); });
    if (status) arrays_.end_shell();
    return status;
  }
  Status polygon() {
    auto status = list([this] { return ring(); });
    if (status) arrays_.end_facet();
    return status;
  }

  Status ring() {
    const std::size_t first = positions_.size();
    if (auto status = list([this] { return point(); }); !status) return status;
    if (positions_.size() - first < 2 || positions_.back() != positions_[first]) {
      return wrong("the ring is not closed: its last point must be its first");
    }
    positions_.pop_back();
    if (!rounded_.empty() && rounded_.back() == positions_.size()) rounded_.pop_back();
    for (std::size_t i = first; i < positions_.size(); ++i) {
      arrays_.ring_vertices.push_back(static_cast<Index>(i));
    }
    arrays_.end_ring();
    return Done{};
  }

  Status point() {
    if (positions_.size() > 8 * limits_.vertices || positions_.size() >= kNone - 1) {
      return Error{ErrorCode::limit_exceeded, "more points than the limit", at_, {}};
    }
    std::array<GridNumber, 3> position;
    bool is_rounded = false;
    for (GridNumber& axis : position) {
      skip_space();
      std::size_t end = at_;
      while (end < text_.size() && !is_space(text_[end]) && text_[end] != ',' &&
             text_[end] != '(' && text_[end] != ')') {
        ++end;
      }
      auto exact = exact_number(text_.substr(at_, end - at_));
      if (!exact) return wrong("a point needs three coordinates: " + exact.error().message);
      axis = exact->value;
      is_rounded = is_rounded || exact->is_rounded;
      at_ = end;
    }
    if (is_rounded) rounded_.push_back(static_cast<Index>(positions_.size()));
    positions_.push_back(position);
    return Done{};
  }

  std::string_view text_;
  const Limits& limits_;
  std::size_t at_ = 0;
  bool is_empty_ = false;
  std::uint32_t srid_ = 0;
  SolidArrays arrays_;
  std::vector<std::array<GridNumber, 3>> positions_;
  std::vector<Index> rounded_;
};

void append_point(std::string& out, const Solid& solid, Index vertex) {
  for (int axis = 0; axis < 3; ++axis) {
    if (axis > 0) out += ' ';
    out += solid.lattice().world_text(solid.vertices()[vertex][axis], axis);
  }
}

void append_ring(std::string& out, const Solid& solid, Index ring) {
  const auto vertices = solid.ring(ring);
  out += '(';
  for (const Index vertex : vertices) {
    append_point(out, solid, vertex);
    out += ',';
  }
  if (!vertices.empty()) append_point(out, solid, vertices.front());
  out += ')';
}

void append_shell(std::string& out, const Solid& solid, Index shell) {
  out += '(';
  const IndexRange facets = solid.facets_of(shell);
  for (Index facet = facets.begin; facet < facets.end; ++facet) {
    out += facet > facets.begin ? ",(" : "(";
    const IndexRange rings = solid.rings_of(facet);
    for (Index ring = rings.begin; ring < rings.end; ++ring) {
      if (ring > rings.begin) out += ',';
      append_ring(out, solid, ring);
    }
    out += ')';
  }
  out += ')';
}

}  // namespace

Result<SubmittedSolid> read_wkt(std::string_view text, const Limits& limits) {
  if (text.size() > limits.bytes) {
    return Error{ErrorCode::limit_exceeded, "the text is longer than the limit"};
  }
  WktReader reader(text, limits);
  auto solid = reader.read();
  if (solid && !reader.is_at_end()) {
    return Error{ErrorCode::malformed, "text after the geometry", reader.position(), {}};
  }
  return solid;
}

Result<Document> read_wkt_document(std::string_view text, const Limits& limits) {
  WktReader reader(text, limits);
  if (reader.is_at_end()) return Error{ErrorCode::malformed, "the text is empty", 0, {}};
  return document_of_geometries(std::move(reader), Format::wkt);
}

std::string write_wkt(const Solid& solid) {
  std::string out;
  if (solid.srid() != 0) out = "SRID=" + std::to_string(solid.srid()) + ';';
  if (solid.facet_count() == 0) return out + "POLYHEDRALSURFACE Z EMPTY";
  if (solid.shell_count() == 1) {
    out += "POLYHEDRALSURFACE Z ";
    append_shell(out, solid, 0);
    return out;
  }
  out += "SOLID Z (";
  for (Index shell = 0; shell < solid.shell_count(); ++shell) {
    if (shell > 0) out += ',';
    append_shell(out, solid, shell);
  }
  return out + ')';
}

}  // namespace watertight::formats
