// SPDX-License-Identifier: GPL-3.0-or-later
//
// codec_speed FILE... [--repeat N]: times the codec and the writer of documents, without validation
// and on one thread. Each document is read and its solids are certified first (without engines, so
// a few stay undecided and are left out). Then these steps run N times (5 by default), and the
// least processor time of each is printed, per solid and as MB of the source document a second:
// pages and blobs written, pages and blobs read, the bytes of the document written from its solids.
// The last column is the CRC-32C of the bytes made, so that two builds can be compared.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/checksum.h"
#include "bench/input.h"
#include "codec/page_file.h"
#include "validate/certify.h"

using namespace watertight;

namespace {

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

[[noreturn]] void give_up(const std::string& file, const Error& error) {
  std::fprintf(stderr, "%s: %s\n", file.c_str(), error.message.c_str());
  std::exit(2);
}

struct Source {
  std::string file;
  double megabytes = 0;
  Document document;
  std::vector<ValidSolid> solids;
};

Source read_source(const std::string& file) {
  formats::ReadOptions options;
  options.split_features = false;
  options.keep_text = true;
  auto document = bench::read_file(file, options);
  if (!document) give_up(file, document.error());
  Source source{
      file, static_cast<double>(std::filesystem::file_size(file)) / 1e6, *std::move(document), {}};
  for (const Feature& feature : source.document.features) {
    for (const formats::SubmittedSolid& submitted : feature.solids) {
      auto inspection = certify(submitted.solid, nullptr);
      if (inspection.certified) source.solids.push_back(std::move(inspection.certified->solid));
    }
  }
  return source;
}

/// Runs a step, which adds what it makes to a checksum, `repeat` times. Prints the least time.
void measure(const Source& source, const char* name, int repeat,
             const std::function<std::uint32_t()>& step) {
  double least = 1e9;
  std::uint32_t checksum = 0;
  for (int i = 0; i < repeat; ++i) {
    const double start = cpu_seconds();
    checksum = step();
    least = std::min(least, cpu_seconds() - start);
  }
  const auto solids = static_cast<double>(source.solids.size());
  std::printf("| %-16s | %8.2f | %7.3f | %7.1f | %08x |\n", name, 1e3 * least, 1e3 * least / solids,
              source.megabytes / least, checksum);
}

std::vector<Bytes> blobs_of(const Source& source) {
  std::vector<Bytes> blobs;
  for (const ValidSolid& solid : source.solids) {
    auto blob = encode(solid);
    if (!blob) give_up(source.file, blob.error());
    blobs.push_back(*std::move(blob));
  }
  return blobs;
}

Bytes pages_of(const Source& source) {
  codec::PageFileWriter writer;
  for (const ValidSolid& solid : source.solids) {
    if (const Status added = writer.add(solid); !added) give_up(source.file, added.error());
  }
  auto pages = std::move(writer).finish();
  if (!pages) give_up(source.file, pages.error());
  return *std::move(pages);
}

std::uint32_t read_pages(const Source& source, ByteView file) {
  const auto reader = codec::PageFileReader::open(file);
  if (!reader) give_up(source.file, reader.error());
  std::uint32_t vertices = 0;
  for (std::size_t i = 0; i < reader->page_count(); ++i) {
    const auto solids = reader->page(i);
    if (!solids) give_up(source.file, solids.error());
    for (const auto& solid : *solids) vertices += solid.decoded.solid.vertex_count();
  }
  return vertices;
}

std::uint32_t read_blobs(const Source& source, const std::vector<Bytes>& blobs) {
  std::uint32_t vertices = 0;
  for (const Bytes& blob : blobs) {
    const auto decoded = decode(blob);
    if (!decoded) give_up(source.file, decoded.error());
    vertices += decoded->solid.vertex_count();
  }
  return vertices;
}

void run(const Source& source, int repeat) {
  std::printf("\n%s: %.3f MB, %zu solids certified\n\n", source.file.c_str(), source.megabytes,
              source.solids.size());
  std::printf("| step             |       ms | ms each |    MB/s | result   |\n");
  std::printf("|------------------|---------:|--------:|--------:|----------|\n");
  Bytes pages;
  std::vector<Bytes> blobs;
  measure(source, "pages written", repeat, [&] {
    pages = pages_of(source);
    return crc32c(pages);
  });
  measure(source, "blobs written", repeat, [&] {
    blobs = blobs_of(source);
    std::uint32_t checksum = 0;
    for (const Bytes& blob : blobs) checksum = crc32c(blob, checksum);
    return checksum;
  });
  measure(source, "pages read", repeat, [&] { return read_pages(source, pages); });
  measure(source, "blobs read", repeat, [&] { return read_blobs(source, blobs); });
  measure(source, "document written", repeat, [&] {
    const auto text = formats::write_document(source.document, source.document.format);
    if (!text) give_up(source.file, text.error());
    return crc32c(*text);
  });
}

}  // namespace

int main(int count, char** arguments) {
  std::vector<std::string> files(arguments + 1, arguments + count);
  int repeat = 5;
  if (files.size() > 2 && files[files.size() - 2] == "--repeat") {
    repeat = std::max(1, std::atoi(files.back().c_str()));
    files.resize(files.size() - 2);
  }
  if (files.empty()) {
    std::fprintf(stderr, "usage: codec_speed FILE... [--repeat N]\n");
    return 2;
  }
  for (const std::string& file : files) run(read_source(file), repeat);
  return 0;
}
