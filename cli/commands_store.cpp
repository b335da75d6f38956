// SPDX-License-Identifier: GPL-3.0-or-later
//
// The commands serve, ingest and export, which use a store.
#include <charconv>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <map>

#include "base/quantity.h"
#include "cli/commands.h"
#include "cli/files.h"
#include "cli/inputs.h"
#include "cli/printable.h"
#include "cli/progress.h"
#include "pipeline/export.h"
#include "pipeline/outcome_json.h"
#include "server/serve.h"
#include "store/private_cluster.h"

namespace watertight::cli {
namespace {

/// A database, with the private cluster behind it if there is one.
struct OpenedDatabase {
  std::unique_ptr<store::PrivateCluster> cluster;
  std::string connection;
};

std::string directory_of(const StoreChoice& choice) {
  std::error_code error;
  return std::filesystem::absolute(choice.data_directory, error).string();
}

/// Gives up the rights that only root has, and those that the program never needs. To be called
/// before the first thread starts.
Status give_up_rights(const StoreChoice& choice) {
  if (choice.database_url.empty()) {
    if (Status dropped = store::drop_root_privileges(directory_of(choice)); !dropped)
      return dropped;
  }
  return store::forbid_new_privileges();
}

Result<OpenedDatabase> open_database(const StoreChoice& choice,
                                     const server::StopSignals& signals) {
  OpenedDatabase opened;
  if (!choice.database_url.empty()) {
    opened.connection = choice.database_url;
    return opened;
  }
  store::ClusterOptions options;
  options.data_directory = directory_of(choice);
  options.is_cancelled = [&signals] { return signals.is_requested(); };
  options.tell = [](const std::string& sentence) {
    server::write_unless_full("watertight: store: " + printable(sentence) + "\n");
  };
  auto cluster = store::PrivateCluster::start(options);
  if (!cluster) return std::move(cluster).error();
  opened.connection = (*cluster)->connection();
  opened.cluster = *std::move(cluster);
  return opened;
}

/// A store for a command that ends by itself. The cluster must outlive the store.
struct OpenedStore {
  std::unique_ptr<store::PrivateCluster> cluster;
  std::unique_ptr<SolidStore> store;
};

Result<OpenedStore> open_store(const StoreChoice& choice) {
  if (Status given_up = give_up_rights(choice); !given_up) return std::move(given_up).error();
  const server::StopSignals signals;
  auto database = open_database(choice, signals);
  if (!database) return std::move(database).error();
  auto store = store::open_postgres_store(database->connection, 4,
                                          [&signals] { return signals.is_requested(); });
  if (signals.is_requested()) return Error{ErrorCode::cancelled, "stopped before the work began"};
  if (!store) return std::move(store).error();
  return OpenedStore{std::move(database->cluster), *std::move(store)};
}

bool is_loopback(const std::string& address) {
  return address.starts_with("127.") || address == "::1";
}

/// The limits of one client's address: four connections for each request that it has in work.
void limit_addresses(const ServeCommand& command, server::ServerOptions& options) {
  constexpr std::size_t kUsual = 128;
  options.connections_per_address =
      command.connections_per_address.value_or(is_loopback(options.address) ? 0 : kUsual);
  options.works_per_address = (options.connections_per_address + 3) / 4;
}

/// Reads "127.0.0.1:8080", "[::1]:8080" or ":8080".
Status read_listen(const std::string& text, server::ServerOptions& options) {
  const Error wrong{ErrorCode::invalid_argument,
                    "'" + text + "' is not ADDRESS:PORT (example: 127.0.0.1:8080)"};
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos) return wrong;
  std::string address = text.substr(0, colon);
  if (address.starts_with('[') && address.ends_with(']')) {
    address = address.substr(1, address.size() - 2);
  }
  if (!address.empty()) options.address = address;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data() + colon + 1, end, options.port);
  return error == std::errc{} && rest == end ? Status(Done{}) : Status(wrong);
}

