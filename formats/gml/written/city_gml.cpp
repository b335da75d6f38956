// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/gml/written/city_gml.h"

#include <array>
#include <utility>
#include <vector>

#include "base/quantity.h"
#include "formats/city_json/city_json.h"
#include "formats/city_json/model.h"
#include "formats/gml/written/object_writer.h"

namespace watertight::formats {
namespace {

/// A feature as it is written.
struct Member {
  CityModel model;
  VertexTexts vertices;
};

Result<Member> member_of(const CityHeader& header, std::string_view text) {
  auto model = parse_city_model(text, CityText::document, kOwnText);
  if (!model) return std::move(model).error();
  const Json* objects = find_member(model->root, "CityObjects");
  if (objects == nullptr || !objects->is_object()) {
    return malformed_at("CityObjects is missing or not an object", "/CityObjects");
  }
  auto vertices = VertexTexts::of(*model, header.transform.value_or(geometry::Transform{}));
  if (!vertices) return std::move(vertices).error();
  return Member{*std::move(model), *std::move(vertices)};
}

void open_model(XmlText& xml) {
  std::vector<XmlAttribute> declarations;
  for (const GmlNamespace& space : gml_namespaces()) {
    declarations.emplace_back(space.declaration, space.uri);
  }
  xml.open("core:CityModel", declarations);
}

void write_head(XmlText& xml, const CityHeader& header, const VertexTexts& box,
                GmlLeftOut& left_out) {
  const auto root = parse_json(header.text, kOwnText);
  const Json* metadata = root ? find_member(*root, "metadata") : nullptr;
  const std::string title = metadata == nullptr ? "" : string_member(*metadata, "title");
  if (!title.empty()) xml.leaf("gml:name", title);
  const Json* appearance = root ? find_member(*root, "appearance") : nullptr;
  for (const char* theme : {"default-theme-material", "default-theme-texture"}) {
    if (appearance != nullptr && appearance->contains(theme)) ++left_out[theme];
  }
  if (!box.has_box) return;
  const std::string srs = header.srid == 0 ? "" : "EPSG:" + std::to_string(header.srid);
  const auto corner = [](const std::array<VertexTexts::Bound, 3>& bounds) {
    return bounds[0].text + " " + bounds[1].text + " " + bounds[2].text;
  };
  xml.open("gml:boundedBy");
  xml.open("gml:Envelope", {{"srsName", srs}, {"srsDimension", "3"}});
  xml.leaf("gml:lowerCorner", corner(box.least));
  xml.leaf("gml:upperCorner", corner(box.most));
  xml.close();
  xml.close();
}

}  // namespace

Result<std::string> write_city_gml(const Document& document) {
  const auto header = read_city_json_header(document.header, kOwnText);
  if (!header) return header.error();
  std::vector<Member> members;
  VertexTexts box;
  for (const Feature& feature : document.features) {
    const auto text = write_feature(document, feature);
    if (!text) return text.error();
    auto member = member_of(*header, *text);
    if (!member) return std::move(member).error();
    box.join_box(member->vertices);
    members.push_back(*std::move(member));
  }
  XmlText xml;
  GmlLeftOut left_out;
  XmlIds ids;
  open_model(xml);
  write_head(xml, *header, box, left_out);
  for (const Member& member : members) {
    ObjectWriter(member.model, member.vertices, ids, xml, left_out).write_members();
  }
  for (const auto& [part, count] : left_out) {
    xml.comment("not written: " + part + " (" + quantity(count, "time") + ")");
  }
  xml.close();
  return std::move(xml).take();
}

}  // namespace watertight::formats
