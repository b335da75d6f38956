// SPDX-License-Identifier: GPL-3.0-or-later
#include "projection/projection.h"

#include <proj.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace watertight::projection {
namespace {

struct Destroy {
  void operator()(PJ_CONTEXT* context) const { proj_context_destroy(context); }
  void operator()(PJ* object) const { proj_destroy(object); }
};
using Context = std::unique_ptr<PJ_CONTEXT, Destroy>;
using Object = std::unique_ptr<PJ, Destroy>;

constexpr int kPointsOfAnEdge = 21;  // where the edges of a rectangle are followed

std::uint32_t code_of(System system) {
  // With EPSG's code PROJ takes EPSG's operations, as map programs do. Axes are put in order below.
  return system == System::longitude_latitude ? 4326 : 3857;
}

void be_silent(void* /*user*/, int /*level*/, const char* /*message*/) {}

/// PROJ as one thread uses it, with the transformations that were made so far.
class Library {
 public:
  Library() : context_(proj_context_create()) {
    proj_context_set_enable_network(context_.get(), 0);
    proj_log_func(context_.get(), nullptr, be_silent);
  }

  PJ_CONTEXT* context() const { return context_.get(); }

  /// The transformation from an EPSG system to another; null if there is none.
  PJ* find(std::uint32_t from, std::uint32_t to) {
    if (made_.size() >= kMostKept) made_.clear();
    const auto [place, is_new] = made_.try_emplace({from, to});
    if (is_new) place->second = make(from, to);
    return place->second.get();
  }

  /// From longitude, latitude and height to earth-centred coordinates.
  PJ* earth_centred() {
    if (!earth_centred_) {
      earth_centred_.reset(
          proj_create(context(),
                      "+proj=pipeline +step +proj=unitconvert +xy_in=deg +xy_out=rad "
                      "+step +proj=cart +ellps=WGS84"));
    }
    return earth_centred_.get();
  }

  bool is_north_first(std::uint32_t srid) {
    if (north_first_.size() >= kMostKept) north_first_.clear();
    const auto [place, is_new] = north_first_.try_emplace(srid, false);
    if (is_new) place->second = has_north_first(srid);
    return place->second;
  }

 private:
  static constexpr std::size_t kMostKept = 64;  // of each map; beyond it they start anew

  bool has_north_first(std::uint32_t srid) const {
    const Object crs = horizontal(srid);
    const Object axes(crs ? proj_crs_get_coordinate_system(context(), crs.get()) : nullptr);
    const char* direction = nullptr;
    return axes &&
           proj_cs_get_axis_info(context(), axes.get(), 0, nullptr, nullptr, &direction, nullptr,
                                 nullptr, nullptr, nullptr) != 0 &&
           direction != nullptr && std::string_view(direction) == "north";
  }

  /// The system on x and y alone.
  Object horizontal(std::uint32_t srid) const {
    const std::string code = std::to_string(srid);
    Object crs(
        proj_create_from_database(context(), "EPSG", code.c_str(), PJ_CATEGORY_CRS, 0, nullptr));
    if (crs && proj_get_type(crs.get()) == PJ_TYPE_COMPOUND_CRS) {
      crs.reset(proj_crs_get_sub_crs(context(), crs.get(), 0));
    }
    if (!crs) return nullptr;
    switch (proj_get_type(crs.get())) {
      case PJ_TYPE_GEOGRAPHIC_2D_CRS:
      case PJ_TYPE_GEOGRAPHIC_3D_CRS:
      case PJ_TYPE_PROJECTED_CRS:
        return crs;
      default:  // geocentric, vertical, local: no x and y that a map has
        return nullptr;
    }
  }

  Object make(std::uint32_t from, std::uint32_t to) const {
    const Object source = horizontal(from);
    const Object target = horizontal(to);
    if (!source || !target) return nullptr;
    const Object change(
        proj_create_crs_to_crs_from_pj(context(), source.get(), target.get(), nullptr, nullptr));
    if (!change) return nullptr;
    return Object(proj_normalize_for_visualization(context(), change.get()));
  }

