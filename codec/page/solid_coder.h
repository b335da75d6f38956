// SPDX-License-Identifier: GPL-3.0-or-later
//
// Codes the parts of a page around its solids (docs/format.md, "Frame" and "Solid"): the values
// that the solids share, and for each solid its mode, the origin of its lattice, and its source
// order. A blob is a page of one solid. Each function writes, reads or measures.
#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "codec/blob.h"
#include "codec/entropy/bank_trial.h"
#include "codec/entropy/context.h"
#include "codec/entropy/entropy_stream.h"
#include "codec/mode_bitmap/compose.h"
#include "codec/page/integer_solid.h"
#include "codec/page/model_sets.h"
#include "codec/page/modes.h"
#include "codec/page/writer_choice.h"
#include "geometry/canonical_form.h"

namespace watertight::codec {

/// The values that the solids of a page share.
struct Frame {
  Acceptance acceptance;
  std::uint32_t srid = 0;
  PageGrid grid;  // for a float64 lattice only the kind is used
  friend bool operator==(const Frame&, const Frame&) = default;
};

const ModelLayout& frame_layout();

/// Codes the frame of a page. Errors, when reading: malformed.
Status code_frame(EntropyStream& stream, ModelBank& models, Frame& frame);

/// The flags of mode bitmap. All other bits are 0.
enum BitmapFlag : std::uint8_t {
  kHasSteiner = 4,      // there is a section of Steiner vertices
  kHasUnrecovered = 8,  // there is a section of unrecovered faces
  kCodedBitmap = 16,    // the marks are arithmetic coded, not plain bits
  kCodedFacets = 32,    // the facet section is arithmetic coded
  kExplicitFacets = 64  // the facet section lists rings as mode raw does
};

/// The bytes of mode raw or bitmap.
struct PlainSections {
  std::uint8_t flags = 0;  // BitmapFlag; 0 in mode raw
  std::vector<Bytes> sections;
  bitmap::FaceCounts counts;  // the counts of faces and Steiner vertices; 0 in mode raw
};

/// A solid as it stands in a page.
struct PageSolid {
  Mode mode = Mode::raw;
  std::optional<geometry::CanonicalSolid> canonical;  // nothing until the solid is read
  bool keeps_order = false;  // true if the page has the source order of this solid
  /// The solid on the page's grid; nothing if its coordinates are on no grid, or if the solid was
  /// read in mode raw or bitmap.
  std::optional<IntegerSolid> integers;
  GridPoint origin{};   // the grid point where the solid's lattice begins
  PlainSections plain;  // empty but in modes raw and bitmap
};

/// The mode and the choices with which a solid is to be written.
struct Plan {
  Mode mode = Mode::automatic;
  std::uint32_t declined = 0;  // bit m is set if automatic mode must not take mode m
  WriterChoice choice = {};
};

/// A solid coded in a mode for integers by way of trial. The bank of the mode has learned from the
/// solid; the end of the draft makes it forget, unless SolidCoder::code() has used the draft.
struct Draft {
  Draft(Mode of, ModelBank& models, std::size_t vertices, EntropyStream stream)
      : mode(of), learned(models, vertices), decisions(std::move(stream)) {}

  Mode mode;
  WriterChoice choice;  // the choices that were made
  BankTrial learned;
  EntropyStream decisions;
  /// The solid's own part of the stream, in 1/65536 bit.
  std::uint64_t cost() const { return decisions.cost(); }
};

/// Codes the solids of one page, one after the other. The limits are for all its solids together.
class SolidCoder {
 public:
  SolidCoder(EntropyStream& stream, ModelSet& models, const Frame& frame, const Limits& limits)
      : stream_(stream), models_(models), frame_(frame), limits_(limits) {}

  /// Codes one solid. When writing or measuring, `solid` must have this coder's frame and all that
  /// its mode needs, and stays unchanged; errors: not_encodable (the coder is then useless). When
  /// reading, `solid` must be empty; errors: malformed; limit_exceeded. `draft` is null or a draft
  /// of the solid in its mode with its decisions, made by this coder since the last solid: this
  /// saves most of the work.
  Status code(PageSolid& solid, const WriterChoice& choice = {}, Draft* draft = nullptr);

  /// Codes a solid in a mode by way of trial. Makes the choices that `choice` leaves open. Returns
  /// null if the mode cannot hold the solid for less than `limit` or is not for integers. The
  /// decisions of a solid of more than 50,000 vertices are not kept, to save memory.
  std::unique_ptr<Draft> draft(const PageSolid& solid, Mode mode, const WriterChoice& choice = {},
                               std::uint64_t limit = ~std::uint64_t{0}) const;

  /// The draft in the mode for integers that costs least among those that the plan does not
  /// decline; null if no such mode can hold the solid.
  std::unique_ptr<Draft> cheapest(const PageSolid& solid, const Plan& plan = {}) const;

  CancelPoll poll() const { return limits_.poll(); }

 private:
  Mode code_mode(Mode mode);
  Status code_geometry(PageSolid& solid, const WriterChoice& choice, Draft* draft);
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
  Context<8> last_mode_{7U};         // 7: no solid before
  Context<4> last_origin_case_{0U};  // 0: no solid before; else 1 + the case of code_origin()
  Context<2> last_order_{0U};
};

}  // namespace watertight::codec
