// SPDX-License-Identifier: GPL-3.0-or-later
//
// compare CORPUS [--page N] [--unseen SET]...: prints the bytes of files that decode, for each set
// of the test half (bench/corpus/split.h), beside those of other coders on the same grid. A page
// counts all its bytes and those of a page file around it; a blob counts all its bytes. Other
// coders that keep no position or grid get the bytes added that our format takes for them: three
// varints of the origin, and two bytes of the grid for a blob.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "bench/corpus/split.h"
#include "bench/ratio/peers.h"
#include "codec/encode_boundary.h"
#include "codec/page.h"
#include "tessellate/facets.h"

using namespace watertight;

namespace {

// The bytes of a file of one page besides the page: head and tail (17), the index with its numbers
// of pages and solids (up to 8), and a byte for each solid (codec/page_file.h).
constexpr std::size_t kFileBytes = 25;

struct Options {
  std::string corpus;
  std::size_t page = 256;
  std::set<std::string> unseen;
};

struct Sums {
  std::size_t solids = 0;
  std::size_t vertices = 0;
  std::size_t wide = 0;  // the number of solids that Draco cannot take, which are left out
  double paged = 0;
  double alone = 0;
  double draco_paged = 0;
  double draco_alone = 0;
  double meshopt = 0;
  double wkb = 0;
  double city_json = 0;
  double encode_seconds = 0;
  double decode_seconds = 0;
  std::vector<const Solid*> all;
};

double now() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

std::size_t varint_bytes(std::int64_t value) {
  ByteWriter writer;
  writer.zigzag(value);
  return writer.size();
}

std::size_t position_bytes(const codec::GridPoint& origin, const codec::GridPoint& before) {
  std::size_t bytes = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) bytes += varint_bytes(origin[axis] - before[axis]);
  return bytes;
}

template <class Value>
const Value& require(const Result<Value>& result, const char* what) {
  if (result) return *result;
  std::fprintf(stderr, "%s: %s\n", what, to_string(result.error()).c_str());
  std::exit(1);
}

void add_peers(const Solid& solid, const codec::GridPoint& origin, const codec::GridPoint& before,
               Sums& sums) {
  const PeerBytes peers = measure_peers(solid, tessellate::triangulate_facets(solid).triangles);
  sums.draco_alone += static_cast<double>(peers.draco + position_bytes(origin, {}) + 2);
  sums.draco_paged += static_cast<double>(peers.draco + position_bytes(origin, before));
  sums.meshopt += static_cast<double>(peers.meshopt + position_bytes(origin, {}) + 2);
  sums.wkb += static_cast<double>(peers.wkb_zstd);
  sums.city_json += static_cast<double>(peers.city_json_zstd);
}

Sums measure(const CorpusPage& page, const std::vector<CorpusSolid>& corpus,
             const std::vector<codec::PageSolid>& stored) {
  Sums sums;
  codec::PageContents contents;
  contents.frame = page.frame;
  codec::GridPoint before{};
  std::vector<const OrientedBoundary*> boundaries;
  for (const std::size_t number : page.solids) {
    const Solid& solid = corpus[number].canonical.boundary.solid();
    const Box box = solid.box();
    if (std::max({box.max.x, box.max.y, box.max.z}) >= 0x1p31) {
      ++sums.wide;
      continue;
    }
    ++sums.solids;
    sums.vertices += solid.vertex_count();
    sums.all.push_back(&solid);
    const EncodeOptions options{.keep_order = false};
    const double start = now();
    const auto blob = codec::encode_boundary(corpus[number].canonical.boundary,
                                             corpus[number].acceptance, options);
    const double middle = now();
    const auto again = decode(require(blob, "encode"));
    sums.encode_seconds += middle - start;
    sums.decode_seconds += now() - middle;
    if (require(again, "decode").solid != solid) std::abort();
    sums.alone += static_cast<double>(blob->size());
    add_peers(solid, stored[number].origin, before, sums);
    before = stored[number].origin;
    contents.solids.push_back(codec::page_solid(corpus[number].canonical.boundary, false));
  }
  if (contents.solids.empty()) return sums;
  std::vector<codec::Plan> plans(contents.solids.size());
  const auto bytes = codec::write_page_bytes(contents, plans, codec::PageKind::page, nullptr);
  const auto decoded = codec::decode_page(require(bytes, "encode page"));
  for (std::size_t i = 0; i < sums.all.size(); ++i) {
    if (require(decoded, "decode page")[i].solid != *sums.all[i]) std::abort();
  }
  sums.paged = static_cast<double>(bytes->size() + kFileBytes + sums.solids);
  return sums;
}

