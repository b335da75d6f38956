// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "base/ascii.h"
#include "formats/city_json/city_json.h"
#include "formats/document.h"
#include "formats/mesh/mesh_text.h"
#include "formats/part21/part21.h"

namespace watertight::formats {
namespace {

struct Ending {
  std::string_view text;
  Format format;
};
constexpr std::array kEndings{
    Ending{".brep.json", Format::brep},
    Ending{".bpt", Format::bpt},
    Ending{".jsonl", Format::city_json_seq},
    Ending{".ndjson", Format::city_json_seq},
    Ending{".stl", Format::stl},
    Ending{".ply", Format::ply},
    Ending{".poly", Format::poly},
    Ending{".obj", Format::obj},
    Ending{".off", Format::off},
    Ending{".wkt", Format::wkt},
    Ending{".ewkt", Format::wkt},
    Ending{".wkb", Format::ewkb},
    Ending{".ewkb", Format::ewkb},
    Ending{".gml", Format::gml},
    Ending{".citygml", Format::gml},
    Ending{".xml", Format::gml},
    Ending{".ifc", Format::ifc},
    Ending{".step", Format::step},
    Ending{".stp", Format::step},
    Ending{".p21", Format::step},
};

// Where the string that starts at `at` ends: the position of its closing quote, or npos.
std::size_t string_end(std::string_view text, std::size_t at) {
  for (++at; at < text.size(); ++at) {
    if (text[at] == '\\') {
      ++at;
    } else if (text[at] == '"') {
      return at;
    }
  }
  return std::string_view::npos;
}

// The value of the top-level member "type", as written; "" when there is none in the text.
std::string_view json_type(std::string_view text) {
  std::size_t depth = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] != '"' && text[at] < '[') continue;  // skips numbers and everything between values
    if (text[at] == '{' || text[at] == '[') ++depth;
    if ((text[at] == '}' || text[at] == ']') && depth > 0) --depth;
    if (text[at] != '"') continue;
    const std::size_t end = string_end(text, at);
    if (end == std::string_view::npos) return {};
    const bool is_type = depth == 1 && text.substr(at + 1, end - at - 1) == "type";
    const std::size_t colon = text.find_first_not_of(" \t\r\n", end + 1);
    at = end;
    if (!is_type || colon == std::string_view::npos || text[colon] != ':') continue;
    const std::size_t value = text.find_first_not_of(" \t\r\n", colon + 1);
    if (value == std::string_view::npos || text[value] != '"') return {};
    const std::size_t value_end = string_end(text, value);
    if (value_end == std::string_view::npos) return {};
    return text.substr(value + 1, value_end - value - 1);
  }
  return {};
}

// The format of a JSON text by its type, which CityJSON, CityJSONSeq and GeoJSON (and so JSON-FG)
// have. A sequence has a second JSON text after the line that ends the first one.
Format json_format(std::string_view text) {
  const std::string_view type = json_type(text);
  if (type == "BRep") return Format::brep;
  if (type == "Feature" || type == "FeatureCollection") return Format::json_fg;
  const std::size_t end = text.find('\n');
  if (end == std::string_view::npos) return Format::city_json;
  std::string_view first = text.substr(0, end);
  while (!first.empty() && (first.back() == '\r' || first.back() == ' ')) first.remove_suffix(1);
  const std::size_t second = text.find_first_not_of(" \t\r\n\x1E", end);
  const bool is_sequence = first.size() > 1 && first.back() == '}' &&
                           second != std::string_view::npos && text[second] == '{';
  return is_sequence ? Format::city_json_seq : Format::city_json;
}

bool is_utf16_xml(std::string_view text) {
  return text.starts_with("\xFF\xFE<") || text.starts_with(std::string_view("\xFE\xFF\0<", 4));
}

bool is_obj_line(std::string_view text) {
  for (const std::string_view word : {"v", "vn", "vt", "f", "o", "g", "mtllib", "usemtl", "s"}) {
    if (text.size() > word.size() && text.starts_with(word) &&
        (text[word.size()] == ' ' || text[word.size()] == '\t')) {
      return true;
    }
  }
  return false;
}

