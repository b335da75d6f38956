// SPDX-License-Identifier: GPL-3.0-or-later
//
// The findings of the HTML report: a section for each object, in it a row for each finding.
// Internal to report/.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "report/feature_report.h"
#include "report/place.h"

namespace watertight::report {

/// Collects the rows of the findings of a run. Options bound their number and that of the pictures.
/// The codes share the pictures: when all are drawn, a code with few pictures takes the place of
/// the last picture of the code with the most. A row without a picture shows its code's figure.
class FindingRows {
 public:
  explicit FindingRows(const HtmlOptions& options) : options_(options) {}

  /// Adds the findings of a feature, by object.
  void add(std::string_view file, const pipeline::InspectedFeature& feature);
  /// Adds a row for an error of reading; nothing after the first 200.
  void add_error(std::string_view file, const Error& error);

  /// Writes the sections. Errors: those of the sink.
  Status write(const TextSink& sink) const;

  std::size_t rows() const { return row_count_; }
  std::size_t pictures() const { return picture_count_; }

 private:
  struct Row {
    int code = 0;
    std::string start;    // the tag <tr>
    std::string picture;  // the element <figure>; "" for none
    std::string cells;    // the cells after the picture, and </tr>
  };
  struct Section {
    std::string object;  // as in the document
    std::string head;    // HTML
    std::vector<Row> rows;
  };
  /// The number of a row: its section, and its number in the section.
  struct RowPlace {
    std::size_t section = 0;
    std::size_t row = 0;
  };

  Section& section_of(std::string_view file, const pipeline::InspectedFeature& feature,
                      const PlacedFinding& placed, std::size_t first);
  void add_picture(const pipeline::InspectedFeature& feature, const PlacedFinding& placed,
                   RowPlace place);
  std::map<int, std::vector<RowPlace>>::iterator most_drawn();
  /// Whether a code may have another picture, in the place of another code's if need be.
  bool has_room(int code);
  /// Takes a picture from the code with the most if all are drawn.
  void make_room();

  HtmlOptions options_;
  std::vector<Section> sections_;
  std::map<int, std::vector<RowPlace>> pictures_;  // the rows with pictures, by code
  std::size_t row_count_ = 0;
  std::size_t picture_count_ = 0;
  std::size_t error_count_ = 0;
  std::uint64_t facets_visited_ = 0;
};

}  // namespace watertight::report
