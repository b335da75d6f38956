// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/geo_json/city_shapes.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <span>
#include <unordered_map>

#include "formats/city_json/boundary_cursor.h"
#include "formats/city_json/city_json.h"
#include "formats/city_json/model.h"
#include "formats/text/json.h"
#include "formats/text/numbers.h"

namespace watertight::formats {
namespace {

using Position = std::array<double, 3>;

constexpr double kNoLevel = -1;  // the rank of a geometry that states no level of detail

std::optional<double> number_of(const Json& value) {
  if (value.is_number()) return value.get<double>();
  if (!is_number_value(value)) return std::nullopt;
  const std::string text = json_text(value);
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

/// Three numbers; nothing for another value.
std::optional<Position> position_of(const Json& value) {
  if (!value.is_array() || value.size() != 3) return std::nullopt;
  Position position;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto number = number_of(value[axis]);
    if (!number) return std::nullopt;
    position[axis] = *number;
  }
  return position;
}

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
constexpr Position kNoPosition{kNoNumber, kNoNumber, kNoNumber};

/// The positions of an array of vertices; one that is no vertex is not finite.
std::vector<Position> positions_of(const Json* vertices) {
  std::vector<Position> positions;
  if (vertices == nullptr || !vertices->is_array()) return positions;
  positions.reserve(vertices->size());
  for (const Json& vertex : *vertices) {
    positions.push_back(position_of(vertex).value_or(kNoPosition));
  }
  return positions;
}

std::vector<Position> positions_of(const VertexList& vertices) {
  std::vector<Position> positions;
  positions.reserve(vertices.size());
  for (const auto& [x, y, z] : vertices.integers) {
    positions.push_back({static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
  }
  for (const auto& [x, y, z] : vertices.decimals) {
    positions.push_back({geometry::rounded(x), geometry::rounded(y), geometry::rounded(z)});
  }
  for (const FaultyVertex& faulty : vertices.faulty) positions[faulty.vertex] = kNoPosition;
  return positions;
}

/// Stands among boundaries for a value that is neither an array nor a vertex.
constexpr BoundaryToken kNoVertex = kClose - 1;
static_assert(kNoVertex >= kMostVertices);

/// Appends boundaries that are JSON values. Recursive; the reader's limit bounds the depth.
void append_tokens(const Json& value, std::vector<BoundaryToken>& tokens) {
  if (value.is_array()) {
    tokens.push_back(kOpen);
    for (const Json& element : value) append_tokens(element, tokens);
    tokens.push_back(kClose);
  } else if (value.is_number_unsigned() && value.get<std::uint64_t>() < kMostVertices) {
    tokens.push_back(static_cast<BoundaryToken>(value.get<std::uint64_t>()));
  } else {
    tokens.push_back(kNoVertex);
  }
}

/// The boundaries of a geometry of an object; empty without any. Those that have something else
/// than vertices were not captured: `own` receives them.
std::span<const BoundaryToken> boundaries_of(const CityModel& model, const Json& geometry,
                                             std::vector<BoundaryToken>& own) {
  const Json* boundaries = find_member(geometry, "boundaries");
  if (boundaries == nullptr) return {};
  if (boundaries->is_number_unsigned()) return model.boundary(boundaries->get<std::size_t>());
  append_tokens(*boundaries, own);
  return own;
}

/// The rank of a level of detail: higher ones are larger numbers.
double rank_of(std::string_view level) {
  double rank = kNoLevel;
  std::from_chars(level.data(), level.data() + level.size(), rank);
  return rank;
}

/// The place of a template: its positions times the matrix, moved by the anchor.
struct TemplatePlace {
  std::array<double, kMatrixSize> matrix{};  // row by row
  Position anchor{};

  Position apply(const Position& source) const {
    Position placed = anchor;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double* row = &matrix[axis * 4];
      placed[axis] += row[0] * source[0] + row[1] * source[1] + row[2] * source[2] + row[3];
    }
    return placed;
  }
};

FacetKind kind_named(std::string_view type) {
  if (type == "RoofSurface") return FacetKind::roof;
  if (type == "WallSurface") return FacetKind::wall;
  if (type == "GroundSurface") return FacetKind::ground;
  return FacetKind::other;
}

/// The semantics of a geometry: kinds, and which facet has which, in lists like its boundaries.
struct Semantics {
  std::vector<FacetKind> kinds;
  const Json* values = nullptr;

  static Semantics of(const Json& geometry) {
    Semantics semantics;
    const Json* member = find_member(geometry, "semantics");
    if (member == nullptr) return semantics;
    const Json* surfaces = find_member(*member, "surfaces");
    if (surfaces == nullptr || !surfaces->is_array()) return semantics;
    for (const Json& surface : *surfaces) {
      semantics.kinds.push_back(kind_named(string_member(surface, "type")));
    }
    semantics.values = find_member(*member, "values");
    return semantics;
  }

  FacetKind kind(const Json* value) const {
    if (value == nullptr || !value->is_number_unsigned()) return FacetKind::none;
    const auto index = value->get<std::uint64_t>();
    return index < kinds.size() ? kinds[index] : FacetKind::none;
  }
};

/// Adds geometries that refer to one list of positions, until there are kMostShownVertices.
class ShapeBuilder {
 public:
  /// All must outlive this object. `count` is the number of vertices of rings so far.
  ShapeBuilder(const std::vector<Position>& vertices, CityShapes& shapes, std::size_t& count,
               const TemplatePlace* place = nullptr)
      : vertices_(vertices), shapes_(shapes), count_(count), place_(place) {}

  /// Adds a geometry with its boundaries.
  void add(const Json& geometry, std::span<const BoundaryToken> boundaries) {
    if (boundaries.empty()) return;
    cursor_ = BoundaryCursor(boundaries);
    const std::string type = string_member(geometry, "type");
    semantics_ = Semantics::of(geometry);
    const Json* values = semantics_.values;
    if (type == "MultiLineString") {
      cursor_.for_each_element([&](std::size_t) {
        auto positions = take_ring(2);
        if (!positions.empty()) shapes_.lines.push_back(std::move(positions));
      });
    } else if (type == "MultiPoint") {
      for (const std::size_t position : take_ring(1)) shapes_.points.push_back(position);
    } else if (type == "MultiSurface" || type == "CompositeSurface") {
      add_surfaces(values);
    } else if (type == "Solid") {
      add_solid(values);
    } else if (type == "MultiSolid" || type == "CompositeSolid") {
      cursor_.for_each_element([&](std::size_t i) { add_solid(element_of(values, i)); });
    }
  }

 private:
  void add_solid(const Json* values) {
    std::vector<CityShapes::Shell> solid;
    cursor_.for_each_element([&](std::size_t i) {
      const std::size_t first = shapes_.polygons.size();
      add_surfaces(element_of(values, i));
      solid.push_back({first, shapes_.polygons.size() - first});
    });
    shapes_.solids.push_back(std::move(solid));
  }

  void add_surfaces(const Json* values) {
    cursor_.for_each_element(
        [&](std::size_t i) { add_surface(semantics_.kind(element_of(values, i))); });
  }

  /// Without the exterior ring there is no polygon: a hole would be one.
  void add_surface(FacetKind kind) {
    CityShapes::Polygon polygon;
    cursor_.for_each_element([&](std::size_t i) {
      if (i > 0 && polygon.empty()) {
        cursor_.take_elements();
        return;
      }
      auto positions = take_ring(3);
      if (!positions.empty()) polygon.push_back(std::move(positions));
    });
    if (polygon.empty()) return;
    shapes_.polygons.push_back(std::move(polygon));
    shapes_.kinds.push_back(kind);
  }

  /// The positions of a list of vertices; none if there are fewer than `least`, or one of them does
  /// not exist.
  CityShapes::Ring take_ring(std::size_t least) {
    const auto list = cursor_.take_elements();
    const auto exists = [&](BoundaryToken vertex) {
      return vertex < vertices_.size() && !std::isnan(vertices_[vertex][0]);
    };
    CityShapes::Ring ring;
    if (count_ > kMostShownVertices || list.size() < least ||
        !std::all_of(list.begin(), list.end(), exists)) {
      return ring;
    }
    count_ += list.size();
    ring.reserve(list.size());
    for (const BoundaryToken vertex : list) {
      const auto [place, is_new] = used_.try_emplace(vertex, shapes_.positions.size());
      if (is_new) {
        shapes_.positions.push_back(place_ ? place_->apply(vertices_[vertex]) : vertices_[vertex]);
      }
      ring.push_back(place->second);
    }
    return ring;
  }

  const std::vector<Position>& vertices_;
  CityShapes& shapes_;
  std::size_t& count_;
  const TemplatePlace* place_;
  BoundaryCursor cursor_;  // in the boundaries of the geometry in work
  Semantics semantics_;    // of the geometry in work
  std::unordered_map<BoundaryToken, std::size_t> used_;
};

/// The double nearest to `value` rounded to so many decimals. A quotient of two doubles that are
/// whole numbers is the nearest one.
double nearest_decimal(double value, int decimals) {
  constexpr int kMostExact = 22;  // 10^22 is the largest power of ten that is a double
  constexpr double kLargestExact = 9007199254740992;  // 2^53
  if (decimals > kMostExact) return value;
  double power = 1;
  for (int i = 0; i < decimals; ++i) power *= 10;
  const double units = std::round(value * power);
  return std::abs(units) < kLargestExact ? units / power : value;
}

/// The name and value of each attribute of an object.
void append_attributes(const Json& object, std::vector<std::pair<std::string, std::string>>& out) {
  const Json* attributes = find_member(object, "attributes");
  if (attributes == nullptr || !attributes->is_object()) return;
  for (const auto& [name, value] : attributes->items()) out.emplace_back(name, json_text(value));
}

/// The attributes of the top-level object, then those that its parts add without contradiction.
std::vector<std::pair<std::string, std::string>> merged_attributes(const Json& objects,
                                                                   std::string_view id) {
  std::vector<std::pair<std::string, std::string>> merged;
  const Json* top = find_member(objects, id);
  if (top != nullptr) append_attributes(*top, merged);
  std::unordered_map<std::string, std::size_t> places;
  for (std::size_t i = 0; i < merged.size(); ++i) places.emplace(merged[i].first, i);
  const std::size_t own = merged.size();
  std::vector<bool> differs(own, false);
  for (const Json& object : objects) {
    if (&object == top) continue;
    std::vector<std::pair<std::string, std::string>> added;
    append_attributes(object, added);
    for (auto& attribute : added) {
      const auto [place, is_new] = places.try_emplace(attribute.first, merged.size());
      if (is_new) {
        merged.push_back(std::move(attribute));
        differs.push_back(false);
      } else if (place->second >= own && merged[place->second].second != attribute.second) {
        differs[place->second] = true;
      }
    }
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < merged.size(); ++i) {
    if (differs[i]) continue;
    if (kept != i) merged[kept] = std::move(merged[i]);
    ++kept;
  }
  merged.resize(kept);
  return merged;
}

/// The value of a member that is an array of three numbers.
std::optional<std::array<GridNumber, 3>> three_numbers(const Json& object, std::string_view name) {
  const Json* list = find_member(object, name);
  if (list == nullptr || !list->is_array() || list->size() != 3) return std::nullopt;
  std::array<GridNumber, 3> numbers;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!is_number_value((*list)[axis])) return std::nullopt;
    const auto number = exact_number(json_text((*list)[axis]));
    if (!number) return std::nullopt;
    numbers[axis] = number->value;
  }
  return numbers;
}

/// A geometry of a city object and its level of detail.
struct Levelled {
  const Json* geometry;
  std::string level;
  double rank;
};

}  // namespace

