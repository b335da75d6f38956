// SPDX-License-Identifier: GPL-3.0-or-later
//
// Samples as documents, so that a disagreement can be examined with the command line.
#include <cstdio>

#include "bench/verdict/judge.h"

namespace watertight::verdict {
namespace {

std::string number(const GridNumber& value) {
  return std::to_string(value.mantissa).append("e").append(std::to_string(value.exponent));
}

/// The vertices on a decimal lattice as integers; the origin of the lattice is the document's
/// translate.
std::string vertices_text(const Solid& solid) {
  std::string text;
  for (const Point& p : solid.vertices()) {
    char line[96];
    std::snprintf(line, sizeof line, "%s[%.0f, %.0f, %.0f]", text.empty() ? "" : ", ", p.x, p.y,
                  p.z);
    text += line;
  }
  return text;
}

std::string triple(const std::array<GridNumber, 3>& numbers) {
  std::string text = "[";
  for (const GridNumber& value : numbers) {
    if (text.size() > 1) text += ", ";
    text += number(value);
  }
  return text.append("]");
}

std::string city_json(const std::string& objects, const Lattice& lattice,
                      const std::string& vertices) {
  return "{\"type\": \"CityJSON\", \"version\": \"2.0\", \"transform\": {\"scale\": " +
         triple(lattice.step) + ", \"translate\": " + triple(lattice.origin) +
         "}, \"CityObjects\": {" + objects + "}, \"vertices\": [" + vertices + "]}\n";
}

/// The second solid with the vertices of both: the members of a group share one list, in which
/// those of the first come first.
Solid with_first_vertices(const Solid& first, const Solid& second) {
  SolidArrays arrays = second.arrays();
  arrays.vertices.insert(arrays.vertices.begin(), first.vertices().begin(), first.vertices().end());
  for (Index& vertex : arrays.ring_vertices) vertex += first.vertex_count();
  return solids::solid_of(std::move(arrays), second.lattice());
}

std::string geometry(const std::string& type, const std::string& boundaries) {
  std::string text = "\"geometry\": [{\"type\": \"";
  return text.append(type)
      .append("\", \"lod\": \"2\", \"boundaries\": ")
      .append(boundaries)
      .append("}]");
}

std::string group_text(const Sample& sample) {
  const Solid all = with_first_vertices(sample.members[0], sample.members[1]);
  const std::string first = boundaries_text(sample.members[0]);
  const std::string second = boundaries_text(all);
  std::string objects;
  if (*sample.group == validate::GroupKind::composite_solid) {
    objects = "\"a\": {\"type\": \"Building\", " +
              geometry("CompositeSolid",
                       std::string("[").append(first).append(", ").append(second).append("]")) +
              "}";
  } else {
    objects = "\"a\": {\"type\": \"Building\", \"children\": [\"b\"], " + geometry("Solid", first) +
              "}, \"b\": {\"type\": \"BuildingPart\", \"parents\": [\"a\"], " +
              geometry("Solid", second) + "}";
  }
  return city_json(objects, all.lattice(), vertices_text(all));
}

std::string wkt(const Solid& solid) {
  std::string text = "SOLID Z (";
  for (Index shell = 0; shell < solid.shell_count(); ++shell) {
    text += shell == 0 ? "(" : ",(";
    for (Index f = solid.facets_of(shell).begin; f < solid.facets_of(shell).end; ++f) {
      text += f == solid.facets_of(shell).begin ? "(" : ",(";
      for (Index r = solid.rings_of(f).begin; r < solid.rings_of(f).end; ++r) {
        text += r == solid.rings_of(f).begin ? "(" : ",(";
        std::vector<Index> ring(solid.ring(r).begin(), solid.ring(r).end());
        ring.push_back(ring.front());
        for (std::size_t k = 0; k < ring.size(); ++k) {
          const auto [x, y, z] = solid.world(ring[k]);
          char point[96];
          std::snprintf(point, sizeof point, "%s%.17g %.17g %.17g", k == 0 ? "" : ",", x, y, z);
          text += point;
        }
        text += ")";
      }
      text += ")";
    }
    text += ")";
  }
  return text + ")\n";
}

}  // namespace

WrittenSample written(const Sample& sample) {
  if (!sample.document.empty()) return {sample.document + "\n"};
  if (sample.group) return {group_text(sample)};
  const Solid& solid = sample.members.front();
  if (solid.lattice().kind != LatticeKind::decimal) return {wkt(solid), ".wkt"};
  const std::string object =
      "\"a\": {\"type\": \"Building\", " + geometry("Solid", boundaries_text(solid)) + "}";
  return {city_json(object, solid.lattice(), vertices_text(solid))};
}

}  // namespace watertight::verdict
