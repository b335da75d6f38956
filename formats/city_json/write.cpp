// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <charconv>
#include <set>
#include <utility>

#include "formats/city_json/appearance.h"
#include "formats/city_json/merge_headers.h"
#include "formats/city_json/model.h"
#include "formats/text/numbers.h"
#include "formats/text/text_layout.h"

namespace watertight::formats {
namespace {

Error unfit(std::string message) {
  return Error{ErrorCode::malformed, "skeleton and solids do not fit: " + std::move(message)};
}

std::optional<std::uint64_t> unsigned_of(const Json* value) {
  if (value == nullptr || !value->is_number_unsigned()) return std::nullopt;
  return value->get<std::uint64_t>();
}

// The texts "[x,y,z]" of the vertices of a document, one after the other in one string.
class VertexTexts {
 public:
  void resize(std::size_t count) { places_.resize(count); }
  std::size_t size() const { return places_.size(); }
  bool has(std::size_t vertex) const { return places_[vertex].size > 0; }
  std::string_view operator[](std::size_t vertex) const {
    const Place& place = places_[vertex];
    return std::string_view(texts_).substr(place.at, place.size);
  }
  void set(std::size_t vertex, std::string_view text) {
    places_[vertex] = {texts_.size(), text.size()};
    texts_ += text;
  }
  // False if the vertex has another text.
  bool agree(std::size_t vertex, std::string_view text) {
    if (has(vertex)) return (*this)[vertex] == text;
    set(vertex, text);
    return true;
  }

