// SPDX-License-Identifier: GPL-3.0-or-later
//
// check_reference LIST FOLDER [--database CONNECTION]: checks the whole path against the reference
// list. Every solid that the list calls clean must be valid; every feature whose solids are all
// valid goes through document -> certify -> encode -> store -> decode -> document and must come
// back as the same text, in modes raw, bitmap and automatic. Prints each closed solid that is
// rejected (code and place) and the share of each rung. Exit status 1 on any difference.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "bench/input.h"
#include "pipeline/pipeline.h"

using namespace watertight;

namespace {

using SolidKey = std::string;  // "file,object,geometry,ordinal"

struct Reference {
  std::vector<std::string> files;
  std::set<SolidKey> clean;
  std::set<SolidKey> closed;
};

Reference read_reference(const std::string& path) {
  Reference reference;
  std::ifstream stream(path);
  std::string line;
  std::getline(stream, line);  // skips the header
  while (std::getline(stream, line)) {
    std::vector<std::string> fields;
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) fields.push_back(cell);
    if (fields.size() != 9) continue;
    if (reference.files.empty() || reference.files.back() != fields[0])
      reference.files.push_back(fields[0]);
    const SolidKey key = fields[0] + "," + fields[1] + "," + fields[2] + "," + fields[3];
    if (fields[4] == "0") reference.closed.insert(key);
    if (fields[8] == "clean") reference.clean.insert(key);
  }
  return reference;
}

struct Totals {
  std::size_t solids = 0, closed = 0, clean = 0, valid = 0, not_planar = 0, failures = 0;
  std::size_t solid_round_trips = 0, feature_round_trips = 0;
  std::map<std::string, std::size_t> rungs;
  std::uint64_t blob_bytes = 0;
};

constexpr Mode kModes[] = {Mode::automatic, Mode::raw, Mode::bitmap};

/// True if every error is from a metric rule, which the oracle does not have.
bool is_refused_for_planarity_only(const Report& report) {
  return report.verdict == Verdict::invalid &&
         std::all_of(report.findings.begin(), report.findings.end(), [](const Finding& finding) {
           return finding.severity != Severity::error || finding.code == 203 || finding.code == 204;
         });
}

void print_rejection(const SolidKey& key, const Report& report) {
  std::printf("rejected %s:", key.c_str());
  if (report.verdict == Verdict::undecided)
    std::printf(" undecided (%s)", report.undecided_reason.c_str());
  std::size_t shown = 0;
  for (const Finding& finding : report.findings) {
    if (finding.severity != Severity::error || ++shown > 3) continue;
    std::printf(" %d shell %d facet %d", finding.code, static_cast<int>(finding.place.shell),
                static_cast<int>(finding.place.facet));
    if (finding.other) std::printf(" / facet %d", static_cast<int>(finding.other->facet));
    if (finding.witness) {
      std::printf(" at (%.3f %.3f %.3f)", (*finding.witness)[0], (*finding.witness)[1],
                  (*finding.witness)[2]);
    }
    std::printf(";");
  }
  std::printf("\n");
}

/// Encodes and decodes a solid in each mode; counts the differences.
void check_solid(const SolidKey& key, const ValidSolid& solid, Totals& totals) {
  for (const Mode mode : kModes) {
    EncodeOptions options;
    options.mode = mode;
    const auto blob = encode(solid, options);
    const auto decoded = blob ? decode(*blob) : Result<Decoded>(blob.error());
    if (decoded && decoded->solid == solid.solid()) {
      ++totals.solid_round_trips;
      if (mode == Mode::automatic) totals.blob_bytes += blob->size();
      continue;
    }
    ++totals.failures;
    std::printf("FAIL %s mode %s: %s\n", key.c_str(), std::string(codec::to_string(mode)).c_str(),
                decoded ? "another solid came back" : to_string(decoded.error()).c_str());
  }
}

/// Takes a feature from the document to blobs, through the store (a collection for each file) and
/// back to a document. Returns an empty text on success, else the difference.
std::string round_trip(const std::string& file, const pipeline::InspectedFeature& feature,
                       const Document& document, SolidStore* store) {
  pipeline::IngestOptions options;
  options.collection = file;
  auto encoded = pipeline::encode_feature(feature, document, options);
  if (!encoded) return "encode: " + to_string(encoded.error());
  auto stored = pipeline::pack(*std::move(encoded), nullptr);
  if (!stored) return "pack: " + to_string(stored.error());
  StoredFeature returned = *stored;
  if (store != nullptr) {
    if (auto put = store->put({&*stored, 1}); !put) return "put: " + to_string(put.error());
    auto got = store->get(file, stored->id);
    if (!got) return "get: " + to_string(got.error());
    returned = *got;
  }
  const auto decoded = pipeline::from_stored(returned);
  if (!decoded) return "decode: " + to_string(decoded.error());
  if (decoded->features.size() != 1) return "decode returned no feature";
  const auto before = formats::write_feature(document, feature.feature);
  const auto after = formats::write_feature(*decoded, decoded->features[0]);
  if (!before || !after) return "cannot write the feature";
  return *before == *after ? "" : "the document differs";
}

