// SPDX-License-Identifier: GPL-3.0-or-later
//
// Geometry templates and their instances, judged as placed. For validate_stream() and ingest().
//
// A template counts as one solid, which all its valid instances share; an instance that is not
// valid, or in whose group something was found, counts as solids of the feature that has it. A
// template without instances is judged as it is; one whose instances are all invalid does not
// count.
#pragma once

#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "pipeline/pipeline.h"

namespace watertight::pipeline {

/// One solid of an instance. Its placement is that of the feature's instance.
struct InstanceSolid {
  SolidSource source;  // the instance's, with LoD and ordinal of the template's solid
  const formats::TemplateInstance* instance = nullptr;
  std::size_t template_solid = 0;
  const ValidSolid* valid = nullptr;     // as the template has it; null if not valid
  std::optional<Inspection> inspection;  // absent if valid
};

/// The instances of a feature, solid by solid, and the groups of those that are composite solids in
/// which something was found. Members are indices into `solids`.
struct InspectedInstances {
  std::vector<InstanceSolid> solids;
  std::vector<InspectedGroup> groups;
};

/// Thread-safe. Keeps references to the templates of one document.
class TemplateInspector {
 public:
  TemplateInspector(std::span<const SubmittedSolid> templates, delaunay::EngineWorkers* workers,
                    const CertifyOptions& options, const validate::GroupOptions& groups);

  /// Judges instances of the templates, and the members of composite ones with each other.
  /// Instances that do the same to one template share the work. The result refers to `instances`
  /// and to this. Cost: the exact tests for each different matrix, a proof for each template.
  InspectedInstances inspect(std::span<const formats::TemplateInstance> instances);

  /// Makes an instance's solid one of the feature's, whose index is returned.
  std::size_t show(InstanceSolid solid, InspectedFeature& feature) const;

  /// The templates as a feature of their own, of type "GeometryTemplates", after all features:
  /// those without instances as they are, the others as one of their valid instances has them (one
  /// that is shifted or turned only, else the least placement, whatever the order of features). It
  /// includes the invalid ones of `others`, which are instances that no feature has. Nothing when
  /// no template is left.
  std::optional<InspectedFeature> inspect_templates(
      std::vector<formats::TemplateInstance> others = {});

 private:
  /// How an instance changes the size and shape of its template. Nothing when it is turned and
  /// shifted only, exactly, in metres.
  using Effect =
      std::optional<std::pair<decltype(geometry::Placement::linear), std::array<double, 3>>>;

  struct Uses {
    bool has_instances = false;
    bool has_congruent = false;                // a valid one without effect
    std::optional<geometry::Placement> least;  // the least placement of the other valid ones
    std::string least_name;                    // the name of the instance at `least`
    bool is_proven = false;                    // an instance that is not mirrored has a proof
    bool is_unproven = false;                  // no engine found a proof: none is asked again
    std::set<Effect> valid;                    // some of the effects of valid instances
    std::set<Effect> fitting;  // some effects with which the members of a composite solid fit
    std::optional<ValidSolid> solid;  // the solid that all valid instances have
  };

  static Effect effect_of(const geometry::Placement& placement);
  static Effect full_effect_of(const geometry::Placement& placement);
  Inspection judge(std::size_t solid, const formats::TemplateInstance& instance);
  void note_valid(std::size_t solid, const formats::TemplateInstance& instance,
                  const Effect& effect);
  InstanceSolid inspect_solid(std::size_t solid, const formats::TemplateInstance& instance,
                              const Effect& effect);
  void compare_members(std::size_t first, InspectedInstances& instances);

  std::span<const SubmittedSolid> templates_;
  delaunay::EngineWorkers* workers_;
  CertifyOptions options_;
  validate::GroupOptions group_options_;
  std::mutex mutex_;        // guards uses_
  std::vector<Uses> uses_;  // one per solid of templates_
};

/// Compares the feature's solids and instances in groups, and makes solids of the feature of the
/// instances that are not valid or in whose groups something was found.
void add_groups(InspectedInstances instances, const TemplateInspector& templates,
                const validate::GroupOptions& options, InspectedFeature& feature);

}  // namespace watertight::pipeline
