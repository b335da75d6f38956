// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "server/access/gate.h"
#include "server/access/keys.h"
#include "tests/unit/server/client.h"
#include "tests/unit/server/routes_fixture.h"

namespace watertight::test_access {
namespace {

using server::Gate;
using server::Request;
using server::Scope;

/// A folder with a file of keys, one of each scope.
class Keys {
 public:
  Keys() {
    std::string name = (std::filesystem::temp_directory_path() / "watertight-keys-XXXXXX").string();
    REQUIRE(::mkdtemp(name.data()) != nullptr);
    path = name + "/keys";
    std::string text = "# keys of the test\n\n";
    for (const Scope scope : {Scope::read, Scope::write, Scope::admin}) {
      const auto made = server::make_key(server::to_string(scope), scope);
      REQUIRE(made);
      text += made->line + "\n";
      keys.push_back(made->key);
    }
    write(text);
  }
  ~Keys() { std::filesystem::remove_all(std::filesystem::path(path).parent_path()); }
  Keys(const Keys&) = delete;
  Keys& operator=(const Keys&) = delete;
  void write(const std::string& text) const {
    std::ofstream(path, std::ios::binary) << text;
    // A time of its own, whatever the file system's resolution.
    static int changes = 0;
    std::filesystem::last_write_time(
        path, std::filesystem::file_time_type::clock::now() + std::chrono::seconds(++changes));
  }
  std::unique_ptr<Gate> gate(Scope without_key = Scope::none) const {
    auto opened = Gate::open(path, without_key);
    REQUIRE(opened);
    return *std::move(opened);
  }

