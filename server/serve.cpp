// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/serve.h"

#include <pthread.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <thread>

namespace watertight::server {
namespace {

/// The signals that stop the service, to be waited for.
sigset_t stop_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  return signals;
}

std::shared_ptr<spdlog::logger> make_logger() {
  auto logger = std::make_shared<spdlog::logger>("watertight",
                                                 std::make_shared<spdlog::sinks::stderr_sink_mt>());
  logger->set_pattern("time=%Y-%m-%dT%H:%M:%S.%e%z level=%l %v");
  logger->flush_on(spdlog::level::info);
  return logger;
}

std::string url_of(const ServerOptions& options, std::uint16_t port) {
  const bool is_v6 = options.address.find(':') != std::string::npos;
  return "http://" + (is_v6 ? "[" + options.address + "]" : options.address) + ":" +
         std::to_string(port);
}

}  // namespace

void hold_stop_signals() {
  const sigset_t signals = stop_signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
}

Status serve(const ServeOptions& options) {
  std::signal(SIGPIPE, SIG_IGN);
  hold_stop_signals();
  auto store = store::open_postgres_store(options.connection, options.database_connections);
  if (!store) return std::move(store).error();
  delaunay::EngineWorkers workers;
  Service service{store->get(), &workers, {}};
  service.options.limits = options.limits;
  const auto logger = make_logger();
  auto server = HttpServer::start(options.server, make_application(service),
                                  [logger](const std::string& line) { logger->info(line); });
  if (!server) return std::move(server).error();

  const std::string url = url_of(options.server, (*server)->port());
  std::printf("listening on %s\n", url.c_str());
  std::fflush(stdout);
  logger->info("event=listening url=" + url);
  const sigset_t signals = stop_signals();
  int signal = 0;
  sigwait(&signals, &signal);
  logger->info("event=stopping signal=" + std::to_string(signal));
  (*server)->stop();
  logger->info("event=stopped");
  return Done{};
}

}  // namespace watertight::server
