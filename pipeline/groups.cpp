// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/groups.h"

#include <algorithm>
#include <map>
#include <string>
#include <tuple>
#include <utility>

namespace watertight::pipeline {
namespace {

using Candidates = std::span<const GroupCandidate>;

bool are_of_one_geometry(const SolidSource& a, const SolidSource& b) {
  return a.object_id == b.object_id && a.geometry == b.geometry &&
         a.geometry_type == b.geometry_type && a.lod == b.lod;
}

/// The first solid of each geometry, and the end. A geometry is a run of solids whose ordinals
/// ascend.
std::vector<std::size_t> geometry_starts(Candidates candidates) {
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const bool continues = i > 0 &&
                           are_of_one_geometry(*candidates[i - 1].source, *candidates[i].source) &&
                           candidates[i - 1].source->ordinal < candidates[i].source->ordinal;
    if (!continues) starts.push_back(i);
  }
  starts.push_back(candidates.size());
  return starts;
}

struct DraftGroup {
  InspectedGroup group;
  std::vector<Index> unit_of;  // the geometry of each member
};

void add(DraftGroup& draft, std::size_t begin, std::size_t end, std::size_t geometry) {
  for (std::size_t i = begin; i < end; ++i) {
    draft.group.members.push_back(i);
    draft.unit_of.push_back(static_cast<Index>(geometry));
  }
}

std::vector<DraftGroup> draft_groups(Candidates candidates) {
  std::vector<DraftGroup> drafts;
  std::map<std::pair<std::string, std::string>, DraftGroup> buildings;  // by id and LoD
  const std::vector<std::size_t> starts = geometry_starts(candidates);
  for (std::size_t geometry = 0; geometry + 1 < starts.size(); ++geometry) {
    const std::size_t begin = starts[geometry];
    const std::size_t end = starts[geometry + 1];
    const SolidSource& source = *candidates[begin].source;
    if (source.geometry_type == "CompositeSolid") {
      DraftGroup& draft = drafts.emplace_back();
      draft.group = {validate::GroupKind::composite_solid, source.object_id, source.lod, {}, {}};
      for (std::size_t i = begin; i < end; ++i) draft.group.members.push_back(i);
    }
    if (source.building_id.empty()) continue;
    DraftGroup& building = buildings[{source.building_id, source.lod}];
    building.group.kind = validate::GroupKind::building_parts;
    building.group.object_id = source.building_id;
    building.group.lod = source.lod;
    add(building, begin, end, geometry);
  }
  for (auto& [key, building] : buildings) {
    if (building.unit_of.front() != building.unit_of.back()) drafts.push_back(std::move(building));
  }
  std::sort(drafts.begin(), drafts.end(), [](const DraftGroup& a, const DraftGroup& b) {
    return std::pair(a.group.members.front(), a.group.kind) <
           std::pair(b.group.members.front(), b.group.kind);
  });
  return drafts;
}

}  // namespace

std::vector<GroupCandidate> group_candidates(const InspectedFeature& feature) {
  std::vector<GroupCandidate> candidates;
  candidates.reserve(feature.solids.size());
  for (const InspectedSolid& solid : feature.solids) {
    const auto& certified = solid.inspection.certified;
    candidates.push_back({&solid.source, {certified ? &certified->solid : nullptr}});
  }
  return candidates;
}

std::vector<InspectedGroup> inspect_groups(std::span<const GroupCandidate> candidates,
                                           const validate::GroupOptions& options) {
  std::vector<InspectedGroup> groups;
  if (candidates.size() < 2) return groups;
  for (DraftGroup& draft : draft_groups(candidates)) {
    std::vector<validate::GroupMember> members;
    for (const std::size_t member : draft.group.members) {
      members.push_back(candidates[member].member);
    }
    draft.group.report = validate::check_group(members, draft.group.kind, options, draft.unit_of);
    groups.push_back(std::move(draft.group));
  }
  return groups;
}

}  // namespace watertight::pipeline
