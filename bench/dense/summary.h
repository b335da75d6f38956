// SPDX-License-Identifier: GPL-3.0-or-later
//
// The measurements of one mesh, and of many, as Markdown.
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
  WholeBlob blob;                      // with the shipped priors
  bool is_seen = false;                // by the priors
  std::size_t draco = 0;               // 0: it refuses
  std::size_t meshopt = 0;             // 0: coordinates too wide for it
  std::size_t draco_connectivity = 0;  // the mesh with all positions 0
};

void print_heading(const std::string& grid);
void print_row(const MeshRow& row);

/// Means, medians and exceptions of all rows, and of those from `listed` facets on.
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
