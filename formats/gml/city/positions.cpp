// SPDX-License-Identifier: GPL-3.0-or-later
//
// The positions of GeometryReader: their texts, reference systems and order of axes.
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/quantity.h"
#include "formats/gml/city/geometry.h"
#include "formats/gml/elements.h"
#include "formats/gml/gml.h"
#include "formats/text/numbers.h"
#include "geometry/crs/crs.h"

namespace watertight::formats {
namespace {

double pole_of(std::string_view system) {
  return is_in_order_of_authority(system)
             ? watertight::geometry::pole_of_first_axis(srid_of_srs_name(system))
             : 0;
}

}  // namespace

Status GeometryReader::note_system(std::string_view system, Index element) {
  if (system.empty()) return Done{};
  if (system_of_feature_.empty()) {
    system_of_feature_ = system;
    systems_.insert(system);
  }
  if (system == system_of_feature_) return Done{};
  const std::uint32_t srid = srid_of_srs_name(system);
  if (srid != 0 && srid == srid_of_srs_name(system_of_feature_) &&
      pole_of(system) == pole_of(system_of_feature_)) {
    return Done{};
  }
  std::string text = "geometry in '";
  text.append(system).append("' beside geometry in '").append(system_of_feature_).append("'");
  return wrong(element, ErrorCode::unsupported, text);
}

bool GeometryReader::is_latitude_first(Index element) const {
  return pole_of(contexts_[element].system) != 0;
}

Status GeometryReader::read_positions(Index element, std::vector<Index>& out) {
  result_.elements.push_back(element);
  if (auto status = note_system(contexts_[element].system, element); !status) return status;
  for (Index i = tree_[element].first_child; i != kNone; i = tree_[i].next) {
    const std::string_view name = tree_.name(i);
    if (!tree_.is_gml(i) || is_remark(name)) continue;
    Status status = Done{};
    if (name == "pos" || name == "posList" || name == "coordinates") {
      status = read_numbers(i, out);
    } else if (name == "pointProperty" || name == "pointRep") {
      const Index point = tree_.child(i, "Point");
      const Index position = point == kNone ? kNone : tree_.child(point, "pos");
      if (position == kNone)
        return wrong(i, ErrorCode::unsupported, "a Point with pos is expected");
      result_.elements.push_back(i);
      result_.elements.push_back(point);
      status = read_numbers(position, out);
    } else {
      return wrong(i, ErrorCode::unsupported, "not read among positions");
    }
    if (!status) return status;
  }
  return Done{};
}

Status GeometryReader::read_numbers(Index element, std::vector<Index>& out) {
  result_.elements.push_back(element);
  const Context& context = contexts_[element];
  if (context.dimension != 0 && context.dimension != 3) {
    return wrong(element, ErrorCode::unsupported, "two-dimensional positions are not read");
  }
  std::string rewritten;
  std::string_view text = tree_.text(element);
  if (tree_.name(element) == "coordinates") {
    // "1,5;2,5;3 4;5;6" with decimal "," and cs ";" becomes "1.5 2.5 3 4 5 6".
    const auto sign = [&](std::string_view attribute, char usual) {
      const Index found = tree_.find_attribute(element, "", attribute);
      const std::string_view value = found == kNone ? "" : tree_.attribute_value(found);
      return value.size() == 1 ? value.front() : usual;
    };
    const char decimal = sign("decimal", '.');
    const char between_numbers = sign("cs", ',');
    const char between_positions = sign("ts", ' ');
    rewritten = text;
    for (char& c : rewritten) {
      if (c == between_numbers || c == between_positions) {
        c = ' ';
      } else if (c == decimal) {
        c = '.';
      }
    }
    text = rewritten;
  }
  while (true) {
    std::array<std::string_view, 3> words;
    words[0] = take_word(text);
    if (words[0].empty()) return Done{};
    words[1] = take_word(text);
    words[2] = take_word(text);
    if (words[2].empty()) {
      return wrong(element, ErrorCode::unsupported,
                   "positions of other than three numbers are not read");
    }
    if (auto status = add_position(words, element, out); !status) return status;
  }
}

Status GeometryReader::add_position(const std::array<std::string_view, 3>& words, Index element,
                                    std::vector<Index>& out) {
  if (auto status = spend(1, element); !status) return status;
  if (positions_.size() >= kNone - 1) {
    return wrong(element, ErrorCode::limit_exceeded, "more positions than the limit");
  }
  std::array<GridNumber, 3> position;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto exact = exact_number(words[axis]);
    if (!exact) {
      return wrong(element, exact.error().code,
                   std::string("a coordinate: ").append(exact.error().message));
    }
    position[axis] = exact->value;
    if (exact->is_rounded) ++rounded_;
  }
  out.push_back(static_cast<Index>(positions_.size()));
  positions_.push_back(position);
  return Done{};
}

void GeometryReader::end_feature() {
  const std::string_view system = system_of_feature_;
  const double pole = system.empty() ? 0 : pole_of(system);
  const auto begin = positions_.begin() + static_cast<std::ptrdiff_t>(first_of_feature_);
  const auto can_be_latitude = [&](const std::array<GridNumber, 3>& position) {
    const double size = std::abs(static_cast<double>(position[0].mantissa));
    return size * std::pow(10.0, position[0].exponent) <= pole;
  };
  if (pole != 0 && begin != positions_.end()) {
    if (std::all_of(begin, positions_.end(), can_be_latitude)) {
      latitude_first_.insert(system);
      std::for_each(begin, positions_.end(),
                    [](std::array<GridNumber, 3>& p) { std::swap(p[0], p[1]); });
    } else {
      wrongly_ordered_.insert(system);
    }
  }
  first_of_feature_ = positions_.size();
  system_of_feature_ = {};
}

Result<std::uint32_t> GeometryReader::srid() const {
  std::uint32_t srid = 0;
  for (const std::string_view system : systems_) {
    const std::uint32_t own = srid_of_srs_name(system);
    if (srid != 0 && own != 0 && own != srid) {
      return Error{ErrorCode::unsupported, "a CityJSON has one reference system, not several"};
    }
    if (own != 0) srid = own;
  }
  return srid;
}

std::vector<std::string> GeometryReader::notes() const {
  std::vector<std::string> notes;
  for (const std::string_view system : systems_) {
    const std::uint32_t srid = srid_of_srs_name(system);
    std::string text = "reference system '";
    text.append(system);
    if (srid == 0) {
      notes.push_back(text.append("' has no known EPSG code"));
    } else if (system.find(',') != std::string_view::npos || system.find('*') != system.npos) {
      notes.push_back(text.append("' is written as EPSG:")
                          .append(std::to_string(srid))
                          .append(", without its vertical part"));
    }
  }
  for (const std::string_view system : latitude_first_) {
    notes.push_back(std::string("positions in '")
                        .append(system)
                        .append("' are latitude, longitude; written as longitude, latitude"));
  }
  for (const std::string_view system : wrongly_ordered_) {
    notes.push_back(std::string("positions in '")
                        .append(system)
                        .append("' should be latitude, longitude, but some begin beyond the poles; "
                                "kept in the order "
                                "written"));
  }
  if (rounded_ > 0) {
    notes.push_back(quantity(rounded_, "coordinate was", "coordinates were").append(" rounded"));
  }
  if (unclosed_ > 0) {
    notes.push_back(quantity(unclosed_, "ring that does", "rings that do")
                        .append(" not end where they begin; rings of CityJSON always do"));
  }
  return notes;
}

}  // namespace watertight::formats
