// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/city_json/merge_headers.h"

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "formats/city_json/model.h"
#include "formats/text/numbers.h"

namespace watertight::formats {
namespace {

__extension__ using Wide = __int128;

constexpr std::int64_t kFinest = std::int64_t{1} << 20;          // steps to a scale
constexpr std::int64_t kFarthest = std::int64_t{1} << 52;        // steps between translations
constexpr std::int64_t kMostMantissa = 999'999'999'999'999'999;  // 18 digits
constexpr int kMostShift = 18;                                   // decimal places

/// A decimal as a whole number of 10^exponent; nullopt when that has too many digits.
std::optional<Wide> wide(const GridNumber& number, std::int32_t exponent) {
  if (number.mantissa == 0) return Wide{0};
  if (number.exponent < exponent || number.exponent - exponent > kMostShift) return std::nullopt;
  Wide value = number.mantissa;
  for (std::int32_t i = exponent; i < number.exponent; ++i) value *= 10;
  return value;
}

Wide greatest_divisor(Wide a, Wide b) {
  while (b != 0) a = std::exchange(b, a % b);
  return a < 0 ? -a : a;
}

/// The normalized decimal value * 10^exponent; nullopt when it has more than 18 digits.
std::optional<GridNumber> decimal(Wide value, std::int32_t exponent) {
  while (value != 0 && value % 10 == 0) {
    value /= 10;
    ++exponent;
  }
  if (value > kMostMantissa || value < -kMostMantissa) return std::nullopt;
  if (value == 0) return GridNumber{};
  return GridNumber{static_cast<std::int64_t>(value), exponent};
}

/// Scale and translation of one axis, or two of each, as whole numbers of one power of ten.
struct AxisGrid {
  std::int32_t exponent = 0;
  Wide scale = 0;
  Wide translate = 0;
  Wide other_scale = 0;
  Wide other_translate = 0;
};

std::optional<AxisGrid> axis_grid(const geometry::Transform& a, const geometry::Transform& b,
                                  std::size_t axis) {
  AxisGrid grid;
  grid.exponent = a.scale[axis].exponent;
  for (const GridNumber& number : {b.scale[axis], a.translate[axis], b.translate[axis]}) {
    if (number.mantissa != 0) grid.exponent = std::min(grid.exponent, number.exponent);
  }
  const auto scale = wide(a.scale[axis], grid.exponent);
  const auto translate = wide(a.translate[axis], grid.exponent);
  const auto other_scale = wide(b.scale[axis], grid.exponent);
  const auto other_translate = wide(b.translate[axis], grid.exponent);
  if (!scale || !translate || !other_scale || !other_translate) return std::nullopt;
  grid.scale = *scale;
  grid.translate = *translate;
  grid.other_scale = *other_scale;
  grid.other_translate = *other_translate;
  return grid;
}

/// The coarsest transform with the translation of `first` whose grid holds those of both; nullopt
/// when decimals of 18 digits do not say it.
std::optional<geometry::Transform> common_transform(const geometry::Transform& first,
                                                    const geometry::Transform& other) {
  geometry::Transform common = first;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto grid = axis_grid(first, other, axis);
    if (!grid) return std::nullopt;
    const Wide step = greatest_divisor(greatest_divisor(grid->scale, grid->other_scale),
                                       grid->translate - grid->other_translate);
    const auto scale = decimal(step, grid->exponent);
    if (!scale) return std::nullopt;
    common.scale[axis] = *scale;
  }
  return common;
}

/// The map from vertices under `source` to those under `target`, whose grid holds that of `source`;
/// nullopt when the numbers become too large.
std::optional<VertexMap> map_between(const geometry::Transform& source,
                                     const geometry::Transform& target) {
  VertexMap map;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto grid = axis_grid(target, source, axis);
    if (!grid) return std::nullopt;
    const Wide distance = grid->other_translate - grid->translate;
    if (grid->other_scale % grid->scale != 0 || distance % grid->scale != 0) return std::nullopt;
    const Wide factor = grid->other_scale / grid->scale;
    const Wide shift = distance / grid->scale;
    if (factor > kFinest || shift > kFarthest || shift < -kFarthest) return std::nullopt;
    map.factor[axis] = static_cast<std::int64_t>(factor);
    map.shift[axis] = static_cast<std::int64_t>(shift);
  }
  return map;
}

