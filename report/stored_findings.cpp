// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/stored_findings.h"

#include <nlohmann/json.hpp>

namespace watertight::report {
namespace {

using Json = nlohmann::json;

StoredFinding finding_of(const std::string& object, const std::string& lod, const Json& json) {
  StoredFinding finding;
  finding.object = object;
  finding.lod = lod;
  finding.code = json.value("code", 0);
  finding.name = json.value("name", "");
  finding.severity = json.value("severity", "");
  if (const auto witness = json.find("witness");
      witness != json.end() && witness->is_array() && witness->size() == 3) {
    finding.witness = witness->get<std::array<double, 3>>();
  }
  for (const char* name : {"measured", "limit", "unit", "hint"}) {
    finding.members.emplace_back(name, json.value(name, Json()).dump());
  }
  // The reports of solids call the text "info", those of groups "detail".
  const char* detail = json.contains("info") ? "info" : "detail";
  finding.members.emplace_back("detail", json.value(detail, Json()).dump());
  finding.members.emplace_back("pointer", json.value("pointer", Json()).dump());
  return finding;
}

}  // namespace

std::vector<StoredFinding> findings_of(const pipeline::EncodedFeature& feature) {
  std::vector<StoredFinding> findings;
  const auto add = [&](const std::string& object, const std::string& lod, const Json& list) {
    for (const Json& finding : list) findings.push_back(finding_of(object, lod, finding));
  };
  for (const StoredSolid& solid : feature.solids) {
    if (solid.is_proven) continue;
    const Json report = Json::parse(solid.report, nullptr, false);
    if (!report.is_object()) continue;
    for (const char* list : {"errors", "warnings"}) {
      add(solid.object_id, solid.lod, report.value(list, Json::array()));
    }
  }
  const Json groups = Json::parse(feature.findings, nullptr, false);
  if (!groups.is_array()) return findings;
  for (const Json& group : groups) {
    add(group.value("object", ""), group.value("lod", ""), group.value("findings", Json::array()));
  }
  return findings;
}

std::vector<std::pair<std::string, std::string>> properties_of(const StoredFinding& finding) {
  std::vector<std::pair<std::string, std::string>> properties{
      {"object", Json(finding.object).dump()},
      {"lod", Json(finding.lod).dump()},
      {"code", std::to_string(finding.code)},
      {"name", Json(finding.name).dump()},
      {"severity", Json(finding.severity).dump()}};
  properties.insert(properties.end(), finding.members.begin(), finding.members.end());
  return properties;
}

}  // namespace watertight::report
