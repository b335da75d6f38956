// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/gml/edits/edit_gml.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include "formats/gml/edits/xml_spans.h"
#include "formats/gml/gml.h"
#include "formats/text/kept_text.h"

namespace watertight::formats {
namespace {

/// The property of a collection that holds one surface; others hold several.
constexpr std::string_view kSingleMember = "surfaceMember";

/// The start of the ids of new polygons.
constexpr std::string_view kNewId = "watertight-";

std::string_view local_name(std::string_view name) { return name.substr(prefix_of(name).size()); }

/// A document that is to be changed.
struct GmlText {
  std::string_view text;
  GmlElements gml;
  std::vector<const Solid*> solids;
  /// Solid -> the first one with the same element; a Solid may be the value of several properties.
  std::vector<std::size_t> first_of;
  std::vector<Index> uses;           // node -> the number of facets of solids that it is
  std::vector<Index> member_uses;    // link -> the number of facets of solids that it gives
  std::vector<Index> owners;         // node -> the link that holds it; kNone: none
  std::set<std::string> references;  // the ids to which the document refers
  std::map<std::string, bool> id_attributes;  // whether elements have this attribute
  bool has_new_ids = false;                   // ids like those that are made
  std::size_t new_ids = 0;                    // the number of ids that were made
};

/// The changes that put one solid into the document.
class SolidRewriter {
 public:
  SolidRewriter(GmlText& document, const SolidEdit& edit)
      : document_(document),
        text_(document.text),
        gml_(document.gml),
        its_(gml_.solids[edit.number]),
        edit_(edit),
        before_(*document.solids[edit.number]) {}

  /// Errors: unsupported.
  Result<std::vector<TextChange>> changes();

  /// The polygons whose rings have changed, after changes().
  const std::vector<Index>& changed_polygons() const { return changed_; }

 private:
  Error unsupported(Index node, const std::string& message) const {
    return error_at(gml_.model.nodes[node].place, ErrorCode::unsupported, message);
  }
  /// The span of the property through which a facet got into its shell.
  XmlSpan member_span(Index facet) const {
    return xml_span(text_, gml_.model.links[its_.members[facet].link].property_at);
  }
  /// Whether other solids get the facet by the same property.
  bool is_common(Index facet) const { return document_.member_uses[its_.members[facet].link] > 1; }
  bool keeps_shells() const;
  bool is_unchanged(Index facet, Index after) const;
  std::string positions_of(std::span<const Index> ring, bool is_reversed) const;
  std::string ring_property(Index facet, std::size_t ring, bool is_reversed,
                            std::string_view prefix) const;
  Status rewrite(Index facet, Index after);
  Status replace_ring(Index node, std::span<const Index> ring, bool is_reversed);
  Status remove(Index facet, bool is_needed);
  Status add(Index facet, Index after);
  Status add_part(Index facet, Index after);
  Status change_facet(Index facet, std::span<const Index> parts);
  std::size_t member_end(Index facet) const;
  struct NewId {
    std::string id;
    std::string attribute;
  };
  NewId new_id(std::string_view prefix);
  std::string polygon(Index facet, const std::string& name, const std::string& attribute,
                      bool is_reversed) const;
  Index owner_of_reference(Index facet) const;