CityFeature city_feature_of(const Feature& feature) {
  CityFeature made;
  made.id = feature.id;
  made.type = feature.type;
  CityShapes& shapes = made.shapes;
  std::size_t count = 0;
  for (const SubmittedSolid& submitted : feature.solids) {
    const Solid& solid = submitted.solid;
    count += solid.arrays().ring_vertices.size();
    made.is_too_large = count > kMostShownVertices;
    if (made.is_too_large) {
      shapes = {};
      return made;
    }
    const std::size_t first = shapes.positions.size();
    for (Index vertex = 0; vertex < solid.vertex_count(); ++vertex) {
      shapes.positions.push_back(solid.world(vertex));
    }
    std::vector<CityShapes::Shell> shells;
    for (Index shell = 0; shell < solid.shell_count(); ++shell) {
      const IndexRange facets = solid.facets_of(shell);
      const std::size_t before = shapes.polygons.size();
      for (Index facet = facets.begin; facet < facets.end; ++facet) {
        CityShapes::Polygon polygon;
        const IndexRange rings = solid.rings_of(facet);
        for (Index r = rings.begin; r < rings.end; ++r) {
          CityShapes::Ring ring;
          for (const Index vertex : solid.ring(r)) ring.push_back(first + vertex);
          const bool is_short = ring.size() < 3;
          if (is_short && polygon.empty()) break;
          if (!is_short) polygon.push_back(std::move(ring));
        }
        if (polygon.empty()) continue;
        shapes.polygons.push_back(std::move(polygon));
        shapes.kinds.push_back(FacetKind::none);
      }
      shells.push_back({before, shapes.polygons.size() - before});
    }
    shapes.solids.push_back(std::move(shells));
  }
  return made;
}

