// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/part21/boundary_reader.h"

#include <algorithm>
#include <array>
#include <utility>

#include "formats/part21/boundary_curves.h"

namespace watertight::formats {
namespace {

using surfaces::BoundaryEdge;
using surfaces::BoundaryFace;
using surfaces::EdgeLoop;
using surfaces::OrientedEdge;
using surfaces::Vector3;

constexpr std::array<std::string_view, 9> kSolids{"ADVANCEDBREP",
                                                  "ADVANCEDBREPWITHVOIDS",
                                                  "FACETEDBREP",
                                                  "FACETEDBREPWITHVOIDS",
                                                  "MANIFOLDSOLIDBREP",
                                                  "BREPWITHVOIDS",
                                                  "FACETEDBREPANDBREPWITHVOIDS",
                                                  "POLYGONALFACESET",
                                                  "TRIANGULATEDFACESET"};

class BoundaryReader {
 public:
  BoundaryReader(const Part21& file, double radians, const Limits& limits)
      : reader_(file), radians_(radians), limits_(limits) {}

  Result<ReadBoundary> read(std::uint64_t id) {
    const auto found = reader_.entity(id);
    if (!found) return found.error();
    if (!is_solid_type(found->type)) {
      return Error{ErrorCode::unsupported,
                   "solids of the kind " + found->type + " are not read",
                   found->offset,
                   {}};
    }
    const bool is_face_set = found->type.ends_with("FACESET");
    Status status = is_face_set ? face_set(*found) : shells(*found);
    if (!status) return status.error();
    return std::move(result_);
  }

 private:
  surfaces::BoundaryRepresentation& solid() { return result_.solid; }

  Status shells(const PlainEntity& brep) {
    const auto outer = reader_.reference(brep, 0);
    if (!outer) return outer.error();
    if (Status status = shell(*outer); !status) return status;
    if (!brep.type.ends_with("VOIDS")) return Done{};
    const auto voids = reader_.references(brep, 1);
    if (!voids) return voids.error();
    for (const std::uint64_t id : *voids) {
      if (solid().shells.size() >= limits_.shells) return too_many("shells", limits_.shells);
      if (Status status = shell(id); !status) return status;
    }
    return Done{};
  }

  Error too_many(const std::string& things, std::uint64_t limit) const {
    return Error{ErrorCode::limit_exceeded,
                 "more " + things + " in one solid than the limit of " + std::to_string(limit),
                 {},
                 {}};
  }

  Status shell(std::uint64_t id) {
    auto found = reader_.entity(id);
    if (!found) return found.error();
    bool is_turned = false;
    if (found->type == "ORIENTEDCLOSEDSHELL") {
      is_turned = found->values.size() > 2 && !found->values[2].is_true();
      found = reader_.entity(*found, 1);
      if (!found) return found.error();
    }
    if (!found->type.ends_with("SHELL")) return reader_.error(*found, "a shell should stand here");
    const auto faces = reader_.references(*found, 0);
    if (!faces) return faces.error();
    solid().shells.emplace_back();
    face_on_.clear();
    for (const std::uint64_t face_id : *faces) {
      if (solid().faces.size() >= limits_.facets) return too_many("faces", limits_.facets);
      if (Status status = face(face_id, is_turned); !status) return status;
    }
    return Done{};
  }

