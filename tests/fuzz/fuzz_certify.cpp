// SPDX-License-Identifier: GPL-3.0-or-later
//
// libFuzzer harness of the validator and the codec behind it: small solids on a coarse grid, with
// many coincidences. Input: scale (1 byte), number of vertices (1), their coordinates (3 each),
// then bytes: 0 ends a facet, 255 ends a shell, any other begins a ring and gives its size, before
// its vertices. The report must be consistent and must not contradict that of the other proof, and
// a valid solid must come back equal from its blob.
#include <algorithm>
#include <array>

#include "base/bytes.h"
#include "codec/blob.h"
#include "fuzz_formats.h"
#include "validate/certify.h"
#include "validate/report_json.h"

namespace {

using namespace watertight;

constexpr std::size_t kMaxVertices = 24;
constexpr std::size_t kMaxCorners = 160;
constexpr std::uint8_t kFloats = 4;  // the bit of the scale for coordinates on no common grid
constexpr std::array<double, 4> kScales{1, 3, 1048577, 562949953421311};

Result<Solid> solid_of(ByteReader reader) {
  const std::uint8_t scale = reader.u8();
  Lattice lattice;
  if ((scale & kFloats) != 0) lattice.kind = LatticeKind::float64;
  const double step = kScales[scale % 4] / ((scale & kFloats) != 0 ? 10 : 1);
  SolidArrays arrays;
  const std::size_t count = 1 + reader.u8() % kMaxVertices;
  for (std::size_t i = 0; i < count; ++i) {
    Point point;
    for (int axis = 0; axis < 3; ++axis) point[axis] = (reader.u8() % 16) * step;
    arrays.vertices.push_back(point);
  }
  while (reader.remaining() > 0 && arrays.ring_vertices.size() < kMaxCorners) {
    const std::uint8_t byte = reader.u8();
    if (byte == 0) {
      arrays.end_facet();
    } else if (byte == 255) {
      arrays.end_facet();
      arrays.end_shell();
    } else {
      for (int i = 0; i < byte % 9; ++i) {
        arrays.ring_vertices.push_back(static_cast<Index>(reader.u8() % count));
      }
      arrays.end_ring();
    }
  }
  arrays.end_facet();
  arrays.end_shell();
  return Solid::make(std::move(arrays), lattice, 0, fuzz::small_limits());
}

void check_report(const Inspection& inspection) {
  const Report& report = inspection.report;
  const bool has_error = std::any_of(report.findings.begin(), report.findings.end(),
                                     [](const auto& f) { return f.severity == Severity::error; });
  fuzz::require(has_error == (report.verdict == Verdict::invalid));
  fuzz::require(inspection.certified.has_value() == (report.verdict == Verdict::valid));
  fuzz::require(report.undecided_reason.empty() == (report.verdict != Verdict::undecided));
}

void check_codec(const validate::Certified& certified) {
  for (const Mode mode : {Mode::automatic, Mode::raw, Mode::bitmap}) {
    const auto blob = encode(certified.solid, {.mode = mode});
    if (!blob) {
      fuzz::require(mode != Mode::automatic && blob.error().code == ErrorCode::not_encodable);
      continue;
    }
    const auto decoded = decode(*blob);
    fuzz::require(decoded.has_value() && decoded->solid == certified.solid.solid());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto solid = solid_of(ByteReader(ByteView(data, size)));
  fuzz::require(solid.has_value());
  const Inspection inspection = certify(*solid, nullptr);
  check_report(inspection);
  fuzz::require(!validate::report_json(inspection.report, *solid, {}).empty());
  CertifyOptions options;
  options.proof = Proof::boundary;
  const Inspection boundary = certify(*solid, nullptr, options);
  check_report(boundary);
  // The two proofs may leave different solids undecided, but must not contradict each other.
  const bool is_valid_for_one = inspection.certified || boundary.certified;
  const bool is_invalid_for_one =
      inspection.report.verdict == Verdict::invalid || boundary.report.verdict == Verdict::invalid;
  fuzz::require(!(is_valid_for_one && is_invalid_for_one));
  if (inspection.certified) check_codec(*inspection.certified);
  return 0;
}
