// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/gml/gml.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/quantity.h"
#include "formats/gml/elements.h"
#include "formats/gml/model.h"
#include "formats/gml/ring_texts.h"
#include "formats/gml/shapes.h"
#include "formats/surface.h"
#include "formats/text/kept_text.h"
#include "formats/text/numbers.h"
#include "geometry/mesh/closure.h"

namespace watertight::formats {
namespace {

struct Draft {
  GmlSolid solid;
  SolidSource source;
  std::string unreadable;  // SubmittedSolid::unreadable
};

// The most bytes of SubmittedSolid::unreadable, which may repeat long gml:ids.
constexpr std::size_t kLongestReason = 512;

/// A geometry property that is a surface.
struct SurfaceDraft {
  Index node = kNone;
  SolidSource source;
};

class GmlReader {
 public:
  GmlReader(const GmlModel& model, std::uint64_t byte_count, const ReadOptions& options,
            std::vector<GmlSolidElements>* elements = nullptr)
      : model_(model),
        elements_(elements),
        limits_(options.limits),
        surfaces_(options.surfaces),
        shapes_(model, byte_count, options.limits),
        surface_shapes_(model, byte_count, options.limits),
        ring_uses_(model.nodes.size()) {}

  Result<Document> read() {
    document_.format = Format::gml;
    document_.graph = model_.graph;
    // The geometries of one feature need not follow one another: features can hold collections.
    std::vector<std::vector<Index>> of_object(model_.objects.size());
    std::vector<std::vector<Index>> groups;
    for (Index i = 0; i < model_.geometries.size(); ++i) {
      const GmlGeometry& geometry = model_.geometries[i];
      if (geometry.object != kNone && !geometry.is_template) {
        of_object[model_.objects[geometry.object].feature].push_back(i);
      }
    }
    std::vector<bool> is_grouped(model_.objects.size(), false);
    for (Index i = 0; i < model_.geometries.size(); ++i) {
      const GmlGeometry& geometry = model_.geometries[i];
      if (geometry.object == kNone || geometry.is_template) {
        if (auto status = feature_of({i}, geometry); !status) return std::move(status).error();
        continue;
      }
      const Index feature = model_.objects[geometry.object].feature;
      if (is_grouped[feature]) continue;
      is_grouped[feature] = true;
      auto status = feature_of(of_object[feature], geometry);
      if (!status) return std::move(status).error();
    }
    if (auto status = add_instances(); !status) return std::move(status).error();
    place_states();
    add_notes();
    return std::move(document_);
  }

  /// After read(): the use of each node that is a ring.
  std::span<GmlRingUse> ring_uses() { return ring_uses_; }

 private:
  static Error in_object(Error error, const std::string& id) {
    if (!id.empty()) error.message.append(", of object '").append(id).append("'");
    return error;
  }

  // Adds the feature of a top-level object's geometries or of a geometry outside of objects, or the
  // solids of a template.
  Status feature_of(const std::vector<Index>& geometries, const GmlGeometry& first) {
    drafts_.clear();
    positions_ = {};
    is_y_first_ = false;
    is_template_ = first.is_template;
    system_ = kNone;
    geometries_of_.clear();
    surface_drafts_.clear();
    for (const Index geometry : geometries) {
      auto status = add_geometry(model_.geometries[geometry]);
      if (!status) return status;
    }
    Feature feature;
    if (auto status = read_surfaces(feature); !status) return status;
    if (drafts_.empty() && feature.surfaces.empty()) return Done{};
    if (first.object != kNone) {
      const GmlObject& top = model_.objects[model_.objects[first.object].feature];
      feature.id = top.id;
      feature.type = top.type;
      feature.cell = top.cell;
    } else {
      feature.id = drafts_.empty() ? feature.surfaces.front().source.object_id
                                   : drafts_.front().source.object_id;
    }
    if (drafts_.empty()) feature.srid = feature.surfaces.front().solid.srid();
    auto status = drafts_.empty() ? Status(Done{}) : finish(feature);
    if (!status) return in_object(std::move(status).error(), feature.id);
    if (feature.cell != kNone) cells_.push_back({feature.cell, feature.srid, is_y_first_});
    if (first.is_template) {
      for (SubmittedSolid& solid : feature.solids) {
        document_.templates.push_back(std::move(solid));
      }
    } else {
      document_.features.push_back(std::move(feature));
    }
    return Done{};
  }

