// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/gml/city/city.h"

#include <algorithm>
#include <map>
#include <utility>

#include "base/quantity.h"
#include "formats/city_json/city_json.h"
#include "formats/gml/city/appearance.h"
#include "formats/gml/city/objects.h"
#include "formats/gml/city/tree.h"
#include "formats/gml/city/writer.h"
#include "formats/gml/elements.h"

namespace watertight::formats {
namespace {

// The deepest nesting of the CityJSON: the XML's, with a few levels of CityJSON around it.
constexpr std::uint32_t kNestingAround = 64;

constexpr std::size_t kLongestId = 1024;  // bytes, as for read_gml()

// Paths in the list of losses stay short, and are not too many, whatever the names are.
constexpr std::size_t kLongestName = 80;
constexpr std::size_t kMostNames = 4;
constexpr std::size_t kMostPaths = 10'000;
constexpr std::string_view kOtherPaths = "(other elements)";

// Attributes whose meaning is in what was read, or that say nothing about the city.
bool is_said_otherwise(const GmlTree& tree, Index attribute) {
  const std::string_view space = tree.attribute_space(attribute);
  const std::string_view name = tree.attribute_name(attribute);
  if (space == "http://www.w3.org/2001/XMLSchema-instance") return true;
  if (space == kXlinkSpace) return name != "href";
  return space.empty() && (name == "srsName" || name == "srsDimension" || name == "orientation" ||
                           name == "axisLabels" || name == "uomLabels" || name == "decimal" ||
                           name == "cs" || name == "ts");
}

// The name, or its beginning and "..." when it is long.
std::string short_name(std::string_view name) {
  if (name.size() <= kLongestName) return std::string(name);
  std::size_t end = kLongestName;
  while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xC0U) == 0x80U) --end;
  return std::string(name.substr(0, end)).append("...");
}

// The element with those around it up to the nearest object, and with the object that it holds:
// "Building/lod2TerrainIntersection", "CityModel/versionMember/Version".
std::string path_of(const GmlTree& tree, Index element) {
  std::vector<std::string_view> names{tree.name(element)};
  for (Index i = tree[element].parent; i != kNone; i = tree[i].parent) {
    names.push_back(tree.name(i));
    if (is_object_name(names.back())) break;
  }
  std::string path = short_name(names.back());
  if (names.size() > kMostNames) path.append("/...");
  for (std::size_t i = std::min(names.size() - 1, kMostNames - 1); i-- > 0;) {
    path.append("/").append(short_name(names[i]));
  }
  const Index held = tree[element].first_child;
  const bool holds_object = held != kNone && tree[held].next == kNone && !tree.is_gml(held) &&
                            is_object_name(tree.name(held)) && !is_object_name(tree.name(element));
  if (holds_object) path.append("/").append(short_name(tree.name(held)));
  return path;
}

// Refuses XML that is not GML, and ids of which many copies would be made.
Status check_gml(const GmlTree& tree) {
  bool is_of_ogc = false;
  for (Index i = 0; i < tree.elements().size(); ++i) {
    const std::string_view id = tree.id(i);
    is_of_ogc = is_of_ogc || !id.empty() || tree.space(i).starts_with("http://www.opengis.net/");
    if (id.size() > kLongestId) {
      return error_at(tree[i].place, ErrorCode::limit_exceeded,
                      "a gml:id of more than " + std::to_string(kLongestId) + " bytes");
    }
  }
  if (is_of_ogc || tree.elements().empty()) return Done{};
  std::string text = "not GML: the root element is '";
  text.append(tree.name(0));
  return error_at(tree[0].place, ErrorCode::malformed,
                  text.append("', and nothing is in a namespace http://www.opengis.net/..."));
}

// Whether the text of an element was read if the element was: not beside children or a reference,
// and of GML only in coordinates.
bool goes_with_element(const GmlTree& tree, Index element) {
  if (tree[element].first_child != kNone || !tree.href(element).empty()) return false;
  if (!tree.is_gml(element)) return true;
  const std::string_view name = tree.name(element);
  return name == "pos" || name == "posList" || name == "coordinates" || name == "lowerCorner" ||
         name == "upperCorner";
}

