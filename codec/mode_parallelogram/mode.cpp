// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <numeric>

#include "codec/entropy/bank_trial.h"
#include "codec/mode_parallelogram/corner_contexts.h"
#include "codec/mode_parallelogram/cut_surface.h"
#include "codec/mode_parallelogram/families.h"
#include "codec/mode_parallelogram/front.h"
#include "codec/mode_parallelogram/vectors.h"
#include "codec/mode_parallelogram/vertex_coder.h"
#include "codec/page/modes.h"
#include "codec/page/writer_choice.h"
#include "geometry/mesh/half_edges.h"

namespace watertight::codec::parallelogram {

namespace {

constexpr int kCandidateSteps = 256;
constexpr int kRankBits = 32;
constexpr Scale<32> kRoomsForNew{.per_unit = 4};  // classes of the room of a corner, for New
constexpr double kMostAveraged = 1000;  // the number of edges that the mean edge remembers

Error not_closed() { return {ErrorCode::malformed, "the triangles do not form a closed surface"}; }

/// Codes the triangles and vertices of a solid in the order of the stream.
class SurfaceCoder {
 public:
  SurfaceCoder(EntropyStream& stream, ModelBank& models, const PageMemory& memory,
               const Limits& limits)
      : stream_(stream),
        models_(models),
        limits_(limits),
        vertices_(stream, models, memory, limits) {}

  /// For measuring: code() ends after this many triangles.
  void stop_after(std::size_t triangles) { most_triangles_ = triangles; }
  std::size_t triangle_count() const { return front_.triangles().size(); }

  Status code(const CutSurface* surface, IntegerSolid& solid, const VertexOptions& options) {
    surface_ = surface;
    vertices_.code_options(options);
    if (surface_) {
      code_of_.assign(surface_->positions.size(), kNone);
      gate_of_.assign(surface_->twin.size(), kNone);
    }
    bool has_more = true;
    for (Index component = 0; has_more; ++component) {
      if (component > 0) {
        shells_.push_back(models_.code<kNewShell>(stream_, {kNothingKnown},
                                                  surface_ && surface_->is_new_shell[component]));
      }
      starts_.push_back(static_cast<Index>(front_.triangles().size()));
      if (Status coded = code_component(component); !coded) return coded;
      if (triangle_count() >= most_triangles_) return Done{};
      has_more = models_.code<kMore>(stream_, {Context<2>(component > 0)},
                                     surface_ && component + 1 < surface_->component_first.size());
    }
    return is_writing() ? Status(Done{}) : finish(solid);
  }

 private:
  bool is_writing() const { return surface_ != nullptr; }
  Index true_vertex(Index half_edge) const {
    return geometry::start_of(surface_->triangles, half_edge);
  }
  const GridPoint* true_position(Index true_index) const {
    return is_writing() ? &surface_->positions[true_index] : nullptr;
  }

  Status code_component(Index component) {
    std::array<Index, 3> half_edges{kNone, kNone, kNone};
    std::array<Index, 3> truth{};
    if (is_writing()) {
      const Index first = 3 * surface_->component_first[component];
      half_edges = {first, first + 1, first + 2};
      for (std::size_t k = 0; k < 3; ++k) truth[k] = true_vertex(half_edges[k]);
    }
    Triangle seed{};
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (Status coded = vertices_.code_seed(k, true_position(truth[k])); !coded) return coded;
      seed[k] = note_vertex(truth[k]);
    }
    front_.add_seed(seed, half_edges);
    note_gates(3);
    return walk();
  }

  static Status stuck() {
    return Error{ErrorCode::not_encodable, "two triangles meet along two edges"};
  }

  /// Notes the vertex that was coded last, and returns its number.
  Index note_vertex(Index true_index) {
    const Index vertex = vertices_.count() - 1;
    if (is_writing()) code_of_[true_index] = vertex;
    stream_.enter(StreamPart::connectivity);
    return vertex;
  }

  /// When writing, notes the half-edges of the last `count` gates of the front.
  void note_gates(Index count) {
    if (!is_writing()) return;
    for (Index gate = front_.gate_count() - count; gate < front_.gate_count(); ++gate) {
      gate_of_[front_[gate].half_edge] = gate;
    }
  }

  /// Codes triangles until the component is closed.
  Status walk() {
    for (Index corner = front_.next_corner(); corner != kNone; corner = front_.next_corner()) {
      if (is_stuck_) return stuck();
      if (stream_.failed()) return not_closed();
      if (front_.triangles().size() >= limits_.facets) {
        return Error{ErrorCode::limit_exceeded, "the solid has too many facets"};
      }
      if (triangle_count() >= most_triangles_) return Done{};
      if (!front_[corner].is_refused && code_close(corner)) continue;
      const Index before = front_[corner].previous;
      if (!front_[before].is_refused && code_close(before)) continue;
      if (Status extended = extend(corner); !extended) return extended;
    }
    if (is_stuck_) return stuck();
    return front_.open_count() == 0 ? Status(Done{}) : Status(not_closed());
  }

