// SPDX-License-Identifier: GPL-3.0-or-later
//
// The measurements of one mesh and of many meshes, as Markdown.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bench/dense/whole_blob.h"

namespace watertight {

struct MeshRow {
  std::string name;
  std::size_t vertices = 0;
  std::size_t facets = 0;
  std::string validity;
  WholeBlob blob;                      // the blob with the shipped priors
  bool is_seen = false;                // the priors were trained on the mesh
  std::size_t draco = 0;               // bytes; 0: Draco refuses the mesh
  std::size_t meshopt = 0;             // bytes; 0: the coordinates are too wide for meshoptimizer
  std::size_t draco_connectivity = 0;  // bytes of the mesh with all positions 0
};

void print_heading(const std::string& grid);
void print_row(const MeshRow& row);

/// Means, medians and exceptions of all meshes, and of those with at least `listed` facets.
class Summary {
 public:
  explicit Summary(std::size_t listed) : listed_(listed) {}
  void add(const MeshRow& row) { rows_.push_back(row); }
  void print() const;

 private:
  std::size_t listed_;
  std::vector<MeshRow> rows_;
};

}  // namespace watertight
