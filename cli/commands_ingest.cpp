// SPDX-License-Identifier: GPL-3.0-or-later
//
// The command ingest: files of any length into a collection of a store.
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <unordered_map>

#include "base/quantity.h"
#include "cli/commands.h"
#include "cli/opened_store.h"
#include "cli/outputs/rejected_files.h"
#include "cli/sources/input_list.h"
#include "cli/terminal/printable.h"
#include "cli/terminal/progress.h"
#include "files/files.h"
#include "files/inputs.h"
#include "pipeline/collections/collection_header.h"
#include "pipeline/collections/collection_rules.h"
#include "pipeline/streaming/ingestion.h"

namespace watertight::cli {
namespace {

pipeline::IngestOptions ingest_options(const IngestCommand& command, formats::Contract contract) {
  pipeline::IngestOptions options;
  if (!command.remedies.empty()) {
    options.repair.emplace();
    options.repair->remedies = *repair::remedies_of(command.remedies);
    options.repair->weld_metres = command.weld_metres;
  }
  options.collection = command.collection;
  options.threads = command.jobs;
  options.contract = contract;
  if (!command.invalid.empty()) options.policy = *pipeline::policy_named(command.invalid);
  options.surfaces = surface_rule(command.surfaces).reading;
  return options;
}

/// Says which stored features have the box of another one.
void tell_twins(const std::string& file, const pipeline::IngestCounts& counts,
                const std::vector<store::Twins>& twins) {
  constexpr std::size_t kMostNamed = 3;
  if (counts.twins == 0) return;
  std::string text = quantity(counts.twins, "feature has", "features have") +
                     " the same box as another one of the collection, so they may be there twice:";
  for (std::size_t i = 0; i < std::min(kMostNamed, twins.size()); ++i) {
    text.append(i == 0 ? " '" : ", '").append(twins[i].id).append("' as '");
    text.append(twins[i].other).append("'");
  }
  if (counts.twins > kMostNamed) text += ", ...";
  std::fprintf(stderr, "watertight: %s: %s\n", printable(file).c_str(), printable(text).c_str());
}

/// A run of `watertight ingest`: all files, one after the other.
class IngestRun {
 public:
  IngestRun(const IngestCommand& command, formats::Contract contract)
      : command_(command),
        inputs_(list_inputs(command.files)),
        options_(ingest_options(command, contract)) {}

  Exit run();

 private:
  /// The file of each feature that this run has stored, as an index, by the feature's id. Empty in
  /// a run over one file.
  using FilesOfFeatures = std::unordered_map<std::string, std::size_t>;

  /// The facts about a file before all of it is stored.
  struct FileRun {
    Summary summary;
    std::vector<std::string> valid;                  // ids; none in a run over one file
    std::string header;                              // that of the document
    std::vector<pipeline::FeatureOutcome> left_out;  // with --rejected
  };

  Result<pipeline::IngestCounts> ingest(std::size_t number, SolidStore& store, FileRun& run);
  Status take(std::size_t number, pipeline::FeatureOutcome&& outcome, FileRun& run);
  void tell_replaced(std::size_t number, const FileRun& run);
  Status open_rejected(bool gives_up_rights);
  Status add_rejected(std::size_t number, FileRun run);
  bool has_several_files() const { return inputs_.size() > 1; }

