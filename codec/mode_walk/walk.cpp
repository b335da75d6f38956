// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/mode_walk/walk.h"

#include <algorithm>
#include <bit>
#include <concepts>
#include <queue>
#include <utility>

#include "codec/mode_walk/delaunay_edges.h"
#include "codec/mode_walk/families.h"
#include "codec/mode_walk/front.h"
#include "codec/mode_walk/given_surface.h"
#include "codec/mode_walk/triangle_classes.h"
#include "geometry/mesh/half_edges.h"

namespace watertight::codec::walk {
namespace {

// Contexts (docs/format-walk.md, "The walk").
/// The state of a candidate: unused, used, closing the left or the right edge or both, or closed.
constexpr std::uint32_t kStates = 6;
/// The origin of a candidate: one of several faces at the gate, the only face, no face.
constexpr std::uint32_t kKinds = 3;
/// The edges beside the gate that a candidate closes: none, left, right, both.
constexpr std::uint32_t kCloses = 4;
/// Classes of the number of candidates from faces.
constexpr std::uint32_t kCounts = 7;
constexpr std::uint32_t kFewCounts = 5;
constexpr std::uint32_t kLikelihoods = 64;
constexpr std::uint32_t kRanks = 4;

// The contexts of the decisions of family Rare. Context 6 is not used.
constexpr Context<7> kIsManifold{0U};
constexpr Context<7> kIsMore{5U};
/// The context of the question whether the vertex is in the distant list, by the length of the
/// list.
Context<7> listed_among(std::size_t length) {
  return trailing<1>(leading<2>(capped<4>(length / 4)));
}

/// The class of a probability in 1/65536, two classes for each power of two. Above one half the
/// classes are those of its complement, from the other end.
Context<kLikelihoods> likelihood(std::uint32_t probability) {
  const bool is_high = probability > 32768;
  const std::uint32_t lesser = is_high ? 65536 - probability : probability;
  if (lesser == 0) return Context<kLikelihoods>(0U);
  const auto width = static_cast<std::uint32_t>(std::bit_width(lesser));  // 1 to 16
  const std::uint32_t half = width > 1 ? (lesser >> (width - 2)) & 1U : 0;
  const std::uint32_t octave_half = std::min(2 * (width - 1) + half, kLikelihoods / 2 - 1);
  return Context<kLikelihoods>(is_high ? kLikelihoods - 1 - octave_half : octave_half);
}

/// An edge with a candidate of at least this probability, in 1/65536, is not scored again when a
/// triangle is added beside it.
constexpr std::uint32_t kCertain = 32768;

/// The most steps that a walk may take, whatever its bytes are: a vertex of degree d takes about
/// d^2 steps. Solids of 1 to 100,000 vertices took up to 120 for each vertex (docs/format.md,
/// "Limits").
constexpr std::uint64_t kStepsPerPoint = 256;
constexpr std::uint64_t kFreeSteps = 1U << 20;

/// A vertex that may be the third corner of the triangle beyond the gate.
struct Candidate {
  Index vertex = 0;
  std::uint32_t probability = 0;
  Context<kStates> state;
  Context<kKinds> kind;
  ContextsOf<kCandidate> contexts;

  SelectorOf<kCandidate> selector() const { return combine(state, kind); }
};
static_assert(std::same_as<ContextsOf<kCandidate>, ContextsOf<kDistant>>);

bool is_more_likely(const Candidate& x, const Candidate& y) {
  return x.probability != y.probability ? x.probability > y.probability : x.vertex < y.vertex;
}

Error not_encodable(const char* reason) { return {ErrorCode::not_encodable, reason}; }

class Walk {
 public:
  Walk(EntropyStream& stream, ModelBank& models, std::span<const Point> points,
       const delaunay::CanonicalDelaunay& delaunay, GivenSurface* truth)
      : stream_(stream),
        models_(models),
        points_(points),
        delaunay_(delaunay),
        edges_(delaunay, static_cast<Index>(points.size())),
        truth_(truth),
        front_(static_cast<Index>(points.size())),
        face_shapes_(delaunay.faces.size(), kUnknownShape),
        mark_(points.size(), 0),
        closing_mark_(points.size(), 0),
        closing_sides_(points.size(), 0),
        steps_left_(kStepsPerPoint * points.size() + kFreeSteps) {}