struct CityFeatureReader::Header {
  std::optional<std::array<int, 3>> decimals;
  Position scale{1, 1, 1};
  Position translate{};
  struct Template {
    Json geometry;
    std::vector<BoundaryToken> boundaries;
  };
  std::vector<Template> templates;
  std::vector<Position> template_vertices;

  /// The doubles nearest to the decimals that the transform gives; where it has none, to rounding.
  Position world(const Position& vertex) const {
    Position position;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      position[axis] = vertex[axis] * scale[axis] + translate[axis];
      if (decimals) position[axis] = nearest_decimal(position[axis], (*decimals)[axis]);
    }
    return position;
  }

  /// The template of an instance; null for other geometries.
  const Template* template_of(const Json& geometry) const {
    const Json* number = find_member(geometry, "template");
    if (number == nullptr || !number->is_number_unsigned()) return nullptr;
    const auto index = number->get<std::uint64_t>();
    return index < templates.size() ? &templates[index] : nullptr;
  }

  std::vector<Levelled> geometries_of(const Json& object) const;
  void add_instance(const Json& geometry, std::span<const BoundaryToken> boundaries,
                    const std::vector<Position>& vertices, CityShapes& shapes,
                    std::size_t& count) const;
  void add_shapes(const CityModel& model, const Json& objects, std::optional<std::string_view> lod,
                  CityFeature& feature) const;
};

