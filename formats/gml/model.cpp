// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/gml/model.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "formats/gml/elements.h"
#include "formats/gml/indoor.h"

namespace watertight::formats {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

std::size_t count_words(std::string_view text) {
  std::size_t count = 0;
  bool is_in_word = false;
  for (const char c : text) {
    const bool is_word = !is_blank(c);
    if (is_word && !is_in_word) ++count;
    is_in_word = is_word;
  }
  return count;
}

// The most bytes of a gml:id, of which every solid and facet has a copy.
constexpr std::size_t kLongestId = 1024;

bool is_object(std::string_view name) {
  return !name.empty() && name.front() >= 'A' && name.front() <= 'Z' && name != "Geometry3D" &&
         name != "Geometry2D" && name != "ImplicitGeometry";
}

// Turns the elements of a document into a GmlModel. Keeps a frame for each open element.
class GmlBuilder : public XmlHandler {
 public:
  Status start(const XmlElement& element) override {
    graph_.start(element, gml_id(element).substr(0, kLongestId + 1));
    if (skipped_ > 0) {
      ++skipped_;
      return Done{};
    }
    if (frames_.empty()) root_ = {std::string(element.name), element.place};
    is_of_ogc_ = is_of_ogc_ || element.space.starts_with("http://www.opengis.net/") ||
                 !gml_id(element).empty();
    if (gml_id(element).size() > kLongestId) {
      return error_at(element.place, ErrorCode::limit_exceeded,
                      "a gml:id of more than " + std::to_string(kLongestId) + " bytes");
    }
    const Frame parent = frames_.empty() ? Frame{} : frames_.back();
    switch (parent.kind) {
      case FrameKind::element:
        return start_in_element(element, parent);
      case FrameKind::geometry:
        return start_in_geometry(element, parent);
      case FrameKind::ring_point:
        return start_in_ring(element, parent);
      case FrameKind::property:
        return start_in_property(element, parent);
      case FrameKind::matrix:
        return skip();
      case FrameKind::numbers:
        break;
    }
    add_defect(parent.node, element.place, ErrorCode::malformed,
               "an element inside of coordinates");
    return skip();
  }

  Status text(std::string_view text) override {
    graph_.text(text);
    if (skipped_ == 0 && !frames_.empty() && frames_.back().kind == FrameKind::numbers) {
      model_.positions.append(text);
    }
    if (skipped_ == 0 && !frames_.empty() && frames_.back().kind == FrameKind::matrix) {
      model_.implicits[frames_.back().implicit].matrix.size += text.size();
      model_.names.append(text);
    }
    return Done{};
  }

  Status end() override {
    graph_.end();
    if (skipped_ > 0) {
      --skipped_;
      return Done{};
    }
    const Frame frame = frames_.back();
    frames_.pop_back();
    if (frame.kind == FrameKind::numbers) end_numbers(frame);
    if (frame.opens_object) objects_.pop_back();
    return Done{};
  }

  /// Errors: malformed for XML that is not GML, such as a page of HTML saved instead of the data.
  Result<GmlModel> take() {
    if (is_of_ogc_) {
      model_.graph = graph_.take();
      model_.srids_of_states = graph_.srids_of_states();
      return std::move(model_);
    }
    return error_at(root_.place, ErrorCode::malformed,
                    "not GML: the root element is '" + root_.name +
                        "', and nothing is in a namespace http://www.opengis.net/...");
  }

 private:
  enum class FrameKind : std::uint8_t {
    element,     // outside of geometry
    geometry,    // a GmlNode
    ring_point,  // between a ring and its positions: pointProperty, Point
    property,    // a property of a GmlNode
    matrix,      // transformationMatrix of an implicit geometry
    numbers      // pos, posList, coordinates
  };

