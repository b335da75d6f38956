// SPDX-License-Identifier: GPL-3.0-or-later
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include "base/quantity.h"
#include "formats/gml/city/city.h"

namespace watertight::formats {
namespace {

// For each solid of the city model the solid of the feature: those of one object follow one another
// in both. Nothing when the solids are not the same.
std::vector<std::size_t> matching_solids(const Feature& feature, const Feature& city) {
  if (feature.solids.size() != city.solids.size()) return {};
  std::map<std::string_view, std::vector<std::size_t>> of_object;  // in reverse order
  for (std::size_t i = feature.solids.size(); i-- > 0;) {
    of_object[feature.solids[i].source.object_id].push_back(i);
  }
  std::vector<std::size_t> numbers;
  for (const SubmittedSolid& solid : city.solids) {
    auto found = of_object.find(solid.source.object_id);
    // An object without gml:id has an id that was made up.
    if (found == of_object.end()) found = of_object.find("");
    if (found == of_object.end() || found->second.empty()) return {};
    numbers.push_back(found->second.back());
    found->second.pop_back();
    if (!(feature.solids[numbers.back()].solid == solid.solid)) return {};
  }
  return numbers;
}

bool adopt(Feature& feature, Feature& city) {
  const std::vector<std::size_t> numbers = matching_solids(feature, city);
  if (numbers.size() != feature.solids.size()) return false;
  std::vector<SubmittedSolid> solids;
  solids.reserve(numbers.size());
  for (const std::size_t number : numbers) solids.push_back(std::move(feature.solids[number]));
  feature.solids = std::move(solids);
  feature.skeleton = std::move(city.skeleton);
  return true;
}

}  // namespace

void keep_city_model(Document& document, ByteView bytes, const Limits& limits) {
  if (document.features.empty()) return;
  auto city = city_model_of_gml(bytes, limits, GroupMembers::alone);
  if (!city) {
    document.notes.push_back("only solids are kept: " + city.error().message);
    return;
  }
  std::map<std::string_view, Feature*> by_id;
  for (Feature& feature : city->model.features) by_id.emplace(feature.id, &feature);
  std::uint64_t others = 0;
  for (Feature& feature : document.features) {
    const auto found = by_id.find(feature.id);
    if (found == by_id.end() || !adopt(feature, *found->second)) ++others;
  }
  document.header = city->model.header;
  for (const GmlLoss& loss : city->losses) {
    std::string note = "not mapped: ";
    note.append(loss.path).append(" (").append(quantity(loss.count, "time")).append(")");
    document.notes.push_back(std::move(note));
  }
  if (others > 0) {
    document.notes.push_back(quantity(others, "feature keeps", "features keep")
                                 .append(" only solids: the city model has others"));
  }
}

}  // namespace watertight::formats
