// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/inputs.h"

#include <algorithm>
#include <array>
#include <utility>

#include "codec/page_file.h"
#include "pipeline/container.h"

namespace watertight::cli {
namespace {

/// The number of bytes that are enough to detect the kind.
constexpr std::size_t kFirstBytes = 8;

Result<Input> input_of_container(ByteView bytes, const Limits& limits) {
  auto documents = pipeline::decode_container(bytes, limits);
  if (!documents) return std::move(documents).error();
  if (documents->size() != 1) {
    return Error{ErrorCode::unsupported,
                 "the file has " + std::to_string(documents->size()) +
                     " documents, and this command reads one; decode writes a file for each"};
  }
  return Input{InputKind::container, std::move(documents->front())};
}

Result<Input> input_of_blob(const std::string& path, ByteView bytes, const Limits& limits) {
  auto decoded = decode(bytes, limits);
  if (!decoded) return std::move(decoded).error();
  Feature feature;
  feature.id = path;
  feature.srid = decoded->info.srid;
  feature.solids.push_back(SubmittedSolid{std::move(decoded->solid), {}, {}});
  Input input{InputKind::blob, {}};
  // Like EWKB, a blob is one solid without a document around it.
  input.document.format = Format::ewkb;
  input.document.features.push_back(std::move(feature));
  return input;
}

/// A source of the bytes of `first`, then of those of `rest`.
formats::ByteSource source_of(Bytes first, formats::ByteSource rest) {
  return [first = std::move(first), rest = std::move(rest),
          given = std::size_t{0}](std::span<std::uint8_t> bytes) mutable -> Result<std::size_t> {
    if (given == first.size()) return rest(bytes);
    const std::size_t part = std::min(bytes.size(), first.size() - given);
    std::copy_n(first.begin() + static_cast<std::ptrdiff_t>(given), part, bytes.begin());
    given += part;
    return part;
  };
}

/// The first bytes of a source: kFirstBytes, or fewer where the source ends.
Result<Bytes> first_bytes(const formats::ByteSource& source) {
  Bytes first(kFirstBytes);
  std::size_t count = 0;
  while (count < first.size()) {
    const auto more = source(std::span<std::uint8_t>(first).subspan(count));
    if (!more) return more.error();
    if (*more == 0) break;
    count += *more;
  }
  first.resize(count);
  return first;
}

}  // namespace

InputKind kind_of_input(ByteView bytes) {
  constexpr std::uint8_t kLeastText = 9;  // a tabulator
  if (pipeline::is_container(bytes)) return InputKind::container;
  if (codec::is_page_file(bytes)) return InputKind::page_file;
  // A blob begins with its magic and a version byte that no text has.
  const bool is_blob =
      bytes.size() > 2 && bytes[0] == 'W' && bytes[1] == 'T' && (bytes[2] & 0x7FU) < kLeastText;
  return is_blob ? InputKind::blob : InputKind::document;
}

Error page_file_error() {
  return {ErrorCode::unsupported,
          "this is a page file; the commands read Watertight files and blobs"};
}

Result<Input> load_input(const std::string& path, ByteView bytes,
                         const formats::ReadOptions& options) {
  switch (kind_of_input(bytes)) {
    case InputKind::container:
      return input_of_container(bytes, options.limits);
    case InputKind::page_file:
      return page_file_error();
    case InputKind::blob:
      return input_of_blob(path, bytes, options.limits);
    case InputKind::document:
      break;
  }
  const auto format = formats::detect_format(path == "-" ? "" : path, bytes);
  if (!format) return format.error();
  auto document = formats::read_document(bytes, *format, options);
  if (!document) return std::move(document).error();
  return Input{InputKind::document, *std::move(document)};
}

Result<FoundInput> find_input(OpenedFile file) {
  auto first = first_bytes(file.source);
  if (!first) return std::move(first).error();
  const InputKind kind = kind_of_input(*first);
  return FoundInput{kind, source_of(*std::move(first), std::move(file.source)), file.bytes};
}

Result<OpenedInput> open_input(const std::string& path, FoundInput input,
                               const formats::ReadOptions& options) {
  if (input.kind == InputKind::document) {
    auto reader =
        formats::FeatureReader::open(std::move(input.source), path == "-" ? "" : path, options);
    if (!reader) return std::move(reader).error();
    return OpenedInput{*std::move(reader), input.bytes};
  }
  const auto bytes = read_all(input.source, options.limits);
  if (!bytes) return bytes.error();
  auto loaded = load_input(path, *bytes, options);
  if (!loaded) return std::move(loaded).error();
  return OpenedInput{formats::FeatureReader::of(std::move(loaded->document)), input.bytes};
}

Result<OpenedInput> open_input(const std::string& path, const formats::ReadOptions& options) {
  auto file = open_file(path);
  if (!file) return std::move(file).error();
  auto input = find_input(*std::move(file));
  if (!input) return std::move(input).error();
  return open_input(path, *std::move(input), options);
}

Result<Format> format_of_name(const std::string& path) {
  const auto format = formats::detect_format(path, {});
  if (format) return format;
  return Error{ErrorCode::unsupported, "the extension of '" + path +
                                           "' is not that of a known format; known: .city.json "
                                           ".json .city.jsonl .jsonl .obj .off .wkt "
                                           ".wkb .ewkb"};
}

}  // namespace watertight::cli
