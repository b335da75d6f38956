// SPDX-License-Identifier: GPL-3.0-or-later
#include "surfaces/invert_point.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace watertight::surfaces {
namespace {

constexpr std::size_t kNet = 4;           // points of the net along a side of a patch
constexpr std::size_t kManyPatches = 64;  // above them the net has a quarter of the points
constexpr std::size_t kTries = 6;         // points of the net from which the search starts
constexpr int kMostApproachSteps = 50;
constexpr int kMostApproachHalvings = 20;
constexpr double kAsFar = 2;          // times the gap of other points: not worth another search
constexpr double kSmallStep = 1e-14;  // of the coordinates: no progress

}  // namespace

Inverter::Inverter(const Surface& surface, double tolerance)
    : surface_(surface), tolerance_(tolerance), poles_(poles_of(surface)) {
  const std::size_t count = surface.patches.size() > kManyPatches ? kNet / 2 : kNet;
  for (std::size_t k = 0; k + 1 < surface.v_breaks.size(); ++k) {
    for (std::size_t i = 0; i + 1 < surface.u_breaks.size(); ++i) {
      for (std::size_t part = 0; part < count * count; ++part) {
        const auto share = [&](std::size_t at) {
          return (static_cast<double>(at) + 0.5) / static_cast<double>(count);
        };
        const double u = surface.u_breaks[i] +
                         share(part % count) * (surface.u_breaks[i + 1] - surface.u_breaks[i]);
        const double v = surface.v_breaks[k] +
                         share(part / count) * (surface.v_breaks[k + 1] - surface.v_breaks[k]);
        net_.push_back({{u, v}, point_at(surface, {u, v}).place});
      }
    }
  }
}

Parameters Inverter::within(Parameters at) const {
  for (const int direction : {0, 1}) {
    const auto axis = static_cast<std::size_t>(direction);
    if (surface_.is_closed[axis]) continue;
    const std::vector<double>& breaks = surface_.breaks(direction);
    if (!surface_.is_endless[axis]) {
      at[axis] = std::clamp(at[axis], breaks.front(), breaks.back());
    }
    for (const Pole& pole : poles_) {  // an endless cone ends at its tip
      if (pole.direction != direction) continue;
      at[axis] = pole.is_upper ? std::min(at[axis], pole.at) : std::max(at[axis], pole.at);
    }
  }
  return at;
}

Inverted Inverter::approach(const Vector3& place, Parameters from) const {
  Parameters at = within(from);
  SurfacePoint point = point_at(surface_, at);
  Vector3 rest = place - point.place;
  double distance = dot(rest, rest);
  for (int step = 0; step < kMostApproachSteps && distance > 0; ++step) {
    const double uu = dot(point.along_u, point.along_u);
    const double uv = dot(point.along_u, point.along_v);
    const double vv = dot(point.along_v, point.along_v);
    const double u = dot(point.along_u, rest);
    const double v = dot(point.along_v, rest);
    const double determinant = uu * vv - uv * uv;
    Parameters change{uu > 0 ? u / uu : 0, vv > 0 ? v / vv : 0};
    if (determinant > 1e-12 * uu * vv) {
      change = {(u * vv - v * uv) / determinant, (v * uu - u * uv) / determinant};
    }
    bool is_nearer = false;
    for (int halving = 0; halving < kMostApproachHalvings && !is_nearer; ++halving) {
      const Parameters next = within({at[0] + change[0], at[1] + change[1]});
      if (next == at) break;
      const SurfacePoint candidate = point_at(surface_, next);
      const Vector3 left = place - candidate.place;
      if (dot(left, left) < distance) {
        at = next;
        point = candidate;
        rest = left;
        distance = dot(left, left);
        is_nearer = true;
      }
      change = {change[0] / 2, change[1] / 2};
    }
    const double moved = std::abs(change[0]) + std::abs(change[1]);
    if (!is_nearer || moved < kSmallStep * (std::abs(at[0]) + std::abs(at[1]))) break;
  }
  return {at, std::sqrt(distance), {}};
}

Inverted Inverter::invert(const Vector3& place, const std::optional<Parameters>& neighbour,
                          double known_gap) const {
  for (std::size_t i = 0; i < poles_.size(); ++i) {
    const double distance = length(place - poles_[i].place);
    if (distance > tolerance_) continue;
    Inverted inverted{{}, distance, i};
    inverted.at[static_cast<std::size_t>(poles_[i].direction)] = poles_[i].at;
    return inverted;
  }
  if (neighbour) {
    const Inverted near = approach(place, *neighbour);
    if (near.gap <= std::max(tolerance_, kAsFar * known_gap)) return near;
  }
  struct Start {
    double distance = 0;
    std::size_t sample = 0;
  };
  std::vector<Start> starts;
  starts.reserve(net_.size());
  for (std::size_t i = 0; i < net_.size(); ++i) {
    const Vector3 offset = place - net_[i].place;
    starts.push_back({dot(offset, offset), i});
  }
  const std::size_t tries = std::min(kTries, starts.size());
  std::partial_sort(starts.begin(), starts.begin() + static_cast<std::ptrdiff_t>(tries),
                    starts.end(), [](const Start& a, const Start& b) {
                      return a.distance != b.distance ? a.distance < b.distance
                                                      : a.sample < b.sample;
                    });
  Inverted best = approach(place, net_[starts[0].sample].at);
  for (std::size_t i = 1; i < tries && best.gap > tolerance_; ++i) {
    const Inverted next = approach(place, net_[starts[i].sample].at);
    if (next.gap < best.gap) best = next;
  }
  return best;
}

}  // namespace watertight::surfaces
