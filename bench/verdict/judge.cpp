// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/verdict/judge.h"

#include <algorithm>
#include <cstring>

#include "pipeline/validate_stream.h"

namespace watertight::verdict {
namespace {

enum class Rewriting : std::uint8_t { none, mirrored_x, mirrored_y, mirrored_z, renumbered };

struct Variant {
  const char* name;
  Rewriting rewriting = Rewriting::none;
  Proof proof = Proof::tetrahedralization;
  delaunay::Engine engine = delaunay::Engine::automatic;
  bool is_strict = false;
};

constexpr Variant kDefault{"default"};
constexpr std::array kVariants{Variant{"mirrored in x", Rewriting::mirrored_x},
                               Variant{"mirrored in y", Rewriting::mirrored_y},
                               Variant{"mirrored in z", Rewriting::mirrored_z},
                               Variant{"renumbered", Rewriting::renumbered},
                               Variant{"boundary", Rewriting::none, Proof::boundary},
                               Variant{"strict", Rewriting::none, Proof::tetrahedralization,
                                       delaunay::Engine::automatic, true}};
constexpr std::array kEngines{
    Variant{"cgal", Rewriting::none, Proof::tetrahedralization, delaunay::Engine::cgal},
    Variant{"tetgen", Rewriting::none, Proof::tetrahedralization, delaunay::Engine::tetgen}};

Solid mirrored(const Solid& solid, int axis) {
  SolidArrays arrays = solid.arrays();
  for (Point& p : arrays.vertices) p[axis] = p[axis] == 0 ? 0 : -p[axis];
  for (std::size_t ring = 0; ring + 1 < arrays.ring_offsets.size(); ++ring) {
    std::reverse(arrays.ring_vertices.begin() + arrays.ring_offsets[ring],
                 arrays.ring_vertices.begin() + arrays.ring_offsets[ring + 1]);
  }
  return solids::solid_of(std::move(arrays), solid.lattice(), solid.srid());
}

Sample rewritten(const Sample& sample, Rewriting rewriting, std::uint64_t seed) {
  Sample result = sample;
  Random random(seed ^ 0x5eedULL);
  for (Solid& solid : result.members) {
    if (rewriting == Rewriting::renumbered) solid = solids::rewritten(solid, random).solid;
    if (rewriting == Rewriting::mirrored_x) solid = mirrored(solid, 0);
    if (rewriting == Rewriting::mirrored_y) solid = mirrored(solid, 1);
    if (rewriting == Rewriting::mirrored_z) solid = mirrored(solid, 2);
  }
  if (rewriting == Rewriting::renumbered && result.group) {
    std::reverse(result.members.begin(), result.members.end());
  }
  return result;
}

Truth group_truth(const Sample& sample) {
  Truth truth;
  const PairTruth pair = pair_truth_of(sample.members[0], sample.members[1]);
  if (*sample.group == validate::GroupKind::building_parts) {
    if (pair.overlap) truth.codes = {601};
  } else if (pair.are_equal) {
    truth.codes = {502};
  } else if (pair.overlap) {
    truth.codes = {501};
  } else if (!pair.share_area) {
    truth.codes = {503};
  }
  return truth;
}

/// The truth about a sample. A group with an invalid member has that member's truth.
Truth truth_about(const Sample& sample) {
  if (sample.truth) return *sample.truth;
  Truth all;
  for (const Solid& solid : sample.members) {
    const Truth truth = truth_of(solid);
    all.is_known = all.is_known && truth.is_known;
    all.is_planar = all.is_planar && truth.is_planar;
    all.has_crossing_edges = all.has_crossing_edges || truth.has_crossing_edges;
    all.codes.insert(truth.codes.begin(), truth.codes.end());
    if (all.reason.empty()) all.reason = truth.reason;
  }
  if (sample.group && all.is_known && all.codes.empty()) {
    const bool has_crossing_edges = all.has_crossing_edges;
    all = group_truth(sample);
    all.has_crossing_edges = has_crossing_edges;
  }
  return all;
}

CertifyOptions certify_options(const Variant& variant) {
  CertifyOptions options;
  options.proof = variant.proof;
  options.ladder.engine = variant.engine;
  options.ladder.strict = variant.is_strict;
  return options;
}

void add_codes(const std::vector<Finding>& findings, std::set<int>& codes) {
  for (const Finding& finding : findings) {
    if (finding.severity == Severity::error) codes.insert(finding.code);
  }
}

Said ask_document(const Sample& sample, const Variant& variant, delaunay::EngineWorkers* workers) {
  std::size_t used = 0;
  const formats::ByteSource source = [&](std::span<std::uint8_t> bytes) -> Result<std::size_t> {
    const std::size_t count = std::min(bytes.size(), sample.document.size() - used);
    std::memcpy(bytes.data(), sample.document.data() + used, count);
    used += count;
    return count;
  };
  Said said;
  auto reader = formats::FeatureReader::open(source, "sample.city.json");
  if (!reader) {
    said.reason = to_string(reader.error());
    return said;
  }
  pipeline::StreamOptions options;
  options.groups.do_steps_warn = false;  // the truth is exact
  options.certify = certify_options(variant);
  const auto outcome = pipeline::validate_stream(
      *reader, workers, options,
      [&](pipeline::ValidatedFeature&& feature) -> Status {
        for (const pipeline::InspectedSolid& solid : feature.inspected.solids) {
          add_codes(solid.inspection.report.findings, said.codes);
          said.reason += solid.inspection.report.undecided_reason;
        }
        for (const pipeline::InspectedGroup& group : feature.inspected.groups) {
          add_codes(group.report.findings, said.codes);
        }
        return Done{};
      },
      [&](const Error& error) -> Status {
        said.reason = to_string(error);
        return Done{};
      });
  if (outcome) said.verdict = outcome->verdict;
  return said;
}

Said ask(const Sample& sample, const Variant& variant, delaunay::EngineWorkers* workers) {
  if (!sample.document.empty()) return ask_document(sample, variant, workers);
  Said said;
  said.verdict = Verdict::valid;
  std::vector<Inspection> inspections;
  for (const Solid& solid : sample.members) {
    inspections.push_back(certify(solid, workers, certify_options(variant)));
    const Report& report = inspections.back().report;
    add_codes(report.findings, said.codes);
    said.reason += report.undecided_reason;
    said.verdict = pipeline::worse(said.verdict, report.verdict);
  }
  if (!sample.group || said.verdict != Verdict::valid) return said;
  std::vector<validate::GroupMember> members;
  for (const Inspection& inspection : inspections) {
    members.push_back({&inspection.certified->solid});
  }
  validate::GroupOptions options;
  options.do_steps_warn = false;  // the truth is exact
  const validate::GroupReport report = validate::check_group(members, *sample.group, options);
  said.verdict = report.verdict;
  add_codes(report.findings, said.codes);
  return said;
}

Outcome outcome_of(const Truth& truth, const Said& said, bool may_be_undecided) {
  if (said.verdict == Verdict::undecided) {
    return may_be_undecided || truth.has_crossing_edges ? Outcome::allowed : Outcome::undecided;
  }
  if (said.verdict == Verdict::valid) {
    return truth.is_valid() ? Outcome::right : Outcome::false_valid;
  }
  if (truth.is_valid()) return Outcome::false_invalid;
  const bool is_named = truth.codes.count(kAnyCode) != 0 ||
                        std::any_of(said.codes.begin(), said.codes.end(),
                                    [&](int code) { return truth.codes.count(code) != 0; });
  return is_named ? Outcome::right : Outcome::wrong_code;
}

/// Adds the judgement of one variant. `base` is the truth about the sample as it is.
void add_judgement(const Sample& sample, const Truth& base, const Variant& variant,
                   std::uint64_t seed, delaunay::EngineWorkers* workers,
                   std::vector<Judgement>& judgements) {
  Judgement judgement{variant.name, Outcome::right, base, {}, {}};
  Sample asked = rewritten(sample, variant.rewriting, seed);
  if (variant.rewriting != Rewriting::none && !base.is_planar) judgement.truth = truth_about(asked);
  judgement.said = ask(asked, variant, workers);
  judgement.outcome = outcome_of(judgement.truth, judgement.said, sample.may_be_undecided);
  if (judgement.outcome != Outcome::right) judgement.sample = asked;
  const bool varies = judgement.truth.is_valid() != base.is_valid();
  judgements.push_back(judgement);
  if (varies) {
    judgement.outcome = Outcome::varies;
    judgement.sample = std::move(asked);
    judgements.push_back(std::move(judgement));
  }
}

}  // namespace

const char* to_string(Outcome outcome) {
  constexpr std::array<const char*, kOutcomes> kNames{
      "right",      "allowed undecided", "false valid",   "false invalid",
      "wrong code", "undecided",         "surface varies"};
  return kNames[static_cast<std::size_t>(outcome)];
}

std::string to_string(const Said& said) {
  std::string text(watertight::validate::to_string(said.verdict));
  for (const int code : said.codes) text += ' ' + std::to_string(code);
  if (!said.reason.empty()) text += " (" + said.reason.substr(0, 120) + ')';
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

std::vector<Judgement> judge(const Sample& sample, std::uint64_t seed,
                             const JudgeOptions& options) {
  std::vector<Judgement> judgements;
  const Truth base = truth_about(sample);
  if (!base.is_known) return judgements;
  add_judgement(sample, base, kDefault, seed, options.workers, judgements);
  const bool is_document = !sample.document.empty();
  for (const Variant& variant : kVariants) {
    if (!options.with_variants || (is_document && variant.rewriting != Rewriting::none)) continue;
    add_judgement(sample, base, variant, seed, options.workers, judgements);
  }
  for (const Variant& variant : kEngines) {
    if (!options.with_engines) continue;
    add_judgement(sample, base, variant, seed, options.workers, judgements);
  }
  return judgements;
}

}  // namespace watertight::verdict