  Context context_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, Object> made_;
  std::map<std::uint32_t, bool> north_first_;
  Object earth_centred_;
};

Library& library() {
  thread_local Library library;
  return library;
}

Error no_transformation(std::uint32_t from, std::uint32_t to) {
  return {ErrorCode::unsupported, "there is no transformation from EPSG:" + std::to_string(from) +
                                      " to EPSG:" + std::to_string(to)};
}

Error outside(std::uint32_t from, std::uint32_t to) {
  return {ErrorCode::unsupported, "a position has no place in both EPSG:" + std::to_string(from) +
                                      " and EPSG:" + std::to_string(to)};
}

Result<Rectangle> bounds(std::uint32_t srid, System system, PJ_DIRECTION direction,
                         const Rectangle& rectangle) {
  PJ* change = library().find(srid, code_of(system));
  if (change == nullptr) return no_transformation(srid, code_of(system));
  Rectangle result;
  const int is_done =
      proj_trans_bounds(library().context(), change, direction, rectangle.min[0], rectangle.min[1],
                        rectangle.max[0], rectangle.max[1], &result.min[0], &result.min[1],
                        &result.max[0], &result.max[1], kPointsOfAnEdge);
  proj_errno_reset(change);
  const bool is_finite = std::isfinite(result.min[0]) && std::isfinite(result.min[1]) &&
                         std::isfinite(result.max[0]) && std::isfinite(result.max[1]);
  if (is_done == 0 || !is_finite) return outside(srid, code_of(system));
  return result;
}

/// The places in the plane of positions, each once: those of a building stand above each other, and
/// most of the time is PROJ's.
struct Places {
  std::vector<std::array<double, 2>> distinct;
  std::vector<std::size_t> number_of;  // for each position

  explicit Places(std::span<const Position> positions) : number_of(positions.size()) {
    using Bits = std::array<std::uint64_t, 2>;  // they have an order, also where one is no number
    std::vector<std::pair<Bits, std::size_t>> order;
    order.reserve(positions.size());
    for (const auto& [x, y, z] : positions) {
      order.emplace_back(Bits{std::bit_cast<std::uint64_t>(x), std::bit_cast<std::uint64_t>(y)},
                         order.size());
    }
    std::sort(order.begin(), order.end());
    const Bits* last = nullptr;
    for (const auto& [bits, position] : order) {
      if (last == nullptr || *last != bits) {
        distinct.push_back({positions[position][0], positions[position][1]});
      }
      number_of[position] = distinct.size() - 1;
      last = &bits;
    }
  }
};

}  // namespace

Status transform(std::uint32_t srid, System system, std::span<Position> positions) {
  return transform_between(srid, code_of(system), positions);
}

Status transform_between(std::uint32_t from, std::uint32_t to, std::span<Position> positions) {
  if (positions.empty()) return Done{};
  PJ* change = library().find(from, to);
  if (change == nullptr) return no_transformation(from, to);
  Places places(positions);
  auto& first = places.distinct.front();
  const std::size_t count = places.distinct.size();
  proj_trans_generic(change, PJ_FWD, &first[0], sizeof(first), count, &first[1], sizeof(first),
                     count, nullptr, 0, 0, nullptr, 0, 0);
  proj_errno_reset(change);
  for (const auto& [x, y] : places.distinct) {
    if (!std::isfinite(x) || !std::isfinite(y)) return outside(from, to);
  }
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const auto& [x, y] = places.distinct[places.number_of[i]];
    positions[i] = {x, y, positions[i][2]};
  }
  return Done{};
}

void to_earth_centred(std::span<Position> positions) {
  if (positions.empty()) return;
  Position& first = positions.front();
  proj_trans_generic(library().earth_centred(), PJ_FWD, &first[0], sizeof(Position),
                     positions.size(), &first[1], sizeof(Position), positions.size(), &first[2],
                     sizeof(Position), positions.size(), nullptr, 0, 0);
}

bool is_north_first(std::uint32_t srid) { return library().is_north_first(srid); }

Result<SystemText> text_of(std::uint32_t srid) {
  PJ_CONTEXT* context = library().context();
  const Object crs(proj_create_from_database(context, "EPSG", std::to_string(srid).c_str(),
                                             PJ_CATEGORY_CRS, 0, nullptr));
  if (!crs) {
    return Error{ErrorCode::unsupported, "EPSG:" + std::to_string(srid) + " is not known"};
  }
  const auto text = [](const char* result) { return std::string(result == nullptr ? "" : result); };
  return SystemText{text(proj_get_name(crs.get())),
                    text(proj_as_wkt(context, crs.get(), PJ_WKT1_GDAL, nullptr)),
                    text(proj_as_wkt(context, crs.get(), PJ_WKT2_2019, nullptr))};
}

Result<Rectangle> bounds_of(std::uint32_t srid, System system, const Rectangle& rectangle) {
  return bounds(srid, system, PJ_FWD, rectangle);
}

Result<Rectangle> bounds_in(std::uint32_t srid, System system, const Rectangle& rectangle) {
  return bounds(srid, system, PJ_INV, rectangle);
}

}  // namespace watertight::projection
