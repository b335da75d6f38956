// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/dense/summary.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace watertight {
namespace {

double ratio_of(const MeshRow& row) {
  return row.draco == 0 ? 0 : static_cast<double>(row.blob.bytes) / static_cast<double>(row.draco);
}

double bits_per_vertex(const MeshRow& row, double bytes) {
  return 8 * bytes / static_cast<double>(row.vertices);
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

double geometric_mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += std::log(value);
  return values.empty() ? 0 : std::exp(sum / static_cast<double>(values.size()));
}

void print_ratios(const std::vector<MeshRow>& rows, const char* which) {
  std::vector<double> ratios;
  std::vector<double> unseen;
  const MeshRow* worst = nullptr;
  for (const MeshRow& row : rows) {
    if (row.draco == 0) continue;
    ratios.push_back(ratio_of(row));
    if (!row.is_seen) unseen.push_back(ratios.back());
    if (worst == nullptr || ratios.back() > ratio_of(*worst)) worst = &row;
  }
  if (worst == nullptr) return;
  std::printf("%s: %zu meshes, geometric mean %.3f (of the %zu unseen %.3f), worst %.3f (%s)\n",
              which, ratios.size(), geometric_mean(ratios), unseen.size(), geometric_mean(unseen),
              ratio_of(*worst), worst->name.c_str());
}

void print_exceptions(const std::vector<MeshRow>& rows) {
  std::printf("\nAbove Draco:");
  for (const MeshRow& row : rows) {
    if (ratio_of(row) > 1) std::printf(" %s %.3f;", row.name.c_str(), ratio_of(row));
  }
  std::printf("\n\nConnectivity above Draco's:");
  for (const MeshRow& row : rows) {
    const double draco = static_cast<double>(row.draco_connectivity);
    if (row.blob.connectivity_bytes < draco) continue;
    std::printf(" %s %.2f > %.2f;", row.name.c_str(),
                bits_per_vertex(row, row.blob.connectivity_bytes), bits_per_vertex(row, draco));
  }
  std::printf("\n\nToo wide for Draco:");
  for (const MeshRow& row : rows) {
    if (row.draco == 0) std::printf(" %s;", row.name.c_str());
  }
  std::printf("\n\n");
}

void print_costs(const std::vector<MeshRow>& rows) {
  std::vector<double> ours;
  std::vector<double> draco;
  double facets = 0;
  double encode = 0;
  double decode = 0;
  double memory = 0;
  for (const MeshRow& row : rows) {
    ours.push_back(bits_per_vertex(row, row.blob.connectivity_bytes));
    draco.push_back(bits_per_vertex(row, static_cast<double>(row.draco_connectivity)));
    facets += static_cast<double>(row.facets);
    encode += row.blob.encode_seconds;
    decode += row.blob.decode_seconds;
    memory = std::max(memory, row.blob.peak_bytes / static_cast<double>(row.vertices));
  }
  if (rows.empty()) return;
  std::printf(
      "Connectivity, median bits per vertex: %.2f, Draco %.2f. Seconds per million facets: encode "
      "%.1f, decode %.1f. Peak memory per vertex, greatest: %.0f bytes.\n\n",
      median(ours), median(draco), 1e6 * encode / facets, 1e6 * decode / facets, memory);
}

}  // namespace

void print_heading(const std::string& grid) {
  std::printf(
      "### Grid %s\n\n| mesh | vertices | facets | verdict | mode | seen | blob | Draco "
      "| "
      "meshopt+zstd | blob/Draco | bits/vertex | connectivity | Draco's | encode s/Mfacet | decode "
      "s/Mfacet | peak B/vertex |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---"
      "|\n",
      grid.c_str());
}

void print_row(const MeshRow& row) {
  const double facets = static_cast<double>(row.facets);
  std::printf("| %s | %zu | %zu | %s | %s | %s | %zu | %zu | %zu | %.3f |", row.name.c_str(),
              row.vertices, row.facets, row.validity.c_str(),
              std::string(codec::to_string(row.blob.mode)).c_str(), row.is_seen ? "yes" : "no",
              row.blob.bytes, row.draco, row.meshopt, ratio_of(row));
  std::printf(" %.2f | %.2f | %.2f | %.1f | %.1f | %.0f |\n",
              bits_per_vertex(row, static_cast<double>(row.blob.bytes)),
              bits_per_vertex(row, row.blob.connectivity_bytes),
              bits_per_vertex(row, static_cast<double>(row.draco_connectivity)),
              1e6 * row.blob.encode_seconds / facets, 1e6 * row.blob.decode_seconds / facets,
              row.blob.peak_bytes / static_cast<double>(row.vertices));
  std::fflush(stdout);
}

void Summary::print() const {
  std::vector<MeshRow> large;
  for (const MeshRow& row : rows_) {
    if (row.facets >= listed_) large.push_back(row);
  }
  std::printf("\n");
  print_ratios(rows_, "All");
  std::printf("\n");
  print_ratios(large, "Those listed");
  print_exceptions(rows_);
  print_costs(large);
  std::fflush(stdout);
}

}  // namespace watertight
