// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/html/scene.h"
#include "report/place.h"
#include "tests/unit/report/samples.h"

using namespace watertight;
using namespace watertight::test;

namespace {

std::string page_of(const std::vector<pipeline::ValidatedFeature>& features,
                    const report::HtmlOptions& options = {},
                    const std::string& name = "a.city.json") {
  Written written;
  const auto report = report::html_report(written.sink(), head_without_times(), options);
  write_document(*report, name, features);
  REQUIRE(report->finish());
  return written.text;
}

std::size_t count_of(std::string_view part, std::string_view text) {
  std::size_t count = 0;
  for (auto at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++count;
  return count;
}

}  // namespace

TEST_CASE("the page has the counts, a row and a picture for each finding") {
  const std::string page =
      page_of({feature_of("a", {}), feature_of("b", {finding_of(306, 1, 4), finding_of(203, 2)})});
  CHECK(page.find("1 of 2 features is not valid.") != page.npos);
  CHECK(count_of("<tr class=\"error\" data-code=", page) == 2);
  CHECK(count_of("data-scene='{", page) == 2);
  CHECK(count_of("class=\"a\"", page) == 2);  // the facet of the finding
  CHECK(count_of("class=\"b\"", page) == 1);  // the other facet of a pair
}

TEST_CASE("the page loads nothing from elsewhere") {
  const std::string page = page_of({feature_of("b", {finding_of(306, 1, 4)})});
  CHECK(count_of("http", page) ==
        count_of("http-equiv", page) + count_of("http://www.w3.org", page));
  CHECK(page.find("src=") == page.npos);
  CHECK(page.find("@import") == page.npos);
}

TEST_CASE("text of hostile documents stays text") {
  const std::string evil = "\"'><script>alert(1)</script><img src=x onerror=y>\xff";
  Finding finding = finding_of(203, 0);
  finding.detail = evil;
  finding.unit = evil;
  finding.measured = 1;
  pipeline::ValidatedFeature feature = feature_of(evil, {finding});
  for (SolidSource* source :
       {&feature.inspected.feature.solids[0].source, &feature.inspected.solids[0].source}) {
    source->lod = evil;
    source->pointer = "/" + evil;
  }
  const std::string page = page_of({feature}, {}, evil);
  CHECK(page.find("<script>alert") == page.npos);
  CHECK(page.find("<img") == page.npos);
  CHECK(page.find('\xff') == page.npos);
  CHECK(count_of("<script>", page) == 1);
}

TEST_CASE("rows and pictures are capped and the page says so") {
  report::HtmlOptions options;
  options.most_rows = 5;
  options.most_pictures = 3;
  const std::string page =
      page_of(std::vector<pipeline::ValidatedFeature>(10, feature_of("b", {finding_of(306, 1, 4)})),
              options);
  CHECK(count_of("<tr class=\"error\" data-code=", page) == 5);
  CHECK(count_of("data-scene='{", page) == 3);
  CHECK(page.find("The first 5 of 10 findings") != page.npos);
  options.most_pictures_per_code = 1;
  CHECK(count_of(
            "data-scene='{",
            page_of({feature_of("b", {finding_of(306, 1), finding_of(306, 2), finding_of(203, 2)})},
                    options)) == 2);
}

TEST_CASE("the codes share the pictures, and rows without one show the figure of their code") {
  report::HtmlOptions options;
  options.most_pictures = 4;
  std::vector<pipeline::ValidatedFeature> features(10, feature_of("b", {finding_of(306, 1, 4)}));
  features.push_back(feature_of("c", {finding_of(203, 2), finding_of(203, 3), finding_of(203, 4)}));
  features.push_back(feature_of("d", {finding_of(104, 2)}));
  const std::string page = page_of(features, options);
  CHECK(count_of("data-scene='{", page) == 4);
  const auto pictures_of = [&](const std::string& code) {
    return count_of("data-code=\"" + code +
                        "\" data-severity=\"error\" data-measured=\"\">"
                        "<td class=\"pic\"><figure",
                    page);
  };
  CHECK(pictures_of("306") == 2);
  CHECK(pictures_of("203") == 1);
  CHECK(pictures_of("104") == 1);
  CHECK(count_of("<symbol id=\"figure-306\"", page) == 1);
  CHECK(count_of("<use href=\"#figure-306\"", page) == 8);
}

TEST_CASE("the findings of an object are together, under its name and that of its file") {
  pipeline::ValidatedFeature parts = overlapping_parts();
  parts.inspected.solids[0].inspection.report.findings = {finding_of(203, 1)};
  parts.inspected.solids[1].inspection.report.findings = {finding_of(203, 2)};
  Written written;
  const auto report = report::html_report(written.sink(), head_without_times());
  write_document(*report, "a.json", {parts});
  write_document(*report, "b.json", {feature_of("part-1", {finding_of(302, 0)})});
  REQUIRE(report->finish());
  CHECK(count_of("<h3>part-1 <span class=\"soft\">of building, in a.json</span>", written.text) ==
        1);
  CHECK(count_of("<h3>part-2 <span class=\"soft\">of building, in a.json</span>", written.text) ==
        1);
  CHECK(count_of("<h3>part-1 <span class=\"soft\">in b.json</span>", written.text) == 1);
  const auto first = written.text.find("<h3>part-1");
  const auto second = written.text.find("<h3>part-2");
  REQUIRE(first < second);
  CHECK(count_of("<tr class=\"error\"", written.text.substr(first, second - first)) == 2);
}

TEST_CASE("a page lists what became of curved solids") {
  pipeline::ValidatedFeature feature = feature_of("rod", {});
  REQUIRE(feature.inspected.solids.size() == 1);
  formats::Tessellation made;
  made.faces = 1234;
  made.chord = 0.01;
  made.chord_error = 0.00425;
  made.halvings = 2;
  made.left_out = {{"#104", "its loops <cross>"}};
  feature.inspected.solids[0].tessellation = made;
  const std::string page = page_of({feature});
  for (const char* part :
       {"<h2 id=\"curved\">Curved solids</h2>", "1 solid became polyhedra. 1 face left out.",
        "<td class=\"num\">1,234</td>", "0.00425 <span class=\"soft\">of 0.01</span>",
        "face #104 is left out: its loops &lt;cross&gt;",
        "chord halved 2 times until no facets crossed"}) {
    CAPTURE(part);
    CHECK(page.find(part) != std::string::npos);
  }
  CHECK(page_of({feature_of("box", {})}).find("id=\"curved\"") == std::string::npos);
}

TEST_CASE("a page says when nothing was checked") {
  pipeline::ValidatedFeature feature = feature_of("a", {});
  feature.inspected.solids.clear();
  feature.inspected.feature.solids.clear();
  CHECK(page_of({feature}).find("Nothing was checked: there are no solids.") != std::string::npos);
  CHECK(page_of({}).find("Nothing was checked") != std::string::npos);
  CHECK(page_of({feature_of("a", {})}).find("Nothing was checked") == std::string::npos);
}

TEST_CASE("a picture of two solids colours both") {
  const std::string page = page_of({overlapping_parts()});
  CHECK(count_of("class=\"a\"", page) == 6);
  CHECK(count_of("class=\"b\"", page) == 6);
  CHECK(count_of("class=\"w\"", page) == 1);
}

TEST_CASE("open edges are drawn as lines") {
  pipeline::ValidatedFeature feature = feature_of("b", {finding_of(302, 0)});
  SolidArrays arrays = feature.inspected.feature.solids[0].solid.arrays();
  arrays.facet_offsets.pop_back();
  arrays.ring_offsets.pop_back();
  arrays.ring_vertices.resize(arrays.ring_offsets.back());
  arrays.shell_offsets.back() = static_cast<Index>(arrays.facet_offsets.size() - 1);
  auto open = Solid::make(std::move(arrays), Lattice{}, 0);
  REQUIRE(open);
  feature.inspected.feature.solids[0].solid = *open;
  const std::string page = page_of({feature});
  const auto at = page.find("<path class=\"l\" d=\"");
  REQUIRE(at != page.npos);
  CHECK(count_of("M", std::string_view(page).substr(at, page.find("/>", at) - at)) == 4);
}

TEST_CASE("places that are out of range give no picture and no failure") {
  Finding finding = finding_of(306, 1000, 2000);
  finding.place.shell = 7;
  finding.place.ring = 9;
  finding.place.vertex = 1'000'000;
  CHECK(count_of("<tr class=\"error\" data-code=", page_of({feature_of("b", {finding})})) == 1);
}

TEST_CASE("a page without findings says that all is valid") {
  const std::string page = page_of({feature_of("a", {})});
  CHECK(page.find("The feature is valid.") != page.npos);
  CHECK(page.find("No findings") != page.npos);
}

TEST_CASE("equal input gives an equal page") {
  const std::vector<pipeline::ValidatedFeature> features{feature_of("b", {finding_of(306, 1, 4)})};
  CHECK(page_of(features) == page_of(features));
}

TEST_CASE("the picture of an open shell shows an edge that a vertex splits by its parts") {
  // A pit in the top, facet 1, has its vertex 8 inside the edge from 4 to 5; the front does not
  // have the vertex.
  const Solid box = box_at(0);
  SolidArrays arrays;
  arrays.vertices.assign(box.vertices().begin(), box.vertices().end());
  arrays.vertices.insert(
      arrays.vertices.end(),
      {{2000, 0, 2000}, {3000, 1500, 2000}, {1000, 1500, 2000}, {2000, 1000, 1000}});
  const auto add_ring = [&](std::span<const Index> ring) {
    arrays.ring_vertices.insert(arrays.ring_vertices.end(), ring.begin(), ring.end());
    arrays.end_ring();
  };
  for (Index facet = 0; facet < box.facet_count(); ++facet) {
    add_ring(box.ring(facet));
    if (facet == 1) add_ring(std::array<Index, 3>{10, 9, 8});
    arrays.end_facet();
  }
  for (const auto& wall : {std::array<Index, 3>{8, 9, 11}, {9, 10, 11}, {10, 8, 11}}) {
    add_ring(wall);
    arrays.end_facet();
  }
  arrays.end_shell();
  pipeline::ValidatedFeature feature = feature_of("a", {finding_of(302, 2, 1)});
  auto solid = Solid::make(std::move(arrays), box.lattice(), box.srid());
  REQUIRE(solid);
  feature.inspected.feature.solids[0].solid = *solid;
  const std::vector<report::PlacedFinding> findings = report::findings_of(feature.inspected);
  REQUIRE(findings.size() == 1);
  const auto scene = report::scene_of(feature.inspected, findings[0], {});
  REQUIRE(scene);
  CHECK(scene->lines.size() == 3);  // the edges 4-8, 8-5 and 4-5
}
