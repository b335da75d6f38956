// SPDX-License-Identifier: GPL-3.0-or-later
//
// ratio FILE...: prints two tables in Markdown for each file, over its valid solids. The first
// table is the paper's own accounting (bench/ratio/accounting.h), from no Steiner points to all of
// them; the second has the bytes of real, decodable files beside those of other coders
// (bench/ratio/peers.h), on the same grid.
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <string>
#include <vector>

#include "bench/input.h"
#include "bench/ratio/accounting.h"
#include "bench/ratio/peers.h"
#include "codec/blob.h"
#include "tessellate/facets.h"
#include "validate/certify.h"

using namespace watertight;

namespace {

struct Setting {
  const char* name;
  Accounting sum;
};

struct FileSums {
  std::vector<Setting> settings{
      {"no Steiner points, facets follow the DT", {}},
      {"polygon facets, 25 % of the Steiner points", {}},
      {"polygon facets, 50 %", {}},
      {"polygon facets, 75 %", {}},
      {"polygon facets, 100 % on edges", {}},
      {"polygon facets, the CDT as it is", {}},
      {"the CDT of this process (encode --steiner)", {}},
      {"triangulated facets (the paper's setting)", {}},
  };
  std::uint64_t solids = 0, skipped = 0, vertices = 0, raw_triangles = 0;
  std::uint64_t raw = 0, bitmap = 0, automatic = 0, with_order = 0;
  std::uint64_t wkb = 0, wkb_zstd = 0, city_json_zstd = 0, draco = 0, without_draco = 0;
};

std::optional<delaunay::Certificate> certificate_of(const Solid& solid,
                                                    const tessellate::FacetTriangles& facets,
                                                    delaunay::EngineWorkers& workers,
                                                    delaunay::Rung first, delaunay::Rung last) {
  delaunay::LadderOptions options;
  options.first_rung = first;
  options.last_rung = last;
  options.keeps_facets = true;
  return delaunay::climb_ladder(solid, facets, &workers, options).certificate;
}

/// Adds all settings of a solid or none, so that every row counts the same solids.
bool add_accounting(const Solid& solid, delaunay::EngineWorkers& workers, FileSums& sums) {
  const tessellate::FacetTriangles facets = tessellate::triangulate_facets(solid);
  using enum delaunay::Rung;
  const auto polygon = certificate_of(solid, facets, workers, patch, patch_scaled);
  const auto own = certificate_of(solid, facets, workers, delaunay::Rung::delaunay, recovered);
  // The paper's numbers come from TetGen.
  const auto triangulated = certificate_of(solid, facets, workers, tetgen, tetgen);
  if (!polygon || !own || !triangulated) return false;
  std::vector<std::optional<Accounting>> rows{account_following(solid)};
  for (const double density : {0.25, 0.5, 0.75, 1.0})
    rows.push_back(account_refined(solid, *polygon, density));
  rows.push_back(account_certificate(*polygon));
  rows.push_back(account_certificate(*own));
  rows.push_back(account_certificate(*triangulated));
  for (const auto& row : rows) {
    if (!row) return false;
  }
  for (std::size_t i = 0; i < rows.size(); ++i) sums.settings[i].sum += *rows[i];
  sums.raw_triangles += facets.triangles.size();
  return true;
}

std::size_t blob_size(const ValidSolid& solid, Mode mode, bool keep_order) {
  EncodeOptions options;
  options.mode = mode;
  options.keep_order = keep_order;
  const auto blob = encode(solid, options);
  return blob ? blob->size() : 0;
}

void add_solid(const SubmittedSolid& submitted, delaunay::EngineWorkers& workers, FileSums& sums) {
  const Inspection inspection = certify(submitted.solid, &workers);
  if (!inspection.certified || submitted.solid.lattice().kind == LatticeKind::float64) return;
  const ValidSolid& valid = inspection.certified->solid;
  if (!add_accounting(valid.solid(), workers, sums)) {
    ++sums.skipped;
    return;
  }
  ++sums.solids;
  sums.vertices += valid.solid().vertex_count();
  sums.raw += blob_size(valid, Mode::raw, false);
  sums.bitmap += blob_size(valid, Mode::bitmap, false);
  sums.automatic += blob_size(valid, Mode::automatic, false);
  sums.with_order += blob_size(valid, Mode::automatic, true);
  const PeerBytes peers =
      measure_peers(valid.solid(), tessellate::triangulate_facets(valid.solid()).triangles);
  sums.wkb += peers.wkb;
  sums.wkb_zstd += peers.wkb_zstd;
  sums.city_json_zstd += peers.city_json_zstd;
  sums.draco += peers.draco;
  sums.without_draco += peers.draco == 0 ? 1U : 0U;
}

void print_tables(const std::string& name, const FileSums& sums) {
  const auto solids = static_cast<double>(sums.solids);
  std::printf(
      "\n### %s\n\n%llu solids, %.1f vertices each (%llu more had no CDT in every setting)\n\n",
      name.c_str(), static_cast<unsigned long long>(sums.solids),
      static_cast<double>(sums.vertices) / solids, static_cast<unsigned long long>(sums.skipped));
  std::printf(
      "| setting | Steiner points | boundary triangles | DT faces | unrecovered | bits per raw "
      "triangle | of raw |\n");
  std::printf("|---|---|---|---|---|---|---|\n");
  std::printf("| raw indices | 0 | %llu | - | - | %llu.0 | 100 %% |\n",
              static_cast<unsigned long long>(sums.raw_triangles),
              static_cast<unsigned long long>(kIndexTripleBits));
  for (const Setting& setting : sums.settings) {
    const double bits =
        static_cast<double>(setting.sum.bits()) / static_cast<double>(sums.raw_triangles);
    std::printf("| %s | %llu | %llu | %llu | %llu | %.1f | %.1f %% |\n", setting.name,
                static_cast<unsigned long long>(setting.sum.steiner),
                static_cast<unsigned long long>(setting.sum.triangles),
                static_cast<unsigned long long>(setting.sum.delaunay_faces),
                static_cast<unsigned long long>(setting.sum.unrecovered), bits,
                100 * bits / static_cast<double>(kIndexTripleBits));
  }
  std::printf("\n| bytes per solid | mean |\n|---|---|\n");
  const auto row = [&](const char* what, std::uint64_t bytes) {
    std::printf("| %s | %.1f |\n", what, static_cast<double>(bytes) / solids);
  };
  row("EWKB", sums.wkb);
  row("EWKB + zstd -19", sums.wkb_zstd);
  row("CityJSON integers + zstd -19", sums.city_json_zstd);
  if (sums.without_draco == 0) {
    row("Draco cl 10 (triangles only)", sums.draco);
  } else {
    std::printf("| Draco cl 10 | none: %llu solids are wider than 31 bits |\n",
                static_cast<unsigned long long>(sums.without_draco));
  }
  row("Watertight raw", sums.raw);
  row("Watertight bitmap", sums.bitmap);
  row("Watertight auto", sums.automatic);
  row("Watertight auto + source order", sums.with_order);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  delaunay::EngineWorkers workers;
  for (int i = 1; i < argc; ++i) {
    const std::string name = std::filesystem::path(argv[i]).filename().string();
    const auto document = bench::read_file(argv[i]);
    if (!document) {
      std::fprintf(stderr, "%s: %s\n", argv[i], to_string(document.error()).c_str());
      return 2;
    }
    FileSums sums;
    for (const Feature& feature : document->features) {
      for (const SubmittedSolid& solid : feature.solids) add_solid(solid, workers, sums);
    }
    if (sums.solids == 0) {
      std::printf("\n### %s\n\nno valid solid on an integer grid\n", name.c_str());
      continue;
    }
    print_tables(name, sums);
  }
}
