// SPDX-License-Identifier: GPL-3.0-or-later
//
// The commands append and delete, which add to the end of a Watertight file.
#include <cstdio>
#include <set>
#include <utility>

#include "base/quantity.h"
#include "cli/commands.h"
#include "cli/outputs/locked_file.h"
#include "cli/sources/input_list.h"
#include "cli/sources/ranged_file.h"
#include "cli/terminal/printable.h"
#include "cli/terminal/progress.h"
#include "pipeline/container.h"

namespace watertight::cli {
namespace {

/// A Watertight file that is being added to.
class EditedFile {
 public:
  static Result<EditedFile> open(const std::string& path) {
    auto locked = LockedFile::open(path);
    if (!locked) return std::move(locked).error();
    auto file = pipeline::ContainerFile::open(locked->bytes(), {}, pipeline::TornTail::leave_out);
    if (!file) return std::move(file).error();
    warn_of_torn(path, *file);
    return EditedFile(*std::move(locked), *std::move(file));
  }

  /// Starts to write. Errors: those of ContainerWriter::append().
  Status begin() {
    auto writer =
        pipeline::ContainerWriter::append(file_, {.purpose = pipeline::FilePurpose::ranges});
    if (!writer) return std::move(writer).error();
    writer_.emplace(*std::move(writer));
    return Done{};
  }

  /// Deletes the features with these ids, and returns those that there were.
  Result<std::set<std::string>> remove(const std::set<std::string>& ids) {
    std::set<std::string> removed;
    if (ids.empty()) return removed;
    const auto blocks = file_.blocks_of({ids.begin(), ids.end()});
    if (!blocks) return blocks.error();
    for (const std::uint64_t number : *blocks) {
      const auto block = file_.block(number);
      if (!block) return block.error();
      for (const pipeline::ReadFeature& feature : block->features) {
        if (!ids.contains(feature.encoded.id)) continue;
        writer_->remove({number, feature.ordinal}, feature.encoded.solids.size());
        removed.insert(feature.encoded.id);
      }
    }
    return removed;
  }

  pipeline::ContainerWriter& writer() { return *writer_; }

  /// Writes all changes. Errors: those of ContainerWriter::finish() and LockedFile::add().
  Status commit() {
    auto rest = std::move(*writer_).finish_in_parts();
    if (!rest) return std::move(rest).error();
    return locked_.add(file_.committed(), rest->records, rest->commit);
  }

 private:
  EditedFile(LockedFile locked, pipeline::ContainerFile file)
      : locked_(std::move(locked)), file_(std::move(file)) {}

  LockedFile locked_;
  pipeline::ContainerFile file_;
  std::optional<pipeline::ContainerWriter> writer_;
};

/// The ids of the features of documents. Errors: conflict when two features have one id.
Result<std::set<std::string>> ids_in(const std::vector<pipeline::EncodedDocument>& documents) {
  std::set<std::string> ids;
  for (const pipeline::EncodedDocument& document : documents) {
    for (const pipeline::EncodedFeature& feature : document.features) {
      if (feature.id.empty() || ids.insert(feature.id).second) continue;
      return Error{ErrorCode::conflict, "two features have the id '" + feature.id + "'"};
    }
  }
  return ids;
}

/// Adds the features of documents; returns how many features they replace.
Result<std::uint64_t> add_all(EditedFile& file, std::vector<pipeline::EncodedDocument> documents) {
  const auto ids = ids_in(documents);
  if (!ids) return ids.error();
  if (Status begun = file.begin(); !begun) return begun.error();
  const auto replaced = file.remove(*ids);
  if (!replaced) return replaced.error();
  for (pipeline::EncodedDocument& document : documents) {
    file.writer().add_document(document.format, document.header, std::move(document.framing));
    for (const std::size_t i : pipeline::order_of_places(document.features)) {
      const Status added = file.writer().add(std::move(document.features[i]));
      if (!added) return added.error();
    }
  }
  if (Status written = file.commit(); !written) return written.error();
  return replaced->size();
}

}  // namespace

Exit run(const AppendCommand& command) {
  auto file = EditedFile::open(command.target);
  if (!file) return fail(command.target, file.error());
  const std::vector<files::InputFile> inputs = list_inputs(command.encode.files);
  std::vector<pipeline::EncodedDocument> documents;
  std::uint64_t features = 0;
  Exit exit = Exit::valid;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    EncodeCommand one = command.encode;
    one.input = inputs[i].name;
    EncodedInput encoded = encode_one(one, inputs[i], position_among(i + 1, inputs.size()));
    exit = worse(exit, encoded.exit);
    if (!encoded.document) return exit;
    features += encoded.document->features.size();
    documents.push_back(*std::move(encoded.document));
  }
  const auto replaced = add_all(*file, std::move(documents));
  if (!replaced) return fail(command.target, replaced.error());
  std::fprintf(stderr, "watertight: %s: %s added, of which %llu replaced another\n",
               printable(command.target).c_str(), quantity(features, "feature").c_str(),
               static_cast<unsigned long long>(*replaced));
  return exit;
}

Exit run(const DeleteCommand& command) {
  auto file = EditedFile::open(command.target);
  if (!file) return fail(command.target, file.error());
  if (Status begun = file->begin(); !begun) return fail(command.target, begun.error());
  const auto removed = file->remove({command.ids.begin(), command.ids.end()});
  if (!removed) return fail(command.target, removed.error());
  Exit exit = Exit::valid;
  for (const std::string& id : command.ids) {
    if (removed->contains(id)) continue;
    complain(command.target, {ErrorCode::not_found, "no feature has the id '" + id + "'"});
    exit = Exit::invalid;
  }
  if (removed->empty()) return exit;
  const Status written = file->commit();
  return written ? exit : fail(command.target, written.error());
}

}  // namespace watertight::cli