  struct Frame {
    FrameKind kind = FrameKind::element;
    GmlRole role = GmlRole::member;
    bool opens_object = false;
    bool has_reference = false;  // the property's value is the target of an xlink:href
    bool is_template = false;
    bool is_flat_envelope = false;  // the Envelope that holds here says srsDimension 2
    char lod = '\0';
    int dimension = 0;       // srsDimension, 0 when not stated; -1 when it is no number
    Index node = kNone;      // the innermost open geometry
    Index implicit = kNone;  // index into GmlModel::implicits, in an implicit geometry
    Index system = kNone;
    Index object_frame = kNone;     // index into frames_ of the element's object
    std::uint64_t property_at = 0;  // where the innermost property of a geometry starts, bytes
  };

  struct OpenObject {
    std::string id;
    std::string type;
    bool is_feature = false;
    bool is_container = false;
    Index cell = kNone;     // index in GmlModel::graph.cells
    Index number = kNone;   // index in model_.objects
    Index feature = kNone;  // index of a top-level object in model_.objects; kNone until needed
  };

  // The attributes of the coordinates element that is being read.
  struct Numbers {
    std::string_view element;  // "pos", "posList", "coordinates"
    std::uint64_t at = 0;
    char decimal = '.';
    char between_numbers = ',';
    char between_positions = ' ';
    XmlPlace place;
  };

  static Frame frame_below(const Frame& parent, FrameKind kind) {
    Frame frame = parent;
    frame.kind = kind;
    frame.opens_object = false;
    frame.has_reference = false;
    return frame;
  }

  TextSpan keep(std::string_view text) {
    const TextSpan span{model_.names.size(), text.size()};
    model_.names.append(text);
    return span;
  }

  static std::string_view gml_id(const XmlElement& element) {
    for (const std::string_view space :
         {"http://www.opengis.net/gml/3.2", "http://www.opengis.net/gml"}) {
      if (const auto id = element.attribute(space, "id")) return *id;
    }
    return {};
  }

  // The xlink:href of an element; "" without one.
  static std::string_view reference(const XmlElement& element) {
    return without_blanks(element.attribute(kXlinkSpace, "href").value_or(""));
  }

  Index system_of(std::string_view name) {
    // Documents name one system or a few, and neighbours name the same, so only the last eight are
    // searched.
    for (std::size_t i = model_.systems.size(); i-- > 0 && model_.systems.size() - i <= 8;) {
      if (model_.systems[i] == name) return static_cast<Index>(i);
    }
    model_.systems.emplace_back(name);
    return static_cast<Index>(model_.systems.size() - 1);
  }

  void read_context(const XmlElement& element, Frame& frame) {
    if (const auto name = element.attribute("", "srsName");
        name && !without_blanks(*name).empty()) {
      frame.system = system_of(without_blanks(*name));
    }
    if (const auto text = element.attribute("", "srsDimension")) {
      const std::string_view digits = without_blanks(*text);
      const bool is_digit = digits.size() == 1 && digits[0] >= '0' && digits[0] <= '9';
      frame.dimension = is_digit && digits[0] != '0' ? digits[0] - '0' : -1;
    }
  }

  void add_defect(Index node, XmlPlace place, ErrorCode code, std::string_view message) {
    if (model_.nodes[node].defect != kNone) return;
    model_.nodes[node].defect = static_cast<Index>(model_.defects.size());
    model_.defects.push_back(error_at(place, code, message));
  }

  Status skip() {
    skipped_ = 1;
    return Done{};
  }

  // --- Outside of geometry ---

