// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/overlap/box_tree.h"

#include <algorithm>
#include <utility>

namespace watertight::validate {
namespace {

constexpr std::size_t kLeafSize = 8;

struct Entry {
  Point centre;
  Index item = 0;
};

int longest_axis(std::span<const Entry> entries) {
  Box box;
  for (const Entry& entry : entries) box.include(entry.centre);
  int longest = 0;
  for (int axis = 1; axis < 3; ++axis) {
    if (box.max[axis] - box.min[axis] > box.max[longest] - box.min[longest]) longest = axis;
  }
  return longest;
}

}  // namespace

BoxTree::BoxTree(std::span<const Box> boxes) {
  std::vector<Entry> entries(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Box& box = boxes[i];
    entries[i].item = static_cast<Index>(i);
    for (int axis = 0; axis < 3; ++axis) {
      entries[i].centre[axis] = box.min[axis] / 2 + box.max[axis] / 2;
    }
  }
  // A stack of the ranges of entries that are still to become nodes, lower halves on top.
  std::vector<std::pair<Index, Index>> ranges;
  if (!entries.empty()) ranges.emplace_back(0, static_cast<Index>(entries.size()));
  while (!ranges.empty()) {
    const auto [begin, end] = ranges.back();
    ranges.pop_back();
    Node node;
    if (end - begin <= kLeafSize) {
      node.begin = begin;
      node.end = end;
    } else {
      const Index middle = begin + (end - begin) / 2;
      const int axis = longest_axis(std::span<const Entry>(entries).subspan(begin, end - begin));
      std::nth_element(entries.begin() + begin, entries.begin() + middle, entries.begin() + end,
                       [axis](const Entry& a, const Entry& b) {
                         return a.centre[axis] != b.centre[axis] ? a.centre[axis] < b.centre[axis]
                                                                 : a.item < b.item;
                       });
      ranges.emplace_back(middle, end);
      ranges.emplace_back(begin, middle);
    }
    nodes_.push_back(node);
  }
  items_.reserve(entries.size());
  for (const Entry& entry : entries) items_.push_back(entry.item);
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    Node& node = nodes_[i];
    for (Index at = node.begin; at < node.end; ++at) {
      node.box.include(boxes[items_[at]].min);
      node.box.include(boxes[items_[at]].max);
    }
    node.next = i + 1;
    if (node.begin != node.end) continue;
    const Node& lower = nodes_[i + 1];
    const Node& upper = nodes_[lower.next];
    for (const Node* half : {&lower, &upper}) {
      node.box.include(half->box.min);
      node.box.include(half->box.max);
    }
    node.next = upper.next;
  }
}

}  // namespace watertight::validate
