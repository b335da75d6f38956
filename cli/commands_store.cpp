// SPDX-License-Identifier: GPL-3.0-or-later
//
// The commands serve and export.
#include <charconv>
#include <cstdio>

#include "base/quantity.h"
#include "cli/commands.h"
#include "cli/files.h"
#include "cli/inputs.h"
#include "cli/opened_store.h"
#include "pipeline/export.h"
#include "server/serve.h"

namespace watertight::cli {
namespace {

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
      is_container ? pipeline::ExportFormat::container : pipeline::ExportFormat::sequence, {},
      pipeline::SolidLayout::pages,
      command.is_proven_only ? pipeline::ExportScope::proven : pipeline::ExportScope::all);
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
