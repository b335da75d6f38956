// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <utility>

#include "base/quantity.h"
#include "formats/city_json/model.h"
#include "formats/surface.h"
#include "geometry/mesh/closure.h"

namespace watertight::formats {
namespace {

// The JSON Pointer to the token at `position`, counted again from the start, as only errors need
// it.
std::string pointer_to(std::span<const BoundaryToken> tokens, std::size_t position) {
  std::vector<std::size_t> counters;
  for (std::size_t i = 0; i < position; ++i) {
    if (tokens[i] == kOpen) {
      counters.push_back(0);
    } else {
      if (tokens[i] == kClose) counters.pop_back();
      if (!counters.empty()) ++counters.back();
    }
  }
  std::string pointer;
  for (const std::size_t counter : counters) pointer += pointer_token(counter);
  return pointer;
}

// The arrays around those of a solid's shells: none, one in a geometry of several solids; a surface
// has one less than a solid.
constexpr int kLevelsAboveSurface = -1;

int levels_above(const GeometryRef& ref) {
  if (ref.is_surface()) return kLevelsAboveSurface;
  return ref.is_solid() ? 0 : 1;
}

// Cuts the boundaries of one geometry into the arrays of its solids, whose rings still have the
// vertex numbers of the document. A surface becomes a solid of one shell.
class SolidCutter {
 public:
  SolidCutter(std::span<const BoundaryToken> tokens, int levels_above)
      : tokens_(tokens), levels_above_(levels_above) {}

  /// Errors: malformed; limit_exceeded for more than `most_solids`.
  Status cut(std::size_t vertex_count, std::uint64_t most_solids) {
    for (position_ = 0; position_ < tokens_.size(); ++position_) {
      const BoundaryToken token = tokens_[position_];
      if (token == kOpen) {
        if (++depth_ > levels_above_ + 4) return wrong("arrays are nested too deep for a solid");
      } else if (token == kClose) {
        end_level(depth_-- - levels_above_);
        if (solids_.size() > most_solids) {
          return Error{ErrorCode::limit_exceeded, "", {}, pointer_to(tokens_, position_)};
        }
      } else {
        if (depth_ - levels_above_ != 4) {
          return wrong("a vertex index outside of a ring: the arrays are not nested deep enough");
        }
        if (token >= vertex_count) {
          return wrong("vertex index " + std::to_string(token) + " is out of range (" +
                       quantity(vertex_count, "vertex", "vertices") + ')');
        }
        current_.ring_vertices.push_back(token);
      }
    }
    if (levels_above_ == kLevelsAboveSurface) solids_.push_back(std::move(current_));
    return Done{};
  }

  std::vector<SolidArrays>& solids() { return solids_; }

 private:
  Error wrong(std::string message) const {
    return Error{ErrorCode::malformed, std::move(message), {}, pointer_to(tokens_, position_)};
  }

  void end_level(int level) {
    if (level == 4) current_.end_ring();
    if (level == 3) current_.end_facet();
    if (level == 2) current_.end_shell();
    if (level == 1) solids_.push_back(std::exchange(current_, SolidArrays{}));
  }