  Status start_in_element(const XmlElement& element, const Frame& parent) {
    Frame frame = frame_below(parent, FrameKind::element);
    const bool is_gml = is_gml_space(element.space);
    if (is_gml) {
      if (const auto kind = geometry_kind(element.name)) {
        if (auto status = room_for_more(element); !status) return status;
        const Index node = add_node(element, *kind, parent);
        add_geometry(add_link(kNone, GmlRole::member, node, {}, element.place), parent);
        return Done{};
      }
      if (element.name == "Envelope") read_envelope(element, parent);
    }
    read_context(element, frame);
    if (frame.lod == '\0' || lod_of(element.name) != '\0') frame.lod = lod_of(element.name);
    if (element.name == "transformationMatrix" && frame.implicit != kNone) {
      frame.kind = FrameKind::matrix;
      model_.implicits[frame.implicit] = {{model_.names.size(), 0}, element.place};
      frames_.push_back(frame);
      return Done{};
    }
    if (element.name == "ImplicitGeometry") {
      if (model_.implicits.size() >= kNone - 2) return room_for_more(element);
      frame.is_template = true;
      frame.implicit = static_cast<Index>(model_.implicits.size());
      model_.implicits.push_back({{}, element.place});
    }
    const bool opens_object = is_object(element.name) && (!is_gml || is_container(element.name));
    if (opens_object) open_object(element, frame);
    const std::string_view href = reference(element);
    frame.has_reference = !opens_object && !href.empty() && is_geometry_property(element.name);
    frames_.push_back(frame);
    if (!frame.has_reference) return Done{};
    if (auto status = room_for_more(element); !status) return status;
    add_geometry(add_link(kNone, GmlRole::member, kNone, href, element.place), frame);
    return Done{};
  }

  // Takes the reference system and the dimension of an Envelope for what follows in its object.
  void read_envelope(const XmlElement& element, const Frame& parent) {
    if (parent.object_frame == kNone) return;
    Frame& object = frames_[parent.object_frame];
    Frame envelope;
    read_context(element, envelope);
    if (envelope.system != kNone) object.system = envelope.system;
    if (envelope.dimension != 0) object.is_flat_envelope = envelope.dimension == 2;
  }

  void open_object(const XmlElement& element, Frame& frame) {
    frame.opens_object = true;
    frame.lod = '\0';
    frame.object_frame = static_cast<Index>(frames_.size());
    OpenObject object;
    object.id = gml_id(element);
    object.type = element.name;
    object.cell = graph_.opened_cell();
    object.is_container = is_container(element.name);
    object.is_feature = !object.is_container && (objects_.empty() || objects_.back().is_container);
    objects_.push_back(std::move(object));
  }

  // The id of the Building that an open object is or belongs to, also through parts of parts; "" if
  // none.
  std::string building_of(std::size_t object) const {
    while (object > 0 && objects_[object].type == "BuildingPart") --object;
    return objects_[object].type == "Building" ? objects_[object].id : "";
  }

  // The number of the innermost open object if that can own geometry, else kNone.
  Index owner() {
    if (objects_.empty() || objects_.back().is_container) return kNone;
    if (objects_.back().number != kNone) return objects_.back().number;
    std::size_t top = objects_.size() - 1;
    while (!objects_[top].is_feature) --top;
    OpenObject& feature = objects_[top];
    if (feature.feature == kNone) {
      feature.number = feature.feature = static_cast<Index>(model_.objects.size());
      model_.objects.push_back(
          {feature.id, feature.type, building_of(top), feature.feature, feature.cell});
      model_.features.push_back(feature.feature);
    }
    OpenObject& object = objects_.back();
    if (object.number == kNone) {
      object.number = static_cast<Index>(model_.objects.size());
      const std::string building = building_of(objects_.size() - 1);
      model_.objects.push_back({object.id, object.type, building, feature.feature, object.cell});
    }
    return object.number;
  }

  void add_geometry(Index link, const Frame& frame) {
    model_.geometries.push_back({link, owner(), frame.lod, frame.is_template, frame.implicit});
  }

  // --- Geometry ---

  Status room_for_more(const XmlElement& element) const {
    if (model_.nodes.size() < kNone - 2 && model_.links.size() < kNone - 2) return Done{};
    return error_at(element.place, ErrorCode::limit_exceeded, "too many geometry elements");
  }

