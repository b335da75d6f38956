// SPDX-License-Identifier: GPL-3.0-or-later
#include "surfaces/face_loops.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "surfaces/invert_point.h"
#include "tessellate/trimmed/plane_predicates.h"

namespace watertight::surfaces {
namespace {

constexpr std::string_view kWindsAroundV = "a loop winds around the second direction";
constexpr double kFarOff = 100;     // times the tolerance or chord: an edge is elsewhere
constexpr double kSameTurn = 1e-9;  // of a period: both sides of a pole are one meridian
constexpr std::size_t kMostSeamPoints = 100'000;
constexpr std::size_t kSeamTries = 256;  // places at which a seam is tried

Error no_loops(std::string message) {
  return Error{ErrorCode::unsupported, std::move(message), {}, {}};
}

/// A loop, unrolled: its points follow each other without a jump.
struct Chain {
  FaceLoop points;
  std::array<int, 2> winding{};  // turns along u and v from the first point around to it
};

Point in_plane(const Parameters& at) { return {at[0], at[1], 0}; }

double signed_area(const FaceLoop& loop) {
  double area = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Parameters& a = loop[i].at;
    const Parameters& b = loop[(i + 1) % loop.size()].at;
    area += (a[0] - loop[0].at[0]) * (b[1] - loop[0].at[1]) -
            (a[1] - loop[0].at[1]) * (b[0] - loop[0].at[0]);
  }
  return area / 2;
}

bool contains(const FaceLoop& loop, const Parameters& at) {
  bool is_inside = false;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    Point a = in_plane(loop[i].at);
    Point b = in_plane(loop[(i + 1) % loop.size()].at);
    if ((a.y <= at[1]) == (b.y <= at[1])) continue;
    if (a.y > b.y) std::swap(a, b);
    if (tessellate::turn(a, b, in_plane(at)) > 0) is_inside = !is_inside;
  }
  return is_inside;
}

bool segments_touch(const Parameters& a, const Parameters& b, const Parameters& c,
                    const Parameters& d) {
  const Point p = in_plane(a);
  const Point q = in_plane(b);
  const Point r = in_plane(c);
  const Point s = in_plane(d);
  if (std::max(p.x, q.x) < std::min(r.x, s.x) || std::max(r.x, s.x) < std::min(p.x, q.x) ||
      std::max(p.y, q.y) < std::min(r.y, s.y) || std::max(r.y, s.y) < std::min(p.y, q.y)) {
    return false;
  }
  return tessellate::turn(p, q, r) * tessellate::turn(p, q, s) <= 0 &&
         tessellate::turn(r, s, p) * tessellate::turn(r, s, q) <= 0;
}

class LoopMaker {
 public:
  LoopMaker(const BoundaryFace& face, const Surface& surface, bool is_transposed,
            const std::vector<EdgeSamples>& edges, double tolerance, double chord, VertexPool& pool)
      : face_(face),
        surface_(surface),
        is_reversed_(face.is_along_surface == is_transposed),
        edges_(edges),
        tolerance_(tolerance),
        chord_(chord),
        inverter_(surface, tolerance),
        pool_(pool),
        period_{surface.period(0), surface.period(1)} {}

  Result<FaceLoops> run() {
    for (const EdgeLoop& loop : face_.loops) {
      auto chain = unrolled(loop);
      if (!chain) return std::move(chain).error();
      chains_.push_back(*std::move(chain));
    }
    const auto has_turn = [&](std::size_t axis) {
      return std::any_of(chains_.begin(), chains_.end(),
                         [&](const Chain& chain) { return chain.winding[axis] != 0; });
    };
    if (has_turn(1)) {
      if (has_turn(0)) return no_loops("loops wind around both directions of the surface");
      return no_loops(std::string(kWindsAroundV));
    }
    if (is_wrong_sense()) {
      result_.is_turned = true;
      for (Chain& chain : chains_) turn(chain);
    }
    if (Status status = make_outer(); !status) return status.error();
    place_holes();
    return std::move(result_);
  }

 private:
  struct Entry {
    Index vertex = kNone;
    Index edge = kNone;
    Inverted inverted;
  };