  /// ADVANCEDFACE and FACESURFACE: bounds, surface, sense. FACE: bounds.
  Status face(std::uint64_t id, bool is_turned) {
    const auto found = reader_.entity(id);
    if (!found) return found.error();
    if (!found->type.ends_with("FACE") && found->type != "FACESURFACE") {
      return reader_.error(*found, "a face should stand here");
    }
    BoundaryFace face;
    face.name = instance_name(id);
    if (reader_.has(*found, 1)) {
      const auto surface_id = reader_.reference(*found, 1);
      if (!surface_id) return surface_id.error();
      auto surface = read_surface(reader_, *surface_id, radians_);
      if (surface) {
        face.surface = *std::move(surface);
      } else if (surface.error().code == ErrorCode::unsupported) {
        face.unreadable = surface.error().message;
      } else {
        return surface.error();
      }
      face.is_along_surface = found->values.size() > 2 && found->values[2].is_true();
    }
    const auto bounds = reader_.references(*found, 0);
    if (!bounds) return bounds.error();
    if (bounds->empty()) face.unreadable = "the face has no loop";
    for (const std::uint64_t bound_id : *bounds) {
      if (Status status = bound(bound_id, face); !status) return status;
    }
    if (is_turned) {
      face.is_along_surface = !face.is_along_surface;
      for (EdgeLoop& loop : face.loops) turn(loop);
    }
    if (face.loops.empty() && face.unreadable.empty()) {
      face.unreadable = "the face has no loop of edges";
    }
    if (has_only_holes(*found, face) && adds_holes(*found, face)) return Done{};
    if (reader_.has(*found, 1)) {
      face_on_[found->values[1].id] = static_cast<Index>(solid().faces.size());
    }
    solid().shells.back().push_back(static_cast<Index>(solid().faces.size()));
    solid().faces.push_back(std::move(face));
    return Done{};
  }

  /// Whether a face of IFC has loops, and none of them is called its outer one.
  static bool has_only_holes(const PlainEntity& from, const BoundaryFace& face) {
    return !from.is_step && !face.loops.empty() && !face.outer;
  }

  /// Adds the loops of a face without an outer one to the face before it on the same plane: some
  /// programs write a face with a hole as two.
  bool adds_holes(const PlainEntity& from, BoundaryFace& holes) {
    if (holes.surface || !reader_.has(from, 1)) return false;
    const auto other = face_on_.find(from.values[1].id);
    if (other == face_on_.end()) return false;
    BoundaryFace& face = solid().faces[other->second];
    result_.notes.push_back(holes.name + " has no outer loop: its loops are read as loops of " +
                            face.name + ", which lies on the same plane");
    face.loops.insert(face.loops.end(), holes.loops.begin(), holes.loops.end());
    face.outer.reset();  // the largest
    return true;
  }

  Status bound(std::uint64_t id, BoundaryFace& face) {
    const auto found = reader_.entity(id);
    if (!found) return found.error();
    const auto loop_entity = reader_.entity(*found, 0);
    if (!loop_entity) return loop_entity.error();
    // A loop that is one vertex lies at a pole, which the surface has without it.
    if (loop_entity->type == "VERTEXLOOP") return Done{};
    auto loop = loop_entity->type == "POLYLOOP" ? poly_loop(*loop_entity) : edge_loop(*loop_entity);
    if (!loop) return loop.error();
    const bool is_along = found->values.size() < 2 || found->values[1].is_true();
    if (!is_along) turn(*loop);
    if (found->type == "FACEOUTERBOUND") face.outer = face.loops.size();
    face.loops.push_back(*std::move(loop));
    return Done{};
  }

  Result<EdgeLoop> edge_loop(const PlainEntity& from) {
    if (from.type != "EDGELOOP") {
      return Error{ErrorCode::unsupported,
                   "loops of the kind " + from.type + " are not read",
                   from.offset,
                   {}};
    }
    const auto ids = reader_.references(from, 0);
    if (!ids) return ids.error();
    EdgeLoop loop;
    for (const std::uint64_t id : *ids) {
      const auto oriented = reader_.entity(id);
      if (!oriented) return oriented.error();
      if (oriented->type != "ORIENTEDEDGE") {
        return reader_.error(*oriented, "an oriented edge should stand here");
      }
      const auto edge_id = reader_.reference(*oriented, 2);
      if (!edge_id) return edge_id.error();
      const auto edge = edge_of(*edge_id);
      if (!edge) return edge.error();
      const bool is_forward = oriented->values.size() > 3 && oriented->values[3].is_true();
      loop.push_back({*edge, is_forward});
    }
    // The end of each edge is the start of the next.
    for (std::size_t i = 0; i < loop.size(); ++i) {
      if (end_of(loop[i], false) != end_of(loop[(i + 1) % loop.size()], true)) {
        return reader_.error(
            from, "edge " + std::to_string(i + 1) + " does not end where the next one starts");
      }
    }
    return loop;
  }

