// SPDX-License-Identifier: GPL-3.0-or-later
//
// damage N SEED DOCUMENT...: reads N damaged Watertight files and rows of stored features, made of
// the documents, and each prefix of the files. damage --seeds FOLDER DOCUMENT writes the rows of
// the document for tests/fuzz/packed/fuzz_rows.cpp instead.
//
// A file with changed bytes must be refused, or give the very documents. A file whose records have
// right checksums again, and a row, must be refused or give documents that are written or refused.
// A prefix must be refused, or be what was committed before. Prints how each ended, the slowest
// reading, and the memory of all.
#include <sys/resource.h>

#include <charconv>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "bench/input.h"
#include "packing/text_dictionary.h"
#include "pipeline/container.h"
#include "pipeline/file/selection.h"
#include "store/rows/packed_solids.h"
#include "tests/generated/mutated_blobs.h"

using namespace watertight;
using pipeline::ContainerFile;
using pipeline::RecordKind;

namespace {

constexpr std::size_t kMostRows = 200;  // of a document
constexpr std::size_t kHeadBytes = 9;
constexpr std::uint64_t kMostText = std::uint64_t{4} << 20U;  // of a row

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

long peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss / 1024;
}

/// A file, what it decodes to, and what the prefixes up to its commits do.
struct File {
  Bytes bytes;
  std::map<std::size_t, std::string> at_commit;  // the documents, by the end of the commit
  std::string id;
};

/// A row as the store gives it.
struct Row {
  std::string id;
  std::string format;
  SharedText header;
  std::uint64_t number = 0;
  Bytes solids;
  Bytes text;
  packing::DictionaryPointer dictionary;
};

/// The documents as bytes, or the error. A document that cannot be written has its error.
Result<std::string> texts_of(const Result<std::vector<Document>>& documents) {
  if (!documents) return documents.error();
  std::string texts;
  for (const Document& document : *documents) {
    const auto text = formats::write_document(document, document.format);
    texts += text ? std::string(as_text(*text)) : to_string(text.error());
  }
  return texts;
}

pipeline::FileBytes in_ranges(ByteView bytes) {
  return {bytes.size(), [bytes](std::uint64_t offset, std::uint64_t size) -> Result<Bytes> {
            const ByteView part =
                bytes.subspan(static_cast<std::size_t>(offset), static_cast<std::size_t>(size));
            return Bytes(part.begin(), part.end());
          }};
}

/// The records of a file, each with the right checksum; bytes that are no record stay away.
Bytes with_checksums(ByteView bytes) {
  ByteWriter writer;
  writer.append(pipeline::file_head());
  ByteReader reader(bytes.subspan(std::min(kHeadBytes, bytes.size())));
  while (reader.remaining() > 0) {
    const std::uint64_t head = reader.varint();
    if (reader.failed()) break;
    const auto kind = static_cast<RecordKind>(head % 4);
    const Bytes record = pipeline::write_record(
        kind, reader.take(
                  static_cast<std::size_t>(std::min<std::uint64_t>(head / 4, reader.remaining()))));
    writer.append(record);
    reader.take(std::min<std::size_t>(4, reader.remaining()));
    std::size_t end = kind == RecordKind::commit ? 1 : 0;
    while (end > 0 && end < 10 && record.size() >> (7 * end) > 0) ++end;
    reader.take(std::min(end, reader.remaining()));
  }
  return std::move(writer).bytes();
}

class Siege {
 public:
  explicit Siege(std::uint64_t seed) : random_(seed) {}

  Status add(const std::string& path) {
    formats::ReadOptions read;
    read.keep_text = true;
    auto document = bench::read_file(path, read);
    if (!document) return std::move(document).error();
    pipeline::IngestOptions options;
    options.policy = pipeline::Policy::keep;
    auto encoded = pipeline::encode_document(*std::move(document), nullptr, options);
    if (!encoded) return std::move(encoded).error();
    if (Status added = add_rows(encoded->document); !added) return added;
    return add_files(encoded->document);
  }

  /// Reads one damaged file or row. False after a broken promise.
  bool round() {
    const double start = cpu_seconds();
    const std::uint64_t kind = random_.below(16);
    const bool is_file = kind < 10;
    bool is_good = true;
    std::size_t size = 0;
    if (is_file) is_good = round_of_file(kind == 0, size);
    if (!is_file) round_of_row(size);
    note(cpu_seconds() - start, size, is_file ? "file" : "row");
    return is_good;
  }

