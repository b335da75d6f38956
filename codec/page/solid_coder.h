// SPDX-License-Identifier: GPL-3.0-or-later
//
// What stands around the solids of a page (docs/format.md, "Frame" and "Solid"): what they have in
// common, and of each solid its mode, where its lattice begins, and its order. A blob is a page of
// one solid. Each function writes, reads or measures.
#pragma once

#include <optional>

#include "codec/blob.h"
#include "codec/entropy/entropy_stream.h"
#include "codec/mode_bitmap/compose.h"
#include "codec/page/integer_solid.h"
#include "codec/page/model_sets.h"
#include "codec/page/modes.h"
#include "geometry/canonical_form.h"

namespace watertight::codec {

/// What the solids of a page share.
struct Frame {
  Acceptance acceptance;
  std::uint32_t srid = 0;
  PageGrid grid;  // of a float64 lattice only the kind counts
  friend bool operator==(const Frame&, const Frame&) = default;
};

const ModelLayout& frame_layout();
const ModelLayout& order_layout();

/// Errors, when reading: malformed.
Status code_frame(EntropyStream& stream, ModelBank& models, Frame& frame);

/// The flags of mode bitmap. All other bits are 0.
enum BitmapFlag : std::uint8_t {
  kHasSteiner = 4,      // there is a section of Steiner vertices
  kHasUnrecovered = 8,  // there is a section of unrecovered faces
  kCodedBitmap = 16,    // the marks are arithmetic coded, not plain bits
  kCodedFacets = 32,    // likewise the facet section
  kExplicitFacets = 64  // the facet section lists rings as mode raw does
};

/// The bytes of mode raw or bitmap.
struct PlainSections {
  std::uint8_t flags = 0;  // BitmapFlag; 0 in mode raw
  std::vector<Bytes> sections;
};

/// A solid as it stands in a page.
struct PageSolid {
  Mode mode = Mode::raw;
  /// When reading, code() sets it; its order is the identity unless the blob keeps a source order.
  std::optional<geometry::CanonicalSolid> canonical;
  bool keeps_order = false;
  GriddedSolid gridded;        // of raw and bitmap only the origin counts
  bool has_grid = false;       // writing: it may take the modes for integers
  std::uint32_t declined = 0;  // writing: bit m is set if automatic mode must not take mode m
  WriterChoice choice;         // writing: made by cost()
  PlainSections plain;
  /// What mode bitmap found, when reading.
  bitmap::Composition composition;
  /// What each StreamPart took, in 1/65536 bit.
  std::array<std::uint64_t, kStreamParts> costs{};
};

/// Codes the solids of one page, one after the other. The limits are for all of them together.
class SolidCoder {
 public:
  SolidCoder(EntropyStream& stream, ModelSet& models, const Frame& frame, const Limits& limits)
      : stream_(stream), models_(models), frame_(frame), limits_(limits) {}

  /// Writing or measuring: requires a solid of this frame, with all that its mode needs.
  /// Errors: not_encodable (the coder is then useless); reading: malformed; limit_exceeded.
  Status code(PageSolid& solid);

  /// What the solid's own part of the stream would cost in `mode`, in 1/65536 bit; nothing if the
  /// mode cannot hold it or is not for integers. Changes nothing but the choice, for code().
  std::optional<std::uint64_t> cost(PageSolid& solid, Mode mode) const;

  /// The mode for integers that costs least, of those not declined; Mode::automatic if none can
  /// hold the solid.
  Mode cheapest_mode(PageSolid& solid) const;

 private:
  Mode code_mode(Mode mode);
  Status code_geometry(PageSolid& solid);
  Status code_plain(PageSolid& solid);
  void code_origin(PageSolid& solid);
  Status rebuild(PageSolid& solid) const;
  Status code_order(PageSolid& solid);
  void take_from_limits(const Solid& solid);

  EntropyStream& stream_;
  ModelSet& models_;
  Frame frame_;
  Limits limits_;
  PageMemory memory_;
  GridPoint last_origin_{};
  std::uint32_t last_mode_ = 7;  // none
  std::uint32_t last_origin_case_ = 0;
  std::uint32_t last_order_ = 0;
};

}  // namespace watertight::codec
