// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/json_fg.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/quantity.h"
#include "formats/surface.h"
#include "formats/text/json.h"
#include "formats/text/numbers.h"

namespace watertight::formats {
namespace {

Error wrong(std::string message, std::string pointer) {
  return Error{ErrorCode::malformed, std::move(message), {}, std::move(pointer)};
}

/// Reads the solids of one place, which share a lattice.
class PlaceReader {
 public:
  PlaceReader(std::uint32_t srid, const Limits& limits) : srid_(srid), limits_(limits) {}

  /// Reads the coordinates of one polyhedron: shells of polygons of rings of positions.
  Status polyhedron(const Json& shells, SolidSource source) {
    if (!shells.is_array()) return wrong("a polyhedron is an array of shells", source.pointer);
    Part part;
    part.source = std::move(source);
    part.begin = positions_.size();
    for (std::size_t shell = 0; shell < shells.size(); ++shell) {
      const std::string pointer = part.source.pointer + pointer_token(shell);
      if (auto status = polygons(shells[shell], pointer, part); !status) return status;
      part.arrays.end_shell();
    }
    part.end = positions_.size();
    parts_.push_back(std::move(part));
    return Done{};
  }

  Result<std::vector<SubmittedSolid>> finish() {
    auto points = geometry::lattice_of_decimals(positions_);
    if (!points) return std::move(points).error();
    for (const Index position : points->rounded) is_rounded_[position] = true;
    std::vector<SubmittedSolid> solids;
    for (Part& part : parts_) {
      geometry::LatticePoints own{points->lattice, {}, {}};
      for (std::size_t i = part.begin; i < part.end; ++i) {
        if (is_rounded_[i]) own.rounded.push_back(static_cast<Index>(i - part.begin));
        own.points.push_back(points->points[i]);
      }
      auto solid =
          solid_of_points(std::move(part.arrays), own, std::move(part.source), srid_, limits_);
      if (!solid) return std::move(solid).error();
      solid->unclosed_rings = std::move(part.unclosed_rings);
      solids.push_back(std::move(*solid));
    }
    return solids;
  }

 private:
  struct Part {
    SolidArrays arrays;     // ring vertices are positions, counted from `begin`
    std::size_t begin = 0;  // index of the first position in positions_
    std::size_t end = 0;
    SolidSource source;
    std::vector<Index> unclosed_rings;
  };

  Status polygons(const Json& shell, const std::string& pointer, Part& part) {
    if (!shell.is_array()) return wrong("a shell is an array of polygons", pointer);
    for (std::size_t i = 0; i < shell.size(); ++i) {
      const Json& polygon = shell[i];
      const std::string place = pointer + pointer_token(i);
      if (!polygon.is_array()) return wrong("a polygon is an array of rings", place);
      for (std::size_t j = 0; j < polygon.size(); ++j) {
        if (auto status = ring(polygon[j], place + pointer_token(j), part); !status) return status;
      }
      part.arrays.end_facet();
    }
    return Done{};
  }

  // A ring repeats its first position at its end; the repetition is dropped.
  Status ring(const Json& ring, const std::string& pointer, Part& part) {
    if (!ring.is_array()) return wrong("a ring is an array of positions", pointer);
    if (positions_.size() + ring.size() >= kNone - 1) {
      return Error{
          ErrorCode::limit_exceeded, "more positions than a 32-bit index can name", {}, pointer};
    }
    const std::size_t first = positions_.size();
    for (std::size_t i = 0; i < ring.size(); ++i) {
      if (auto status = position(ring[i], pointer, i); !status) return status;
    }
    if (ring.size() > 1 && positions_.back() == positions_[first]) {
      positions_.pop_back();
      is_rounded_.pop_back();
    } else if (!ring.empty()) {
      part.unclosed_rings.push_back(static_cast<Index>(part.arrays.ring_offsets.size() - 1));
    }
    for (std::size_t i = first; i < positions_.size(); ++i) {
      part.arrays.ring_vertices.push_back(static_cast<Index>(i - part.begin));
    }
    part.arrays.end_ring();
    return Done{};
  }

  Status position(const Json& value, const std::string& ring, std::size_t number) {
    if (!value.is_array() || value.size() != 3) {
      return wrong("a position of a polyhedron is an array of three numbers",
                   ring + pointer_token(number));
    }
    std::array<GridNumber, 3> at;
    bool is_rounded = false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!is_number_value(value[axis])) {
        return wrong("not a number", ring + pointer_token(number) + pointer_token(axis));
      }
      auto exact = exact_number(json_text(value[axis]));
      if (!exact) {
        return wrong(exact.error().message, ring + pointer_token(number) + pointer_token(axis));
      }
      at[axis] = exact->value;
      is_rounded = is_rounded || exact->is_rounded;
    }
    is_rounded_.push_back(is_rounded);
    positions_.push_back(at);
    return Done{};
  }

  std::uint32_t srid_;
  const Limits& limits_;
  std::vector<std::array<GridNumber, 3>> positions_;
  std::vector<bool> is_rounded_;
  std::vector<Part> parts_;
};

class JsonFgReader {
 public:
  explicit JsonFgReader(const Limits& limits) : limits_(limits) {
    document_.format = Format::json_fg;
  }

