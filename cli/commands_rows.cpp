// SPDX-License-Identifier: GPL-3.0-or-later
//
// The command rows: the solids of documents as rows of text for PostgreSQL's COPY, so that a table
// takes what a file has. Nothing is judged here; the type `solid` does it (docs/sql.md).
#include <cstdio>
#include <string_view>

#include "base/quantity.h"
#include "cli/commands.h"
#include "cli/rules.h"
#include "cli/sources/input_list.h"
#include "cli/terminal/printable.h"
#include "files/inputs.h"
#include "formats/ewkb.h"

namespace watertight::cli {
namespace {

/// A text as a column of COPY: without characters that end columns or rows.
void append_column(std::string& row, std::string_view text) {
  for (const char letter : text) {
    switch (letter) {
      case '\\':
        row += "\\\\";
        break;
      case '\t':
        row += "\\t";
        break;
      case '\n':
        row += "\\n";
        break;
      case '\r':
        row += "\\r";
        break;
      case '\0':
        break;  // PostgreSQL has no texts with it
      default:
        row += letter;
    }
  }
  row += '\t';
}

void append_hexadecimal(std::string& row, ByteView bytes) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  row += "\\\\x";
  for (const std::uint8_t byte : bytes) {
    row += kDigits[byte >> 4U];
    row += kDigits[byte & 15U];
  }
  row += '\n';
}

/// Writes the rows of documents.
class RowWriter {
 public:
  explicit RowWriter(const formats::ReadOptions& options) : options_(options) {}

  /// Errors: those of the input.
  Status add(const files::InputFile& input) {
    auto opened = files::open_input(input, options_);
    if (!opened) return std::move(opened).error();
    for (;;) {
      auto text = opened->reader.next();
      if (!text) return std::move(text).error();
      if (!*text) return Done{};
      const auto feature = opened->reader.read(**text);
      if (feature) {
        write(*feature);
      } else {
        leave_out(input.name, formats::at_place(feature.error(), (*text)->place, ""));
      }
    }
  }

  std::uint64_t left_out() const { return left_out_; }

 private:
  void write(const Feature& feature) {
    for (const SubmittedSolid& submitted : feature.solids) {
      if (!submitted.unreadable.empty()) {
        leave_out(feature.id, {ErrorCode::malformed, submitted.unreadable});
        continue;
      }
      row_.clear();
      append_column(row_, feature.id);
      append_column(row_, submitted.source.object_id);
      append_column(row_, submitted.source.lod);
      append_hexadecimal(row_, formats::write_ewkb(submitted.solid));
      std::fwrite(row_.data(), 1, row_.size(), stdout);
    }
  }

  void leave_out(const std::string& name, const Error& error) {
    ++left_out_;
    complain(name, error);
  }

  const formats::ReadOptions options_;
  std::string row_;
  std::uint64_t left_out_ = 0;
};

}  // namespace

Exit run(const RowsCommand& command) {
  formats::ReadOptions options;
  options.surfaces = surface_rule(command.surfaces).reading;
  options.curved = pipeline::curved_reading(command.chord);
  RowWriter writer(options);
  Exit exit = Exit::valid;
  for (const files::InputFile& input : list_inputs(command.files)) {
    const Status added = writer.add(input);
    if (added) continue;
    complain(input.name, added.error());
    exit = Exit::error;
  }
  if (writer.left_out() > 0) {
    std::fprintf(
        stderr, "watertight: %s left out\n",
        quantity(writer.left_out(), "solid or feature was", "solids or features were").c_str());
    if (exit == Exit::valid) exit = Exit::invalid;
  }
  return exit;
}

}  // namespace watertight::cli