  /// Reads each prefix of each file. False after a broken promise.
  bool prefixes() {
    for (const File& file : files_) {
      for (std::size_t size = 0; size < file.bytes.size(); ++size) {
        const double start = cpu_seconds();
        if (!is_prefix_good(file, size)) return false;
        note(cpu_seconds() - start, size, "prefix");
      }
    }
    return true;
  }

  void write_seeds(const std::string& folder) const {
    for (const Row& row : rows_) {
      ByteWriter writer;
      writer.u16(0);
      writer.u16(static_cast<std::uint16_t>(row.solids.size()));
      writer.append(row.solids);
      writer.append(as_bytes(*packing::unpack(row.text, row.dictionary.get(), 1U << 30U)));
      std::ofstream stream(folder + "/" + std::to_string(&row - rows_.data()) + ".row",
                           std::ios::binary);
      stream << as_text(writer.bytes());
    }
  }

  void print(std::uint64_t rounds) const {
    std::size_t largest = 0;
    for (const File& file : files_) largest = std::max(largest, file.bytes.size());
    for (const auto& [outcome, times] : outcomes_) {
      std::printf("%s %llu\n", outcome.c_str(), static_cast<unsigned long long>(times));
    }
    std::printf(
        "%zu files of at most %zu bytes and %zu rows; %llu damaged in %.0f s; the slowest took %.3f"
        " s for %zu bytes (%s); at most %ld MB of memory\n",
        files_.size(), largest, rows_.size(), static_cast<unsigned long long>(rounds),
        cpu_seconds(), slowest_, slowest_size_, slowest_what_, peak_megabytes());
  }

 private:
  Status add_rows(const pipeline::EncodedDocument& document) {
    std::vector<std::string> texts;
    for (const pipeline::EncodedFeature& feature : document.features) {
      texts.push_back(pipeline::stored_text(feature));
    }
    const auto dictionary = packing::best_dictionary(texts, 1'000'000);
    if (!dictionary) return dictionary.error();
    for (std::size_t i = 0; i < std::min(kMostRows, texts.size()); ++i) {
      const pipeline::EncodedFeature& feature = document.features[i];
      const auto packed = packing::pack(texts[i], dictionary->get());
      if (!packed) return packed.error();
      rows_.push_back({feature.id, feature.format, feature.header, feature.solids.size(),
                       store::pack_solids(feature), *packed, *dictionary});
      solids_.push_back(rows_.back().solids);
      texts_.push_back(*packed);
    }
    if (*dictionary) dictionaries_.push_back((*dictionary)->content());
    return Done{};
  }

  Status add_files(const pipeline::EncodedDocument& document) {
    for (const auto purpose : {pipeline::FilePurpose::size, pipeline::FilePurpose::ranges}) {
      auto file = pipeline::write_container(document, {.purpose = purpose});
      if (!file) return std::move(file).error();
      if (Status added = add_file(*file, document); !added) return added;
      // The same with its first feature added once more.
      auto opened = ContainerFile::open(*file, {});
      if (!opened) return std::move(opened).error();
      auto writer = pipeline::ContainerWriter::append(*opened, {.purpose = purpose});
      if (!writer) return std::move(writer).error();
      if (Status added = writer->add(document.features.front()); !added) return added;
      writer->remove({0, 0}, document.features.front().solids.size());
      const auto more = std::move(*writer).finish();
      if (!more) return more.error();
      file->insert(file->end(), more->begin(), more->end());
      if (Status added = add_file(*file, document); !added) return added;
    }
    return Done{};
  }

  Status add_file(const Bytes& bytes, const pipeline::EncodedDocument& document) {
    File file{bytes, {}, document.features.front().id};
    for (const pipeline::Record& record : pipeline::walk_records(bytes).records) {
      if (record.kind != RecordKind::commit) continue;
      const ByteView part = ByteView(bytes).first(static_cast<std::size_t>(record.extent.end()));
      auto texts = texts_of(pipeline::decode_container(part));
      if (!texts) return std::move(texts).error();
      file.at_commit[part.size()] = *std::move(texts);
    }
    files_.push_back(std::move(file));
    return Done{};
  }

  bool round_of_file(bool has_checksums, std::size_t& size) {
    const File& file = files_[random_.below(files_.size())];
    Bytes bytes = generated::mutated({file.bytes}, random_);
    if (has_checksums) bytes = with_checksums(bytes);
    size = bytes.size();
    const auto texts = texts_of(pipeline::decode_container(bytes));
    count(has_checksums ? "file with checksums" : "file", texts);
    if (random_.below(8) == 0) {
      auto opened = ContainerFile::open(in_ranges(bytes), {}, pipeline::TornTail::leave_out);
      const auto selected = opened ? pipeline::select_ids(*opened, {file.id})
                                   : Result<pipeline::Selected>(opened.error());
      count(has_checksums ? "id in file with checksums" : "id in file", selected);
    }
    if (has_checksums || !texts) return true;
    for (const auto& [end, expected] : file.at_commit) {
      if (*texts == expected) return true;
    }
    std::fprintf(stderr, "a damaged file of %zu bytes gives other documents\n", bytes.size());
    return false;
  }

