// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/repaired/repair_notes.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <vector>

#include "base/quantity.h"
#include "validate/finding_kinds.h"

namespace watertight::pipeline {
namespace {

std::string fixed_text(double value, int decimals) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  return text.data();
}

std::string short_text(double value) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.3g", value);
  return text.data();
}

/// The smooth patches: "1 hole of 12 edges: 19 vertices and 48 facets added, largest turn across
/// the border 11 degrees, energy 2.1", and why holes got none. Empty without any.
std::string patches_of(const repair::RepairSummary& changes) {
  std::size_t holes = 0;
  std::size_t edges = 0;
  std::size_t facets = 0;
  repair::SmoothMeasures sum;
  std::map<std::string, std::size_t> refusals;
  for (const repair::HoleFill& hole : changes.holes) {
    if (!hole.smooth_refusal.empty()) ++refusals[hole.smooth_refusal];
    if (!hole.smooth) continue;
    ++holes;
    edges += hole.vertices;
    facets += hole.facets;
    sum.vertices += hole.smooth->vertices;
    sum.largest_turn = std::max(sum.largest_turn, hole.smooth->largest_turn);
    sum.energy += hole.smooth->energy;
  }
  std::string text;
  if (holes > 0) {
    text = quantity(holes, "hole") + " of " + quantity(edges, "edge") + ": " +
           quantity(sum.vertices, "vertex", "vertices") + " and " + quantity(facets, "facet") +
           " added, largest turn across the border " + fixed_text(sum.largest_turn, 1) +
           " degrees, energy " + short_text(sum.energy);
  }
  for (const auto& [reason, count] : refusals) {
    text.append(text.empty() ? "" : "; ").append(quantity(count, "hole"));
    text.append(" without smooth patch (").append(reason).append(")");
  }
  return text;
}

/// The facets that came, went and were turned, and the vertices that moved: "1 facet of 80.000 m2
/// added, 2 removed". Empty without any.
std::string changes_of(const repair::RepairSummary& changes) {
  std::vector<std::string> parts;
  if (changes.facets_added > 0) {
    std::string text = quantity(changes.facets_added, "facet");
    if (changes.area_added > 0) text += " of " + fixed_text(changes.area_added, 3) + " m2";
    parts.push_back(text + " added");
  }
  if (changes.facets_removed > 0) {
    parts.push_back(quantity(changes.facets_removed, "facet") + " removed");
  }
  if (changes.facets_turned > 0) {
    parts.push_back(quantity(changes.facets_turned, "facet") + " turned");
  }
  if (changes.moves.vertices > 0) {
    parts.push_back(quantity(changes.moves.vertices, "vertex", "vertices") + " moved by at most " +
                    fixed_text(changes.moves.largest_metres, 4) + " m");
  }
  std::string text;
  for (const std::string& part : parts) text.append(text.empty() ? "" : ", ").append(part);
  return text;
}

}  // namespace

RepairNotes::RepairNotes(std::span<const SolidRepair> repairs) {
  for (const SolidRepair& repair : repairs) {
    summaries_.emplace(key_of(repair.source, repair.feature), &repair.summary);
  }
}

RepairNotes::SolidKey RepairNotes::key_of(const SolidSource& source, const std::string& feature) {
  return {source.object_id.empty() ? feature : source.object_id, source.geometry, source.ordinal};
}

void RepairNotes::add_to(InspectedFeature& feature) const {
  for (std::size_t i = 0; i < feature.own; ++i) {
    InspectedSolid& solid = feature.solids[i];
    const auto found = summaries_.find(key_of(solid.source, feature.feature.id));
    if (found != summaries_.end()) solid.repair = *found->second;
  }
}

std::string account_of(const repair::RepairSummary& summary) {
  std::string text;
  const auto add = [&](const std::string& part, const char* between) {
    text.append(text.empty() ? "" : between).append(part);
  };
  if (!is_repaired(summary)) {
    for (const int code : summary.codes_before) {
      add(std::to_string(code) + ' ' + std::string(validate::finding_name(code)), ", ");
    }
    if (summary.is_undecided) {
      if (!summary.undecided_reason.empty())
        add(summary.undecided_reason, "; mended, but not proven: ");
      return text.empty() ? "undecided" : "undecided: " + text;
    }
    return "not repaired: " + text;
  }
  for (const repair::Remedy remedy : summary.remedies) add(std::string(to_string(remedy)), ", ");
  text = "repaired: " + text;
  std::string changes = patches_of(summary);
  if (const std::string others = changes_of(summary); !others.empty())
    changes.append(changes.empty() ? "" : "; ").append(others);
  return changes.empty() ? text : text + " (" + changes + ')';
}

}  // namespace watertight::pipeline