 private:
  struct Place {
    std::size_t at = 0;
    std::size_t size = 0;
  };
  std::string texts_;
  std::vector<Place> places_;
};

// A feature that is ready to be printed.
struct OpenFeature {
  CityModel model;
  const Feature* feature = nullptr;
  std::vector<std::vector<Index>> vertex_of;  // the document's vertices of each solid
  VertexTexts vertices;
  std::vector<std::size_t> faulty = {};  // those of elements that are no vertices, ascending
};

std::string vertex_text(const std::array<std::string, 3>& axes) {
  return '[' + axes[0] + ',' + axes[1] + ',' + axes[2] + ']';
}

void set_vertex_text(std::string& text, const std::array<std::int64_t, 3>& axes) {
  text = '[';
  append_integer(text, axes[0]);
  text += ',';
  append_integer(text, axes[1]);
  text += ',';
  append_integer(text, axes[2]);
  text += ']';
}

// Makes the texts of a solid's vertices: grid integers, or decimals with a point or an exponent.
// Calls `use` with each; stops where that returns false.
template <class Use>
Status for_each_vertex_text(const Solid& solid, const std::optional<geometry::Transform>& transform,
                            bool are_integers, Use use) {
  if (are_integers || transform) {
    auto integers = geometry::integers_under(solid.lattice(), solid.vertices(),
                                             transform.value_or(geometry::Transform{}));
    if (!integers) {
      return Error{ErrorCode::unsupported,
                   integers.error().message + ": the coordinates had to be rounded"};
    }
    std::string text;
    for (const std::array<std::int64_t, 3>& axes : *integers) {
      set_vertex_text(text, axes);
      if (!use(text)) break;
    }
    return Done{};
  }
  for (const Point& p : solid.vertices()) {
    std::array<std::string, 3> axes;
    for (int axis = 0; axis < 3; ++axis) {
      std::string& text = axes[static_cast<std::size_t>(axis)];
      text = solid.lattice().world_text(p[axis], axis);
      if (text.find_first_of(".e") == std::string::npos) text += ".0";
    }
    if (!use(vertex_text(axes))) break;
  }
  return Done{};
}

// The text of a skeleton's decimal for a document: "0.123" for "123e-3", "5.0" for "5".
std::string plain_decimal(const Json& value) {
  std::string text = json_text(value);
  if (const auto exact = exact_number(text); exact) text = plain_text(exact->value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

Status place_others(const Json& others, bool are_integers, OpenFeature& open) {
  std::size_t next = 0;
  if (!others.is_array()) return unfit("other vertices");
  for (std::size_t i = 0; i < open.vertices.size(); ++i) {
    if (open.vertices.has(i)) continue;
    if (next < others.size() && others[next].is_array()) {
      const Json& faulty = others[next++];
      if (faulty.size() != 1) return unfit("other vertices");
      open.vertices.set(i, json_text(faulty[0]));
      open.faulty.push_back(i);
      continue;
    }
    if (next + 3 > others.size()) return unfit("too few other vertices");
    std::array<std::string, 3> axes;
    for (std::string& axis : axes) {
      const Json& value = others[next++];
      if (!is_number_value(value)) return unfit("other vertices");
      axis = are_integers ? json_text(value) : plain_decimal(value);
    }
    open.vertices.set(i, vertex_text(axes));
  }
  if (next != others.size()) return unfit("too many other vertices");
  return Done{};
}

Status place_vertices(OpenFeature& open, const CityHeader& header) {
  const Json* vertices = find_member(open.model.root, "vertices");
  if (vertices == nullptr) return unfit("no vertices");
  const auto count = unsigned_of(find_member(*vertices, "count"));
  const Json* solids = find_member(*vertices, "solids");
  const Json* others = find_member(*vertices, "others");
  const std::string kind = string_member(*vertices, "kind");
  if (!count || solids == nullptr || !solids->is_array() || others == nullptr) {
    return unfit("vertices");
  }
  if (solids->size() != open.feature->solids.size()) return unfit("number of solids");

  std::uint64_t most = others->size();
  for (const SubmittedSolid& solid : open.feature->solids) most += solid.solid.vertex_count();
  if (*count > most) return unfit("number of vertices");
  open.vertices.resize(*count);
  for (std::size_t i = 0; i < solids->size(); ++i) {
    const Solid& solid = open.feature->solids[i].solid;
    auto vertex_of = read_vertex_runs((*solids)[i], *count, solid.vertex_count());
    if (!vertex_of) return vertex_of.error();
    bool agree = true;
    const Index* vertex = vertex_of->data();
    auto status = for_each_vertex_text(
        solid, header.transform, kind == "integers",
        [&](std::string_view text) { return agree = open.vertices.agree(*vertex++, text); });
    if (!status) return status;
    if (!agree) return unfit("solids disagree on a vertex");
    open.vertex_of.push_back(std::move(*vertex_of));
  }
  return place_others(*others, kind == "integers", open);
}

// The solids to which {"solid": k}, {"solids": [k, n]} or {"surface": k} in a skeleton refers.
struct SolidRange {
  std::size_t first = 0;
  std::size_t count = 0;
  bool is_single = false;
  bool is_surface = false;
};
std::optional<SolidRange> solid_range(const Json& reference, std::size_t solid_count) {
  if (const auto first = unsigned_of(find_member(reference, "solid")); first) {
    if (*first >= solid_count) return std::nullopt;
    return SolidRange{*first, 1, true};
  }
  if (const auto first = unsigned_of(find_member(reference, "surface")); first) {
    if (*first >= solid_count) return std::nullopt;
    return SolidRange{*first, 1, true, true};
  }
  const Json* range = find_member(reference, "solids");
  if (range == nullptr || !range->is_array() || range->size() != 2) return std::nullopt;
  const auto first = unsigned_of(&(*range)[0]);
  const auto count = unsigned_of(&(*range)[1]);
  if (!first || !count || *first > solid_count || *count > solid_count - *first) {
    return std::nullopt;
  }
  return SolidRange{*first, *count, false};
}

Status check_references(const OpenFeature& open) {
  const Json* objects = find_member(open.model.root, "CityObjects");
  if (objects == nullptr || !objects->is_object()) return unfit("no city objects");
  for (const auto& [id, object] : objects->get_ref<const Json::object_t&>()) {
    const Json* geometries = find_member(object, "geometry");
    if (geometries == nullptr || !geometries->is_array()) continue;
    for (const Json& geometry : *geometries) {
      const Json* boundaries = find_member(geometry, "boundaries");
      if (boundaries == nullptr || !boundaries->is_object()) continue;
      const auto range = solid_range(*boundaries, open.feature->solids.size());
      if (!range) return unfit("solid numbers");
      if (range->is_surface && open.feature->solids[range->first].solid.shell_count() != 1) {
        return unfit("a surface of several shells");
      }
    }
  }
  return Done{};
}

Result<OpenFeature> open_feature(const CityHeader& header, const Feature& feature) {
  const Limits& limits = kOwnText;
  auto model = parse_city_model(feature.skeleton, CityText::skeleton, limits);
  if (!model) return std::move(model).error();
  OpenFeature open{std::move(*model), &feature, {}, {}};
  if (auto status = place_vertices(open, header); !status) return status.error();
  if (auto status = check_references(open); !status) return status.error();
  return open;
}

// Puts the vertex "[x,y,z]" under another header.
Status map_vertex(VertexTexts& vertices, std::size_t vertex, const VertexMap& map) {
  __extension__ using Wide = __int128;
  constexpr std::int64_t kMost = (std::int64_t{1} << 53) - 1;
  const std::string text(vertices[vertex]);
  std::array<std::int64_t, 3> axes{};
  const char* next = text.data();
  const char* const end = next + text.size();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::int64_t value = 0;
    const auto [rest, error] = std::from_chars(next + 1, end, value);
    if (error != std::errc{} || rest == end) return unfit("vertices that are no integers");
    const Wide moved = Wide{value} * map.factor[axis] + map.shift[axis];
    if (moved > kMost || moved < -kMost) {
      return Error{ErrorCode::limit_exceeded,
                   "vertex " + text + " would be 2^53 or more under the header of the sequence"};
    }
    axes[axis] = static_cast<std::int64_t>(moved);
    next = rest;
  }
  std::string mapped;
  set_vertex_text(mapped, axes);
  vertices.set(vertex, mapped);
  return Done{};
}

void append_ring(std::string& out, std::span<const Index> ring, const std::vector<Index>& vertex_of,
                 std::uint64_t offset) {
  out += '[';
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (i > 0) out += ',';
    append_integer(out, vertex_of[ring[i]] + offset);
  }
  out += ']';
}

void append_facet(std::string& out, const Solid& solid, Index facet,
                  const std::vector<Index>& vertex_of, std::uint64_t offset) {
  out += '[';
  const IndexRange rings = solid.rings_of(facet);
  for (Index ring = rings.begin; ring < rings.end; ++ring) {
    if (ring > rings.begin) out += ',';
    append_ring(out, solid.ring(ring), vertex_of, offset);
  }
  out += ']';
}

void append_shell(std::string& out, const Solid& solid, Index shell,
                  const std::vector<Index>& vertex_of, std::uint64_t offset) {
  out += '[';
  const IndexRange facets = solid.facets_of(shell);
  for (Index facet = facets.begin; facet < facets.end; ++facet) {
    if (facet > facets.begin) out += ',';
    append_facet(out, solid, facet, vertex_of, offset);
  }
  out += ']';
}

void append_solid(std::string& out, const Solid& solid, const std::vector<Index>& vertex_of,
                  std::uint64_t offset) {
  out += '[';
  for (Index shell = 0; shell < solid.shell_count(); ++shell) {
    if (shell > 0) out += ',';
    append_shell(out, solid, shell, vertex_of, offset);
  }
  out += ']';
}

BoundaryPrinter boundary_printer(const OpenFeature& open, std::uint64_t offset) {
  return [&open, offset](const Json& boundaries, std::string& out) {
    if (!boundaries.is_object() && !boundaries.is_number_unsigned()) {
      return append_json(out, boundaries);
    }
    if (!boundaries.is_object()) {
      append_boundary(out, open.model.boundary(boundaries.get<std::size_t>()),
                      [offset](Index vertex) { return vertex + offset; });
      return;
    }
    const auto range = solid_range(boundaries, open.feature->solids.size()).value_or(SolidRange{});
    if (range.is_surface) {
      const Solid& surface = open.feature->solids[range.first].solid;
      return append_shell(out, surface, 0, open.vertex_of[range.first], offset);
    }
    if (!range.is_single) out += '[';
    for (std::size_t i = range.first; i < range.first + range.count; ++i) {
      if (i > range.first) out += ',';
      append_solid(out, open.feature->solids[i].solid, open.vertex_of[i], offset);
    }
    if (!range.is_single) out += ']';
  };
}

void append_vertices(std::string& out, const VertexTexts& vertices) {
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (i > 0) out += ',';
    out += vertices[i];
  }
}

// The text of a skeleton's own document, with the solids put back.
std::string print_whole(const OpenFeature& open) {
  std::string out = "{";
  for (const auto& [key, value] : open.model.root.get_ref<const Json::object_t&>()) {
    if (out.size() > 1) out += ',';
    append_json_string(out, key);
    out += ':';
    if (key == "CityObjects") {
      append_city_objects(out, value, boundary_printer(open, 0));
    } else if (key == "vertices") {
      out += '[';
      append_vertices(out, open.vertices);
      out += ']';
    } else {
      append_json(out, value);
    }
  }
  return out + '}';
}

Result<CityHeader> header_of(const Document& document, Json& root) {
  auto parsed = parse_json(document.header, kOwnText);
  if (!parsed) return std::move(parsed).error();
  auto header = city_header(*parsed);
  root = std::move(*parsed);
  return header;
}

// Shifts the vertex numbers in the locations of addresses.
Status shift_addresses(Json& object, std::uint64_t offset) {
  return for_each_address_vertex(object, [offset](Json& vertex) -> Status {
    if (vertex.is_number_unsigned()) vertex = vertex.get<std::uint64_t>() + offset;
    return Done{};
  });
}

// Merges many features into one CityJSON document.
class Merger {
 public:
  explicit Merger(const Json& header) : header_(header) {
    appearance_.include(find_member(header, "appearance"));
  }

