// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/unit/validate/solids.h"

using namespace watertight;
using namespace watertight::test;

using Codes = std::set<int>;

TEST_CASE("a cube is valid, with certificate and measures") {
  const Inspection inspection = certify(solid_of({cube(4)}), nullptr);
  CHECK(inspection.report.verdict == Verdict::valid);
  CHECK(inspection.report.findings.empty());
  CHECK(inspection.report.first_level.empty());
  REQUIRE(inspection.certified);
  CHECK(inspection.certified->certificate);
  CHECK(inspection.certified->solid.solid().vertex_count() == 8);
  REQUIRE(inspection.report.measures);
  CHECK(inspection.report.measures->volume == 64);
}

TEST_CASE("the boundary proof needs no tetrahedralization") {
  CertifyOptions options;
  options.proof = Proof::boundary;
  const Inspection one = certify(solid_of({cube(4)}), nullptr, options);
  CHECK(one.report.verdict == Verdict::valid);
  REQUIRE(one.certified);
  CHECK_FALSE(one.certified->certificate);
  CHECK(one.certified->solid.acceptance().proof == Proof::boundary);
  const Inspection two =
      certify(solid_of({cube(9), inside_out(box({1, 1, 1}, {3, 3, 3}))}), nullptr, options);
  CHECK(two.report.verdict == Verdict::valid);
  CHECK(two.certified);
}

/// A room in which cavities enclose an octahedron: two pyramids, base to base, or only one of them.
std::vector<Shell> room_with_pyramids(bool has_both) {
  const Point a{2, 2, 4};
  const Point b{6, 2, 4};
  const Point c{6, 6, 4};
  const Point d{2, 6, 4};
  const auto roof = [&](const Point& tip) {
    return Shell{{{a, b, tip}}, {{b, c, tip}}, {{c, d, tip}}, {{d, a, tip}}};
  };
  // A cavity between two roofs whose tips are at the heights `inner` and `outer`.
  const auto lid = [&](double inner, double outer) {
    const Shell near = roof({4, 4, inner});
    const Shell far = roof({4, 4, outer});
    return outer > inner ? join(inside_out(far), near) : join(far, inside_out(near));
  };
  std::vector<Shell> shells{cube(8), lid(6, 7)};
  if (has_both) shells.push_back(lid(2, 1));
  return shells;
}

TEST_CASE(
    "cavities that meet along a closed chain of edges cut the interior, by exact tests alone") {
  CertifyOptions options;
  options.proof = Proof::boundary;
  const Inspection open = certify(solid_of(room_with_pyramids(false)), nullptr, options);
  CHECK(error_codes(open.report).empty());
  CHECK(open.report.verdict == Verdict::valid);
  const Inspection shut = certify(solid_of(room_with_pyramids(true)), nullptr, options);
  CHECK(shut.report.verdict == Verdict::invalid);
  CHECK(error_codes(shut.report) == Codes{404});
  const Finding* finding = first_finding(shut.report, 404);
  REQUIRE(finding);
  CHECK(finding->place.shell > 0);
}

/// A solid with a tetrahedral cavity that seals the corner at the origin off: three edges of the
/// cavity are the shorter diagonals of the three quadrilaterals there, which are `bulge` off their
/// planes.
std::vector<Shell> sealed_corner(double bulge) {
  const Point o{0, 0, 0};
  const Point x{10000, bulge, bulge};
  const Point y{bulge, 10000, bulge};
  const Point z{bulge, bulge, 10000};
  const Point xy{11000, 11000, 0};
  const Point yz{0, 11000, 11000};
  const Point zx{11000, 0, 11000};
  const Point tip{20000, 20000, 20000};
  const Point inner{9000, 9000, 9000};
  const Shell outer{{{o, y, xy, x}}, {{o, z, yz, y}}, {{o, x, zx, z}},
                    {{tip, x, xy}},  {{tip, xy, y}},  {{tip, y, yz}},
                    {{tip, yz, z}},  {{tip, z, zx}},  {{tip, zx, x}}};
  const Shell cavity{{{x, y, z}}, {{y, x, inner}}, {{z, y, inner}}, {{x, z, inner}}};
  return {outer, cavity};
}