  Status add_geometry(const GmlGeometry& geometry) {
    const GmlLink& link = model_.links[geometry.link];
    // An implicit geometry that only refers to a template adds no solids; add_instances() places
    // it.
    if (geometry.is_template && link.node == kNone) return Done{};
    auto target = shapes_.resolve(link);
    SolidSource source;
    source.object_id = id_of(geometry, target ? *target : kNone);
    if (geometry.object != kNone && !geometry.is_template) {
      source.building_id = model_.objects[geometry.object].building_id;
    }
    if (geometry.lod != '\0') source.lod = geometry.lod;
    source.geometry = next_geometry(geometry.is_template, source.object_id);
    if (!target) return add_unreadable(target.error(), link.place, std::move(source));
    auto status = add_solids(*target, geometry.is_template, source);
    if (geometry.is_template) templates_of_[*target] = {source.geometry, templates_};
    if (!status) return in_object(std::move(status).error(), source.object_id);
    return status;
  }

  // Implicit geometries may refer to templates that come later, so they are placed after all
  // geometries. Those that refer to no template of solids, or to nothing in the document, are left
  // out.
  Status add_instances() {
    for (const GmlGeometry& geometry : model_.geometries) {
      if (geometry.implicit == kNone) continue;
      const GmlImplicit& implicit = model_.implicits[geometry.implicit];
      if (implicit.matrix.size == 0) continue;
      const auto target = shapes_.resolve(model_.links[geometry.link]);
      const auto numbers = target ? templates_of_.find(*target) : templates_of_.end();
      if (numbers == templates_of_.end()) continue;
      auto placement = read_placement(model_.name(implicit.matrix));
      if (!placement) {
        return in_object(
            error_at(implicit.place, placement.error().code, placement.error().message),
            id_of(geometry, *target));
      }
      TemplateInstance instance;
      instance.source.object_id = id_of(geometry, *target);
      instance.source.geometry_type = "ImplicitGeometry";
      instance.placement = *placement;
      for (Index number = numbers->second.begin; number < numbers->second.end; ++number) {
        instance.template_number = number;
        document_.instances.push_back(instance);
      }
    }
    return Done{};
  }

  // Brings the positions of states into the order of axes of their cells. A position in another
  // system than the cell is not known.
  void place_states() {
    std::vector<const CellSystem*> system_of(document_.graph.cells.size());
    for (const CellSystem& cell : cells_) system_of[cell.cell] = &cell;
    std::vector<Index> cell_of(document_.graph.states.size(), kNone);
    for (Index i = 0; i < document_.graph.cells.size(); ++i) {
      const geometry::GraphCell& cell = document_.graph.cells[i];
      if (!cell.duals.empty() && cell.duals.front().target != kNone) {
        cell_of[cell.duals.front().target] = i;
      }
    }
    for (Index i = 0; i < document_.graph.states.size(); ++i) {
      geometry::GraphState& state = document_.graph.states[i];
      const bool has_dual = !state.duals.empty() && state.duals.front().target != kNone;
      const Index cell = has_dual ? state.duals.front().target : cell_of[i];
      if (!state.position || cell == kNone || system_of[cell] == nullptr) continue;
      const std::uint32_t srid = model_.srids_of_states[i];
      if (srid != 0 && system_of[cell]->srid != 0 && srid != system_of[cell]->srid) {
        state.position.reset();
        state.fault = "its position is in another reference system than its cell";
      } else if (system_of[cell]->is_y_first) {
        std::swap((*state.position)[0], (*state.position)[1]);
      }
    }
  }

  std::string id_of(const GmlGeometry& geometry, Index node) const {
    if (geometry.object != kNone) return model_.objects[geometry.object].id;
    return node == kNone ? "" : std::string(model_.name(model_.nodes[node].id));
  }

  // The number of the next geometry of an object. Objects of one feature that have no gml:id, or
  // the same, share one count, so that id and number name one geometry.
  std::uint32_t next_geometry(bool is_template, const std::string& object_id) {
    return is_template ? templates_++ : geometries_of_[object_id]++;
  }