/// The geometries of a city object. An instance has the level of its template.
std::vector<Levelled> CityFeatureReader::Header::geometries_of(const Json& object) const {
  std::vector<Levelled> geometries;
  const Json* list = find_member(object, "geometry");
  if (list == nullptr || !list->is_array()) return geometries;
  for (const Json& geometry : *list) {
    const Template* shape = template_of(geometry);
    std::string level = level_of(shape == nullptr ? geometry : shape->geometry);
    const double rank = rank_of(level);
    geometries.push_back({&geometry, std::move(level), rank});
  }
  return geometries;
}

/// Places a template at the vertex of an instance, which is its boundaries.
void CityFeatureReader::Header::add_instance(const Json& geometry,
                                             std::span<const BoundaryToken> boundaries,
                                             const std::vector<Position>& vertices,
                                             CityShapes& shapes, std::size_t& count) const {
  const Template* shape = template_of(geometry);
  const Json* matrix = find_member(geometry, "transformationMatrix");
  if (count > kMostShownVertices || shape == nullptr || boundaries.size() != 3 ||
      boundaries[1] >= vertices.size() || std::isnan(vertices[boundaries[1]][0]) ||
      matrix == nullptr || !matrix->is_array() || matrix->size() != kMatrixSize) {
    return;
  }
  TemplatePlace place;
  place.anchor = vertices[boundaries[1]];
  for (std::size_t i = 0; i < kMatrixSize; ++i) {
    place.matrix[i] = number_of((*matrix)[i]).value_or(0);
  }
  shapes.decimals.reset();
  ShapeBuilder(template_vertices, shapes, count, &place).add(shape->geometry, shape->boundaries);
}