TEST_CASE("a cavity whose edges are diagonals of flat facets cuts a corner off") {
  for (const Proof proof : {Proof::boundary, Proof::tetrahedralization}) {
    CertifyOptions options;
    options.proof = proof;
    const Report report =
        certify(solid_of(sealed_corner(0), lattice_of(0.001)), nullptr, options).report;
    CHECK(error_codes(report) == Codes{404});
    CHECK_FALSE(first_finding(report, 804));
  }
}

TEST_CASE("804 reports where another diagonal would open a corner that a cavity seals off") {
  CertifyOptions options;
  options.proof = Proof::boundary;
  const Report report =
      certify(solid_of(sealed_corner(4), lattice_of(0.001)), nullptr, options).report;
  CHECK(error_codes(report) == Codes{404});
  std::set<Index> facets;
  for (const Finding& finding : report.findings) {
    if (finding.code != 804) continue;
    CHECK(finding.detail.find("be connected") != std::string::npos);
    facets.insert(finding.place.facet);
  }
  CHECK(facets == std::set<Index>{0, 1, 2});
}

TEST_CASE("an invalid solid is never certified") {
  const Inspection inspection = certify(solid_of({inside_out(cube(4))}), nullptr);
  CHECK(inspection.report.verdict == Verdict::invalid);
  CHECK_FALSE(inspection.certified);
}

TEST_CASE("findings of all levels are reported, not those of the first failing level only") {
  Shell shell = cube(8);
  // The facet is off its plane, and its edges are open.
  shell[1] = {Ring{{0, 0, 8}, {8, 0, 8}, {8, 8, 9}, {0, 8, 8}}};
  shell = join(shell, corner({3, 3, 7}, 4));  // the tetrahedron crosses the top
  const Report report = report_of({shell});
  CHECK(error_codes(report) == Codes{203, 302, 305, 306});
  CHECK(report.first_level == std::vector<int>{203});
  const Finding* crossing = first_finding(report, 306);
  REQUIRE(crossing);
  CHECK(crossing->uncertain);
}

TEST_CASE("a T-junction is 302 and names the vertex and the edge") {
  Shell shell = cube(4);
  shell[1] = {Ring{{0, 0, 4}, {2, 0, 4}, {4, 0, 4}, {4, 4, 4}, {0, 4, 4}}};
  const Report report = report_of({shell});
  CHECK(error_codes(report) == Codes{302});
  REQUIRE(report.findings.size() == 1);
  const Finding& finding = report.findings[0];
  CHECK(finding.detail.find("T-junction") == 0);
  CHECK(finding.witness == std::array<double, 3>{2, 0, 4});
  CHECK(finding.place.facet == 2);
  REQUIRE(finding.other);
  CHECK(finding.other->facet == 1);
}

TEST_CASE("a missing facet is one border, two missing facets apart are two") {
  Shell shell = cube(4);
  shell.pop_back();
  CHECK(report_of({shell}).findings.size() == 1);
  shell.erase(shell.begin() + 3);  // erases the opposite wall
  const Report report = report_of({shell});
  CHECK(report.findings.size() == 2);
  CHECK(error_codes(report) == Codes{302});
}

