// SPDX-License-Identifier: GPL-3.0-or-later
#include "tessellate/strips.h"

#include <array>
#include <cstdint>
#include <optional>
#include <utility>

#include "tessellate/trimmed/neighbours.h"

namespace watertight::tessellate {
namespace {

constexpr int kMostTurns = 4;

class StripMaker {
 public:
  StripMaker(std::span<const Triangle> triangles, std::size_t point_count)
      : triangles_(triangles),
        twins_(twins_of(triangles, point_count)),
        left_(triangles.size(), 0),
        tried_(triangles.size(), 0),
        is_taken_(triangles.size(), false) {}

  std::vector<Strip> run() {
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        if (twins_[3 * t + k] != kNone) ++left_[t];
      }
      waiting_[left_[t]].triangles.push_back(t);
    }
    std::vector<Strip> strips;
    while (const auto start = next_start()) {
      find_best_walk(*start, best_);
      // The way back from its end may go on beyond its start.
      for (int turns = 0; turns < kMostTurns; ++turns) {
        find_best_walk(best_.triangles.back(), back_);
        if (!is_better(back_, best_)) break;
        std::swap(back_, best_);
      }
      for (const std::uint32_t triangle : best_.triangles) take(triangle);
      strips.push_back(best_.strip);
    }
    return strips;
  }

 private:
  struct Walk {
    Strip strip;
    std::vector<std::uint32_t> triangles;
  };

  struct Queue {
    std::vector<std::uint32_t> triangles;
    std::size_t first = 0;
  };

  /// Whether a walk has fewer indices for each triangle, or as many with more triangles.
  static bool is_better(const Walk& walk, const Walk& other) {
    const std::size_t one = walk.strip.size() * other.triangles.size();
    const std::size_t two = other.strip.size() * walk.triangles.size();
    return one != two ? one < two : walk.triangles.size() > other.triangles.size();
  }

  void find_best_walk(std::uint32_t triangle, Walk& best) {
    walk_from(3 * triangle, best);
    for (std::uint32_t k = 1; k < 3; ++k) {
      walk_from(3 * triangle + k, other_);
      if (is_better(other_, best)) std::swap(other_, best);
    }
  }

  /// A triangle with the fewest neighbours that are left; nothing when all are taken.
  std::optional<std::uint32_t> next_start() {
    for (std::size_t left = 0; left < waiting_.size(); ++left) {
      auto& [triangles, first] = waiting_[left];
      while (first < triangles.size()) {
        const std::uint32_t triangle = triangles[first++];
        if (!is_taken_[triangle] && left_[triangle] == left) return triangle;
      }
    }
    return std::nullopt;
  }

  void take(std::uint32_t triangle) {
    is_taken_[triangle] = true;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t twin = twins_[3 * triangle + k];
      if (twin == kNone || is_taken_[twin / 3]) continue;
      waiting_[--left_[twin / 3]].triangles.push_back(twin / 3);
    }
  }

  bool is_free(std::uint32_t edge) const {
    return edge != kNone && !is_taken_[edge / 3] && tried_[edge / 3] != trial_;
  }

  /// The triangles from an edge on, each across the side that needs no repeated vertex if one is
  /// left there.
  void walk_from(std::uint32_t edge, Walk& walk) {
    ++trial_;
    walk.triangles.clear();
    Index p = start_of(triangles_, edge);
    Index q = start_of(triangles_, next_edge(edge));
    walk.strip.assign({p, q});
    bool is_even = true;  // the next triangle of the strip is not the other way round
    for (;;) {
      tried_[edge / 3] = trial_;
      walk.triangles.push_back(edge / 3);
      const Index r = start_of(triangles_, previous_edge(edge));
      const std::uint32_t ahead = twins_[is_even ? next_edge(edge) : previous_edge(edge)];
      const std::uint32_t aside = twins_[is_even ? previous_edge(edge) : next_edge(edge)];
      if (is_free(ahead)) {
        walk.strip.push_back(r);
        p = q;
        edge = ahead;
        is_even = !is_even;
      } else if (is_free(aside)) {
        walk.strip.push_back(p);
        walk.strip.push_back(r);
        edge = aside;
      } else {
        walk.strip.push_back(r);
        return;
      }
      q = r;
    }
  }

  std::span<const Triangle> triangles_;
  std::vector<std::uint32_t> twins_;
  std::vector<std::uint8_t> left_;    // triangle -> neighbours that are not taken
  std::vector<std::uint32_t> tried_;  // triangle -> last trial that went through it
  std::vector<bool> is_taken_;
  std::uint32_t trial_ = 0;
  Walk best_;  // these keep their room
  Walk back_;
  Walk other_;
  std::array<Queue, 4> waiting_;  // by left_; outdated ones are skipped
};

}  // namespace

std::vector<Strip> strips_of(std::span<const Triangle> triangles, std::size_t point_count) {
  return StripMaker(triangles, point_count).run();
}

std::vector<Triangle> triangles_of(const Strip& strip) {
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i + 2 < strip.size(); ++i) {
    Triangle t{strip[i], strip[i + 1], strip[i + 2]};
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    if (i % 2 == 1) std::swap(t[0], t[1]);
    triangles.push_back(t);
  }
  return triangles;
}

}  // namespace watertight::tessellate