  /// Codes whether a triangle fills the corner; adds the triangle or refuses the corner.
  bool code_close(Index corner) {
    const Gate& gate = front_[corner];
    const Gate& after = front_[gate.next];
    const bool ends = after.next == gate.previous;
    Index half_edge = kNone;
    bool truth = false;
    if (is_writing()) {
      const Index beyond = surface_->twin[gate.half_edge];
      truth = surface_->twin[geometry::previous_half_edge(beyond)] == after.half_edge;
      half_edge = geometry::next_half_edge(beyond);
      if (ends && truth) {
        // A loop of three gates ends with one triangle beyond all of them. A triangle beyond only
        // two of them cannot be coded.
        is_stuck_ = surface_->twin[half_edge] != front_[gate.previous].half_edge;
      }
    }
    const CornerView view{front_,
                          centres_,
                          corner,
                          vertices_.predict(front_, corner),
                          vertices_.predict(front_, gate.next),
                          mean_edge_,
                          close_answers_.last()};
    const SelectorOf<kClose> selector(ends ? 2U : front_[gate.previous].is_refused ? 1U : 0U);
    const bool closes = models_.code<kClose>(stream_, selector, corner_contexts(view), truth);
    close_answers_.add(closes);
    if (closes) {
      front_.close_corner(corner, half_edge);
      if (!ends) note_gates(1);
      return true;
    }
    front_.refuse(corner);
    if (ends) {  // one triangle would close all three corners
      front_.refuse(gate.next);
      front_.refuse(gate.previous);
    }
    return false;
  }

  /// Codes the triangle beyond the gate, which has a new vertex or joins the front elsewhere.
  Status extend(Index corner) {
    const Gate gate = front_[corner];
    std::array<Index, 2> half_edges{kNone, kNone};
    Index tip = kNone;
    if (is_writing()) {
      const Index beyond = surface_->twin[gate.half_edge];
      half_edges = {geometry::next_half_edge(beyond), geometry::previous_half_edge(beyond)};
      tip = true_vertex(half_edges[1]);
    }
    const bool is_new = models_.code<kNew>(
        stream_,
        {kRoomsForNew(gate.room), kRoomsForNew(front_[gate.previous].room), new_answers_.last(),
         combine(new_answers_.last<3>(), close_answers_.last<6>())},
        is_writing() && code_of_[tip] == kNone);
    new_answers_.add(is_new);
    const Vector predicted = vertices_.predict(front_, corner);
    if (!is_new) return join(corner, half_edges, predicted);
    if (Status coded =
            vertices_.code_tip(front_, corner, is_writing() ? true_position(tip) : nullptr);
        !coded)
      return coded;
    const Index vertex = note_vertex(tip);
    const double size = length(centres_[vertex] - centres_[gate.start]);
    mean_edge_ += (size - mean_edge_) / (1.0 + std::min<double>(vertex, kMostAveraged));
    front_.add_vertex(corner, vertex, half_edges);
    note_gates(2);
    return Done{};
  }

  /// Codes the corner of the front at which the triangle ends: its rank by distance from the
  /// prediction among the corners near the gate on its loop, or else the number of its gate.
  Status join(Index corner, const std::array<Index, 2>& half_edges, const Vector& predicted) {
    const Gate& gate = front_[corner];
    Index truth = kNone;
    if (is_writing()) {
      // Turns around the vertex up to the first half-edge that is an open gate.
      Index incoming = surface_->twin[half_edges[1]];
      const Index first = incoming;
      while (gate_of_[incoming] == kNone || !front_[gate_of_[incoming]].is_open) {
        incoming = surface_->twin[geometry::next_half_edge(incoming)];
        if (incoming == first) return stuck();
      }
      truth = gate_of_[incoming];
    }
    candidates_.clear();
    const Index last = front_[front_[gate.previous].previous].previous;
    Index ahead = front_[gate.next].next;
    for (int steps = 0; steps < kCandidateSteps && ahead != last && ahead != corner; ++steps) {
      add_candidate(ahead, predicted);
      ahead = front_[ahead].next;
    }
    Index behind = last;
    for (int steps = 0; steps < kCandidateSteps && ahead != corner && behind != ahead; ++steps) {
      add_candidate(behind, predicted);
      behind = front_[behind].previous;
    }
    if (ahead == last && ahead != corner) add_candidate(ahead, predicted);
    std::sort(candidates_.begin(), candidates_.end(), [](const auto& a, const auto& b) {
      return a.distance != b.distance ? a.distance < b.distance : a.corner < b.corner;
    });
    candidates_.erase(
        std::unique(candidates_.begin(), candidates_.end(),
                    [](const auto& a, const auto& b) { return a.corner == b.corner; }),
        candidates_.end());
    const auto found = std::find_if(candidates_.begin(), candidates_.end(),
                                    [&](const auto& c) { return c.corner == truth; });
    const auto index = static_cast<std::uint64_t>(found - candidates_.begin());
    const std::uint64_t rank = models_.code_number<kRank>(
        stream_, {kNothingKnown}, found == candidates_.end() ? 0 : index + 1, kRankBits);
    if (rank > candidates_.size() || stream_.failed()) return not_closed();
    const auto other = rank > 0
                           ? candidates_[rank - 1].corner
                           : static_cast<Index>(stream_.code_uniform(truth, front_.gate_count()));
    const Gate& target = front_[other];
    const bool is_neighbour = other == corner || other == gate.previous || other == gate.next ||
                              other == front_[gate.previous].previous;
    if (!target.is_open || is_neighbour) {
      return is_writing() ? stuck() : Status(not_closed());
    }
    front_.join_corner(corner, other, half_edges);
    note_gates(2);
    return Done{};
  }

