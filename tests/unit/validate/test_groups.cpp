// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <optional>
#include <random>

#include "geometry/predicates/point_in_solid.h"
#include "tests/unit/validate/solids.h"
#include "validate/groups.h"

namespace watertight::test {
namespace {

/// A group of members; it keeps their certified solids alive.
class Group {
 public:
  Group& add(const std::vector<Shell>& shells, const Lattice& lattice = {},
             std::uint32_t srid = 0) {
    CertifyOptions options;
    if (shells.size() == 1) options.proof = Proof::boundary;
    Inspection inspection = certify(solid_of(shells, lattice, srid), nullptr, options);
    REQUIRE(inspection.certified);
    solids_.push_back(std::move(inspection.certified->solid));
    return *this;
  }
  Group& add(const Shell& shell) { return add(std::vector<Shell>{shell}); }
  Group& add_invalid() {
    solids_.emplace_back();
    return *this;
  }
  validate::GroupReport check(validate::GroupKind kind,
                              const validate::GroupOptions& options = {}) const {
    std::vector<validate::GroupMember> members;
    for (const auto& solid : solids_) members.push_back({solid ? &*solid : nullptr});
    return validate::check_group(members, kind, options);
  }
  /// How the first two members meet as neighbouring cells.
  validate::CellContact contact(const validate::GroupOptions& options = {}) const {
    std::vector<validate::GroupMember> members;
    std::vector<Index> cells;
    for (const auto& solid : solids_) {
      cells.push_back(static_cast<Index>(members.size()));
      members.push_back({&*solid});
    }
    std::vector<validate::CellPair> pairs{{0, 1}};
    validate::check_cells(members, cells, pairs, options);
    return pairs[0].contact;
  }

