// SPDX-License-Identifier: GPL-3.0-or-later
//
// Prints the library's results for the solids of files, as rows for COPY: name, EWKB, blob (\N if
// the solid is not valid). The row of a golden blob has the solid that the blob decodes to.
// run_regress.sh compares the rows with the results of the extension for the same EWKB. Undecided
// solids and files that are no document are left out.
#include <cstdio>

#include "codec/blob.h"
#include "formats/document.h"
#include "formats/ewkb.h"
#include "tests/files.h"
#include "validate/certify.h"

using namespace watertight;

namespace {

std::string hex(ByteView bytes) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text = "\\\\x";
  for (const std::uint8_t byte : bytes) {
    text += kDigits[byte >> 4U];
    text += kDigits[byte & 15U];
  }
  return text;
}

/// Prints the row of a solid. The solid goes through EWKB first, as in SQL: its coordinates are
/// doubles, and its vertices are in order of first use.
void print_row(const std::string& name, const Solid& solid, delaunay::EngineWorkers& workers) {
  const Bytes ewkb = formats::write_ewkb(solid);
  const auto submitted = formats::read_ewkb(ewkb);
  if (!submitted) return;
  CertifyOptions options;
  options.rounded = submitted->rounded;
  const Inspection inspection = certify(submitted->solid, &workers, options);
  if (inspection.report.verdict == Verdict::undecided) return;
  std::string blob = "\\N";
  if (inspection.certified) {
    const auto encoded = encode(inspection.certified->solid);
    blob = encoded ? hex(*encoded) : to_string(encoded.error());
  }
  std::printf("%s\t%s\t%s\n", name.c_str(), hex(ewkb).c_str(), blob.c_str());
}

void print_document(const std::string& file, ByteView bytes, delaunay::EngineWorkers& workers) {
  const auto format = formats::detect_format(file, bytes);
  if (!format) return;
  const auto document = formats::read_document(bytes, *format);
  if (!document) return;
  std::size_t number = 0;
  for (const Feature& feature : document->features) {
    for (const SubmittedSolid& submitted : feature.solids) {
      print_row(file + " " + std::to_string(number++), submitted.solid, workers);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  delaunay::EngineWorkers workers;
  for (int i = 1; i < argc; ++i) {
    const std::string file = argv[i];
    const Bytes bytes = test::read_bytes(file);
    if (const auto decoded = decode(bytes)) {
      print_row(file, decoded->solid, workers);
    } else {
      print_document(file, bytes, workers);
    }
  }
  return 0;
}
