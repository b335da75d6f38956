// SPDX-License-Identifier: GPL-3.0-or-later
//
// dense [--grid 11|14|16|source]... [--listed FACETS] [--mode MODE] FILE...: encodes the closed
// meshes of the files as triangles on each grid, in automatic mode or in mode walk or
// parallelogram. Counted are whole blobs with the shipped priors that decode to the same canonical
// solid, beside Draco and meshoptimizer; the peers get the bytes added that a blob takes for origin
// and grid (as in bench/ratio/compare.cpp). Meshes below --listed facets (1,000) are only summed
// up. If the files are all those of the training data in the order of their paths, the meshes on
// which the priors were trained are listed apart (bench/corpus/training_meshes.h).
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/dense/mesh_peers.h"
#include "bench/dense/quantized_mesh.h"
#include "bench/dense/summary.h"
#include "bench/dense/whole_blob.h"
#include "bench/input.h"
#include "codec/page/container.h"
#include "validate/certify.h"

namespace {

using namespace watertight;

/// The bytes of a blob that a peer does not store: three varints of the origin and two bytes of the
/// grid.
std::size_t placement_bytes(const OrientedBoundary& boundary) {
  ByteWriter writer;
  for (const std::int64_t number : codec::page_solid(boundary, false).origin) writer.zigzag(number);
  return writer.size() + 2;
}

std::string_view validity(const OrientedBoundary& boundary) {
  CertifyOptions options;
  options.proof = Proof::boundary;
  return validate::to_string(certify(boundary.solid(), nullptr, options).report.verdict);
}

std::optional<MeshRow> measure(const std::string& name, const Solid& source,
                               std::optional<int> bits, Mode mode) {
  const auto mesh = quantize(source, bits);
  if (!mesh) return std::nullopt;
  const auto boundary = boundary_of(*mesh, bits ? nullptr : &source.lattice());
  if (!boundary) {
    std::fprintf(stderr, "%s: %s\n", name.c_str(), to_string(boundary.error()).c_str());
    return std::nullopt;
  }
  MeshRow row;
  row.name = name;
  row.vertices = mesh->vertices.size();
  row.facets = mesh->facet_count();
  row.blob = whole_blob(*boundary, mode);
  row.validity = validity(*boundary);
  const std::size_t placement = placement_bytes(*boundary);
  if (const std::size_t bytes = draco_bytes(*mesh); bytes > 0) row.draco = bytes + placement;
  if (const std::size_t bytes = meshopt_bytes(*mesh); bytes > 0) row.meshopt = bytes + placement;
  row.draco_connectivity = draco_connectivity_bytes(*mesh);
  return row;
}

void report(const std::string& grid, const std::vector<std::filesystem::path>& files,
            std::size_t listed, Mode mode) {
  const std::optional<int> bits =
      grid == "source" ? std::nullopt : std::optional<int>(std::atoi(grid.c_str()));
  Summary summary(listed);
  print_heading(grid);
  for (std::size_t number = 0; number < files.size(); ++number) {
    const auto& path = files[number];
    const auto document = bench::read_file(path);
    if (!document) continue;
    for (const Feature& feature : document->features) {
      for (const SubmittedSolid& submitted : feature.solids) {
        auto row = measure(path.filename().string(), submitted.solid, bits, mode);
        if (!row) continue;
        row->is_seen = number % 2 == 0 && row->facets <= 60000;
        if (row->facets >= listed) print_row(*row);
        summary.add(*row);
      }
    }
  }
  summary.print();
}

Mode mode_named(std::string_view name) {
  for (const Mode mode : {Mode::walk, Mode::parallelogram}) {
    if (codec::to_string(mode) == name) return mode;
  }
  std::fprintf(stderr, "--mode is walk or parallelogram\n");
  std::exit(2);
}

}  // namespace

int main(int count, char** arguments) {
  std::vector<std::string> grids;
  std::vector<std::filesystem::path> files;
  std::size_t listed = 1000;
  Mode mode = Mode::automatic;
  for (int i = 1; i < count; ++i) {
    const std::string word = arguments[i];
    if (word == "--grid" && i + 1 < count) {
      grids.emplace_back(arguments[++i]);
    } else if (word == "--listed" && i + 1 < count) {
      listed = static_cast<std::size_t>(std::atoi(arguments[++i]));
    } else if (word == "--mode" && i + 1 < count) {
      mode = mode_named(arguments[++i]);
    } else {
      files.emplace_back(word);
    }
  }
  if (grids.empty()) grids = {"11", "14", "16", "source"};
  for (const std::string& grid : grids) report(grid, files, listed, mode);
  return 0;
}