  GmlText& document_;
  const std::string_view text_;
  const GmlElements& gml_;
  const GmlSolidElements& its_;
  const SolidEdit& edit_;
  const Solid& before_;
  std::vector<TextChange> changes_;
  std::vector<Index> changed_;
};

bool SolidRewriter::is_unchanged(Index facet, Index after) const {
  const IndexRange old_rings = before_.rings_of(facet);
  const IndexRange rings = edit_.solid.rings_of(after);
  if (old_rings.size() != rings.size()) return false;
  for (Index i = 0; i < rings.size(); ++i) {
    const bool is_equal =
        std::ranges::equal(before_.ring(old_rings.begin + i), edit_.solid.ring(rings.begin + i));
    if (!is_equal) return false;
  }
  return true;
}

/// The positions of a ring as a posList, the first one repeated at the end. A reversed ring keeps
/// its first position, as the reader does.
std::string SolidRewriter::positions_of(std::span<const Index> ring, bool is_reversed) const {
  std::vector<Index> vertices(ring.begin(), ring.end());
  if (is_reversed && !vertices.empty()) std::reverse(vertices.begin() + 1, vertices.end());
  vertices.push_back(vertices.front());
  const std::array<int, 3> axes = its_.is_y_first ? std::array{1, 0, 2} : std::array{0, 1, 2};
  std::string positions;
  for (const Index vertex : vertices) {
    const Point& point = edit_.solid.vertices()[vertex];
    for (const int axis : axes) {
      if (!positions.empty()) positions += ' ';
      positions += edit_.solid.lattice().world_text(point[axis], axis);
    }
  }
  return positions;
}

std::string list_element(const std::string& prefix, const std::string& positions) {
  return "<" + prefix + "posList srsDimension=\"3\">" + positions + "</" + prefix + "posList>";
}

/// The property of a polygon that holds a ring of a facet.
std::string SolidRewriter::ring_property(Index facet, std::size_t ring, bool is_reversed,
                                         std::string_view prefix) const {
  const std::string p(prefix);
  const std::string property = p + (ring == 0 ? "exterior" : "interior");
  const Index number = edit_.solid.rings_of(facet).begin + static_cast<Index>(ring);
  return "<" + property + "><" + p + "LinearRing>" +
         list_element(p, positions_of(edit_.solid.ring(number), is_reversed)) + "</" + p +
         "LinearRing></" + property + ">";
}

/// Gives a ring other positions. Its element stays.
Status SolidRewriter::replace_ring(Index node, std::span<const Index> ring, bool is_reversed) {
  const XmlSpan span = xml_span(text_, gml_.model.nodes[node].place.byte);
  if (span.is_empty()) return unsupported(node, "an empty ring cannot get positions");
  changes_.push_back(
      {span.content, span.content_end,
       list_element(std::string(prefix_of(span.name)), positions_of(ring, is_reversed))});
  return Done{};
}

/// Gives the polygon of a facet the rings of another one.
Status SolidRewriter::rewrite(Index facet, Index after) {
  const Index polygon = its_.facets[facet];
  const GmlNode& element = gml_.model.nodes[polygon];
  const IndexRange old_rings = before_.rings_of(facet);
  const IndexRange rings = edit_.solid.rings_of(after);
  const std::string_view name = gml_.model.name(element.name);
  const bool is_bound = name == "Triangle" || name == "Rectangle";
  const std::size_t corners = name == "Triangle" ? 3 : 4;
  if (is_bound && (rings.size() != 1 || edit_.solid.ring(rings.begin).size() != corners)) {
    return unsupported(polygon, "a " + std::string(name) + " cannot hold the repaired facet");
  }
  std::vector<std::size_t> properties;
  for (const GmlRole role : {GmlRole::exterior, GmlRole::interior}) {
    for (Index link = element.first_link; link != kNone; link = gml_.model.links[link].next) {
      if (gml_.model.links[link].role != role) continue;
      properties.push_back(gml_.model.links[link].property_at);
    }
  }
  if (properties.size() != old_rings.size()) {
    return unsupported(polygon, "a polygon without exterior ring cannot be changed");
  }
  changed_.push_back(polygon);
  for (Index i = 0; i < std::min(old_rings.size(), rings.size()); ++i) {
    const auto ring = edit_.solid.ring(rings.begin + i);
    if (std::ranges::equal(before_.ring(old_rings.begin + i), ring)) continue;
    const GmlRing& its = its_.rings[old_rings.begin + i];
    Status replaced = replace_ring(its.node, ring, its.is_reversed);
    if (!replaced) return replaced;
  }
  for (std::size_t i = rings.size(); i < properties.size(); ++i) {
    changes_.push_back({properties[i], xml_span(text_, properties[i]).end, ""});
  }
  const XmlSpan last = xml_span(text_, properties.back());
  for (std::size_t i = properties.size(); i < rings.size(); ++i) {
    changes_.push_back(
        {last.end, last.end,
         ring_property(after, i, its_.rings[old_rings.begin].is_reversed, prefix_of(last.name))});
  }
  return Done{};
}

/// Takes a facet out of its shell. `is_needed`: its polygon is used elsewhere too.
Status SolidRewriter::remove(Index facet, bool is_needed) {
  const GmlMember& member = its_.members[facet];
  const Index polygon = its_.facets[facet];
  if (member.link == kNone) return unsupported(polygon, "a shell would have no facet");
  if (is_common(facet)) return unsupported(polygon, "its shell belongs to several solids");
  const GmlLink& link = gml_.model.links[member.link];
  if (link.node != kNone && is_needed) {
    return unsupported(polygon, "a polygon that is used elsewhere cannot be taken out");
  }
  XmlSpan span = member_span(facet);
  if (local_name(span.name) != kSingleMember) {
    if (link.node == kNone) return unsupported(polygon, "a reference cannot be taken out");
    span = xml_span(text_, gml_.model.nodes[link.node].place.byte);
  }
  changes_.push_back({span.begin - indent_before(text_, span.begin).size(), span.end, ""});
  return Done{};
}

/// The byte after the property, or after the element in a property of several, through which a
/// facet got into its shell.
std::size_t SolidRewriter::member_end(Index facet) const {
  const XmlSpan property = member_span(facet);
  if (local_name(property.name) == kSingleMember) return property.end;
  const Index node = gml_.model.links[its_.members[facet].link].node;
  return node == kNone ? property.end : xml_span(text_, gml_.model.nodes[node].place.byte).end;
}

/// The attribute with an id that the document does not have, for an element of this prefix, as
/// ` gml:id="..."`; "" for a document without ids.
SolidRewriter::NewId SolidRewriter::new_id(std::string_view prefix) {
  const std::string attribute = prefix.empty() ? "gml:id" : std::string(prefix) + "id";
  const auto [known, is_new] = document_.id_attributes.emplace(attribute, false);
  if (is_new) known->second = text_.find(' ' + attribute + '=') != std::string_view::npos;
  if (!known->second) return {};
  while (true) {
    const std::string id = std::string(kNewId) + std::to_string(++document_.new_ids);
    const bool is_free =
        !document_.has_new_ids || text_.find('"' + id + '"') == std::string_view::npos;
    if (is_free) return {id, " " + attribute + "=\"" + id + "\""};
  }
}

/// The element of a new polygon.
std::string SolidRewriter::polygon(Index facet, const std::string& name,
                                   const std::string& attribute, bool is_reversed) const {
  std::string element = "<" + name + attribute + ">";
  for (std::size_t i = 0; i < edit_.solid.rings_of(facet).size(); ++i) {
    element += ring_property(facet, i, is_reversed, prefix_of(name));
  }
  return element + "</" + name + ">";
}

/// Adds a facet to the shell of another one, after it.
Status SolidRewriter::add(Index facet, Index after) {
  const GmlMember& member = its_.members[facet];
  const Index node = its_.facets[facet];
  if (member.link == kNone) return unsupported(node, "a shell of one polygon cannot get more");
  if (is_common(facet)) return unsupported(node, "its shell belongs to several solids");
  const XmlSpan property = member_span(facet);
  const bool is_single = local_name(property.name) == kSingleMember;
  const Index sibling = gml_.model.links[member.link].node;
  std::string name = std::string(prefix_of(property.name)) + "Polygon";
  if (!is_single && sibling != kNone) {
    name = xml_span(text_, gml_.model.nodes[sibling].place.byte).name;
  }
  const IndexRange rings = edit_.solid.rings_of(after);
  const std::string_view kind = local_name(name);
  const bool is_triangle =
      kind == "Triangle" && rings.size() == 1 && edit_.solid.ring(rings.begin).size() == 3;
  if (kind != "Polygon" && kind != "PolygonPatch" && !is_triangle) {
    return unsupported(node, "a collection of " + std::string(kind) + " cannot get the facet");
  }
  const std::string id = kind == "Polygon" ? new_id(prefix_of(name)).attribute : "";
  std::string element = polygon(after, name, id, member.is_reversed);
  if (is_single) {
    const std::string tag(property.name);
    element = "<" + tag + ">" + element + "</" + tag + ">";
  }
  const std::size_t at = member_end(facet);
  changes_.push_back({at, at, std::string(indent_before(text_, property.begin)) + element});
  return Done{};
}

/// The property that holds the polygon of a facet, if the shell refers to the polygon itself by a
/// property of its own and the polygon is a member of another collection; else kNone.
Index SolidRewriter::owner_of_reference(Index facet) const {
  const Index node = its_.facets[facet];
  const Index owner = document_.owners[node];
  const GmlMember& member = its_.members[facet];
  if (owner == kNone || member.link == kNone) return kNone;
  const std::string_view href = gml_.model.name(gml_.model.links[member.link].reference);
  if (!href.starts_with('#') || href.substr(1) != gml_.model.name(gml_.model.nodes[node].id)) {
    return kNone;
  }
  const bool is_single =
      local_name(member_span(facet).name) == kSingleMember &&
      local_name(xml_span(text_, gml_.model.links[owner].property_at).name) == kSingleMember;
  return is_single ? owner : kNone;
}

/// Adds a part of a facet that was divided. A shell that refers to the polygons of a thematic
/// surface refers to the part too, which stands beside the polygon.
Status SolidRewriter::add_part(Index facet, Index after) {
  const Index owner = owner_of_reference(facet);
  if (owner == kNone) return add(facet, after);
  if (is_common(facet)) {
    return unsupported(its_.facets[facet], "its shell belongs to several solids");
  }
  const XmlSpan held = xml_span(text_, gml_.model.links[owner].property_at);
  const std::string tag(held.name);
  const std::string prefix(prefix_of(held.name));
  const NewId id = new_id(prefix);
  if (id.id.empty()) return add(facet, after);
  const std::string element =
      polygon(after, prefix + "Polygon", id.attribute, its_.members[facet].is_reversed);
  changes_.push_back({held.end, held.end,
                      std::string(indent_before(text_, held.begin)) + "<" + tag + ">" + element +
                          "</" + tag + ">"});
  const XmlSpan member = member_span(facet);
  std::string reference(text_.substr(member.begin, member.end - member.begin));
  const std::string_view old_id = gml_.model.name(gml_.model.nodes[its_.facets[facet]].id);
  const std::size_t at = reference.find("#" + std::string(old_id));
  if (at == std::string::npos)
    return unsupported(its_.facets[facet], "its xlink is not plain text");
  reference.replace(at + 1, old_id.size(), id.id);
  changes_.push_back(
      {member.end, member.end, std::string(indent_before(text_, member.begin)) + reference});
  return Done{};
}

/// Puts the facets into which a facet was changed in its place.
Status SolidRewriter::change_facet(Index facet, std::span<const Index> parts) {
  const Index node = its_.facets[facet];
  const std::string id(gml_.model.name(gml_.model.nodes[node].id));
  const bool is_shared = document_.uses[node] > 1;
  if (parts.empty()) return remove(facet, is_shared || document_.references.contains(id));
  Status status = Done{};
  const bool is_changed = !is_unchanged(facet, parts.front());
  if (is_changed && is_shared) {
    status = remove(facet, true);
    if (status) status = add(facet, parts.front());
  } else if (is_changed) {
    status = rewrite(facet, parts.front());
  }
  for (std::size_t i = 1; status && i < parts.size(); ++i) {
    status = is_shared ? add(facet, parts[i]) : add_part(facet, parts[i]);
  }
  return status;
}

/// Whether each facet is in the shell of the facet from which it comes.
bool SolidRewriter::keeps_shells() const {
  if (edit_.solid.shell_count() != before_.shell_count()) return false;
  for (Index shell = 0; shell < before_.shell_count(); ++shell) {
    const IndexRange own = before_.facets_of(shell);
    const IndexRange facets = edit_.solid.facets_of(shell);
    for (Index facet = facets.begin; facet < facets.end; ++facet) {
      const Index source = edit_.facet_source[facet];
      const bool is_there = source >= own.begin && source < own.end;
      if (source == kNone ? own.size() == 0 : !is_there) return false;
    }
  }
  return true;
}

Result<std::vector<TextChange>> SolidRewriter::changes() {
  if (!keeps_shells()) {
    return Error{ErrorCode::unsupported, "a shell would come or go, or facets change the shell"};
  }
  std::vector<std::vector<Index>> parts(before_.facet_count());
  for (Index facet = 0; facet < edit_.solid.facet_count(); ++facet) {
    if (edit_.facet_source[facet] != kNone) parts[edit_.facet_source[facet]].push_back(facet);
  }
  for (Index facet = 0; facet < parts.size(); ++facet) {
    if (Status changed = change_facet(facet, parts[facet]); !changed) return changed.error();
  }
  for (Index shell = 0; shell < edit_.solid.shell_count(); ++shell) {
    const IndexRange facets = edit_.solid.facets_of(shell);
    for (Index facet = facets.begin; facet < facets.end; ++facet) {
      if (edit_.facet_source[facet] != kNone) continue;
      if (Status added = add(before_.facets_of(shell).end - 1, facet); !added) return added.error();
    }
  }
  return std::move(changes_);
}

/// A solid by its positions: shells, facets and rings in an order of their own.
using RingShape = std::vector<std::array<double, 3>>;
using SolidShape = std::vector<std::vector<std::vector<RingShape>>>;

SolidShape shape_of(const Solid& solid) {
  SolidShape shape;
  for (Index shell = 0; shell < solid.shell_count(); ++shell) {
    auto& facets = shape.emplace_back();
    const IndexRange range = solid.facets_of(shell);
    for (Index facet = range.begin; facet < range.end; ++facet) {
      auto& rings = facets.emplace_back();
      const IndexRange its = solid.rings_of(facet);
      for (Index ring = its.begin; ring < its.end; ++ring) {
        RingShape& positions = rings.emplace_back();
        for (const Index vertex : solid.ring(ring)) {
          positions.push_back(solid.lattice().world(solid.vertices()[vertex]));
        }
        std::rotate(positions.begin(), std::min_element(positions.begin(), positions.end()),
                    positions.end());
      }
      if (!rings.empty()) std::ranges::sort(rings.begin() + 1, rings.end());
    }
    std::ranges::sort(facets);
  }
  return shape;
}

/// The places of the textures of polygons: elements `target` of an appearance that name them.
void remove_textures(std::string_view text, const std::set<std::string>& ids,
                     std::vector<TextChange>& changes) {
  constexpr std::string_view kUri = "uri=\"#";
  for (std::size_t at = 0; (at = text.find(kUri, at)) != std::string_view::npos;) {
    at += kUri.size();
    const std::size_t end = std::min(text.find('"', at), text.size());
    if (!ids.contains(std::string(text.substr(at, end - at)))) continue;
    const std::size_t begin = text.rfind('<', at);
    if (begin == std::string_view::npos) continue;
    const XmlSpan span = xml_span(text, begin);
    if (local_name(span.name) != "target") continue;
    changes.push_back({begin - indent_before(text, begin).size(), span.end, ""});
  }
}

/// Whether all solids of a document are those that were asked for.
bool are_as_asked(const std::vector<const Solid*>& before, const std::vector<const Solid*>& after,
                  const std::map<std::size_t, const Solid*>& asked) {
  if (before.size() != after.size()) return false;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const auto found = asked.find(i);
    const Solid& wanted = found == asked.end() ? *before[i] : *found->second;
    if (shape_of(wanted) != shape_of(*after[i])) return false;
  }
  return true;
}

std::set<std::string> references_of(const GmlModel& model) {
  std::set<std::string> references;
  for (const GmlLink& link : model.links) {
    const std::string_view href = model.name(link.reference);
    if (href.starts_with('#')) references.emplace(href.substr(1));
  }
  return references;
}

bool has_ascii(std::string_view text) {
  return text.substr(0, 4).find('\0') == std::string_view::npos;
}

/// The links through which the facets of a solid got into their shells, then the facets: equal for
/// solids that are one element.
std::vector<Index> element_key(const GmlSolidElements& solid) {
  std::vector<Index> key;
  for (const GmlMember& member : solid.members) key.push_back(member.link);
  key.insert(key.end(), solid.facets.begin(), solid.facets.end());
  return key;
}

Result<GmlText> gml_text(ByteView bytes, const ReadOptions& options) {
  auto gml = read_gml_elements(bytes, options);
  if (!gml) return std::move(gml).error();
  GmlText document;
  document.text = as_text(bytes);
  document.gml = *std::move(gml);
  document.has_new_ids = document.text.find('"' + std::string(kNewId)) != std::string_view::npos;
  document.solids = solids_of(document.gml.document);
  const GmlModel& model = document.gml.model;
  document.uses.resize(model.nodes.size());
  document.member_uses.resize(model.links.size());
  std::map<std::vector<Index>, std::size_t> numbers;
  for (const GmlSolidElements& solid : document.gml.solids) {
    const std::size_t number = document.first_of.size();
    const auto [first, is_new] = numbers.emplace(element_key(solid), number);
    document.first_of.push_back(first->second);
    if (!is_new) continue;
    for (const Index node : solid.facets) ++document.uses[node];
    for (const GmlMember& member : solid.members) {
      if (member.link != kNone) ++document.member_uses[member.link];
    }
  }
  document.owners.resize(model.nodes.size(), kNone);
  for (Index node = 0; node < model.nodes.size(); ++node) {
    if (model.nodes[node].kind != GmlKind::surfaces) continue;
    for (Index link = model.nodes[node].first_link; link != kNone; link = model.links[link].next) {
      if (model.links[link].node != kNone) document.owners[model.links[link].node] = link;
    }
  }
  document.references = references_of(model);
  return document;
}

}  // namespace