struct Path {
  delaunay::EngineWorkers* workers;
  SolidStore* store;
  CertifyOptions certify;
};

void check_feature(const std::string& file, Feature input, const Document& document,
                   const Reference& reference, const Path& path, Totals& totals) {
  const pipeline::InspectedFeature feature =
      pipeline::inspect(std::move(input), path.workers, path.certify);
  for (const pipeline::InspectedSolid& solid : feature.solids) {
    const SolidKey key = file + "," + solid.source.object_id + "," +
                         std::to_string(solid.source.geometry) + "," +
                         std::to_string(solid.source.ordinal);
    const Report& report = solid.inspection.report;
    const bool is_clean = reference.clean.count(key) != 0;
    ++totals.solids;
    totals.closed += reference.closed.count(key);
    totals.clean += is_clean ? 1U : 0U;
    if (solid.inspection.certified) {
      ++totals.valid;
      ++totals.rungs[std::string(delaunay::to_string(report.rung))];
      check_solid(key, solid.inspection.certified->solid, totals);
      continue;
    }
    if (reference.closed.count(key) != 0) print_rejection(key, report);
    if (is_clean && is_refused_for_planarity_only(report)) {
      ++totals.not_planar;
    } else if (is_clean) {
      ++totals.failures;
      std::printf("FAIL %s is clean by the oracle and %s here\n", key.c_str(),
                  std::string(validate::to_string(report.verdict)).c_str());
    }
  }
  if (feature.verdict() != Verdict::valid || feature.solids.empty()) return;
  const std::string difference = round_trip(file, feature, document, path.store);
  if (difference.empty()) {
    ++totals.feature_round_trips;
  } else {
    ++totals.failures;
    std::printf("FAIL %s %s: %s\n", file.c_str(), feature.feature.id.c_str(), difference.c_str());
  }
}

void print_totals(const std::string& file, const Totals& totals) {
  std::printf(
      "%-32s solids %zu closed %zu clean %zu valid %zu (clean but not planar %zu) round trips: "
      "solids %zu in 3 modes, "
      "features %zu; failures %zu; blob bytes %llu; rungs",
      file.c_str(), totals.solids, totals.closed, totals.clean, totals.valid, totals.not_planar,
      totals.solid_round_trips, totals.feature_round_trips, totals.failures,
      static_cast<unsigned long long>(totals.blob_bytes));
  for (const auto& [rung, count] : totals.rungs) {
    std::printf(" %s %zu (%.1f %%)", rung.c_str(), count,
                100.0 * static_cast<double>(count) / static_cast<double>(totals.valid));
  }
  std::printf("\n");
  std::fflush(stdout);
}

/// The totals of one file, or nothing if the file cannot be read.
std::optional<Totals> check_file(const std::filesystem::path& path_to_file,
                                 const Reference& reference, const Path& path) {
  const std::string file = path_to_file.filename().string();
  auto document = bench::read_file(path_to_file);
  if (!document) {
    std::fprintf(stderr, "%s: %s\n", file.c_str(), to_string(document.error()).c_str());
    return std::nullopt;
  }
  Totals totals;
  std::vector<Feature> features = std::move(document->features);
  document->features.clear();
  for (Feature& feature : features)
    check_feature(file, std::move(feature), *document, reference, path, totals);
  print_totals(file, totals);
  return totals;
}

}  // namespace

int main(int argc, char** argv) {
  std::map<std::string, std::string> options{{"--planarity", "on"}};
  for (int i = 3; i + 1 < argc; i += 2) options[argv[i]] = argv[i + 1];
  if (argc < 3 || argc % 2 == 0) {
    std::fprintf(
        stderr,
        "usage: check_reference LIST FOLDER [--planarity on|off] [--database CONNECTION]\n");
    return 2;
  }
  const Reference reference = read_reference(argv[1]);
  std::unique_ptr<SolidStore> store;
  if (options.count("--database") != 0) {
    auto opened = store::open_postgres_store(options["--database"]);
    if (!opened) {
      std::fprintf(stderr, "%s\n", to_string(opened.error()).c_str());
      return 2;
    }
    store = std::move(*opened);
  }
  delaunay::EngineWorkers workers;
  Path path{&workers, store.get(), {}};
  if (options["--planarity"] == "off") {
    path.certify.tolerances.planarity_metres = 1e9;
    path.certify.tolerances.planarity_degrees = 180;
  }
  std::size_t failures = 0;
  for (const std::string& file : reference.files) {
    const auto totals = check_file(std::filesystem::path(argv[2]) / file, reference, path);
    if (!totals) return 2;
    failures += totals->failures;
  }
  std::printf("%s\n", failures == 0 ? "no difference" : "DIFFERENCES");
  return failures == 0 ? 0 : 1;
}