void add(const Sums& page, Sums& total) {
  total.solids += page.solids;
  total.vertices += page.vertices;
  total.wide += page.wide;
  total.paged += page.paged;
  total.alone += page.alone;
  total.draco_paged += page.draco_paged;
  total.draco_alone += page.draco_alone;
  total.meshopt += page.meshopt;
  total.wkb += page.wkb;
  total.city_json += page.city_json;
  total.encode_seconds += page.encode_seconds;
  total.decode_seconds += page.decode_seconds;
  total.all.insert(total.all.end(), page.all.begin(), page.all.end());
}

void print(const std::map<std::string, Sums>& sets) {
  std::printf(
      "| set | solids | vertices | page | blob | Draco | meshopt | WKB+zstd | CityJSON+zstd | "
      "page/Draco | blob/Draco | page/WKB | page/CityJSON | page/whole CityJSON | encode ms | "
      "decode ms |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const auto& [set, sum] : sets) {
    const auto n = static_cast<double>(std::max<std::size_t>(sum.solids, 1));
    const auto whole = static_cast<double>(whole_city_json_zstd(sum.all));
    const auto percent = [](double part, double all) { return 100 * part / all; };
    std::printf("| %s | %zu | %.1f | %.1f | %.1f | %.1f | %.1f | %.1f | %.1f |", set.c_str(),
                sum.solids, static_cast<double>(sum.vertices) / n, sum.paged / n, sum.alone / n,
                sum.draco_alone / n, sum.meshopt / n, sum.wkb / n, sum.city_json / n);
    std::printf(" %.1f %% | %.1f %% | %.1f %% | %.1f %% | %.1f %% | %.2f | %.2f |\n",
                percent(sum.paged, sum.draco_paged), percent(sum.alone, sum.draco_alone),
                percent(sum.paged, sum.wkb), percent(sum.paged, sum.city_json),
                percent(sum.paged, whole), 1e3 * sum.encode_seconds / n,
                1e3 * sum.decode_seconds / n);
    std::fflush(stdout);
  }
}

Options read_options(int count, char** arguments) {
  Options options;
  options.corpus = count > 1 ? arguments[1] : "";
  for (int i = 2; i + 1 < count; i += 2) {
    const std::string name = arguments[i];
    const std::string value = arguments[i + 1];
    if (name == "--page") options.page = static_cast<std::size_t>(std::atoi(value.c_str()));
    if (name == "--unseen") options.unseen.insert(value);
  }
  return options;
}

}  // namespace

int main(int count, char** arguments) {
  const Options options = read_options(count, arguments);
  if (options.corpus.empty()) {
    std::fprintf(stderr, "usage: compare CORPUS [--page N] [--unseen SET]...\n");
    return 2;
  }
  const std::vector<CorpusSolid> corpus = read_corpus(options.corpus);
  std::vector<codec::PageSolid> stored;
  for (const CorpusSolid& solid : corpus) {
    stored.push_back(codec::page_solid(solid.source, false));
  }
  std::map<std::string, Sums> sets;
  std::size_t wide = 0;
  for (const CorpusPage& page : split_corpus(corpus, stored, options.unseen, options.page)) {
    if (!page.is_test) continue;
    const Sums sums = measure(page, corpus, stored);
    wide += sums.wide;
    if (sums.solids == 0) continue;
    const bool is_unseen = options.unseen.contains(page.set);
    add(sums, sets[(is_unseen ? "unseen: " : "") + page.set]);
    add(sums, sets[is_unseen ? "~ all unseen" : "~ all, test half"]);
  }
  print(sets);
  std::printf("\n%zu solids are wider than 31 bits: no peer of integers takes them.\n", wide);
}