TEST_CASE("a hole may touch an edge of its facet where the facet across has the vertex") {
  const Point v{4, 0, 8};
  const Ring rim{v, {6, 4, 8}, {2, 4, 8}};
  const Point bottom{4, 3, 6};
  Shell shell = cube(8);
  shell[1].push_back({rim[2], rim[1], rim[0]});
  for (std::size_t i = 0; i < 3; ++i) shell.push_back({{rim[i], rim[(i + 1) % 3], bottom}});
  const Report open = report_of({shell});
  CHECK(error_codes(open) == Codes{302});
  REQUIRE(open.findings.size() == 1);
  CHECK(open.findings[0].place.facet == 2);
  CHECK(open.findings[0].other->facet == 1);
  CHECK(open.findings[0].other->ring == 0);
  CHECK(open.findings[0].detail.find("T-junction") != std::string::npos);
  CHECK_FALSE(open.measures);

  Ring& front = shell[2][0];
  front.insert(std::find(front.begin(), front.end(), Point{8, 0, 8}) + 1, v);
  const Inspection inspection = certify(solid_of({shell}), nullptr, {});
  CHECK(inspection.report.findings.empty());
  REQUIRE(inspection.certified);
  // The certified solid has the submitted rings.
  CHECK(inspection.certified->solid.solid().ring(1).size() == 4);

  // A vertex of a ring inside an edge of the same ring is an error.
  Shell own = cube(8);
  own[1][0] = {{0, 0, 8}, {8, 0, 8}, {8, 8, 8}, {4, 0, 8}, {0, 8, 8}};
  CHECK(error_codes(report_of({own})).contains(104));
}

TEST_CASE("solids that touch in a vertex or an edge are not 2-manifold") {
  const Report vertex = report_of({join(cube(2), box({2, 2, 2}, {4, 4, 4}))});
  CHECK(error_codes(vertex) == Codes{303});
  CHECK(vertex.findings[0].detail.find("interior_connected: no") != std::string::npos);
  const Report edge = report_of({join(cube(2), box({2, 2, 0}, {4, 4, 2}))});
  CHECK(error_codes(edge) == Codes{303});
  CHECK(edge.findings[0].measured == 4.0);
}

TEST_CASE("a pinch that leaves the interior connected says so") {
  // A cavity that touches the outside in a vertex belongs to the exterior shell.
  const Point apex{0, 0, 0};
  const Point a{4, 2, 2};
  const Point b{2, 4, 2};
  const Point c{2, 2, 4};
  const Shell inner{{{apex, b, a}}, {{apex, a, c}}, {{a, b, c}}, {{b, apex, c}}};
  const Report report = report_of({join(cube(8), inside_out(inner))});
  CHECK(error_codes(report) == Codes{303});
  CHECK(report.findings[0].detail.find("interior_connected: yes") != std::string::npos);
}

TEST_CASE("facets turned over are found through their neighbours") {
  Shell shell = cube(4);
  std::reverse(shell[3][0].begin(), shell[3][0].end());
  const Report report = report_of({shell});
  CHECK(error_codes(report) == Codes{307});
  REQUIRE(report.findings.size() == 1);
  CHECK(report.findings[0].place.facet == 3);
}

TEST_CASE("cavities are valid inside, and may touch the exterior in a vertex or along an edge") {
  CHECK(report_of({cube(9), inside_out(box({3, 3, 3}, {6, 6, 6}))}).verdict == Verdict::valid);
  const Point apex{0, 0, 0};
  const Shell inner{{{apex, {2, 4, 2}, {4, 2, 2}}},
                    {{apex, {4, 2, 2}, {2, 2, 4}}},
                    {{{4, 2, 2}, {2, 4, 2}, {2, 2, 4}}},
                    {{{2, 4, 2}, apex, {2, 2, 4}}}};
  CHECK(error_codes(report_of({cube(8), inside_out(inner)})).empty());
  const Shell along{{{{0, 0, 0}, {0, 0, 8}, {4, 3, 4}}},
                    {{{0, 0, 8}, {0, 0, 0}, {3, 4, 4}}},
                    {{{0, 0, 0}, {4, 3, 4}, {3, 4, 4}}},
                    {{{0, 0, 8}, {3, 4, 4}, {4, 3, 4}}}};
  CHECK(error_codes(report_of({cube(8), along})).empty());
}

