// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/instances.h"

#include <algorithm>

#include "geometry/crs.h"

namespace watertight {
namespace {

/// Effects remembered for each template: bounds the memory of a document with many instances.
constexpr std::size_t kMostEffects = 4096;

std::string name_of(const TemplateInstance& instance) {
  return instance.source.pointer.empty() ? "'" + instance.source.object_id + "'"
                                         : instance.source.pointer;
}

}  // namespace

TemplateInspector::TemplateInspector(std::span<const SubmittedSolid> templates,
                                     EngineWorkers* workers, const CertifyOptions& options)
    : templates_(templates), workers_(workers), options_(options), uses_(templates.size()) {}

void TemplateInspector::inspect_instances(InspectedFeature& feature) {
  // Solids are appended to feature.feature, whose instances stay as they are.
  const std::vector<TemplateInstance> instances = feature.feature.instances;
  for (const TemplateInstance& instance : instances) {
    const auto begin = std::partition_point(
        templates_.begin(), templates_.end(), [&](const SubmittedSolid& solid) {
          return solid.source.geometry < instance.template_number;
        });
    for (auto solid = static_cast<std::size_t>(begin - templates_.begin());
         solid < templates_.size() && templates_[solid].source.geometry == instance.template_number;
         ++solid) {
      const Effect effect = effect_of(instance.placement);
      {
        const std::lock_guard lock(mutex_);
        uses_[solid].has_instances = true;
        if (uses_[solid].valid.count(effect) != 0) {
          note_valid(solid, instance, effect);
          continue;
        }
      }
      Inspection inspection = judge(solid, instance);
      if (inspection.report.verdict == Verdict::valid) {
        const std::lock_guard lock(mutex_);
        note_valid(solid, instance, effect);
      } else {
        append(solid, instance, std::move(inspection), feature);
      }
    }
  }
}

/// Nothing of a placement that is congruent in metres: then the template stands for the instance.
TemplateInspector::Effect TemplateInspector::effect_of(const Placement& placement) {
  const std::array<double, 3> units = axis_units(placement.srid, placement.shift).metres_per_unit;
  if (units == std::array<double, 3>{1, 1, 1} && is_rotation(placement)) return std::nullopt;
  return std::pair(placement.linear, units);
}

Inspection TemplateInspector::judge(std::size_t solid, const TemplateInstance& instance) {
  CertifyOptions own = options_for(templates_[solid], options_);
  own.placement = &instance.placement;
  const bool is_mirrored = determinant_sign(instance.placement) < 0;
  EngineWorkers* workers = workers_;
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
  if (!is_mirrored && inspection.report.verdict == Verdict::valid) {
    const std::lock_guard lock(mutex_);
    uses_[solid].is_proven = true;
  }
  return inspection;
}

/// Requires the lock.
void TemplateInspector::note_valid(std::size_t solid, const TemplateInstance& instance,
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

void TemplateInspector::append(std::size_t solid, const TemplateInstance& instance,
                               Inspection inspection, InspectedFeature& feature) const {
  const SubmittedSolid& source = templates_[solid];
  // A place beyond the doubles cannot be shown: the template is.
  auto in_place = placed(source.solid, instance.placement);
  SubmittedSolid submitted{in_place ? *std::move(in_place) : source.solid, instance.source};
  submitted.source.lod = source.source.lod;
  submitted.source.ordinal = source.source.ordinal;
  const int sign = determinant_sign(instance.placement);
  const bool has_pointer = !instance.source.pointer.empty();
  submitted.source.pointer = sign == 0 && has_pointer
                                 ? instance.source.pointer + "/transformationMatrix"
                                 : source.source.pointer;
  const std::string name = " (template " + std::to_string(instance.template_number) +
                           (sign < 0 ? ", mirrored and placed by " : " as placed by ") +
                           name_of(instance) + ")";
  for (Finding& finding : inspection.report.findings) finding.detail += name;
  if (!inspection.report.undecided_reason.empty()) inspection.report.undecided_reason += name;
  feature.solids.push_back({submitted.source, std::move(inspection)});
  feature.feature.solids.push_back(std::move(submitted));
}

std::optional<InspectedFeature> TemplateInspector::inspect_templates(
    const std::vector<TemplateInstance>& others) {
  InspectedFeature inspected;
  inspected.feature.instances = others;
  inspect_instances(inspected);
  inspected.feature.id = "geometry-templates";
  inspected.feature.type = "GeometryTemplates";
  for (std::size_t i = 0; i < templates_.size(); ++i) {
    const Uses& uses = uses_[i];
    if (uses.has_instances && !uses.has_congruent && !uses.least) continue;
    CertifyOptions own = options_for(templates_[i], options_);
    const bool is_placed = uses.has_instances && !uses.has_congruent;
    if (is_placed) own.placement = &*uses.least;
    Inspection inspection = certify(templates_[i].solid, workers_, own);
    if (is_placed) inspection.report.notes.push_back("as placed by " + uses.least_name);
    inspected.solids.push_back({templates_[i].source, std::move(inspection)});
    inspected.feature.solids.push_back(templates_[i]);
  }
  if (inspected.solids.empty()) return std::nullopt;
  return inspected;
}

}  // namespace watertight
