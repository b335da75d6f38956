// SPDX-License-Identifier: GPL-3.0-or-later
//
// For each document, prints the numbers of features, solids, valid solids, groups and findings 501
// to 601, the seconds of reading and validating without groups, and those of the groups. Uses one
// thread and no worker processes. With --list prints each finding.
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <string>

#include "formats/document.h"
#include "pipeline/groups.h"

namespace {

using namespace watertight;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void list_findings(const pipeline::InspectedFeature& feature,
                   const pipeline::InspectedGroup& group) {
  for (const Finding& finding : group.report.findings) {
    const auto object = [&](const Place& place) {
      return feature.solids[group.members[place.solid]].source.object_id;
    };
    std::cout << "  " << finding.code << ' ' << object(finding.place) << ' '
              << (finding.other ? object(*finding.other) : "") << ' '
              << finding.measured.value_or(0) << ' ' << finding.unit << ": " << finding.detail;
    if (finding.witness) {
      std::cout << " at";
      for (const double coordinate : *finding.witness) std::cout << ' ' << coordinate;
    }
    std::cout << '\n';
  }
}

void count(const std::filesystem::path& path, bool has_list) {
  std::ifstream stream(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const auto format = formats::detect_format(path.filename().string(), as_bytes(text));
  if (!format) return;
  const Clock::time_point start = Clock::now();
  auto document = formats::read_document(as_bytes(text), *format);
  if (!document) {
    std::cout << path.string() << ": " << to_string(document.error()) << '\n';
    return;
  }
  std::size_t solids = 0;
  std::size_t valid = 0;
  std::size_t groups = 0;
  std::map<int, std::size_t> findings;
  std::size_t features_found = 0;
  double seconds_of_groups = 0;
  const std::size_t features = document->features.size();
  CertifyOptions options;
  for (Feature& feature : document->features) {
    pipeline::InspectedFeature inspected;
    for (const SubmittedSolid& submitted : feature.solids) {
      // Groups compare solids that the exact tests accept; no CDT is made where these tests
      // suffice.
      options.proof =
          submitted.solid.shell_count() == 1 ? Proof::boundary : Proof::tetrahedralization;
      inspected.solids.push_back({submitted.source, certify(submitted.solid, nullptr, options)});
      valid += inspected.solids.back().inspection.certified ? 1 : 0;
    }
    solids += inspected.solids.size();
    const Clock::time_point begin = Clock::now();
    inspected.groups = pipeline::inspect_groups(pipeline::group_candidates(inspected), {});
    seconds_of_groups += seconds_since(begin);
    groups += inspected.groups.size();
    std::size_t here = 0;
    for (const pipeline::InspectedGroup& group : inspected.groups) {
      for (const Finding& finding : group.report.findings) ++findings[finding.code];
      here += group.report.findings.size();
      if (has_list) list_findings(inspected, group);
    }
    features_found += here > 0 ? 1 : 0;
  }
  std::cout << path.filename().string() << ": " << features << " features, " << solids
            << " solids, " << valid << " valid, " << groups << " groups, " << features_found
            << " features with findings";
  for (const auto& [code, number] : findings) std::cout << ", " << code << ": " << number;
  const double all = seconds_since(start);
  std::cout << "; " << all - seconds_of_groups << " s + " << seconds_of_groups << " s\n";
}

}  // namespace

int main(int argc, char** argv) {
  bool has_list = false;
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "--list") {
      has_list = true;
    } else {
      count(argv[i], has_list);
    }
  }
  return 0;
}
