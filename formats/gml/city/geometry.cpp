// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/gml/city/geometry.h"

#include <algorithm>
#include <utility>

#include "formats/gml/elements.h"

namespace watertight::formats {
GeometryReader::GeometryReader(const GmlTree& tree, std::uint64_t byte_count, const Limits& limits)
    : tree_(tree),
      limits_(limits),
      allowed_steps_(byte_count + 40'000),
      is_entered_(tree.elements().size(), false) {
  std::unordered_map<Index, Index> envelopes;  // the Envelope of an object
  for (Index i = 0; i < tree.elements().size(); ++i) {
    if (!tree.is_gml(i)) continue;
    if (tree.name(i) == "Envelope" && tree[i].parent != kNone &&
        tree[tree[i].parent].parent != kNone) {
      envelopes.emplace(tree[tree[i].parent].parent, i);
    }
    if (!geometry_kind(tree.name(i)) || tree.id(i).empty()) continue;
    const auto [place, is_new] = by_id_.emplace(tree.id(i), i);
    if (!is_new) place->second = kNone;
  }
  contexts_.resize(tree.elements().size());
  for (Index i = 0; i < tree.elements().size(); ++i) {
    Context& own = contexts_[i];
    if (tree[i].parent != kNone) own = contexts_[tree[i].parent];
    read_context(i, own);
    const auto envelope = envelopes.find(i);
    if (envelope == envelopes.end()) continue;
    Context stated;
    read_context(envelope->second, stated);
    if (!stated.system.empty()) own.system = stated.system;
    if (stated.dimension != 0) own.is_flat_envelope = stated.dimension == 2;
  }
}

// Takes what an element says about positions below it.
void GeometryReader::read_context(Index element, Context& context) const {
  const std::string_view system = tree_.attribute(element, "", "srsName");
  const std::string_view dimension = tree_.attribute(element, "", "srsDimension");
  if (!system.empty()) context.system = system;
  if (!dimension.empty()) context.dimension = dimension == "3" ? 3 : dimension == "2" ? 2 : -1;
}

Error GeometryReader::wrong(Index element, ErrorCode code, std::string_view message) const {
  std::string text(message);
  text.append(" (").append(tree_.name(element));
  const std::string_view id = tree_.id(element);
  if (!id.empty()) text.append(" '").append(id).append("'");
  text.append(")");
  return error_at(tree_[element].place, code, text);
}

Status GeometryReader::spend(std::uint64_t steps, Index element) {
  steps_ += steps;
  if (steps_ <= allowed_steps_) return Done{};
  return wrong(element, ErrorCode::limit_exceeded,
               "xlinks repeat more geometry than a document of this size could hold");
}

// The geometry to which a property with an xlink:href refers.
Result<Index> GeometryReader::resolve(Index property) {
  const std::string_view href = tree_.href(property);
  std::string quoted = "xlink:href '";
  quoted.append(href).append("'");
  if (!href.starts_with('#') || href.starts_with("#xpointer(")) {
    return wrong(property, ErrorCode::unsupported,
                 quoted + " is not the gml:id of this document; nothing else is followed");
  }
  const auto found = by_id_.find(href.substr(1));
  if (found == by_id_.end()) {
    return wrong(property, ErrorCode::malformed,
                 quoted + ": no geometry of this document has this gml:id");
  }
  if (found->second == kNone) {
    return wrong(property, ErrorCode::malformed, quoted + ": several geometries have this gml:id");
  }
  result_.attributes.push_back(tree_.href_attribute(property));
  return found->second;
}

// The elements that a property holds, or the one to which it refers.
Result<std::vector<GeometryReader::Link>> GeometryReader::values(Index property, GmlRole role) {
  std::vector<Link> found;
  if (auto status = spend(1, property); !status) return std::move(status).error();
  result_.elements.push_back(property);
  if (!tree_.href(property).empty()) {
    if (tree_[property].first_child != kNone) {
      return wrong(property, ErrorCode::malformed, "a property has both an xlink:href and a value");
    }
    auto target = resolve(property);
    if (!target) return std::move(target).error();
    found.push_back({*target, role});
    return found;
  }
  for (Index i = tree_[property].first_child; i != kNone; i = tree_[i].next) {
    if (auto status = spend(1, i); !status) return std::move(status).error();
    found.push_back({i, role});
  }
  return found;
}

// The members of a geometry in order.
Result<std::vector<GeometryReader::Link>> GeometryReader::links(Index element, GmlKind kind) {
  std::vector<Link> found;
  result_.elements.push_back(element);
  for (Index i = tree_[element].first_child; i != kNone; i = tree_[i].next) {
    if (!tree_.is_gml(i) || is_remark(tree_.name(i))) continue;
    const auto role = role_of(kind, tree_.name(i));
    if (!role) {
      return wrong(element, ErrorCode::unsupported,
                   std::string("'").append(tree_.name(i)).append("' is not read here"));
    }
    auto own = values(i, *role);
    if (!own) return own;
    found.insert(found.end(), own->begin(), own->end());
  }
  return found;
}

Index GeometryReader::geometry_of(std::string_view href) const {
  if (!href.starts_with('#')) return kNone;
  const auto found = by_id_.find(href.substr(1));
  return found == by_id_.end() ? kNone : found->second;
}

Result<ReadGeometry> GeometryReader::read(Index property, std::string_view lod) {
  result_ = {};
  if (auto status = read_value(property, lod); !status) {
    for (const Index element : result_.elements) is_entered_[element] = false;
    return std::move(status).error();
  }
  return std::move(result_);
}

Status GeometryReader::read_value(Index property, std::string_view lod) {
  auto found = values(property, GmlRole::member);
  if (!found) return std::move(found).error();
  // IndoorGML wraps the geometry once more.
  if (found->size() == 1 && tree_.name(found->front().element) == "Geometry3D") {
    found = values(found->front().element, GmlRole::member);
    if (!found) return std::move(found).error();
  }
  for (const Link& link : *found) {
    if (auto status = read_element(link.element, lod); !status) return status;
  }
  return Done{};
}

Result<ReadGeometry> GeometryReader::read_alone(Index element, std::string_view lod) {
  result_ = {};
  if (auto status = read_element(element, lod); !status) return std::move(status).error();
  return std::move(result_);
}

Status GeometryReader::read_element(Index element, std::string_view lod) {
  const auto kind = tree_.is_gml(element) ? geometry_kind(tree_.name(element)) : std::nullopt;
  if (!kind) return wrong(element, ErrorCode::unsupported, "not a geometry of GML");
  CityGeometry geometry;
  geometry.lod = lod;
  Status status = Done{};
  if (*kind == GmlKind::solid) {
    geometry.type = "Solid";
    status = read_solid(element, geometry);
  } else if (*kind == GmlKind::solids || *kind == GmlKind::mixed) {
    status = read_solids(element, lod);
  } else if (is_surface(*kind)) {
    const std::string_view name = tree_.name(element);
    const bool is_composite =
        name == "CompositeSurface" || name == "TriangulatedSurface" || name == "Tin";
    geometry.type = is_composite ? "CompositeSurface" : "MultiSurface";
    status = read_surface(element, geometry);
  } else {
    status = read_lines(element, geometry);
  }
  if (status && !geometry.type.empty()) result_.geometries.push_back(std::move(geometry));
  return status;
}

Status GeometryReader::read_solid(Index element, CityGeometry& geometry) {
  auto found = links(element, GmlKind::solid);
  if (!found) return std::move(found).error();
  std::vector<std::size_t> shells;
  for (const GmlRole role : {GmlRole::exterior, GmlRole::interior}) {
    for (const Link& link : *found) {
      if (link.role != role) continue;
      if (role == GmlRole::exterior && !shells.empty()) {
        return wrong(element, ErrorCode::malformed, "a second exterior");
      }
      // The first shell of a solid is its exterior; a missing exterior becomes an empty shell.
      if (role == GmlRole::interior && shells.empty()) shells.push_back(0);
      const std::size_t before = geometry.facets.size();
      if (auto status = read_surface(link.element, geometry); !status) return status;
      shells.push_back(geometry.facets.size() - before);
    }
  }
  geometry.solids.push_back(std::move(shells));
  return Done{};
}

// Reads a collection of solids. A CompositeSolid within another collection is a geometry of its
// own, as are the surfaces and curves of a MultiGeometry.
Status GeometryReader::read_solids(Index root, std::string_view lod) {
  std::vector<Index> roots{root};
  for (std::size_t next = 0; next < roots.size(); ++next) {
    const bool is_composite = tree_.name(roots[next]) == "CompositeSolid";
    CityGeometry geometry;
    geometry.type = is_composite ? "CompositeSolid" : "MultiSolid";
    geometry.lod = lod;
    std::vector<CityGeometry> others;
    std::vector<std::pair<Index, bool>> path{{roots[next], false}};  // element, is it to be left
    while (!path.empty()) {
      const auto [element, is_left] = path.back();
      path.pop_back();
      if (is_left) {
        is_entered_[element] = false;
        continue;
      }
      const auto kind = geometry_kind(tree_.name(element)).value_or(GmlKind::unread);
      if (kind == GmlKind::solid) {
        if (auto status = read_solid(element, geometry); !status) return status;
        continue;
      }
      if (kind != GmlKind::solids && kind != GmlKind::mixed) {
        CityGeometry other;
        other.lod = lod;
        other.type = "MultiSurface";
        auto status = is_surface(kind) ? read_surface(element, other) : read_lines(element, other);
        if (!status) return status;
        others.push_back(std::move(other));
        continue;
      }
      const bool is_nested = element != roots[next];
      if (is_nested && tree_.name(element) == "CompositeSolid" && !is_composite) {
        roots.push_back(element);
        continue;
      }
      if (is_entered_[element]) {
        return wrong(element, ErrorCode::malformed, "contains itself by xlink");
      }
      is_entered_[element] = true;
      path.emplace_back(element, true);
      auto found = links(element, kind);
      if (!found) return std::move(found).error();
      for (auto link = found->rbegin(); link != found->rend(); ++link) {
        path.emplace_back(link->element, false);
      }
    }
    if (!geometry.solids.empty()) result_.geometries.push_back(std::move(geometry));
    for (CityGeometry& other : others) result_.geometries.push_back(std::move(other));
  }
  return Done{};
}

Status GeometryReader::read_surface(Index root, CityGeometry& geometry) {
  struct Step {
    Index element;
    bool is_reversed;
    bool is_left;
  };
  std::vector<Step> path{{root, false, false}};
  while (!path.empty()) {
    const Step step = path.back();
    path.pop_back();
    if (step.is_left) {
      is_entered_[step.element] = false;
      continue;
    }
    const auto kind = tree_.is_gml(step.element)
                          ? geometry_kind(tree_.name(step.element)).value_or(GmlKind::unread)
                          : GmlKind::unread;
    if (!is_surface(kind)) {
      return wrong(step.element, ErrorCode::malformed, "a surface is expected");
    }
    if (kind == GmlKind::polygon) {
      auto status = read_polygon(step.element, step.is_reversed, geometry);
      if (!status) return status;
      continue;
    }
    if (is_entered_[step.element]) {
      return wrong(step.element, ErrorCode::malformed, "contains itself by xlink");
    }
    is_entered_[step.element] = true;
    path.push_back({step.element, false, true});
    const bool is_reversed =
        step.is_reversed !=
        (kind == GmlKind::orientable && tree_.attribute(step.element, "", "orientation") == "-");
    auto found = links(step.element, kind);
    if (!found) return std::move(found).error();
    for (auto link = found->rbegin(); link != found->rend(); ++link) {
      path.push_back({link->element, is_reversed, false});
    }
  }
  return Done{};
}

Status GeometryReader::read_polygon(Index element, bool is_reversed, CityGeometry& geometry) {
  auto found = links(element, GmlKind::polygon);
  if (!found) return std::move(found).error();
  CityFacet facet;
  facet.polygon = element;
  for (const GmlRole role : {GmlRole::exterior, GmlRole::interior}) {
    for (const Link& link : *found) {
      if (link.role != role) continue;
      if (role == GmlRole::exterior && !facet.rings.empty()) {
        return wrong(element, ErrorCode::malformed, "a second exterior ring");
      }
      if (role == GmlRole::interior && facet.rings.empty()) facet.rings.emplace_back();
      if (auto status = read_ring(link.element, is_reversed, facet); !status) return status;
    }
  }
  geometry.facets.push_back(std::move(facet));
  return Done{};
}

Status GeometryReader::read_ring(Index element, bool is_reversed, CityFacet& facet) {
  if (!tree_.is_gml(element, "LinearRing")) {
    return wrong(element, ErrorCode::unsupported, "a LinearRing is expected");
  }
  CityRing ring;
  ring.element = element;
  ring.is_reversed = is_reversed;
  if (auto status = read_positions(element, ring.positions); !status) return status;
  auto& positions = ring.positions;
  if (positions.size() > 1) {
    const auto& first = positions_[positions.front()];
    const auto& last = positions_[positions.back()];
    if (first == last) {
      positions.pop_back();
    } else if (contexts_[element].is_flat_envelope && contexts_[element].dimension == 0 &&
               first[0] == last[1] && first[1] == last[2]) {
      return wrong(element, ErrorCode::unsupported,
                   "two-dimensional positions (srsDimension 2 of the Envelope) are not read");
    } else {
      ++unclosed_;
    }
  }
  // The first position of a reversed ring stays the first.
  if (is_reversed && !positions.empty()) std::reverse(positions.begin() + 1, positions.end());
  facet.rings.push_back(std::move(ring));
  return Done{};
}

// Reads curves as a MultiLineString and points as a MultiPoint.
Status GeometryReader::read_lines(Index root, CityGeometry& geometry) {
  std::vector<Index> path{root};
  while (!path.empty()) {
    const Index element = path.back();
    path.pop_back();
    const std::string_view name = tree_.is_gml(element) ? tree_.name(element) : "";
    const bool is_point = name == "Point";
    if (is_point || name == "LineString" || name == "Curve") {
      const std::string_view type = is_point ? "MultiPoint" : "MultiLineString";
      if (!geometry.type.empty() && geometry.type != type) {
        return wrong(element, ErrorCode::unsupported, "points among curves are not read");
      }
      geometry.type = type;
      if (!is_point || geometry.lines.empty()) geometry.lines.emplace_back();
      auto status = name == "Curve" ? read_curve(element, geometry)
                                    : read_positions(element, geometry.lines.back());
      if (!status) return status;
      continue;
    }
    if (name != "MultiCurve" && name != "CompositeCurve" && name != "MultiLineString" &&
        name != "MultiPoint") {
      return wrong(element, ErrorCode::unsupported, "this geometry is not read");
    }
    result_.elements.push_back(element);
    std::vector<Index> members;
    for (Index i = tree_[element].first_child; i != kNone; i = tree_[i].next) {
      const bool is_member =
          tree_.name(i).ends_with("Member") || tree_.name(i).ends_with("Members");
      if (!tree_.is_gml(i) || !is_member) continue;
      auto found = values(i, GmlRole::member);
      if (!found) return std::move(found).error();
      for (const Link& link : *found) members.push_back(link.element);
    }
    // A member that is a collection again could refer back to this one: the steps bound that.
    path.insert(path.end(), members.rbegin(), members.rend());
  }
  return Done{};
}

// Reads the straight segments of a Curve as one line.
Status GeometryReader::read_curve(Index element, CityGeometry& geometry) {
  result_.elements.push_back(element);
  const Index segments = tree_.child(element, "segments");
  if (segments == kNone) return wrong(element, ErrorCode::unsupported, "a curve without segments");
  result_.elements.push_back(segments);
  std::vector<Index>& line = geometry.lines.back();
  for (Index i = tree_[segments].first_child; i != kNone; i = tree_[i].next) {
    if (!tree_.is_gml(i, "LineStringSegment")) {
      return wrong(i, ErrorCode::unsupported, "only straight segments are read");
    }
    std::vector<Index> own;
    if (auto status = read_positions(i, own); !status) return status;
    const bool joins =
        !line.empty() && !own.empty() && positions_[line.back()] == positions_[own.front()];
    line.insert(line.end(), own.begin() + (joins ? 1 : 0), own.end());
  }
  return Done{};
}

}  // namespace watertight::formats
