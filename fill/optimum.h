// SPDX-License-Identifier: GPL-3.0-or-later
//
// The best triangulation of a domain, from the best ones of the parts that a triangle leaves.
// Internal to fill/.
// Source: Zou, Ju and Carr 2013, section 3.2, figure 6. Departure: a domain keeps its weights by
// the triangle on its access edge, and answers for each triangle behind that edge from the two
// nearest directions, as the angle of two triangles is a distance on a circle.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/cancel.h"
#include "base/result.h"
#include "fill/domain_table.h"

namespace watertight::fill {

/// The ends of the work, in counts and bytes, so that every machine stops at the same place.
struct Budget {
  std::size_t max_domains = 0;
  std::size_t max_bytes = 0;
  CancelPoll is_cancelled;
};

class Optimum {
 public:
  Optimum(const Borders& borders, const Candidates& candidates, const SplitOptions& options,
          bool keeps_all_sets);

  /// The triangles of the best triangulation of a domain of one spanning edge, which is an edge of
  /// a loop. Each has the sense of the boundary. Errors: not_found where there is none;
  /// limit_exceeded beyond the budget; cancelled.
  Result<std::vector<std::array<Vertex, 3>>> triangulate(const Domain& start, const Budget& budget);

  const DomainTable& table() const { return table_; }

 private:
  /// A domain whose parts are being weighed.
  struct Frame {
    Domain domain;
    std::vector<EdgeNumber> weak;
    std::vector<WeighedTriangle> found;
    std::size_t next = 0;  // the number of the next triangle on its access edge
  };
  Status weigh(const Domain& start, const Budget& budget);
  bool weigh_triangles(Frame& frame);
  bool weigh_segment(Frame& frame);
  bool find_segment(const Span& side, std::uint32_t length, DomainTable::Number& number);
  std::optional<Weight> weight_of(const Span& side, DomainTable::Number number) const;
  Weight closing_weight(const Span& side) const;
  bool find_parts();
  template <class Visit>
  void join_parts(const Domain& domain, std::span<const EdgeNumber> weak, const Split& split,
                  Visit visit);
  void answer(const Part& part, std::vector<Answer>& answers) const;
  std::optional<Turn> turn_behind(const Span& span) const;
  Weight angle(const std::optional<Turn>& first, const std::optional<Turn>& second) const;
  Weight own_weight(const Domain& domain, Vertex third) const;
  void start_frame(const Domain& domain);

  const Borders& borders_;
  const Candidates& candidates_;
  bool has_angles_;
  Splitter splitter_;
  DomainTable table_;
  std::vector<Frame> frames_;  // more than are in use, so that their lists keep their memory
  std::size_t frame_count_ = 0;
  std::vector<Split> splits_;
  std::array<std::vector<Answer>, 2> answers_;  // of the parts of a split
  Domain unknown_;                              // the part that has to be weighed first
};

}  // namespace watertight::fill