  // Adds the solids of a geometry: a solid itself, or the solids of a collection and of the
  // collections in it. A CompositeSolid within another collection is a geometry of its own: its
  // members must fit together, the collection's need not.
  Status add_solids(Index root, bool is_template, SolidSource source) {
    const GmlKind kind = model_.nodes[root].kind;
    if (kind == GmlKind::solid) return add_solid(root, source);
    if (is_surface(kind) && surfaces_ != Surfaces::ignore && !is_template) {
      source.geometry_type = model_.name(model_.nodes[root].name);
      surface_drafts_.push_back({root, std::move(source)});
      return Done{};
    }
    if (kind != GmlKind::solids && kind != GmlKind::mixed) {
      ++passed_over_;
      return Done{};
    }
    std::vector<Index> composites{root};
    for (std::size_t i = 0; i < composites.size(); ++i) {
      if (i > 0) source.geometry = next_geometry(is_template, source.object_id);
      source.ordinal = 0;
      if (auto status = add_members(composites[i], composites, source); !status) return status;
    }
    return Done{};
  }

  Status add_members(Index root, std::vector<Index>& composites, SolidSource& source) {
    struct Step {
      Index node;
      Index link;  // the next link to follow
    };
    std::vector<Step> path;
    const auto open = [&](Index node) -> Status {
      if (auto status = shapes_.check(node); !status) return status;
      if (!shapes_.enter(node)) {
        return error_at(model_.nodes[node].place, ErrorCode::malformed,
                        shapes_.title(node) + " contains itself by xlink");
      }
      path.push_back({node, model_.nodes[node].first_link});
      return Done{};
    };
    const bool is_composite = is_composite_solid(root);
    source.geometry_type = model_.name(model_.nodes[root].name);
    if (auto status = open(root); !status) {
      return add_unreadable(status.error(), model_.nodes[root].place, source);
    }
    while (!path.empty()) {
      const Step step = path.back();
      if (step.link == kNone) {
        shapes_.leave(step.node);
        path.pop_back();
        continue;
      }
      const GmlLink& link = model_.links[step.link];
      path.back().link = link.next;
      const auto node = shapes_.resolve(link);
      const GmlKind kind = node ? model_.nodes[*node].kind : GmlKind::unread;
      Status status = Done{};
      if (!node) {
        status = node.error();
      } else if (kind == GmlKind::solid) {
        status = add_solid(*node, source);
        ++source.ordinal;
        if (!status) return status;
      } else if (is_composite_solid(*node) && !is_composite) {
        composites.push_back(*node);
      } else if (kind == GmlKind::solids || kind == GmlKind::mixed) {
        status = open(*node);
      } else if (model_.nodes[step.node].kind == GmlKind::solids) {
        status = error_at(link.place, ErrorCode::malformed,
                          shapes_.title(*node) + " where a solid is expected");
      }
      if (status) continue;
      status = add_unreadable(status.error(), link.place, source);
      if (!status) return status;
      ++source.ordinal;
    }
    return Done{};
  }

  bool is_composite_solid(Index node) const {
    return model_.name(model_.nodes[node].name) == "CompositeSolid";
  }

  Status add_solid(Index node, SolidSource source) {
    if (source.geometry_type.empty()) source.geometry_type = model_.name(model_.nodes[node].name);
    const std::size_t positions = positions_.values.size();
    const std::size_t rounded = positions_.rounded.size();
    auto solid = shapes_.solid(node, positions_);
    if (solid) {
      if (auto status = use_system(*solid); !status) solid = status.error();
    }
    if (!solid) {
      positions_.values.resize(positions);
      positions_.rounded.resize(rounded);
      return add_unreadable(solid.error(), model_.nodes[node].place, std::move(source));
    }
    source.line = solid->place.line;
    drafts_.push_back({std::move(*solid), std::move(source), {}});
    return Done{};
  }

