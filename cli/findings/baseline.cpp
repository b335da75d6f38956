// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/findings/baseline.h"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/json_text.h"
#include "report/fingerprint.h"
#include "validate/report_json.h"

namespace watertight::cli {
namespace {

using Json = nlohmann::json;

std::string text_at(const Json& json, const char* name) {
  const auto found = json.find(name);
  return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
}

/// An array member, or an empty array.
const Json& list_at(const Json& json, const char* name) {
  static const Json kNothing = Json::array();
  const auto found = json.find(name);
  return found != json.end() && found->is_array() ? *found : kNothing;
}

std::uint64_t number_at(const Json& json, const char* name) {
  const auto found = json.find(name);
  return found != json.end() && found->is_number_unsigned() ? found->get<std::uint64_t>() : 0;
}

Index index_at(const Json& place, const char* name) {
  const auto found = place.find(name);
  if (found == place.end() || !found->is_number_unsigned()) return kNone;
  const auto index = found->get<std::uint64_t>();
  return index < kNone ? static_cast<Index>(index) : kNone;
}

/// The names of a solid, kept while fingerprints are made.
struct Names {
  std::string object;
  std::string lod;
};

/// The side of a finding in the report of a feature; nullopt if `place` is none.
std::optional<report::FindingSide> side_of(const std::vector<Names>& solids, const Json& finding,
                                           const char* member) {
  const auto place = finding.find(member);
  if (place == finding.end() || !place->is_object()) return std::nullopt;
  report::FindingSide side;
  const Index solid = index_at(*place, "solid");
  if (solid < solids.size()) {
    side.object = solids[solid].object;
    side.lod = solids[solid].lod;
  }
  side.place = {index_at(*place, "shell"), index_at(*place, "facet"), index_at(*place, "ring"),
                index_at(*place, "vertex"), kNone};
  return side;
}

std::optional<std::array<double, 3>> witness_of(const Json& finding) {
  const Json& values = list_at(finding, "witness");
  if (values.size() != 3) return std::nullopt;
  std::array<double, 3> witness{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!values[axis].is_number()) return std::nullopt;
    witness[axis] = values[axis].get<double>();
  }
  return witness;
}

std::vector<Names> names_of(const Json& feature) {
  std::vector<Names> names;
  for (const Json& solid : list_at(feature, "primitives")) {
    const bool is_solid = solid.is_object();
    names.push_back(is_solid ? Names{text_at(solid, "object"), text_at(solid, "lod")} : Names{});
  }
  return names;
}

std::optional<std::uint64_t> fingerprint_of(const std::string& file,
                                            const std::vector<Names>& solids, const Json& finding) {
  if (!finding.is_object()) return std::nullopt;
  const std::uint64_t code = number_at(finding, "code");
  const auto side = side_of(solids, finding, "place");
  if (code == 0 || code > 999 || !side) return std::nullopt;
  return report::fingerprint_of({file, static_cast<int>(code), *side,
                                 side_of(solids, finding, "other"), witness_of(finding)});
}

/// The name under which a file's findings are kept: as a report gives it back.
std::string key_of(const std::string& file) { return utf8_text(report::plain_file_name(file)); }

Error malformed(std::size_t line, const std::string& reason) {
  return {ErrorCode::malformed, "line " + std::to_string(line) + ": " + reason};
}

}  // namespace

Result<Baseline> Baseline::read(ByteView text) {
  Baseline baseline;
  std::string_view rest = as_text(text);
  for (std::size_t number = 1; !rest.empty(); ++number) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    if (line.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    const Json json = Json::parse(line.begin(), line.end(), nullptr, false);
    if (!json.is_object() || text_at(json, "type") != "val3dity_report") {
      return malformed(number, "no report of `watertight validate --report`");
    }
    if (number_at(json, "schema") != validate::kReportSchema) {
      return Error{ErrorCode::unsupported,
                   "the report has another layout than this program's; make a new baseline"};
    }
    const std::string name = key_of(text_at(json, "input_file"));
    File& file = baseline.files_[name];
    file.omitted += number_at(json, "findings_omitted");
    for (const Json& feature : list_at(json, "features")) {
      if (!feature.is_object()) return malformed(number, "a feature is no object");
      const std::vector<Names> solids = names_of(feature);
      for (const char* list : {"errors", "warnings"}) {
        for (const Json& finding : list_at(feature, list)) {
          const auto fingerprint = fingerprint_of(name, solids, finding);
          if (!fingerprint) return malformed(number, "a finding lacks its code or place");
          ++file.counts[*fingerprint];
        }
      }
    }
  }
  if (baseline.files_.empty()) return malformed(1, "the baseline is empty");
  return baseline;
}

std::vector<bool> Baseline::take(const std::string& file,
                                 const pipeline::InspectedFeature& feature) {
  const auto entry = files_.find(key_of(file));
  std::vector<bool> is_known;
  for (const report::IdentifiedFinding& found : report::identified_findings(file, feature)) {
    bool known = false;
    if (entry != files_.end()) {
      const auto count = entry->second.counts.find(found.fingerprint);
      known = count != entry->second.counts.end() && count->second > 0;
      if (known) --count->second;
    }
    is_known.push_back(known);
  }
  return is_known;
}

std::uint64_t Baseline::newly_omitted(const std::string& file, std::uint64_t omitted) const {
  const auto entry = files_.find(key_of(file));
  const std::uint64_t before = entry == files_.end() ? 0 : entry->second.omitted;
  return omitted > before ? omitted - before : 0;
}

std::uint64_t Baseline::gone(const std::string& file) const {
  const auto entry = files_.find(key_of(file));
  if (entry == files_.end()) return 0;
  std::uint64_t count = 0;
  for (const auto& [fingerprint, left] : entry->second.counts) count += left;
  return count;
}

}  // namespace watertight::cli
