// SPDX-License-Identifier: GPL-3.0-or-later
//
// Runs the service until SIGTERM or SIGINT: store, engines, routes and listener together.
#pragma once

#include <string>

#include "server/routes.h"
#include "server/transport/listener.h"

namespace watertight::server {

struct ServeOptions {
  ServerOptions server;
  std::string connection;  // libpq connection string or URL of the database
  std::size_t database_connections = 8;
  Limits limits;
};

/// Blocks SIGTERM and SIGINT in this thread and those that it starts later, so that serve() can
/// wait for the signals. For callers that start threads before serve(); a signal that comes in
/// between stops serve() at once, gracefully.
void hold_stop_signals();

/// Runs the service and blocks until it has stopped gracefully. Prints "listening on
/// http://ADDRESS:PORT" on standard output when requests are taken, and log lines on standard
/// error. Errors: unavailable (database, address), invalid_argument. Requires that no other thread
/// takes SIGTERM and SIGINT: see hold_stop_signals().
Status serve(const ServeOptions& options);

}  // namespace watertight::server
