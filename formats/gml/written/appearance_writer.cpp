// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/gml/written/appearance_writer.h"

#include "formats/city_json/model.h"

namespace watertight::formats {
namespace {

/// A list of numbers between blanks; "" for another value.
std::string numbers_text(const Json& list) {
  std::string text;
  if (!list.is_array()) return text;
  for (const Json& number : list) {
    if (!is_number_value(number)) return {};
    text.append(text.empty() ? "" : " ").append(json_text(number));
  }
  return text;
}

/// The text of a member that is a number, a colour, a text, or true or false; "" for others.
std::string member_text(const Json& object, std::string_view name) {
  const Json* value = find_member(object, name);
  if (value == nullptr) return {};
  if (value->is_string()) return value->get<std::string>();
  if (value->is_array()) return numbers_text(*value);
  return value->is_boolean() || is_number_value(*value) ? json_text(*value) : std::string();
}

}  // namespace

AppearanceWriter::AppearanceWriter(const Json& model, XmlText& xml, GmlLeftOut& left_out)
    : xml_(xml), left_out_(left_out) {
  const Json* appearance = find_member(model, "appearance");
  if (appearance == nullptr) return;
  materials_ = find_member(*appearance, "materials");
  textures_ = find_member(*appearance, "textures");
  vertices_ = find_member(*appearance, "vertices-texture");
}

void AppearanceWriter::add(const WrittenFacet& facet, const std::vector<std::string>& ring_ids) {
  for (const FacetLook& look : facet.looks) {
    if (look.is_texture) {
      add_texture(look, facet, ring_ids);
    } else if (look.value->is_number_unsigned() &&
               element_of(materials_, look.value->get<std::size_t>()) != nullptr) {
      themes_[look.theme].materials[look.value->get<std::size_t>()].push_back(facet.id);
    } else {
      ++left_out_["materials that do not exist"];
    }
  }
}

/// The value of a texture is a list for each ring: the number of the texture and, for each vertex,
/// that of its place in the image; [null] for none.
void AppearanceWriter::add_texture(const FacetLook& look, const WrittenFacet& facet,
                                   const std::vector<std::string>& ring_ids) {
  for (std::size_t i = 0; i < facet.rings.size(); ++i) {
    const Json* ring = element_of(look.value, i);
    const Json* number = ring == nullptr ? nullptr : element_of(ring, 0);
    if (number == nullptr || number->is_null()) continue;
    const std::string coordinates =
        ring->size() == facet.rings[i].size() + 1 ? coordinates_of(*ring) : std::string();
    const bool is_known = number->is_number_unsigned() &&
                          element_of(textures_, number->get<std::size_t>()) != nullptr;
    if (!is_known || coordinates.empty() || ring_ids[i].empty()) {
      ++left_out_["textures of rings that cannot be read"];
      continue;
    }
    themes_[look.theme].textures[number->get<std::size_t>()][facet.id].push_back(
        {ring_ids[i], coordinates});
  }
}

/// The places in the image, the first one again at the end; "" where one does not exist.
std::string AppearanceWriter::coordinates_of(const Json& ring) const {
  std::string text;
  for (std::size_t i = 1; i <= ring.size(); ++i) {
    const Json& number = ring[i < ring.size() ? i : 1];
    const Json* vertex =
        number.is_number_unsigned() ? element_of(vertices_, number.get<std::size_t>()) : nullptr;
    const std::string pair = vertex == nullptr || vertex->size() != 2 ? "" : numbers_text(*vertex);
    if (pair.empty()) return {};
    text.append(text.empty() ? "" : " ").append(pair);
  }
  return text;
}

void AppearanceWriter::write_material(std::size_t number,
                                      const std::vector<std::string>& polygons) {
  const Json& material = (*materials_)[number];
  xml_.open("app:surfaceDataMember");
  xml_.open("app:X3DMaterial");
  const auto leaf = [&](const std::string& element_name, std::string_view member) {
    const std::string text = member_text(material, member);
    if (!text.empty()) xml_.leaf(element_name, text);
  };
  leaf("gml:name", "name");
  for (const std::string_view member : {"ambientIntensity", "diffuseColor", "emissiveColor",
                                        "specularColor", "shininess", "transparency", "isSmooth"}) {
    leaf(std::string("app:").append(member), member);
  }
  for (const std::string& polygon : polygons) xml_.leaf("app:target", "#" + polygon);
  xml_.close();
  xml_.close();
}

void AppearanceWriter::write_texture(std::size_t number, const Targets& targets) {
  const Json& texture = (*textures_)[number];
  xml_.open("app:surfaceDataMember");
  xml_.open("app:ParameterizedTexture");
  xml_.leaf("app:imageURI", member_text(texture, "image"));
  xml_.leaf("app:mimeType", member_text(texture, "type") == "PNG" ? "image/png" : "image/jpeg");
  for (const std::string_view member : {"textureType", "wrapMode", "borderColor"}) {
    const std::string text = member_text(texture, member);
    if (!text.empty()) xml_.leaf(std::string("app:").append(member), text);
  }
  for (const auto& [polygon, rings] : targets) {
    xml_.open("app:target", {{"uri", "#" + polygon}});
    xml_.open("app:TexCoordList");
    for (const TexturedRing& ring : rings) {
      xml_.leaf("app:textureCoordinates", ring.coordinates, {{"ring", "#" + ring.ring}});
    }
    xml_.close();
    xml_.close();
  }
  xml_.close();
  xml_.close();
}

void AppearanceWriter::write() {
  for (const auto& [name, theme] : themes_) {
    xml_.open("app:appearanceMember");
    xml_.open("app:Appearance");
    if (!name.empty()) xml_.leaf("app:theme", name);
    for (const auto& [number, polygons] : theme.materials) write_material(number, polygons);
    for (const auto& [number, targets] : theme.textures) write_texture(number, targets);
    xml_.close();
    xml_.close();
  }
}

}  // namespace watertight::formats
