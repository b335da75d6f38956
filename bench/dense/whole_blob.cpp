// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/dense/whole_blob.h"

#include <malloc.h>
#include <time.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <utility>

#include "codec/encode_boundary.h"
#include "geometry/canonical_form.h"

namespace watertight {
namespace {

/// The CPU time of this thread in seconds: other work on the machine does not count.
double processor_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// The value of a line of /proc/self/status in bytes; 0 if the file or the line is missing.
double status_bytes(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind(name, 0) == 0) return 1024 * std::atof(line.c_str() + name.size());
  }
  return 0;
}

/// Makes the present resident set the peak, if the system allows it. Returns the peak in bytes.
double begin_peak() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";
  return status_bytes("VmRSS:");
}

[[noreturn]] void stop(const char* what, const Error& error) {
  std::fprintf(stderr, "%s: %s\n", what, to_string(error).c_str());
  std::exit(1);
}

}  // namespace

Result<OrientedBoundary> boundary_of(const codec::IntegerSolid& mesh, const Lattice* lattice) {
  auto points = geometry::lattice_of_integers(mesh.vertices, geometry::Transform{});
  if (!points) return points.error();
  SolidArrays arrays;
  arrays.vertices = std::move(points->points);
  Lattice on = points->lattice;
  if (lattice != nullptr) {
    on = *lattice;
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      const codec::GridPoint& p = mesh.vertices[i];
      arrays.vertices[i] = {static_cast<double>(p[0]), static_cast<double>(p[1]),
                            static_cast<double>(p[2])};
    }
  }
  arrays.ring_vertices = mesh.ring_vertices;
  arrays.ring_offsets = mesh.ring_offsets;
  arrays.facet_offsets = mesh.facet_offsets;
  arrays.shell_offsets = mesh.shell_offsets;
  auto solid = Solid::make(std::move(arrays), on, 0);
  if (!solid) return solid.error();
  return OrientedBoundary::make(std::move(solid).value());
}

WholeBlob whole_blob(const OrientedBoundary& boundary, Mode mode) {
  const Solid wanted = geometry::canonical_form(boundary).boundary.solid();
  EncodeOptions options;
  options.keep_order = false;
  options.mode = mode;
  const double resident = begin_peak();
  const double start = processor_seconds();
  const auto blob = codec::encode_boundary(boundary, {}, options);
  const double encoded = processor_seconds();
  if (!blob) stop("encode", blob.error());
  const auto decoded = decode(*blob);
  const double end = processor_seconds();
  const double peak = status_bytes("VmHWM:");
  if (!decoded) stop("decode", decoded.error());
  if (decoded->solid != wanted) {
    stop("decode", Error{ErrorCode::malformed, "another solid came back"});
  }
  WholeBlob result;
  result.bytes = blob->size();
  result.mode = decoded->info.mode;
  for (const codec::BlobInfo::Part& part : decoded->info.parts) {
    if (part.name == "connectivity" || part.name == "facets") {
      result.connectivity_bytes += part.bytes;
    }
  }
  result.encode_seconds = encoded - start;
  result.decode_seconds = end - encoded;
  result.peak_bytes = peak > resident ? peak - resident : 0;
  return result;
}

}  // namespace watertight