  Status run(BoundaryMesh& mesh);

 private:
  static constexpr FaceShape kUnknownShape{255, 0, 0};
  /// A face in one of its directions, as the first triangle of a component.
  struct Seed {
    Triangle triangle;
    Context<4> kind;  // first and second direction of a face of the hull, then of an inner face
    Context<kSphereClasses> sphere;
  };
  struct Entry {
    std::uint32_t probability;
    Index half_edge;
    bool operator<(const Entry& other) const {
      return probability != other.probability ? probability < other.probability
                                              : half_edge > other.half_edge;
    }
  };

  bool code_rare(Context<7> question, bool value) {
    return models_.code<kRare>(stream_, {question}, value);
  }
  bool is_reading() const { return truth_ == nullptr; }
  Error broken() const {
    return is_reading() ? Error{ErrorCode::malformed, "the boundary among the Delaunay faces"}
                        : not_encodable("mode walk cannot code the boundary");
  }

  Status code_component(Index seed);
  Status code_seed(Index seed);
  void list_seeds(Index seed);
  Status code_gate(Index gate);
  bool code_candidate(std::size_t index, Index truth);
  Index code_distant(Index gate, Index truth);
  void add(const Triangle& triangle, Index source);
  std::uint32_t greatest_probability() const;
  void push(Index half_edge);
  void push_open(Index triangle);

  void mark_used(Index gate);
  bool is_possible(Index w) const;
  void list_candidates(Index gate);
  void list_distant(Index gate);
  Candidate describe(const Gate& gate, Index half_edge, Index w, Index face, std::uint32_t faces);
  const FaceShape& shape_of(Index face);
  Context<kStates> state_of(Index w) const;
  template <Family family>
  void score(std::vector<Candidate>& list) const;

  EntropyStream& stream_;
  /// A meter for the decisions from which the models only learn, and which do not go into the
  /// stream.
  EntropyStream uncoded_ = EntropyStream::meter();
  ModelBank& models_;
  std::span<const Point> points_;
  const delaunay::CanonicalDelaunay& delaunay_;
  DelaunayEdges edges_;
  GivenSurface* truth_;
  WalkFront front_;
  std::vector<FaceShape> face_shapes_;
  bool is_manifold_ = true;
  std::vector<Index> source_;  // when writing: triangle -> the given half-edge that is its first
                               // one

