// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/zip_documents.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "archives/expansion.h"
#include "archives/zip.h"
#include "files/names.h"

namespace watertight::files {
namespace {

using BytesOpener = std::function<Result<archives::RandomBytes>()>;

/// Whether a member belongs to the system that made the archive: "__MACOSX/._a.json", ".a.json".
bool is_of_system(std::string_view name) {
  if (name.starts_with("__MACOSX/")) return true;
  while (!name.empty()) {
    const std::string_view part = name.substr(0, name.find('/'));
    if (part.starts_with('.') && part != "." && part != "..") return true;
    name.remove_prefix(std::min(part.size() + 1, name.size()));
  }
  return false;
}

InputFile input_of(const archives::ZipMember& member, const std::string& path,
                   const std::string& name, const BytesOpener& open,
                   std::shared_ptr<archives::ExpansionCount> count) {
  InputFile input{name + '/' + member.name, path, name + '/' + member.name, {}};
  input.open = [member, open, count = std::move(count)]() -> Result<OpenedFile> {
    auto bytes = open();
    if (!bytes) return std::move(bytes).error();
    auto source = archives::open_member(*std::move(bytes), member, count);
    if (!source) return std::move(source).error();
    return OpenedFile{*std::move(source), member.size, true};
  };
  return input;
}

Result<ZipDocuments> documents_of(const BytesOpener& open, const std::string& path,
                                  const std::string& name) {
  auto bytes = open();
  if (!bytes) return std::move(bytes).error();
  auto members = archives::zip_members(*bytes);
  if (!members) return std::move(members).error();
  std::sort(members->begin(), members->end(),
            [](const auto& a, const auto& b) { return a.name < b.name; });
  const auto count =
      std::make_shared<archives::ExpansionCount>(archives::ExpansionLimit{}, bytes->size);
  ZipDocuments documents;
  for (const archives::ZipMember& member : *members) {
    const bool is_document = is_document_name(member.name) && !is_of_system(member.name);
    if (is_document || members->size() == 1) {
      documents.inputs.push_back(input_of(member, path, name, open, count));
    } else {
      ++documents.skipped;
    }
  }
  return documents;
}

}  // namespace

bool is_zip(const std::string& path) {
  const auto file = open_file(path);
  if (!file) return false;
  Bytes first(archives::kMagicBytes);
  const auto count = file->source(first);
  return count &&
         archives::compression_of(ByteView(first).first(*count)) == archives::Compression::zip;
}

Result<ZipDocuments> documents_of_zip(const std::string& path, const std::string& name) {
  return documents_of([path] { return open_random(path); }, path, name);
}

Result<InputFile> only_member(const ByteSource& source) {
  auto all = read_all(source, {});
  if (!all) return std::move(all).error();
  const auto shared = std::make_shared<const Bytes>(*std::move(all));
  const auto read = [shared](std::uint64_t offset,
                             std::span<std::uint8_t> out) -> Result<std::size_t> {
    const auto rest = ByteView(*shared).subspan(std::min<std::size_t>(offset, shared->size()));
    const std::size_t count = std::min(rest.size(), out.size());
    std::copy_n(rest.begin(), count, out.begin());
    return count;
  };
  const BytesOpener open = [shared, read] {
    return Result<archives::RandomBytes>(archives::RandomBytes{shared->size(), read});
  };
  auto documents = documents_of(open, "-", "-");
  if (!documents) return std::move(documents).error();
  if (documents->inputs.size() == 1) return std::move(documents->inputs.front());
  return Error{ErrorCode::unsupported,
               "a zip from a pipe must have one document, and this one has " +
                   std::to_string(documents->inputs.size()) + "; give the archive as a file"};
}

}  // namespace watertight::files
