// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/gml/written/object_geometry.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "formats/city_json/boundary_cursor.h"
#include "formats/city_json/model.h"
#include "geometry/lattice/lattice.h"

namespace watertight::formats {
namespace {

constexpr int kUnstatedLevel = 1;  // the reader takes the same

/// The number that a level of detail is; that of none for another text.
double level_number(std::string_view level) {
  double number = -1;  // below all levels
  std::from_chars(level.data(), level.data() + level.size(), number);
  return number;
}

bool is_lower(const std::string& a, const std::string& b) {
  return std::pair(level_number(a), a) < std::pair(level_number(b), b);
}

/// The place of a geometry by its type and level. Nothing for a type that CityGML does not have.
std::optional<LevelAndClass> place_of(std::string_view type, std::string_view level) {
  const double stated = level_number(level);
  const double number = stated < 0 ? kUnstatedLevel : stated;
  const int digit = static_cast<int>(std::clamp(std::floor(number), 0.0, double{kMostLevel}));
  if (type == "Solid" || type == "MultiSolid" || type == "CompositeSolid") {
    return LevelAndClass{digit, GeometryClass::solids};
  }
  if (type == "MultiSurface" || type == "CompositeSurface") {
    return LevelAndClass{digit, GeometryClass::surfaces};
  }
  if (type == "MultiLineString") return LevelAndClass{digit, GeometryClass::lines};
  if (type == "MultiPoint") return LevelAndClass{digit, GeometryClass::points};
  return std::nullopt;
}

/// Adds the boundaries of geometries to the one that is written.
class GeometryAdder {
 public:
  GeometryAdder(const CityModel& model, const VertexTexts& vertices, GmlLeftOut& left_out)
      : model_(model), vertices_(vertices), left_out_(left_out) {}

  void add(const Json& geometry, WrittenGeometry& out) {
    const Json* boundaries = find_member(geometry, "boundaries");
    if (boundaries == nullptr || !boundaries->is_number_unsigned()) {
      ++left_out_["geometries that cannot be read"];
      return;
    }
    cursor_ = BoundaryCursor(model_.boundary(boundaries->get<std::size_t>()));
    const Values values = values_of(geometry);
    const std::string type = string_member(geometry, "type");
    if (type == "Solid") {
      add_solid(values, out);
    } else if (type == "MultiSolid" || type == "CompositeSolid") {
      cursor_.for_each_element([&](std::size_t i) { add_solid(parts(values, i), out); });
    } else if (type == "MultiLineString") {
      cursor_.for_each_element([&](std::size_t) { add_line(2, out.lines); });
    } else if (type == "MultiPoint") {
      add_line(1, out.lines);
    } else {
      add_facets(values, out);
    }
  }

 private:
  /// The lists that have a value for each facet: the semantics, then those of looks_.
  using Values = std::vector<const Json*>;

  static Values parts(const Values& values, std::size_t index) {
    Values found;
    found.reserve(values.size());
    for (const Json* list : values) found.push_back(element_of(list, index));
    return found;
  }

  /// The lists of a geometry; sets surfaces_ and looks_.
  Values values_of(const Json& geometry) {
    const Json* semantics = find_member(geometry, "semantics");
    surfaces_ = semantics == nullptr ? nullptr : find_member(*semantics, "surfaces");
    Values values{semantics == nullptr ? nullptr : find_member(*semantics, "values")};
    looks_.clear();
    for (const char* kind : {"material", "texture"}) {
      const Json* themes = find_member(geometry, kind);
      if (themes == nullptr || !themes->is_object()) continue;
      for (const auto& [theme, look] : themes->items()) {
        looks_.push_back({theme, kind == std::string_view("texture"), find_member(look, "value")});
        values.push_back(find_member(look, "values"));
      }
    }
    return values;
  }

  void add_solid(const Values& values, WrittenGeometry& out) {
    std::vector<std::size_t> shells;
    cursor_.for_each_element([&](std::size_t i) {
      const std::size_t before = out.facets.size();
      add_facets(parts(values, i), out);
      shells.push_back(out.facets.size() - before);
    });
    out.solids.push_back(std::move(shells));
  }

  void add_facets(const Values& values, WrittenGeometry& out) {
    cursor_.for_each_element([&](std::size_t i) {
      WrittenFacet facet;
      std::size_t rings = 0;
      cursor_.for_each_element([&](std::size_t) {
        add_line(1, facet.rings);
        ++rings;
      });
      if (facet.rings.empty()) return;
      const Json* value = element_of(values.front(), i);
      if (value != nullptr && value->is_number_unsigned() && surfaces_ != nullptr) {
        facet.semantics = element_of(surfaces_, value->get<std::size_t>());
        facet.surfaces = surfaces_;
      }
      const bool is_whole = facet.rings.size() == rings;  // else textures are those of other rings
      for (std::size_t k = 0; k < looks_.size() && is_whole; ++k) {
        FacetLook look = looks_[k];
        if (look.value == nullptr) look.value = element_of(values[k + 1], i);
        if (look.value != nullptr && !look.value->is_null()) facet.looks.push_back(look);
      }
      out.facets.push_back(std::move(facet));
    });
  }