  // Adds a solid of which only the place is known and why it could not be read. Errors: that of the
  // solid if a limit was exceeded, because the rest of the document may exceed it too.
  Status add_unreadable(const Error& error, XmlPlace place, SolidSource source) {
    if (error.code == ErrorCode::limit_exceeded) return error;
    Draft draft;
    draft.solid.first_position = positions_.values.size();
    draft.solid.place = place;
    source.line = place.line;
    draft.source = std::move(source);
    draft.unreadable = in_object(error, draft.source.object_id).message.substr(0, kLongestReason);
    drafts_.push_back(std::move(draft));
    return Done{};
  }

  // Reads the surfaces of a feature whose solids are drafted already. Those whose polygons are all
  // facets of the solids are left out: they have been checked there. Errors: those of add_solid().
  Status read_surfaces(Feature& feature) {
    std::set<Index> used;
    for (const Draft& draft : drafts_) {
      used.insert(draft.solid.facets.begin(), draft.solid.facets.end());
    }
    const auto is_used = [&](Index polygon) { return used.contains(polygon); };
    for (SurfaceDraft& draft : surface_drafts_) {
      GmlPositions positions;
      auto shape = surface_shapes_.surface_alone(draft.node, positions);
      if (!shape && shape.error().code == ErrorCode::limit_exceeded) {
        ++surfaces_beyond_limit_;
        continue;
      }
      if (shape && !shape->facets.empty() &&
          std::all_of(shape->facets.begin(), shape->facets.end(), is_used)) {
        continue;
      }
      draft.source.line = model_.nodes[draft.node].place.line;
      auto surface = shape ? place_alone(*shape, std::move(positions), draft.source)
                           : Result<SubmittedSolid>(shape.error());
      if (!surface) surface = unread_surface(surface.error(), draft.source);
      if (!surface) return std::move(surface).error();
      const bool is_solid = surfaces_ == Surfaces::as_solids && surface->unreadable.empty() &&
                            geometry::closure_of(surface->solid).is_one_shell();
      if (!is_solid || !add_closed(draft)) feature.surfaces.push_back(std::move(*surface));
    }
    return Done{};
  }

  // Adds a surface that is one closed shell to the solids. False if it is in another system, or if
  // xlinks repeat too much: then it stays a surface.
  bool add_closed(SurfaceDraft& draft) {
    const std::size_t positions = positions_.values.size();
    const std::size_t rounded = positions_.rounded.size();
    auto solid = surface_shapes_.surface_alone(draft.node, positions_);
    if (!solid || !use_system(*solid)) {
      positions_.values.resize(positions);
      positions_.rounded.resize(rounded);
      return false;
    }
    drafts_.push_back({*std::move(solid), std::move(draft.source), {}});
    return true;
  }

  // Puts a surface on a lattice of its own.
  Result<SubmittedSolid> place_alone(GmlSolid& shape, GmlPositions positions,
                                     const SolidSource& source) {
    const bool is_y_first = is_y_first_;
    std::swap(positions, positions_);
    if (shape.system != kNone) put_longitude_first(shape.system);
    std::swap(positions, positions_);
    is_y_first_ = is_y_first;
    auto points = geometry::lattice_of_decimals(positions.values);
    if (!points) return std::move(points).error();
    const std::uint32_t srid = shape.system == kNone ? 0 : shapes_.srid(shape.system);
    auto surface = solid_of_points(std::move(shape.arrays), *points, source, srid, limits_);
    if (!surface) return std::move(surface).error();
    surface->unclosed_rings = std::move(shape.unclosed_rings);
    name_elements(shape, *surface);
    return surface;
  }

  static Result<SubmittedSolid> unread_surface(const Error& error, const SolidSource& source) {
    auto nothing = Solid::make(SolidArrays{}, Lattice{}, 0);
    if (!nothing) return std::move(nothing).error();
    SubmittedSolid surface{*std::move(nothing), source, {}};
    surface.unreadable = error.message.substr(0, kLongestReason);
    return surface;
  }

  // Takes the system of the first solid for the feature. Errors: unsupported for a solid in another
  // system. Templates have axes of their own, whatever the system of the document.
  Status use_system(const GmlSolid& solid) {
    if (is_template_) return Done{};
    if (system_ == kNone) system_ = solid.system;
    if (shapes_.is_same_system(system_, solid.system)) return Done{};
    return error_at(solid.place, ErrorCode::unsupported,
                    "a solid in '" + model_.systems[solid.system] + "' beside solids in '" +
                        model_.systems[system_] + "'");
  }

