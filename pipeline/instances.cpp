// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/instances.h"

#include <algorithm>
#include <tuple>

#include "base/assert.h"
#include "base/quantity.h"
#include "geometry/crs/crs.h"
#include "pipeline/groups.h"

namespace watertight::pipeline {
namespace {

/// The most effects that are remembered per template, as a document may have many instances.
constexpr std::size_t kMostEffects = 4096;

/// True if no finding and no reason in the group's report refers to a member.
bool is_silent(const InspectedGroup& group) {
  return group.report.verdict == Verdict::valid && group.report.findings.empty() &&
         group.report.not_run.empty();
}

/// The candidates that are solids of the feature: the first `own` ones, instances that are not
/// valid, and members of the groups whose reports say something.
std::vector<bool> shown(std::span<const GroupCandidate> candidates, std::size_t own,
                        std::span<const InspectedGroup> groups) {
  std::vector<bool> is_shown(candidates.size());
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    is_shown[i] = i < own || candidates[i].member.solid == nullptr;
  }
  for (const InspectedGroup& group : groups) {
    if (is_silent(group)) continue;
    for (const std::size_t member : group.members) is_shown[member] = true;
  }
  return is_shown;
}

/// True if the members, solids of the feature itself, come from two geometries or more.
bool are_of_two_geometries(std::span<const std::size_t> members, const InspectedFeature& feature) {
  const auto geometry = [&](std::size_t member) {
    const SolidSource& source = feature.solids[member].source;
    return std::tie(source.object_id, source.geometry);
  };
  return std::any_of(members.begin(), members.end(), [&](std::size_t member) {
    return geometry(member) != geometry(members.front());
  });
}

bool by_first_member(const InspectedGroup& a, const InspectedGroup& b) {
  return std::pair(a.members.front(), a.kind) < std::pair(b.members.front(), b.kind);
}

/// Orders solids of templates by the number of their template.
struct ByTemplate {
  bool operator()(const SubmittedSolid& solid, std::uint64_t number) const {
    return solid.source.geometry < number;
  }
  bool operator()(std::uint64_t number, const SubmittedSolid& solid) const {
    return number < solid.source.geometry;
  }
};

std::string name_of(const formats::TemplateInstance& instance) {
  return instance.source.pointer.empty() ? "'" + instance.source.object_id + "'"
                                         : instance.source.pointer;
}

}  // namespace

TemplateInspector::TemplateInspector(std::span<const SubmittedSolid> templates,
                                     delaunay::EngineWorkers* workers,
                                     const CertifyOptions& options,
                                     const validate::GroupOptions& groups)
    : templates_(templates),
      workers_(workers),
      options_(options),
      group_options_(groups),
      uses_(templates.size()) {}

std::string TemplateInspector::refusal_of(
    std::span<const formats::TemplateInstance> instances) const {
  std::uint64_t count = 0;
  for (const formats::TemplateInstance& instance : instances) {
    const auto [begin, end] = std::equal_range(templates_.begin(), templates_.end(),
                                               instance.template_number, ByTemplate{});
    count += static_cast<std::uint64_t>(end - begin);
  }
  const std::uint64_t most = options_.limits.placed_solids_of(instances.size());
  if (count <= most) return {};
  return quantity(instances.size(), "instance") + " of geometry templates place " +
         quantity(count, "solid") + " in one feature; the limit is " + std::to_string(most);
}

InspectedInstances TemplateInspector::inspect(
    std::span<const formats::TemplateInstance> instances) {
  InspectedInstances inspected;
  inspected.refusal = refusal_of(instances);
  if (!inspected.refusal.empty()) return inspected;
  for (const formats::TemplateInstance& instance : instances) {
    const auto [begin, end] = std::equal_range(templates_.begin(), templates_.end(),
                                               instance.template_number, ByTemplate{});
    const Effect effect = effect_of(instance.placement);
    const std::size_t first = inspected.solids.size();
    for (auto solid = begin; solid != end; ++solid) {
      const auto number = static_cast<std::size_t>(solid - templates_.begin());
      inspected.solids.push_back(inspect_solid(number, instance, effect));
    }
    if (end - begin > 1 && begin->source.geometry_type == "CompositeSolid") {
      compare_members(first, inspected);
    }
  }
  return inspected;
}

InstanceSolid TemplateInspector::inspect_solid(std::size_t solid,
                                               const formats::TemplateInstance& instance,
                                               const Effect& effect) {
  InstanceSolid result{instance.source, &instance, solid, nullptr, std::nullopt};
  result.source.lod = templates_[solid].source.lod;
  result.source.ordinal = templates_[solid].source.ordinal;
  Uses& uses = uses_[solid];
  {
    const std::lock_guard lock(mutex_);
    uses.has_instances = true;
    if (uses.valid.count(effect) != 0) {
      note_valid(solid, instance, effect);
      result.valid = &*uses.solid;
      return result;
    }
  }
  Inspection inspection = judge(solid, instance);
  if (inspection.report.verdict != Verdict::valid) {
    result.inspection = std::move(inspection);
    return result;
  }
  const std::lock_guard lock(mutex_);
  // An instance that relied on the proof of another one finds the solid here, because proof and
  // solid are set together.
  if (!uses.solid) uses.solid = std::move(inspection.unplaced);
  uses.is_proven = uses.is_proven || geometry::determinant_sign(instance.placement) > 0;
  WATERTIGHT_ASSERT(uses.solid);
  note_valid(solid, instance, effect);
  result.valid = &*uses.solid;
  return result;
}

