// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/crs/crs.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/crs/crs_table.h"

namespace watertight::geometry {
namespace {

constexpr double kFoot = 0.3048;
constexpr double kUsSurveyFoot = 1200.0 / 3937.0;

std::optional<CrsUnit> unit_of(std::uint32_t srid) {
  const auto runs = crs_runs();
  const auto after =
      std::upper_bound(runs.begin(), runs.end(), srid,
                       [](std::uint32_t code, const CrsRun& run) { return code < run.first; });
  if (after == runs.begin() || srid > (after - 1)->last) return std::nullopt;
  return (after - 1)->unit;
}

/// Metres per unit of length, as the EPSG data set states them; 0 for angles.
double length_of(CrsUnit unit) {
  switch (unit) {
    case CrsUnit::metre:
      return 1.0;
    case CrsUnit::us_survey_foot:
      return kUsSurveyFoot;
    case CrsUnit::foot:
      return kFoot;
    case CrsUnit::kilometre:
      return 1000.0;
    case CrsUnit::german_legal_metre:
      return 1.0000135965;
    case CrsUnit::indian_yard:
      return 36.0 / 39.370142;
    case CrsUnit::clarke_foot:
      return 0.3047972654;
    case CrsUnit::clarke_link:
      return 0.201166195164;
    case CrsUnit::clarke_yard:
      return 0.9143917962;
    case CrsUnit::gold_coast_foot:
      return 6378300.0 / 20926201.0;
    case CrsUnit::link:
      return 0.201168;
    case CrsUnit::sears_yard:
      return 36.0 / 39.370147;
    case CrsUnit::sears_foot:
      return 12.0 / 39.370147;
    case CrsUnit::sears_chain:
      return 792.0 / 39.370147;
    case CrsUnit::sears_chain_truncated:
      return 20.116756;
    case CrsUnit::benoit_chain:
      return 792.0 / 39.370113;
    case CrsUnit::degree:
    case CrsUnit::degree_foot:
    case CrsUnit::degree_us_survey_foot:
    case CrsUnit::grad:
      return 0.0;
  }
  return 1.0;
}

/// A full turn in the unit of an angle: 400 grads or 360 degrees.
double full_turn_of(CrsUnit angle) { return angle == CrsUnit::grad ? 400.0 : 360.0; }

/// Runs {first, last}, inclusive, of the EPSG codes of geographic systems whose first axis is
/// longitude.
constexpr std::array<std::array<std::uint32_t, 2>, 6> kLongitudeFirst{
    {{7034, 7042}, {7084, 7088}, {7133, 7133}, {8901, 8902}, {9778, 9779}, {9783, 9784}}};

double height_unit_of(CrsUnit angle) {
  if (angle == CrsUnit::degree_foot) return kFoot;
  return angle == CrsUnit::degree_us_survey_foot ? kUsSurveyFoot : 1.0;
}

/// Metres per degree of longitude and of latitude on the WGS 84 ellipsoid.
struct DegreeLengths {
  double longitude = 0;
  double latitude = 0;
};

DegreeLengths degree_lengths(double latitude_degrees) {
  constexpr double kSemiMajorAxis = 6378137.0;               // of WGS 84, in metres
  constexpr double kEccentricitySquared = 6.69437999014e-3;  // of WGS 84
  constexpr double kRadians = 0.017453292519943295;          // radians per degree
  constexpr double kNearPole = 89.9;  // degrees; beyond, a degree of longitude has hardly a length
  const double latitude = std::clamp(latitude_degrees, -kNearPole, kNearPole) * kRadians;
  const double sine = std::sin(latitude);
  const double w = 1 - kEccentricitySquared * sine * sine;
  return {kSemiMajorAxis * std::cos(latitude) / std::sqrt(w) * kRadians,
          kSemiMajorAxis * (1 - kEccentricitySquared) / (w * std::sqrt(w)) * kRadians};
}

AxisUnits angular_units(std::uint32_t srid, CrsUnit unit, const std::array<double, 3>& centre) {
  const double degrees = unit == CrsUnit::grad ? 0.9 : 1.0;
  const double largest = full_turn_of(unit);
  if (!(std::abs(centre[0]) <= largest) || !(std::abs(centre[1]) <= largest)) {
    return {{1, 1, 1},
            "EPSG:" + std::to_string(srid) +
                " is geographic, but the coordinates cannot be angles: metres assumed"};
  }
  const bool is_latitude_first =
      std::abs(centre[1]) * degrees > 90 && std::abs(centre[0]) * degrees <= 90;
  const DegreeLengths lengths = degree_lengths(degrees * centre[is_latitude_first ? 0 : 1]);
  AxisUnits units;
  units.metres_per_unit = {degrees * lengths.longitude, degrees * lengths.latitude,
                           height_unit_of(unit)};
  if (is_latitude_first) std::swap(units.metres_per_unit[0], units.metres_per_unit[1]);
  units.note = "EPSG:" + std::to_string(srid) +
               " is geographic: metres per degree at the centre, " +
               (is_latitude_first ? "latitude first" : "longitude first");
  return units;
}

}  // namespace

AxisUnits axis_units(std::uint32_t srid, const std::array<double, 3>& centre) {
  if (srid == 0) return {{1, 1, 1}, "no coordinate reference system stated: metres assumed"};
  const auto unit = unit_of(srid);
  if (!unit) {
    return {{1, 1, 1}, "EPSG:" + std::to_string(srid) + " is not known: metres assumed"};
  }
  const double length = length_of(*unit);
  if (length == 0) return angular_units(srid, *unit, centre);
  AxisUnits units;
  units.metres_per_unit = {length, length, length};
  if (*unit != CrsUnit::metre) {
    units.note = "EPSG:" + std::to_string(srid) + " has axes in units of " +
                 std::to_string(length) + " metres; heights taken in the same unit";
  }
  return units;
}

double largest_angle(std::uint32_t srid) {
  const auto unit = unit_of(srid);
  return unit && length_of(*unit) == 0 ? full_turn_of(*unit) : 0.0;
}

double pole_of_first_axis(std::uint32_t srid) {
  const auto unit = unit_of(srid);
  if (!unit || length_of(*unit) != 0) return 0;
  for (const auto& [first, last] : kLongitudeFirst) {
    if (srid >= first && srid <= last) return 0;
  }
  return *unit == CrsUnit::grad ? 100 : 90;
}

}  // namespace watertight::geometry
