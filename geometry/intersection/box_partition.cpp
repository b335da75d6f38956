// SPDX-License-Identifier: GPL-3.0-or-later
//
// Based on: E. Verbree and H. Si, Validation and Storage of Polyhedra through Constrained Delaunay
// Tetrahedralization, 2008, section 3.2.
#include "geometry/intersection/box_partition.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "geometry/intersection/pair_search.h"
#include "geometry/parallel.h"

namespace watertight::geometry {
namespace {

/// The largest number of triangles in a piece of space, where a division is possible. The threads
/// share the pieces, which do not depend on the number of threads.
constexpr std::size_t kPieceSize = 16'384;
constexpr std::size_t kTrianglesPerChunk = 8'192;

struct Piece {
  std::vector<BoxMember<3>> members;
  PartBounds<3> bounds = PartBounds<3>::everything();
};

class Search {
 public:
  Search(std::span<const Point> points, std::span<const Triangle> triangles,
         const IntersectionOptions& options)
      : threads_(std::max(1U, options.threads)),
        points_(points),
        triangles_(triangles),
        context_{.points = points,
                 .triangles = triangles,
                 .boxes = {},
                 .tester = PairTester(points, triangles),
                 .group_of = options.group_of,
                 .limit = options.limit,
                 .cancel = options.cancel} {}

  Result<std::vector<IntersectingPair>> run() {
    measure_boxes();
    divide_into_pieces();
    search_pieces();
    if (context_.is_cancelled)
      return Error{ErrorCode::cancelled, "the search for intersections was stopped"};
    return first_pairs();
  }

 private:
  void for_each_chunk(const std::function<void(std::size_t, std::size_t, std::size_t)>& work);
  void measure_boxes();
  void divide_into_pieces();
  bool divide(std::size_t number);
  void search_pieces();
  void note_finished(std::size_t number);
  std::vector<IntersectingPair> first_pairs();

  unsigned threads_;
  std::span<const Point> points_;
  std::span<const Triangle> triangles_;
  SearchContext context_;
  std::vector<BoxMember<3>> boxes_;  // the box of each triangle
  std::vector<Piece> pieces_;
  std::vector<std::vector<IntersectingPair>> found_;  // the pairs of each piece
  std::mutex mutex_;
  // mutex_ guards is_finished_, finished_ and found_in_finished_.
  std::vector<bool> is_finished_;  // piece -> whether the search of it is finished
  std::size_t finished_ = 0;       // the number of finished pieces before the first unfinished one
  std::uint64_t found_in_finished_ = 0;  // the number of pairs found in the first finished_ pieces
};

/// Calls work(chunk, begin, end) for consecutive ranges of triangles.
void Search::for_each_chunk(
    const std::function<void(std::size_t, std::size_t, std::size_t)>& work) {
  const std::size_t chunks = (triangles_.size() + kTrianglesPerChunk - 1) / kTrianglesPerChunk;
  for_each_piece(chunks, threads_, [&](std::size_t chunk, bool) {
    const std::size_t begin = chunk * kTrianglesPerChunk;
    work(chunk, begin, std::min(triangles_.size(), begin + kTrianglesPerChunk));
  });
}

/// Computes the boxes of all triangles, relative to the low corner of their common box and in units
/// of the largest extent of the common box. Makes one piece of all triangles that are not
/// degenerate.
void Search::measure_boxes() {
  std::vector<Box> chunk_boxes(triangles_.size() / kTrianglesPerChunk + 1);
  for_each_chunk([&](std::size_t chunk, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (const Index vertex : triangles_[i]) chunk_boxes[chunk].include(points_[vertex]);
    }
  });
  Box all;
  for (const Box& box : chunk_boxes) {
    if (box.is_empty()) continue;
    all.include(box.min);
    all.include(box.max);
  }
  double extent = 0;  // half the largest extent: the difference of two doubles can overflow
  for (int axis = 0; axis < 3; ++axis) {
    extent = std::max(extent, 0.5 * all.max[axis] - 0.5 * all.min[axis]);
  }
  constexpr double kSmallest = 1e-290;
  const double scale = extent > kSmallest ? 1 / extent : 1;
  boxes_.resize(triangles_.size());
  std::vector<std::uint8_t> is_degenerate(triangles_.size());
  for_each_chunk([&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      is_degenerate[i] = context_.tester.is_degenerate(static_cast<Index>(i)) ? 1 : 0;
      Box box;
      for (const Index vertex : triangles_[i]) box.include(points_[vertex]);
      BoxMember<3>& member = boxes_[i];
      member.triangle = static_cast<Index>(i);
      for (int axis = 0; axis < 3; ++axis) {
        const auto at = static_cast<std::size_t>(axis);
        // The formula is monotone in the coordinate, so boxes that overlap in doubles also overlap
        // in floats.
        member.low[at] = rounded_down((0.5 * box.min[axis] - 0.5 * all.min[axis]) * scale);
        member.high[at] = rounded_up((0.5 * box.max[axis] - 0.5 * all.min[axis]) * scale);
      }
    }
  });
  context_.boxes = boxes_;
  Piece whole;
  whole.members.reserve(triangles_.size());
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    if (is_degenerate[i] == 0) whole.members.push_back(boxes_[i]);
  }
  pieces_.push_back(std::move(whole));
}