  void add_line(std::size_t least, std::vector<std::vector<BoundaryToken>>& lines) {
    const auto list = cursor_.take_elements();
    const bool is_readable =
        list.size() >= least && std::ranges::all_of(list, [&](BoundaryToken vertex) {
          return vertex < vertices_.texts.size() && !vertices_.texts[vertex].empty();
        });
    if (is_readable) {
      lines.emplace_back(list.begin(), list.end());
    } else {
      ++left_out_["rings without vertices"];
    }
  }

  const CityModel& model_;
  const VertexTexts& vertices_;
  GmlLeftOut& left_out_;
  BoundaryCursor cursor_;
  const Json* surfaces_ = nullptr;  // of the semantics of the geometry in work
  std::vector<FacetLook> looks_;    // of the geometry in work: the value that all facets have
};

}  // namespace

Result<VertexTexts> VertexTexts::of(const CityModel& model, const geometry::Transform& transform) {
  VertexTexts made;
  VertexList list = model.vertices;
  made.texts.resize(list.size());
  if (list.size() == list.faulty.size()) return made;
  Index good = 0;  // faulty vertices take its place, so that the box does not have them
  for (const FaultyVertex& faulty : list.faulty) {
    if (faulty.vertex == good) ++good;
  }
  for (const FaultyVertex& faulty : list.faulty) {
    if (list.are_integers) {
      list.integers[faulty.vertex] = list.integers[good];
    } else {
      list.decimals[faulty.vertex] = list.decimals[good];
    }
  }
  const auto points = list.are_integers ? geometry::lattice_of_integers(list.integers, transform)
                                        : geometry::lattice_of_decimals(list.decimals);
  if (!points) return points.error();
  for (int axis = 0; axis < 3; ++axis) {
    const auto place = static_cast<std::size_t>(axis);
    const auto text = [&](const Point& point) {
      return points->lattice.world_text(point[axis], axis);
    };
    const auto less = [&](const Point& a, const Point& b) { return a[axis] < b[axis]; };
    const auto [least, most] =
        std::minmax_element(points->points.begin(), points->points.end(), less);
    made.least[place] = {points->lattice.world((*least)[axis], axis), text(*least)};
    made.most[place] = {points->lattice.world((*most)[axis], axis), text(*most)};
    for (std::size_t vertex = 0; vertex < made.texts.size(); ++vertex) {
      made.texts[vertex].append(axis > 0 ? " " : "").append(text(points->points[vertex]));
    }
  }
  for (const FaultyVertex& faulty : list.faulty) made.texts[faulty.vertex].clear();
  made.has_box = true;
  return made;
}

void VertexTexts::join_box(const VertexTexts& other) {
  if (!other.has_box) return;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!has_box || other.least[axis].value < least[axis].value) least[axis] = other.least[axis];
    if (!has_box || other.most[axis].value > most[axis].value) most[axis] = other.most[axis];
  }
  has_box = true;
}

std::map<LevelAndClass, WrittenGeometry> written_geometries(const CityModel& model,
                                                            const Json& object,
                                                            const VertexTexts& vertices,
                                                            GmlLeftOut& left_out) {
  std::map<LevelAndClass, WrittenGeometry> written;
  const Json* list = find_member(object, "geometry");
  if (list == nullptr || !list->is_array()) return written;
  for (const Json& geometry : *list) {
    const auto place = place_of(string_member(geometry, "type"), level_of(geometry));
    if (!place) continue;
    std::string& level = written[*place].level;
    level = std::max(level, level_of(geometry), is_lower);
  }
  GeometryAdder adder(model, vertices, left_out);
  for (const Json& geometry : *list) {
    const std::string type = string_member(geometry, "type");
    const std::string level = level_of(geometry);
    const auto place = place_of(type, level);
    if (!place) {
      ++left_out["geometries of type " + type];
      continue;
    }
    WrittenGeometry& chosen = written[*place];
    if (chosen.level != level) {
      ++left_out["geometries of level of detail " + level];
      continue;
    }
    if (chosen.type.empty()) chosen.type = type;
    if (level != std::to_string(place->first)) ++left_out["the level of detail as " + level];
    adder.add(geometry, chosen);
  }
  return written;
}

void write_point(XmlText& xml, std::string_view position) {
  xml.open("gml:pointMember");
  xml.open("gml:Point");
  xml.leaf("gml:pos", position, {{"srsDimension", "3"}});
  xml.close();
  xml.close();
}

}  // namespace watertight::formats