/// Compares with each other the solids from `first` on, which are those of one instance of a
/// composite solid. The placement is an affine map with an inverse, so only the depth of overlaps
/// depends on it.
void TemplateInspector::compare_members(std::size_t first, InspectedInstances& instances) {
  const std::span<const InstanceSolid> solids = std::span(instances.solids).subspan(first);
  const geometry::Placement& placement = solids.front().instance->placement;
  const Effect effect =
      group_options_.overlap_metres > 0 ? full_effect_of(placement) : std::nullopt;
  Uses& uses = uses_[solids.front().template_solid];
  {
    const std::lock_guard lock(mutex_);
    if (uses.fitting.count(effect) != 0) return;
  }
  std::vector<SolidSource> sources;
  for (const InstanceSolid& solid : solids) {
    sources.push_back(solid.source);
    sources.back().geometry_type = templates_[solid.template_solid].source.geometry_type;
    sources.back().building_id.clear();
  }
  std::vector<GroupCandidate> candidates;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    candidates.push_back({&sources[i], {solids[i].valid, &solids[i].instance->placement}});
  }
  for (InspectedGroup& group : inspect_groups(candidates, group_options_)) {
    if (group.report.verdict == Verdict::valid && group.report.not_run.empty()) {
      const std::lock_guard lock(mutex_);
      if (uses.fitting.size() < kMostEffects) uses.fitting.insert(effect);
      continue;
    }
    for (std::size_t& member : group.members) member += first;
    instances.groups.push_back(std::move(group));
  }
}

/// nullopt for a placement that is congruent in metres: the template then stands for the instance.
TemplateInspector::Effect TemplateInspector::effect_of(const geometry::Placement& placement) {
  Effect effect = full_effect_of(placement);
  const bool is_in_metres = effect->second == std::array<double, 3>{1, 1, 1};
  if (is_in_metres && geometry::is_rotation(placement)) effect.reset();
  return effect;
}

TemplateInspector::Effect TemplateInspector::full_effect_of(const geometry::Placement& placement) {
  return std::pair(
      placement.linear,
      geometry::axis_units(placement.srid, geometry::shift_of(placement)).metres_per_unit);
}

Inspection TemplateInspector::judge(std::size_t solid, const formats::TemplateInstance& instance) {
  CertifyOptions own = options_for(templates_[solid], options_);
  own.placement = &instance.placement;
  const bool is_mirrored = geometry::determinant_sign(instance.placement) < 0;
  delaunay::EngineWorkers* workers = workers_;
  {
    const std::lock_guard lock(mutex_);
    own.is_proven = !is_mirrored && uses_[solid].is_proven;
    if (uses_[solid].is_unproven) workers = nullptr;
  }
  Inspection inspection = certify(templates_[solid].solid, workers, own);
  if (inspection.report.verdict == Verdict::undecided) {
    const std::lock_guard lock(mutex_);
    uses_[solid].is_unproven = true;
  }
  return inspection;
}

/// Notes that an instance is valid. Requires the lock of mutex_.
void TemplateInspector::note_valid(std::size_t solid, const formats::TemplateInstance& instance,
                                   const Effect& effect) {
  Uses& uses = uses_[solid];
  if (uses.valid.size() < kMostEffects) uses.valid.insert(effect);
  if (!effect) {
    uses.has_congruent = true;
  } else if (!uses.least || std::pair(instance.placement, name_of(instance)) <
                                std::pair(*uses.least, uses.least_name)) {
    uses.least = instance.placement;
    uses.least_name = name_of(instance);
  }
}

std::size_t TemplateInspector::show(InstanceSolid solid, InspectedFeature& feature) const {
  const SubmittedSolid& source = templates_[solid.template_solid];
  const geometry::Placement& placement = solid.instance->placement;
  if (!solid.inspection) {  // a valid solid lacks only its report
    CertifyOptions own = options_for(source, options_);
    own.placement = &placement;
    own.is_proven = true;
    solid.inspection = certify(source.solid, nullptr, own);
  }
  // If the coordinates of an instance exceed the doubles, its template is shown.
  auto in_place = geometry::placed(source.solid, placement);
  SubmittedSolid submitted{in_place ? *std::move(in_place) : source.solid, std::move(solid.source)};
  const int sign = geometry::determinant_sign(placement);
  const std::string& pointer = solid.instance->source.pointer;
  submitted.source.pointer =
      sign == 0 && !pointer.empty() ? pointer + "/transformationMatrix" : source.source.pointer;
  const std::string name = " (template " + std::to_string(solid.instance->template_number) +
                           (sign < 0 ? ", mirrored and placed by " : " as placed by ") +
                           name_of(*solid.instance) + ")";
  Report& report = solid.inspection->report;
  for (Finding& finding : report.findings) finding.detail += name;
  if (!report.undecided_reason.empty()) report.undecided_reason += name;
  feature.solids.push_back({submitted.source, *std::move(solid.inspection)});
  feature.feature.solids.push_back(std::move(submitted));
  return feature.solids.size() - 1;
}