  // The candidates of the present gate. A vertex is marked with the stamp when it is listed or
  // ruled out.
  std::vector<Candidate> candidates_;
  std::vector<Candidate> distant_;
  std::vector<Index> mark_;
  Index stamp_ = 0;
  // The vertices beyond open edges beside the gate are marked too, with the edges that the triangle
  // with the vertex would close.
  std::vector<Index> closing_;
  std::vector<Index> closing_mark_;
  std::vector<std::uint8_t> closing_sides_;
  std::vector<Seed> seeds_;
  std::priority_queue<Entry> queue_;
  std::vector<std::uint32_t> pushed_;  // half-edge -> its probability in the queue
  std::uint64_t steps_left_;
};

const FaceShape& Walk::shape_of(Index face) {
  FaceShape& shape = face_shapes_[face];
  if (shape.sphere == kUnknownShape.sphere) {
    shape = face_shape(points_, delaunay_.faces[face], delaunay_.apexes[face]);
  }
  return shape;
}

/// Marks the vertices that cannot be beyond the gate, since the triangle would use a half-edge
/// twice, and lists the vertices beyond open edges beside the gate. The triangle (b, a, w) needs
/// the half-edges a -> w and w -> b.
void Walk::mark_used(Index gate) {
  const Index a = front_.from(gate);
  const Index b = front_.to(gate);
  ++stamp_;
  closing_.clear();
  mark_[a] = mark_[b] = mark_[front_.corner(gate)] = stamp_;
  const auto close = [&](Index w, std::uint32_t side) {
    if (closing_mark_[w] != stamp_) {
      closing_mark_[w] = stamp_;
      closing_sides_[w] = 0;
      closing_.push_back(w);
    }
    closing_sides_[w] = static_cast<std::uint8_t>(closing_sides_[w] | side);
  };
  std::uint64_t steps = 1;
  for (Index h = front_.first_at(a); h != kNone; h = front_.next_at(h), ++steps) {
    mark_[front_.to(h)] = stamp_;
    const Index incoming = geometry::previous_half_edge(h);
    if (front_.is_open(incoming)) close(front_.from(incoming), 1);
  }
  for (Index h = front_.first_at(b); h != kNone; h = front_.next_at(h), ++steps) {
    mark_[front_.from(geometry::previous_half_edge(h))] = stamp_;
    if (front_.is_open(h)) close(front_.to(h), 2);
  }
  steps_left_ -= std::min(steps, steps_left_);
}

bool Walk::is_possible(Index w) const {
  return mark_[w] != stamp_ && !(is_manifold_ && front_.is_closed(w));
}

Context<kStates> Walk::state_of(Index w) const {
  if (closing_mark_[w] == stamp_) return Context<kStates>(1U + closing_sides_[w]);
  if (front_.is_closed(w)) return Context<kStates>(5U);
  return Context<kStates>(front_.is_used(w));
}

/// Describes vertex w as a candidate beyond a gate. `face` is the Delaunay face at the gate whose
/// third corner is w, or kNone. `faces` is the number of candidates from faces.
Candidate Walk::describe(const Gate& gate, Index half_edge, Index w, Index face,
                         std::uint32_t faces) {
  const FaceShape shape =
      face == kNone ? no_face((edges_.faces_at(front_.from(half_edge), w).empty() ? 0U : 1U) +
                              (edges_.faces_at(front_.to(half_edge), w).empty() ? 0U : 2U))
                    : shape_of(face);
  const Context<kSphereClasses> sphere(shape.sphere);
  const Context<kRatioClasses> ratio(shape.ratio);
  const Context<kGabrielClasses> gabriel(shape.gabriel);
  const Continuation c = continuation(gate, points_[w]);
  const Context<kStates> state = state_of(w);
  const Context<kCloses> closes(state.value >= 2 && state.value <= 4 ? state.value - 1 : 0);
  const auto count = capped<kCounts>(faces);
  const auto few = capped<kFewCounts>(faces);
  const Context<kKinds> kind(face == kNone ? 2U : faces == 1 ? 1U : 0U);
  return {w,
          0,
          state,
          kind,
          {combine(c.bend, state, count), combine(sphere, halved(c.bend), state),
           combine(c.radius, c.parallelogram, closes, gabriel), combine(sphere, c.radius, c.side),
           combine(state, gabriel, c.deviation, c.side), combine(ratio, sphere, state),
           combine(c.parallelogram, halved(sphere), state, few),
           combine(c.radius, c.bend, closes, gabriel)}};
}

template <Family family>
void Walk::score(std::vector<Candidate>& list) const {
  for (Candidate& candidate : list) {
    candidate.probability = models_.probability<family>(candidate.selector(), candidate.contexts);
  }
}

/// Lists the third corners of the Delaunay faces at the gate, then the vertices beyond open edges
/// beside the gate.
void Walk::list_candidates(Index gate) {
  const Index a = front_.from(gate);
  const Index b = front_.to(gate);
  mark_used(gate);
  candidates_.clear();
  const Gate shape(points_[a], points_[b], points_[front_.corner(gate)]);
  const auto faces = edges_.faces_at(a, b);
  std::uint32_t count = 0;
  const auto opposite = [&](Index face) {
    Index w = kNone;
    for (const Index v : delaunay_.faces[face]) {
      if (v != a && v != b) w = v;
    }
    return w;
  };
  for (const Index face : faces) count += is_possible(opposite(face)) ? 1U : 0U;
  for (const Index face : faces) {
    const Index w = opposite(face);
    const bool possible = is_possible(w);
    mark_[w] = stamp_;
    if (possible) candidates_.push_back(describe(shape, gate, w, face, count));
  }
  for (std::size_t i = 0; i < closing_.size(); ++i) {
    const Index w = closing_[i];
    if (!is_possible(w)) continue;
    mark_[w] = stamp_;
    candidates_.push_back(describe(shape, gate, w, kNone, count));
  }
  steps_left_ -= std::min<std::uint64_t>(faces.size(), steps_left_);
  score<kCandidate>(candidates_);
}

/// Lists all other Delaunay neighbours of the ends of the gate. Call list_candidates() before.
void Walk::list_distant(Index gate) {
  const Index a = front_.from(gate);
  const Index b = front_.to(gate);
  const Gate shape(points_[a], points_[b], points_[front_.corner(gate)]);
  distant_.clear();
  for (const Index end : {a, b}) {
    for (const auto neighbours : {edges_.smaller_neighbours(end), edges_.greater_neighbours(end)}) {
      steps_left_ -= std::min<std::uint64_t>(neighbours.size(), steps_left_);
      for (const Index w : neighbours) {
        if (!is_possible(w)) continue;
        mark_[w] = stamp_;
        distant_.push_back(describe(shape, gate, w, kNone, 0));
      }
    }
  }
  score<kDistant>(distant_);
  std::sort(distant_.begin(), distant_.end(), is_more_likely);
}

void Walk::add(const Triangle& triangle, Index source) {
  front_.add(triangle);
  if (is_reading()) return;
  truth_->use(source);
  source_.push_back(source);
}

std::uint32_t Walk::greatest_probability() const {
  std::uint32_t greatest = 0;
  for (const Candidate& c : candidates_) greatest = std::max(greatest, c.probability);
  return greatest;
}

void Walk::push(Index half_edge) {
  list_candidates(half_edge);
  const std::uint32_t now = greatest_probability();
  if (now <= pushed_[half_edge] && now > 0) return;
  pushed_[half_edge] = now;
  queue_.push({now, half_edge});
}

/// Puts the open edges at the corners of a new triangle into the queue, unless the queue has them
/// with a greater probability.
void Walk::push_open(Index triangle) {
  pushed_.resize(front_.twin.size(), 0);
  for (Index h = 3 * triangle; h < 3 * triangle + 3; ++h) {
    if (front_.is_open(h)) push(h);
  }
  for (const Index v : front_.triangles[triangle]) {
    for (Index h = front_.first_at(v); h != kNone; h = front_.next_at(h)) {
      const Index incoming = geometry::previous_half_edge(h);
      if (h / 3 == triangle) continue;
      if (front_.is_open(h) && pushed_[h] < kCertain) push(h);
      if (front_.is_open(incoming) && pushed_[incoming] < kCertain) push(incoming);
    }
  }
}

Index Walk::code_distant(Index gate, Index truth) {
  list_distant(gate);
  const auto is_truth = [&](const Candidate& c) { return c.vertex == truth; };
  const bool is_in_list =
      !distant_.empty() && code_rare(listed_among(distant_.size()),
                                     std::any_of(distant_.begin(), distant_.end(), is_truth));
  if (!is_in_list) {
    const Index w =
        static_cast<Index>(stream_.code_uniform(truth == kNone ? 0 : truth, points_.size()));
    return w;
  }
  for (std::size_t i = 0; i + 1 < distant_.size(); ++i) {
    const Candidate& c = distant_[i];
    if (models_.code<kDistant>(stream_, c.selector(), c.contexts, is_truth(c))) {
      return c.vertex;
    }
  }
  return distant_.back().vertex;
}

/// Codes whether the vertex beyond the gate is the candidate at `index`. Family Candidate, which
/// ranked the candidates, learns from the answer too.
bool Walk::code_candidate(std::size_t index, Index truth) {
  const Candidate& c = candidates_[index];
  const std::uint32_t next =
      index + 1 < candidates_.size() ? candidates_[index + 1].probability : 0;
  const auto own = likelihood(c.probability);
  const auto rank = capped<kRanks>(index);
  const bool is_it = models_.code<kChoice>(
      stream_, rank,
      {combine(own, rank, c.kind), combine(halved(own), halved(likelihood(next))),
       combine(halved(own), c.state, rank)},
      c.vertex == truth);
  models_.code<kCandidate>(uncoded_, c.selector(), c.contexts, is_it);
  return is_it;
}

/// Codes the triangle beyond an open edge. Requires list_candidates(gate) just before.
Status Walk::code_gate(Index gate) {
  const Index a = front_.from(gate);
  const Index b = front_.to(gate);
  Index source = kNone;
  Index truth = kNone;
  if (!is_reading()) {
    source = truth_->twin_of(geometry::turned_half_edge(source_[gate / 3], gate % 3));
    truth = truth_->corner(source);
  }
  std::sort(candidates_.begin(), candidates_.end(), is_more_likely);
  Index w = kNone;
  for (std::size_t i = 0; i < candidates_.size() && w == kNone; ++i) {
    if (code_candidate(i, truth)) w = candidates_[i].vertex;
  }
  if (w == kNone) {
    w = code_distant(gate, truth);
    if (w == a || w == b || w == front_.corner(gate) || front_.find(a, w) != kNone ||
        front_.find(w, b) != kNone || (is_manifold_ && front_.is_closed(w))) {
      return broken();
    }
  }
  const auto triangle = static_cast<Index>(front_.triangles.size());
  add({b, a, w}, source);
  push_open(triangle);
  return Done{};
}

/// Lists the faces at a vertex in both directions: first those of the hull as seen from outside,
/// then the same faces from inside, then all other faces.
void Walk::list_seeds(Index seed) {
  seeds_.clear();
  const auto list = [&](Index face) {
    const Triangle& t = delaunay_.faces[face];
    const auto& apexes = delaunay_.apexes[face];
    const Context<kSphereClasses> sphere(shape_of(face).sphere);
    // A face of the hull has one apex, which is inside. If it is the first apex, the face turns
    // clockwise seen from outside.
    const Triangle reverse{t[0], t[2], t[1]};
    const bool hull = apexes[0] == kNone || apexes[1] == kNone;
    const bool first_inside = apexes[1] == kNone;
    const Context<2> inner(!hull);
    seeds_.push_back({first_inside ? reverse : t, combine(inner, Context<2>(false)), sphere});
    seeds_.push_back({first_inside ? t : reverse, combine(inner, Context<2>(true)), sphere});
  };
  Index last = kNone;
  std::vector<Index> faces;
  for (const auto neighbours : {edges_.smaller_neighbours(seed), edges_.greater_neighbours(seed)}) {
    for (const Index w : neighbours) {
      const auto around = edges_.faces_at(seed, w);
      faces.insert(faces.end(), around.begin(), around.end());
    }
  }
  std::sort(faces.begin(), faces.end());
  for (const Index face : faces) {
    if (face != last) list(face);
    last = face;
  }
  std::stable_sort(seeds_.begin(), seeds_.end(), [](const Seed& x, const Seed& y) {
    return std::min(x.kind.value, 2U) < std::min(y.kind.value, 2U);
  });
  steps_left_ -= std::min<std::uint64_t>(seeds_.size(), steps_left_);
}

Status Walk::code_seed(Index seed) {
  list_seeds(seed);
  Index truth = kNone;
  std::size_t chosen = seeds_.size();
  if (!is_reading()) {
    for (std::size_t i = 0; i < seeds_.size() && truth == kNone; ++i) {
      truth = truth_->find_unused(seeds_[i].triangle);
      chosen = i;
    }
    if (truth == kNone) chosen = seeds_.size();
  }
  for (std::size_t i = 0; i < seeds_.size(); ++i) {
    const auto context = combine(seeds_[i].kind, seeds_[i].sphere);
    if (!models_.code<kSeed>(stream_, {context}, i == chosen)) continue;
    add(seeds_[i].triangle, truth);
    return Done{};
  }
  // The first triangle is not in the list: the numbers of its vertices are coded.
  if (!is_reading()) truth = truth_->any_unused_at(seed);
  if (!is_reading() && truth == kNone) return not_encodable("a vertex without triangles");
  Triangle triangle{seed, 0, 0};
  for (Index k = 1; k < 3; ++k) {
    const Index v = truth == kNone ? 0 : truth_->from(geometry::turned_half_edge(truth, k));
    triangle[k] = static_cast<Index>(stream_.code_uniform(v, points_.size()));
  }
  if (triangle[1] == seed || triangle[2] == seed || triangle[1] == triangle[2]) return broken();
  add(triangle, truth);
  return Done{};
}

Status Walk::code_component(Index seed) {
  front_.start_component();
  const std::size_t open_before = front_.open_edges();
  const auto first = static_cast<Index>(front_.triangles.size());
  if (Status status = code_seed(seed); !status) return status;
  push_open(first);
  while (front_.open_edges() > open_before) {
    if (queue_.empty() || stream_.failed() || steps_left_ == 0) return broken();
    const Entry entry = queue_.top();
    queue_.pop();
    if (!front_.is_open(entry.half_edge)) continue;
    if (entry.probability != pushed_[entry.half_edge])
      continue;  // the queue has a more recent
                 // entry
    list_candidates(entry.half_edge);
    const std::uint32_t now = greatest_probability();
    if (now + 1024 < entry.probability && !queue_.empty() && now < queue_.top().probability) {
      pushed_[entry.half_edge] = now;
      queue_.push({now, entry.half_edge});
      continue;
    }
    if (Status status = code_gate(entry.half_edge); !status) return status;
    if (front_.triangles.size() > std::size_t{4} * points_.size() + 64) return broken();
  }
  queue_ = {};
  return Done{};
}

Status Walk::run(BoundaryMesh& mesh) {
  is_manifold_ = code_rare(kIsManifold, !is_reading() && truth_->is_manifold());
  std::vector<Index> component_first;
  Index next = 0;
  while (true) {
    while (next < points_.size() && front_.is_known(next)) ++next;
    Index seed = next;
    if (next == points_.size()) {
      seed = is_reading() ? kNone : truth_->unused_vertex();
      if (!code_rare(kIsMore, seed != kNone)) break;
      seed = static_cast<Index>(stream_.code_uniform(seed == kNone ? 0 : seed, points_.size()));
    }
    component_first.push_back(static_cast<Index>(front_.triangles.size()));
    if (Status status = code_component(seed); !status) return status;
  }
  component_first.push_back(static_cast<Index>(front_.triangles.size()));
  mesh.triangles = std::move(front_.triangles);
  mesh.twin = std::move(front_.twin);
  mesh.component_first = std::move(component_first);
  mesh.source.clear();
  if (!is_reading()) {
    for (const Index half_edge : source_) mesh.source.push_back(half_edge / 3);
  }
  return Done{};
}

}  // namespace

Status code_boundary_walk(EntropyStream& stream, ModelBank& models, std::span<const Point> points,
                          const delaunay::CanonicalDelaunay& delaunay, BoundaryMesh& mesh) {
  if (stream.is_reading()) {
    return Walk(stream, models, points, delaunay, nullptr).run(mesh);
  }
  GivenSurface given;
  if (!given.take(mesh, static_cast<Index>(points.size()))) {
    return not_encodable("the triangles of the boundary do not meet in pairs");
  }
  return Walk(stream, models, points, delaunay, &given).run(mesh);
}

}  // namespace watertight::codec::walk
