// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tessellates the curved solids of files, and validates the polyhedra.
//
//   curved_files FILE...
//
// Each file is read with a chord of 1, 0.1 and 0.01 % of the diagonal of its box. Prints for each
// of them: solids, those that are certified, faces and those left out with their reasons, open
// edges, triangles, measured chord error and gap in metres, volume and area of all solids, seconds
// for reading (with tessellation) and for validating.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "bench/input.h"
#include "formats/document.h"
#include "validate/certify.h"

using namespace watertight;

namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double diagonal_of(const formats::Document& document) {
  std::array<double, 3> low{1e300, 1e300, 1e300};
  std::array<double, 3> high{-1e300, -1e300, -1e300};
  for (const auto& feature : document.features) {
    for (const auto& submitted : feature.solids) {
      for (Index v = 0; v < submitted.solid.vertex_count(); ++v) {
        const auto place = submitted.solid.world(v);
        for (std::size_t axis = 0; axis < 3; ++axis) {
          low[axis] = std::min(low[axis], place[axis]);
          high[axis] = std::max(high[axis], place[axis]);
        }
      }
    }
  }
  double squared = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    squared += (high[axis] - low[axis]) * (high[axis] - low[axis]);
  }
  return std::sqrt(squared);
}

void run(const char* path, double chord) {
  formats::ReadOptions options;
  options.curved.chord = chord;
  options.curved.has_crossing = validate::has_crossing_facets;
  const auto start = std::chrono::steady_clock::now();
  const auto document = bench::read_file(path, options);
  const double reading = seconds_since(start);
  if (!document) {
    std::printf("%s: %s\n", path, to_string(document.error()).c_str());
    return;
  }
  std::size_t solids = 0;
  std::size_t valid = 0;
  double volume = 0;
  double area = 0;
  std::uint64_t facets = 0;
  const auto middle = std::chrono::steady_clock::now();
  std::string rest;
  for (const auto& feature : document->features) {
    solids += formats::solid_count(feature);
    for (const auto& part : feature.unreadable) {
      rest.append("    ").append(part.source.object_id).append(": ");
      rest.append(to_string(part.error)).append("\n");
    }
    for (const auto& submitted : feature.solids) {
      facets += submitted.solid.facet_count();
      const Inspection inspection = certify(submitted.solid, nullptr, {});
      const auto& measures = inspection.report.measures;
      if (inspection.certified) ++valid;
      if (measures) {
        volume += measures->volume;
        area += measures->area;
      }
      const auto& made = submitted.tessellation;
      const bool is_whole = !made || made->left_out.empty();
      if (inspection.certified && is_whole) continue;
      rest.append("    ").append(submitted.source.object_id).append(":");
      std::size_t shown = 0;
      for (const auto& finding : inspection.report.findings) {
        if (finding.severity != Severity::error) continue;
        if (std::getenv("WATERTIGHT_SHOW") != nullptr && shown < 12) {
          const auto at = finding.witness.value_or(std::array<double, 3>{});
          std::printf("  %s %d %s at %.8f %.8f %.8f\n", submitted.source.object_id.c_str(),
                      finding.code, finding.detail.c_str(), at[0], at[1], at[2]);
        }
        if (++shown <= 6) rest.append(" ").append(std::to_string(finding.code));
      }
      rest.append(" (").append(std::to_string(shown)).append(" errors)");
      if (!is_whole) {
        for (const auto& face : made->left_out) {
          rest.append(" ").append(face.face).append(" ").append(face.reason).append(";");
        }
      }
      rest.append("\n");
    }
  }
  std::printf(
      "%-24s chord %.6f: %zu of %zu certified, %llu facets, volume %.8g, area %.8g, "
      "read %.3f s, validated %.3f s\n%s",
      std::string(path).substr(std::string(path).rfind('/') + 1).c_str(), chord, valid, solids,
      static_cast<unsigned long long>(facets), volume, area, reading, seconds_since(middle),
      rest.c_str());
}

}  // namespace

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const auto coarse = bench::read_file(argv[i]);
    if (!coarse) {
      std::printf("%s: %s\n", argv[i], to_string(coarse.error()).c_str());
      continue;
    }
    const double diagonal = diagonal_of(*coarse);
    for (const double share : {0.01, 0.001, 0.0001}) run(argv[i], share * diagonal);
  }
  return 0;
}
