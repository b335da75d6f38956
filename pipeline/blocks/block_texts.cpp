// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/blocks/block_texts.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "formats/document.h"
#include "packing/feature_text.h"

namespace watertight::pipeline {
namespace {

using columns::Text;
using columns::TextKind;

constexpr std::string_view kDocuments = "documents\n";
constexpr std::string_view kFeatures = "features\n";
constexpr std::string_view kSolids = "solids\n";
constexpr std::string_view kErrors = R"("all_errors":[)";

/// Writes a table: a line with its name, then lines of cells with tabs between them. A tab, a line
/// feed and a backslash in a cell are "\t", "\n" and "\\".
class TableWriter {
 public:
  explicit TableWriter(std::string_view name) : text_(name) {}
  void cell(std::string_view value) {
    if (!is_first_) text_ += '\t';
    is_first_ = false;
    for (const char c : value) {
      switch (c) {
        case '\t':
          text_ += "\\t";
          break;
        case '\n':
          text_ += "\\n";
          break;
        case '\\':
          text_ += "\\\\";
          break;
        default:
          text_ += c;
      }
    }
  }
  void cell(std::uint64_t value) { cell(std::to_string(value)); }
  void end_row() {
    text_ += '\n';
    is_first_ = true;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
  bool is_first_ = true;
};

/// Reads the table of a TableWriter. After a failure all cells are empty.
class TableReader {
 public:
  TableReader(std::string_view text, std::string_view name) : rest_(text) {
    has_failed_ = !text.starts_with(name);
    rest_.remove_prefix(std::min(name.size(), rest_.size()));
  }
  std::string cell() {
    const std::size_t end = rest_.find_first_of("\t\n");
    if (has_failed_ || end == std::string_view::npos) {
      has_failed_ = true;
      return {};
    }
    std::string value;
    for (std::size_t i = 0; i < end; ++i) {
      const bool is_escape = rest_[i] == '\\' && i + 1 < end;
      if (is_escape) ++i;
      value += !is_escape ? rest_[i] : rest_[i] == 't' ? '\t' : rest_[i] == 'n' ? '\n' : rest_[i];
    }
    rest_.remove_prefix(end + 1);
    return value;
  }
  std::uint64_t number() {
    const std::string text = cell();
    std::uint64_t value = 0;
    const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || rest != text.data() + text.size()) has_failed_ = true;
    return has_failed_ ? 0 : value;
  }
  std::uint32_t index() {
    const std::uint64_t value = number();
    if (value > std::numeric_limits<std::uint32_t>::max()) has_failed_ = true;
    return has_failed_ ? 0 : static_cast<std::uint32_t>(value);
  }
  bool has_failed() const { return has_failed_; }
  bool is_done() const { return !has_failed_ && rest_.empty(); }

 private:
  std::string_view rest_;
  bool has_failed_ = false;
};

/// The codes of the errors in a report, with commas between them.
std::string_view error_codes(std::string_view report) {
  const std::size_t at = report.find(kErrors);
  if (at == std::string_view::npos) return {};
  const std::string_view codes = report.substr(at + kErrors.size());
  return codes.substr(0, codes.find(']'));
}

std::string report_of(std::string_view codes) {
  return std::string("{").append(kErrors).append(codes).append("]}");
}

TextKind kind_of_framing(std::string_view format) {
  return format == formats::to_string(formats::Format::gml) ? TextKind::xml : TextKind::bytes;
}

/// The parts of EncodedFeature::skeleton: the lines about solids, the skeleton itself, the layout.
struct SkeletonParts {
  std::vector<std::string_view> lines;
  std::string_view skeleton;
  std::optional<std::string_view> layout;
};

SkeletonParts parts_of(std::string_view text) {
  SkeletonParts parts;
  while (std::ranges::any_of(packing::kSolidLines,
                             [&](std::string_view start) { return text.starts_with(start); })) {
    const std::size_t size = std::min(text.find('\n'), text.size() - 1) + 1;
    parts.lines.push_back(text.substr(0, size));
    text.remove_prefix(size);
  }
  const std::size_t end = text.find('\n');
  parts.skeleton = text.substr(0, end);
  if (end != std::string_view::npos) parts.layout = text.substr(end + 1);
  return parts;
}

/// Collects the texts of a block.
class TextList {
 public:
  void add(TextKind kind, std::string text) { texts_.emplace_back(kind, std::move(text)); }
  void add(const BlockDocument& document) {
    add(TextKind::json, document.header.str());
    add(kind_of_framing(document.format), std::string(as_text(document.framing)));
  }
  void add(const SkeletonParts& parts) {
    for (const std::string_view line : parts.lines) add(TextKind::json, std::string(line));
    add(TextKind::json, std::string(parts.skeleton));
    if (parts.layout) add(TextKind::bytes, std::string(*parts.layout));
  }
  PackedTexts pack() const {
    PackedTexts packed;
    std::vector<Text> views;
    for (const auto& [kind, text] : texts_) {
      views.push_back({kind, text});
      packed.text_bytes += text.size();
    }
    packed.bytes = columns::pack_texts(views);
    return packed;
  }

 private:
  std::vector<std::pair<TextKind, std::string>> texts_;
};

void add_row(TableWriter& table, const BlockFeature& feature, bool has_numbers,
             const SkeletonParts& parts) {
  const EncodedFeature& encoded = feature.encoded;
  table.cell(feature.document);
  if (has_numbers) table.cell(feature.number);
  table.cell(encoded.id);
  table.cell(encoded.type);
  table.cell(encoded.srid);
  table.cell(encoded.findings.empty() ? 0 : 1);
  table.cell(parts.lines.size());
  table.cell(parts.layout ? 1 : 0);
  table.cell(encoded.solids.size());
  table.end_row();
}

void add_row(TableWriter& table, const StoredSolid& solid, std::uint64_t blob_bytes) {
  table.cell(solid.object_id);
  table.cell(solid.lod);
  table.cell(solid.geometry);
  table.cell(solid.ordinal);
  table.cell(blob_bytes);
  table.cell(error_codes(solid.report));
  table.end_row();
}

/// Gives the rows of the tables their texts.
class BlockBuilder {
 public:
  BlockBuilder(std::vector<std::string> texts, std::size_t documents, ReadBudget& budget)
      : texts_(std::move(texts)), documents_(documents), budget_(budget) {}

