// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/gml/shapes.h"

#include <algorithm>
#include <utility>

#include "formats/gml/elements.h"
#include "formats/gml/gml.h"
#include "formats/surface.h"
#include "formats/text/numbers.h"
#include "geometry/crs/crs.h"

namespace watertight::formats {
GmlShapes::GmlShapes(const GmlModel& model, std::uint64_t byte_count, const Limits& limits)
    : model_(model),
      limits_(limits),
      allowed_steps_(byte_count / 4 + 10'000),
      is_entered_(model.nodes.size(), false) {
  for (Index node = 0; node < model.nodes.size(); ++node) {
    const std::string_view id = model.name(model.nodes[node].id);
    if (!id.empty()) by_id_.emplace_back(id, node);
  }
  std::sort(by_id_.begin(), by_id_.end());
  for (const std::string& name : model.systems) {
    srids_.push_back(srid_of_srs_name(name));
    const bool is_ordered = is_in_order_of_authority(name);
    poles_.push_back(is_ordered ? watertight::geometry::pole_of_first_axis(srids_.back()) : 0);
  }
}

Error GmlShapes::wrong(XmlPlace place, std::string_view message) const {
  return error_at(place, ErrorCode::malformed, message);
}

std::string GmlShapes::title(Index node) const {
  std::string text(model_.name(model_.nodes[node].name));
  const std::string_view id = model_.name(model_.nodes[node].id);
  if (!id.empty()) text.append(" '").append(id).append("'");
  return text;
}

bool GmlShapes::is_same_system(Index a, Index b) const {
  if (a == b || a == kNone || b == kNone) return true;
  if (srids_[a] == 0) return model_.systems[a] == model_.systems[b];
  return srids_[a] == srids_[b] && poles_[a] == poles_[b];
}

Status GmlShapes::spend(std::uint64_t steps, XmlPlace place) {
  steps_ += steps;
  if (steps_ <= allowed_steps_) return Done{};
  return error_at(place, ErrorCode::limit_exceeded,
                  "xlinks repeat more geometry than a document of this size could hold");
}

bool GmlShapes::enter(Index node) {
  if (is_entered_[node]) return false;
  is_entered_[node] = true;
  return true;
}

Result<Index> GmlShapes::resolve(const GmlLink& link) {
  if (auto status = spend(1, link.place); !status) return std::move(status).error();
  if (link.node != kNone) return link.node;
  const std::string_view href = model_.name(link.reference);
  std::string quoted = "xlink:href '";
  quoted.append(href).append("'");
  if (!href.starts_with('#') || href.starts_with("#xpointer(")) {
    return error_at(link.place, ErrorCode::unsupported,
                    quoted + " is not the gml:id of this document; nothing else is followed");
  }
  const std::string_view id = href.substr(1);
  const auto found =
      std::lower_bound(by_id_.begin(), by_id_.end(), std::pair<std::string_view, Index>(id, 0));
  if (found == by_id_.end() || found->first != id) {
    return wrong(link.place, quoted + ": no geometry of this document has this gml:id");
  }
  if (found + 1 != by_id_.end() && (found + 1)->first == id) {
    return wrong(link.place, quoted + ": several geometries have this gml:id");
  }
  return found->second;
}

Status GmlShapes::check(Index node) const {
  const Index defect = model_.nodes[node].defect;
  if (defect != kNone) {
    Error error = model_.defects[defect];
    error.message.append(" (").append(title(node)).append(")");
    return error;
  }
  if (model_.nodes[node].kind != GmlKind::unread) return Done{};
  return error_at(model_.nodes[node].place, ErrorCode::unsupported,
                  title(node) + " is not read as part of a solid");
}

Result<GmlSolid> GmlShapes::solid(Index node, GmlPositions& positions) {
  if (auto status = check(node); !status) return std::move(status).error();
  const GmlNode& element = model_.nodes[node];
  GmlSolid solid;
  solid.first_position = positions.values.size();
  solid.system = element.system;
  solid.place = element.place;
  std::size_t exteriors = 0;
  for (const GmlRole role : {GmlRole::exterior, GmlRole::interior}) {
    for (Index link = element.first_link; link != kNone; link = model_.links[link].next) {
      if (model_.links[link].role != role) continue;
      if (role == GmlRole::exterior && ++exteriors > 1) {
        return wrong(model_.links[link].place, title(node) + " has a second exterior");
      }
      // The first shell of a Solid is its exterior; a missing exterior becomes an empty shell.
      if (role == GmlRole::interior && exteriors == 0 && ++exteriors > 0) solid.arrays.end_shell();
      auto status = shell(model_.links[link], solid, positions);
      if (!status) {
        Error error = std::move(status).error();
        if (!model_.name(element.id).empty()) error.message.append(", in ").append(title(node));
        return error;
      }
    }
  }
  return solid;
}

Status GmlShapes::shell(const GmlLink& link, GmlSolid& solid, GmlPositions& positions) {
  auto target = resolve(link);
  if (!target) return std::move(target).error();
  return shell_of(*target, solid, positions);
}

Result<GmlSolid> GmlShapes::surface_alone(Index node, GmlPositions& positions) {
  GmlSolid surface;
  surface.first_position = positions.values.size();
  surface.system = model_.nodes[node].system;
  surface.place = model_.nodes[node].place;
  auto status = shell_of(node, surface, positions);
  if (!status) return std::move(status).error();
  return surface;
}

Status GmlShapes::shell_of(Index node, GmlSolid& solid, GmlPositions& positions) {
  std::vector<Step> path;
  auto status = follow(path, node, solid, positions);
  for (const Step& step : path) leave(step.node);
  if (status) solid.arrays.end_shell();
  return status;
}

// Adds the facets of a surface and of all surfaces in it. After an error the path has the surfaces
// that were not left.
Status GmlShapes::follow(std::vector<Step>& path, Index first, GmlSolid& solid,
                         GmlPositions& positions) {
  auto status = surface(path, first, false, {}, solid, positions);
  while (status && !path.empty()) {
    Step& step = path.back();
    if (step.link == kNone) {
      leave(step.node);
      path.pop_back();
      continue;
    }
    const GmlLink& next = model_.links[step.link];
    const bool is_reversed = step.is_reversed;
    const bool is_collection = model_.nodes[step.node].kind == GmlKind::surfaces;
    const GmlMember member = is_collection ? GmlMember{step.link, is_reversed} : step.member;
    step.link = next.next;
    auto node = resolve(next);
    if (!node) return std::move(node).error();
    status = surface(path, *node, is_reversed, member, solid, positions);
  }
  return status;
}

// Adds the facet of a polygon; puts other surfaces on the path, which goes on with their members.
Status GmlShapes::surface(std::vector<Step>& path, Index node, bool is_reversed, GmlMember member,
                          GmlSolid& solid, GmlPositions& positions) {
  if (auto status = check(node); !status) return status;
  const GmlNode& element = model_.nodes[node];
  if (!is_surface(element.kind)) {
    return wrong(element.place, title(node) + " where a surface is expected");
  }
  if (element.kind == GmlKind::polygon) {
    solid.members.push_back(member);
    return facet(node, is_reversed, solid, positions);
  }
  const bool is_orientable = element.kind == GmlKind::orientable;
  if (is_orientable && element.first_link != element.last_link) {
    return wrong(element.place, title(node) + " has several base surfaces");
  }
  if (!enter(node)) return wrong(element.place, title(node) + " contains itself by xlink");
  path.push_back({node, element.first_link, is_reversed != element.is_reversed, member});
  return Done{};
}

Status GmlShapes::facet(Index node, bool is_reversed, GmlSolid& solid, GmlPositions& positions) {
  const GmlNode& element = model_.nodes[node];
  if (solid.facets.size() >= limits_.facets) {
    return error_at(element.place, ErrorCode::limit_exceeded, "more facets than the limit");
  }
  std::size_t exteriors = 0;
  for (const GmlRole role : {GmlRole::exterior, GmlRole::interior}) {
    for (Index link = element.first_link; link != kNone; link = model_.links[link].next) {
      if (model_.links[link].role != role) continue;
      if (role == GmlRole::exterior && ++exteriors > 1) {
        return wrong(model_.links[link].place, title(node) + " has a second exterior ring");
      }
      if (role == GmlRole::interior && exteriors == 0 && ++exteriors > 0) {
        solid.arrays.end_ring();
        solid.rings.emplace_back();
      }
      auto status = ring(model_.links[link], is_reversed, solid, positions);
      if (!status) {
        Error error = std::move(status).error();
        if (!model_.name(element.id).empty()) error.message.append(", in ").append(title(node));
        return error;
      }
    }
  }
  solid.arrays.end_facet();
  solid.facets.push_back(node);
  return Done{};
}

Status GmlShapes::ring(const GmlLink& link, bool is_reversed, GmlSolid& solid,
                       GmlPositions& positions) {
  auto node = resolve(link);
  if (!node) return std::move(node).error();
  if (auto status = check(*node); !status) return status;
  const GmlNode& element = model_.nodes[*node];
  if (element.kind != GmlKind::ring) {
    return wrong(element.place, title(*node) + " where a LinearRing is expected");
  }
  if (!is_same_system(solid.system, element.system)) {
    return error_at(element.place, ErrorCode::unsupported,
                    title(*node) + " is in '" + model_.systems[element.system] +
                        "', its solid in '" + model_.systems[solid.system] + "'");
  }
  if (solid.system == kNone) solid.system = element.system;
  const std::size_t first = positions.values.size();
  if (auto status = read_positions(element, positions); !status) return status;
  if (auto status = close_ring(element, first, solid, positions); !status) return status;

  auto& vertices = solid.arrays.ring_vertices;
  const std::size_t start = vertices.size();
  for (std::size_t i = first; i < positions.values.size(); ++i) {
    vertices.push_back(static_cast<Index>(i - solid.first_position));
  }
  // The first position of a reversed ring stays the first.
  if (is_reversed && vertices.size() > start) {
    std::reverse(vertices.begin() + static_cast<std::ptrdiff_t>(start) + 1, vertices.end());
  }
  solid.arrays.end_ring();
  solid.rings.push_back({*node, is_reversed});
  return Done{};
}

Status GmlShapes::read_positions(const GmlNode& ring, GmlPositions& positions) {
  std::string_view text = model_.numbers(ring.positions);
  for (std::string_view word = take_word(text); !word.empty(); word = take_word(text)) {
    if (auto status = spend(1, ring.place); !status) return status;
    if (positions.values.size() > 8 * limits_.vertices || positions.values.size() >= kNone - 1) {
      return error_at(ring.place, ErrorCode::limit_exceeded, "more positions than the limit");
    }
    std::array<GridNumber, 3> position;
    bool is_rounded = false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (axis > 0) word = take_word(text);
      auto exact = exact_number(word);
      if (!exact) {
        return wrong(ring.place,
                     std::string("a coordinate of the ring: ").append(exact.error().message));
      }
      position[axis] = exact->value;
      is_rounded = is_rounded || exact->is_rounded;
    }
    if (is_rounded) positions.rounded.push_back(static_cast<Index>(positions.values.size()));
    positions.values.push_back(position);
  }
  return Done{};
}

// Drops the position that closes the ring, or lists the ring as unclosed.
Status GmlShapes::close_ring(const GmlNode& ring, std::size_t first, GmlSolid& solid,
                             GmlPositions& positions) {
  auto& values = positions.values;
  if (values.size() < first + 2) return Done{};
  const auto& begin = values[first];
  const auto& end = values.back();
  if (begin == end) {
    values.pop_back();
    if (!positions.rounded.empty() && positions.rounded.back() == values.size()) {
      positions.rounded.pop_back();
    }
    return Done{};
  }
  if (ring.is_plane_stated && begin[0] == end[1] && begin[1] == end[2]) {
    return error_at(ring.place, ErrorCode::unsupported,
                    "two-dimensional positions (srsDimension 2 of the Envelope) are not read; a "
                    "solid needs x, y and z");
  }
  solid.unclosed_rings.push_back(static_cast<Index>(solid.arrays.ring_offsets.size() - 1));
  return Done{};
}

Result<geometry::Placement> read_placement(std::string_view text) {
  std::vector<GridNumber> numbers;
  for (std::size_t at = 0; at < text.size() && numbers.size() <= kMatrixSize;) {
    const std::size_t begin = text.find_first_not_of(" \t\r\n", at);
    if (begin == std::string_view::npos) break;
    at = std::min(text.find_first_of(" \t\r\n", begin), text.size());
    auto exact = exact_number(text.substr(begin, at - begin));
    if (!exact) return std::move(exact).error();
    numbers.push_back(exact->value);
  }
  return placement_of_matrix(numbers, {});
}

}  // namespace watertight::formats