/// The file of each feature that this run has stored, by the feature's id.
using FilesOfFeatures = std::map<std::string, std::string>;

/// Names features without ids after their file: house, house-2, ... Errors: conflict if another
/// file of this run has given that name already, as such features would replace each other.
Status name_features(Document& document, const std::string& file, const FilesOfFeatures& files) {
  const std::string stem = std::filesystem::path(file).stem().string();
  std::size_t unnamed = 0;
  for (Feature& feature : document.features) {
    if (!feature.id.empty()) continue;
    feature.id = ++unnamed == 1 ? stem : stem + '-' + std::to_string(unnamed);
    const auto other = files.find(feature.id);
    if (other == files.end()) continue;
    return Error{ErrorCode::conflict, "its features have no ids and would be called '" +
                                          feature.id + "', as one of '" + other->second + "' is"};
  }
  return Done{};
}

/// Remembers which features this file stored, and prints which features of earlier files of the run
/// they replaced.
void tell_replaced(const pipeline::IngestOutcome& outcome, const std::string& file,
                   FilesOfFeatures& files) {
  for (const pipeline::FeatureOutcome& feature : outcome.features) {
    if (!feature.is_stored) continue;
    const auto [known, is_new] = files.try_emplace(feature.id, file);
    if (is_new) continue;
    const std::string text =
        "feature '" + feature.id + "' replaces the one from '" + known->second + "'";
    std::fprintf(stderr, "watertight: %s: %s\n", printable(file).c_str(), printable(text).c_str());
    known->second = file;
  }
}

/// The document of a file, with names for features that have none.
Result<Document> read_named(const std::string& file, const Bytes& bytes, formats::Contract contract,
                            const FilesOfFeatures& files) {
  formats::ReadOptions options;
  options.keep_text = contract == formats::Contract::exact;
  auto input = load_input(file, bytes, options);
  if (!input) return std::move(input).error();
  if (Status named = name_features(input->document, file, files); !named) return named.error();
  return std::move(input->document);
}

pipeline::IngestOptions ingest_options(const IngestCommand& command, formats::Contract contract) {
  pipeline::IngestOptions options;
  options.collection = command.collection;
  options.threads = command.jobs;
  options.contract = contract;
  options.invalid_features = command.invalid == "skip" ? pipeline::InvalidFeatures::skip
                                                       : pipeline::InvalidFeatures::refuse_document;
  return options;
}

Result<pipeline::IngestOutcome> ingest_file(const std::string& file, Result<Document> document,
                                            SolidStore& store, delaunay::EngineWorkers& workers,
                                            pipeline::IngestOptions options) {
  if (!document) return std::move(document).error();
  ProgressBar bar(file);
  options.progress = [&bar](std::size_t done, std::size_t total) {
    bar.show(done, static_cast<double>(done) / static_cast<double>(total));
  };
  return pipeline::ingest(*std::move(document), store, &workers, options);
}

Result<Bytes> read_and_close(Result<OpenedFile> file) {
  if (!file) return file.error();
  return read_all(file->source, {});
}

}  // namespace

Exit run(const ServeCommand& command) {
  server::ServeOptions options;
  const Status status = read_listen(command.listen, options.server);
  if (!status) {
    complain("--listen", status.error());
    return Exit::error;
  }
  const auto fail = [](const std::string& what, const Error& error) {
    complain(what, error);
    // A service that was stopped before it listened has done what it was told.
    return error.code == ErrorCode::cancelled ? Exit::valid : Exit::error;
  };
  limit_addresses(command, options.server);
  options.requires_preconditions = command.requires_preconditions;
  if (!command.probes.empty()) {
    const Status read = read_listen(command.probes, options.probes.emplace());
    if (!read) {
      complain("--probes", read.error());
      return Exit::error;
    }
  }
  if (const Status given_up = give_up_rights(command.store); !given_up) {
    return fail("store", given_up.error());
  }
  server::StopSignals signals;
  auto opened = open_database(command.store, signals);
  if (!opened) return fail("store", opened.error());
  options.connection = opened->connection;
  if (opened->cluster) {
    options.database_health = [&opened] { return opened->cluster->health(); };
  }
  const Status served = server::serve(options, signals);
  return served ? Exit::valid : fail("serve", served.error());
}