  Status add(OpenFeature open) {
    const Json* source = find_member(open.model.root, "appearance");
    Json* objects = find_member(open.model.root, "CityObjects");
    for (auto& [id, object] : objects->get_ref<Json::object_t&>()) {
      if (!ids_.insert(id).second) {
        return Error{ErrorCode::malformed,
                     "two features have a city object of the same id",
                     {},
                     "/CityObjects" + pointer_token(id)};
      }
      if (auto status = shift_addresses(object, vertex_count_); !status) return status;
      if (source != nullptr) {
        adopt(object, source);
      }
      if (!objects_.empty()) objects_ += ',';
      append_json_string(objects_, id);
      objects_ += ':';
      append_city_object(objects_, object, boundary_printer(open, vertex_count_));
    }
    if (!vertices_.empty() && open.vertices.size() > 0) vertices_ += ',';
    append_vertices(vertices_, open.vertices);
    vertex_count_ += open.vertices.size();
    return Done{};
  }

  std::string finish() {
    std::string out = "{";
    for (const auto& [key, value] : header_.get_ref<const Json::object_t&>()) {
      if (key == "CityObjects" || key == "vertices" || key == "appearance") continue;
      append_json_string(out, key);
      out += ':';
      append_json(out, value);
      out += ',';
    }
    const Json appearance = appearance_.take(find_member(header_, "appearance"));
    if (!appearance.is_null()) {
      out += "\"appearance\":";
      append_json(out, appearance);
      out += ',';
    }
    return out + "\"CityObjects\":{" + objects_ + "},\"vertices\":[" + vertices_ + "]}";
  }

