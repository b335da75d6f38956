// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/summary.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>

#include "base/quantity.h"
#include "validate/finding_kinds.h"

namespace watertight::cli {
namespace {

std::string row(const std::string& name, const std::string& value) {
  constexpr std::size_t kNameWidth = 46;  // enough for the longest name of a finding
  constexpr std::size_t kValueWidth = 10;
  const std::size_t padding = name.size() < kNameWidth ? kNameWidth - name.size() : 1;
  const std::size_t blanks = value.size() < kValueWidth ? kValueWidth - value.size() : 1;
  return name + std::string(padding, ' ') + std::string(blanks, ' ') + value + "\n";
}

std::string row(const std::string& name, std::uint64_t value) {
  return row(name, std::to_string(value));
}

/// The rows for files or features without solids, of which `surfaces` have surfaces.
std::string empty_rows(std::uint64_t without_solids, std::uint64_t surfaces) {
  std::string text;
  const std::uint64_t unchecked = without_solids - surfaces;
  if (unchecked > 0) text += row("  without solids: nothing was checked", unchecked);
  if (surfaces > 0) text += row("  without solids: surfaces were checked", surfaces);
  return text;
}

std::string code_row(std::string_view indent, int code, std::uint64_t count) {
  std::string name(indent);
  name.append(std::to_string(code)).append(1, ' ').append(validate::finding_name(code));
  return row(name, count);
}

std::string decimals(double value, int digits) {
  std::array<char, 64> buffer{};
  const int length = std::snprintf(buffer.data(), buffer.size(), "%.*f", digits, value);
  return std::string(buffer.data(), static_cast<std::size_t>(std::max(length, 0)));
}

}  // namespace

Exit worse(Exit a, Exit b) {
  constexpr std::array<Exit, 4> kOrder{Exit::error, Exit::invalid, Exit::undecided, Exit::valid};
  return *std::find_if(kOrder.begin(), kOrder.end(),
                       [&](Exit exit) { return exit == a || exit == b; });
}

Exit exit_of(Verdict verdict) {
  if (verdict == Verdict::valid) return Exit::valid;
  return verdict == Verdict::invalid ? Exit::invalid : Exit::undecided;
}

void Summary::add(const Summary& part) {
  valid_ += part.valid_;
  with_warnings_ += part.with_warnings_;
  invalid_ += part.invalid_;
  undecided_ += part.undecided_;
  has_tolerant_ = has_tolerant_ || part.has_tolerant_;
  valid_snapped_ += part.valid_snapped_;
  repaired_ += part.repaired_;
  features_ += part.features_;
  invalid_features_ += part.invalid_features_;
  undecided_features_ += part.undecided_features_;
  empty_features_ += part.empty_features_;
  files_ += part.files_;
  empty_files_ += part.empty_files_;
  unreadable_files_ += part.unreadable_files_;
  if (part.baseline_) add(*part.baseline_);
  unreadable_ += part.unreadable_;
  stored_ += part.stored_;
  file_bytes_ += part.file_bytes_;
  plain_bytes_ += part.plain_bytes_;
  blob_bytes_ += part.blob_bytes_;
  for (const auto& [code, count] : part.by_code_) by_code_[code] += count;
  for (const auto& [code, count] : part.groups_by_code_) groups_by_code_[code] += count;
  for (const auto& [rung, count] : part.by_rung_) by_rung_[rung] += count;
  surface_features_ += part.surface_features_;
  surface_files_ += part.surface_files_;
  surfaces_.add(part.surfaces_);
  for (const auto& [code, count] : part.surfaces_by_code_) surfaces_by_code_[code] += count;
}

void Summary::add_file(bool has_solids, bool has_surfaces) {
  ++files_;
  if (!has_solids) ++empty_files_;
  if (!has_solids && has_surfaces) ++surface_files_;
}

void Summary::add_unreadable_file() {
  ++files_;
  ++unreadable_files_;
}

void Summary::add(const BaselineCounts& counts) {
  if (!baseline_) baseline_.emplace();
  baseline_->fresh += counts.fresh;
  baseline_->known += counts.known;
  baseline_->gone += counts.gone;
}

void Summary::add_feature(Verdict verdict, bool has_solids, bool has_surfaces) {
  ++features_;
  if (verdict == Verdict::invalid) ++invalid_features_;
  if (verdict == Verdict::undecided) ++undecided_features_;
  if (has_solids || verdict != Verdict::valid) return;
  ++empty_features_;
  if (has_surfaces) ++surface_features_;
}

void Summary::add(const pipeline::FeatureOutcome& feature) {
  repaired_ += static_cast<std::uint64_t>(
      std::ranges::count_if(feature.repairs, &pipeline::SolidRepair::is_repaired));
  add_feature(feature.verdict, !feature.solids.empty(), false);
  for (const pipeline::SolidOutcome& solid : feature.solids) {
    add(solid.report);
    if (solid.blob_bytes == 0) continue;
    plain_bytes_ += solid.source_bytes;
    blob_bytes_ += solid.blob_bytes;
  }
  add(feature.groups);
}

void Summary::add(const pipeline::InspectedFeature& feature) {
  bool has_solids = false;
  for (const pipeline::InspectedSolid& solid : feature.solids) {
    const Report& report = solid.inspection.report;
    if (!solid.surface) {
      has_solids = true;
      add(report);
      continue;
    }
    std::set<int> codes;
    for (const Finding& finding : report.findings) codes.insert(finding.code);
    for (const int code : codes) ++surfaces_by_code_[code];
  }
  surfaces_.add(feature.surfaces);
  add_feature(feature.verdict(), has_solids, feature.surfaces.checked > 0);
  add(feature.groups);
}

void Summary::add(const Report& report) {
  if (report.tolerant) {
    has_tolerant_ = true;
    if (report.tolerant->verdict == Verdict::valid) ++valid_snapped_;
  }
  if (report.verdict == Verdict::valid) {
    ++valid_;
    if (!report.findings.empty()) ++with_warnings_;
    ++by_rung_[report.rung];
  } else if (report.verdict == Verdict::invalid) {
    ++invalid_;
    for (const int code : validate::error_codes(report.findings)) ++by_code_[code];
  } else {
    ++undecided_;
  }
}

void Summary::add(const std::vector<pipeline::InspectedGroup>& groups) {
  for (const pipeline::InspectedGroup& group : groups) {
    for (const int code : validate::error_codes(group.report.findings)) ++groups_by_code_[code];
  }
}

void Summary::add(const pipeline::StageTimes& times) {
  for (const pipeline::Stage stage : pipeline::kStages) stages_[stage] += times.seconds(stage);
}

std::string Summary::headline() const {
  std::string text;
  const std::uint64_t checked = features_ - empty_features_;
  if (solids() == 0) {
    const bool is_read = unreadable_ + unreadable_files_ == 0;
    text = surfaces_.checked > 0 ? "There are no solids; rings and facets of " +
                                       quantity(surfaces_.checked, "surface") + " were checked.\n"
           : is_read ? "Nothing was checked: there are no solids.\n"
                     : "Nothing was checked.\n";
    if (invalid_features_ + undecided_features_ > 0) {
      text += quantity(invalid_features_, "feature") + " invalid, " +
              std::to_string(undecided_features_) + " undecided.\n";
    }
  } else if (invalid_features_ + undecided_features_ == 0) {
    text = checked == 1 ? "The feature with solids is valid.\n"
                        : "All " + quantity(checked, "feature") + " with solids are valid.\n";
  } else {
    text = quantity(invalid_features_, "feature") + " of " + std::to_string(checked) +
           (invalid_features_ == 1 ? " is invalid" : " are invalid");
    if (undecided_features_ > 0) text += ", " + std::to_string(undecided_features_) + " undecided";
    text += ".\n";
  }
  if (unreadable_files_ > 0) {
    text += quantity(unreadable_files_, "file") + " could not be read.\n";
  }
  if (unreadable_ > 0) {
    text += quantity(unreadable_, "part") + " of the input could not be read.\n";
  }
  const std::uint64_t unchecked = empty_files_ - surface_files_;
  if (solids() > 0 && unchecked > 0) {
    text += "Nothing was checked in " + quantity(unchecked, "file") + " of " +
            std::to_string(files_) + (unchecked == 1 ? ", which has" : ", which have") +
            " no solids.\n";
  }
  if (!baseline_) return text;
  return text + "Against the baseline: " + quantity(baseline_->fresh, "new finding") + ", " +
         std::to_string(baseline_->known) + " known, " + std::to_string(baseline_->gone) +
         " gone.\n";
}

std::string Summary::surface_rows() const {
  if (surfaces_.checked == 0) return "";
  std::string text = row("surfaces", surfaces_.checked);
  if (surfaces_.closed_valid > 0) {
    text += row("  closed: would be a valid solid", surfaces_.closed_valid);
  }
  if (surfaces_.closed > surfaces_.closed_valid) {
    text += row("  closed, but no valid solid", surfaces_.closed - surfaces_.closed_valid);
  }
  text += row("  with findings", surfaces_.with_findings);
  for (const auto& [code, count] : surfaces_by_code_) text += code_row("    ", code, count);
  return text;
}

std::string Summary::table(double seconds) const {
  std::string text;
  if (files_ > 0) text += row("files", files_);
  if (unreadable_files_ > 0) text += row("  that could not be read", unreadable_files_);
  text += empty_rows(empty_files_, surface_files_);
  text += row("features", features_) + row("  invalid", invalid_features_);
  for (const auto& [code, count] : groups_by_code_) {
    text +=
        row("    with " + std::to_string(code) + " " + std::string(validate::finding_name(code)),
            count);
  }
  if (undecided_features_ > 0) text += row("  undecided", undecided_features_);
  text += empty_rows(empty_features_, surface_features_);
  if (unreadable_ > 0) text += row("  that could not be read", unreadable_);
  text += row("solids", solids()) + row("  valid", valid_);
  if (with_warnings_ > 0) text += row("    with warnings", with_warnings_);
  for (const auto& [rung, count] : by_rung_) {
    text += row("    proven by " + std::string(delaunay::to_string(rung)), count);
  }
  if (repaired_ > 0) text += row("    repaired", repaired_);
  text += row("  invalid", invalid_);
  for (const auto& [code, count] : by_code_) {
    text +=
        row("    " + std::to_string(code) + " " + std::string(validate::finding_name(code)), count);
  }
  text += row("  undecided", undecided_);
  if (has_tolerant_) text += row("  valid when snapped (--tolerant)", valid_snapped_);
  text += surface_rows();
  if (baseline_) {
    text += row("new findings", baseline_->fresh) + row("known findings", baseline_->known) +
            row("findings gone", baseline_->gone);
  }
  if (stored_ > 0) text += row("features stored", stored_);
  text += row("bytes of the files", file_bytes_);
  if (blob_bytes_ > 0) {
    text += row("bytes in: solids as plain arrays", plain_bytes_);
    text += row("bytes out: solids as blobs", blob_bytes_);
    text += row("ratio",
                decimals(static_cast<double>(plain_bytes_) / static_cast<double>(blob_bytes_), 2));
  }
  text += row("seconds", decimals(seconds, 2));
  for (const auto& [stage, time] : stages_) {
    std::string name = "  ";
    text += row(name.append(to_string(stage)).append(", all threads"), decimals(time, 2));
  }
  return text;
}

std::string Summary::json(double seconds) const {
  nlohmann::ordered_json json{{"features", features_},     {"solids", solids()},
                              {"valid", valid_},           {"validWithWarnings", with_warnings_},
                              {"invalid", invalid_},       {"undecided", undecided_},
                              {"unreadable", unreadable_}, {"stored", stored_},
                              {"fileBytes", file_bytes_},  {"plainBytes", plain_bytes_},
                              {"blobBytes", blob_bytes_}};
  json["invalidByCode"] = nlohmann::ordered_json::object();
  for (const auto& [code, count] : by_code_) json["invalidByCode"][std::to_string(code)] = count;
  json["featuresByCode"] = nlohmann::ordered_json::object();
  for (const auto& [code, count] : groups_by_code_) {
    json["featuresByCode"][std::to_string(code)] = count;
  }
  json["validByRung"] = nlohmann::ordered_json::object();
  for (const auto& [rung, count] : by_rung_) {
    json["validByRung"][std::string(delaunay::to_string(rung))] = count;
  }
  json["seconds"] = seconds;
  for (const auto& [stage, time] : stages_) {
    json["secondsByStage"][std::string(to_string(stage))] = time;
  }
  return json.dump();
}

}  // namespace watertight::cli
