// SPDX-License-Identifier: GPL-3.0-or-later
//
// A corpus: valid solids of many files in canonical form, in one file that loads fast. It serves to
// train and to measure the models of the codec. A record is the name of a data set and a raw blob
// in source order.
#pragma once

#include <string>
#include <vector>

#include "base/bytes.h"
#include "codec/page/integer_solid.h"
#include "geometry/canonical_form.h"
#include "geometry/valid_solid.h"

namespace watertight {

struct CorpusSolid {
  std::string set;  // the file of the solid, without its extension
  Acceptance acceptance;
  OrientedBoundary source;
  geometry::CanonicalSolid canonical;
};

/// Writes one record.
Bytes write_corpus_record(const std::string& set, const ValidSolid& solid);

/// Reads a corpus. Ends the program with a message if the file is not a corpus.
std::vector<CorpusSolid> read_corpus(const std::string& path);

}  // namespace watertight