TEST_CASE("cavities that cross, share a face, lie outside or in each other are found") {
  const Shell outer = cube(9);
  const auto cavity = [](const Point& low, const Point& high) {
    return inside_out(box(low, high));
  };
  CHECK(error_codes(report_of({outer, cavity({7, 3, 3}, {12, 6, 6})})) == Codes{401});
  CHECK(error_codes(report_of({outer, cavity({6, 3, 3}, {9, 6, 6})})) == Codes{401});
  CHECK(error_codes(report_of({outer, cavity({12, 3, 3}, {15, 6, 6})})) == Codes{403});
  CHECK(error_codes(report_of(
            {outer, cavity({1, 1, 1}, {8, 8, 8}), cavity({3, 3, 3}, {5, 5, 5})})) == Codes{401});
  CHECK(error_codes(report_of(
            {outer, cavity({1, 1, 1}, {3, 3, 3}), cavity({3, 1, 1}, {5, 3, 3})})) == Codes{401});
  CHECK(error_codes(report_of(
            {outer, cavity({1, 1, 1}, {3, 3, 3}), cavity({1, 1, 1}, {3, 3, 3})})) == Codes{402});
  CHECK(error_codes(report_of({outer, inside_out(cube(9))})) == Codes{402});
}

TEST_CASE("a cavity that crosses the wall only along edges is found") {
  // Four edges of the octahedron lie in the wall x = 9: one half of it is outside.
  const std::vector<Point> ring{{9, 3, 3}, {9, 6, 3}, {9, 6, 6}, {9, 3, 6}};
  Shell octahedron;
  for (std::size_t i = 0; i < 4; ++i) {
    octahedron.push_back({{ring[i], ring[(i + 1) % 4], {12, 4, 4}}});
    octahedron.push_back({{ring[(i + 1) % 4], ring[i], {6, 4, 4}}});
  }
  CHECK(error_codes(report_of({cube(9), inside_out(octahedron)})) == Codes{401});
}

TEST_CASE("shells turned the wrong way are found, each by itself") {
  CHECK(error_codes(report_of({inside_out(cube(4))})) == Codes{405});
  const Report report = report_of({cube(9), box({3, 3, 3}, {6, 6, 6})});
  CHECK(error_codes(report) == Codes{405});
  CHECK(report.findings[0].place.shell == 1);
}

TEST_CASE("a part of a shell that floats inside is a component, not a cavity") {
  CHECK(error_codes(report_of({join(cube(9), inside_out(box({3, 3, 3}, {6, 6, 6})))})) ==
        Codes{305});
}

TEST_CASE("equal vertices are one vertex, whatever their numbers") {
  // solid_of() gives every corner a vertex of its own, 24 for a cube.
  const Solid solid = solid_of({cube(4)});
  CHECK(solid.vertex_count() == 24);
  CHECK(certify(solid, nullptr).report.verdict == Verdict::valid);
}

TEST_CASE("planarity is measured in metres through the lattice and the tolerances") {
  Shell shell = cube(1000);
  for (Facet& facet : shell) {
    for (Point& p : facet[0]) {
      if (p == Point{1000, 1000, 1000}) p.z = 1030;
    }
  }
  Lattice millimetres;
  millimetres.step.fill(GridNumber{1, -3});
  const auto codes = [&](double metres) {
    CertifyOptions options;
    options.tolerances.planarity_metres = metres;
    return error_codes(certify(solid_of({shell}, millimetres), nullptr, options).report);
  };
  CHECK(codes(0.01).empty());  // one corner is 30 mm up: 7.5 mm off the fitted plane
  CHECK(codes(0.005) == Codes{203});
  CHECK(error_codes(report_of({shell})) == Codes{203});  // the coordinates are metres
}

TEST_CASE("exactly planar facets have no planarity finding, however long and thin") {
  // A prism of 1 x 1 x 4e9 along a direction that no plane of doubles fits well.
  const Point d{3999999999.0, 2999999999.0, 1999999999.0};
  const auto along = [&](const Point& p) { return Point{p.x + d.x, p.y + d.y, p.z + d.z}; };
  const Point a{0, 0, 0};
  const Point b{1, 0, 0};
  const Point c{0, 1, 0};
  const Shell prism{{{a, c, b}},
                    {{along(a), along(b), along(c)}},
                    {{a, b, along(b), along(a)}},
                    {{b, c, along(c), along(b)}},
                    {{c, a, along(a), along(c)}}};
  CertifyOptions options;
  options.tolerances.planarity_metres = 1e-12;
  options.tolerances.planarity_degrees = 1e-9;
  options.proof = Proof::boundary;
  CHECK(error_codes(report_of({prism}, options)).empty());
}

