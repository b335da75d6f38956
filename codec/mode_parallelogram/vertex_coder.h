// SPDX-License-Identifier: GPL-3.0-or-later
//
// Codes the coordinates of the vertices of mode parallelogram, in the order in which the front
// meets the vertices: each coordinate is predicted, and the difference from the prediction is
// coded.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/limits.h"
#include "base/result.h"
#include "codec/entropy/context.h"
#include "codec/entropy/entropy_stream.h"
#include "codec/entropy/model_bank.h"
#include "codec/mode_parallelogram/axis_places.h"
#include "codec/mode_parallelogram/families.h"
#include "codec/mode_parallelogram/front.h"
#include "codec/mode_parallelogram/tip_prediction.h"
#include "codec/mode_parallelogram/vectors.h"
#include "codec/mode_parallelogram/vertex_options.h"
#include "codec/page/integer_solid.h"

namespace watertight::codec::parallelogram {

/// Codes vertices one after the other. The positions that functions take are null when reading. All
/// stored positions are relative to the first vertex of the solid, the origin.
class VertexCoder {
 public:
  VertexCoder(EntropyStream& stream, ModelBank& models, const PageMemory& memory,
              const Limits& limits)
      : stream_(stream), models_(models), memory_(memory), limits_(limits) {}

  void code_options(const VertexOptions& options);
  /// Codes vertex `number` (0 to 2) of the first triangle of a component. Errors: malformed;
  /// limit_exceeded.
  Status code_seed(std::uint32_t number, const GridPoint* position);
  /// The expected position of the tip beyond the gate of `corner`.
  Vector predict(const SurfaceFront& front, Index corner) {
    return prediction_.predict(front, centres_, corner).guesses[0];
  }
  /// Codes the tip at the gate of the last prediction. Errors: malformed; limit_exceeded.
  Status code_tip(const SurfaceFront& front, Index corner, const GridPoint* position);

  Index count() const { return static_cast<Index>(positions_.size()); }
  const GridPoint& origin() const { return origin_; }
  /// The positions of the vertices coded so far, relative to the origin.
  const std::vector<GridPoint>& positions() const { return positions_; }
  /// The positions of the vertices coded so far, as doubles.
  const std::vector<Vector>& centres() const { return centres_; }

 private:
  static constexpr std::uint32_t kGuesses = TipPrediction::kGuesses;
  static constexpr std::uint32_t kSpans = TipPrediction::kSpanClasses;
  static constexpr std::uint32_t kMisses = 16;     // classes of misses and lengths
  static constexpr std::uint32_t kAxisMisses = 6;  // classes of the miss on one axis
  static constexpr std::uint32_t kSpreads = 8;     // classes of the distance of two guesses

  using Guess = Context<kGuesses>;
  struct Axis {
    std::size_t number;
    Context<3> rank;  // the index of the axis in the order of coding
  };
  /// The facts that are known about a tip before its coordinates are coded.
  struct TipContexts {
    double expected;                    // the expected miss
    Guess guess;                        // the guess that is the prediction
    Context<kSpans + kGuesses> source;  // the set of coefficients, or the guess if tips name one
    Context<kMisses> size;              // the length of the gate
    Context<kSpreads> spread;           // the distance of the first two guesses
    Context<kMisses> least_miss;        // the lesser miss of the ends of the gate
    Context<kMisses> apex_miss;         // the misses of two vertices beside the gate
    Context<kAxisMisses> missed{0U};    // the greatest miss of a coordinate so far
  };

  GridPoint relative(const GridPoint* position) const;
  Status add_vertex(const GridPoint& position, double miss);
  template <Number number, std::uint32_t size>
  GridPoint code_vertex(const GridPoint& near, const GridPoint& truth, Context<size> context);
  /// Codes which of the guesses is the prediction of the tip.
  Guess code_guess(const SurfaceFront& front, const Gate& gate, const GridPoint* truth,
                   Context<kMisses> scale);
  /// Codes whether the coordinate equals that of a vertex beside the gate, and if so, the index of
  /// the vertex. Returns the coordinate, or nothing if it equals none.
  std::optional<std::int64_t> code_repeat(const SurfaceFront& front, const Gate& gate,
                                          const Axis& axis, std::int64_t truth);
  TipContexts contexts_of_tip(const SurfaceFront& front, const Gate& gate, const GridPoint* truth);
  std::int64_t code_coordinate(const TipContexts& tip, const Axis& axis, double expectation,
                               std::int64_t truth);

  EntropyStream& stream_;
  ModelBank& models_;
  const PageMemory& memory_;
  Limits limits_;
  bool has_repeats_ = false;
  bool has_guesses_ = false;
  double naming_weight_ = 0;                   // when writing: as in VertexOptions
  std::array<AxisPlaces, 3> chosen_places_{};  // when writing: as in VertexOptions
  std::array<AxisPlaces, 3> places_{};         // Kind::every until the origin is known
  GridPoint origin_{};
  std::vector<GridPoint> positions_;
  std::vector<Vector> centres_;
  std::vector<double> misses_;         // vertex -> the distance from its prediction
  std::vector<std::uint8_t> guesses_;  // vertex -> the guess that was its prediction
  std::vector<std::uint8_t> repeats_;  // vertex -> bit k: the coordinate on axis k was a repeat
  TipPrediction prediction_;
  Context<kGuesses * kGuesses> last_guesses_{0U};  // the guesses of the two tips before
  std::array<Answers<3>, 3> history_;              // axis -> the last answers of Repeat
  std::uint32_t now_repeats_ = 0;  // the answers of Repeat for this tip, latest lowest
};

}  // namespace watertight::codec::parallelogram
