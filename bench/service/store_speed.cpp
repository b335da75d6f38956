// SPDX-License-Identifier: GPL-3.0-or-later
//
// Measures calls of the store in any PostgreSQL database (libpq connection string):
//
//     store_speed CONNECTION [SECONDS [puts|reads]]
//
// Writes boxes to new collections "speed-..." and reads them. Prints calls and features a second,
// and the processor time of this process for each call; the server's time is not in it.
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <functional>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "store/solid_store.h"

using namespace watertight;

namespace {

using Clock = std::chrono::steady_clock;

constexpr int kKept = 20'000;  // the features of the collection that is read

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double processor_seconds() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

/// A building of one solid, of about the bytes of an ingested box.
StoredFeature box(const std::string& collection, int number) {
  StoredFeature feature;
  feature.collection = collection;
  feature.id = "box-" + std::to_string(number);
  feature.type = "Building";
  feature.format = "city_json";
  feature.srid = 7415;
  feature.header = std::string(
      R"({"type":"CityJSON","version":"2.0","transform":{"scale":[0.001,0.001,0.001],"translate":[85000.0,446000.0,0.0]}})");
  feature.skeleton.bytes.assign(180, static_cast<std::uint8_t>(number));
  const double x = 85'000 + 20.0 * (number % 1000);
  const double y = 446'000 + 20.0 * (number / 1000);
  feature.box = store::StoredBox{{x, y, 0}, {x + 10, y + 10, 5}};
  StoredSolid solid;
  solid.object_id = feature.id;
  solid.lod = "2.2";
  solid.blob.assign(60, static_cast<std::uint8_t>(number));
  feature.solids.push_back(std::move(solid));
  return feature;
}

/// Calls `call(thread, i)` on some threads for some seconds; prints the rates. A call that fails
/// ends the program.
void measure(const char* name, int threads, double seconds, int features,
             const std::function<Status(int, int)>& call) {
  std::atomic<std::uint64_t> calls{0};
  const double processor = processor_seconds();
  const auto start = Clock::now();
  std::vector<std::thread> running;
  for (int t = 0; t < threads; ++t) {
    running.emplace_back([&, t] {
      for (int i = 0; seconds_since(start) < seconds; ++i, ++calls) {
        if (const Status done = call(t, i); !done) {
          std::fprintf(stderr, "%s\n", to_string(done.error()).c_str());
          _exit(1);
        }
      }
    });
  }
  for (std::thread& thread : running) thread.join();
  const double elapsed = seconds_since(start);
  const auto count = static_cast<double>(calls);
  std::printf("| %s | %d | %.0f | %.0f | %.3f |\n", name, threads, count / elapsed,
              count * features / elapsed, 1e3 * (processor_seconds() - processor) / count);
  std::fflush(stdout);
}

template <class Value>
Status status_of(const Result<Value>& result) {
  if (!result) return result.error();
  return Done{};
}

std::vector<StoredFeature> boxes(const std::string& collection, int first, int count) {
  std::vector<StoredFeature> made;
  for (int i = 0; i < count; ++i) made.push_back(box(collection, first + i));
  return made;
}

void measure_puts(SolidStore& store, const std::string& name, int threads, int batch,
                  double seconds) {
  const std::string label = "put of " + std::to_string(batch);
  measure(label.c_str(), threads, seconds, batch, [&](int thread, int i) {
    return status_of(store.put(boxes(name, thread * 10'000'000 + i * batch, batch)));
  });
}

void measure_reads(SolidStore& store, const std::string& name, int threads, double seconds) {
  const auto random_id = [](int thread, int i) {
    std::minstd_rand random(static_cast<unsigned>(thread * 1'000'003 + i + 1));
    random.discard(2);
    return "box-" + std::to_string(random() % kKept);
  };
  measure("get", threads, seconds, 1,
          [&](int thread, int i) { return status_of(store.get(name, random_id(thread, i))); });
  measure("version", threads, seconds, 1,
          [&](int thread, int i) { return status_of(store.version(name, random_id(thread, i))); });
  measure("list of 10", threads, seconds, 10, [&](int thread, int i) {
    return status_of(store.list({name, 10, random_id(thread, i), {}}));
  });
  measure("collection", threads, seconds, 1,
          [&](int, int) { return status_of(store.collection(name)); });
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("usage: store_speed CONNECTION [SECONDS [puts|reads]]\n", stderr);
    return 2;
  }
  const double seconds = argc > 2 ? std::atof(argv[2]) : 3;
  auto opened = store::open_postgres_store(argv[1], 8);
  if (!opened) {
    std::fprintf(stderr, "%s\n", to_string(opened.error()).c_str());
    return 1;
  }
  SolidStore& store = **opened;
  const std::string only = argc > 3 ? argv[3] : "";
  const std::string name = "speed-" + std::to_string(getpid());
  for (int first = 0; first < kKept; first += 1000) {
    if (const Status done = status_of(store.put(boxes(name, first, 1000))); !done) {
      std::fprintf(stderr, "%s\n", to_string(done.error()).c_str());
      return 1;
    }
  }
  std::puts("| call | threads | calls/s | features/s | client ms/call |\n|---|---|---|---|---|");
  if (only != "puts") {
    for (const int threads : {1, 4}) measure_reads(store, name, threads, seconds);
  }
  if (only == "reads") return 0;
  measure_puts(store, name + "-w1", 1, 1, seconds);
  measure_puts(store, name + "-w8", 8, 1, seconds);
  measure_puts(store, name + "-w100", 4, 100, seconds);
  measure_puts(store, name + "-w1000", 1, 1000, seconds);
  return 0;
}
