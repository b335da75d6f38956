// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/place.h"

namespace watertight::report {
namespace {

Index member_of(const pipeline::InspectedFeature& feature, const pipeline::InspectedGroup& group,
                const Place& place) {
  if (group.members.empty()) return kNone;
  const std::size_t solid = group.members[place.solid < group.members.size() ? place.solid : 0];
  return solid < feature.solids.size() ? static_cast<Index>(solid) : kNone;
}

std::optional<std::array<double, 3>> middle_of_ring(const Solid& solid, Index ring) {
  const std::span<const Index> vertices = solid.ring(ring);
  if (vertices.empty()) return std::nullopt;
  std::array<double, 3> sum{};
  for (const Index vertex : vertices) {
    const std::array<double, 3> point = solid.world(vertex);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      sum[axis] += point[axis] / static_cast<double>(vertices.size());
    }
  }
  return sum;
}

}  // namespace

const Solid* submitted_solid(const pipeline::InspectedFeature& feature, Index solid) {
  return solid < feature.feature.solids.size() ? &feature.feature.solids[solid].solid : nullptr;
}

std::vector<PlacedFinding> findings_of(const pipeline::InspectedFeature& feature) {
  std::vector<PlacedFinding> all;
  for (Index i = 0; i < feature.solids.size(); ++i) {
    for (const Finding& finding : feature.solids[i].inspection.report.findings) {
      all.push_back({&finding, i, finding.other ? i : kNone, nullptr});
    }
  }
  for (const pipeline::InspectedGroup& group : feature.groups) {
    for (const Finding& finding : group.report.findings) {
      all.push_back({&finding, member_of(feature, group, finding.place),
                     finding.other ? member_of(feature, group, *finding.other) : kNone, &group});
    }
  }
  return all;
}

std::optional<std::array<double, 3>> point_of(const pipeline::InspectedFeature& feature,
                                              const PlacedFinding& placed) {
  const Finding& finding = *placed.finding;
  if (finding.witness) return finding.witness;
  const Solid* solid = submitted_solid(feature, placed.solid);
  if (solid == nullptr) return std::nullopt;
  if (finding.place.vertex < solid->vertex_count()) return solid->world(finding.place.vertex);
  if (finding.place.facet >= solid->facet_count()) return std::nullopt;
  const IndexRange rings = solid->rings_of(finding.place.facet);
  if (rings.size() == 0) return std::nullopt;
  return middle_of_ring(*solid, rings.begin);
}

std::string place_words(const Place& place, const Solid* solid) {
  std::string text;
  const auto add = [&](std::string_view name, Index index) {
    if (!text.empty()) text += ' ';
    text += name;
    text += ' ';
    text += std::to_string(index);
  };
  const bool has_shells = solid != nullptr && solid->shell_count() > 1;
  if (place.shell != kNone && (has_shells || place.facet == kNone)) add("shell", place.shell);
  if (place.facet != kNone) add("facet", place.facet);
  if (place.ring != kNone && place.ring > 0) add("ring", place.ring);
  if (place.vertex != kNone) add("vertex", place.vertex);
  return text;
}

std::string shortened(std::string_view text) {
  constexpr std::size_t kMost = 300;
  if (text.size() <= kMost) return std::string(text);
  std::size_t end = kMost;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  return std::string(text.substr(0, end)) + "...";
}

std::string solid_id(const SolidSource& source) {
  std::string id = "coid=";
  id += source.object_id;
  id += "|geom=";
  id += std::to_string(source.geometry);
  id += "|solid=";
  id += std::to_string(source.ordinal);
  return id;
}

validate::ReportJsonOptions json_options_of(const SolidSource& source, Index solid) {
  validate::ReportJsonOptions options;
  options.pointer_prefix = source.pointer;
  options.has_shells = !formats::is_surface(source);
  options.id_prefix = solid_id(source) + "|";
  options.solid_number = solid;
  return options;
}

std::string pointer_of(const pipeline::InspectedFeature& feature, Index solid, const Place& place) {
  const Solid* submitted = submitted_solid(feature, solid);
  if (submitted == nullptr) return "";
  return validate::place_pointer(place, *submitted,
                                 json_options_of(feature.feature.solids[solid].source, solid));
}

std::string_view format_name(Format format) {
  switch (format) {
    case Format::city_json:
      return "CityJSON";
    case Format::city_json_seq:
      return "CityJSONSeq";
    case Format::obj:
      return "OBJ";
    case Format::off:
      return "OFF";
    case Format::wkt:
      return "WKT";
    case Format::ewkb:
      return "EWKB";
    case Format::gml:
      return "GML";
    case Format::json_fg:
      return "JSON-FG";
    case Format::stl:
      return "STL";
    case Format::ply:
      return "PLY";
    case Format::poly:
      return "POLY";
    case Format::ifc:
      return "IFC";
    case Format::step:
      return "STEP";
    case Format::brep:
      return "BRep";
    case Format::bpt:
      return "BPT";
  }
  return "unknown";
}

std::string crs_name(std::uint32_t srid) {
  return srid == 0 ? "" : "urn:ogc:def:crs:EPSG::" + std::to_string(srid);
}

}  // namespace watertight::report