  std::span<const BoundaryToken> tokens_;
  int levels_above_;
  int depth_ = 0;
  std::size_t position_ = 0;
  SolidArrays current_;
  std::vector<SolidArrays> solids_;
};

struct CutSolid {
  SolidArrays arrays;
  std::vector<Index> vertex_of;
  SolidSource source;
  std::uint32_t object = 0;
  std::size_t boundary = 0;
};

std::string boundary_pointer(const ModelIndex& index, const GeometryRef& ref) {
  if (index.are_templates) {
    return "/geometry-templates/templates" + pointer_token(ref.geometry) + "/boundaries";
  }
  return "/CityObjects" + pointer_token(index.ids[ref.object]) + "/geometry" +
         pointer_token(ref.geometry) + "/boundaries";
}

CutSolid cut_solid(SolidArrays arrays, const GeometryRef& ref, const ModelIndex& index,
                   std::uint32_t ordinal, std::vector<Index>& number_of) {
  CutSolid cut;
  cut.vertex_of = number_by_first_use(arrays, number_of);
  cut.arrays = std::move(arrays);
  const bool is_one = ref.is_solid() || ref.is_surface();
  std::string pointer = boundary_pointer(index, ref);
  if (!is_one) pointer += pointer_token(ordinal);
  cut.source = {index.ids[ref.object], ref.type, ref.lod,
                ref.geometry,          ordinal,  std::move(pointer)};
  const Index building = index.are_templates ? kNone : index.building_of[ref.object];
  if (building != kNone) cut.source.building_id = index.ids[building];
  cut.object = ref.object;
  cut.boundary = ref.boundary;
  return cut;
}

/// Errors: limit_exceeded for more solids than a text of this length can have.
Result<std::vector<CutSolid>> cut_solids(const CityModel& model, ModelIndex& index,
                                         const Limits& limits) {
  const std::uint64_t most = limits.solids_of(model.text_bytes);
  std::vector<CutSolid> all;
  std::vector<Index> number_of(model.vertices.size(), kNone);
  for (GeometryRef& ref : index.geometries) {
    const std::string pointer = boundary_pointer(index, ref);
    const auto note_unreadable = [&](Error error) {
      UnreadablePart part;
      part.source = {index.ids[ref.object], ref.type, ref.lod,
                     ref.geometry,          0,        pointer + error.pointer};
      error.pointer = part.source.pointer;
      part.error = std::move(error);
      ref.is_unreadable = true;
      index.unreadable.push_back({ref.object, std::move(part)});
    };
    const auto tokens = model.boundary(ref.boundary);
    if (ref.type == "GeometryInstance") continue;  // city_instances() checks them
    if (!ref.is_of_solids()) {
      if (auto status = check_vertices(tokens, model.vertices); !status) {
        note_unreadable(std::move(status).error());
      }
      continue;
    }
    SolidCutter cutter(tokens, levels_above(ref));
    const std::uint64_t found = all.size() + index.unreadable.size();
    if (auto status = cutter.cut(model.vertices.size(), most - std::min(found, most)); !status) {
      if (status.error().code == ErrorCode::limit_exceeded || found >= most) {
        return Error{ErrorCode::limit_exceeded,
                     "more than " + std::to_string(most) + " solids in " +
                         quantity(model.text_bytes, "byte"),
                     {},
                     pointer};
      }
      note_unreadable(std::move(status).error());
      continue;
    }
    auto usable =
        model.vertices.faulty.empty() ? Status(Done{}) : check_vertices(tokens, model.vertices);
    if (!usable) {
      note_unreadable(std::move(usable).error());
      continue;
    }
    std::uint32_t ordinal = 0;
    for (SolidArrays& arrays : cutter.solids()) {
      all.push_back(cut_solid(std::move(arrays), ref, index, ordinal++, number_of));
    }
  }
  return all;
}

Result<geometry::LatticePoints> lattice_of(const CityModel& model, std::span<const Index> used,
                                           const CityHeader& header) {
  const VertexList& list = model.vertices;
  if (!list.are_integers) {
    std::vector<std::array<GridNumber, 3>> decimals;
    decimals.reserve(used.size());
    for (const Index vertex : used) decimals.push_back(list.decimals[vertex]);
    return geometry::lattice_of_decimals(decimals);
  }
  std::vector<std::array<std::int64_t, 3>> integers;
  integers.reserve(used.size());
  for (const Index vertex : used) integers.push_back(list.integers[vertex]);
  return geometry::lattice_of_integers(integers, header.transform.value_or(geometry::Transform{}));
}

// Puts the cut solids of one top-level object on their common lattice.
class FeatureLattice {
 public:
  FeatureLattice(const CityModel& model, const CityHeader& header, const Limits& limits)
      : model_(model),
        header_(header),
        limits_(limits),
        slot_of_(model.vertices.size(), kNone),
        was_rounded_(model.vertices.size(), false) {
    for (const Index vertex : model.vertices.rounded) was_rounded_[vertex] = true;
  }

