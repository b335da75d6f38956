// SPDX-License-Identifier: GPL-3.0-or-later
//
// The closed meshes of the files given, on grids of 11, 14 and 16 bits and on their own: bytes of
// each mesh mode (of a stream that was read back to the same mesh) beside Draco and meshoptimizer.
// dense [--grid 11|14|16|source]... [--least FACETS] FILE...
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "bench/dense/mesh_peers.h"
#include "bench/dense/quantized_mesh.h"
#include "codec/modes.h"
#include "formats/document.h"

namespace {

using namespace watertight;
using Clock = std::chrono::steady_clock;

struct Measured {
  std::size_t bytes = 0;  // 0: the mode cannot hold it
  double write_seconds = 0;
  double read_seconds = 0;
};

/// Positions of the corners of each triangle, the smallest first, sorted: equal for equal meshes.
std::vector<std::array<GridPoint, 3>> corners_of(const IntegerSolid& mesh) {
  std::vector<std::array<GridPoint, 3>> corners;
  for (std::size_t i = 0; i + 2 < mesh.ring_vertices.size(); i += 3) {
    std::array<GridPoint, 3> c{mesh.vertices[mesh.ring_vertices[i]],
                               mesh.vertices[mesh.ring_vertices[i + 1]],
                               mesh.vertices[mesh.ring_vertices[i + 2]]};
    std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
    corners.push_back(c);
  }
  std::sort(corners.begin(), corners.end());
  return corners;
}

Measured measure(const IntegerSolid& mesh, CodeSolid* code, const ModelLayout& layout) {
  Measured result;
  ModelBank bank(layout);
  EntropyStream writer = EntropyStream::writer();
  IntegerSolid source = mesh;
  const auto start = Clock::now();
  if (const Status status = code(writer, bank, {}, source, {}); !status) {
    std::cerr << to_string(status.error()) << '\n';
    return result;
  }
  const Bytes bytes = std::move(writer).finish();
  const auto written = Clock::now();
  ModelBank same(layout);
  EntropyStream reader = EntropyStream::reader(bytes);
  IntegerSolid back;
  const Status read = code(reader, same, {}, back, {});
  const auto end = Clock::now();
  if (!read || !reader.is_finished() || corners_of(back) != corners_of(mesh) ||
      back.vertices.size() != mesh.vertices.size()) {
    std::cerr << "another mesh came back" << (read ? "" : ": " + to_string(read.error())) << '\n';
    return result;
  }
  result.bytes = bytes.size();
  result.write_seconds = std::chrono::duration<double>(written - start).count();
  result.read_seconds = std::chrono::duration<double>(end - written).count();
  return result;
}

struct Totals {
  double log_ratio = 0;
  double worst = 0;
  int count = 0;
};

void report(const std::string& name, const Solid& solid, const std::string& grid, std::size_t least,
            Totals& totals) {
  const auto mesh = quantize(
      solid, grid == "source" ? std::nullopt : std::optional<int>(std::atoi(grid.c_str())));
  if (!mesh || mesh->facet_count() < least) return;
  const std::size_t draco = draco_bytes(*mesh);
  const Measured parallelogram = measure(*mesh, code_parallelogram, parallelogram_layout());
  const std::size_t best = parallelogram.bytes;
  const double n = static_cast<double>(mesh->vertices.size());
  const double ratio = static_cast<double>(best) / static_cast<double>(draco);
  std::cout << std::left << std::setw(26) << name << std::right << std::setw(7) << grid
            << std::setw(8) << mesh->vertices.size() << std::setw(8) << mesh->facet_count()
            << std::fixed << std::setprecision(2) << std::setw(9) << draco << std::setw(7)
            << 8 * static_cast<double>(draco) / n << std::setw(7)
            << 8 * static_cast<double>(draco_connectivity_bytes(*mesh)) / n << std::setw(9)
            << meshopt_bytes(*mesh) << std::setw(9) << parallelogram.bytes << std::setw(7)
            << 8 * static_cast<double>(parallelogram.bytes) / n << std::setw(7)
            << std::setprecision(3) << ratio << std::setw(7) << std::setprecision(1)
            << 1e6 * parallelogram.write_seconds / mesh->facet_count() << std::setw(6)
            << 1e6 * parallelogram.read_seconds / mesh->facet_count() << '\n';
  std::cout.flush();
  if (draco == 0 || best == 0) return;
  totals.log_ratio += std::log(ratio);
  totals.worst = std::max(totals.worst, ratio);
  ++totals.count;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> grids;
  std::vector<std::filesystem::path> files;
  std::size_t least = 4;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--grid" && i + 1 < argc) {
      grids.emplace_back(argv[++i]);
    } else if (word == "--least" && i + 1 < argc) {
      least = static_cast<std::size_t>(std::atoi(argv[++i]));
    } else {
      files.emplace_back(word);
    }
  }
  if (grids.empty()) grids = {"11", "14", "16", "source"};
  std::cout << "mesh                         grid       V       F    Draco  bits/v  conn  meshopt"
               "+z      par bits/v  ratio us/f w r\n";
  for (const std::string& grid : grids) {
    Totals totals;
    for (const auto& path : files) {
      std::ifstream stream(path, std::ios::binary);
      const std::string text{std::istreambuf_iterator<char>(stream), {}};
      const auto format = detect_format(path.filename().string(), as_bytes(text));
      if (!format) continue;
      const auto document = read_document(as_bytes(text), *format);
      if (!document) continue;
      for (const Feature& feature : document->features) {
        for (const SubmittedSolid& submitted : feature.solids) {
          report(path.filename().string(), submitted.solid, grid, least, totals);
        }
      }
    }
    if (totals.count > 0) {
      std::cout << "grid " << grid << ": " << totals.count << " meshes, geometric mean "
                << std::setprecision(3) << std::exp(totals.log_ratio / totals.count) << ", worst "
                << totals.worst << '\n';
    }
  }
  return 0;
}
