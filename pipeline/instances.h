// SPDX-License-Identifier: GPL-3.0-or-later
//
// Geometry templates and their instances, judged as placed. For validate_stream() and ingest().
//
// A template counts as one solid, which all its valid instances share; an instance that is not
// valid counts as a solid of the feature that has it. A template without instances is judged as it
// is; one whose instances are all invalid does not count.
#pragma once

#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "pipeline/pipeline.h"

namespace watertight {

/// Thread-safe. Keeps references to the templates of one document.
class TemplateInspector {
 public:
  TemplateInspector(std::span<const SubmittedSolid> templates, EngineWorkers* workers,
                    const CertifyOptions& options);

  /// Judges the feature's instances and appends those that are not valid to its solids. Instances
  /// that do the same to one template share the work. Cost: the exact tests for each different
  /// matrix, a proof for each template.
  void inspect_instances(InspectedFeature& feature);

  /// The templates as a feature of their own, of type "GeometryTemplates", after all features:
  /// those without instances as they are, the others as one of their valid instances has them (one
  /// that is shifted or turned only, else the least placement, whatever the order of features).
  /// With those of `others`, instances that no feature has, that are not valid. Nothing when none
  /// is left.
  std::optional<InspectedFeature> inspect_templates(
      const std::vector<TemplateInstance>& others = {});

 private:
  /// How an instance changes the size and shape of its template. Nothing when it is turned and
  /// shifted only, exactly, in metres.
  using Effect = std::optional<std::pair<decltype(Placement::linear), std::array<double, 3>>>;

  struct Uses {
    bool has_instances = false;
    bool has_congruent = false;      // a valid one without effect
    std::optional<Placement> least;  // of the other valid ones
    std::string least_name;          // of that instance
    bool is_proven = false;          // by an instance that is not mirrored
    bool is_unproven = false;        // no engine found a proof: none is asked again
    std::set<Effect> valid;          // some of the effects of valid instances
  };

  static Effect effect_of(const Placement& placement);
  Inspection judge(std::size_t solid, const TemplateInstance& instance);
  void note_valid(std::size_t solid, const TemplateInstance& instance, const Effect& effect);
  void append(std::size_t solid, const TemplateInstance& instance, Inspection inspection,
              InspectedFeature& feature) const;

  std::span<const SubmittedSolid> templates_;
  EngineWorkers* workers_;
  CertifyOptions options_;
  std::mutex mutex_;        // guards uses_
  std::vector<Uses> uses_;  // one per solid of templates_
};

}  // namespace watertight