/// Adds the geometries of all objects at the level of detail that is shown.
void CityFeatureReader::Header::add_shapes(const CityModel& model, const Json& objects,
                                           std::optional<std::string_view> lod,
                                           CityFeature& feature) const {
  std::vector<Position> vertices = positions_of(model.vertices);
  for (Position& vertex : vertices) vertex = world(vertex);
  feature.shapes.decimals = decimals;
  double highest = kNoLevel;
  for (const Json& object : objects) {
    for (const Levelled& found : geometries_of(object)) highest = std::max(highest, found.rank);
  }
  std::size_t count = 0;
  ShapeBuilder builder(vertices, feature.shapes, count);
  for (const Json& object : objects) {
    const auto geometries = geometries_of(object);
    double best = kNoLevel;
    for (const Levelled& found : geometries) best = std::max(best, found.rank);
    const bool is_footprint_only = best >= 0 && best < 1 && highest >= 1;
    if (!lod && is_footprint_only) continue;
    for (const auto& [geometry, level, rank] : geometries) {
      if (lod ? level != *lod : rank != best) continue;
      std::vector<BoundaryToken> own;
      const auto boundaries = boundaries_of(model, *geometry, own);
      if (string_member(*geometry, "type") == "GeometryInstance") {
        add_instance(*geometry, boundaries, vertices, feature.shapes, count);
      } else {
        builder.add(*geometry, boundaries);
      }
    }
  }
  feature.is_too_large = count > kMostShownVertices;
  if (feature.is_too_large) feature.shapes = {};
}

CityFeatureReader::CityFeatureReader(std::unique_ptr<Header> header) : header_(std::move(header)) {}
CityFeatureReader::CityFeatureReader(CityFeatureReader&&) noexcept = default;
CityFeatureReader& CityFeatureReader::operator=(CityFeatureReader&&) noexcept = default;
CityFeatureReader::~CityFeatureReader() = default;

Result<CityFeatureReader> CityFeatureReader::make(std::string_view header, const Limits& limits) {
  auto parsed = parse_json(header, limits);
  if (!parsed) return std::move(parsed).error();
  auto made = std::make_unique<Header>();
  if (const Json* transform = find_member(*parsed, "transform")) {
    const auto scale = three_numbers(*transform, "scale");
    const auto translate = three_numbers(*transform, "translate");
    if (!scale || !translate) {
      return Error{
          ErrorCode::malformed, "the transform has no scale and translate", {}, "/transform"};
    }
    made->decimals.emplace();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      made->scale[axis] = geometry::rounded((*scale)[axis]);
      made->translate[axis] = geometry::rounded((*translate)[axis]);
      (*made->decimals)[axis] =
          std::max({0, -(*scale)[axis].exponent, -(*translate)[axis].exponent});
    }
  }
  if (const Json* templates = find_member(*parsed, "geometry-templates")) {
    const Json* list = find_member(*templates, "templates");
    if (list != nullptr && list->is_array()) {
      for (const Json& geometry : *list) {
        auto& added = made->templates.emplace_back(Header::Template{geometry, {}});
        const Json* boundaries = find_member(geometry, "boundaries");
        if (boundaries != nullptr) append_tokens(*boundaries, added.boundaries);
      }
    }
    made->template_vertices = positions_of(find_member(*templates, "vertices-templates"));
  }
  return CityFeatureReader(std::move(made));
}

std::vector<std::pair<std::string, std::string>> city_attributes(std::string_view feature,
                                                                 std::string_view id,
                                                                 const Limits& limits) {
  const auto parsed = parse_json(feature, limits);
  if (!parsed) return {};
  const Json* objects = find_member(*parsed, "CityObjects");
  if (objects == nullptr || !objects->is_object()) return {};
  return merged_attributes(*objects, id);
}

Result<CityFeature> CityFeatureReader::read(std::string_view feature,
                                            std::optional<std::string_view> lod,
                                            const Limits& limits) const {
  const auto model = parse_city_model(feature, CityText::document, limits);
  if (!model) return model.error();
  CityFeature read;
  auto id = feature_id(model->root);
  if (!id) return std::move(id).error();
  read.id = *std::move(id);
  const Json* objects = find_member(model->root, "CityObjects");
  if (objects == nullptr || !objects->is_object()) {
    return malformed_at("CityObjects is missing or not an object", "/CityObjects");
  }
  if (!model->vertices.is_present) {
    return malformed_at("vertices is missing or not an array", "/vertices");
  }
  if (const Json* top = find_member(*objects, read.id)) read.type = string_member(*top, "type");
  read.attributes = merged_attributes(*objects, read.id);
  header_->add_shapes(*model, *objects, lod, read);
  return read;
}

}  // namespace watertight::formats
