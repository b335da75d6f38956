// SPDX-License-Identifier: GPL-3.0-or-later
//
// Codes the coordinates of vertices that belong to no solid, after the rings that use them: a
// vertex is near its neighbours, or completes a parallelogram with them. Internal to columns/.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "columns/models/context_mixer.h"
#include "columns/models/number_coder.h"
#include "columns/rings/ring_coder.h"

namespace watertight::columns {

class VertexCoder {
 public:
  /// Starts another feature, with so many vertices. What is known about coordinates stays.
  void restart(std::uint64_t vertices);
  /// Takes the first vertex of a run, then its length: a solid has these vertices.
  void take_run(std::int64_t number);
  /// Whether there is a vertex whose coordinates are to come.
  bool is_ready() const;
  /// Codes the next coordinate of the next vertex that no solid has: x, y, z, x, ...; none when
  /// its text is no number.
  std::optional<std::string> code(EntropyStream& stream, ContextMixer& mixer, RingCoder& rings,
                                  std::string_view text);

 private:
  static constexpr std::size_t kPredictions = 5;
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  struct Corner {
    std::uint32_t ring = 0;
    std::uint32_t position = 0;
    std::uint32_t next = kNone;  // the next corner of the vertex
  };
  /// The first and the last corner of a vertex.
  struct CornerList {
    std::uint32_t first = kNone;
    std::uint32_t last = kNone;
  };
  /// A coordinate in units of 10^-decimals, of a form that has them.
  struct Coordinate {
    std::int64_t number = 0;
    int decimals = 0;
  };
  using Vertex = std::array<Coordinate, 3>;
  /// The neighbours of a vertex that are known, by their places in `vertices_`, which are in the
  /// order of the vertices.
  struct Surroundings {
    std::uint32_t nearest = kNone;  // the neighbour with the largest number
    std::vector<std::uint32_t> neighbours;
    /// The place of the vertex is likely first + second - third.
    std::array<std::uint32_t, 3> parallelogram{kNone, kNone, kNone};
  };
  void list_corners();
  void look_around();
  /// Codes whether a coordinate is that of a neighbour; none if it is not.
  std::optional<std::int64_t> code_equal(EntropyStream& stream, ContextMixer& mixer,
                                         std::int64_t number, int decimals);
  /// Takes the next coordinate, of which `coordinate` is kept; returns its text.
  std::string take(EntropyStream& stream, const NumberForm& form, std::int64_t number,
                   const Coordinate& coordinate);
  void find_parallelogram(std::span<const VertexNumber> ring, const Corner& corner);
  /// The place of a vertex in `vertices_`, or kNone.
  std::uint32_t place_of(VertexNumber vertex) const;
  std::int64_t value(std::uint32_t place, std::size_t axis, int decimals) const;
  std::array<std::int64_t, kPredictions> predictions(std::size_t axis, int decimals) const;

  const RingList* rings_ = nullptr;
  std::vector<Corner> corners_;
  FlatMap<VertexNumber, CornerList> corners_of_;
  std::vector<Vertex> vertices_;                                    // those that are known
  FlatMap<VertexNumber, std::uint32_t> place_of_;                   // of vertices in `vertices_`
  std::vector<std::pair<std::uint64_t, std::uint64_t>> of_solids_;  // first and end; sorted later
  std::optional<std::int64_t> run_;                                 // the first vertex of a run
  std::uint64_t count_ = 0;
  std::uint64_t next_ = 0;
  std::size_t next_run_ = 0;
  bool is_started_ = false;
  std::size_t axis_ = 0;
  Vertex vertex_;
  Vertex last_vertex_;
  Surroundings around_;
  std::vector<std::uint32_t> equal_;           // the neighbours that had the coordinates so far
  std::array<std::uint32_t, 3> last_equal_{};  // for each axis the neighbour that had the last one
  std::array<std::array<std::int32_t, kPredictions>, 3> misses_{};
  std::array<std::uint32_t, 3> last_residual_{};
  std::array<NumberColumn, 3> forms_;
};

}  // namespace watertight::columns