  std::vector<Entry> entries_of(const EdgeLoop& loop) const {
    std::vector<Entry> entries;
    for (const OrientedEdge& oriented : loop) {
      const EdgeSamples& samples = edges_[oriented.edge];
      for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
        const std::size_t at = oriented.is_forward ? i : samples.size() - 1 - i;
        entries.push_back({samples[at], oriented.edge, {}});
      }
    }
    if (is_reversed_) {
      std::reverse(entries.begin(), entries.end());
      // The way to the next point now is the way from it.
      for (std::size_t i = 0; i + 1 < entries.size(); ++i) entries[i].edge = entries[i + 1].edge;
      if (!entries.empty()) entries.back().edge = loop.back().edge;
    }
    return entries;
  }

  /// `at` in the turn that is nearest to a neighbour.
  Parameters near(Parameters at, const Parameters& neighbour) const {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      if (period_[axis] == 0) continue;
      at[axis] += period_[axis] * std::round((neighbour[axis] - at[axis]) / period_[axis]);
    }
    return at;
  }

  /// The coordinates after a pole: the face is on the left of the way along the pole's side.
  Parameters beyond(const Pole& pole, Parameters at, const Parameters& before) const {
    const auto free = static_cast<std::size_t>(1 - pole.direction);
    at = near(at, before);
    if (period_[free] == 0) return at;
    const bool goes_up = (pole.direction == 0) == pole.is_upper;
    double change = (at[free] - before[free]) / period_[free];
    if (std::abs(change) < kSameTurn) change = 0;
    if (goes_up ? change <= 0 : change >= 0) at[free] += goes_up ? period_[free] : -period_[free];
    return at;
  }

  static bool is_pole(const Entry& entry) { return entry.inverted.pole.has_value(); }

  static bool is_at_one_pole(const std::vector<Entry>& entries) {
    return std::count_if(entries.begin(), entries.end(), is_pole) == 1;
  }

  /// A loop through one pole: it closes there without a turn.
  Chain unrolled_at_pole(std::vector<Entry>& entries) const {
    std::rotate(entries.begin(), std::find_if(entries.begin(), entries.end(), is_pole),
                entries.end());
    const Pole& pole = inverter_.poles()[*entries[0].inverted.pole];
    Chain chain;
    Parameters before = entries[1].inverted.at;
    Parameters corner = before;
    corner[static_cast<std::size_t>(pole.direction)] = pole.at;
    chain.points.push_back({entries[0].vertex, corner, entries[0].edge});
    for (std::size_t i = 1; i < entries.size(); ++i) {
      before = near(entries[i].inverted.at, before);
      chain.points.push_back({entries[i].vertex, before, entries[i].edge});
    }
    before[static_cast<std::size_t>(pole.direction)] = pole.at;
    if (before != corner) chain.points.push_back({entries[0].vertex, before, kNone});
    return chain;
  }

  Result<Chain> unrolled(const EdgeLoop& loop) {
    std::vector<Entry> entries = entries_of(loop);
    std::optional<Parameters> neighbour;
    for (Entry& entry : entries) {
      entry.inverted = inverter_.invert(pool_.place(entry.vertex), neighbour, result_.gap);
      result_.gap = std::max(result_.gap, entry.inverted.gap);
      if (result_.gap > kFarOff * std::max(tolerance_, chord_)) {
        return no_loops("an edge is " + std::to_string(result_.gap) + " m off the surface");
      }
      if (!entry.inverted.pole) neighbour = entry.inverted.at;
    }
    const auto first = std::find_if(entries.begin(), entries.end(),
                                    [](const Entry& entry) { return !entry.inverted.pole; });
    if (first == entries.end()) return no_loops("a loop without extent");
    std::rotate(entries.begin(), first, entries.end());
    return unrolled(entries);
  }

  Result<Chain> unrolled(std::vector<Entry>& entries) const {
    if (is_at_one_pole(entries)) return unrolled_at_pole(entries);
    Chain chain;
    chain.points.push_back({entries[0].vertex, entries[0].inverted.at, entries[0].edge});
    Parameters before = entries[0].inverted.at;
    const Entry* pending = nullptr;  // a pole
    for (std::size_t i = 1; i <= entries.size(); ++i) {
      const Entry& entry = entries[i % entries.size()];
      if (entry.inverted.pole) {
        if (pending != nullptr && pending->inverted.pole != entry.inverted.pole) {
          return no_loops("an edge from pole to pole");
        }
        pending = &entry;
        continue;
      }
      Parameters at = near(entry.inverted.at, before);
      if (pending != nullptr) {
        const Pole& pole = inverter_.poles()[*pending->inverted.pole];
        const auto free = static_cast<std::size_t>(1 - pole.direction);
        at = beyond(pole, entry.inverted.at, before);
        Parameters corner = before;
        corner[static_cast<std::size_t>(pole.direction)] = pole.at;
        chain.points.push_back({pending->vertex, corner, kNone});
        if (at[free] != before[free]) {
          corner[free] = at[free];
          chain.points.push_back({pending->vertex, corner, kNone});
        }
        chain.points.back().edge = pending->edge;
        pending = nullptr;
      }
      if (i < entries.size()) {
        chain.points.push_back({entry.vertex, at, entry.edge});
        before = at;
        continue;
      }
      for (std::size_t axis = 0; axis < 2; ++axis) {
        if (period_[axis] == 0) continue;
        const double turns = (at[axis] - chain.points[0].at[axis]) / period_[axis];
        chain.winding[axis] = static_cast<int>(std::lround(turns));
      }
    }
    return chain;
  }

  /// Whether the loops bound no part of the surface as they turn, but one if they all are turned.
  bool is_wrong_sense() const {
    const auto has_pole = [&](bool is_upper) {
      return std::any_of(inverter_.poles().begin(), inverter_.poles().end(), [&](const Pole& pole) {
        return pole.direction == 1 && pole.is_upper == is_upper;
      });
    };
    std::array<double, 2> height{};  // of the loops that wind: with the face above, and below
    std::array<int, 2> count{};
    double largest = 0;
    for (const Chain& chain : chains_) {
      const double area = signed_area(chain.points);
      if (chain.winding[0] == 0 && std::abs(area) > std::abs(largest)) largest = area;
      if (std::abs(chain.winding[0]) != 1) continue;
      const std::size_t side = chain.winding[0] == 1 ? 0 : 1;
      ++count[side];
      for (const LoopPoint& point : chain.points) {
        height[side] += point.at[1] / static_cast<double>(chain.points.size());
      }
    }
    if (count[0] == 0 && count[1] == 0) return largest < 0 && !(has_pole(false) && has_pole(true));
    if (count[0] > 0 && count[1] > 0) return period_[1] == 0 && height[0] > height[1];
    return count[0] > 0 ? !has_pole(true) && has_pole(false) : !has_pole(false) && has_pole(true);
  }

  void turn(Chain& chain) const {
    // The way to the next point becomes the way from it. The first point stays the first.
    const FaceLoop old = chain.points;
    const std::size_t count = old.size();
    for (std::size_t i = 0; i < count; ++i) {
      chain.points[i] = old[(count - i) % count];
      chain.points[i].edge = old[count - 1 - i].edge;
      for (std::size_t axis = 0; axis < 2 && i > 0; ++axis) {
        chain.points[i].at[axis] -= period_[axis] * chain.winding[axis];
      }
    }
    for (int& turns : chain.winding) turns = -turns;
  }

  /// Makes the loops around the face; `holes_` are the others.
  Status make_outer() {
    std::vector<Chain> up;    // with the face above
    std::vector<Chain> down;  // with the face below
    for (Chain& chain : chains_) {
      if (chain.winding[0] == 0) {
        (signed_area(chain.points) > 0 ? result_.loops : holes_).push_back(std::move(chain.points));
      } else if (chain.winding[0] == 1) {
        up.push_back(std::move(chain));
      } else if (chain.winding[0] == -1) {
        down.push_back(std::move(chain));
      } else {
        return no_loops("a loop winds around the surface more than once");
      }
    }
    turn_inner_loops(up.empty() && down.empty());
    if (up.empty() && down.empty()) {
      if (!result_.loops.empty()) return Done{};
      if (holes_.empty()) return no_loops("the face has no loop");
    }
    if (up.size() > 1 || down.size() > 1) return no_loops("more than two loops around the surface");
    if (up.empty() && !add_pole_chain(false, up)) return no_loops("the face has no lower end");
    if (down.empty() && !add_pole_chain(true, down)) return no_loops("the face has no upper end");
    return cut(up.front(), down.front());
  }

  /// A face is in one piece: one loop is around it, and the others are holes, however they turn.
  void turn_inner_loops(bool has_outer) {
    std::vector<FaceLoop>& loops = result_.loops;
    if (loops.empty()) return;
    const auto outer = std::max_element(
        loops.begin(), loops.end(),
        [](const FaceLoop& a, const FaceLoop& b) { return signed_area(a) < signed_area(b); });
    if (has_outer) std::iter_swap(loops.begin(), outer);
    for (std::size_t i = has_outer ? 1 : 0; i < loops.size(); ++i) {
      Chain hole{std::move(loops[i]), {}};
      turn(hole);
      holes_.push_back(std::move(hole.points));
    }
    loops.resize(has_outer ? 1 : 0);
  }

  bool add_pole_chain(bool is_upper, std::vector<Chain>& chains) {
    for (const Pole& pole : inverter_.poles()) {
      if (pole.direction != 1 || pole.is_upper != is_upper) continue;
      const Index vertex = pool_.add(pole.place);
      chains.push_back(
          {{{vertex, {surface_.u_breaks.front(), pole.at}, kNone}}, {is_upper ? -1 : 1, 0}});
      return true;
    }
    return false;
  }

  /// Makes one loop of two loops around the surface, with a seam between them.
  Status cut(const Chain& up, const Chain& down) {
    const std::size_t stride = 1 + up.points.size() / kSeamTries;
    for (std::size_t i = 0; i < up.points.size(); i += stride) {
      LoopPoint from = up.points[i];
      std::size_t end = 0;
      LoopPoint to;
      double least = 0;
      if (up.points.size() == 1) from.at[0] = down.points[0].at[0];
      for (std::size_t k = 0; k < down.points.size(); ++k) {
        LoopPoint candidate = down.points[k];
        if (down.points.size() == 1) candidate.at[0] = from.at[0];
        candidate.at[0] = near(candidate.at, from.at)[0];
        if (period_[1] > 0) {
          const double turns = std::floor((candidate.at[1] - from.at[1]) / period_[1]);
          candidate.at[1] -= period_[1] * turns;
        }
        const double distance = std::abs(candidate.at[0] - from.at[0]);
        if (k > 0 && distance >= least) continue;
        least = distance;
        end = k;
        to = candidate;
      }
      if (is_seam_blocked(up, i, down, end, from.at, to.at)) continue;
      return join(up, i, from, down, end, to);
    }
    return no_loops("no seam cuts the surface between its loops");
  }

  bool is_seam_blocked(const Chain& up, std::size_t start, const Chain& down, std::size_t end,
                       const Parameters& from, const Parameters& to) const {
    const auto blocks = [&](const FaceLoop& points, std::size_t own, bool is_closed) {
      for (std::size_t i = 0; i < points.size(); ++i) {
        const std::size_t next = (i + 1) % points.size();
        if (i == own || next == own) continue;
        if (next == 0 && !is_closed) continue;
        const Parameters a = near(points[i].at, from);
        const Parameters shift{a[0] - points[i].at[0], a[1] - points[i].at[1]};
        const Parameters& b = points[next].at;
        for (const double turn : {-1.0, 0.0, 1.0}) {
          const double more = turn * period_[0];
          if (segments_touch(from, to, {a[0] + more, a[1]},
                             {b[0] + shift[0] + more, b[1] + shift[1]})) {
            return true;
          }
        }
      }
      return false;
    };
    if (blocks(up.points, start, false) || blocks(down.points, end, false)) return true;
    return std::any_of(holes_.begin(), holes_.end(),
                       [&](const FaceLoop& hole) { return blocks(hole, hole.size(), true); });
  }

  Status join(const Chain& up, std::size_t start, const LoopPoint& from, const Chain& down,
              std::size_t end, const LoopPoint& to) {
    const double period = period_[0];
    FaceLoop loop;
    const auto add = [&](const Chain& chain, std::size_t first, const LoopPoint& begin,
                         double turn) {
      const std::size_t count = chain.points.size();
      for (std::size_t i = 0; i <= count; ++i) {
        LoopPoint point = chain.points[(first + i) % count];
        const double turns = first + i >= count ? turn : 0;
        point.at = {point.at[0] - chain.points[first].at[0] + begin.at[0] + turns,
                    point.at[1] - chain.points[first].at[1] + begin.at[1]};
        if (i == count) point.edge = kNone;
        loop.push_back(point);
      }
    };
    add(up, start, from, period);
    const FaceLoop seam = seam_between(from.at, to.at);
    for (LoopPoint point : seam) {
      point.at[0] += period;
      loop.push_back(point);
    }
    LoopPoint last = to;
    last.at[0] += period;
    add(down, end, last, -period);
    loop.insert(loop.end(), seam.rbegin(), seam.rend());
    result_.loops.push_back(std::move(loop));
    return Done{};
  }

  /// The points of a seam between its ends, as near to each other as the surface needs.
  FaceLoop seam_between(const Parameters& from, const Parameters& to) {
    const auto [low_u, high_u] = std::minmax(from[0], to[0]);
    const auto [low_v, high_v] = std::minmax(from[1], to[1]);
    const SecondDerivatives bend = Bends(surface_).over({low_u, low_v}, {high_u, high_v});
    const double u = high_u - low_u;
    const double v = high_v - low_v;
    const double error = (bend.uu * u * u + 2 * bend.uv * u * v + bend.vv * v * v) / 8;
    const double parts =
        std::min(std::ceil(std::sqrt(error / chord_)), static_cast<double>(kMostSeamPoints));
    FaceLoop seam;
    for (double i = 1; i < parts; ++i) {
      const double share = i / parts;
      const Parameters at{from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1])};
      seam.push_back({pool_.add(point_at(surface_, at).place), at, kNone});
    }
    return seam;
  }

  /// Moves holes by whole turns into the loop around the face.
  void place_holes() {
    for (FaceLoop& hole : holes_) {
      for (const auto& [u, v] : kTurns) {
        const Parameters shift{u * period_[0], v * period_[1]};
        if ((u != 0 && shift[0] == 0) || (v != 0 && shift[1] == 0)) continue;
        const Parameters at{hole[0].at[0] + shift[0], hole[0].at[1] + shift[1]};
        if (std::none_of(result_.loops.begin(), result_.loops.end(),
                         [&](const FaceLoop& loop) { return contains(loop, at); })) {
          continue;
        }
        for (LoopPoint& point : hole) {
          point.at = {point.at[0] + shift[0], point.at[1] + shift[1]};
        }
        break;
      }
    }
    for (FaceLoop& hole : holes_) result_.loops.push_back(std::move(hole));
  }

  static constexpr std::array<std::array<int, 2>, 15> kTurns{{{0, 0},
                                                              {1, 0},
                                                              {-1, 0},
                                                              {0, 1},
                                                              {0, -1},
                                                              {1, 1},
                                                              {1, -1},
                                                              {-1, 1},
                                                              {-1, -1},
                                                              {2, 0},
                                                              {-2, 0},
                                                              {2, 1},
                                                              {2, -1},
                                                              {-2, 1},
                                                              {-2, -1}}};

  const BoundaryFace& face_;
  const Surface& surface_;
  bool is_reversed_;  // the loops have the face on their right in the plane of (u, v)
  const std::vector<EdgeSamples>& edges_;
  double tolerance_;
  double chord_;
  Inverter inverter_;
  VertexPool& pool_;
  std::array<double, 2> period_;
  std::vector<Chain> chains_;
  std::vector<FaceLoop> holes_;
  FaceLoops result_;
};

}  // namespace

Result<FaceLoops> loops_of(const BoundaryFace& face, const Surface& surface, bool is_transposed,
                           const std::vector<EdgeSamples>& edges, double tolerance, double chord,
                           VertexPool& pool) {
  return LoopMaker(face, surface, is_transposed, edges, tolerance, chord, pool).run();
}

bool winds_around_v(const Error& error) { return error.message == kWindsAroundV; }

}  // namespace watertight::surfaces