 private:
  std::vector<std::optional<ValidSolid>> solids_;
};

std::vector<int> composite_codes(const Group& group) {
  std::vector<int> codes;
  for (const Finding& finding : group.check(validate::GroupKind::composite_solid).findings) {
    codes.push_back(finding.code);
  }
  return codes;
}

std::vector<int> composite_codes(const Shell& a, const Shell& b) {
  return composite_codes(Group().add(a).add(b));
}

using CodeList = std::vector<int>;

/// An upright prism over a polygon that turns counter-clockwise.
Shell prism(const Ring& plan, double low, double high) {
  Shell shell;
  Ring bottom;
  Ring top;
  for (const Point& p : plan) {
    bottom.insert(bottom.begin(), Point{p.x, p.y, low});
    top.push_back({p.x, p.y, high});
  }
  shell.push_back({bottom});
  shell.push_back({top});
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const Point& a = plan[i];
    const Point& b = plan[(i + 1) % plan.size()];
    shell.push_back({{{a.x, a.y, low}, {b.x, b.y, low}, {b.x, b.y, high}, {a.x, a.y, high}}});
  }
  return shell;
}

Shell u_shape() {
  return prism({{0, 0}, {6, 0}, {6, 6}, {4, 6}, {4, 2}, {2, 2}, {2, 6}, {0, 6}}, 0, 4);
}

TEST_CASE("a member in whose facet rings touch inside an edge is compared like others") {
  const Point v{4, 0, 8};
  const Ring rim{v, {6, 4, 8}, {2, 4, 8}};
  const Point bottom{4, 3, 6};
  Shell pitted = cube(8);
  pitted[1].push_back({rim[2], rim[1], rim[0]});
  Shell plug{{rim}};
  for (std::size_t i = 0; i < 3; ++i) {
    pitted.push_back({{rim[i], rim[(i + 1) % 3], bottom}});
    plug.push_back({{rim[(i + 1) % 3], rim[i], bottom}});
  }
  Ring& front = pitted[2][0];
  front.insert(std::find(front.begin(), front.end(), Point{8, 0, 8}) + 1, v);
  CHECK(composite_codes(pitted, plug).empty());
  CHECK(composite_codes(pitted, cube(8)) == CodeList{501});
  CHECK(composite_codes(pitted, box({0, 0, 8}, {8, 8, 9})).empty());
  CHECK(composite_codes(pitted, pitted) == CodeList{502});
}

TEST_CASE("members that share a facet make a composite solid") {
  const validate::GroupReport report = Group()
                                           .add(box({0, 0, 0}, {4, 4, 4}))
                                           .add(box({4, 1, 1}, {8, 3, 9}))
                                           .check(validate::GroupKind::composite_solid);
  CHECK(report.verdict == Verdict::valid);
  CHECK(report.findings.empty());
  CHECK(report.not_run.empty());
}

TEST_CASE("crossing members overlap, and the finding says where and how deep") {
  const validate::GroupReport report = Group()
                                           .add(box({0, 0, 0}, {10, 10, 10}))
                                           .add(box({8, 2, 2}, {20, 12, 12}))
                                           .check(validate::GroupKind::composite_solid);
  CHECK(report.verdict == Verdict::invalid);
  REQUIRE(report.findings.size() == 1);
  const Finding& finding = report.findings[0];
  CHECK(finding.code == 501);
  CHECK(finding.place.solid == 0);
  CHECK(finding.place.facet != kNone);
  REQUIRE(finding.other);
  CHECK(finding.other->solid == 1);
  CHECK(finding.other->facet != kNone);
  CHECK(finding.measured == 2.0);
  CHECK(finding.limit == 0.0);
  CHECK(finding.unit == "m");
  REQUIRE(finding.witness);
  const auto& w = *finding.witness;
  CHECK((w[0] > 8 && w[0] < 10 && w[1] > 2 && w[1] < 10 && w[2] > 2 && w[2] < 10));
}

TEST_CASE("contact in an edge or a vertex alone does not connect members") {
  CHECK(composite_codes(box({0, 0, 0}, {4, 4, 4}), box({4, 4, 0}, {8, 8, 4})) == CodeList{503});
  CHECK(composite_codes(box({0, 0, 0}, {4, 4, 4}), box({4, 4, 4}, {8, 8, 8})) == CodeList{503});
  CHECK(composite_codes(box({0, 0, 0}, {4, 4, 4}), box({5, 0, 0}, {8, 4, 4})) == CodeList{503});
  // The tip of a tetrahedron touches a facet, and an edge lies along a facet.
  CHECK(composite_codes(box({0, 0, 0}, {4, 4, 4}),
                        inside_out(Shell{{{{2, 2, 4}, {1, 1, 6}, {3, 1, 6}}},
                                         {{{2, 2, 4}, {3, 1, 6}, {2, 3, 6}}},
                                         {{{2, 2, 4}, {2, 3, 6}, {1, 1, 6}}},
                                         {{{1, 1, 6}, {2, 3, 6}, {3, 1, 6}}}})) == CodeList{503});
}

TEST_CASE("a member inside another overlaps it, a member inside its cavity does not") {
  CHECK(composite_codes(cube(10), box({2, 2, 2}, {4, 4, 4})) == CodeList{501});
  CHECK(composite_codes(box({2, 2, 2}, {4, 4, 4}), cube(10)) == CodeList{501});
  const std::vector<Shell> hollow{cube(10), inside_out(box({2, 2, 2}, {8, 8, 8}))};
  CHECK(composite_codes(Group().add(hollow).add(box({4, 4, 4}, {6, 6, 6}))) == CodeList{503});
  CHECK(composite_codes(Group().add(hollow).add(box({2, 2, 2}, {8, 8, 8}))).empty());
  CHECK(composite_codes(Group().add(hollow).add(box({1, 2, 2}, {8, 8, 8}))) == CodeList{501});
  CHECK(composite_codes(Group().add(hollow).add(cube(10))) == CodeList{501});
}

TEST_CASE("solids whose boundaries touch only and whose interiors meet overlap") {
  // The members are: a box flush inside a face; a box with the same base but another height; a plug
  // that fills a notch exactly.
  CHECK(composite_codes(cube(10), box({0, 2, 2}, {5, 5, 5})) == CodeList{501});
  CHECK(composite_codes(cube(10), box({0, 0, 0}, {10, 10, 4})) == CodeList{501});
  CHECK(composite_codes(u_shape(), box({2, 2, 0}, {4, 6, 4})).empty());
  CHECK(composite_codes(u_shape(), box({2, 1, 0}, {4, 6, 4})) == CodeList{501});
  // The second member is the hull of the first: all vertices of its facets lie on the first
  // boundary.
  CHECK(composite_codes(u_shape(), box({0, 0, 0}, {6, 6, 4})) == CodeList{501});
  // The second member is a tetrahedron with all four corners on edges of the cube.
  CHECK(composite_codes(cube(4), Shell{{{{0, 0, 0}, {4, 4, 0}, {4, 0, 4}}},
                                       {{{0, 0, 0}, {0, 4, 4}, {4, 4, 0}}},
                                       {{{0, 0, 0}, {4, 0, 4}, {0, 4, 4}}},
                                       {{{4, 4, 0}, {0, 4, 4}, {4, 0, 4}}}}) == CodeList{501});
}

TEST_CASE("equal members are duplicates, however their facets are divided") {
  CHECK(composite_codes(cube(4), cube(4)) == CodeList{502});
  Shell divided = cube(4);
  divided.erase(divided.begin() + 1);  // the top is divided in two
  divided.push_back({{{0, 0, 4}, {4, 0, 4}, {4, 4, 4}}});
  divided.push_back({{{0, 0, 4}, {4, 4, 4}, {0, 4, 4}}});
  CHECK(composite_codes(cube(4), divided) == CodeList{502});
  const std::vector<Shell> hollow{cube(10), inside_out(box({2, 2, 2}, {8, 8, 8}))};
  CHECK(composite_codes(Group().add(hollow).add(hollow)) == CodeList{502});
  // The members have equal boxes and volumes, but different points.
  const std::vector<Shell> shifted{cube(10), inside_out(box({1, 2, 2}, {7, 8, 8}))};
  CHECK(composite_codes(Group().add(hollow).add(shifted)) == CodeList{501});
  CHECK(composite_codes(Group().add(cube(4)).add(cube(4)).add(cube(4))) == CodeList{502, 502, 502});
}

TEST_CASE("building parts may touch, be apart and fill each other's cavities, but not overlap") {
  const Group apart =
      Group(Group().add(cube(4)).add(box({4, 0, 0}, {8, 4, 4}))).add(box({20, 0, 0}, {24, 4, 4}));
  CHECK(apart.check(validate::GroupKind::building_parts).findings.empty());
  const validate::GroupReport report = Group()
                                           .add(cube(4))
                                           .add(box({3, 0, 0}, {8, 4, 4}))
                                           .check(validate::GroupKind::building_parts);
  REQUIRE(report.findings.size() == 1);
  CHECK(report.findings[0].code == 601);
  CHECK(report.findings[0].measured == 1.0);
  const validate::GroupReport equal =
      Group().add(cube(4)).add(cube(4)).check(validate::GroupKind::building_parts);
  REQUIRE(equal.findings.size() == 1);
  CHECK(equal.findings[0].code == 601);
}

TEST_CASE("an overlap no deeper than allowed is not reported") {
  const Group group =
      Group(Group().add(box({0, 0, 0}, {10, 10, 10}))).add(box({9, 3, 0}, {20, 9, 9}));
  validate::GroupOptions options;
  options.overlap_metres = 1;
  CHECK(group.check(validate::GroupKind::composite_solid, options).findings.empty());
  CHECK(group.check(validate::GroupKind::building_parts, options).findings.empty());
  options.overlap_metres = 0.999;
  CHECK(group.check(validate::GroupKind::building_parts, options).findings.size() == 1);
}

TEST_CASE("the depth is the thickness of an oblique slab") {
  // The prisms overlap in a slab between two planes with the normal (1, 1, 0).
  const Ring diamond{{0, 0}, {10, -10}, {20, 0}, {10, 10}};
  const Ring moved{{9, -9}, {19, -19}, {29, -9}, {19, 1}};
  const validate::GroupReport report = Group()
                                           .add(prism(diamond, 0, 40))
                                           .add(prism(moved, 0, 40))
                                           .check(validate::GroupKind::building_parts);
  REQUIRE(report.findings.size() == 1);
  REQUIRE(report.findings[0].measured);
  CHECK(std::abs(*report.findings[0].measured - std::sqrt(2.0)) < 1e-9);
}

TEST_CASE("a member that is not valid is not compared, and the report says so") {
  const validate::GroupReport report = Group()
                                           .add(cube(4))
                                           .add_invalid()
                                           .add(box({3, 0, 0}, {8, 4, 4}))
                                           .check(validate::GroupKind::composite_solid);
  REQUIRE(report.findings.size() == 1);
  CHECK(report.findings[0].code == 501);
  CHECK(report.findings[0].other->solid == 2);
  REQUIRE(report.not_run.size() == 1);
  CHECK(report.not_run[0].reason == "member 1 is not valid and was not compared");
}

TEST_CASE("solids of different lattices are brought onto one grid exactly") {
  Lattice centimetres;
  for (auto& step : centimetres.step) step = {1, -2};
  Lattice shifted;
  for (auto& step : shifted.step) step = {25, -3};
  shifted.origin = {GridNumber{4, 0}, GridNumber{5, -3}, GridNumber{}};
  // [0, 4] x [0, 4] x [0, 4], and beside it [4, 5] x [0.005, 1.005] x [0, 1].
  const Group touching = Group(Group().add({cube(400)}, centimetres)).add({cube(40)}, shifted);
  CHECK(touching.check(validate::GroupKind::composite_solid).findings.empty());
  shifted.origin[0] = {3999, -3};
  const validate::GroupReport report = Group(Group().add({cube(400)}, centimetres))
                                           .add({cube(40)}, shifted)
                                           .check(validate::GroupKind::composite_solid);
  REQUIRE(report.findings.size() == 1);
  CHECK(report.findings[0].code == 501);
  CHECK(std::abs(*report.findings[0].measured - 0.001) < 1e-12);
}

TEST_CASE("solids of two kinds of grids are compared exactly, or undecided, never rounded") {
  Lattice binary;
  binary.kind = LatticeKind::binary;
  const auto overlapping = Group(Group().add(cube(4))).add({cube(4)}, binary);
  CHECK(overlapping.check(validate::GroupKind::building_parts).findings.at(0).code == 601);
  binary.origin[0] = {1, 2};
  const auto touching = Group(Group().add(cube(4))).add({cube(4)}, binary);
  CHECK(touching.check(validate::GroupKind::building_parts).verdict == Verdict::valid);
  CHECK(touching.check(validate::GroupKind::composite_solid).verdict == Verdict::undecided);
  Lattice far;
  for (auto& step : far.step) step = {1, -30};
  CHECK(Group(Group().add(cube(4)))
            .add({cube(4)}, far)
            .check(validate::GroupKind::building_parts)
            .verdict == Verdict::undecided);
  CHECK(Group(Group().add({cube(4)}, {}, 7415))
            .add({cube(4)}, {}, 28992)
            .check(validate::GroupKind::building_parts)
            .verdict == Verdict::undecided);
}

TEST_CASE("a cancelled comparison is undecided") {
  validate::GroupOptions options;
  options.cancel = [] { return true; };
  const validate::GroupReport report =
      Group().add(cube(4)).add(cube(4)).check(validate::GroupKind::composite_solid, options);
  CHECK(report.verdict == Verdict::undecided);
  CHECK(report.findings.empty());
  CHECK(report.not_run.size() == 1);
}

TEST_CASE("findings are bounded, and the report says that some were left out") {
  Group group;
  for (int i = 0; i < 20; ++i) group.add(cube(4));
  validate::GroupOptions options;
  options.limits.findings = 5;
  const validate::GroupReport report = group.check(validate::GroupKind::building_parts, options);
  CHECK(report.findings.size() == 5);
  CHECK(report.not_run.size() == 1);
  CHECK(report.verdict == Verdict::invalid);
}

TEST_CASE("groups of no, one and no valid member have no findings") {
  CHECK(validate::check_group({}, validate::GroupKind::composite_solid).verdict == Verdict::valid);
  CHECK(composite_codes(Group().add(cube(4))).empty());
  CHECK(composite_codes(Group().add_invalid().add_invalid()).empty());
}

TEST_CASE("a point of a triangle in doubles is located like the same point in rationals") {
  const std::vector<Point> vertices{{0, 0, 0}, {8, 0, 0}, {0, 8, 0}, {0, 0, 8}};
  const std::vector<Triangle> tetrahedron{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  std::mt19937 random(7);
  std::uniform_int_distribution<int> coordinate(-2, 9);
  const auto point = [&] {
    return Point{double(coordinate(random)), double(coordinate(random)),
                 double(coordinate(random))};
  };
  int inside = 0;
  for (int i = 0; i < 3000; ++i) {
    const std::array<Point, 3> corners{point(), point(), point()};
    const geometry::TrianglePoint at = geometry::triangle_point(corners, 2 + 2 * (i % 5), 1);
    const auto exact = geometry::exact_doubles(at);
    REQUIRE(exact);
    // A point is inside if all coordinates are positive and their sum is below 8.
    const double least =
        std::min({exact->x, exact->y, exact->z, 8 - exact->x - exact->y - exact->z});
    const int expected = least > 0 ? 1 : least < 0 ? -1 : 0;
    CHECK(geometry::locate_exactly(at, vertices, tetrahedron) == expected);
    inside += expected == 1 ? 1 : 0;
  }
  CHECK(inside > 100);
}

TEST_CASE("the comparison does not depend on the order of members") {
  std::mt19937 random(11);
  std::uniform_int_distribution<int> coordinate(0, 5);
  std::uniform_int_distribution<int> size(1, 3);
  int overlaps = 0;
  int touches = 0;
  for (int i = 0; i < 400; ++i) {
    const auto corner_of = [&] {
      return Point{double(coordinate(random)), double(coordinate(random)),
                   double(coordinate(random))};
    };
    const auto box_at = [&](const Point& p) {
      return std::pair(p, Point{p.x + size(random), p.y + size(random), p.z + size(random)});
    };
    const auto [a, b] = box_at(corner_of());
    const auto [c, d] = box_at(corner_of());
    // The overlap of two boxes is the overlap of their intervals.
    int positive = 0;
    int zero = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double length = std::min(b[axis], d[axis]) - std::max(a[axis], c[axis]);
      positive += length > 0 ? 1 : 0;
      zero += length == 0 ? 1 : 0;
    }
    CodeList expected;
    if (a == c && b == d) {
      expected = {502};
    } else if (positive == 3) {
      expected = {501};
    } else if (positive != 2 || zero != 1) {
      expected = {503};
    }
    overlaps += positive == 3 ? 1 : 0;
    touches += expected.empty() ? 1 : 0;
    CHECK(composite_codes(box(a, b), box(c, d)) == expected);
    CHECK(composite_codes(box(c, d), box(a, b)) == expected);
  }
  CHECK(overlaps > 20);
  CHECK(touches > 10);
}

TEST_CASE("neighbours are compared also where the box of one is within that of the other") {
  using validate::CellContact;
  const auto contact = [](const Shell& a, const Shell& b) {
    const CellContact found = Group().add(a).add(b).contact();
    CHECK(Group().add(b).add(a).contact() == found);
    return found;
  };
  const Shell u = u_shape();  // its notch is from x 2 to 4 and from y 2 on
  CHECK(contact(u, box({2.5, 3, 1}, {3.5, 5, 3})) == CellContact::apart);
  CHECK(contact(u, box({2, 3, 1}, {3.5, 5, 3})) == CellContact::area);
  CHECK(contact(u, box({1, 3, 1}, {3.5, 5, 3})) == CellContact::area);
  CHECK(contact(u, prism({{2, 3}, {3, 2.5}, {3, 3.5}}, 1, 3)) == CellContact::at_points);
  CHECK(contact(u, box({7, 0, 0}, {8, 1, 1})) == CellContact::apart);
  const Group hollow =
      Group().add({cube(10), inside_out(box({2, 2, 2}, {3, 3, 3}))}).add(box({2, 2, 2}, {3, 3, 3}));
  CHECK(hollow.contact() == CellContact::area);
}

}  // namespace
}  // namespace watertight::test