  // Swaps the first two axes of latitude, longitude, height: as x, y, z these left-handed axes
  // would turn solids inside out.
  void put_longitude_first(Index system) {
    const double pole = shapes_.pole_of_first_axis(system);
    if (pole == 0) return;
    const auto can_be_latitude = [&](const std::array<GridNumber, 3>& position) {
      const double size = std::abs(static_cast<double>(position[0].mantissa));
      return size * std::pow(10.0, position[0].exponent) <= pole;
    };
    auto& values = positions_.values;
    if (!std::all_of(values.begin(), values.end(), can_be_latitude)) {
      wrongly_ordered_.insert(model_.systems[system]);
      return;
    }
    latitude_first_.insert(model_.systems[system]);
    is_y_first_ = true;
    for (auto& position : values) std::swap(position[0], position[1]);
  }

  // Puts the drafts on their common lattice.
  Status finish(Feature& feature) {
    const Draft& first = drafts_.front();
    if (!is_template_) {
      feature.srid = shapes_.srid(system_);
      if (system_ != kNone && feature.srid == 0) unknown_systems_.insert(model_.systems[system_]);
      if (system_ != kNone) put_longitude_first(system_);
    }
    auto points = geometry::lattice_of_decimals(positions_.values);
    if (!points) return error_at(first.solid.place, points.error().code, points.error().message);
    std::vector<bool> is_rounded(points->points.size(), false);
    for (const Index position : points->rounded) is_rounded[position] = true;
    for (const Index position : positions_.rounded) is_rounded[position] = true;
    for (std::size_t i = 0; i < drafts_.size(); ++i) {
      const std::size_t begin = drafts_[i].solid.first_position;
      const std::size_t end =
          i + 1 < drafts_.size() ? drafts_[i + 1].solid.first_position : points->points.size();
      geometry::LatticePoints own{points->lattice, {}, {}};
      own.points.assign(points->points.begin() + static_cast<std::ptrdiff_t>(begin),
                        points->points.begin() + static_cast<std::ptrdiff_t>(end));
      for (std::size_t k = begin; k < end; ++k) {
        if (is_rounded[k]) own.rounded.push_back(static_cast<Index>(k - begin));
      }
      if (!is_template_) note_ring_uses(drafts_[i].solid);
      auto status = place(drafts_[i], own, feature);
      if (!status) return status;
    }
    return Done{};
  }

  // Notes which rings the next solid of the document uses first.
  void note_ring_uses(const GmlSolid& solid) {
    for (Index ring = 0; ring < solid.rings.size(); ++ring) {
      const auto [node, is_reversed] = solid.rings[ring];
      if (node == kNone || ring_uses_[node].solid != kNone) continue;
      ring_uses_[node] = {solids_, ring, is_reversed, is_y_first_};
    }
    ++solids_;
    if (elements_ == nullptr) return;
    elements_->push_back({solid.facets, solid.members, solid.rings, is_y_first_});
  }

  Status place(Draft& draft, const geometry::LatticePoints& points, Feature& feature) {
    auto solid = solid_of_points(std::move(draft.solid.arrays), points, std::move(draft.source),
                                 feature.srid, limits_);
    if (!solid) {
      return error_at(draft.solid.place, solid.error().code, solid.error().message);
    }
    solid->unclosed_rings = std::move(draft.solid.unclosed_rings);
    name_elements(draft.solid, *solid);
    solid->unreadable = std::move(draft.unreadable);
    feature.solids.push_back(std::move(*solid));
    return Done{};
  }

