// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <sstream>

#include "cli/arguments/arguments.h"

namespace watertight::cli {
namespace {

/// The options of a command as text for --config. Those that are not given are comments, since an
/// empty one would count as given.
std::string options_file(const CLI::App& command) {
  std::istringstream lines(command.config_to_str(true, true));
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    const bool is_given = !line.ends_with("=\"\"") && !line.ends_with("=false");
    if (!is_given) text += "# ";
    text.append(line) += '\n';
  }
  return text;
}

}  // namespace

void add_store(CLI::App& app, StoreChoice& store) {
  auto* data = app.add_option("--data-dir,--data", store.data_directory,
                              "directory of a private PostgreSQL cluster, made when missing");
  auto* url = app.add_option("--database-url", store.database_url,
                             "any PostgreSQL database (URL or libpq connection string)")
                  ->envname("WATERTIGHT_DATABASE_URL");
  data->excludes(url);
}

void require_store(const StoreChoice& store) {
  if (!store.data_directory.empty() || !store.database_url.empty()) return;
  throw CLI::ValidationError("--data-dir DIR or --database-url URL is required");
}

void add_serve(CLI::App& app, ServeCommand& command, Chosen& chosen) {
  CLI::App* sub = app.add_subcommand("serve", "Run the HTTP service until SIGTERM or SIGINT");
  add_store(*sub, command.store);
  sub->add_option("--listen", command.listen, "ADDRESS:PORT")->capture_default_str();
  sub->add_option(
      "--probes", command.probes,
      "ADDRESS:PORT that answers /healthz, /readyz and /metrics only, whatever the clients do");
  auto* certificate =
      sub->add_option("--tls-certificate", command.tls_certificate,
                      "file with the certificate, and those above it, as PEM: clients speak HTTPS")
          ->envname("WATERTIGHT_TLS_CERTIFICATE");
  sub->add_option("--tls-key", command.tls_key, "file with the key of the certificate, as PEM")
      ->needs(certificate)
      ->envname("WATERTIGHT_TLS_KEY");
  auto* keys = sub->add_option("--keys", command.keys_file,
                               "file of access keys, made by 'watertight key'; read again when it "
                               "changes")
                   ->envname("WATERTIGHT_KEYS");
  sub->add_flag("--public-read", command.reading_is_public, "with --keys: reading needs no key")
      ->needs(keys)
      ->envname("WATERTIGHT_PUBLIC_READ");
  sub->add_option(
         "--user-field", command.user_field,
         "with --keys: the field in which a proxy that adds a key names the user, for the log")
      ->needs(keys);
  sub->add_flag("--open", command.is_open,
                "needed to listen on an address of a network without --keys: who reaches it may "
                "change everything")
      ->excludes(keys)
      ->envname("WATERTIGHT_OPEN");
  sub->add_option("--connections-per-address", command.connections_per_address,
                  "the most connections of one client's address; 0 for no limit (default: 128, and "
                  "no limit on a loopback address, where a proxy may speak for many)");
  sub->add_option("--cors", command.cors,
                  "the origin whose web pages may read answers, or * for all; none without it");
  sub->add_option("--base-url", command.base_url,
                  "the address under which clients reach the service, for links; without it, that "
                  "of each request");
  sub->add_option("--jobs-dir", command.jobs_folder,
                  "folder for the files of jobs (default: 'jobs' in --data-dir; no jobs without)")
      ->envname("WATERTIGHT_JOBS_DIR");
  sub->add_flag("--require-preconditions", command.requires_preconditions,
                "refuse writes of features without If-Match or If-None-Match");
  sub->add_flag("--print-config", command.prints_options,
                "print all options as a file for --config, and end")
      ->configurable(false);
  sub->fallthrough();  // --config may stand behind the command
  sub->callback([&, sub] {
    if (command.prints_options) {
      chosen = [sub] {
        std::printf("[serve]\n%s", options_file(*sub).c_str());
        return Exit::valid;
      };
      return;
    }
    require_store(command.store);
    chosen = [&] { return run(command); };
  });
}

void add_key(CLI::App& app, KeyCommand& command, Chosen& chosen) {
  CLI::App* sub = app.add_subcommand("key", "Make an access key for clients of the service");
  sub->add_option("NAME", command.name, "who will use it, for the log")->required();
  sub->add_option("--scope", command.scope,
                  "read; write (also change features); admin (also change collections)")
      ->required()
      ->check(CLI::IsMember({"read", "write", "admin"}));
  sub->add_option("--keys", command.file, "file of keys to which its digest is added")
      ->required()
      ->envname("WATERTIGHT_KEYS");
  sub->callback([&] { chosen = [&] { return run(command); }; });
}

}  // namespace watertight::cli