  const IngestCommand& command_;
  const std::vector<files::InputFile> inputs_;
  const pipeline::IngestOptions options_;
  std::optional<delaunay::EngineWorkers> workers_;
  files::EarlyFiles early_;
  std::optional<RejectedFiles> rejected_;
  pipeline::IngestCounts counts_;  // of all files
  pipeline::StageTimes stages_;
  FilesOfFeatures files_;
  Summary summary_;
};

/// Says what of a GML document the store does not keep.
void tell_losses(const std::string& file, const Document& document) {
  for (const std::string& note : document.notes) {
    if (!note.starts_with("not mapped: ") && !note.starts_with("only solids ")) continue;
    std::fprintf(stderr, "watertight: %s: %s\n", printable(file).c_str(), printable(note).c_str());
  }
}

Status IngestRun::take(std::size_t number, pipeline::FeatureOutcome&& outcome, FileRun& run) {
  const auto other = files_.find(outcome.id);
  if (!outcome.has_own_id && other != files_.end()) {
    return Error{ErrorCode::conflict, "its features have no ids and would be called '" +
                                          outcome.id + "', as one of '" +
                                          inputs_[other->second].name + "' is"};
  }
  if (!command_.is_quiet && !command_.is_json) print_findings(inputs_[number].name, outcome);
  run.summary.add(outcome);
  if (has_several_files() && outcome.is_stored) run.valid.push_back(outcome.id);
  const bool is_whole = outcome.is_stored && outcome.left_out.empty();
  if (rejected_ && !is_whole) run.left_out.push_back(std::move(outcome));
  return Done{};
}

Result<pipeline::IngestCounts> IngestRun::ingest(std::size_t number, SolidStore& store,
                                                 FileRun& run) {
  const std::string& name = inputs_[number].name;
  auto file = early_.take(number);
  if (!file) return std::move(file).error();
  auto input = files::find_input(*std::move(file), name);
  if (!input) return std::move(input).error();
  ProgressBar bar(name, position_among(number + 1, inputs_.size()));
  std::optional<std::uint64_t> whole = input->bytes;
  std::optional<std::size_t> count;
  pipeline::IngestOptions options = options_;
  if (Status own = pipeline::apply_rules_of(store, options); !own) return std::move(own).error();
  apply(command_.rules, options.certify, options.groups);  // what the command line states counts
  options.stages = &stages_;
  options.unnamed = std::filesystem::path(input->name.empty() ? name : input->name).stem().string();
  pipeline::Ingestion ingestion(
      store, &*workers_, options,
      [&](pipeline::FeatureOutcome&& outcome) { return take(number, std::move(outcome), run); },
      [&](std::uint64_t features, std::uint64_t bytes) {
        bar.show(features, share_done(features, count, bytes, whole));
      });
  if (input->kind == files::InputKind::container) {
    if (rejected_) {
      return Error{ErrorCode::unsupported, "--rejected takes documents, no Watertight files"};
    }
    whole.reset();
    const auto bytes = files::read_all(input->source, {});
    if (!bytes) return bytes.error();
    run.summary.add_file_bytes(bytes->size());
    const Status added = ingestion.add_container(*bytes, {}, pipeline::WholeModels::split);
    if (!added) return added.error();
    return ingestion.finish();
  }
  formats::ReadOptions read;
  read.keep_text = options.contract == formats::Contract::exact;
  read.surfaces = options.surfaces;
  read.curved = pipeline::curved_reading(command_.chord);
  const auto header = [&] { return pipeline::collection_header(store, command_.collection); };
  auto opened = files::open_input(*std::move(input), read, header);
  if (!opened) return std::move(opened).error();
  count = opened->reader.feature_count();
  run.header = opened->reader.document().header.str();
  if (!command_.is_quiet && !command_.is_json) tell_losses(name, opened->reader.document());
  if (Status added = ingestion.add(opened->reader); !added) return std::move(added).error();
  run.summary.add_file_bytes(opened->reader.bytes_read());
  auto counts = ingestion.finish();
  if (counts && !command_.is_quiet) tell_twins(name, *counts, ingestion.twins());
  return counts;
}

/// Remembers which features this file stored, and prints which features of earlier files of the run
/// they replaced.
void IngestRun::tell_replaced(std::size_t number, const FileRun& run) {
  const std::string& file = inputs_[number].name;
  for (const std::string& id : run.valid) {
    const auto [known, is_new] = files_.try_emplace(id, number);
    if (is_new) continue;
    const std::string text =
        "feature '" + id + "' replaces the one from '" + inputs_[known->second].name + "'";
    std::fprintf(stderr, "watertight: %s: %s\n", printable(file).c_str(), printable(text).c_str());
    known->second = number;
  }
}

Status IngestRun::open_rejected(bool gives_up_rights) {
  if (command_.rejected.empty()) return Done{};
  const auto wrong = [](std::string text) {
    return Error{ErrorCode::invalid_argument, std::move(text)};
  };
  if (command_.invalid != "skip") return wrong("needs --invalid skip");
  if (command_.rejected == "-") return wrong("needs the name of a file");
  for (const files::InputFile& input : inputs_) {
    for (const std::string& file : {command_.rejected, command_.rejected + ".report.json"}) {
      if (files::is_same_file(file, input.file))
        return wrong("'" + file + "' would replace an input");
    }
  }
  auto files = RejectedFiles::open(command_.rejected, gives_up_rights);
  if (!files) return std::move(files).error();
  rejected_.emplace(*std::move(files));
  return Done{};
}

/// Writes what was left out of a document that is stored.
Status IngestRun::add_rejected(std::size_t number, FileRun run) {
  if (!rejected_) return Done{};
  const auto without_text = rejected_->add(run.header, std::move(run.left_out));
  if (!without_text) return without_text.error();
  if (*without_text == 0) return Done{};
  const std::string text = quantity(*without_text, "feature") +
                           " are left out and in the report only: --rejected writes city models";
  std::fprintf(stderr, "watertight: %s: %s\n", printable(inputs_[number].name).c_str(),
               text.c_str());
  return Done{};
}

void tell_invalid(const std::string& file, const pipeline::IngestCounts& counts) {
  std::string text = "not all features are valid; " + std::to_string(counts.stored) + " of " +
                     std::to_string(counts.total) + " were stored";
  if (counts.unproven_features > 0 && counts.stored > 0) {
    text += ", among them " + quantity(counts.unproven_features, "feature") + " with " +
            quantity(counts.unproven, "solid") + " kept as they came, unproven";
  } else if (counts.stored == 0) {
    text += "; --invalid keep stores all, with what is not proven as it came";
  }
  std::fprintf(stderr, "watertight: %s: %s\n", printable(file).c_str(), text.c_str());
}

Exit IngestRun::run() {
  const auto start = std::chrono::steady_clock::now();
  // As root, opening a private cluster gives up the right to open other users' files.
  const bool gives_up_rights = ::geteuid() == 0 && command_.store.database_url.empty();
  early_ = files::EarlyFiles(inputs_, gives_up_rights);
  if (Status opened = open_rejected(gives_up_rights); !opened) {
    complain("--rejected", opened.error());
    return Exit::error;
  }
  const auto opened = open_store(command_.store);
  if (!opened) {
    complain("store", opened.error());
    return Exit::error;
  }
  workers_.emplace(delaunay::EngineWorkers::Options{{}, {}, command_.jobs});
  Exit exit = Exit::valid;
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    const std::string& file = inputs_[i].name;
    FileRun run;
    const auto counts = ingest(i, *opened->store, run);
    if (!counts) {
      complain(file, counts.error());
      exit = Exit::error;
      continue;
    }
    if (counts->verdict != Verdict::valid) {
      tell_invalid(file, *counts);
    }
    if (counts->stored > 0) tell_replaced(i, run);
    run.summary.add_stored(counts->stored);
    summary_.add(run.summary);
    counts_.add(*counts);
    if (Status added = add_rejected(i, std::move(run)); !added) {
      complain(command_.rejected, added.error());
      return Exit::error;
    }
    exit = worse(exit, exit_of(counts->verdict));
  }
  if (rejected_) {
    if (Status committed = rejected_->commit(counts_); !committed) {
      complain(command_.rejected, committed.error());
      exit = Exit::error;
    }
  }
  summary_.add(stages_);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const std::string text =
      command_.is_json ? summary_.json(seconds) + "\n" : summary_.table(seconds);
  std::fwrite(text.data(), 1, text.size(), stdout);
  return exit;
}

}  // namespace

Exit run(const IngestCommand& command) {
  const auto contract = formats::contract_named(command.contract);
  if (!contract) {
    complain("--contract", contract.error());
    return Exit::error;
  }
  return IngestRun(command, *contract).run();
}

}  // namespace watertight::cli
