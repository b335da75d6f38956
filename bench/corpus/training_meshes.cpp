// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/corpus/training_meshes.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>
#include <utility>

#include "bench/dense/quantized_mesh.h"
#include "bench/input.h"

namespace watertight {
namespace {

constexpr Index kMostFacets = 60000;

std::vector<std::string> files_under(const std::string& folder) {
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) paths.push_back(entry.path().generic_string());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

void add_meshes(const std::string& path, std::vector<codec::IntegerSolid>& meshes) {
  const auto document = bench::read_file(path);
  if (!document) return;
  for (const Feature& feature : document->features) {
    for (const SubmittedSolid& submitted : feature.solids) {
      if (submitted.solid.facet_count() > kMostFacets) continue;
      for (const int bits : {11, 14, 16, 0}) {
        auto mesh = quantize(submitted.solid, bits == 0 ? std::nullopt : std::optional<int>(bits));
        if (mesh) meshes.push_back(std::move(*mesh));
      }
    }
  }
}

}  // namespace

std::vector<codec::IntegerSolid> training_meshes(const std::string& folder) {
  std::vector<codec::IntegerSolid> meshes;
  if (folder.empty()) return meshes;
  const std::vector<std::string> paths = files_under(folder);
  for (std::size_t i = 0; i < paths.size(); i += 2) add_meshes(paths[i], meshes);
  return meshes;
}

}  // namespace watertight