  Index add_node(const XmlElement& element, GmlKind kind, const Frame& parent) {
    Frame frame = frame_below(parent, FrameKind::geometry);
    read_context(element, frame);
    frame.node = static_cast<Index>(model_.nodes.size());
    GmlNode node;
    node.kind = kind;
    node.name = keep(element.name);
    node.id = keep(gml_id(element));
    node.positions.at = model_.positions.size();
    node.system = frame.system;
    node.place = element.place;
    const std::string_view orientation =
        without_blanks(element.attribute("", "orientation").value_or("+"));
    node.is_reversed = kind == GmlKind::orientable && orientation == "-";
    model_.nodes.push_back(node);
    frames_.push_back(frame);
    if (kind == GmlKind::orientable && orientation != "-" && orientation != "+") {
      add_defect(frame.node, element.place, ErrorCode::malformed, "orientation must be + or -");
    }
    if (parent.has_reference) {
      add_defect(frame.node, element.place, ErrorCode::malformed,
                 "a property has both an xlink:href and a value");
    }
    return frame.node;
  }

  Index add_link(Index owner, GmlRole role, Index node, std::string_view href, XmlPlace place,
                 std::uint64_t property_at = 0) {
    const auto number = static_cast<Index>(model_.links.size());
    model_.links.push_back({role, node, keep(href), kNone, place, property_at});
    if (owner == kNone) return number;
    GmlNode& its = model_.nodes[owner];
    if (its.first_link == kNone) {
      its.first_link = number;
    } else {
      model_.links[its.last_link].next = number;
    }
    its.last_link = number;
    return number;
  }

  Status start_in_geometry(const XmlElement& element, const Frame& parent) {
    const GmlKind kind = model_.nodes[parent.node].kind;
    if (!is_gml_space(element.space) || kind == GmlKind::unread || is_remark(element.name)) {
      return skip();
    }
    if (kind == GmlKind::ring) return start_in_ring(element, parent);
    const auto role = role_of(kind, element.name);
    if (!role) {
      add_defect(parent.node, element.place, ErrorCode::unsupported,
                 std::string("'")
                     .append(element.name)
                     .append("' is not read in ")
                     .append(model_.name(model_.nodes[parent.node].name)));
      return skip();
    }
    const std::string_view href = reference(element);
    Frame frame = frame_below(parent, FrameKind::property);
    frame.role = *role;
    frame.property_at = element.place.byte;
    frame.has_reference = !href.empty();
    frames_.push_back(frame);
    if (href.empty()) return Done{};
    if (auto status = room_for_more(element); !status) return status;
    add_link(parent.node, *role, kNone, href, element.place, element.place.byte);
    return Done{};
  }

  Status start_in_property(const XmlElement& element, const Frame& parent) {
    if (auto status = room_for_more(element); !status) return status;
    const bool is_gml = is_gml_space(element.space);
    const auto kind = is_gml ? geometry_kind(element.name) : std::nullopt;
    const Index node = add_node(element, kind.value_or(GmlKind::unread), parent);
    add_link(parent.node, parent.role, node, {}, element.place, parent.property_at);
    return Done{};
  }

  Status start_in_ring(const XmlElement& element, const Frame& parent) {
    if (!is_gml_space(element.space) || is_remark(element.name)) return skip();
    Frame frame = frame_below(parent, FrameKind::ring_point);
    read_context(element, frame);
    if (element.name == "pos" || element.name == "posList" || element.name == "coordinates") {
      frame.kind = FrameKind::numbers;
      frames_.push_back(frame);
      begin_numbers(element, frame);
      return Done{};
    }
    const bool is_point = element.name == "pointProperty" || element.name == "pointRep" ||
                          (element.name == "Point" && parent.kind == FrameKind::ring_point);
    if (is_point && reference(element).empty()) {
      frames_.push_back(frame);
      return Done{};
    }
    add_defect(
        parent.node, element.place, ErrorCode::unsupported,
        std::string("'")
            .append(element.name)
            .append(is_point ? "' by reference is not read" : "' is not read in a LinearRing"));
    return skip();
  }

  // --- Coordinates ---

