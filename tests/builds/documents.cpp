// SPDX-License-Identifier: GPL-3.0-or-later
//
// The part of the fingerprint that covers the whole path: documents read, validated and encoded.
#include <cinttypes>
#include <cstdio>
#include <filesystem>

#include "base/checksum.h"
#include "delaunay/ladder.h"
#include "formats/document.h"
#include "pipeline/pipeline.h"
#include "tests/builds/fingerprint.h"
#include "tests/files.h"
#include "validate/report_json.h"

namespace watertight::builds {
namespace {

std::uint64_t hash_of(const std::string& text) {
  return content_hash({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

void print_solid(const std::string& name, const Inspection& inspection, const Solid& solid) {
  validate::ReportJsonOptions without_times;
  without_times.include_times = false;
  const std::string report = validate::report_json(inspection.report, solid, without_times);
  std::printf("%s %s %016" PRIx64, name.c_str(),
              std::string(validate::to_string(inspection.report.verdict)).c_str(), hash_of(report));
  if (inspection.certified) {
    const auto blob = encode(inspection.certified->solid);
    std::printf(" %zu %016" PRIx64, blob ? blob->size() : 0, blob ? content_hash(*blob) : 0);
  }
  std::printf("\n");
}

Result<Document> read(const char* file) {
  const Bytes bytes = test::read_bytes(file);
  const auto format = formats::detect_format(file, bytes);
  return format ? read_document(bytes, *format) : format.error();
}

/// Prints one line for each solid of the document, or the reason why the document cannot be read.
void print_document(const char* file, delaunay::EngineWorkers& workers) {
  const std::string name = std::filesystem::path(file).filename().string();
  auto document = read(file);
  if (!document) {
    std::printf("%s %s\n", name.c_str(), to_string(document.error()).c_str());
    return;
  }
  CertifyOptions options;
  // The limits of time are so long that slow builds do not run into them either.
  options.ladder.seconds_per_rung = 600;
  options.ladder.seconds_in_all = 6000;
  for (Feature& feature : document->features) {
    const auto inspected = pipeline::inspect(std::move(feature), &workers, options);
    for (std::size_t i = 0; i < inspected.solids.size(); ++i) {
      print_solid(name + " " + inspected.feature.id, inspected.solids[i].inspection,
                  inspected.feature.solids[i].solid);
    }
  }
}

}  // namespace

bool print_documents(std::span<char* const> files) {
  delaunay::EngineWorkers workers(delaunay::EngineWorkers::Options{});
  for (const char* file : files) print_document(file, workers);
  return true;
}

}  // namespace watertight::builds