Result<EditedGml> edit_gml(ByteView bytes, const ReadOptions& options,
                           std::span<const SolidEdit> edits) {
  if (edits.empty()) return EditedGml{Bytes(bytes.begin(), bytes.end()), {}};
  if (!has_ascii(as_text(bytes))) {
    return Error{ErrorCode::unsupported, "GML in UTF-16 cannot be changed: convert it to UTF-8"};
  }
  auto document = gml_text(bytes, options);
  if (!document) return std::move(document).error();
  const GmlModel& model = document->gml.model;
  EditedGml edited;
  std::vector<TextChange> changes;
  std::map<std::size_t, const Solid*> asked;
  std::set<std::string> textured;
  std::map<std::size_t, Error> refusals;
  for (const SolidEdit& edit : edits) {
    const std::size_t first = document->first_of[edit.number];
    const auto refusal = refusals.find(first);
    if (refusal != refusals.end()) edited.refused.emplace_back(edit.number, refusal->second);
    if (first != edit.number) {
      if (refusal == refusals.end()) asked.emplace(edit.number, &edit.solid);
      continue;
    }
    SolidRewriter rewriter(*document, edit);
    auto its = rewriter.changes();
    if (!its) {
      refusals.emplace(edit.number, its.error());
      edited.refused.emplace_back(edit.number, std::move(its).error());
      continue;
    }
    changes.insert(changes.end(), its->begin(), its->end());
    asked.emplace(edit.number, &edit.solid);
    for (const Index polygon : rewriter.changed_polygons()) {
      textured.emplace(model.name(model.nodes[polygon].id));
    }
  }
  textured.erase("");
  if (!textured.empty()) remove_textures(document->text, textured, changes);
  auto changed = changed_text(document->text, std::move(changes));
  if (!changed) return std::move(changed).error();
  edited.text = Bytes(changed->begin(), changed->end());
  const auto again = read_gml(edited.text, options);
  if (!again) return again.error();
  if (!are_as_asked(document->solids, solids_of(*again), asked)) {
    return Error{ErrorCode::unsupported,
                 "the repaired solids cannot be written into this GML document"};
  }
  return edited;
}

}  // namespace watertight::formats
