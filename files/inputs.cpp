// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/inputs.h"

#include <algorithm>
#include <utility>

#include "base/ascii.h"
#include "codec/page_file.h"
#include "files/names.h"
#include "files/zip_documents.h"
#include "pipeline/container.h"

namespace watertight::files {
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

Result<Input> input_of_blob(const std::string& name, ByteView bytes, const Limits& limits) {
  auto decoded = decode(bytes, limits);
  if (!decoded) return std::move(decoded).error();
  Feature feature;
  feature.id = name.empty() ? "-" : name;
  feature.srid = decoded->info.srid;
  feature.solids.push_back(SubmittedSolid{std::move(decoded->solid), {}, {}});
  Input input{InputKind::blob, {}};
  // Like EWKB, a blob is one solid without a document around it.
  input.document.format = Format::ewkb;
  input.document.features.push_back(std::move(feature));
  return input;
}

/// A source of the bytes of `first`, then of those of `rest`.
ByteSource source_of(Bytes first, ByteSource rest) {
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
Result<Bytes> first_bytes(const ByteSource& source) {
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

Error nested_error() {
  return {ErrorCode::unsupported,
          "an archive in an archive, or something compressed twice, is not read"};
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

Result<Input> load_input(const std::string& name, ByteView bytes,
                         const formats::ReadOptions& options) {
  switch (kind_of_input(bytes)) {
    case InputKind::container:
      return input_of_container(bytes, options.limits);
    case InputKind::page_file:
      return page_file_error();
    case InputKind::blob:
      return input_of_blob(name, bytes, options.limits);
    case InputKind::document:
      break;
  }
  const auto format = formats::detect_format(name, bytes);
  if (!format) return format.error();
  auto document = formats::read_document(bytes, *format, options);
  if (!document) return std::move(document).error();
  return Input{InputKind::document, *std::move(document)};
}

Result<FoundInput> find_input(OpenedFile file, const std::string& name) {
  auto first = first_bytes(file.source);
  if (!first) return std::move(first).error();
  const archives::Compression compression = archives::compression_of(*first);
  ByteSource source = source_of(*first, std::move(file.source));
  const bool is_packed = compression != archives::Compression::none;
  if (is_packed && file.is_member) return nested_error();
  if (compression == archives::Compression::zip) {
    auto member = only_member(source);
    if (!member) return std::move(member).error();
    auto opened = member->open();
    if (!opened) return std::move(opened).error();
    return find_input(*std::move(opened), member->name);
  }
  FoundInput found{kind_of_input(*first), std::move(source), file.bytes, name == "-" ? "" : name};
  if (!is_packed) return found;
  found.name = name_without_compression(found.name);
  if (lower_case(found.name).ends_with(".tar")) {
    return Error{ErrorCode::unsupported, "tar archives are not read; zip archives are"};
  }
  found.source = archives::expanded(std::move(found.source), compression);
  found.bytes.reset();
  first = first_bytes(found.source);
  if (!first) return std::move(first).error();
  if (archives::compression_of(*first) != archives::Compression::none) return nested_error();
  found.kind = kind_of_input(*first);
  found.source = source_of(*std::move(first), std::move(found.source));
  return found;
}

Result<OpenedInput> open_input(FoundInput input, const formats::ReadOptions& options,
                               const formats::FeatureReader::HeaderFinder& lone_header) {
  if (input.kind == InputKind::document) {
    auto reader =
        formats::FeatureReader::open(std::move(input.source), input.name, options, lone_header);
    if (!reader) return std::move(reader).error();
    return OpenedInput{*std::move(reader), input.bytes};
  }
  const auto bytes = read_all(input.source, options.limits);
  if (!bytes) return bytes.error();
  auto loaded = load_input(input.name, *bytes, options);
  if (!loaded) return std::move(loaded).error();
  return OpenedInput{formats::FeatureReader::of(std::move(loaded->document)), input.bytes};
}

Result<OpenedInput> open_input(const InputFile& input, const formats::ReadOptions& options) {
  auto file = input.open();
  if (!file) return std::move(file).error();
  auto found = find_input(*std::move(file), input.name);
  if (!found) return std::move(found).error();
  return open_input(*std::move(found), options);
}

Result<WholeInput> read_whole(const InputFile& input, const Limits& limits) {
  auto file = input.open();
  if (!file) return std::move(file).error();
  auto found = find_input(*std::move(file), input.name);
  if (!found) return std::move(found).error();
  auto bytes = read_all(found->source, limits);
  if (!bytes) return std::move(bytes).error();
  return WholeInput{std::move(found->name), *std::move(bytes)};
}

Result<Format> format_of_name(const std::string& path) {
  const auto format = formats::detect_format(path, {});
  if (format) return format;
  return Error{ErrorCode::unsupported, "the extension of '" + path +
                                           "' is not that of a known format; known: .city.json "
                                           ".json .city.jsonl .jsonl .obj .off .wkt "
                                           ".wkb .ewkb"};
}

}  // namespace watertight::files