void Search::divide_into_pieces() {
  std::vector<Piece> small;
  while (!pieces_.empty()) {
    const std::size_t last = pieces_.size() - 1;
    if (pieces_[last].members.size() > kPieceSize && divide(last)) continue;
    small.push_back(std::move(pieces_.back()));
    pieces_.pop_back();
  }
  pieces_ = std::move(small);
}

/// Replaces the last piece, whose number is given, by its slabs. False if no division saves work.
bool Search::divide(std::size_t number) {
  SlabDivider<3> divider;
  const PartMembers<3> members{pieces_[number].members, {}, true};
  if (!divider.find(members, pieces_[number].bounds)) return false;
  const Piece piece = std::move(pieces_[number]);
  pieces_.pop_back();
  std::array<std::vector<BoxMember<3>>, Slabs::kMost> slabs;
  std::array<std::size_t, Slabs::kMost> next{};
  for (std::size_t slab = 0; slab < divider.slabs().count; ++slab) {
    slabs[slab].resize(divider.counts().first[slab]);
  }
  divider.distribute(std::span<const BoxMember<3>>(piece.members),
                     [&](std::size_t slab) { return &slabs[slab][next[slab]++]; });
  for (std::size_t slab = 0; slab < divider.slabs().count; ++slab) {
    if (divider.is_empty(slab, true)) continue;
    pieces_.push_back({std::move(slabs[slab]), divider.bounds_of(slab, piece.bounds)});
  }
  return true;
}

void Search::search_pieces() {
  found_.resize(pieces_.size());
  is_finished_.assign(pieces_.size(), false);
  const auto work = [&](std::size_t number, bool is_caller) {
    if (context_.is_ended) return;
    PairSearch search(context_, is_caller);
    found_[number] = search.run(pieces_[number].members, pieces_[number].bounds);
    pieces_[number].members = {};
    note_finished(number);
  };
  for_each_piece(pieces_.size(), threads_, work, [&] { context_.ask(); });
}

/// Notes that a piece is finished. Ends the search when the finished pieces before the first
/// unfinished one have enough pairs: the pairs of other pieces are not needed.
void Search::note_finished(std::size_t number) {
  const std::lock_guard lock(mutex_);
  is_finished_[number] = true;
  while (finished_ < is_finished_.size() && is_finished_[finished_]) {
    found_in_finished_ += found_[finished_].size();
    ++finished_;
    if (found_in_finished_ >= context_.limit) {
      context_.is_ended = true;
      return;
    }
  }
}

std::vector<IntersectingPair> Search::first_pairs() {
  std::vector<IntersectingPair> pairs;
  for (std::size_t number = 0; number < finished_; ++number) {
    const auto& found = found_[number];
    pairs.insert(pairs.end(), found.begin(), found.end());
  }
  if (pairs.size() > context_.limit) {
    pairs.erase(pairs.begin() + static_cast<std::ptrdiff_t>(context_.limit), pairs.end());
  }
  std::sort(pairs.begin(), pairs.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first < b.first : a.second < b.second;
  });
  return pairs;
}

}  // namespace

Result<std::vector<IntersectingPair>> intersecting_pairs(std::span<const Point> points,
                                                         std::span<const Triangle> triangles,
                                                         const IntersectionOptions& options) {
  if (options.limit == 0) return std::vector<IntersectingPair>{};
  return Search(points, triangles, options).run();
}

}  // namespace watertight::geometry
