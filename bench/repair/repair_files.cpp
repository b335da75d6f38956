// SPDX-License-Identifier: GPL-3.0-or-later
//
// Repairs the invalid solids of documents, and counts what each set of remedies has mended.
//
//   repair_files WELD FILE...        WELD: metres, 0 for none
//   repair_files truth FILE...       takes away each facet of each valid solid, and counts how
//   often
//                                    the repaired solid is the one that it was
//
// Prints for each file the solids, those that are invalid, those that were repaired, and how often
// each set of remedies did it; with WATERTIGHT_SHOW also the codes of those that stay.
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

#include "bench/input.h"
#include "geometry/canonical_form.h"
#include "repair/repair.h"
#include "validate/finding_kinds.h"

using namespace watertight;

namespace {

struct Counts {
  std::size_t solids = 0;
  std::size_t invalid = 0;
  std::size_t repaired = 0;
  std::map<std::string, std::size_t> by_remedies;
  std::map<std::string, std::size_t> left;
};

std::string codes_of(const validate::Report& report) {
  std::string text;
  for (const int code : validate::error_codes(report.findings)) {
    if (!text.empty()) text.append("+");
    text.append(std::to_string(code));
  }
  return text;
}

void print(const std::string& name, const Counts& counts) {
  std::printf("%-36s %6zu solids %5zu invalid %5zu repaired:", name.c_str(), counts.solids,
              counts.invalid, counts.repaired);
  for (const auto& [remedies, count] : counts.by_remedies) {
    std::printf(" %s %zu", remedies.c_str(), count);
  }
  std::printf("\n");
  if (std::getenv("WATERTIGHT_SHOW") == nullptr) return;
  for (const auto& [codes, count] : counts.left)
    std::printf("    left: %s %zu\n", codes.c_str(), count);
}

std::uint64_t hash_of(const Solid& solid) {
  const auto boundary = OrientedBoundary::make(geometry::merge_equal_vertices(solid).solid);
  return boundary ? geometry::solid_hash(*boundary) : 0;
}

/// The solid without a facet; errors: those of Solid::make().
Result<Solid> without(const Solid& solid, Index gone) {
  repair::EditedSolid edited = repair::edited(solid);
  Index number = 0;
  for (auto& facets : edited.shells) {
    std::erase_if(facets, [&](const repair::EditedFacet&) { return number++ == gone; });
  }
  return repair::solid_of(edited);
}

int find_truth(int argc, char** argv, repair::RepairOptions options) {
  std::size_t facets = 0;
  std::map<std::string, std::size_t> outcomes;
  for (int i = 2; i < argc; ++i) {
    const auto document = bench::read_file(argv[i]);
    if (!document) continue;
    for (const auto& feature : document->features) {
      for (const auto& submitted : feature.solids) {
        const Inspection inspection = certify(submitted.solid, nullptr, options.certify);
        if (!inspection.certified) continue;
        const std::uint64_t wanted = hash_of(submitted.solid);
        for (Index facet = 0; facet < submitted.solid.facet_count(); ++facet) {
          const auto open = without(submitted.solid, facet);
          if (!open) continue;
          ++facets;
          const repair::Repaired repaired = repair::repair(*open, nullptr, options);
          std::string outcome = "not repaired";
          if (repaired.outcome == repair::Repaired::Outcome::valid_as_read) outcome = "still valid";
          if (repaired.after) {
            const bool is_same = hash_of(repaired.after->certified->solid.solid()) == wanted;
            outcome = is_same ? "the original" : "another solid";
          }
          ++outcomes[outcome];
          if (outcome != "the original" && std::getenv("WATERTIGHT_SHOW") != nullptr) {
            std::printf("%s %s facet %u: %s\n", argv[i], feature.id.c_str(), facet,
                        outcome.c_str());
          }
        }
      }
    }
  }
  std::printf("%zu facets taken away:", facets);
  for (const auto& [outcome, count] : outcomes) std::printf(" %s %zu", outcome.c_str(), count);
  std::printf("\n");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  repair::RepairOptions options;
  using repair::Remedy;
  options.remedies = {Remedy::rings, Remedy::orientation, Remedy::junctions,
                      Remedy::weld,  Remedy::facets,      Remedy::fill};
  options.weld_metres = std::atof(argv[1]);
  options.certify.proof = Proof::boundary;
  if (std::string(argv[1]) == "truth") return find_truth(argc, argv, options);
  Counts all;
  for (int i = 2; i < argc; ++i) {
    const std::filesystem::path path = argv[i];
    const auto document = bench::read_file(path);
    if (!document) {
      std::fprintf(stderr, "%s: %s\n", argv[i], document.error().message.c_str());
      continue;
    }
    Counts counts;
    for (const auto& feature : document->features) {
      for (const auto& submitted : feature.solids) {
        ++counts.solids;
        const repair::Repaired repaired = repair::repair(submitted.solid, nullptr, options);
        if (repaired.outcome == repair::Repaired::Outcome::valid_as_read) continue;
        ++counts.invalid;
        if (repaired.outcome == repair::Repaired::Outcome::not_repaired) {
          std::string left = codes_of(repaired.before);
          if (std::getenv("WATERTIGHT_SHOW") != nullptr) left.append(" ").append(feature.id);
          ++counts.left[left];
          continue;
        }
        ++counts.repaired;
        std::string set;
        for (const Remedy remedy : repaired.remedies) {
          if (!set.empty()) set.append("+");
          set.append(to_string(remedy));
        }
        ++counts.by_remedies[set];
      }
    }
    print(path.filename().string(), counts);
    all.solids += counts.solids;
    all.invalid += counts.invalid;
    all.repaired += counts.repaired;
    for (const auto& [set, count] : counts.by_remedies) all.by_remedies[set] += count;
  }
  print("all", all);
  return 0;
}
