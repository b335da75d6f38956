// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/unit/report/samples.h"

using namespace watertight;
using namespace watertight::test;

namespace {

std::string table_of(const std::vector<pipeline::ValidatedFeature>& features,
                     const std::string& name = "a.city.json") {
  Written written;
  const auto report = report::csv_report(written.sink());
  write_document(*report, name, features);
  REQUIRE(report->finish());
  return written.text;
}

/// The fields of a table by the rules of RFC 4180.
std::vector<std::vector<std::string>> rows_of(const std::string& text) {
  std::vector<std::vector<std::string>> rows(1, std::vector<std::string>(1));
  bool is_quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"') {
      const bool is_doubled = is_quoted && i + 1 < text.size() && text[i + 1] == '"';
      if (is_doubled) rows.back().back() += text[++i];
      if (!is_doubled) is_quoted = !is_quoted;
    } else if (text[i] == ',' && !is_quoted) {
      rows.back().emplace_back();
    } else if (text.compare(i, 2, "\r\n") == 0 && !is_quoted) {
      ++i;
      rows.emplace_back(1);
    } else {
      rows.back().back() += text[i];
    }
  }
  CHECK_FALSE(is_quoted);
  CHECK(rows.back() == std::vector<std::string>(1));
  rows.pop_back();
  return rows;
}

}  // namespace

TEST_CASE("a table has a header and a row for each finding") {
  Finding finding = finding_of(203, 2);
  finding.witness = std::array<double, 3>{84616.5, 447422.25, 3};
  finding.measured = 9.89865e-05;
  finding.limit = 0.01;
  finding.unit = std::string(1, 'm');
  const auto rows = rows_of(table_of({feature_of("a", {}), feature_of("b", {finding})}));
  REQUIRE(rows.size() == 2);
  using Row = std::vector<std::string>;
  CHECK(rows[0] == Row{"file", "feature", "object", "lod", "geometry", "solid", "code", "name",
                       "severity", "x", "y", "z", "measured", "limit", "unit", "detail"});
  CHECK(rows[1] == Row{"a.city.json", "b", "b", "2.2", "0", "0", "203",
                       "NON_PLANAR_POLYGON_DISTANCE_PLANE", "error", "84616.5", "447422.25", "3",
                       "0.0001", "0.01", "m", "a detail"});
}

TEST_CASE("text of documents keeps within its field") {
  const std::string hostile = "a,\"b\"\r\nc";
  const auto rows = rows_of(table_of({feature_of(hostile, {finding_of(302, 0)})}, hostile));
  REQUIRE(rows.size() == 2);
  REQUIRE(rows[1].size() == 16);
  CHECK(rows[1][15] == "a detail");
}

TEST_CASE("a spreadsheet takes no id for a formula") {
  for (const std::string id : {"=1+1", "+1", "-1", "@SUM(A1)"}) {
    const auto rows = rows_of(table_of({feature_of(id, {finding_of(302, 0)})}));
    REQUIRE(rows.size() == 2);
    CHECK(rows[1][1].substr(1) == id);
    CHECK(rows[1][1].front() == '\'');
  }
}

TEST_CASE("a document that cannot be read is a row, and an empty run has the header") {
  Written written;
  const auto report = report::csv_report(written.sink());
  REQUIRE(report->begin_document({"a", std::nullopt}));
  REQUIRE(report->add_error({ErrorCode::malformed, "no vertices", 17, "/vertices"}));
  REQUIRE(report->end_document({}));
  REQUIRE(report->finish());
  const auto rows = rows_of(written.text);
  REQUIRE(rows.size() == 2);
  REQUIRE(rows[1].size() == 16);
  CHECK(rows[1][6] == "901");
  CHECK(rows[1][15].find("no vertices") != std::string::npos);
  CHECK(rows_of(table_of({})).size() == 1);
}
