// SPDX-License-Identifier: GPL-3.0-or-later
#include <limits>

#include "report/number_text.h"
#include "tests/unit/report/samples.h"

using namespace watertight;
using namespace watertight::test;

namespace {

Finding measured(double value, std::optional<double> limit = {}, const std::string& unit = "m") {
  Finding finding = finding_of(203, 0);
  finding.measured = value;
  finding.limit = limit;
  finding.unit = unit;
  return finding;
}

std::string words(double value, std::optional<double> limit = {}, const std::string& unit = "m") {
  return report::measure_words(measured(value, limit, unit));
}

}  // namespace

TEST_CASE("metres are written as people write them") {
  CHECK(words(9.89865e-05) == "0.1 mm");
  CHECK(words(1.8349) == "1.83 m");
  CHECK(words(0.0250001, 0.01) == "25 mm, limit 10 mm");
  CHECK(words(0.183) == "183 mm");
  CHECK(words(0.99999) == "1 m");
  CHECK(words(0) == "0 m");
  CHECK(words(-0.004) == "-4 mm");
  CHECK(words(3.2e-8) == "32 nm");
  CHECK(words(2.34e-6) == "2.3 \xC2\xB5m");
  CHECK(words(1.234e-14) == "1.2e-14 m");
  CHECK(words(1e300) == "1e+300 m");
  CHECK(words(std::numeric_limits<double>::infinity()) == "inf m");
}

TEST_CASE("a value that exceeds its limit never reads like the limit") {
  CHECK(words(0.0100004, 0.01) == "10.0004 mm, limit 10 mm");
  CHECK(words(0.01, 0.01) == "10 mm, limit 10 mm");
  CHECK(words(20.0001, 20.0, "degree") == "20.0001 degrees, limit 20");
}

TEST_CASE("counts and angles keep their units") {
  CHECK(words(4, 0, "edges") == "4 edges, limit 0");
  CHECK(words(25.3456, 20, "degree") == "25.35 degrees, limit 20");
  CHECK(words(0.000123456, {}, "cubic units") == "0.000123 cubic units");
  CHECK(words(5, {}, "") == "5");
  CHECK(report::measure_words(finding_of(302, 0)).empty());
}

TEST_CASE("the columns of a table have plain numbers in the finding's unit") {
  const report::MeasureText small = report::measure_columns(measured(9.89865e-05, 0.01));
  CHECK(small.measured == "0.0001");
  CHECK(small.limit == "0.01");
  CHECK(small.unit == "m");
  CHECK(report::measure_columns(measured(1.8349)).measured == "1.83");
  CHECK(report::measure_columns(measured(4, 0, "edges")).measured == "4");
  CHECK(report::measure_columns(finding_of(302, 0)).unit.empty());
}

TEST_CASE("coordinates have nine digits for the largest of them") {
  CHECK(report::point_text({84616.468, 447422.9990001, 0.45}) == "84616.468 447422.999 0.45");
  CHECK(report::point_text({4.35612345678, 52.0123456789, -3}) == "4.3561235 52.0123457 -3");
  CHECK(report::point_text({0, 0, 0}) == "0 0 0");
  CHECK(report::point_text({1e-20, 0, -1e-20}) == "1e-20 0 -1e-20");
  CHECK(report::point_text({1e300, -0.0, 1}) == "1e+300 0 1");
}
