// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/gml/city/appearance.h"

#include <algorithm>
#include <array>
#include <utility>

#include "formats/gml/city/values.h"

namespace watertight::formats {
namespace {

bool is_number(const Json& value) { return value.is_binary(); }

// The members of a material that CityJSON has; the colours are lists of three numbers.
constexpr std::array<std::string_view, 3> kFactors{"ambientIntensity", "shininess", "transparency"};
constexpr std::array<std::string_view, 3> kColours{"diffuseColor", "emissiveColor",
                                                   "specularColor"};
// The name of a theme that has none: a key of CityJSON must name it.
constexpr std::string_view kUnnamed = "unnamed";
// Every theme repeats the structure of the geometries that it concerns, so themes multiply the
// text. Further themes are losses.
constexpr std::size_t kMostThemes = 64;
constexpr std::size_t kLongestTheme = 256;  // bytes

}  // namespace

void GmlAppearance::read(Index appearance) {
  if (tree_.name(appearance) != "Appearance") return;
  std::string name(kUnnamed);
  const Index theme = tree_.child(appearance, "theme");
  const std::string_view stated = theme == kNone ? "" : tree_.text(theme);
  if (themes_.size() >= kMostThemes && !themes_.contains(std::string(stated))) return;
  if (stated.size() > kLongestTheme) return;
  marks_.mark(appearance);
  if (theme != kNone) {
    marks_.mark(theme);
    if (!tree_.text(theme).empty()) name = tree_.text(theme);
  }
  for (const Index property : tree_.children(appearance)) {
    for (const Index data : tree_.children(property)) {
      if (tree_.name(data) == "X3DMaterial") read_material(data, themes_[name]);
      if (tree_.name(data) == "ParameterizedTexture") read_texture(data, themes_[name]);
    }
  }
}

Json GmlAppearance::colour(Index element) {
  Json numbers = Json::array();
  for (const std::string_view word : words_of(tree_.text(element))) {
    numbers.push_back(ValueReader::number_of(word));
  }
  return numbers;
}

void GmlAppearance::read_material(Index element, Theme& theme) {
  const Index front = tree_.child(element, "isFront");
  if (front != kNone && tree_.text(front) != "true" && tree_.text(front) != "1") return;
  marks_.mark(element);
  if (front != kNone) marks_.mark(front);
  const std::size_t number = materials_.size();
  ObjectBuilder material;
  const Index name = tree_.child(element, "name");
  std::string own_name = "material-";
  own_name.append(std::to_string(number));
  if (name != kNone) {
    marks_.mark(name);
    marks_.mark_text(name);
    own_name = tree_.text(name);
  } else if (!tree_.id(element).empty()) {
    marks_.mark_attribute(tree_.id_attribute(element));
    own_name = tree_.id(element);
  }
  material.add("name", own_name, "");
  for (const Index property : tree_.children(element)) {
    const std::string key(tree_.name(property));
    const auto is_key = [&](std::string_view known) { return known == key; };
    if (material.has(key)) continue;
    Json value;
    if (std::any_of(kFactors.begin(), kFactors.end(), is_key)) {
      value = ValueReader::number_of(tree_.text(property));
      if (!is_number(value)) continue;
    } else if (std::any_of(kColours.begin(), kColours.end(), is_key)) {
      value = colour(property);
      if (value.size() != 3 || !std::all_of(value.begin(), value.end(), is_number)) continue;
    } else if (key == "isSmooth") {
      value = tree_.text(property) == "true" || tree_.text(property) == "1";
    } else {
      continue;
    }
    marks_.mark(property);
    material.add(key, std::move(value), "");
  }
  materials_.push_back(material.take());
  for (const Index target : tree_.children(element)) {
    if (tree_.name(target) != "target") continue;
    const std::string_view href =
        tree_.text(target).empty() ? tree_.href(target) : tree_.text(target);
    const Index geometry = geometry_.geometry_of(href);
    if (geometry != kNone) theme.materials.emplace(geometry, Material{number, target});
  }
}

void GmlAppearance::read_texture(Index element, Theme& theme) {
  const Index image = tree_.child(element, "imageURI");
  if (image == kNone) return;
  marks_.mark(element);
  marks_.mark(image);
  const std::string_view uri = tree_.text(image);
  const Index mime = tree_.child(element, "mimeType");
  const std::string_view kind = mime == kNone ? uri : tree_.text(mime);
  Json texture = Json::object();
  const bool is_png = kind.ends_with("png") || kind.ends_with("PNG");
  append_member(texture, "type", is_png ? "PNG" : "JPG");
  append_member(texture, "image", std::string(uri));
  const bool is_plain = kind.ends_with("png") || kind.ends_with("jpg") || kind.ends_with("jpeg");
  if (mime != kNone && is_plain) marks_.mark(mime);
  for (const std::string_view name : {"wrapMode", "textureType"}) {
    const Index property = tree_.child(element, name);
    if (property == kNone) continue;
    marks_.mark(property);
    append_member(texture, std::string(name), std::string(tree_.text(property)));
  }
  if (const Index border = tree_.child(element, "borderColor"); border != kNone) {
    Json numbers = colour(border);
    if (numbers.size() == 4 && std::all_of(numbers.begin(), numbers.end(), is_number)) {
      marks_.mark(border);
      append_member(texture, "borderColor", std::move(numbers));
    }
  }
  const std::size_t number = textures_.size();
  textures_.push_back(std::move(texture));
  for (const Index target : tree_.children(element)) {
    // CityGML 1 and 2: target/TexCoordList; 3: textureParameterization/TextureAssociation/...
    for (const Index value : tree_.children(target)) {
      if (tree_.name(value) == "TexCoordList") read_coordinates(value, target, number, theme);
      if (tree_.name(value) != "TextureAssociation") continue;
      const Index parameterization = tree_.child(value, "textureParameterization");
      if (parameterization == kNone) continue;
      const Index list = tree_.child(parameterization, "TexCoordList");
      if (list != kNone) read_coordinates(list, target, number, theme);
    }
  }
}

void GmlAppearance::read_coordinates(Index list, Index target, std::size_t number, Theme& theme) {
  std::vector<Index> coordinates;
  std::vector<Index> rings;  // CityGML 3: elements that follow the coordinates
  for (const Index child : tree_.children(list)) {
    if (tree_.name(child) == "ring") rings.push_back(child);
    if (tree_.name(child) == "textureCoordinates") coordinates.push_back(child);
  }
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    Texture texture;
    texture.number = number;
    texture.target = target;
    texture.coordinates = coordinates[i];
    std::string_view href = tree_.attribute(coordinates[i], "", "ring");
    if (href.empty() && rings.size() == coordinates.size()) {
      texture.ring = rings[i];
      href = tree_.text(rings[i]);
    }
    const Index ring = geometry_.geometry_of(href);
    if (ring == kNone || !read_pairs(coordinates[i], texture)) continue;
    theme.textures.emplace(ring, std::move(texture));
  }
}