  void add_candidate(Index corner, const Vector& predicted) {
    const Vector offset = centres_[front_[corner].end] - predicted;
    candidates_.push_back({dot(offset, offset), corner});
  }

  /// Makes one vertex of all vertices at the same position, which cut_surface() had separated.
  Status finish(IntegerSolid& solid) const {
    const std::vector<GridPoint>& positions = vertices_.positions();
    std::vector<Index> order(positions.size());
    std::iota(order.begin(), order.end(), Index{0});
    std::sort(order.begin(), order.end(), [&](Index a, Index b) {
      return positions[a] != positions[b] ? positions[a] < positions[b] : a < b;
    });
    std::vector<Index> glued(positions.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      const GridPoint& position = positions[order[i]];
      if (i == 0 || position != positions[order[i - 1]]) {
        GridPoint absolute{};
        for (std::size_t k = 0; k < 3; ++k) {
          absolute[k] = position[k] + vertices_.origin()[k];
          if (absolute[k] <= -(std::int64_t{1} << 53) || absolute[k] >= (std::int64_t{1} << 53)) {
            return not_closed();
          }
        }
        solid.vertices.push_back(absolute);
      }
      glued[order[i]] = static_cast<Index>(solid.vertices.size() - 1);
    }
    const auto& triangles = front_.triangles();
    for (std::size_t t = 0, component = 1; t < triangles.size(); ++t) {
      if (component < starts_.size() && starts_[component] == t) {
        if (shells_[component - 1]) solid.shell_offsets.push_back(solid.facet_count());
        ++component;
      }
      for (const Index vertex : triangles[t]) solid.ring_vertices.push_back(glued[vertex]);
      solid.ring_offsets.push_back(static_cast<Index>(solid.ring_vertices.size()));
      solid.facet_offsets.push_back(solid.ring_count());
    }
    solid.shell_offsets.push_back(solid.facet_count());
    if (solid.shell_count() > limits_.shells) {
      return Error{ErrorCode::limit_exceeded, "the solid has too many shells"};
    }
    return Done{};
  }

  struct Candidate {
    double distance = 0;
    Index corner = 0;
  };

  EntropyStream& stream_;
  ModelBank& models_;
  Limits limits_;
  const CutSurface* surface_ = nullptr;  // null when reading
  VertexCoder vertices_;
  const std::vector<Vector>& centres_ = vertices_.centres();
  SurfaceFront front_{centres_};
  std::vector<Index> starts_;   // component -> first triangle
  std::vector<bool> shells_;    // component but the first -> whether it begins a shell
  std::vector<Index> code_of_;  // writing: vertex of the surface -> its number in the stream
  std::vector<Index> gate_of_;  // writing: half-edge of the surface -> gate
  std::vector<Candidate> candidates_;
  std::size_t most_triangles_ = ~std::size_t{0};
  double mean_edge_ = 1;
  Answers<8> close_answers_;  // the last answers of Close
  Answers<6> new_answers_;    // the last answers of New
  bool is_stuck_ = false;     // when writing: two edges join the same two vertices
};

/// Options are measured on this many triangles of a surface.
constexpr std::size_t kTrialTriangles = 2500;

/// For surfaces with fewer triangles not all options are tried: they would save too little.
constexpr std::size_t kFewTriangles = 64;

/// Tries options on a part of a surface.
class OptionTrials {
 public:
  OptionTrials(const CutSurface& surface, ModelBank& models, const PageMemory& memory,
               const Limits& limits)
      : surface_(surface), models_(models), memory_(memory), limits_(limits) {}

