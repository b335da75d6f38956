// SPDX-License-Identifier: GPL-3.0-or-later
//
// The commands serve, which runs the service, and key, which makes keys for its clients.
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "base/ascii.h"
#include "cli/commands.h"
#include "cli/opened_store.h"
#include "cli/terminal/printable.h"
#include "files/files.h"
#include "files/inputs.h"
#include "server/access/keys.h"
#include "server/features/cors.h"
#include "server/features/links.h"
#include "server/serve.h"

namespace watertight::cli {
namespace {

/// The characters that the name of a field may have.
constexpr std::string_view kFieldLetters =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";

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

/// Reads the origin whose pages may read; "" for none.
Status read_origin(const std::string& origin, server::ServeOptions& options) {
  options.cors_origin = origin;
  return origin.empty() ? Status(Done{}) : server::check_origin(origin);
}

/// Reads the start of links; "" leaves it to the requests.
Status read_base_url(std::string url, server::ServeOptions& options) {
  if (url.empty()) return Done{};
  if (Status checked = server::check_base_url(url); !checked) return checked;
  while (url.ends_with('/')) url.pop_back();
  options.base_url = std::move(url);
  return Done{};
}

/// Reads the certificate and its key, while the program has the right to.
Status read_tls(const ServeCommand& command, server::ServerOptions& options) {
  if (command.tls_certificate.empty()) return Done{};
  if (command.tls_key.empty()) {
    return Error{ErrorCode::invalid_argument, "a certificate needs its key (--tls-key)"};
  }
  for (const auto& [file, text] : {std::pair(&command.tls_certificate, &options.tls_certificate),
                                   std::pair(&command.tls_key, &options.tls_key)}) {
    const auto bytes = files::read_file(*file, Limits{});
    if (!bytes) return Error{bytes.error().code, *file + ": " + bytes.error().message};
    *text = as_text(*bytes);
  }
  return server::check_tls(options.tls_certificate, options.tls_key);
}

/// Reads the name of the field that names users; "" for none.
Status read_user_field(const std::string& name, server::ServeOptions& options) {
  options.user_field = lower_case(name);
  if (name.find_first_not_of(kFieldLetters) == std::string::npos) return Done{};
  return Error{ErrorCode::invalid_argument,
               "is the name of a field of requests: letters, digits, - and _"};
}

/// Reads the address of the clients, which is one that other machines do not reach unless keys are
/// asked for, or nobody who reaches it is a stranger.
Status read_address(const ServeCommand& command, server::ServerOptions& options) {
  const Status read = read_listen(command.listen, options);
  if (!read || !command.keys_file.empty() || command.is_open || is_loopback(options.address)) {
    return read;
  }
  return Error{ErrorCode::invalid_argument,
               "at " + options.address +
                   " other machines could change everything: name a file of keys (--keys FILE, "
                   "which 'watertight key' makes), or give --open (in a container "
                   "WATERTIGHT_OPEN=1) if nobody else reaches it"};
}

/// An option that is not right, and why.
struct WrongOption {
  const char* name;
  Error error;
};

std::optional<WrongOption> read_options(const ServeCommand& command,
                                        server::ServeOptions& options) {
  options.keys_file = command.keys_file;
  options.reading_is_public = command.reading_is_public;
  options.jobs_folder = command.jobs_folder;
  options.requires_preconditions = command.requires_preconditions;
  const auto wrong = [](const char* name, const Status& status) {
    return WrongOption{name, status.error()};
  };
  if (Status read = read_address(command, options.server); !read) return wrong("--listen", read);
  if (Status read = read_user_field(command.user_field, options); !read) {
    return wrong("--user-field", read);
  }
  if (Status read = read_base_url(command.base_url, options); !read) {
    return wrong("--base-url", read);
  }
  if (Status read = read_origin(command.cors, options); !read) return wrong("--cors", read);
  limit_addresses(command, options.server);
  if (Status read = read_tls(command, options.server); !read) {
    return wrong("--tls-certificate", read);
  }
  if (command.probes.empty()) return std::nullopt;
  const Status read = read_listen(command.probes, options.probes.emplace());
  return read ? std::optional<WrongOption>() : wrong("--probes", read);
}

}  // namespace

Exit run(const ServeCommand& command) {
  server::ServeOptions options;
  if (const auto wrong = read_options(command, options)) {
    complain(wrong->name, wrong->error);
    return Exit::error;
  }
  const auto end_with = [](const std::string& what, const Error& error) {
    complain(what, error);
    // A service that was stopped before it listened has done what it was told.
    return error.code == ErrorCode::cancelled ? Exit::valid : Exit::error;
  };
  if (const Status given_up = give_up_rights(command.store); !given_up) {
    return end_with("store", given_up.error());
  }
  server::StopSignals signals;
  auto opened = open_database(command.store, signals);
  if (!opened) return end_with("store", opened.error());
  options.connection = opened->connection;
  if (opened->cluster) {
    if (options.jobs_folder.empty()) options.jobs_folder = opened->data_directory + "/jobs";
    options.database_health = [&opened] { return opened->cluster->health(); };
  }
  const Status served = server::serve(options, signals);
  return served ? Exit::valid : end_with("serve", served.error());
}

Exit run(const KeyCommand& command) {
  // The file is read first, so that no key is added to a file that is none of keys.
  std::string text;
  if (std::filesystem::exists(command.file)) {
    const auto bytes = files::read_file(command.file, Limits{});
    if (!bytes) return fail(command.file, bytes.error());
    text = as_text(*bytes);
  }
  const auto keys = server::read_keys(text);
  if (!keys) return fail(command.file, keys.error());
  for (const server::AccessKey& key : *keys) {
    if (key.name != command.name) continue;
    return fail(command.file, {ErrorCode::conflict, "there is a key with the name '" + key.name +
                                                        "'; delete its line to take it back"});
  }
  const auto made = server::make_key(command.name, *server::scope_named(command.scope));
  if (!made) return fail(command.file, made.error());
  std::ofstream file(command.file, std::ios::binary | std::ios::app);
  if (!text.empty() && !text.ends_with('\n')) file << '\n';
  file << made->line << '\n';
  file.close();
  if (!file) return fail(command.file, {ErrorCode::unavailable, "the file cannot be written"});
  std::printf("%s\n", made->key.c_str());
  return Exit::valid;
}

}  // namespace watertight::cli