  /// None when texts and tables do not fit.
  std::optional<BlockTexts> build() && {
    if (texts_.size() < kTables) return std::nullopt;
    last_text_ = texts_.size() - kTables;
    read_documents(TableReader(texts_[last_text_], kDocuments));
    read_features(TableReader(texts_[last_text_ + 1], kFeatures),
                  TableReader(texts_[last_text_ + 2], kSolids));
    if (has_failed_ || next_text_ != last_text_) return std::nullopt;
    return std::move(built_);
  }

 private:
  static constexpr std::size_t kTables = 3;

  std::string next_text() {
    if (next_text_ < last_text_) return std::move(texts_[next_text_++]);
    has_failed_ = true;
    return {};
  }

  void read_documents(TableReader table) {
    const std::uint64_t count = table.number();
    built_.block.has_numbers = table.number() == 1;
    if (!budget_.take_items(count)) has_failed_ = true;
    for (std::uint64_t i = 0; i < count && !has_failed_; ++i) {
      BlockDocument& document = built_.block.documents.emplace_back();
      document.format = table.cell();
      document.header = next_text();
      const std::string framing = next_text();
      document.framing.assign(framing.begin(), framing.end());
      has_failed_ = has_failed_ || table.has_failed();
    }
    if (!table.is_done()) has_failed_ = true;
    if (documents_ == 0) documents_ = built_.block.documents.size();
  }

  void read_features(TableReader table, TableReader solids) {
    while (!has_failed_ && !table.is_done()) {
      if (!budget_.take_items(1)) has_failed_ = true;
      ReadFeature& feature = built_.block.features.emplace_back();
      EncodedFeature& encoded = feature.encoded;
      feature.ordinal = built_.block.features.size() - 1;
      feature.document = table.number();
      if (built_.block.has_numbers) feature.number = table.number();
      encoded.id = table.cell();
      encoded.type = table.cell();
      encoded.srid = table.index();
      if (table.number() > 0) encoded.findings = kUnknownFindings;
      const std::uint64_t lines = table.number();
      for (std::uint64_t i = 0; i < lines && !has_failed_; ++i) encoded.skeleton += next_text();
      encoded.skeleton += next_text();
      if (table.number() > 0) encoded.skeleton.append("\n").append(next_text());
      read_solids(encoded, table.number(), solids);
      if (table.has_failed() || feature.document >= documents_) has_failed_ = true;
    }
    if (!solids.is_done()) has_failed_ = true;
  }

  void read_solids(EncodedFeature& feature, std::uint64_t count, TableReader& table) {
    if (!budget_.take_items(count)) has_failed_ = true;
    for (std::uint64_t i = 0; i < count && !has_failed_; ++i) {
      StoredSolid& solid = feature.solids.emplace_back();
      solid.object_id = table.cell();
      solid.lod = table.cell();
      solid.geometry = table.index();
      solid.ordinal = table.index();
      built_.blob_bytes.push_back(table.number());
      solid.is_proven = built_.blob_bytes.back() != kNoBlob;
      const std::string codes = table.cell();
      if (!solid.is_proven) solid.report = report_of(codes);
      has_failed_ = has_failed_ || table.has_failed();
    }
  }

  /// Of the findings between solids a block keeps only that there are some.
  static constexpr const char* kUnknownFindings = "[]";

  std::vector<std::string> texts_;
  std::size_t documents_;
  ReadBudget& budget_;
  BlockTexts built_;
  std::size_t next_text_ = 0;
  std::size_t last_text_ = 0;
  bool has_failed_ = false;
};

}  // namespace

PackedTexts pack_block_texts(const BlockContents& contents,
                             std::span<const std::uint64_t> blob_bytes) {
  TextList texts;
  TableWriter documents(kDocuments);
  documents.cell(contents.documents.size());
  documents.cell(contents.has_numbers ? 1 : 0);
  documents.end_row();
  for (const BlockDocument& document : contents.documents) {
    texts.add(document);
    documents.cell(document.format);
    documents.end_row();
  }
  TableWriter features(kFeatures);
  TableWriter solids(kSolids);
  std::size_t number = 0;
  for (const BlockFeature& feature : contents.features) {
    const SkeletonParts parts = parts_of(feature.encoded.skeleton);
    texts.add(parts);
    add_row(features, feature, contents.has_numbers, parts);
    for (const StoredSolid& solid : feature.encoded.solids) {
      add_row(solids, solid, blob_bytes[number++]);
    }
  }
  for (const TableWriter* table : {&documents, &features, &solids}) {
    texts.add(TextKind::table, table->text());
  }
  return texts.pack();
}

Result<BlockTexts> unpack_block_texts(ByteView bytes, std::size_t documents, ReadBudget& budget) {
  auto texts = columns::unpack_texts(bytes, budget.texts_left());
  if (!texts) return std::move(texts).error();
  for (const std::string& text : *texts) budget.take_text(text.size());
  auto built = BlockBuilder(*std::move(texts), documents, budget).build();
  if (!built) return Error{ErrorCode::malformed, "malformed texts of a block", 0, {}};
  return *std::move(built);
}

}  // namespace watertight::pipeline
