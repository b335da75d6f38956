// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

#include "formats/city_json/model.h"
#include "formats/text/numbers.h"

namespace watertight::formats {
namespace {

// The exponent of the finest step among all solids: its grid, without translation, holds all
// solids.
Result<std::int32_t> finest_exponent(const Document& document) {
  std::int32_t exponent = 0;
  bool is_first = true;
  for (const Feature& feature : document.features) {
    for (const SubmittedSolid& solid : feature.solids) {
      const Lattice& lattice = solid.solid.lattice();
      if (lattice.kind != LatticeKind::decimal) {
        return Error{ErrorCode::unsupported,
                     "the coordinates are on no decimal grid, which a CityJSON needs"};
      }
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::int32_t finest =
            lattice.origin[axis].mantissa == 0
                ? lattice.step[axis].exponent
                : std::min(lattice.step[axis].exponent, lattice.origin[axis].exponent);
        exponent = is_first ? finest : std::min(exponent, finest);
        is_first = false;
      }
    }
  }
  return std::min(exponent, 0);
}

std::string header_text(std::int32_t exponent, std::uint32_t srid) {
  const std::string step = plain_text(GridNumber{1, exponent});
  std::string text = R"({"type":"CityJSON","version":"2.0","transform":{"scale":[)" + step + ',' +
                     step + ',' + step + R"(],"translate":[0,0,0]},)";
  if (srid != 0) {
    text += R"("metadata":{"referenceSystem":"https://www.opengis.net/def/crs/EPSG/0/)" +
            std::to_string(srid) + R"("},)";
  }
  return text + R"("CityObjects":{},"vertices":[]})";
}

// A feature whose solids follow one another, each with vertices of its own.
Feature generic_feature(const Feature& source, std::string id) {
  Feature feature;
  feature.id = std::move(id);
  feature.type = "GenericCityObject";
  feature.srid = source.srid;
  feature.solids = source.solids;
  std::string geometries;
  std::string runs;
  std::uint64_t vertex_count = 0;
  for (std::size_t i = 0; i < source.solids.size(); ++i) {
    const std::uint64_t size = source.solids[i].solid.vertex_count();
    if (i > 0) {
      geometries += ',';
      runs += ',';
    }
    geometries += R"({"type":"Solid","lod":"1","boundaries":{"solid":)" + std::to_string(i) + "}}";
    runs += '[';
    if (size > 0) runs += std::to_string(vertex_count) + ',' + std::to_string(size);
    runs += ']';
    vertex_count += size;
  }
  std::string& out = feature.skeleton;
  out = R"({"type":"CityJSONFeature","id":)";
  append_json_string(out, feature.id);
  out += R"(,"CityObjects":{)";
  append_json_string(out, feature.id);
  out += R"(:{"type":"GenericCityObject","geometry":[)" + geometries +
         R"(]}},"vertices":{"count":)" + std::to_string(vertex_count) +
         R"(,"kind":"integers","solids":[)" + runs + R"(],"others":[]}})";
  return feature;
}

bool is_utf8_name(const std::string& name) {
  std::string quoted;
  append_json_string(quoted, name);
  return parse_json(quoted, Limits{}).has_value();
}

// The document of features that keep their city model: a GML document read for a store.
Document kept_city_model(const Document& document) {
  Document model;
  model.format = Format::city_json;
  model.header = document.header;
  model.notes = document.notes;
  for (const Feature& feature : document.features) {
    model.features.push_back(feature.skeleton.empty() ? generic_feature(feature, feature.id)
                                                      : feature);
  }
  return model;
}

}  // namespace

Result<Document> as_city_model(const Document& document) {
  const std::string_view header = document.header;
  if (document.format == Format::gml && !header.empty()) return kept_city_model(document);
  const auto exponent = finest_exponent(document);
  if (!exponent) return exponent.error();
  Document model;
  model.format = Format::city_json;
  model.notes = document.notes;
  std::set<std::string> ids;
  std::uint32_t srid = 0;
  for (const Feature& feature : document.features) {
    if (srid == 0) srid = feature.srid;
    if (feature.srid != srid) {
      return Error{ErrorCode::unsupported, "a CityJSON has one reference system, not several"};
    }
    std::string id = feature.id;
    if (id.empty() || !is_utf8_name(id)) {
      id = std::string("solid-").append(std::to_string(ids.size() + 1));
    }
    while (!ids.insert(id).second) id.append("-").append(std::to_string(ids.size() + 1));
    model.features.push_back(generic_feature(feature, id));
  }
  model.header = header_text(*exponent, srid);
  return model;
}

}  // namespace watertight::formats