// Counts what has no mark: the outermost elements of which nothing was read, and attributes.
std::vector<GmlLoss> losses_of(const GmlTree& tree, const TreeMarks& marks) {
  const auto& elements = tree.elements();
  std::vector<bool> is_used(elements.size(), false);  // the element, or one below it, has a mark
  for (std::size_t i = elements.size(); i-- > 0;) {
    if (marks.is_marked(static_cast<Index>(i))) is_used[i] = true;
    if (is_used[i] && elements[i].parent != kNone) is_used[elements[i].parent] = true;
  }
  std::map<std::string, std::uint64_t> counts;
  const auto count = [&](std::string path) {
    if (counts.size() >= kMostPaths && !counts.contains(path)) path = kOtherPaths;
    ++counts[path];
  };
  for (Index i = 0; i < elements.size(); ++i) {
    const bool is_below_used = elements[i].parent == kNone || is_used[elements[i].parent];
    if (!is_used[i]) {
      if (is_below_used) count(path_of(tree, i));
      continue;
    }
    if (marks.is_lost(i)) count(path_of(tree, i));
    if (!goes_with_element(tree, i) && !marks.is_text_marked(i) && !tree.text(i).empty()) {
      count(short_name(tree.name(i)).append("/text()"));
    }
    const Index end = elements[i].first_attribute + elements[i].attribute_count;
    for (Index k = elements[i].first_attribute; k < end; ++k) {
      if (marks.is_attribute_marked(k) || is_said_otherwise(tree, k)) continue;
      std::string path = short_name(tree.name(i));
      const bool is_id = tree.attribute_name(k) == "id" && is_gml_space(tree.attribute_space(k));
      path.append(is_id ? "/@gml:" : "/@").append(short_name(tree.attribute_name(k)));
      count(std::move(path));
    }
  }
  std::vector<GmlLoss> losses;
  for (const auto& [path, number] : counts) losses.push_back({path, number});
  return losses;
}

// Reads the city model on the finest grid that holds its coordinates.
Result<Document> city_model_of(const CityWriter& writer, const Limits& limits) {
  ReadOptions options;
  options.limits = limits;
  options.limits.bytes = ~0ULL;
  options.limits.nesting = limits.nesting + kNestingAround;
  for (const GridChoice choice : {GridChoice::common, GridChoice::by_axis, GridChoice::rounded}) {
    const auto text = writer.text(choice);
    if (!text && choice != GridChoice::rounded) continue;
    if (!text) return text.error();
    auto model = read_city_json(*text, options);
    const bool is_too_fine = !model && model.error().code == ErrorCode::limit_exceeded;
    if (is_too_fine && choice != GridChoice::rounded) continue;
    if (!model) return model;
    if (const std::uint64_t count = writer.count_rounded(choice); count > 0) {
      model->notes.push_back(quantity(count, "coordinate was", "coordinates were")
                                 .append(" rounded to the finest grid of 2^53 steps"));
    }
    return model;
  }
  return Error{ErrorCode::unsupported, "no grid holds the coordinates"};
}

}  // namespace

Result<GmlCityModel> city_model_of_gml(ByteView bytes, const Limits& limits, GroupMembers members) {
  const auto tree = GmlTree::read(bytes, limits);
  if (!tree) return tree.error();
  if (auto status = check_gml(*tree); !status) return std::move(status).error();
  TreeMarks marks(*tree);
  GeometryReader geometry(*tree, bytes.size(), limits);
  auto objects = ObjectReader(*tree, marks, geometry, members).read();
  if (!objects) return std::move(objects).error();
  GmlAppearance appearance(*tree, marks, geometry);
  for (const Index element : objects->appearances) appearance.read(element);
  CityWriter writer(*tree, marks, *objects, geometry, appearance);
  const std::uint64_t most_surface_bytes = 16 * bytes.size() + (1U << 20U);
  if (auto status = writer.prepare(most_surface_bytes); !status) return std::move(status).error();
  auto model = city_model_of(writer, limits);
  if (!model) return std::move(model).error();
  GmlCityModel result{std::move(*model), losses_of(*tree, marks)};
  auto& notes = result.model.notes;
  for (std::string& note : geometry.notes()) notes.push_back(std::move(note));
  for (std::string& note : objects->notes) notes.push_back(std::move(note));
  for (const GmlLoss& loss : result.losses) {
    std::string note = "not mapped: ";
    note.append(loss.path).append(" (").append(quantity(loss.count, "time")).append(")");
    notes.push_back(std::move(note));
  }
  return result;
}

}  // namespace watertight::formats
