// SPDX-License-Identifier: GPL-3.0-or-later
//
// The city objects and thematic surfaces of a GML tree, between the elements and the text of the
// CityJSON. Internal to formats/.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/result.h"
#include "formats/gml/city/city.h"
#include "formats/gml/city/geometry.h"
#include "formats/gml/city/tree.h"
#include "formats/gml/city/values.h"
#include "formats/text/json.h"

namespace watertight::formats {

/// An address; `location` are indices into GeometryReader::positions().
struct GmlAddress {
  Json members;
  std::vector<Index> location;
};

/// A RoofSurface, a Window, ...: the semantics of some facets.
struct GmlSurface {
  Index element = kNone;
  Index object = kNone;  // index into GmlObjects::objects
  Index parent = kNone;  // the surface whose opening this is
  std::string type;      // in CityJSON
  std::vector<CityGeometry> geometries;
  std::vector<Index> elements;         // marked when the surface is written
  std::vector<Index> attributes_read;  // attributes of XML, likewise
};

struct GmlCityObject {
  Index element = kNone;
  std::string id;
  std::string type;  // in CityJSON
  std::vector<Index> parents;
  std::vector<Index> children;
  std::vector<std::string> roles;  // of a group's children, in their order
  std::vector<CityGeometry> geometries;
  /// For each geometry the type of surface that its property states ("lod0RoofEdge"), or "".
  std::vector<std::string> stated_surface;
  std::vector<Index> surfaces;  // indices into GmlObjects::surfaces
  ObjectBuilder attributes;
  std::vector<GmlAddress> addresses;
  Json extent;
};

/// What a document has.
struct GmlObjects {
  std::vector<GmlCityObject> objects;
  std::vector<GmlSurface> surfaces;
  std::vector<Index> appearances;  // elements
  Json metadata = Json::object();
  std::vector<std::string> notes;
};

/// Finds the objects of a tree and reads their parts. Marks what it reads, except for surfaces,
/// which are marked when they are written. Errors: those of geometry that belongs to a solid.
/// Recursive; the depth of the XML bounds it.
class ObjectReader {
 public:
  ObjectReader(const GmlTree& tree, TreeMarks& marks, GeometryReader& geometry,
               GroupMembers members)
      : tree_(tree), marks_(marks), geometry_(geometry), members_(members), values_(tree, marks) {}

  Result<GmlObjects> read();

 private:
  struct Reference {
    Index object = kNone;
    Index property = kNone;
    std::string role;
  };

  Status walk(Index element, Index parent);
  Status read_root();
  Status read_alone(Index element);
  Status read_object(Index element, Index parent, std::string_view type);
  Status read_property(Index property, Index object, std::vector<Index>& plain,
                       std::vector<Index>& generics);
  Status read_relief(Index element);
  Status read_geometry(Index property, Index object);
  Status read_address(Index property, Index object);
  Status read_surface(Index element, Index object, Index parent);
  void read_group_member(Index property, Index object);
  bool read_extent(Index property, Json& extent);
  bool is_object_here(Index element) const;
  bool has_geometry(Index element) const;
  std::string lod_of_property(Index property);
  std::string new_id(Index element, std::string_view type);
  void follow_references();
  void note_made_up();

  const GmlTree& tree_;
  TreeMarks& marks_;
  GeometryReader& geometry_;
  GroupMembers members_;
  ValueReader values_;
  GmlObjects found_;
  std::set<std::string> ids_;
  std::unordered_map<Index, Index> object_of_;  // by element
  std::vector<Reference> references_;
  std::map<std::string, std::uint64_t> generic_names_;  // elements written as GenericCityObject
  std::unordered_map<Index, Index> stated_lods_;        // the element "lod" of an object, or kNone
  std::size_t made_up_number_ = 0;
  std::uint64_t made_up_ids_ = 0;
  std::uint64_t made_up_lods_ = 0;
  std::map<std::string, std::uint64_t> unread_;  // reasons why geometry was not read
};

/// Whether a property holds a geometry, or refers to one.
bool holds_geometry(const GmlTree& tree, Index property);

/// The members of an address by xAL 2 and 3: "Country", "Locality", "ThoroughfareName",
/// "ThoroughfareNumber", "Postcode"; others by the names of their elements. Marks what it reads.
Json address_members(const GmlTree& tree, TreeMarks& marks, Index address);

}  // namespace watertight::formats