// Reads the coordinates of one ring; false when they are no pairs of numbers.
bool GmlAppearance::read_pairs(Index coordinates, Texture& texture) {
  const auto words = words_of(tree_.text(coordinates));
  if (words.empty() || words.size() % 2 != 0) return false;
  for (std::size_t i = 0; i < words.size(); i += 2) {
    const auto [place, is_new] =
        vertex_numbers_.emplace(std::pair(words[i], words[i + 1]), vertices_.size());
    if (is_new) {
      Json u = ValueReader::number_of(words[i]);
      Json v = ValueReader::number_of(words[i + 1]);
      if (!is_number(u) || !is_number(v)) {
        vertex_numbers_.erase(place);
        return false;
      }
      Json vertex = Json::array();
      vertex.push_back(std::move(u));
      vertex.push_back(std::move(v));
      vertices_.push_back(std::move(vertex));
    }
    texture.vertices.push_back(place->second);
  }
  return true;
}

// The material of a polygon, or of a collection of surfaces that it stands in.
const GmlAppearance::Material* GmlAppearance::material_of(const Theme& theme, Index polygon) const {
  for (Index i = polygon; i != kNone && tree_.is_gml(i); i = tree_[i].parent) {
    const auto found = theme.materials.find(i);
    if (found != theme.materials.end()) return &found->second;
  }
  return nullptr;
}

