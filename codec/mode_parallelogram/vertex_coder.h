// SPDX-License-Identifier: GPL-3.0-or-later
//
// The coordinates of the vertices of mode parallelogram, in the order in which the front meets
// them: a prediction, and what it missed by.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/limits.h"
#include "base/result.h"
#include "codec/entropy/entropy_stream.h"
#include "codec/entropy/model_bank.h"
#include "codec/mode_parallelogram/axis_places.h"
#include "codec/mode_parallelogram/front.h"
#include "codec/mode_parallelogram/tip_prediction.h"
#include "codec/mode_parallelogram/vectors.h"
#include "codec/mode_parallelogram/vertex_options.h"
#include "codec/page/integer_solid.h"

namespace watertight::codec::parallelogram {

/// Positions are given when writing or measuring and are nothing when reading. All others are
/// relative to the first vertex of the solid, the origin.
class VertexCoder {
 public:
  VertexCoder(EntropyStream& stream, ModelBank& models, const PageMemory& memory,
              const Limits& limits)
      : stream_(stream), models_(models), memory_(memory), limits_(limits) {}

  void code_options(const VertexOptions& options);
  /// Vertex `number` of the first triangle of a component. Errors: malformed; limit_exceeded.
  Status code_seed(std::uint32_t number, const GridPoint* position);
  /// Where the tip beyond the gate of `corner` is expected.
  Vector predict(const SurfaceFront& front, Index corner) {
    return prediction_.predict(front, centres_, corner).guesses[0];
  }
  /// The tip at the gate of the last prediction. Errors: malformed; limit_exceeded.
  Status code_tip(const SurfaceFront& front, Index corner, const GridPoint* position);

  Index count() const { return static_cast<Index>(cells_.size()); }
  const GridPoint& origin() const { return origin_; }
  const std::vector<GridPoint>& cells() const { return cells_; }
  /// The same as doubles.
  const std::vector<Vector>& centres() const { return centres_; }

 private:
  GridPoint relative(const GridPoint* position) const;
  Status add_vertex(const GridPoint& cell, double error);
  GridPoint code_cell(const GridPoint& near, const GridPoint& truth, std::uint32_t number,
                      std::uint32_t context);
  /// Which of the guesses the residuals are from.
  std::uint32_t code_guess(const SurfaceFront& front, const Gate& gate, const GridPoint* truth,
                           std::uint32_t scale);
  /// Whether the coordinate is that of a vertex beside the gate, and which one.
  bool code_repeat(const SurfaceFront& front, const Gate& gate, std::uint32_t rank, std::size_t k,
                   std::int64_t truth, std::int64_t& value);

  EntropyStream& stream_;
  ModelBank& models_;
  const PageMemory& memory_;
  Limits limits_;
  bool has_repeats_ = false;
  bool has_guesses_ = false;
  double naming_weight_ = 0;                   // writing
  std::array<AxisPlaces, 3> chosen_places_{};  // writing
  std::array<AxisPlaces, 3> places_{};         // of every number until the origin is known
  GridPoint origin_{};
  std::vector<GridPoint> cells_;
  std::vector<Vector> centres_;
  std::vector<double> errors_;         // what the prediction missed by
  std::vector<std::uint8_t> guesses_;  // which guess it was
  std::vector<std::uint8_t> repeats_;  // by axis, bits
  TipPrediction prediction_;
  std::uint32_t last_guesses_ = 0;          // of the two tips before
  std::array<std::uint32_t, 3> history_{};  // of each axis, whether the last three repeated
  std::uint32_t now_repeats_ = 0;           // the same of this tip so far
};

}  // namespace watertight::codec::parallelogram
