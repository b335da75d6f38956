// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "base/quantity.h"
#include "formats/mesh/mesh_text.h"
#include "formats/surface.h"
#include "formats/text/numbers.h"

namespace watertight::formats {
namespace {

// Statements of the format that say nothing about facets of polygons.
constexpr std::array<std::string_view, 40> kIgnored{
    "vt",     "vn",     "vp",         "l",         "p",        "g",    "s",    "mg",
    "usemtl", "mtllib", "usemap",     "maplib",    "cstype",   "deg",  "bmat", "step",
    "curv",   "curv2",  "surf",       "parm",      "trim",     "hole", "scrv", "sp",
    "end",    "con",    "bevel",      "c_interp",  "d_interp", "lod",  "call", "csh",
    "ctech",  "stech",  "shadow_obj", "trace_obj", "xyzrgb",   "bsp",  "cdp",  "res"};

struct ObjObject {
  std::string name;
  SolidArrays arrays;  // ring vertices are indices into the file's vertices
};

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t begin = text.find_first_not_of(kBlank);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlank) - begin + 1);
}

class ObjReader {
 public:
  ObjReader(std::string_view text, const Limits& limits) : text_(text), limits_(limits) {
    objects_.emplace_back();
  }

  Result<Document> read() {
    std::size_t at = 0;
    std::size_t number = 0;
    while (at < text_.size()) {
      const TextLine line = next_line(at, number);
      if (auto status = statement(line); !status) return status.error();
    }
    if (last_missing_ != 0 && last_missing_ > vertices_.positions.size()) {
      return Error{ErrorCode::malformed,
                   "line " + std::to_string(missing_line_) + ": vertex index " +
                       std::to_string(last_missing_) + " is out of range (" +
                       quantity(vertices_.positions.size(), "vertex", "vertices") + ')',
                   missing_offset_,
                   {}};
    }
    return document();
  }

 private:
  // The next line. Lines that end with a backslash are joined, with blanks for the bytes between
  // them, so that positions in the line are positions in the file.
  TextLine next_line(std::size_t& at, std::size_t& number) {
    TextLine line{{}, at, number + 1};
    joined_.clear();
    while (true) {
      const std::size_t end = std::min(text_.find('\n', at), text_.size());
      std::string_view part = text_.substr(at, end - at);
      at = end + 1;
      ++number;
      std::string_view content = part;
      if (content.ends_with('\r')) content.remove_suffix(1);
      if (!content.ends_with('\\') || at >= text_.size()) {
        if (joined_.empty()) {
          line.text = part;
        } else {
          joined_ += part;
          line.text = joined_;
        }
        return line;
      }
      joined_ += content.substr(0, content.size() - 1);
      joined_.append(part.size() - content.size() + 2, ' ');
    }
  }

  Status statement(const TextLine& line) {
    const std::string_view content = trimmed(line.text);
    if (content.empty() || content.front() == '#') return Done{};
    const std::string_view keyword = content.substr(0, content.find_first_of(" \t"));
    if (keyword == "o") {
      begin_object(std::string(trimmed(content.substr(1))));
      return Done{};
    }
    if (keyword == "v" || keyword == "f") {
      words_of(line.text, words_);
      for (std::size_t i = 0; i < words_.size(); ++i) {
        if (words_[i].front() == '#') words_.resize(i);
      }
      const auto arguments = std::span<const std::string_view>(words_).subspan(1);
      return keyword == "v" ? vertex(line, arguments) : facet(line, arguments);
    }
    if (std::find(kIgnored.begin(), kIgnored.end(), keyword) != kIgnored.end()) return Done{};
    return error_at(line, keyword, "not a statement of an OBJ file");
  }

  // Begins an object, which replaces the last one if that has no faces.
  void begin_object(std::string name) {
    ObjObject& last = objects_.back();
    if (!last.arrays.ring_vertices.empty()) {
      objects_.push_back({std::move(name), {}});
      return;
    }
    if (!last.name.empty()) ++left_out_;
    last.name = std::move(name);
  }

  // Reads the coordinates x y z, optionally with a weight or a colour.
  Status vertex(const TextLine& line, std::span<const std::string_view> words) {
    if (vertices_.positions.size() >= kNone - 1) {
      return Error{ErrorCode::limit_exceeded, "more vertices than a 32-bit index can name"};
    }
    if (words.size() == 4) {
      const auto weight = exact_number(words[3]);
      if (!weight || weight->value != GridNumber{1, 0}) {
        return error_at(line, words[3], "a vertex with a weight other than 1");
      }
    }
    if (words.size() == 5 || words.size() > 7) {
      return error_at(line, words[3], "a vertex has three numbers, a weight or a colour");
    }
    for (const std::string_view word : words.subspan(std::min<std::size_t>(words.size(), 3))) {
      if (!exact_number(word)) return error_at(line, word, "not a number");
    }
    return append_vertex(line, words, vertices_);
  }

  Status facet(const TextLine& line, std::span<const std::string_view> words) {
    if (words.empty()) return error_at(line, line.text, "a face without vertices");
    SolidArrays& arrays = objects_.back().arrays;
    if (arrays.facet_offsets.size() > limits_.facets) {
      return Error{ErrorCode::limit_exceeded,
                   "more facets in one object than the limit of " + std::to_string(limits_.facets)};
    }
    for (const std::string_view word : words) {
      if (auto status = corner(line, word, arrays); !status) return status;
    }
    arrays.end_ring();
    arrays.end_facet();
    return Done{};
  }