// Marks the coordinates of a ring and the elements that say to which ring they belong.
void GmlAppearance::mark_texture(const Texture& texture) {
  if (texture.ring != kNone) marks_.mark(texture.ring);
  for (Index i = texture.coordinates; i != kNone; i = tree_[i].parent) {
    marks_.mark(i);
    const Index end = tree_[i].first_attribute + tree_[i].attribute_count;
    for (Index k = tree_[i].first_attribute; k < end; ++k) {
      const std::string_view name = tree_.attribute_name(k);
      if (name == "ring" || name == "uri") marks_.mark_attribute(k);
    }
    if (tree_.name(i) == "TextureAssociation") {
      const Index target = tree_.child(i, "target");
      if (target != kNone) marks_.mark(target);
    }
    if (i == texture.target) return;
  }
}

// The textures of a facet's rings: [[0,10,11,12]], or [[null]] without one.
std::string GmlAppearance::texture_text(const Theme& theme, const CityFacet& facet, bool& is_any) {
  std::string text = "[";
  for (const CityRing& ring : facet.rings) {
    if (text.size() > 1) text += ',';
    const auto found = theme.textures.find(ring.element);
    const std::size_t count = ring.positions.size();
    // The list repeats the first position, as the ring does in GML.
    if (found == theme.textures.end() || found->second.vertices.size() != count + 1) {
      text += "[null]";
      continue;
    }
    is_any = true;
    mark_texture(found->second);
    std::vector<std::size_t> vertices = found->second.vertices;
    vertices.pop_back();
    if (ring.is_reversed) std::reverse(vertices.begin() + 1, vertices.end());
    text.append("[").append(std::to_string(found->second.number));
    for (const std::size_t vertex : vertices) text.append(",").append(std::to_string(vertex));
    text += ']';
  }
  return text + ']';
}

void GmlAppearance::append_members(std::string& out, const CityGeometry& geometry) {
  std::string materials;
  std::string textures;
  for (const auto& named : themes_) {
    const Theme& theme = named.second;
    bool is_any = false;
    std::string values;
    append_by_facet(values, geometry, [&](const CityFacet& facet) -> std::string {
      const Material* material = material_of(theme, facet.polygon);
      if (material == nullptr) return "null";
      is_any = true;
      marks_.mark(material->target);
      marks_.mark_text(material->target);
      marks_.mark_attribute(tree_.href_attribute(material->target));
      return std::to_string(material->number);
    });
    const auto add = [&](std::string& members) {
      if (!is_any) return;
      if (!members.empty()) members += ',';
      append_json_string(members, named.first);
      members.append(":{\"values\":").append(values).append("}");
    };
    if (!theme.materials.empty()) add(materials);
    is_any = false;
    values.clear();
    if (theme.textures.empty()) continue;
    append_by_facet(values, geometry,
                    [&](const CityFacet& facet) { return texture_text(theme, facet, is_any); });
    add(textures);
  }
  if (!materials.empty()) out.append(",\"material\":{").append(materials).append("}");
  if (!textures.empty()) out.append(",\"texture\":{").append(textures).append("}");
}

Json GmlAppearance::take() {
  if (materials_.empty() && textures_.empty()) return nullptr;
  Json appearance = Json::object();
  if (!materials_.empty()) append_member(appearance, "materials", std::move(materials_));
  if (!textures_.empty()) append_member(appearance, "textures", std::move(textures_));
  if (!vertices_.empty()) append_member(appearance, "vertices-texture", std::move(vertices_));
  return appearance;
}

}  // namespace watertight::formats
