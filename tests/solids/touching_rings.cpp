// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/solids/touching_rings.h"

#include <algorithm>

#include "geometry/predicates/predicates.h"
#include "tests/solids/builders.h"

namespace watertight::solids {
namespace {

constexpr double kUnit = 100;  // the unit of the coordinates below: 100 mm
constexpr double kTop = 60;    // the height of the blocks, in units

constexpr std::size_t kUpper = 1;  // the index of the upper facet of a prism()

class PittedBlock {
 public:
  explicit PittedBlock(const Ring& outline) : shell_(prism(outline, 0, kTop)) {}

  /// Adds a pit to a facet; its rim turns counter-clockwise seen from outside.
  void add_pit(std::size_t facet, const Ring& rim, const Point& bottom) {
    shell_[facet].push_back(reversed(rim));
    for (std::size_t i = 0; i < rim.size(); ++i) {
      shell_.push_back({{rim[i], rim[(i + 1) % rim.size()], bottom}});
    }
  }

  /// Inserts the vertex into the rings of all facets but `facet` in which it lies inside an edge.
  void give_to_facets_across(const Point& v, std::size_t facet) {
    for (std::size_t f = 0; f < shell_.size(); ++f) {
      if (f == facet) continue;
      for (Ring& ring : shell_[f]) insert_into(ring, v);
    }
  }

  /// The index of the facet whose exterior ring has the edge from a to b.
  std::size_t facet_with_edge(const Point& a, const Point& b) const {
    for (std::size_t f = 0; f < shell_.size(); ++f) {
      const Ring& ring = shell_[f][0];
      for (std::size_t i = 0; i < ring.size(); ++i) {
        if (ring[i] == a && ring[(i + 1) % ring.size()] == b) return f;
      }
    }
    return shell_.size();
  }

  void raise(const Point& corner, double steps) {
    raised_ = scaled(corner);
    steps_ = steps;
  }

  Shape shape() const {
    Shell result = shell_;
    for (Facet& facet : result) {
      for (Ring& ring : facet) {
        for (Point& p : ring) {
          p = scaled(p);
          if (steps_ > 0 && p == raised_) p.z += steps_;
        }
      }
    }
    return {result};
  }

 private:
  static Point scaled(const Point& p) { return {kUnit * p.x, kUnit * p.y, kUnit * p.z}; }

  static void insert_into(Ring& ring, const Point& v) {
    if (std::find(ring.begin(), ring.end(), v) != ring.end()) return;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      if (!geometry::is_on_segment(ring[i], ring[(i + 1) % ring.size()], v)) continue;
      ring.insert(ring.begin() + static_cast<std::ptrdiff_t>(i) + 1, v);
      return;
    }
  }

  Shell shell_;
  Point raised_;
  double steps_ = 0;
};

Ring rectangle(double width, double depth) {
  return {{0, 0, 0}, {width, 0, 0}, {width, depth, 0}, {0, depth, 0}};
}

/// Adds a pit that touches the outline or another pit in (x, y); its far edge is at y + 12.
void add_upper_pit(PittedBlock& block, double x, double y) {
  block.add_pit(kUpper, {{x, y, kTop}, {x + 7, y + 12, kTop}, {x - 7, y + 12, kTop}},
                {x, y + 8, kTop - 8});
}

/// Adds a pit in the front wall that touches the upper edge of the wall at x.
void add_front_pit(PittedBlock& block, std::size_t front, double x) {
  block.add_pit(front, {{x, 0, kTop}, {x - 7, 0, kTop - 12}, {x + 7, 0, kTop - 12}},
                {x, 4, kTop - 14});
}

/// Adds a pit whose edge passes through the tip (x, y) of a notch of the outline.
void add_notched_pit(PittedBlock& block, double x, double y) {
  block.add_pit(kUpper, {{x - 6, y, kTop}, {x + 6, y, kTop}, {x, y + 12, kTop}},
                {x, y + 4, kTop - 8});
}

class Rows {
 public:
  Rows(Random& random, bool is_even) : random_(random), is_even_(is_even) {}

  TouchingRings make() {
    const std::size_t count = 1 + random_.below(5);
    width_ = 20 * static_cast<double>(count + 1);
    choose(count);
    PittedBlock block(outline());
    for (const Row& row : rows_) add_row(block, row);
    if (!is_even_) block.raise({width_, kDepth, kTop}, 3);
    return {"rows of pits", block.shape(), errors_};
  }

 private:
  static constexpr double kDepth = 48;
  struct Row {
    double x = 0;
    std::size_t pits = 0;  // the number of pits, one behind the other
    bool has_notch = false;
    bool reaches_back = false;
    bool has_front_pit = false;
  };

  void choose(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      Row row;
      row.x = 20 * static_cast<double>(i + 1);
      row.has_notch = random_.below(4) == 0;
      row.pits = random_.below(4);
      row.reaches_back = is_even_ && row.pits == 3 && !row.has_notch && random_.below(2) == 0;
      row.has_front_pit = row.pits > 0 && !row.has_notch && random_.below(4) == 0;
      rows_.push_back(row);
    }
  }

  /// A rectangle with a notch in its front for each row that has one.
  Ring outline() const {
    Ring ring{{0, 0, 0}};
    for (const Row& row : rows_) {
      if (!row.has_notch) continue;
      ring.insert(ring.end(), {{row.x - 5, 0, 0}, {row.x, 6, 0}, {row.x + 5, 0, 0}});
    }
    ring.insert(ring.end(), {{width_, 0, 0}, {width_, kDepth, 0}, {0, kDepth, 0}});
    return ring;
  }