  std::string path;
  std::vector<std::string> keys;
};

Request asking(const std::string& method, const std::string& target,
               const std::string& authorization = "") {
  Request request{method, target, {{"content-type", "application/json"}}, ""};
  if (!authorization.empty()) request.headers.push_back({"authorization", authorization});
  return request;
}

unsigned status_of(const Gate& gate, const Request& request) {
  server::Service service;
  service.gate = &gate;
  const server::Admission admission = server::admit(service, request);
  return admission.refusal ? admission.refusal->status : 200;
}

TEST_CASE("each route needs the scope of what it does") {
  const Keys keys;
  const auto gate = keys.gate();
  // `wanted`: without key, with that of read, write, admin.
  const auto check = [&](const std::string& method, const std::string& target,
                         std::vector<unsigned> wanted) {
    INFO(method << ' ' << target);
    std::vector<unsigned> got{status_of(*gate, asking(method, target))};
    for (const std::string& key : keys.keys) {
      got.push_back(status_of(*gate, asking(method, target, "Bearer " + key)));
    }
    CHECK(got == wanted);
  };
  check("GET", "/healthz", {200, 200, 200, 200});
  check("HEAD", "/readyz", {200, 200, 200, 200});
  check("OPTIONS", "/collections/a/items", {200, 200, 200, 200});
  check("GET", "/", {401, 200, 200, 200});
  check("HEAD", "/collections/a/items?limit=3", {401, 200, 200, 200});
  check("POST", "/validate", {401, 200, 200, 200});
  check("POST", "/collections/a/items", {401, 403, 200, 200});
  check("DELETE", "/collections/a/items/b%2Fc", {401, 403, 200, 200});
  check("PUT", "/collections/a/attributes", {401, 403, 200, 200});
  check("PATCH", "/collections/a", {401, 403, 403, 200});
  check("DELETE", "/collections/a", {401, 403, 403, 200});
  check("GET", "/no/such/path", {401, 200, 200, 200});
  check("DELETE", "/validate", {401, 200, 200, 200});
  check("GET", "/%zz", {401, 200, 200, 200});
}

TEST_CASE("every route but the probes needs a key, and every change more than to read") {
  for (const server::Route& route : server::routes()) {
    INFO(route.method << ' ' << route.path);
    // Programs and style of the pages are the same for everyone.
    const bool is_probe =
        route.path == "/healthz" || route.path == "/readyz" || route.path == "/web/{file}";
    CHECK((route.scope == Scope::none) == is_probe);
    const std::set<std::string_view> computing{"/validate", "/convert", "/tessellate",
                                               "/repair",   "/encode",  "/decode"};
    const bool changes = route.method != "GET" && !computing.contains(route.path);
    CHECK((route.scope >= Scope::write) == changes);
  }
}

TEST_CASE("a key comes as bearer or as the password of any user") {
  const Keys keys;
  const auto gate = keys.gate();
  const auto status = [&](const std::string& authorization) {
    return status_of(*gate, asking("GET", "/", authorization));
  };
  const std::string& key = keys.keys[0];
  CHECK(status("Bearer " + key) == 200);
  CHECK(status("bEARER   " + key) == 200);
  CHECK(status("Basic dXNlcjo=") == 401);  // "user:"
  CHECK(status("Basic dXNlcg==") == 401);  // "user"
  CHECK(status("Basic ====") == 401);
  CHECK(status("Basic !") == 401);
  CHECK(status("Basic") == 401);
  CHECK(status("Bearer") == 401);
  CHECK(status("Bearer " + key + "x") == 401);
  CHECK(status("Digest " + key) == 401);
  CHECK(status(std::string(300, ' ')) == 401);
  keys.write("basic read " + server::digest_of_key("a password: of Öz"));
  CHECK(*gate->refresh());
  CHECK(status("Basic OmEgcGFzc3dvcmQ6IG9mIMOWeg==") == 200);      // ""
  CHECK(status("Basic cXFxOmEgcGFzc3dvcmQ6IG9mIMOWeg==") == 200);  // "qqq"
}

TEST_CASE("reading can be public, but a wrong key is never taken for none") {
  const Keys keys;
  const auto gate = keys.gate(Scope::read);
  CHECK(status_of(*gate, asking("GET", "/")) == 200);
  CHECK(status_of(*gate, asking("POST", "/collections/a/items")) == 401);
  CHECK(status_of(*gate, asking("GET", "/", "Bearer wt_wrong")) == 401);
  CHECK(status_of(*gate, asking("GET", "/", "Bearer " + keys.keys[0])) == 200);
}

TEST_CASE("a refusal says how to come in, to web maps too") {
  const Keys keys;
  const auto gate = keys.gate();
  server::Service service;
  service.gate = gate.get();
  service.options.cors_origin = "*";
  Request request = asking("GET", "/");
  request.headers.push_back({"origin", "https://maps.example.org"});
  const server::Admission admission = server::admit(service, request);
  REQUIRE(admission.refusal);
  CHECK(samples::problem_of(*admission.refusal)["type"] == "urn:watertight:problem:unauthorized");
  CHECK(*samples::header_of(*admission.refusal, "WWW-Authenticate") ==
        "Bearer realm=\"watertight\"");
  CHECK(*samples::header_of(*admission.refusal, "Access-Control-Allow-Origin") == "*");
}

TEST_CASE("a proxy names its user, who counts only beside a key") {
  const Keys keys;
  const auto gate = keys.gate(Scope::read);
  server::Service service;
  service.gate = gate.get();
  const auto user_of = [&](const std::string& authorization) {
    Request request = asking("GET", "/", authorization);
    request.headers.push_back({"x-forwarded-user", std::string(300, 'a')});
    return server::admit(service, request).user;
  };
  CHECK(user_of("Bearer " + keys.keys[0]).empty());
  service.options.user_field = "x-forwarded-user";
  CHECK(user_of("Bearer " + keys.keys[0]) == std::string(256, 'a'));
  CHECK(user_of("Bearer wt_wrong").empty());
  CHECK(user_of("").empty());
}

TEST_CASE("keys that change count at once, and a wrong file changes nothing") {
  const Keys keys;
  const auto gate = keys.gate();
  const Request request = asking("GET", "/", "Bearer " + keys.keys[0]);
  CHECK(!*gate->refresh());
  keys.write("other read " + std::string(64, '0') + "\n");
  CHECK(*gate->refresh());
  CHECK(status_of(*gate, request) == 401);
  keys.write("first read " + server::digest_of_key(keys.keys[0]));
  CHECK(*gate->refresh());
  CHECK(status_of(*gate, request) == 200);
  keys.write("first nothing 0\n");
  const auto wrong = gate->refresh();
  REQUIRE(!wrong);
  CHECK(wrong.error().message == "line 1: the scope of a key is read, write or admin");
  CHECK(!*gate->refresh());  // is said once
  CHECK(status_of(*gate, request) == 200);
  std::filesystem::remove(keys.path);
  CHECK(!*gate->refresh());
  CHECK(status_of(*gate, request) == 200);
}

TEST_CASE("a file of keys is read strictly") {
  const auto error = [](const std::string& text) {
    const auto keys = server::read_keys(text);
    return keys ? "" : keys.error().message;
  };
  const std::string digest(64, 'a');
  CHECK(error("") == "");
  CHECK(error("# only words\n \t\r\n") == "");
  CHECK(error("a read " + digest + "\r\nb\twrite  " + std::string(64, 'F')) == "");
  CHECK(error("a read") == "line 1: a key is NAME SCOPE DIGEST");
  CHECK(error("\na read " + digest + " more") == "line 2: a key is NAME SCOPE DIGEST");
  CHECK(error("a none " + digest).find("the scope of a key") != std::string::npos);
  CHECK(error("a read " + digest + "0").find("64 hexadecimal") != std::string::npos);
  CHECK(error("a read " + std::string(64, 'g')).find("64 hexadecimal") != std::string::npos);
  CHECK(error("\x01 read " + digest).find("the name of a key") != std::string::npos);
  std::string many;
  for (int i = 0; i < 10'001; ++i) many += "a read " + digest + "\n";
  CHECK(error(many) == "there are more than 10000 keys");
  CHECK(!Gate::open("/nowhere/at/all", Scope::none));
}

TEST_CASE("keys are random, and their digest is SHA-256") {
  // The example of FIPS 180-4.
  CHECK(server::digest_of_key("abc") ==
        "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  std::set<std::string> keys;
  for (int i = 0; i < 100; ++i) keys.insert(server::make_key("a", Scope::read)->key);
  CHECK(keys.size() == 100);
  CHECK(keys.begin()->size() == 67);
  CHECK(!server::make_key("", Scope::read));
  CHECK(!server::make_key("a b", Scope::read));
}

TEST_CASE("a request without right is refused before its body comes") {
  server::Application application;
  application.lane = [](const Request&, std::uint64_t) { return server::Lane::quick; };
  application.respond = [](const Request&, const CancelPoll&) {
    return server::Response{200, "text/plain", "done", {}};
  };
  application.admit = [](const Request& request) -> server::Admission {
    server::Admission admission{"somebody", std::nullopt};
    admission.user = "ada";
    if (request.header("authorization") != nullptr) return admission;
    return {"", server::refuse(401, "unauthorized", "no key")};
  };
  std::string log;
  server::ServerOptions options;
  options.port = 0;
  auto server = server::HttpServer::start(options, application,
                                          [&log](const std::string& line) { log += line + "\n"; });
  REQUIRE(server);
  {
    const Client client((*server)->port());
    client.send(
        "POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1000\r\n"
        "Expect: 100-continue\r\n\r\n");
    CHECK(client.receive_answer().starts_with("HTTP/1.1 401 "));
  }
  {
    const Client client((*server)->port());
    client.send("GET / HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer x\r\n\r\n");
    CHECK(client.receive_answer().starts_with("HTTP/1.1 200 "));
    client.send("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n");
    CHECK(client.receive_answer().starts_with("HTTP/1.1 401 "));
  }
  (*server)->stop();
  // How long it took depends on the machine.
  CHECK(std::regex_search(log,
                          std::regex(R"(status=200 bytes=4 ms=[0-9]+ key="somebody" user="ada")")));
  CHECK(log.find("somebody", log.find("somebody") + 1) == std::string::npos);
}

}  // namespace
}  // namespace watertight::test_access