  Result<Document> read(const Json& root) {
    const std::string type = string_member(root, "type");
    Status status = Done{};
    if (type == "Feature") {
      status = feature(root, nullptr, "");
    } else if (type == "FeatureCollection") {
      status = features(root);
    } else {
      status = wrong("the type is neither \"Feature\" nor \"FeatureCollection\"", "/type");
    }
    if (!status) return std::move(status).error();
    if (document_.features.empty() && (left_out_ > 0 || fallbacks_ > 0)) return nothing_to_read();
    if (left_out_ > 0) {
      document_.notes.push_back(quantity(left_out_, "feature") +
                                " without a polyhedron as place left out");
    }
    if (fallbacks_ > 0) {
      document_.notes.push_back("geometry ignored where place is given");
    }
    return std::move(document_);
  }

 private:
  Error nothing_to_read() const {
    return Error{ErrorCode::unsupported,
                 "no feature has a place of type Polyhedron or MultiPolyhedron: plain GeoJSON "
                 "holds no solids",
                 {},
                 {}};
  }

  Status features(const Json& root) {
    const Json* features = find_member(root, "features");
    if (features == nullptr || !features->is_array()) {
      return wrong("features is missing or not an array", "/features");
    }
    const Json* crs = find_member(root, "coordRefSys");
    for (std::size_t i = 0; i < features->size(); ++i) {
      const std::string pointer = "/features" + pointer_token(i);
      if (string_member((*features)[i], "type") != "Feature") {
        return wrong("the type is not \"Feature\"", pointer + "/type");
      }
      if (auto status = feature((*features)[i], crs, pointer); !status) return status;
    }
    return Done{};
  }

  // The id as text: a string, or a number as written.
  static std::string id_of(const Json& feature) {
    const Json* id = find_member(feature, "id");
    if (id == nullptr) return {};
    if (id->is_string()) return id->get<std::string>();
    return is_number_value(*id) ? json_text(*id) : std::string();
  }

  Status feature(const Json& value, const Json* collection_crs, const std::string& pointer) {
    const Json* place = find_member(value, "place");
    if (place == nullptr || place->is_null()) {
      ++left_out_;
      return Done{};
    }
    const std::string type = string_member(*place, "type");
    if (type == "Prism" || type == "MultiPrism") {
      return Error{ErrorCode::unsupported,
                   "prisms are not read: write them as polyhedra",
                   {},
                   pointer + "/place"};
    }
    if (type != "Polyhedron" && type != "MultiPolyhedron") {
      ++left_out_;
      return Done{};
    }
    if (const Json* geometry = find_member(value, "geometry");
        geometry != nullptr && !geometry->is_null()) {
      ++fallbacks_;
    }
    const Json* crs = find_member(*place, "coordRefSys");
    if (crs == nullptr) crs = find_member(value, "coordRefSys");
    if (crs == nullptr) crs = collection_crs;
    return solids(value, *place, srid_of(crs), pointer + "/place");
  }

  Status solids(const Json& value, const Json& place, std::uint32_t srid,
                const std::string& pointer) {
    const std::string type = string_member(place, "type");
    const Json* coordinates = find_member(place, "coordinates");
    if (coordinates == nullptr || !coordinates->is_array()) {
      return wrong("coordinates is missing or not an array", pointer + "/coordinates");
    }
    Feature feature;
    feature.id = id_of(value);
    feature.type = string_member(value, "featureType");
    feature.srid = srid;
    PlaceReader reader(srid, limits_);
    SolidSource source{feature.id, type, "", 0, 0, pointer + "/coordinates"};
    if (type == "Polyhedron") {
      if (auto status = reader.polyhedron(*coordinates, source); !status) return status;
    } else {
      for (std::uint32_t i = 0; i < coordinates->size(); ++i) {
        source.ordinal = i;
        source.pointer = pointer + "/coordinates" + pointer_token(i);
        if (auto status = reader.polyhedron((*coordinates)[i], source); !status) return status;
      }
    }
    auto solids = reader.finish();
    if (!solids) {
      Error error = std::move(solids).error();
      if (error.pointer.empty()) error.pointer = pointer + "/coordinates";
      return error;
    }
    feature.solids = std::move(*solids);
    document_.features.push_back(std::move(feature));
    return Done{};
  }

  // The EPSG code of a reference system: a URI or safe CURIE ("[EPSG:7415]"), an object with one of
  // them in "href", or an array of systems, of which the first with a code counts (compound systems
  // start with the horizontal one). 0 when there is none.
  static std::uint32_t srid_of(const Json* crs) {
    if (crs == nullptr) return 0;
    if (crs->is_string()) return epsg_code(crs->get_ref<const std::string&>());
    if (crs->is_object()) return epsg_code(string_member(*crs, "href"));
    if (!crs->is_array()) return 0;
    for (const Json& part : crs->get_ref<const Json::array_t&>()) {
      const std::uint32_t code = part.is_array() ? 0 : srid_of(&part);
      if (code != 0) return code;
    }
    return 0;
  }

  const Limits& limits_;
  Document document_;
  std::size_t left_out_ = 0;   // the number of features without a polyhedron
  std::size_t fallbacks_ = 0;  // the number of features with a geometry beside their place
};

}  // namespace

Result<Document> read_json_fg(std::string_view text, const ReadOptions& options) {
  const auto root = parse_json(text, options.limits);
  if (!root) return root.error();
  return JsonFgReader(options.limits).read(*root);
}

}  // namespace watertight::formats