  // Reads a vertex index "7", "7/1", "7//3" or "7/1/3"; negative numbers count from the last vertex
  // so far.
  Status corner(const TextLine& line, std::string_view word, SolidArrays& arrays) {
    const std::string_view digits = word.substr(0, word.find('/'));
    std::int64_t index = 0;
    const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
    if (status != std::errc() || end != digits.data() + digits.size()) {
      return error_at(line, word, "not a vertex index");
    }
    if (auto others = check_other_indices(line, word); !others) return others;
    const auto count = static_cast<std::int64_t>(vertices_.positions.size());
    if (index < 0) index += count + 1;
    if (index < 1 || index >= static_cast<std::int64_t>(kNone)) {
      return error_at(line, word, "vertex index is out of range");
    }
    if (index > count && static_cast<std::uint64_t>(index) > last_missing_) {
      last_missing_ = static_cast<std::uint64_t>(index);
      missing_line_ = line.number;
      missing_offset_ = line.offset + static_cast<std::size_t>(word.data() - line.text.data());
    }
    arrays.ring_vertices.push_back(static_cast<Index>(index - 1));
    return Done{};
  }

  // The indices of texture vertex and normal are not used, but must be indices.
  static Status check_other_indices(const TextLine& line, std::string_view word) {
    const std::size_t slash = word.find('/');
    if (slash == std::string_view::npos) return Done{};
    const std::string_view rest = word.substr(slash);
    if (std::count(rest.begin(), rest.end(), '/') > 2 ||
        rest.find_first_not_of("/-0123456789") != std::string_view::npos) {
      return error_at(line, word, "not vertex/texture/normal indices");
    }
    return Done{};
  }

  Result<Document> document() {
    Document document;
    document.format = Format::obj;
    if (objects_.back().arrays.ring_vertices.empty()) {
      if (objects_.size() == 1) {
        // The document gets one empty solid, so that there is a feature to report about.
        document.notes.push_back("the file has no faces");
      } else {
        objects_.pop_back();
        ++left_out_;
      }
    }
    for (ObjObject& object : objects_) {
      object.arrays.end_shell();
      auto solid = indexed_solid(std::move(object.arrays), vertices_,
                                 SolidSource{object.name, "Mesh", "", 0, 0, ""}, limits_);
      if (!solid) return std::move(solid).error();
      if (objects_.size() > 1) solid->unused = {};  // the file's vertices are for all objects
      Feature feature;
      feature.id = object.name;
      feature.solids.push_back(std::move(*solid));
      document.features.push_back(std::move(feature));
    }
    if (left_out_ > 0) {
      document.notes.push_back(quantity(left_out_, "object") + " without faces left out");
    }
    return document;
  }

  std::string_view text_;
  const Limits& limits_;
  DecimalVertices vertices_;
  std::vector<ObjObject> objects_;
  std::string joined_;
  std::vector<std::string_view> words_;  // the words of the statement
  std::size_t left_out_ = 0;             // the number of objects without faces
  std::uint64_t last_missing_ = 0;       // the largest index beyond the vertices so far, from 1
  std::size_t missing_line_ = 0;
  std::size_t missing_offset_ = 0;
};

// The name of an object, without control characters: the end of the line ends it.
std::string object_name(const Feature& feature, const SubmittedSolid& solid) {
  std::string name = solid.source.object_id.empty() ? feature.id : solid.source.object_id;
  for (char& c : name) {
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  }
  if (feature.solids.size() > 1) {
    name +=
        '#' + std::to_string(solid.source.geometry) + '.' + std::to_string(solid.source.ordinal);
  }
  return name;
}

Status append_obj(std::string& out, const Solid& solid, std::uint64_t first_vertex) {
  if (solid.shell_count() > 1) {
    return Error{ErrorCode::unsupported, "OBJ has no cavities: the solid has inner shells"};
  }
  for (const Point& p : solid.vertices()) {
    out += 'v';
    for (int axis = 0; axis < 3; ++axis) out += ' ' + solid.lattice().world_text(p[axis], axis);
    out += '\n';
  }
  for (Index facet = 0; facet < solid.facet_count(); ++facet) {
    const IndexRange rings = solid.rings_of(facet);
    if (rings.size() != 1 || solid.ring(rings.begin).empty()) {
      return Error{ErrorCode::unsupported, "OBJ has no facets with holes: facet " +
                                               std::to_string(facet) + " has " +
                                               std::to_string(rings.size()) + " rings"};
    }
    out += 'f';
    for (const Index vertex : solid.ring(rings.begin)) {
      out += ' ' + std::to_string(first_vertex + vertex);
    }
    out += '\n';
  }
  return Done{};
}

}  // namespace

Result<Document> read_obj(std::string_view text, const Limits& limits) {
  return ObjReader(text, limits).read();
}

Result<std::string> write_obj(std::span<const Feature> features) {
  std::string out;
  std::uint64_t first_vertex = 1;
  for (const Feature& feature : features) {
    for (const SubmittedSolid& solid : feature.solids) {
      // Without its line "o", an object would be part of the one before it.
      const std::string name = object_name(feature, solid);
      if (!name.empty() || !out.empty()) out += "o " + name + '\n';
      auto status = append_obj(out, solid.solid, first_vertex);
      if (!status) return status.error();
      first_vertex += solid.solid.vertex_count();
    }
  }
  return out;
}

}  // namespace watertight::formats