  // Puts one geometry on a lattice of its own.
  Result<CitySolid> place_alone(CutSolid cut) {
    std::vector<CutSolid> one;
    one.push_back(std::move(cut));
    auto nothing = Solid::make(SolidArrays{}, Lattice{}, 0);
    if (!nothing) return std::move(nothing).error();
    std::vector<CitySolid> placed{CitySolid{SubmittedSolid{*std::move(nothing), {}, {}}, {}, 0, 0}};
    const std::size_t first = 0;
    if (auto status = place(one, {&first, 1}, placed); !status) return status.error();
    return std::move(placed.front());
  }

  Status place(std::vector<CutSolid>& cut, std::span<const std::size_t> members,
               std::vector<CitySolid>& solids) {
    std::vector<Index> used;
    for (const std::size_t i : members) {
      for (const Index vertex : cut[i].vertex_of) {
        if (slot_of_[vertex] != kNone) continue;
        slot_of_[vertex] = static_cast<Index>(used.size());
        used.push_back(vertex);
      }
    }
    auto status = place_used(cut, members, used, solids);
    for (const Index vertex : used) slot_of_[vertex] = kNone;
    return status;
  }

 private:
  Status place_used(std::vector<CutSolid>& cut, std::span<const std::size_t> members,
                    std::span<const Index> used, std::vector<CitySolid>& solids) {
    const std::string pointer = cut[members.front()].source.pointer;
    if (used.size() > limits_.vertices) {
      return Error{ErrorCode::limit_exceeded,
                   std::to_string(used.size()) + " vertices in one feature; the limit is " +
                       std::to_string(limits_.vertices),
                   {},
                   pointer};
    }
    auto lattice = lattice_of(model_, used, header_);
    if (!lattice) return located(lattice.error(), pointer);
    std::vector<bool> is_rounded(used.size(), false);
    for (const Index slot : lattice->rounded) is_rounded[slot] = true;
    for (std::size_t slot = 0; slot < used.size(); ++slot) {
      if (was_rounded_[used[slot]]) is_rounded[slot] = true;
    }
    for (const std::size_t i : members) {
      auto solid = make(cut[i], *lattice, is_rounded);
      if (!solid) return located(solid.error(), cut[i].source.pointer);
      solids[i] = std::move(*solid);
    }
    return Done{};
  }

  static Error located(Error error, const std::string& pointer) {
    if (error.pointer.empty()) error.pointer = pointer;
    return error;
  }

  Result<CitySolid> make(CutSolid& cut, const geometry::LatticePoints& lattice,
                         const std::vector<bool>& is_rounded) {
    std::vector<Index> rounded;
    cut.arrays.vertices.reserve(cut.vertex_of.size());
    for (Index i = 0; i < cut.vertex_of.size(); ++i) {
      const Index slot = slot_of_[cut.vertex_of[i]];
      cut.arrays.vertices.push_back(lattice.points[slot]);
      if (is_rounded[slot]) rounded.push_back(i);
    }
    auto solid = Solid::make(std::move(cut.arrays), lattice.lattice, header_.srid, limits_);
    if (!solid) return solid.error();
    CitySolid made{SubmittedSolid{std::move(*solid), std::move(cut.source), std::move(rounded)},
                   std::move(cut.vertex_of), cut.object, cut.boundary};
    made.submitted.is_origin_rounded = lattice.is_origin_rounded;
    return made;
  }

  const CityModel& model_;
  const CityHeader& header_;
  const Limits& limits_;
  std::vector<Index> slot_of_;     // the point of each document vertex; kNone between features
  std::vector<bool> was_rounded_;  // whether reading rounded a document vertex
};

// Reads the surfaces of a model. One that cannot be read is a surface with the reason.
class SurfaceReader {
 public:
  SurfaceReader(const CityModel& model, ModelIndex& index, const CityHeader& header,
                const Limits& limits)
      : model_(model),
        index_(index),
        lattice_(model, header, limits),
        number_of_(model.vertices.size(), kNone) {}