bool are_equal(const Json* a, const Json* b) {
  if (a == nullptr || b == nullptr) return a == b;
  return *a == *b;
}

/// A member's member; null if there is none.
const Json* find_path(const Json& root, std::string_view key, std::string_view inner) {
  const Json* member = find_member(root, key);
  return member == nullptr ? nullptr : find_member(*member, inner);
}

/// The number of a JSON value, rounded; nullopt for another value.
std::optional<double> number_of(const Json& value) {
  if (!is_number_value(value)) return std::nullopt;
  const auto exact = exact_number(json_text(value));
  if (!exact) return std::nullopt;
  return geometry::rounded(exact->value);
}

/// The union of two extents, with the digits of the numbers; nullopt if one of them is none.
std::optional<Json> united(const Json& a, const Json& b) {
  constexpr std::size_t kNumbers = 6;
  if (!a.is_array() || !b.is_array() || a.size() != kNumbers || b.size() != kNumbers) {
    return std::nullopt;
  }
  Json both = a;
  for (std::size_t i = 0; i < kNumbers; ++i) {
    const auto first = number_of(a[i]);
    const auto second = number_of(b[i]);
    if (!first || !second) return std::nullopt;
    const bool is_minimum = i < 3;
    if (is_minimum ? *second < *first : *second > *first) both[i] = b[i];
  }
  return both;
}

/// Headers that share one, in the making.
class HeaderGroup {
 public:
  HeaderGroup(std::string text, Json root, const CityHeader& header, std::size_t number,
              std::string reason)
      : root_(std::move(root)), common_(*header.transform), srid_(header.srid) {
    shared_.reason = std::move(reason);
    shared_.text = std::move(text);
    shared_.members.push_back(number);
    transforms_.push_back(*header.transform);
  }

  /// Takes one more header; else says why not.
  std::string add(const Json& root, const CityHeader& header, std::size_t number) {
    if (std::string reason = difference(root, header); !reason.empty()) return reason;
    const auto common = common_transform(common_, *header.transform);
    if (!common || !fits(*common, *header.transform)) {
      return "no common grid of decimals holds the coordinates under both transforms";
    }
    common_ = *common;
    shared_.members.push_back(number);
    transforms_.push_back(*header.transform);
    merge(root);
    return {};
  }

  SharedHeader finish() && {
    for (const geometry::Transform& transform : transforms_) {
      shared_.maps.push_back(map_between(transform, common_).value_or(VertexMap{}));
    }
    shared_.losses.assign(lost_.begin(), lost_.end());
    if (shared_.members.size() > 1) {
      set_transform();
      shared_.text = json_text(root_);
    }
    return std::move(shared_);
  }

 private:
  std::string difference(const Json& root, const CityHeader& header) const {
    for (const char* key : {"version", "appearance", "geometry-templates"}) {
      if (!are_equal(find_member(root_, key), find_member(root, key))) {
        return std::string("another ") + key;
      }
    }
    const bool is_same_system =
        srid_ == header.srid &&
        (srid_ != 0 || are_equal(find_path(root_, "metadata", "referenceSystem"),
                                 find_path(root, "metadata", "referenceSystem")));
    if (!is_same_system) return "another reference system";
    const Json* extensions = find_member(root, "extensions");
    if (extensions == nullptr || !extensions->is_object()) return {};
    for (const auto& [name, extension] : extensions->get_ref<const Json::object_t&>()) {
      const Json* known = find_path(root_, "extensions", name);
      if (known != nullptr && *known != extension) {
        return "another definition of the extension " + name;
      }
    }
    return {};
  }

  /// Whether the grid of a transform takes the vertices of all members and of one more.
  bool fits(const geometry::Transform& common, const geometry::Transform& added) const {
    if (!map_between(added, common)) return false;
    if (common == common_) return true;
    return std::all_of(
        transforms_.begin(), transforms_.end(),
        [&](const geometry::Transform& member) { return map_between(member, common); });
  }

