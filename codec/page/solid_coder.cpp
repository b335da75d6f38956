// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/page/solid_coder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "base/assert.h"
#include "codec/page/source_order.h"
#include "codec/sections/coordinates.h"
#include "codec/sections/facet_listing.h"

namespace watertight::codec {

// The families and numbers of the frame, with the names, the order and the sizes of docs/format.md,
// "Frame".
enum FrameFamily : std::uint32_t {
  kImplied,
  kProof,
  kKind,
  kOneStep,
  kPhase,
  kMode,
  kOrigin,
  kOrder
};
enum FrameNumber : std::uint32_t { kRuleSet, kSrid, kMantissa, kExponent, kOffset, kSection };

constexpr FamilyShape kFrameFamilies[] = {
    {kImplied, 1, {1}}, {kProof, 1, {1}}, {kKind, 1, {3}},   {kOneStep, 1, {1}},
    {kPhase, 1, {1}},   {kMode, 1, {64}}, {kOrigin, 1, {8}}, {kOrder, 1, {2}},
};
constexpr NumberShape kFrameNumbers[] = {
    {kRuleSet, 1, {1}},  {kSrid, 1, {1}},   {kMantissa, 1, {2}},
    {kExponent, 1, {2}}, {kOffset, 1, {3}}, {kSection, 1, {1}},
};

constexpr const FamilyShape& shape_of(FrameFamily family) { return kFrameFamilies[family]; }
constexpr const NumberShape& shape_of(FrameNumber number) { return kFrameNumbers[number]; }

namespace {

// The contexts of numbers Mantissa and Exponent: a step or a phase is coded.
constexpr Context<2> kOfStep{0U};
constexpr Context<2> kOfPhase{1U};
// The contexts of family Origin: is the origin the smallest corner, or the last origin?
constexpr Context<2> kIsCorner{0U};
constexpr Context<2> kIsLastOrigin{1U};

// The tolerances of an acceptance whose tolerances the stream does not state. Part of the format.
constexpr Tolerances kImpliedTolerances{0.01, 20.0, 0.0};

constexpr int kModeBits = 3;
constexpr std::uint32_t kModes = 1U << kModeBits;

double code_double(EntropyStream& stream, double value) {
  return std::bit_cast<double>(stream.code_bits(std::bit_cast<std::uint64_t>(value), 64));
}

Status code_tolerances(EntropyStream& stream, ModelBank& models, Tolerances& tolerances) {
  const bool implied =
      models.code<kImplied>(stream, {kNothingKnown}, tolerances == kImpliedTolerances);
  if (implied) {
    tolerances = kImpliedTolerances;
    return Done{};
  }
  tolerances.planarity_metres = code_double(stream, tolerances.planarity_metres);
  tolerances.planarity_degrees = code_double(stream, tolerances.planarity_degrees);
  tolerances.snap_metres = code_double(stream, tolerances.snap_metres);
  const bool is_number = std::isfinite(tolerances.planarity_metres) &&
                         std::isfinite(tolerances.planarity_degrees) &&
                         std::isfinite(tolerances.snap_metres);
  if (!is_number || tolerances == kImpliedTolerances) {
    return Error{
        ErrorCode::malformed,
        "the acceptance has tolerances that are not finite, or that the format leaves out"};
  }
  return Done{};
}

void code_grid_number(EntropyStream& stream, ModelBank& models, Context<2> which,
                      GridNumber& number) {
  number.mantissa = models.code_signed<kMantissa>(stream, {which}, number.mantissa, 63);
  number.exponent = static_cast<std::int32_t>(
      models.code_signed<kExponent>(stream, {which}, number.exponent, 20));
}

Status code_grid(EntropyStream& stream, ModelBank& models, PageGrid& grid) {
  const auto kind = static_cast<unsigned>(grid.kind);
  const bool high = models.code<kKind>(stream, {Context<3>(0U)}, (kind & 2U) != 0);
  const bool low = models.code<kKind>(stream, {Context<3>(high ? 2U : 1U)}, (kind & 1U) != 0);
  if (high && low) return Error{ErrorCode::malformed, "the kind of the lattice is unknown"};
  grid.kind = high ? LatticeKind::float64 : low ? LatticeKind::binary : LatticeKind::decimal;
  if (grid.kind == LatticeKind::float64) return Done{};
  const bool one_step = models.code<kOneStep>(
      stream, {kNothingKnown}, grid.step[0] == grid.step[1] && grid.step[1] == grid.step[2]);
  code_grid_number(stream, models, kOfStep, grid.step[0]);
  for (std::size_t axis = 1; axis < 3; ++axis) {
    if (one_step) {
      grid.step[axis] = grid.step[0];
    } else {
      code_grid_number(stream, models, kOfStep, grid.step[axis]);
    }
  }
  for (GridNumber& phase : grid.phase) {
    if (models.code<kPhase>(stream, {kNothingKnown}, phase == GridNumber{})) continue;
    code_grid_number(stream, models, kOfPhase, phase);
  }
  return Done{};
}

/// Codes the bytes of a section as they are.
void code_section(EntropyStream& stream, ModelBank& models, Bytes& section) {
  const std::uint64_t size =
      models.code_number<kSection>(stream, {kNothingKnown}, section.size(), 40);
  for (std::uint64_t i = 0; i < size && !stream.failed(); ++i) {
    const std::uint8_t byte = stream.is_reading() ? std::uint8_t{0} : section[i];
    const auto coded = static_cast<std::uint8_t>(stream.code_bits(byte, 8));
    if (stream.is_reading()) section.push_back(coded);
  }
}

std::size_t section_count(Mode mode, std::uint8_t flags) {
  if (mode == Mode::raw) return 2;
  return 3U + ((flags & kHasSteiner) != 0 ? 1U : 0U) + ((flags & kHasUnrecovered) != 0 ? 1U : 0U);
}

Result<bitmap::Composition> compose_plain(Mode mode, const PlainSections& plain,
                                          const Limits& limits) {
  if (mode == Mode::raw) {
    auto vertices = read_vertices(plain.sections[0], limits);
    if (!vertices) return vertices.error();
    auto arrays =
        read_facet_listing(plain.sections[1], static_cast<Index>(vertices->size()), limits);
    if (!arrays) return arrays.error();
    bitmap::Composition result;
    result.arrays = std::move(arrays).value();
    result.arrays.vertices = std::move(vertices).value();
    return result;
  }
  const auto has = [&](BitmapFlag flag) { return (plain.flags & flag) != 0; };
  bitmap::BitmapSections parts;
  std::size_t next = 0;
  parts.vertices = plain.sections[next++];
  if (has(kHasSteiner)) parts.steiner = plain.sections[next++];
  parts.bitmap = plain.sections[next++];
  if (has(kHasUnrecovered)) parts.unrecovered = plain.sections[next++];
  parts.facets = plain.sections[next++];
  parts.bitmap_coding =
      has(kCodedBitmap) ? bitmap::BitCoding::arithmetic : bitmap::BitCoding::plain;
  parts.facet_coding = has(kCodedFacets) ? bitmap::BitCoding::arithmetic : bitmap::BitCoding::plain;
  parts.lists_facets = has(kExplicitFacets);
  if ((has(kHasSteiner) && parts.steiner.empty()) ||
      (has(kHasUnrecovered) && parts.unrecovered.empty())) {
    return Error{ErrorCode::malformed, "a section is empty"};
  }
  if (parts.lists_facets && has(kCodedFacets)) {
    return Error{ErrorCode::malformed, "the facet section has two codings"};
  }
  return bitmap::compose(parts, limits);
}

/// Returns the canonical form of a solid. Errors: malformed if its boundary is not closed.
Result<geometry::CanonicalSolid> canonical_of(Result<Solid> solid) {
  if (!solid) return solid.error();
  auto boundary = OrientedBoundary::make(std::move(solid).value());
  if (!boundary) {
    return Error{ErrorCode::malformed, "the boundary is not closed: " + boundary.error().message};
  }
  geometry::CanonicalSolid canonical = geometry::canonical_form(*boundary);
  return canonical;
}

GridPoint smallest_corner(const IntegerSolid& solid) {
  GridPoint corner{};
  for (std::size_t axis = 0; axis < 3 && !solid.vertices.empty(); ++axis) {
    corner[axis] = solid.vertices.front()[axis];
    for (const GridPoint& vertex : solid.vertices) {
      corner[axis] = std::min(corner[axis], vertex[axis]);
    }
  }
  return corner;
}

struct ModeCoder {
  ModelPart part;
  CodeSolid* code;
};

ModeCoder coder_of(Mode mode) {
  switch (mode) {
    case Mode::walk:
      return {ModelPart::walk, walk::code_solid};
    case Mode::polygon:
      return {ModelPart::polygon, polygon::code_solid};
    case Mode::parallelogram:
      return {ModelPart::parallelogram, parallelogram::code_solid};
    default:
      return {ModelPart::frame, nullptr};
  }
}

/// True if every facet is a triangle without interior rings. Mode parallelogram holds no other
/// solids.
bool is_all_triangles(const IntegerSolid& solid) {
  return solid.ring_vertices.size() == 3 * std::size_t{solid.facet_count()} &&
         solid.ring_count() == solid.facet_count();
}

/// True if all coordinates are below 2^53 in magnitude. The sum of hostile differences may be
/// larger.
bool are_in_range(const IntegerSolid& solid) {
  constexpr std::int64_t kLimit = std::int64_t{1} << 53;
  return std::all_of(solid.vertices.begin(), solid.vertices.end(), [](const GridPoint& vertex) {
    return std::all_of(vertex.begin(), vertex.end(),
                       [](std::int64_t c) { return c < kLimit && c > -kLimit; });
  });
}

/// True for a solid of triangles so large that mode walk is not tried: it takes twice the time and
/// memory of mode parallelogram and has been larger on every such mesh (bench/results/dense.md).
bool is_large_mesh(const IntegerSolid& solid) {
  constexpr std::size_t kMostVertices = 20'000;
  return solid.vertices.size() > kMostVertices &&
         solid.ring_vertices.size() == 3 * std::size_t{solid.facet_count()};
}

}  // namespace

const ModelLayout& frame_layout() {
  static constexpr ModelLayout layout{kFrameFamilies, kFrameNumbers};
  return layout;
}

Status code_frame(EntropyStream& stream, ModelBank& models, Frame& frame) {
  Acceptance& acceptance = frame.acceptance;
  if (auto status = code_tolerances(stream, models, acceptance.tolerances); !status) return status;
  acceptance.proof =
      models.code<kProof>(stream, {kNothingKnown}, acceptance.proof == Proof::boundary)
          ? Proof::boundary
          : Proof::tetrahedralization;
  acceptance.rule_set = static_cast<std::uint16_t>(
      models.code_number<kRuleSet>(stream, {kNothingKnown}, acceptance.rule_set, 16));
  frame.srid = static_cast<std::uint32_t>(
      models.code_number<kSrid>(stream, {kNothingKnown}, frame.srid, 32));
  if (auto status = code_grid(stream, models, frame.grid); !status) return status;
  if (!stream.is_reading()) return Done{};
  if (stream.failed()) return Error{ErrorCode::malformed, "truncated or malformed frame"};
  const auto lattice = lattice_at(frame.grid, GridPoint{});
  return lattice ? Status{Done{}} : lattice.error();
}

Mode SolidCoder::code_mode(Mode mode) {
  ModelBank& models = models_[ModelPart::frame];
  std::uint32_t bits = 1;  // the bits of the mode so far, after a leading 1
  for (int bit = kModeBits - 1; bit >= 0; --bit) {
    const auto known = combine(last_mode_, Context<kModes>(bits));
    const bool one = ((static_cast<unsigned>(mode) >> bit) & 1U) != 0;
    bits = 2 * bits + (models.code<kMode>(stream_, {known}, one) ? 1U : 0U);
  }
  last_mode_ = Context<kModes>(bits - kModes);
  return static_cast<Mode>(last_mode_.value);
}

Status SolidCoder::code_geometry(PageSolid& solid, const WriterChoice& choice, Draft* draft) {
  if (draft != nullptr) {
    WATERTIGHT_ASSERT(draft->mode == solid.mode);
    stream_.append(draft->decisions);
    draft->learned.keep();
    return Done{};
  }
  const ModeCoder coder = coder_of(solid.mode);
  if (coder.code == nullptr) {
    return Error{ErrorCode::unsupported,
                 "mode " + std::to_string(static_cast<unsigned>(solid.mode)) + " is unknown"};
  }
  const bool has_integers = stream_.is_reading() || solid.integers;
  if (frame_.grid.kind == LatticeKind::float64 || !has_integers) {
    const ErrorCode code = stream_.is_reading() ? ErrorCode::malformed : ErrorCode::not_encodable;
    return Error{code, "mode " + std::string(to_string(solid.mode)) +
                           " is for integers, and the coordinates are on no grid"};
  }
  if (stream_.is_reading()) solid.integers.emplace();
  return coder.code(stream_, models_[coder.part], memory_, *solid.integers, choice, limits_);
}

Status SolidCoder::code_plain(PageSolid& solid) {
  PlainSections& plain = solid.plain;
  if (solid.mode == Mode::bitmap) {
    plain.flags = static_cast<std::uint8_t>(stream_.code_bits(plain.flags, 8));
    const unsigned known =
        kHasSteiner | kHasUnrecovered | kCodedBitmap | kCodedFacets | kExplicitFacets;
    if ((plain.flags & ~known) != 0) {
      return Error{ErrorCode::malformed, "a flag of mode bitmap is unknown"};
    }
  }
  plain.sections.resize(section_count(solid.mode, plain.flags));
  stream_.enter(StreamPart::coordinates);
  for (Bytes& section : plain.sections) {
    code_section(stream_, models_[ModelPart::frame], section);
    stream_.enter(StreamPart::connectivity);
  }
  return Done{};
}

/// Codes the origin of the solid's lattice: it is the smallest corner of the solid's box (case 0),
/// the origin of the solid before (case 1), or any other grid point (case 2, the only one in modes
/// raw and bitmap).
void SolidCoder::code_origin(PageSolid& solid) {
  if (frame_.grid.kind == LatticeKind::float64) return;
  ModelBank& models = models_[ModelPart::frame];
  const bool is_plain = solid.mode == Mode::raw || solid.mode == Mode::bitmap;
  GridPoint& origin = solid.origin;
  const GridPoint corner = is_plain ? memory_.last_position : smallest_corner(*solid.integers);
  std::uint32_t which = 0;
  const auto known = [&](Context<2> question) { return combine(last_origin_case_, question); };
  if (!is_plain && !models.code<kOrigin>(stream_, {known(kIsCorner)}, origin == corner)) {
    which = models.code<kOrigin>(stream_, {known(kIsLastOrigin)}, origin == last_origin_) ? 1 : 2;
  }
  if (is_plain) which = 2;
  if (which == 0) origin = corner;
  if (which == 1) origin = last_origin_;
  for (std::uint32_t axis = 0; axis < 3 && which == 2; ++axis) {
    origin[axis] = corner[axis] + models.code_signed<kOffset>(stream_, {Context<3>(axis)},
                                                              origin[axis] - corner[axis], 55);
  }
  if (!is_plain) last_origin_case_ = Context<4>(1 + which);
  last_origin_ = origin;
}

Status SolidCoder::rebuild(PageSolid& solid) const {
  if (stream_.failed()) return Error{ErrorCode::malformed, "truncated or malformed solid"};
  if (solid.mode != Mode::raw && solid.mode != Mode::bitmap) {
    if (!are_in_range(*solid.integers)) {
      return Error{ErrorCode::malformed, "a coordinate is out of range"};
    }
    GriddedSolid gridded{frame_.grid, solid.origin, std::move(*solid.integers)};
    auto canonical = canonical_of(ungrid_solid(gridded, frame_.srid, limits_));
    solid.integers = std::move(gridded.solid);
    if (!canonical) return canonical.error();
    solid.canonical = std::move(canonical).value();
    return Done{};
  }
  auto composition = compose_plain(solid.mode, solid.plain, limits_);
  if (!composition) return composition.error();
  auto lattice = lattice_at(frame_.grid, solid.origin);
  if (!lattice) return lattice.error();
  solid.plain.counts = composition->counts;
  auto canonical =
      canonical_of(Solid::make(std::move(composition->arrays), *lattice, frame_.srid, limits_));
  if (!canonical) return canonical.error();
  const bool is_listed = solid.mode == Mode::raw || (solid.plain.flags & kExplicitFacets) != 0;
  if (is_listed && !canonical->order.is_identity()) {
    return Error{ErrorCode::malformed, "the listed facets are not in canonical order"};
  }
  solid.canonical = std::move(canonical).value();
  return Done{};
}

Status SolidCoder::code_order(PageSolid& solid) {
  solid.keeps_order =
      models_[ModelPart::frame].code<kOrder>(stream_, {last_order_}, solid.keeps_order);
  last_order_ = Context<2>(solid.keeps_order);
  if (!solid.keeps_order) return Done{};
  watertight::codec::code_order(stream_, models_[ModelPart::order],
                                solid.canonical->boundary.solid(), solid.canonical->order);
  if (stream_.is_reading() && solid.canonical->order.is_identity()) {
    return Error{ErrorCode::malformed,
                 "the source order equals the canonical order, which the format leaves out"};
  }
  return Done{};
}

void SolidCoder::take_from_limits(const Solid& solid) {
  const auto take = [](std::uint64_t& limit, std::uint64_t count) {
    limit -= std::min(limit, count);
  };
  take(limits_.vertices, solid.vertex_count());
  take(limits_.facets, solid.facet_count());
  take(limits_.rings, solid.ring_count());
  take(limits_.shells, solid.shell_count());
}

Status SolidCoder::code(PageSolid& solid, const WriterChoice& choice, Draft* draft) {
  stream_.enter(StreamPart::frame);
  solid.mode = code_mode(solid.mode);
  const bool is_plain = solid.mode == Mode::raw || solid.mode == Mode::bitmap;
  if (auto status = is_plain ? code_plain(solid) : code_geometry(solid, choice, draft); !status) {
    return status;
  }
  stream_.enter(StreamPart::position);
  code_origin(solid);
  if (stream_.is_reading()) {
    if (auto status = rebuild(solid); !status) return status;
  }
  stream_.enter(StreamPart::order);
  if (auto status = code_order(solid); !status) return status;
  if (stream_.failed()) return Error{ErrorCode::malformed, "truncated or malformed solid"};
  if (!is_plain) memory_.add(*solid.integers);
  take_from_limits(solid.canonical->boundary.solid());
  return Done{};
}

std::unique_ptr<Draft> SolidCoder::draft(const PageSolid& solid, Mode mode,
                                         const WriterChoice& choice, std::uint64_t limit) const {
  const ModeCoder coder = coder_of(mode);
  if (coder.code == nullptr || !solid.integers) return nullptr;
  if (mode == Mode::parallelogram && !is_all_triangles(*solid.integers)) return nullptr;
  IntegerSolid integers = *solid.integers;
  ModelBank& models = models_[coder.part];
  WriterChoice made = choice;
  if (mode == Mode::parallelogram && !made.vertex_options) {
    auto options = parallelogram::choose_options(integers, models, memory_, limits_);
    if (!options) return nullptr;
    made.vertex_options = std::move(options).value();
  }
  constexpr std::size_t kMostRecorded = 50'000;
  const std::size_t size = integers.vertices.size();
  auto draft = std::make_unique<Draft>(
      mode, models, size,
      size > kMostRecorded ? EntropyStream::meter(limit) : EntropyStream::recorder(limit));
  draft->decisions.heed(limits_);
  draft->choice = made;
  const Status coded = coder.code(draft->decisions, models, memory_, integers, made, limits_);
  if (!coded || draft->decisions.failed()) return nullptr;
  return draft;
}

std::unique_ptr<Draft> SolidCoder::cheapest(const PageSolid& solid, const Plan& plan) const {
  std::unique_ptr<Draft> best;
  WriterChoice choice = plan.choice;
  for (const Mode mode : {Mode::polygon, Mode::walk, Mode::parallelogram}) {
    if ((plan.declined >> static_cast<unsigned>(mode) & 1U) != 0) continue;
    if (mode == Mode::walk && solid.integers && is_large_mesh(*solid.integers)) continue;
    auto tried = draft(solid, mode, choice, best ? best->cost() : ~std::uint64_t{0});
    if (!tried) continue;
    choice = tried->choice;
    best = std::move(tried);
  }
  return best;
}

}  // namespace watertight::codec