std::optional<InspectedFeature> TemplateInspector::inspect_templates(
    std::vector<formats::TemplateInstance> others, std::vector<SubmittedSolid> surfaces) {
  InspectedFeature inspected;
  inspected.feature.surfaces = std::move(surfaces);
  inspected.feature.id = "geometry-templates";
  inspected.feature.type = "GeometryTemplates";
  inspected.feature.instances = std::move(others);
  add_groups(inspect(inspected.feature.instances), *this, group_options_, inspected);
  std::vector<std::size_t> unplaced;  // solids of templates without instances
  for (std::size_t i = 0; i < templates_.size(); ++i) {
    const Uses& uses = uses_[i];
    if (uses.has_instances && !uses.has_congruent && !uses.least) continue;
    CertifyOptions own = options_for(templates_[i], options_);
    const bool is_placed = uses.has_instances && !uses.has_congruent;
    if (is_placed) own.placement = &*uses.least;
    Inspection inspection = certify(templates_[i].solid, workers_, own);
    if (is_placed) inspection.report.notes.push_back("as placed by " + uses.least_name);
    if (!uses.has_instances) unplaced.push_back(inspected.solids.size());
    inspected.solids.push_back({templates_[i].source, std::move(inspection)});
    inspected.feature.solids.push_back(templates_[i]);
  }
  if (solid_count(inspected.feature) == 0 && inspected.feature.surfaces.empty()) {
    return std::nullopt;
  }
  const std::vector<GroupCandidate> all = group_candidates(inspected);
  std::vector<GroupCandidate> candidates;
  for (const std::size_t solid : unplaced) candidates.push_back(all[solid]);
  for (InspectedGroup& group : inspect_groups(candidates, group_options_)) {
    for (std::size_t& member : group.members) member = unplaced[member];
    inspected.groups.push_back(std::move(group));
  }
  add_unreadable(inspected, options_);
  add_surfaces(inspected, options_);
  return inspected;
}

void add_unreadable(InspectedFeature& inspected, const CertifyOptions& options) {
  for (formats::UnreadablePart& part : inspected.feature.unreadable) {
    auto nothing = Solid::make(SolidArrays{}, Lattice{}, inspected.feature.srid);
    if (!nothing) continue;  // an empty solid breaks no rule of Solid
    SubmittedSolid solid{*std::move(nothing), std::move(part.source), {}};
    solid.unreadable = std::move(part.error.message);
    inspected.solids.push_back(
        {solid.source, certify(solid.solid, nullptr, options_for(solid, options))});
    inspected.feature.solids.push_back(std::move(solid));
  }
  inspected.feature.unreadable.clear();
}

void add_groups(InspectedInstances instances, const TemplateInspector& templates,
                const validate::GroupOptions& options, InspectedFeature& feature) {
  if (!instances.refusal.empty()) {
    feature.feature.unreadable.push_back(
        {{}, Error{ErrorCode::limit_exceeded, std::move(instances.refusal)}});
  }
  std::vector<GroupCandidate> candidates = group_candidates(feature);
  const std::size_t own = candidates.size();
  for (const InstanceSolid& solid : instances.solids) {
    candidates.push_back({&solid.source, {solid.valid, &solid.instance->placement}});
  }
  std::vector<InspectedGroup> groups = inspect_groups(candidates, options);
  for (InspectedGroup& group : instances.groups) {
    for (std::size_t& member : group.members) member += own;
    groups.push_back(std::move(group));
  }
  const std::vector<bool> is_shown = shown(candidates, own, groups);
  // For each candidate that is shown, its index among the feature's solids.
  std::vector<std::size_t> place(candidates.size());
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (i < own) {
      place[i] = i;
    } else if (is_shown[i]) {
      place[i] = templates.show(std::move(instances.solids[i - own]), feature);
    }
  }
  for (InspectedGroup& group : groups) {
    const std::size_t count = group.members.size();
    std::erase_if(group.members, [&](std::size_t member) { return !is_shown[member]; });
    if (group.members.size() < count && !are_of_two_geometries(group.members, feature)) continue;
    for (std::size_t& member : group.members) member = place[member];
    feature.groups.push_back(std::move(group));
  }
  std::stable_sort(feature.groups.begin(), feature.groups.end(), by_first_member);
}

}  // namespace watertight::pipeline
