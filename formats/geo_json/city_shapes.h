// SPDX-License-Identifier: GPL-3.0-or-later
//
// The features of a city model as map programs want them: attributes as one list of properties, and
// the geometry of one level of detail as polygons, lines and points in world coordinates.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/limits.h"
#include "base/result.h"
#include "formats/document.h"

namespace watertight::formats {

/// The part of an object that a facet is, by the semantics of its geometry.
enum class FacetKind : std::uint8_t { none, roof, wall, ground, other };

/// The geometry of a feature. Indices refer to `positions`.
struct CityShapes {
  using Ring = std::vector<std::size_t>;  // does not repeat its first position
  using Polygon = std::vector<Ring>;      // the exterior ring, then the holes

  std::vector<std::array<double, 3>> positions;  // world coordinates, on the axes of the document
  /// The most decimals that x, y and z have; nothing where the document does not limit them.
  std::optional<std::array<int, 3>> decimals;
  std::vector<Polygon> polygons;  // facets, of solids and surfaces alike
  std::vector<FacetKind> kinds;   // of each polygon
  /// The solids: for each its shells, the outer one first, as runs of `polygons`.
  struct Shell {
    std::size_t first = 0;
    std::size_t count = 0;
  };
  std::vector<std::vector<Shell>> solids;
  std::vector<Ring> lines;
  std::vector<std::size_t> points;
};

/// The most vertices of all rings of a feature, counted as often as rings name them: some 100 MB of
/// GeoJSON. A template of a megabyte can be placed in a hundred bytes.
inline constexpr std::size_t kMostShownVertices = 2'000'000;

/// A feature with its properties.
struct CityFeature {
  std::string id;
  std::string type;  // of the top-level object
  CityShapes shapes;
  bool is_too_large = false;  // more than kMostShownVertices: there are no shapes
  /// Names and values (JSON texts): the attributes of the top-level object, then those of other
  /// objects which it does not have and in which no two of them differ.
  std::vector<std::pair<std::string, std::string>> attributes;
};

/// CityFeature::attributes of a feature, from its text alone (a skeleton or a CityJSONFeature).
/// Empty for another text. Cost: linear, the text as JSON values.
std::vector<std::pair<std::string, std::string>> city_attributes(std::string_view feature,
                                                                 std::string_view id,
                                                                 const Limits& limits = {});

/// The solids of a feature of any format, without semantics and attributes. Cost: linear.
CityFeature city_feature_of(const Feature& feature);

/// Reads the features of one header (Document::header). Thread-safe.
class CityFeatureReader {
 public:
  /// Errors: malformed, limit_exceeded. Cost: linear in the header.
  static Result<CityFeatureReader> make(std::string_view header, const Limits& limits = {});
  CityFeatureReader(CityFeatureReader&&) noexcept;
  CityFeatureReader& operator=(CityFeatureReader&&) noexcept;
  ~CityFeatureReader();

  /// Reads a CityJSONFeature. Of each object the geometries of its highest level
  /// of detail are read, those of level 0 (footprints) only if the feature has no other; or those
  /// of level `lod`, as written. Instances of geometry templates are placed. Rings that name
  /// vertices which do not exist, or fewer than three, are left out: what is stored without a proof
  /// can have such. Errors: malformed, limit_exceeded. Cost: linear in the text.
  Result<CityFeature> read(std::string_view feature,
                           std::optional<std::string_view> lod = std::nullopt,
                           const Limits& limits = {}) const;

 private:
  struct Header;
  explicit CityFeatureReader(std::unique_ptr<Header> header);
  std::unique_ptr<Header> header_;
};

}  // namespace watertight::formats
