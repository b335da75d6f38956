// SPDX-License-Identifier: GPL-3.0-or-later
//
// A static tree of boxes that finds the boxes near a point, a box or a ray. A search leaves out
// only boxes that the caller's test rules out, so it can be exact. For validate/ and repair/.
#pragma once

#include <span>
#include <vector>

#include "geometry/point.h"

namespace watertight::validate {

class BoxTree {
 public:
  /// Cost: O(n log n). The same boxes in the same order give the same tree.
  explicit BoxTree(std::span<const Box> boxes);

  /// Calls visit(item) for the items of each leaf for whose box and all boxes above it enter(box)
  /// is true. A box contains all boxes below it. Cost: the number of calls of `enter`.
  template <class Enter, class Visit>
  void visit(Enter enter, Visit visit) const {
    for (std::size_t i = 0; i < nodes_.size();) {
      const Node& node = nodes_[i];
      if (!enter(node.box)) {
        i = node.next;
        continue;
      }
      for (Index at = node.begin; at < node.end; ++at) visit(items_[at]);
      ++i;
    }
  }

  /// Calls visit(items, box) for every leaf; the items of a leaf lie close to each other.
  template <class Visit>
  void visit_leaves(Visit visit) const {
    for (const Node& node : nodes_) {
      if (node.begin == node.end) continue;
      visit(std::span<const Index>(items_).subspan(node.begin, node.end - node.begin), node.box);
    }
  }

 private:
  struct Node {
    Box box;
    Index begin = 0;  // the first item of a leaf; an inner node has no items
    Index end = 0;
    std::size_t next = 0;  // the index of the first node after all nodes below this one
  };

  std::vector<Index> items_;
  std::vector<Node> nodes_;  // each node before the nodes below it, the lower half first
};

/// The box of a triangle.
inline Box box_of(const Triangle& triangle, std::span<const Point> vertices) {
  Box box;
  for (const Index vertex : triangle) box.include(vertices[vertex]);
  return box;
}

/// The boxes of triangles, in their order.
inline std::vector<Box> boxes_of(std::span<const Point> vertices,
                                 std::span<const Triangle> triangles) {
  std::vector<Box> boxes;
  boxes.reserve(triangles.size());
  for (const Triangle& triangle : triangles) boxes.push_back(box_of(triangle, vertices));
  return boxes;
}

}  // namespace watertight::validate