// Whether the text begins with "solid NAME", followed by "facet" or "endsolid" in the next line
// that is not blank. WKT goes on with a bracket.
bool is_text_stl_head(std::string_view text) {
  if (lower_case(text.substr(0, 5)) != "solid") return false;
  const std::size_t line_end = text.find('\n');
  if (line_end == std::string_view::npos) return false;
  const std::size_t next = text.find_first_not_of(" \t\r\n", line_end);
  if (next == std::string_view::npos) return false;
  const std::string word = lower_case(text.substr(next, 8));
  return word.starts_with("facet") || word == "endsolid";
}

// The format by the first bytes of the first line that is neither blank nor a comment.
Result<Format> format_of_text(std::string_view text) {
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  std::size_t start = text.find_first_not_of(" \t\r\n\x1E");
  while (start != std::string_view::npos && text[start] == '#') {
    start = text.find('\n', start);
    if (start != std::string_view::npos) start = text.find_first_not_of(" \t\r\n", start);
  }
  if (start != std::string_view::npos) {
    text.remove_prefix(start);
    if (text.front() == '{') return json_format(text);
    if (text.front() == '<' || is_utf16_xml(text)) return Format::gml;
    if (is_text_stl_head(text)) return Format::stl;
    if (is_part21(text)) {
      const std::size_t schema = text.find("FILE_SCHEMA");
      const bool is_ifc = schema != std::string_view::npos &&
                          text.substr(schema, 64).find("IFC") != std::string_view::npos;
      return is_ifc ? Format::ifc : Format::step;
    }
    if (text.starts_with("ply\n") || text.starts_with("ply\r\n")) return Format::ply;
    const std::string head = lower_case(text.substr(0, 24));
    for (const std::string_view word : {"srid=", "polyhedralsurface", "solid", "tin"}) {
      if (head.starts_with(word)) return Format::wkt;
    }
    for (const std::string_view word : {"off", "coff", "noff", "cnoff", "stoff"}) {
      if (head.starts_with(word)) return Format::off;
    }
    if (is_obj_line(text)) return Format::obj;
  }
  return Error{
      ErrorCode::unsupported,
      "neither the file name nor the first bytes show the format; known formats: CityJSON, "
      "CityJSONSeq, JSON-FG, GML, OBJ, OFF, STL, PLY, POLY, IFC, STEP, "
      "BRep, BPT, WKT and EWKB"};
}

}  // namespace

bool is_lone_feature(std::string_view text) {
  const std::size_t start = text.find_first_not_of(" \t\r\n\x1E\xEF\xBB\xBF");
  if (start == std::string_view::npos || text[start] != '{') return false;
  text.remove_prefix(start);
  if (json_type(text) != "CityJSONFeature") return false;
  const std::size_t line_end = std::min(text.find('\n'), text.size());
  const std::size_t last = text.find_last_not_of(" \t\r", line_end > 0 ? line_end - 1 : 0);
  const bool is_line_whole = last != std::string_view::npos && text[last] == '}';
  return !is_line_whole ||
         text.find_first_not_of(" \t\r\n\x1E", line_end) == std::string_view::npos;
}

bool has_known_ending(std::string_view file_name) {
  const std::string name = lower_case(file_name);
  const auto is_its = [&](const Ending& ending) { return name.ends_with(ending.text); };
  return std::any_of(kEndings.begin(), kEndings.end(), is_its) || name.ends_with(".json") ||
         name.ends_with(".geojson") || name.ends_with(".jsonfg");
}

Result<Format> detect_format(std::string_view file_name, ByteView bytes) {
  const std::string name = lower_case(file_name);
  for (const Ending& ending : kEndings) {
    if (!name.ends_with(ending.text)) continue;
    const bool is_sequence = ending.format == Format::city_json_seq;
    return is_sequence && is_lone_feature(as_text(bytes)) ? Format::city_json : ending.format;
  }
  if (name.ends_with(".geojson") || name.ends_with(".jsonfg")) return Format::json_fg;
  if (name.ends_with(".json")) return json_format(as_text(bytes));
  if (is_binary_stl(bytes)) return Format::stl;
  // EWKB begins with the byte order 0 or 1, which no text does.
  if (bytes.size() >= 9 && bytes[0] <= 1) return Format::ewkb;
  return format_of_text(as_text(bytes));
}

}  // namespace watertight::formats
