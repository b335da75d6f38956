// SPDX-License-Identifier: GPL-3.0-or-later
//
// Geometry templates and their instances, validated as placed. For validate_stream() and ingest().
//
// A template counts as one solid, which all its valid instances share; an instance that is not
// valid, or in whose group something was found, counts as solids of the feature that has it. A
// template without instances is validated as it is; a template whose instances are all invalid does
// not count.
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
  SolidSource source;  // that of the instance, with LoD and ordinal of the template's solid
  const formats::TemplateInstance* instance = nullptr;
  std::size_t template_solid = 0;
  const ValidSolid* valid = nullptr;     // the template's solid; null if not valid
  std::optional<Inspection> inspection;  // absent if valid
};

/// The solids of the instances of a feature, and the groups of composite solids in which something
/// was found. Members are indices into `solids`.
struct InspectedInstances {
  std::vector<InstanceSolid> solids;
  std::vector<InspectedGroup> groups;
  std::string refusal;  // why the instances were not validated, "" if they were
};

/// Validates instances of the templates of one document, to which it keeps references. Thread-safe.
class TemplateInspector {
 public:
  TemplateInspector(std::span<const SubmittedSolid> templates, delaunay::EngineWorkers* workers,
                    const CertifyOptions& options, const validate::GroupOptions& groups);

  /// Validates instances of the templates, and compares the members of composite solids with each
  /// other. Instances that change one template in the same way share the work. More solids than
  /// Limits::placed_solids_of() are refused. The result refers to `instances` and to this object.
  /// Cost: the exact tests for each different matrix, a proof for each template.
  InspectedInstances inspect(std::span<const formats::TemplateInstance> instances);

  /// Adds the solid of an instance to the solids of the feature; returns its index there.
  std::size_t show(InstanceSolid solid, InspectedFeature& feature) const;

  /// The templates as a feature of their own, of type "GeometryTemplates", after all features. A
  /// template without instances is in it as it is, another one as a valid instance places it (one
  /// that is only shifted or turned, else the one with the least placement, whatever the order of
  /// features). The feature includes the invalid instances among `others`, which belong to no
  /// feature. `surfaces` are those of
  /// templates. nullopt when nothing is left.
  std::optional<InspectedFeature> inspect_templates(
      std::vector<formats::TemplateInstance> others = {},
      std::vector<SubmittedSolid> surfaces = {});

 private:
  /// The change that an instance makes to size and shape of its template. nullopt when the instance
  /// is only turned and shifted, exactly, in metres.
  using Effect =
      std::optional<std::pair<decltype(geometry::Placement::linear), std::array<double, 3>>>;

  struct Uses {
    bool has_instances = false;
    bool has_congruent = false;                // a valid instance has no effect
    std::optional<geometry::Placement> least;  // the least placement of the other valid instances
    std::string least_name;                    // the name of the instance with placement `least`
    bool is_proven = false;                    // an instance that is not mirrored has a proof
    bool is_unproven = false;                  // no engine found a proof; none is asked again
    std::set<Effect> valid;                    // some effects of valid instances
    std::set<Effect> fitting;  // some effects with which the members of a composite solid fit
    std::optional<ValidSolid> solid;  // the solid that all valid instances have
  };

  /// Why so many instances are refused, "" if they are not.
  std::string refusal_of(std::span<const formats::TemplateInstance> instances) const;
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

/// Adds an empty, invalid solid for each part of the feature that could not be read.
void add_unreadable(InspectedFeature& inspected, const CertifyOptions& options);

/// Compares the feature's solids and instances in groups, and makes solids of the feature of the
/// instances that are not valid or in whose groups something was found. Instances that were refused
/// become an unreadable part.
void add_groups(InspectedInstances instances, const TemplateInspector& templates,
                const validate::GroupOptions& options, InspectedFeature& feature);

}  // namespace watertight::pipeline