  Index end_of(const OrientedEdge& oriented, bool wants_start) const {
    const BoundaryEdge& edge = result_.solid.edges[oriented.edge];
    return oriented.is_forward == wants_start ? edge.start : edge.end;
  }

  Result<Index> edge_of(std::uint64_t id) {
    if (const auto known = edges_.find(id); known != edges_.end()) return known->second;
    const auto found = reader_.entity(id);
    if (!found) return found.error();
    if (found->type != "EDGECURVE") return reader_.error(*found, "an edge should stand here");
    BoundaryEdge edge;
    for (const std::size_t end : {0, 1}) {
      const auto vertex_id = reader_.reference(*found, end);
      if (!vertex_id) return vertex_id.error();
      const auto vertex = vertex_of(*vertex_id);
      if (!vertex) return vertex.error();
      (end == 0 ? edge.start : edge.end) = *vertex;
    }
    const auto curve_id = reader_.reference(*found, 2);
    if (!curve_id) return curve_id.error();
    auto curve = read_curve(reader_, *curve_id);
    if (!curve) return curve.error();
    edge.curve = *std::move(curve);
    edge.is_along_curve = found->values.size() > 3 && found->values[3].is_true();
    make_straight(edge);
    const auto index = static_cast<Index>(solid().edges.size());
    edges_.emplace(id, index);
    solid().edges.push_back(std::move(edge));
    return index;
  }

  /// A straight edge goes from vertex to vertex, also where its line is given in two coordinates.
  void make_straight(BoundaryEdge& edge) {
    const bool is_line = edge.curve.pieces.size() == 1 && edge.curve.pieces[0].degree() == 1;
    if (!is_line || edge.start == edge.end) return;
    edge.curve = {};
  }

  Result<Index> vertex_of(std::uint64_t id) {
    if (const auto known = vertices_.find(id); known != vertices_.end()) return known->second;
    const auto found = reader_.entity(id);
    if (!found) return found.error();
    auto point_id = reader_.reference(*found, 0);
    if (found->type == "CARTESIANPOINT") point_id = id;
    if (!point_id) return point_id.error();
    const auto point = reader_.triple(*point_id);
    if (!point) return point.error();
    if (solid().vertices.size() >= limits_.vertices) return too_many("vertices", limits_.vertices);
    const auto index = static_cast<Index>(solid().vertices.size());
    vertices_.emplace(id, index);
    solid().vertices.push_back(*point);
    return index;
  }

  Result<EdgeLoop> poly_loop(const PlainEntity& from) {
    const auto ids = reader_.references(from, 0);
    if (!ids) return ids.error();
    std::vector<Index> ring;
    for (const std::uint64_t id : *ids) {
      const auto vertex = vertex_of(id);
      if (!vertex) return vertex.error();
      ring.push_back(*vertex);
    }
    return straight_loop(ring);
  }

  EdgeLoop straight_loop(const std::vector<Index>& ring) {
    EdgeLoop loop;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Index start = ring[i];
      const Index end = ring[(i + 1) % ring.size()];
      loop.push_back({static_cast<Index>(solid().edges.size()), true});
      solid().edges.push_back({start, end, {}, true});
    }
    return loop;
  }

