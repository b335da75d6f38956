// SPDX-License-Identifier: GPL-3.0-or-later
//
// The command advise: the fewest decimals at which every valid solid stays valid.
#include <algorithm>
#include <cstdio>
#include <vector>

#include "base/quantity.h"
#include "cli/commands.h"
#include "cli/sources/input_list.h"
#include "cli/terminal/printable.h"
#include "files/inputs.h"
#include "pipeline/advise.h"
#include "validate/finding_kinds.h"

namespace watertight::cli {
namespace {

std::string first_broken(const pipeline::RoundedSolids& level) {
  if (!level.first_broken) return "-";
  const auto& [source, code] = *level.first_broken;
  std::string text = source.object_id.empty() ? "solid " + std::to_string(source.ordinal)
                                              : printable(source.object_id);
  if (code == 0) return text + " (undecided)";
  return text + " (" + std::to_string(code) + ' ' + std::string(validate::finding_name(code)) + ')';
}

/// The last of the levels at which every solid stays valid.
const pipeline::RoundedSolids& fewest(const std::vector<pipeline::RoundedSolids>& levels) {
  const auto breaks = std::find_if(levels.begin(), levels.end(),
                                   [](const auto& level) { return level.broken > 0; });
  return *(breaks - 1);  // nothing breaks at the first level
}

void print(const pipeline::Advice& advice) {
  std::printf("%s, %llu valid\n", quantity(advice.solids, "solid").c_str(),
              static_cast<unsigned long long>(advice.valid));
  if (advice.off_grid > 0) {
    std::printf("%s on no decimal grid of at most 12 decimals: not rounded\n",
                quantity(advice.off_grid, "valid solid is", "valid solids are").c_str());
  }
  if (advice.levels.empty()) return;
  const int enough = fewest(advice.levels).decimals;
  std::printf("%s: every valid solid stays valid\n",
              enough == 1 ? "1 decimal is enough"
                          : (std::to_string(enough) + " decimals are enough").c_str());
  std::printf("%-9s %9s %9s %12s  %s\n", "decimals", "valid", "broken", "blob bytes",
              "first to break");
  for (const pipeline::RoundedSolids& level : advice.levels) {
    std::printf("%-9d %9llu %9llu %12llu  %s\n", level.decimals,
                static_cast<unsigned long long>(level.valid),
                static_cast<unsigned long long>(level.broken),
                static_cast<unsigned long long>(level.blob_bytes), first_broken(level).c_str());
  }
}

}  // namespace

Exit run(const AdviseCommand& command) {
  const auto input = single_input(command.input);
  auto opened = input ? files::open_input(*input, {}) : Result<files::OpenedInput>(input.error());
  if (!opened) {
    complain(command.input, opened.error());
    return Exit::error;
  }
  std::vector<SubmittedSolid> solids;
  for (;;) {
    auto text = opened->reader.next();
    if (text && !*text) break;
    auto feature = text ? opened->reader.read(**std::move(text)) : Result<Feature>(text.error());
    if (!feature) {
      complain(command.input, feature.error());
      return Exit::error;
    }
    for (SubmittedSolid& solid : feature->solids) solids.push_back(std::move(solid));
  }
  delaunay::EngineWorkers workers(delaunay::EngineWorkers::Options{{}, {}, command.jobs});
  pipeline::AdviceOptions options;
  options.threads = command.jobs;
  validate::GroupOptions groups;  // solids are judged one by one
  apply(command.rules, options.certify, groups);
  const auto advice = pipeline::advise(solids, &workers, options);
  if (!advice) {
    complain(command.input, advice.error());
    return Exit::error;
  }
  print(*advice);
  return advice->valid == advice->solids ? Exit::valid : Exit::invalid;
}

}  // namespace watertight::cli