  void merge(const Json& root) {
    static const std::set<std::string_view> kDone{
        "type",       "version",    "transform", "vertices",          "CityObjects",
        "appearance", "extensions", "metadata",  "geometry-templates"};
    merge_members(root_, root, "", kDone);
    if (const Json* extensions = find_member(root, "extensions");
        extensions != nullptr && extensions->is_object()) {
      add_extensions(*extensions);
    }
    const Json nothing = Json::object();
    const Json* metadata = find_member(root, "metadata");
    Json* own = find_member(root_, "metadata");
    if (metadata == nullptr || !metadata->is_object()) metadata = &nothing;
    if (own == nullptr || !own->is_object()) {
      Json none = Json::object();
      merge_members(none, *metadata, "metadata/", {"referenceSystem"});
      return;
    }
    merge_members(*own, *metadata, "metadata/", {"referenceSystem"});
  }

  /// Leaves those members of an object that another one has too, but for members named in `kept`.
  void merge_members(Json& own, const Json& other, const std::string& path,
                     const std::set<std::string_view>& kept) {
    std::vector<std::string> unequal;
    for (auto& [key, value] : own.get_ref<Json::object_t&>()) {
      if (kept.contains(key)) continue;
      const Json* equal = find_member(other, key);
      if (equal != nullptr && *equal == value) continue;
      const auto both =
          key == "geographicalExtent" && equal != nullptr ? united(value, *equal) : std::nullopt;
      if (both) {
        value = *both;
      } else {
        unequal.push_back(key);
      }
    }
    for (const std::string& key : unequal) {
      own.erase(key);
      lost_.insert(path + key);
    }
    for (const auto& [key, value] : other.get_ref<const Json::object_t&>()) {
      if (!kept.contains(key) && find_member(std::as_const(own), key) == nullptr) {
        lost_.insert(path + key);
      }
    }
  }

  void add_extensions(const Json& extensions) {
    Json* own = find_member(root_, "extensions");
    if (own == nullptr || !own->is_object()) {
      if (own != nullptr) root_.erase("extensions");
      append_member(root_, "extensions", extensions);
      return;
    }
    for (const auto& [name, extension] : extensions.get_ref<const Json::object_t&>()) {
      if (find_member(std::as_const(*own), name) == nullptr) append_member(*own, name, extension);
    }
  }

  void set_transform() {
    if (common_ == transforms_.front()) return;
    Json scale = Json::array();
    for (const GridNumber& number : common_.scale) {
      const std::string text = plain_text(number);
      scale.push_back(number_value(geometry::rounded(number), text));
    }
    Json* transform = find_member(root_, "transform");
    *find_member(*transform, "scale") = std::move(scale);
  }

  Json root_;
  geometry::Transform common_;
  std::uint32_t srid_;
  std::vector<geometry::Transform> transforms_;  // of the members
  std::set<std::string> lost_;
  SharedHeader shared_;
};

}  // namespace

Result<std::vector<SharedHeader>> merge_headers(std::span<const std::string> headers) {
  std::vector<HeaderGroup> groups;
  for (std::size_t i = 0; i < headers.size(); ++i) {
    auto header = read_city_json_header(headers[i], kOwnText);
    if (!header) return std::move(header).error();
    if (!header->transform) {
      return Error{ErrorCode::unsupported,
                   "a CityJSONSeq needs a transform and this city model has none"};
    }
    auto root = parse_json(headers[i], kOwnText);
    if (!root) return std::move(root).error();
    std::string reason;
    const bool is_taken = std::any_of(groups.begin(), groups.end(), [&](HeaderGroup& group) {
      std::string difference = group.add(*root, *header, i);
      if (reason.empty()) reason = difference;
      return difference.empty();
    });
    if (!is_taken) {
      groups.emplace_back(headers[i], *std::move(root), *header, i, std::move(reason));
    }
  }
  std::vector<SharedHeader> shared;
  shared.reserve(groups.size());
  for (HeaderGroup& group : groups) shared.push_back(std::move(group).finish());
  return shared;
}

}  // namespace watertight::formats