  void begin_numbers(const XmlElement& element, const Frame& frame) {
    model_.positions.push_back(' ');
    numbers_ = {};
    numbers_.element = element.name == "pos"       ? "pos"
                       : element.name == "posList" ? "posList"
                                                   : "coordinates";
    numbers_.at = model_.positions.size();
    numbers_.place = element.place;
    model_.numbers_of_rings.push_back({frame.node, element.content});
    const auto separator = [&](std::string_view name, char& value) {
      const auto text = element.attribute("", name);
      if (text && text->size() == 1) value = text->front();
      if (text && text->size() != 1) {
        add_defect(frame.node, element.place, ErrorCode::unsupported,
                   std::string("'").append(name).append("' of coordinates must be one character"));
      }
    };
    if (numbers_.element == "coordinates") {
      separator("decimal", numbers_.decimal);
      separator("cs", numbers_.between_numbers);
      separator("ts", numbers_.between_positions);
    }
  }

  void end_numbers(const Frame& frame) {
    GmlNode& ring = model_.nodes[frame.node];
    const std::string_view text = std::string_view(model_.positions).substr(numbers_.at);
    if (frame.dimension == 0 && frame.is_flat_envelope) ring.is_plane_stated = true;
    if (frame.dimension != 0 && frame.dimension != 3) {
      const std::string what =
          frame.dimension == 2
              ? "two-dimensional positions (srsDimension 2) are not read; a solid needs x, y and z"
              : "srsDimension must be 3";
      add_defect(frame.node, numbers_.place, ErrorCode::unsupported, what);
    } else if (numbers_.element == "coordinates") {
      end_coordinates(frame.node);
    } else {
      check_count(frame.node, count_words(text));
    }
    ring.positions.size = model_.positions.size() - ring.positions.at;
  }

  void check_count(Index node, std::size_t count) {
    const bool is_list = numbers_.element == "posList";
    if (is_list ? count % 3 == 0 : count == 3) return;
    std::string message(is_list ? "a posList" : "a position");
    message.append(" of ").append(std::to_string(count));
    message.append(is_list ? " numbers, which is not a multiple of 3" : " numbers");
    message.append(": two-dimensional positions are not read; a solid needs x, y and z");
    add_defect(node, numbers_.place, ErrorCode::unsupported, std::move(message));
  }

  // Rewrites coordinates: "1,5;2,5;3 4;5;6" with decimal "," and cs ";" becomes "1.5 2.5 3 4 5 6".
  void end_coordinates(Index node) {
    std::size_t count = 0;       // the numbers in the current position
    std::size_t separators = 0;  // the separators in the current position
    bool is_in_number = false;
    const auto end_position = [&] {
      if (count + separators > 0 && (count != 3 || separators != 2)) {
        check_count(node, count == 3 ? separators + 1 : count);
      }
      count = separators = 0;
      is_in_number = false;
    };
    for (std::size_t i = numbers_.at; i < model_.positions.size(); ++i) {
      char& c = model_.positions[i];
      if (c == numbers_.between_numbers) {
        ++separators;
        is_in_number = false;
        c = ' ';
      } else if (c == numbers_.between_positions || is_blank(c)) {
        end_position();
        c = ' ';
      } else {
        if (!is_in_number) ++count;
        is_in_number = true;
        if (c == numbers_.decimal) c = '.';
      }
    }
    end_position();
  }

  GmlModel model_;
  CellGraphReader graph_;
  std::vector<Frame> frames_;
  std::vector<OpenObject> objects_;
  Numbers numbers_;
  struct Root {
    std::string name;
    XmlPlace place;
  };
  Root root_;
  bool is_of_ogc_ = false;     // an element is in a namespace of OGC or has a gml:id
  std::uint64_t skipped_ = 0;  // the number of open elements that are skipped
};

}  // namespace

Result<GmlModel> read_gml_model(ByteView bytes, const Limits& limits) {
  GmlBuilder builder;
  if (auto status = read_xml(bytes, builder, limits); !status) return std::move(status).error();
  return builder.take();
}

}  // namespace watertight::formats