 private:
  void adopt(Json& object, const Json* source) {
    Json* geometries = find_member(object, "geometry");
    if (geometries == nullptr || !geometries->is_array()) return;
    for (Json& geometry : *geometries) static_cast<void>(appearance_.adopt(geometry, source));
  }

  const Json& header_;
  AppearanceCollector appearance_;
  std::set<std::string> ids_;
  std::string objects_;
  std::string vertices_;
  std::uint64_t vertex_count_ = 0;
};

bool is_whole(const Document& document) {
  return document.features.size() == 1 && document.features[0].type == "CityJSON";
}

}  // namespace

Result<std::vector<Index>> read_vertex_runs(const Json& runs, std::size_t vertex_count,
                                            std::size_t solid_vertex_count) {
  std::vector<Index> vertices;
  if (!runs.is_array() || runs.size() % 2 != 0) return unfit("vertex runs");
  for (std::size_t i = 0; i < runs.size(); i += 2) {
    const auto first = unsigned_of(&runs[i]);
    const auto length = unsigned_of(&runs[i + 1]);
    // A run must end within the document's vertices, and all runs together must not have more
    // vertices than the solid: hostile runs cannot make the list long. No sum can overflow here.
    if (!first || !length || *first > vertex_count || *length > vertex_count - *first ||
        *length > solid_vertex_count - vertices.size()) {
      return unfit("vertex runs");
    }
    for (std::uint64_t j = 0; j < *length; ++j) vertices.push_back(static_cast<Index>(*first + j));
  }
  if (vertices.size() != solid_vertex_count) return unfit("number of vertices");
  return vertices;
}