Exit run(const IngestCommand& command) {
  const auto start = std::chrono::steady_clock::now();
  const auto contract = formats::contract_named(command.contract);
  if (!contract) {
    complain("--contract", contract.error());
    return Exit::error;
  }
  const pipeline::IngestOptions options = ingest_options(command, *contract);
  // The files are opened before the store: as root, opening the store gives up the right to open
  // other users' files.
  auto opened_files = open_files(command.files);
  const auto opened = open_store(command.store);
  if (!opened) {
    complain("store", opened.error());
    return Exit::error;
  }
  delaunay::EngineWorkers workers(delaunay::EngineWorkers::Options{{}, {}, command.jobs});
  Summary summary;
  FilesOfFeatures files;
  Exit exit = Exit::valid;
  for (std::size_t i = 0; i < command.files.size(); ++i) {
    const std::string& file = command.files[i];
    const auto bytes = read_and_close(std::move(opened_files[i]));
    auto document = bytes ? read_named(file, *bytes, *contract, files) : bytes.error();
    const auto outcome = ingest_file(file, std::move(document), *opened->store, workers, options);
    if (!outcome) {
      complain(file, outcome.error());
      exit = Exit::error;
      continue;
    }
    if (!command.is_quiet && !command.is_json) print_findings(file, *outcome);
    if (outcome->verdict != Verdict::valid) {
      std::fprintf(stderr, "watertight: %s: not all features are valid; %zu of %zu were stored\n",
                   printable(file).c_str(), outcome->stored, outcome->features.size());
    }
    tell_replaced(*outcome, file, files);
    summary.add(*outcome, bytes->size());
    exit = worse(exit, exit_of(outcome->verdict));
  }
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const std::string text = command.is_json ? summary.json(seconds) + "\n" : summary.table(seconds);
  std::fwrite(text.data(), 1, text.size(), stdout);
  return exit;
}

Exit run(const ExportCommand& command) {
  const auto fail = [](const std::string& what, const Error& error) {
    complain(what, error);
    return Exit::error;
  };
  const bool is_container = command.output == "-" || command.output.ends_with(".wt");
  if (!is_container) {
    const auto format = format_of_name(command.output);
    if (!format || *format != Format::city_json_seq) {
      return fail(command.output,
                  {ErrorCode::unsupported,
                   "export writes Watertight files (.wt) and CityJSONSeq (.jsonl)"});
    }
  }
  const auto opened = open_store(command.store);
  if (!opened) return fail("store", opened.error());
  auto exporting = pipeline::CollectionExport::start(
      *opened->store, command.collection,
      is_container ? pipeline::ExportFormat::container : pipeline::ExportFormat::sequence);
  if (!exporting) return fail(command.collection, exporting.error());
  const std::string output = command.output == "-" ? "standard output" : command.output;
  auto writer = FileWriter::open(command.output);
  if (!writer) return fail(output, writer.error());
  for (;;) {
    const auto bytes = exporting->next();
    if (!bytes) return fail(command.collection, bytes.error());
    if (bytes->empty()) break;
    const Status written = writer->write(as_text(*bytes));
    if (!written) return fail(output, written.error());
  }
  const Status status = writer->commit();
  if (!status) return fail(output, status.error());
  std::fprintf(stderr, "watertight: %s with %s written\n",
               quantity(exporting->exported().features, "feature").c_str(),
               quantity(exporting->exported().solids, "solid").c_str());
  return Exit::valid;
}

}  // namespace watertight::cli
