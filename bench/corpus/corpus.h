// SPDX-License-Identifier: GPL-3.0-or-later
//
// A corpus: valid solids of many files, canonical, in one file that loads fast. For training the
// models of the codec and for measuring it. A record is the name of a data set and a raw blob in
// source order.
#pragma once

#include <string>
#include <vector>

#include "base/bytes.h"
#include "codec/page/integer_solid.h"
#include "geometry/canonical_form.h"
#include "geometry/valid_solid.h"

namespace watertight {

struct CorpusSolid {
  std::string set;  // the file it came from, without its extension
  Acceptance acceptance;
  OrientedBoundary source;
  geometry::CanonicalSolid canonical;
};

/// Writes one record.
Bytes write_corpus_record(const std::string& set, const ValidSolid& solid);

/// Ends the program with a message if the file is not a corpus.
std::vector<CorpusSolid> read_corpus(const std::string& path);

}  // namespace watertight
