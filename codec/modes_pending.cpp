// SPDX-License-Identifier: GPL-3.0-or-later
//
// Modes that are not written yet hold nothing.
#include "codec/modes.h"

namespace watertight {
namespace {

constexpr FamilyShape kFamilies[] = {{1, {1}}};
constexpr ModelLayout kLayout{kFamilies, {}};

}  // namespace

const ModelLayout& hybrid_layout() { return kLayout; }
Status code_hybrid(EntropyStream&, ModelBank&, const PageMemory&, IntegerSolid&, const Limits&) {
  return Error{ErrorCode::not_encodable, "not written yet"};
}

}  // namespace watertight
