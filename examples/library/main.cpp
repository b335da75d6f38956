// SPDX-License-Identifier: GPL-3.0-or-later
//
// Judges the solids of a CityJSONSeq, and packs those that are valid: solids_of_a_city FILE
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

#include "codec/blob.h"
#include "delaunay/ladder.h"
#include "formats/document.h"
#include "validate/certify.h"
#include "validate/report_json.h"

namespace wt = watertight;

int main(int argc, char** argv) {
  std::ifstream file(argc == 2 ? argv[1] : "", std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const auto document = wt::formats::read_document(wt::as_bytes(text), wt::Format::city_json_seq);
  if (!document) {
    std::fprintf(stderr, "%s\n", to_string(document.error()).c_str());
    return 2;
  }
  wt::delaunay::EngineWorkers workers;  // processes for the few solids that need one
  std::size_t solids = 0, valid = 0, bytes = 0;
  double volume = 0;
  for (const wt::Feature& feature : document->features) {
    for (const wt::SubmittedSolid& submitted : feature.solids) {
      ++solids;
      const wt::Inspection inspection = wt::certify(submitted.solid, &workers);
      for (const wt::Finding& finding : inspection.report.findings) {
        std::printf("%s: %s\n", feature.id.c_str(), wt::validate::finding_text(finding).c_str());
      }
      if (!inspection.certified) continue;
      const auto blob = wt::encode(inspection.certified->solid);
      if (!blob || !wt::decode(*blob)) return 2;
      ++valid;
      bytes += blob->size();
      volume += inspection.report.measures->volume;
    }
  }
  std::printf("%zu of %zu solids are valid: %.0f cubic metres in %zu bytes\n", valid, solids,
              volume, bytes);
  return valid == solids ? 0 : 1;
}