  /// Gives the vertex of a touch to the facet across the edge, or leaves it out at random. Only one
  /// vertex of a shape is left out: a vertex between two such vertices would have two fans (303).
  void give(PittedBlock& block, const Point& v, std::size_t facet) {
    if (!errors_.contains(302) && random_.below(10) == 0) {
      errors_.insert(302);
    } else {
      block.give_to_facets_across(v, facet);
    }
  }

  void add_row(PittedBlock& block, const Row& row) {
    double y = row.has_notch ? 6 : 0;
    for (std::size_t i = 0; i < row.pits; ++i) {
      const Point touch{row.x, y, kTop};
      if (i == 0 && row.has_notch) {
        add_notched_pit(block, row.x, y);
        give(block, touch, kUpper);
        return;  // the tip of the pit points backward: nothing touches it
      }
      const bool is_last = i + 1 == row.pits && row.reaches_back;
      if (is_last) {
        add_last_pit(block, row.x, y);
      } else {
        add_upper_pit(block, row.x, y);
      }
      add_across(block, row, touch, i == 0);
      y += 12;
    }
  }

  void add_across(PittedBlock& block, const Row& row, const Point& touch, bool is_first) {
    const std::size_t front = front_of(block, row.x);
    if (is_first && row.has_front_pit && front != kNone) {
      add_front_pit(block, front, row.x);
    } else {
      give(block, touch, kUpper);
    }
  }

  /// Adds a pit that reaches from the pit before to the back edge.
  void add_last_pit(PittedBlock& block, double x, double y) {
    const Point back{x, kDepth, kTop};
    block.add_pit(kUpper, {{x, y, kTop}, {x + 6, y + 12, kTop}, back, {x - 6, y + 12, kTop}},
                  {x, y + 12, kTop - 8});
    block.give_to_facets_across(back, kUpper);
    errors_.insert(205);
  }

  /// The front wall that has x between its ends.
  Index front_of(const PittedBlock& block, double x) const {
    const Ring ring = outline();
    for (std::size_t i = 0; i + 1 < ring.size(); ++i) {
      const bool is_around =
          ring[i].y == 0 && ring[i + 1].y == 0 && ring[i].x < x && x < ring[i + 1].x;
      if (is_around) return static_cast<Index>(block.facet_with_edge(ring[i], ring[i + 1]));
    }
    return kNone;
  }

  Random& random_;
  bool is_even_;
  double width_ = 0;
  std::vector<Row> rows_;
  std::set<int> errors_;
};

}  // namespace

std::vector<TouchingRings> touching_rings() {
  const Point v{20, 0, kTop};
  const Point w{20, 12, kTop};
  const Ring outline = rectangle(40, 48);
  const auto front_of = [](const PittedBlock& block) {
    return block.facet_with_edge({0, 0, 0}, {40, 0, 0});
  };
  std::vector<TouchingRings> list;

  PittedBlock at_outline(outline);
  add_upper_pit(at_outline, 20, 0);
  list.push_back({"pit-at-edge-plain-across", at_outline.shape(), {302}});
  PittedBlock between_pits = at_outline;
  at_outline.give_to_facets_across(v, kUpper);
  list.push_back({"pit-at-edge", at_outline.shape(), {}});

  between_pits = at_outline;
  add_upper_pit(between_pits, 20, 12);
  list.push_back({"pit-at-pit-plain-across", between_pits.shape(), {302}});
  between_pits.give_to_facets_across(w, kUpper);
  list.push_back({"pit-at-pit", between_pits.shape(), {}});

  PittedBlock both_sides(outline);
  add_upper_pit(both_sides, 20, 0);
  add_front_pit(both_sides, front_of(both_sides), 20);
  list.push_back({"pits-on-both-sides-of-edge", both_sides.shape(), {}});

  PittedBlock notched(
      {{0, 0, 0}, {15, 0, 0}, {20, 6, 0}, {25, 0, 0}, {40, 0, 0}, {40, 48, 0}, {0, 48, 0}});
  add_notched_pit(notched, 20, 6);
  list.push_back({"notch-at-pit-plain-across", notched.shape(), {302}});
  notched.give_to_facets_across({20, 6, kTop}, kUpper);
  list.push_back({"notch-at-pit", notched.shape(), {}});

  PittedBlock several(rectangle(80, 48));
  for (const double x : {20.0, 40.0, 60.0}) {
    add_upper_pit(several, x, 0);
    several.give_to_facets_across({x, 0, kTop}, kUpper);
  }
  list.push_back({"three-pits-at-edge", several.shape(), {}});

  PittedBlock twice(outline);
  twice.add_pit(kUpper, {{8, 0, kTop}, {20, 8, kTop}, {32, 0, kTop}, {20, 20, kTop}},
                {20, 12, kTop - 8});
  for (const double x : {8.0, 32.0}) twice.give_to_facets_across({x, 0, kTop}, kUpper);
  list.push_back({"pit-at-edge-twice", twice.shape(), {205}});

  PittedBlock along(outline);
  along.add_pit(kUpper, {{8, 0, kTop}, {32, 0, kTop}, {20, 20, kTop}}, {20, 8, kTop - 8});
  list.push_back({"pit-along-edge", along.shape(), {201, 306}});

  PittedBlock across(outline);
  across.add_pit(kUpper, {{20, -4, kTop}, {27, 12, kTop}, {13, 12, kTop}}, {20, 8, kTop - 8});
  list.push_back({"pit-across-edge", across.shape(), {201, 306}});
  return list;
}

TouchingRings random_touching_rings(Random& random) { return Rows(random, true).make(); }

TouchingRings uneven_touching_rings(Random& random) { return Rows(random, false).make(); }

}  // namespace watertight::solids