  // Names the elements of facets and rings by gml:id and line.
  void name_elements(const GmlSolid& draft, SubmittedSolid& solid) const {
    const std::string_view none;
    bool have_ids = false;
    for (const Index node : draft.facets) {
      solid.facet_ids.emplace_back(model_.name(model_.nodes[node].id));
      solid.facet_lines.push_back(model_.nodes[node].place.line);
      have_ids = have_ids || !solid.facet_ids.back().empty();
    }
    if (!have_ids) solid.facet_ids.clear();
    have_ids = false;
    for (const auto [node, is_reversed] : draft.rings) {
      const bool is_missing = node == kNone;
      solid.ring_ids.emplace_back(is_missing ? none : model_.name(model_.nodes[node].id));
      solid.ring_lines.push_back(is_missing ? 0 : model_.nodes[node].place.line);
      have_ids = have_ids || !solid.ring_ids.back().empty();
    }
    if (!have_ids) solid.ring_ids.clear();
  }

  void add_notes() {
    if (surfaces_beyond_limit_ > 0) {
      document_.notes.push_back(quantity(surfaces_beyond_limit_, "surface is", "surfaces are") +
                                " not checked: xlinks repeat more geometry than a document of "
                                "this size could hold");
    }
    for (const std::string& system : unknown_systems_) {
      document_.notes.push_back("reference system '" + system + "' has no known EPSG code");
    }
    for (const std::string& system : latitude_first_) {
      document_.notes.push_back("positions in '" + system +
                                "' are latitude, longitude; read as longitude, latitude");
    }
    for (const std::string& system : wrongly_ordered_) {
      document_.notes.push_back("positions in '" + system +
                                "' should be latitude, longitude, but some begin beyond the poles; "
                                "read in the order written");
    }
    if (document_.features.empty() && document_.templates.empty()) {
      document_.notes.push_back(
          "the document has no solids; " +
          quantity(passed_over_, "other geometry is", "other geometries are") + " passed over");
    }
  }

  const GmlModel& model_;
  std::vector<GmlSolidElements>* elements_;  // of the solids, in order; null: nobody asks
  const Limits& limits_;
  const Surfaces surfaces_;
  GmlShapes shapes_;
  GmlShapes surface_shapes_;  // surfaces leave the limits of the solids as they are
  std::vector<SurfaceDraft> surface_drafts_;
  std::uint64_t surfaces_beyond_limit_ = 0;
  std::map<std::string, std::uint32_t> geometries_of_;  // number of geometries, by object id
  std::map<Index, IndexRange> templates_of_;            // range of templates, by node
  std::uint32_t templates_ = 0;
  std::uint64_t passed_over_ = 0;
  std::set<std::string> unknown_systems_;
  std::set<std::string> latitude_first_;
  std::set<std::string> wrongly_ordered_;
  // How the positions of a cell were read.
  struct CellSystem {
    Index cell = kNone;
    std::uint32_t srid = 0;
    bool is_y_first = false;
  };

  std::vector<CellSystem> cells_;
  std::vector<Draft> drafts_;
  GmlPositions positions_;
  bool is_template_ = false;           // the drafts are those of a template
  Index system_ = kNone;               // the reference system of the drafts
  bool is_y_first_ = false;            // the positions of the present feature were written y, x, z
  std::vector<GmlRingUse> ring_uses_;  // by node
  Index solids_ = 0;                   // the solids of features until now
  Document document_;
};

}  // namespace

Result<Document> read_gml(ByteView bytes, const ReadOptions& options) {
  if (options.surfaces == Surfaces::as_solids && options.keep_text && options.split_features) {
    return Error{ErrorCode::unsupported,
                 "surfaces of GML cannot be stored as solids: convert the document to CityJSON"};
  }
  const auto model = read_gml_model(bytes, options.limits);
  if (!model) return model.error();
  GmlReader reader(*model, bytes.size(), options);
  auto document = reader.read();
  if (!document || !options.keep_text || options.split_features) return document;
  find_copies(*model, reader.ring_uses());
  const auto texts = ring_texts(*model, reader.ring_uses(), bytes);
  document->framing = keep_with_rings(bytes, texts, solids_of(*document));
  return document;
}

Result<GmlElements> read_gml_elements(ByteView bytes, const ReadOptions& options) {
  auto model = read_gml_model(bytes, options.limits);
  if (!model) return std::move(model).error();
  GmlElements elements{*std::move(model), {}, {}};
  auto document = GmlReader(elements.model, bytes.size(), options, &elements.solids).read();
  if (!document) return std::move(document).error();
  elements.document = *std::move(document);
  return elements;
}

}  // namespace watertight::formats
