// SPDX-License-Identifier: GPL-3.0-or-later
//
// A GML document as its geometry elements, the links between them, and the objects that own them.
// Coordinates stay text until a solid uses them: coordinates that no solid uses are not checked.
// Internal to formats/.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/bytes.h"
#include "base/limits.h"
#include "base/result.h"
#include "formats/gml/xml.h"
#include "geometry/cell_graph.h"
#include "geometry/point.h"

namespace watertight::formats {

/// The role of an element in a solid. A collection of surfaces is any of Shell, CompositeSurface,
/// MultiSurface, Surface, PolyhedralSurface, TriangulatedSurface and Tin.
enum class GmlKind : std::uint8_t {
  ring,     // LinearRing
  polygon,  // Polygon, PolygonPatch, Triangle, Rectangle
  surfaces,
  orientable,  // OrientableSurface
  solid,
  solids,  // MultiSolid, CompositeSolid
  mixed,   // MultiGeometry: solids are taken, other members are passed over
  unread   // geometry that is no part of a solid of polygons
};

enum class GmlRole : std::uint8_t { exterior, interior, member };

/// A part of GmlModel::names or GmlModel::positions.
struct TextSpan {
  std::uint64_t at = 0;
  std::uint64_t size = 0;
};

/// A property of a geometry (or of an object) with its value: an element, or a reference.
struct GmlLink {
  GmlRole role = GmlRole::member;
  Index node = kNone;  // kNone: `reference` holds the href, or the property is empty
  TextSpan reference;
  Index next = kNone;             // the next property of the same element
  XmlPlace place;                 // of the value; of the property if that is a reference
  std::uint64_t property_at = 0;  // where the property of a geometry starts, bytes
};

struct GmlNode {
  GmlKind kind = GmlKind::unread;
  bool is_reversed = false;      // OrientableSurface with orientation "-"
  bool is_plane_stated = false;  // ring: positions without srsDimension under a flat Envelope
  TextSpan name;                 // local name of the element
  TextSpan id;                   // gml:id
  TextSpan positions;            // ring: numbers between blanks, three per position
  Index system = kNone;          // index into GmlModel::systems
  Index defect = kNone;          // index into GmlModel::defects: why the element cannot be used
  Index first_link = kNone;
  Index last_link = kNone;
  XmlPlace place;
};

/// A feature or a part of one. Only objects that own geometry are kept.
struct GmlObject {
  std::string id;
  std::string type;
  std::string building_id;  // the value of SolidSource::building_id
  Index feature = 0;
  Index cell = kNone;  // index into GmlModel::graph.cells, for a cell of an indoor model
};

/// A geometry property of an object.
struct GmlGeometry {
  Index link = kNone;
  Index object = kNone;  // kNone: a geometry outside of any object
  char lod = '\0';
  bool is_template = false;  // part of an implicit geometry, with coordinates of its own
  Index implicit = kNone;    // index into GmlModel::implicits, for a template
};

/// An implicit geometry: a template and its placement.
struct GmlImplicit {
  TextSpan matrix;  // part of GmlModel::names: text of the transformationMatrix, or empty
  XmlPlace place;
};

/// The content of a pos, posList or coordinates element of a ring.
struct GmlNumbers {
  Index ring = kNone;         // a node
  std::uint64_t content = 0;  // the first byte after the start tag
};

struct GmlModel {
  std::vector<GmlNode> nodes;
  std::vector<GmlNumbers> numbers_of_rings;  // in document order
  std::vector<GmlLink> links;
  std::vector<GmlGeometry> geometries;  // in document order
  std::vector<GmlImplicit> implicits;
  std::vector<GmlObject> objects;
  std::vector<Index> features;       // the top-level objects
  std::vector<std::string> systems;  // values of srsName
  std::vector<Error> defects;
  geometry::CellGraph graph;                   // of an indoor model; empty for other documents
  std::vector<std::uint32_t> srids_of_states;  // one for each of graph.states; 0: none stated
  std::string names;
  std::string positions;

  std::string_view name(TextSpan span) const {
    return std::string_view(names).substr(span.at, span.size);
  }
  std::string_view numbers(TextSpan span) const {
    return std::string_view(positions).substr(span.at, span.size);
  }
};

/// Reads the elements of a GML document. Errors: those of read_xml(); malformed for XML that is not
/// GML. Cost: linear; memory proportional to the document.
Result<GmlModel> read_gml_model(ByteView bytes, const Limits& limits);

}  // namespace watertight::formats
