// SPDX-License-Identifier: GPL-3.0-or-later
//
// The command export.
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <vector>

#include "base/quantity.h"
#include "cli/commands.h"
#include "cli/opened_store.h"
#include "cli/outputs/output_files.h"
#include "cli/terminal/printable.h"
#include "files/inputs.h"
#include "geopackage/collection_file.h"
#include "pipeline/export.h"
#include "pipeline/stored/attributes.h"

namespace watertight::cli {
namespace {

/// A run of `watertight export`: one file, or one for each sequence that the collection needs.
class ExportRun {
 public:
  explicit ExportRun(const ExportCommand& command)
      : command_(command),
        scope_(command.is_proven_only ? pipeline::ExportScope::proven
                                      : pipeline::ExportScope::all) {}

  Exit run() {
    const bool is_container = command_.output == "-" || command_.output.ends_with(".wt");
    const bool is_package = command_.output.ends_with(".gpkg");
    if (!is_container && !is_package && !is_sequence(command_.output)) {
      return fail(command_.output, {ErrorCode::unsupported,
                                    "export writes Watertight files (.wt), CityJSONSeq (.jsonl) "
                                    "and GeoPackages (.gpkg)"});
    }
    if (!command_.lod.empty() && !is_package) {
      return fail("--lod", {ErrorCode::invalid_argument, "only a GeoPackage has one level"});
    }
    // As root, opening a private cluster gives up the right to write where root can.
    const bool gives_up_rights = ::geteuid() == 0 && command_.store.database_url.empty();
    auto files = OutputFiles::open(command_.output, gives_up_rights);
    if (!files) return fail(name_of(command_.output), files.error());
    files_.emplace(*std::move(files));
    if (const Status read = read_conditions(); !read) return fail("--where", read.error());
    const auto opened = open_store(command_.store);
    if (!opened) return fail("store", opened.error());
    const Exit exit = is_container ? write_container(*opened->store)
                      : is_package ? write_package(*opened->store)
                                   : write_sequences(*opened->store);
    if (exit != Exit::valid) return exit;
    if (const Status status = files_->commit(); !status) return fail("export", status.error());
    for (const std::string& sentence : sentences_) {
      std::fprintf(stderr, "watertight: %s\n", printable(sentence).c_str());
    }
    return Exit::valid;
  }

 private:
  static bool is_sequence(const std::string& name) {
    const auto format = files::format_of_name(name);
    return format && *format == Format::city_json_seq;
  }
  static std::string name_of(const std::string& output) {
    return output == "-" ? "standard output" : output;
  }
  Status read_conditions() {
    if (command_.where.empty()) return Done{};
    std::vector<store::AttributeCondition> conditions;
    for (const std::string& text : command_.where) {
      const std::size_t sign = text.find('=');
      if (sign == std::string::npos) {
        return Error{ErrorCode::invalid_argument, "'" + text + "' is not NAME=VALUE"};
      }
      auto condition = pipeline::condition_of(text.substr(0, sign), text.substr(sign + 1));
      if (!condition) return std::move(condition).error();
      conditions.push_back(*std::move(condition));
    }
    filter_ = store::filter_of(conditions);
    return Done{};
  }

  Exit write_container(SolidStore& store) {
    pipeline::ContainerOptions options;
    options.purpose = *pipeline::file_purpose_named(command_.purpose);
    auto exporting = pipeline::CollectionExport::start(
        store, command_.collection, pipeline::ExportFormat::container, options, scope_, filter_);
    if (!exporting) return fail(command_.collection, exporting.error());
    const Exit exit = write(*exporting, 0);
    if (exit == Exit::valid) sentences_.push_back(counts_of(*exporting) + " written");
    return exit;
  }

  Exit write_package(SolidStore& store) {
    std::optional<std::string> lod;
    if (!command_.lod.empty()) lod = command_.lod;
    const auto made =
        geopackage::collection_file(store, command_.collection, {scope_, filter_, std::move(lod)});
    if (!made) return fail(command_.collection, made.error());
    constexpr std::uint64_t kPiece = 1U << 20U;
    for (std::uint64_t at = 0; at < made->file.size(); at += kPiece) {
      const auto count = static_cast<std::size_t>(std::min(kPiece, made->file.size() - at));
      const auto bytes = made->file.read(at, count);
      if (!bytes) return fail(command_.output, bytes.error());
      const Status written = files_->write(0, as_text(*bytes));
      if (!written) return fail(files_->name(0), written.error());
    }
    sentences_.push_back(quantity(made->features, "feature") + " and " +
                         quantity(made->findings, "finding") + " written");
    return Exit::valid;
  }

  Exit write_sequences(SolidStore& store) {
    auto made = pipeline::SequencePlan::make(store, command_.collection);
    if (!made) return fail(command_.collection, made.error());
    const auto plan = std::make_shared<const pipeline::SequencePlan>(*std::move(made));
    for (std::size_t i = 0; i < plan->sequences().size(); ++i) {
      const Status added = i == 0 ? Status(Done{}) : files_->add();
      if (!added) return fail(files_->name(i), added.error());
      auto exporting = pipeline::CollectionExport::start_sequence(store, command_.collection, plan,
                                                                  i, scope_, filter_);
      if (!exporting) return fail(command_.collection, exporting.error());
      const Exit exit = write(*exporting, i);
      if (exit != Exit::valid) return exit;
      describe(*plan, i, *exporting);
    }
    return Exit::valid;
  }

  Exit write(pipeline::CollectionExport& exporting, std::size_t file) {
    for (;;) {
      const auto bytes = exporting.next();
      if (!bytes) return fail(command_.collection, bytes.error());
      if (bytes->empty()) return Exit::valid;
      const Status written = files_->write(file, as_text(*bytes));
      if (!written) return fail(files_->name(file), written.error());
    }
  }

  static std::string counts_of(const pipeline::CollectionExport& exporting) {
    return quantity(exporting.exported().features, "feature") + " with " +
           quantity(exporting.exported().solids, "solid");
  }

  /// Notes the facts about a sequence for the end of the run.
  void describe(const pipeline::SequencePlan& plan, std::size_t number,
                const pipeline::CollectionExport& exporting) {
    const pipeline::PlannedSequence& sequence = plan.sequences()[number];
    std::string text;
    if (plan.sequences().size() > 1) text = files_->name(number) + ": ";
    text += counts_of(exporting) + " written";
    if (sequence.headers > 1) {
      text += ", under one header for " + std::to_string(sequence.headers);
    }
    if (!sequence.reason.empty()) text += "; a file of its own: " + sequence.reason;
    sentences_.push_back(std::move(text));
    if (!sequence.losses.empty()) {
      std::string lost = files_->name(number) + ": left out, because the headers differ in it:";
      for (const std::string& path : sequence.losses) lost.append(1, ' ').append(path);
      sentences_.push_back(std::move(lost));
    }
    if (const std::uint64_t generic = exporting.exported().generic; generic > 0) {
      sentences_.push_back(files_->name(number) + ": " + quantity(generic, "feature") +
                           " came without a city model and have only their solids, as "
                           "GenericCityObject");
    }
  }

  const ExportCommand& command_;
  const pipeline::ExportScope scope_;
  std::optional<store::Filter> filter_;
  std::optional<OutputFiles> files_;
  std::vector<std::string> sentences_;
};

}  // namespace

Exit run(const ExportCommand& command) { return ExportRun(command).run(); }

}  // namespace watertight::cli