  /// Adds each surface to index.surfaces. With `are_solids` those that are one closed shell are
  /// marked instead, so that cut_solids() takes them.
  Status read(bool are_solids) {
    for (GeometryRef& ref : index_.geometries) {
      if (!ref.is_surface() || ref.is_unreadable) continue;
      const auto tokens = model_.boundary(ref.boundary);
      if (!check_vertices(tokens, model_.vertices)) continue;  // cut_solids() notes the fault
      auto surface = read_one(ref, tokens);
      if (!surface) {
        if (auto status = add_unreadable(ref, surface.error()); !status) return status;
      } else if (are_solids && geometry::closure_of(surface->submitted.solid).is_one_shell()) {
        ref.is_closed_surface = true;
      } else {
        index_.surfaces.push_back({ref.object, std::move(surface->submitted)});
      }
    }
    return Done{};
  }

 private:
  Result<CitySolid> read_one(const GeometryRef& ref, std::span<const BoundaryToken> tokens) {
    SolidCutter cutter(tokens, kLevelsAboveSurface);
    if (auto status = cutter.cut(model_.vertices.size(), 1); !status) return status.error();
    return lattice_.place_alone(
        cut_solid(std::move(cutter.solids().front()), ref, index_, 0, number_of_));
  }

  Status add_unreadable(const GeometryRef& ref, const Error& error) {
    auto nothing = Solid::make(SolidArrays{}, Lattice{}, 0);
    if (!nothing) return std::move(nothing).error();
    const std::string pointer = boundary_pointer(index_, ref);
    SubmittedSolid surface{*std::move(nothing),
                           {index_.ids[ref.object], ref.type, ref.lod, ref.geometry, 0, pointer},
                           {}};
    surface.unreadable = error.message;
    index_.surfaces.push_back({ref.object, std::move(surface)});
    return Done{};
  }

  const CityModel& model_;
  ModelIndex& index_;
  FeatureLattice lattice_;
  std::vector<Index> number_of_;
};

}  // namespace

Status check_vertices(std::span<const BoundaryToken> tokens, const VertexList& list) {
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    if (tokens[i] >= kClose) continue;
    if (tokens[i] >= list.size()) {
      return Error{ErrorCode::malformed,
                   "vertex index " + std::to_string(tokens[i]) + " is out of range (" +
                       quantity(list.size(), "vertex", "vertices") + ')',
                   {},
                   pointer_to(tokens, i)};
    }
    if (const FaultyVertex* fault = list.fault_of(tokens[i]); fault != nullptr) {
      return Error{ErrorCode::malformed,
                   "vertex " + std::to_string(tokens[i]) +
                       " is none: " + std::string(fault->reason) + " (at /vertices" +
                       pointer_token(tokens[i]) + fault->place + ')',
                   {},
                   pointer_to(tokens, i)};
    }
  }
  return Done{};
}

Result<std::vector<CitySolid>> city_solids(const CityModel& model, ModelIndex& index,
                                           const CityHeader& header, const Limits& limits,
                                           Surfaces surfaces) {
  if (surfaces != Surfaces::ignore) {
    auto status = SurfaceReader(model, index, header, limits).read(surfaces == Surfaces::as_solids);
    if (!status) return std::move(status).error();
  }
  auto found = cut_solids(model, index, limits);
  if (!found) return std::move(found).error();
  std::vector<CutSolid> cut = *std::move(found);
  const bool is_one_feature = string_member(model.root, "type") == "CityJSONFeature";

  std::vector<std::size_t> order(cut.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto root_of = [&](std::size_t i) {
    return is_one_feature ? 0 : index.root_of[cut[i].object];
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return root_of(a) < root_of(b); });

  // The loop assigns every entry, because each solid belongs to one top-level object.
  auto nothing = Solid::make(SolidArrays{}, Lattice{}, 0);
  if (!nothing) return std::move(nothing).error();
  std::vector<CitySolid> solids(cut.size(), CitySolid{SubmittedSolid{*nothing, {}, {}}, {}, 0, 0});
  FeatureLattice feature(model, header, limits);
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin;
    while (end < order.size() && root_of(order[end]) == root_of(order[begin])) ++end;
    const std::span<const std::size_t> members(order.data() + begin, end - begin);
    if (auto status = feature.place(cut, members, solids); !status) return status.error();
    begin = end;
  }
  return solids;
}

}  // namespace watertight::formats
