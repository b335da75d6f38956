// SPDX-License-Identifier: GPL-3.0-or-later
//
// The text of a CityJSON 2.0 from the objects of a GML tree. Internal to formats/.
#pragma once

#include <array>
#include <map>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/result.h"
#include "formats/gml/city/appearance.h"
#include "formats/gml/city/objects.h"

namespace watertight::formats {

/// The steps of the coordinates.
enum class GridChoice : std::uint8_t {
  common,   // the finest decimal step of all coordinates for all axes
  by_axis,  // the finest step of each axis
  rounded   // steps of which 2^53 span the document; coordinates are rounded where that is coarser
};

class CityWriter {
 public:
  /// All must outlive this object. Marks the surfaces that it writes.
  CityWriter(const GmlTree& tree, TreeMarks& marks, GmlObjects& objects,
             const GeometryReader& geometry, GmlAppearance& appearance);

  /// Makes the text of all but the vertices. Errors: unsupported when the objects have several
  /// reference systems; limit_exceeded when the surfaces that geometries share would have more than
  /// `most_surface_bytes`. Cost: n log n.
  Status prepare(std::uint64_t most_surface_bytes);

  /// The document. Requires prepare(). Errors: unsupported when 64 bits do not hold the
  /// coordinates. Cost: linear.
  Result<std::string> text(GridChoice choice) const;

  /// How many coordinates text() rounds.
  std::uint64_t count_rounded(GridChoice choice) const;

 private:
  using Position = std::array<GridNumber, 3>;
  using Exponents = std::array<std::int32_t, 3>;
  struct PositionHash {
    std::size_t operator()(const Position& position) const;
  };

  void find_surfaces_of_facets();
  void append_object(std::string& out, GmlCityObject& object);
  void append_ids(std::string& out, std::string_view member, const std::vector<Index>& objects);
  void append_addresses(std::string& out, const GmlCityObject& object);
  void append_geometry(std::string& out, const CityGeometry& geometry,
                       std::string_view stated_surface);
  void append_semantics(std::string& out, const CityGeometry& geometry,
                        std::string_view stated_surface);
  std::string surface_members(Index surface);
  std::vector<CityGeometry> geometries_of_surfaces(const GmlCityObject& object) const;
  std::string facet_text(const CityFacet& facet);
  std::string line_text(const std::vector<Index>& positions);
  Index vertex_of(Index position);
  std::string header_text(const Exponents& exponents) const;
  Result<std::string> vertices_text(const Exponents& exponents) const;
  Exponents exponents(GridChoice choice) const;

  const GmlTree& tree_;
  TreeMarks& marks_;
  GmlObjects& found_;
  const GeometryReader& geometry_;
  GmlAppearance& appearance_;
  ValueReader values_;
  std::unordered_map<Index, Index> surface_of_;  // by polygon
  std::map<Index, std::string> surface_texts_;   // by surface
  std::unordered_map<Position, Index, PositionHash> vertex_numbers_;
  std::vector<Index> vertices_;      // positions
  std::uint64_t surface_bytes_ = 0;  // of the texts of surfaces, each as often as it is written
  std::uint64_t most_surface_bytes_ = 0;
  std::uint32_t srid_ = 0;
  std::string objects_text_;
  std::string appearance_text_;  // "" without materials and textures
};

}  // namespace watertight::formats
