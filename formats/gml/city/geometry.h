// SPDX-License-Identifier: GPL-3.0-or-later
//
// The geometries of a GML tree as facets, lines and points of CityJSON, with the elements that they
// came from. The facets of a solid have the order, the orientation and the positions with which
// read_gml() hands them to the validator. Internal to formats/.
#pragma once

#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "base/limits.h"
#include "base/result.h"
#include "formats/gml/city/tree.h"
#include "formats/gml/model.h"
#include "geometry/lattice/lattice.h"
#include "geometry/point.h"

namespace watertight::formats {

/// A ring; `positions` are indices into GeometryReader::positions(), without the closing one.
struct CityRing {
  Index element = kNone;
  bool is_reversed = false;
  std::vector<Index> positions;
};

struct CityFacet {
  Index polygon = kNone;  // the element Polygon, Triangle, ...
  std::vector<CityRing> rings;
};

/// A geometry of CityJSON.
struct CityGeometry {
  std::string type;  // Solid, MultiSolid, CompositeSolid, MultiSurface, CompositeSurface,
                     // MultiLineString or MultiPoint
  std::string lod;
  std::vector<CityFacet> facets;
  /// For each solid the number of facets of each of its shells.
  std::vector<std::vector<std::size_t>> solids;
  std::vector<std::vector<Index>> lines;  // of a MultiPoint: one line with all points
};

/// What GeometryReader::read() found.
struct ReadGeometry {
  std::vector<CityGeometry> geometries;
  std::vector<Index> elements;    // the elements that were read
  std::vector<Index> attributes;  // the references that were followed
};

class GeometryReader {
 public:
  /// `tree` must outlive this object. The size of the document limits how much xlinks may repeat.
  GeometryReader(const GmlTree& tree, std::uint64_t byte_count, const Limits& limits);

  /// Reads the geometry that a property holds or refers to, with its collections of solids as
  /// separate geometries where CityJSON cannot nest them. Errors: malformed, unsupported,
  /// limit_exceeded; with the line.
  Result<ReadGeometry> read(Index property, std::string_view lod);

  /// The same for a geometry element that stands alone.
  Result<ReadGeometry> read_alone(Index element, std::string_view lod);

  /// The geometry with this gml:id ("#id"); kNone for none and for several.
  Index geometry_of(std::string_view href) const;

  /// Ends a top-level object: puts longitude first in its positions where latitude is first.
  void end_feature();

  const std::vector<std::array<GridNumber, 3>>& positions() const { return positions_; }
  /// The EPSG code of the whole document, 0 without one. Errors: unsupported for several.
  Result<std::uint32_t> srid() const;
  /// Readings of doubtful input, one clause each.
  std::vector<std::string> notes() const;
  /// True if the positions of this element's system are latitude, longitude.
  bool is_latitude_first(Index element) const;

 private:
  struct Link {
    Index element = kNone;
    GmlRole role = GmlRole::member;
  };

  Status read_value(Index property, std::string_view lod);
  Status read_element(Index element, std::string_view lod);
  Result<Index> resolve(Index property);
  Result<std::vector<Link>> links(Index element, GmlKind kind);
  Result<std::vector<Link>> values(Index property, GmlRole role);
  Status read_solid(Index element, CityGeometry& geometry);
  Status read_solids(Index element, std::string_view lod);
  Status read_surface(Index element, CityGeometry& geometry);
  Status read_polygon(Index element, bool is_reversed, CityGeometry& geometry);
  Status read_ring(Index element, bool is_reversed, CityFacet& facet);
  Status read_lines(Index element, CityGeometry& geometry);
  Status read_curve(Index element, CityGeometry& geometry);
  Status read_positions(Index element, std::vector<Index>& out);
  Status read_numbers(Index element, std::vector<Index>& out);
  Status add_position(const std::array<std::string_view, 3>& words, Index element,
                      std::vector<Index>& out);
  Status spend(std::uint64_t steps, Index element);
  Error wrong(Index element, ErrorCode code, std::string_view message) const;

  struct Context {
    std::string_view system;
    int dimension = 0;              // 0: not stated
    bool is_flat_envelope = false;  // the Envelope around it says srsDimension 2
  };
  void read_context(Index element, Context& context) const;
  Status note_system(std::string_view system, Index element);

  const GmlTree& tree_;
  const Limits& limits_;
  std::uint64_t allowed_steps_;
  std::uint64_t steps_ = 0;
  std::unordered_map<std::string_view, Index> by_id_;  // kNone: several geometries have the gml:id
  std::vector<Context> contexts_;                      // of each element
  std::vector<bool> is_entered_;
  std::vector<std::array<GridNumber, 3>> positions_;
  std::size_t first_of_feature_ = 0;
  std::string_view system_of_feature_;
  std::set<std::string_view> systems_;
  std::set<std::string_view> latitude_first_;
  std::set<std::string_view> wrongly_ordered_;
  std::uint64_t rounded_ = 0;
  std::uint64_t unclosed_ = 0;
  ReadGeometry result_;
};

}  // namespace watertight::formats
