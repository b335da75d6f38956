// SPDX-License-Identifier: AGPL-3.0-or-later
//
// TetGen's constrained Delaunay tetrahedralization, as Debian packages it (1.5.0). This file is
// linked with TetGen into the executable watertight-tetgen, which as a whole is under the GNU
// Affero General Public License, version 3 or later; nothing else links it.
// Based on: Si, "TetGen, a Delaunay-based quality tetrahedral mesh generator" (2015).
//
// TetGen 1.5.0 frees its memory twice on every error path and keeps its tables in globals, so a
// process runs one job only, and a crash means "no answer".
#include <tetgen.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "delaunay/engines/engine.h"

namespace watertight::delaunay {
namespace {

// p: constrain to the facets; c: keep the convex hull, the regions are flooded by the certificate;
// Q: no output; T: the deviation, relative to the box, up to which points count as coplanar. The
// default of 1e-8 rejects thin plates and boxes in degrees and metres; 1e-14 lets the exact
// arithmetic decide.
constexpr const char* kSwitches = "pcQT1e-14";

/// Copies the complex into arrays of `input`, whose destructor frees them with delete[].
void fill(tetgenio& input, const PiecewiseLinearComplex& complex) {
  input.firstnumber = 0;
  input.numberofpoints = static_cast<int>(complex.vertices.size());
  input.pointlist = new REAL[3 * complex.vertices.size()];
  for (std::size_t i = 0; i < complex.vertices.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      input.pointlist[3 * i + static_cast<std::size_t>(axis)] = complex.vertices[i][axis];
    }
  }
  const std::size_t count = complex.triangles.size();
  input.numberoffacets = static_cast<int>(count);
  input.facetlist = new tetgenio::facet[count];
  input.facetmarkerlist = new int[count];
  for (std::size_t t = 0; t < count; ++t) {
    tetgenio::facet& facet = input.facetlist[t];
    tetgenio::init(&facet);
    facet.numberofpolygons = 1;
    facet.polygonlist = new tetgenio::polygon[1];
    tetgenio::polygon& polygon = facet.polygonlist[0];
    tetgenio::init(&polygon);
    polygon.numberofvertices = 3;
    polygon.vertexlist = new int[3];
    for (std::size_t k = 0; k < 3; ++k) {
      polygon.vertexlist[k] = static_cast<int>(complex.triangles[t][k]);
    }
    // 0 is TetGen's marker for faces of the hull that belong to no facet.
    input.facetmarkerlist[t] = static_cast<int>(complex.facet_of[t]) + 1;
  }
}

std::size_t checked_count(int count) { return count > 0 ? static_cast<std::size_t>(count) : 0; }

Tetrahedralization collect(const tetgenio& output, const std::vector<Point>& vertices) {
  Tetrahedralization result;
  result.points = vertices;
  result.input_count = static_cast<Index>(vertices.size());
  for (std::size_t i = vertices.size(); i < checked_count(output.numberofpoints); ++i) {
    result.points.push_back(
        {output.pointlist[3 * i], output.pointlist[3 * i + 1], output.pointlist[3 * i + 2]});
  }
  for (std::size_t t = 0; t < checked_count(output.numberoftetrahedra); ++t) {
    geometry::Tetrahedron& tetrahedron = result.tetrahedra.emplace_back();
    for (std::size_t k = 0; k < 4; ++k) {
      tetrahedron[k] = static_cast<Index>(output.tetrahedronlist[4 * t + k]);
    }
  }
  for (std::size_t t = 0; t < checked_count(output.numberoftrifaces); ++t) {
    const int marker = output.trifacemarkerlist == nullptr ? 0 : output.trifacemarkerlist[t];
    if (marker <= 0) continue;
    ConstrainedFace& face = result.constrained.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      face.vertices[k] = static_cast<Index>(output.trifacelist[3 * t + k]);
    }
    std::sort(face.vertices.begin(), face.vertices.end());
    face.facet = static_cast<Index>(marker - 1);
  }
  std::sort(result.constrained.begin(), result.constrained.end());
  return result;
}

}  // namespace

CdtAnswer constrained_delaunay(const CdtJob& job) {
  tetgenio input;
  tetgenio output;
  fill(input, job.complex);
  std::string switches = kSwitches;
  tetgenbehavior behavior;
  if (!behavior.parse_commandline(switches.data())) return {{}, "TetGen refused its switches"};
  tetrahedralize(&behavior, &input, &output);
  CdtAnswer answer;
  if (output.numberofpoints < input.numberofpoints || output.numberofcorners != 4) {
    answer.refusal = "TetGen dropped vertices";
    return answer;
  }
  answer.tetrahedralization = collect(output, job.complex.vertices);
  return answer;
}

}  // namespace watertight::delaunay
