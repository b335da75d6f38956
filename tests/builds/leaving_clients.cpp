// SPDX-License-Identifier: GPL-3.0-or-later
//
// Starts a server and lets clients come and go; the program also holds the code that talks to the
// database.
#include <cstdio>
#include <string>
#include <utility>  // Asio uses this header without including it

#include <boost/asio.hpp>

#include "server/transport/listener.h"
#include "store/connection.h"
#include "tests/builds/fingerprint.h"

namespace watertight::builds {
namespace {

using server::HttpServer;
using server::Lane;
using server::Request;
using server::Response;

/// The first line of the answer to GET /, "" if no answer came.
std::string status_line(std::uint16_t port) {
  boost::asio::io_context context;
  boost::asio::ip::tcp::socket socket(context);
  socket.connect({boost::asio::ip::make_address("127.0.0.1"), port});
  const std::string request = "GET / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";
  boost::asio::write(socket, boost::asio::buffer(request));
  std::string answer;
  boost::system::error_code error;
  boost::asio::read_until(socket, boost::asio::dynamic_buffer(answer), "\r\n", error);
  return answer.substr(0, answer.find("\r\n"));
}

bool fail(const std::string& message) {
  std::fprintf(stderr, "%s\n", message.c_str());
  return false;
}

}  // namespace

bool serve_leaving_clients() {
  // This call makes the linker take the database's connections into the program.
  if (store::connection_option("host", "h") != "host='h'") return fail("no libpq options");
  server::ServerOptions options;
  options.port = 0;
  server::Application application;
  application.lane = [](const Request&, std::uint64_t) { return Lane::quick; };
  application.respond = [](const Request&, const CancelPoll&) { return Response{}; };
  auto server = HttpServer::start(options, application, [](const std::string&) {});
  if (!server) return fail(to_string(server.error()));
  for (int i = 0; i < 3; ++i) {
    const std::string line = status_line((*server)->port());
    if (line != "HTTP/1.1 200 OK") return fail("answer " + std::to_string(i) + ": " + line);
  }
  (*server)->stop();
  return true;
}

}  // namespace watertight::builds
