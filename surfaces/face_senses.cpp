// SPDX-License-Identifier: GPL-3.0-or-later
#include "surfaces/face_senses.h"

namespace watertight::surfaces {
namespace {

struct Neighbour {
  Index face = kNone;
  bool is_against = false;  // both faces use the edge in the same direction
};

/// The faces that edges of two faces join to each face.
std::vector<std::vector<Neighbour>> neighbours_of(std::size_t face_count,
                                                  const std::vector<std::vector<EdgeUse>>& uses) {
  std::vector<std::vector<Neighbour>> neighbours(face_count);
  for (const std::vector<EdgeUse>& pair : uses) {
    if (pair.size() != 2 || pair[0].face == pair[1].face) continue;
    const bool is_against = pair[0].is_forward == pair[1].is_forward;
    neighbours[pair[0].face].push_back({pair[1].face, is_against});
    neighbours[pair[1].face].push_back({pair[0].face, is_against});
  }
  return neighbours;
}

}  // namespace

std::vector<bool> wrongly_oriented(std::size_t face_count,
                                   const std::vector<std::vector<EdgeUse>>& uses) {
  const std::vector<std::vector<Neighbour>> neighbours = neighbours_of(face_count, uses);
  std::vector<bool> is_turned(face_count, false);
  std::vector<bool> is_seen(face_count, false);
  for (Index first = 0; first < face_count; ++first) {
    if (is_seen[first]) continue;
    std::vector<Index> part{first};
    is_seen[first] = true;
    std::size_t turned = 0;
    bool is_consistent = true;
    for (std::size_t at = 0; at < part.size(); ++at) {
      const Index face = part[at];
      if (is_turned[face]) ++turned;
      for (const Neighbour& other : neighbours[face]) {
        const bool wanted = is_turned[face] != other.is_against;
        if (!is_seen[other.face]) {
          is_seen[other.face] = true;
          is_turned[other.face] = wanted;
          part.push_back(other.face);
        } else if (is_turned[other.face] != wanted) {
          is_consistent = false;
        }
      }
    }
    const bool are_most = 2 * turned > part.size();
    for (const Index face : part) is_turned[face] = is_consistent && is_turned[face] != are_most;
  }
  return is_turned;
}

}  // namespace watertight::surfaces