TEST_CASE("a snap tolerance closes a gap, and the report says that the solid is another one") {
  Shell shell = cube(1000);
  shell[1][0][2].x = 1001;  // one corner of the top is 1 mm off
  Lattice millimetres;
  millimetres.step.fill(GridNumber{1, -3});
  const Solid solid = solid_of({shell}, millimetres);
  CHECK(error_codes(certify(solid, nullptr).report).count(302) == 1);
  CertifyOptions options;
  options.tolerances.snap_metres = 0.0015;
  const Inspection snapped = certify(solid, nullptr, options);
  CHECK(snapped.report.verdict == Verdict::valid);
  REQUIRE_FALSE(snapped.report.notes.empty());
  CHECK(snapped.report.notes[0].find("snap") != std::string::npos);
}

TEST_CASE("more findings than the limit are counted, and the verdict stays") {
  CertifyOptions options;
  options.limits.findings = 2;
  Shell shell = join(cube(9), join(box({-3, 3, 3}, {12, 4, 4}), box({3, -3, 3}, {4, 12, 4})));
  const Report report = report_of({shell}, options);
  CHECK(report.verdict == Verdict::invalid);
  CHECK(report.findings.size() == 2);
  CHECK(report.findings_omitted > 0);
}

TEST_CASE("nothing crashes on empty and degenerate solids") {
  for (const std::vector<Shell>& shells :
       std::vector<std::vector<Shell>>{{},
                                       {{}},
                                       {{}, {}},
                                       {{{}}},
                                       {{{{}}}},
                                       {{{{{0, 0, 0}}}}},
                                       {{{{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}}}},
                                       {{{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}}}},
                                       {cube(0)},
                                       {cube(1), {}},
                                       {{}, cube(1)}}) {
    const Inspection inspection = certify(solid_of(shells), nullptr);
    CHECK(inspection.report.verdict == Verdict::invalid);
    CHECK_FALSE(inspection.report.first_level.empty());
  }
}

TEST_CASE("a cancelled certification is undecided, never valid") {
  CertifyOptions options;
  options.proof = Proof::boundary;
  options.ladder.cancel = [] { return true; };
  // A finely divided box has enough triangles for the search to call `cancel`.
  Shell shell;
  const int n = 90;
  for (const Facet& facet : cube(n)) {
    const Point& a = facet[0][0];
    const auto step = [&](std::size_t to) {
      const Point& b = facet[0][to];
      return Point{(b.x - a.x) / n, (b.y - a.y) / n, (b.z - a.z) / n};
    };
    const Point u = step(1);
    const Point v = step(3);
    const auto at = [&](int i, int j) {
      return Point{a.x + i * u.x + j * v.x, a.y + i * u.y + j * v.y, a.z + i * u.z + j * v.z};
    };
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        shell.push_back({{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)}});
      }
    }
  }
  const Inspection inspection = certify(solid_of({shell}), nullptr, options);
  CHECK(inspection.report.verdict == Verdict::undecided);
  CHECK_FALSE(inspection.certified);
  options.ladder.cancel = {};
  CHECK(certify(solid_of({shell}), nullptr, options).report.verdict == Verdict::valid);
}

// tests/fuzz/fuzz_certify.cpp found: the place of finding 305 was taken from the exterior ring.
TEST_CASE("an empty exterior ring in a part of its own is reported, not divided by") {
  Shell shell = join(cube(4), {{Ring{}, Ring{{9, 9, 9}, {9, 9, 8}, {9, 8, 9}}}});
  const Report report = report_of({shell});
  CHECK(report.verdict == Verdict::invalid);
  const auto part = std::find_if(report.findings.begin(), report.findings.end(),
                                 [](const Finding& finding) { return finding.code == 305; });
  REQUIRE(part != report.findings.end());
  CHECK(part->place.facet == 6);
  CHECK(part->place.ring == 1);
  CHECK(part->place.vertex != kNone);
}