  /// POLYGONALFACESET: points, closed, faces, numbers. TRIANGULATEDFACESET: points, normals,
  /// closed, triples, numbers.
  Status face_set(const PlainEntity& set) {
    const auto list = reader_.entity(set, 0);
    if (!list) return list.error();
    if (list->values.empty() || list->values[0].kind != StepValue::Kind::list) {
      return reader_.error(*list, "a list of points should stand here");
    }
    for (const StepValue& item : list->values[0].items) {
      const bool is_point =
          item.kind == StepValue::Kind::list && item.items.size() == 3 &&
          std::all_of(item.items.begin(), item.items.end(),
                      [](const StepValue& value) { return value.kind == StepValue::Kind::number; });
      if (!is_point) return reader_.error(*list, "a point without three coordinates");
      if (solid().vertices.size() >= limits_.vertices) {
        return too_many("vertices", limits_.vertices);
      }
      solid().vertices.push_back(
          {item.items[0].number, item.items[1].number, item.items[2].number});
    }
    solid().shells.emplace_back();
    const bool is_triangulated = set.type == "TRIANGULATEDFACESET";
    const std::size_t faces = is_triangulated ? 3 : 2;
    numbers_ = nullptr;
    if (set.values.size() > faces + 1 && set.values[faces + 1].kind == StepValue::Kind::list) {
      numbers_ = &set.values[faces + 1].items;
    }
    if (set.values.size() <= faces || set.values[faces].kind != StepValue::Kind::list) {
      return reader_.error(set, "a list of faces should stand here");
    }
    for (const StepValue& item : set.values[faces].items) {
      if (solid().faces.size() >= limits_.facets) return too_many("faces", limits_.facets);
      BoundaryFace face;
      face.name = instance_name(set.id) + " face " + std::to_string(solid().faces.size() + 1);
      face.outer = 0;
      Status status = is_triangulated ? indexed_ring(set, item, face) : indexed_face(item, face);
      if (!status) return status;
      solid().shells.back().push_back(static_cast<Index>(solid().faces.size()));
      solid().faces.push_back(std::move(face));
    }
    return Done{};
  }

  Status indexed_face(const StepValue& reference, BoundaryFace& face) {
    const auto found = reader_.entity(reference.id);
    if (!found) return found.error();
    if (found->values.empty()) return reader_.error(*found, "it has no ring");
    if (Status status = indexed_ring(*found, found->values[0], face); !status) return status;
    if (found->values.size() < 2) return Done{};
    for (const StepValue& inner : found->values[1].items) {
      if (Status status = indexed_ring(*found, inner, face); !status) return status;
    }
    return Done{};
  }

  Status indexed_ring(const PlainEntity& from, const StepValue& ring, BoundaryFace& face) {
    std::vector<Index> vertices;
    for (const StepValue& item : ring.items) {
      double number = item.kind == StepValue::Kind::number ? item.number : 0;
      if (numbers_ != nullptr && number >= 1 && number <= static_cast<double>(numbers_->size())) {
        number = (*numbers_)[static_cast<std::size_t>(number) - 1].number;
      }
      if (!(number >= 1 && number <= static_cast<double>(solid().vertices.size()))) {
        return reader_.error(from, "a ring names a point that there is not");
      }
      vertices.push_back(static_cast<Index>(number) - 1);
    }
    face.loops.push_back(straight_loop(vertices));
    return Done{};
  }

  EntityReader reader_;
  double radians_;
  const Limits& limits_;
  std::map<std::uint64_t, Index> vertices_;          // instance -> vertex
  std::map<std::uint64_t, Index> edges_;             // instance -> edge
  std::map<std::uint64_t, Index> face_on_;           // surface -> last face of the shell on it
  const std::vector<StepValue>* numbers_ = nullptr;  // of points, where a set of faces has its own
  ReadBoundary result_;
};

}  // namespace

bool is_solid_type(std::string_view plain) {
  return std::find(kSolids.begin(), kSolids.end(), plain) != kSolids.end();
}

Result<ReadBoundary> read_boundary(const Part21& file, std::uint64_t id, double radians,
                                   const Limits& limits) {
  return BoundaryReader(file, radians, limits).read(id);
}

}  // namespace watertight::formats