  Status attempt(const VertexOptions& options) {
    EntropyStream meter = EntropyStream::meter();
    meter.heed(limits_);
    const BankTrial trial(models_, surface_.positions.size());
    IntegerSolid unused;
    SurfaceCoder coder(meter, models_, memory_, limits_);
    coder.stop_after(kTrialTriangles);
    if (Status coded = coder.code(&surface_, unused, options); !coded) return coded;
    // The lists of values are coded once; all other costs grow with the number of triangles.
    const auto once = static_cast<double>(meter.cost(StreamPart::position));
    const double share = static_cast<double>(surface_.triangles.size()) /
                         static_cast<double>(coder.triangle_count());
    const double cost = once + (static_cast<double>(meter.cost()) - once) * share;
    if (has_best_ && cost >= least_) return Done{};
    has_best_ = true;
    least_ = cost;
    best_ = options;
    return Done{};
  }
  const VertexOptions& best() const { return best_; }

 private:
  const CutSurface& surface_;
  ModelBank& models_;  // unchanged after each trial
  const PageMemory& memory_;
  Limits limits_;
  VertexOptions best_;
  double least_ = 0;
  bool has_best_ = false;
};

std::array<AxisPlaces, 3> suggest_places(const CutSurface& surface) {
  std::array<AxisPlaces, 3> places{};
  const GridPoint& origin = surface.positions[surface.triangles.front()[0]];
  for (std::size_t k = 0; k < 3; ++k) {
    std::vector<std::int64_t> values;
    for (const GridPoint& position : surface.positions) values.push_back(position[k] - origin[k]);
    places[k] = AxisPlaces::suggest(std::move(values));
  }
  return places;
}

/// Chooses options by trials: first repeats and guesses, with Kind::every on all axes; then the
/// best of these options and its variants, with the values that occur on each axis.
Result<VertexOptions> options_for(const CutSurface& surface, ModelBank& models,
                                  const PageMemory& memory, const Limits& limits) {
  OptionTrials trials(surface, models, memory, limits);
  const bool is_small = surface.triangles.size() < kFewTriangles;
  std::vector<VertexOptions> options{{}, {.has_repeats = true}};
  if (!is_small) options.push_back({.has_guesses = true});
  for (const VertexOptions& tried : options) {
    if (const Status status = trials.attempt(tried); !status) return status.error();
  }
  if (is_small) return trials.best();
  if (trials.best().has_guesses || trials.best().has_repeats) {
    const Status status = trials.attempt({.has_repeats = true, .has_guesses = true});
    if (!status) return status.error();
  }
  VertexOptions base = trials.best();
  base.places = suggest_places(surface);
  const bool has_places = std::any_of(
      base.places.begin(), base.places.end(),
      [](const AxisPlaces& places) { return places.kind() != AxisPlaces::Kind::every; });
  for (unsigned change = 0; has_places && change < 3; ++change) {
    VertexOptions changed = base;
    if (change == 1) changed.has_repeats = !changed.has_repeats;
    if (change == 2) changed.has_guesses = !changed.has_guesses;
    if (const Status tried = trials.attempt(changed); !tried) return tried.error();
  }
  if (trials.best().has_guesses) {
    VertexOptions changed = trials.best();
    changed.naming_weight = 1;
    if (const Status tried = trials.attempt(changed); !tried) return tried.error();
  }
  return trials.best();
}

}  // namespace

const ModelLayout& model_layout() {
  static constexpr ModelLayout layout{kFamilies, kNumbers, true};
  return layout;
}

Result<VertexOptions> choose_options(const IntegerSolid& solid, ModelBank& models,
                                     const PageMemory& memory, const Limits& limits) {
  const Result<CutSurface> surface = cut_surface(solid);
  if (!surface) return surface.error();
  return options_for(*surface, models, memory, limits);
}

Status code_solid(EntropyStream& stream, ModelBank& models, const PageMemory& memory,
                  IntegerSolid& solid, const WriterChoice& choice, const Limits& limits) {
  if (stream.is_reading()) {
    return SurfaceCoder(stream, models, memory, limits).code(nullptr, solid, {});
  }
  const Result<CutSurface> surface = cut_surface(solid);
  if (!surface) return surface.error();
  auto options = choice.vertex_options ? Result<VertexOptions>(*choice.vertex_options)
                                       : options_for(*surface, models, memory, limits);
  if (!options) return options.error();
  return SurfaceCoder(stream, models, memory, limits).code(&*surface, solid, *options);
}

}  // namespace watertight::codec::parallelogram