Result<std::string> write_city_json_feature(const CityHeader& header, const Feature& feature) {
  const auto plain = [&]() -> Result<std::string> {
    auto open = open_feature(header, feature);
    if (!open) return std::move(open).error();
    return print_whole(*open);
  };
  if (feature.layout.empty()) return plain();
  // The text of a document that was read is at most as long as the readers' limit.
  if (holds_whole_text(feature.layout)) return apply_layout({}, feature.layout, Limits{}.bytes);
  const auto text = plain();
  if (!text) return text;
  return apply_layout(*text, feature.layout, Limits{}.bytes);
}

Result<std::string> write_city_json_feature(const CityHeader& header, const Feature& feature,
                                            const VertexMap& map) {
  if (map.is_identity()) return write_city_json_feature(header, feature);
  auto open = open_feature(header, feature);
  if (!open) return std::move(open).error();
  for (std::size_t i = 0; i < open->vertices.size(); ++i) {
    if (std::binary_search(open->faulty.begin(), open->faulty.end(), i)) continue;
    if (auto status = map_vertex(open->vertices, i, map); !status) return status.error();
  }
  return print_whole(*open);
}

Result<std::string> write_city_json(const Document& document) {
  Json root;
  auto header = header_of(document, root);
  if (!header) return std::move(header).error();
  if (is_whole(document)) return write_city_json_feature(*header, document.features[0]);
  Merger merger(root);
  for (const Feature& feature : document.features) {
    auto open = open_feature(*header, feature);
    if (!open) return std::move(open).error();
    if (auto status = merger.add(std::move(*open)); !status) return status.error();
  }
  return merger.finish();
}

Result<std::string> write_city_json_seq(const Document& document) {
  if (is_whole(document)) {
    auto whole = write_city_json(document);
    if (!whole || is_lone_feature(*whole)) return whole;  // a file .jsonl may hold it as it is
    auto split = read_city_json(*whole, ReadOptions{.limits = kOwnText});
    if (!split) return std::move(split).error();
    return write_city_json_seq(*split);
  }
  Json root;
  auto header = header_of(document, root);
  if (!header) return std::move(header).error();
  if (!header->transform && document.format != Format::city_json_seq) {
    return Error{ErrorCode::unsupported,
                 "a CityJSONSeq needs a transform and this city model has none"};
  }
  FramingReader framing(document.framing);
  std::string out(framing.next_gap(false));
  out += document.header;
  for (const Feature& feature : document.features) {
    auto line = write_city_json_feature(*header, feature);
    if (!line) return line;
    out += framing.next_gap(false);
    out += *line;
  }
  out += framing.next_gap(true);
  if (!framing.is_finished()) return unfit("lines");
  return out;
}

}  // namespace watertight::formats