  void round_of_row(std::size_t& size) {
    const Row& row = rows_[random_.below(rows_.size())];
    StoredFeature feature;
    feature.id = row.id;
    feature.format = row.format;
    feature.header = row.header;
    Bytes solids = row.solids;
    feature.skeleton = {row.text, row.dictionary};
    const std::uint64_t part = random_.below(16);
    if (part < 6) solids = generated::mutated(solids_, random_);
    if (part >= 4) feature.skeleton.bytes = generated::mutated(texts_, random_);
    if (part == 15 && !dictionaries_.empty()) {
      auto dictionary = packing::TextDictionary::of(generated::mutated(dictionaries_, random_));
      count("dictionary", dictionary);
      if (dictionary) feature.skeleton.dictionary = *dictionary;
    }
    size = solids.size() + feature.skeleton.bytes.size();
    const auto unpacked = store::unpack_solids(feature, row.number, solids);
    count("solids of a row", unpacked);
    if (!unpacked) return;
    auto whole = pipeline::unpack(feature, {.bytes = kMostText});
    count("text of a row", whole);
    if (!whole) return;
    const auto document = pipeline::decode_feature(*whole);
    count("document of a row", document);
    if (document) count("writing of a row", formats::write_document(*document, document->format));
  }

  static bool is_prefix_good(const File& file, std::size_t size) {
    const ByteView bytes = ByteView(file.bytes).first(size);
    const auto whole = texts_of(pipeline::decode_container(bytes));
    const auto here = file.at_commit.find(size);
    const bool is_whole_good =
        here == file.at_commit.end() ? !whole : whole && *whole == here->second;
    auto opened = ContainerFile::open(in_ranges(bytes), {}, pipeline::TornTail::leave_out);
    auto before = file.at_commit.upper_bound(size);
    bool is_part_good = !opened;
    if (before != file.at_commit.begin()) {
      --before;
      const auto part = opened ? texts_of(pipeline::decode_container(*opened))
                               : Result<std::string>(opened.error());
      is_part_good = part && *part == before->second;
    }
    if (is_whole_good && is_part_good) return true;
    std::fprintf(stderr, "the prefix of %zu bytes of a file of %zu is read wrongly\n", size,
                 file.bytes.size());
    return false;
  }

  template <class Value>
  void count(const char* what, const Result<Value>& result) {
    ++outcomes_[std::string(what) + ": " +
                (result ? "read" : std::string(to_string(result.error().code)))];
  }

  void note(double seconds, std::size_t size, const char* what) {
    if (seconds <= slowest_) return;
    slowest_ = seconds;
    slowest_size_ = size;
    slowest_what_ = what;
  }

  generated::Random random_;
  std::vector<File> files_;
  std::vector<Row> rows_;
  std::vector<Bytes> solids_;
  std::vector<Bytes> texts_;
  std::vector<Bytes> dictionaries_;
  std::map<std::string, std::uint64_t> outcomes_;
  double slowest_ = 0;
  std::size_t slowest_size_ = 0;
  const char* slowest_what_ = "";
};

std::uint64_t number(const char* text) {
  std::uint64_t value = 0;
  std::from_chars(text, text + std::strlen(text), value);
  return value;
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 4) {
    std::fprintf(stderr, "usage: damage N SEED DOCUMENT... | --seeds FOLDER DOCUMENT\n");
    return 2;
  }
  const bool are_seeds = std::strcmp(arguments[1], "--seeds") == 0;
  Siege siege(are_seeds ? 0 : number(arguments[2]));
  for (int i = 3; i < count; ++i) {
    if (const Status added = siege.add(arguments[i]); !added) {
      std::fprintf(stderr, "%s: %s\n", arguments[i], to_string(added.error()).c_str());
      return 2;
    }
  }
  if (are_seeds) {
    siege.write_seeds(arguments[2]);
    return 0;
  }
  const std::uint64_t rounds = number(arguments[1]);
  if (!siege.prefixes()) return 1;
  for (std::uint64_t i = 0; i < rounds; ++i) {
    if (!siege.round()) return 1;
    if (i % 10'000 == 9'999) {
      std::fprintf(stderr, "%llu, %.0f s\n", static_cast<unsigned long long>(i + 1), cpu_seconds());
    }
  }
  siege.print(rounds);
  return 0;
}
