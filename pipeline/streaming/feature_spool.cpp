// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/streaming/feature_spool.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

namespace watertight::pipeline {
namespace {

constexpr std::size_t kBatchFeatures = 5000;
constexpr std::size_t kSolidOverhead = sizeof(StoredSolid);
constexpr std::size_t kFeatureOverhead = sizeof(StoredFeature);

/// The spool holds other bytes than were written to it.
Error damaged() { return {ErrorCode::unavailable, "the temporary file has been changed"}; }

std::size_t bytes_of(const StoredFeature& feature) {
  std::size_t bytes =
      kFeatureOverhead + feature.id.size() + feature.skeleton.bytes.size() + feature.page.size();
  for (const StoredSolid& solid : feature.solids) {
    bytes += kSolidOverhead + solid.object_id.size() + solid.blob.size();
  }
  return bytes;
}

void write(ByteWriter& writer, ByteView bytes) {
  writer.varint(bytes.size());
  writer.append(bytes);
}

void write(ByteWriter& writer, std::string_view text) { write(writer, as_bytes(text)); }

ByteView read_bytes(ByteReader& reader) {
  return reader.take(static_cast<std::size_t>(reader.varint()));
}

std::string read_text(ByteReader& reader) { return std::string(as_text(read_bytes(reader))); }

Bytes read_copy(ByteReader& reader) {
  const ByteView bytes = read_bytes(reader);
  return {bytes.begin(), bytes.end()};
}

void write_feature(ByteWriter& writer, const StoredFeature& feature, std::uint64_t header,
                   std::uint64_t dictionary) {
  write(writer, feature.collection);
  write(writer, feature.id);
  write(writer, feature.type);
  writer.varint(feature.srid);
  write(writer, feature.format);
  writer.varint(header);
  writer.u8(feature.box ? 1 : 0);
  for (std::size_t axis = 0; feature.box && axis < 3; ++axis) {
    writer.f64(feature.box->min[axis]);
    writer.f64(feature.box->max[axis]);
  }
  writer.u8(feature.has_findings ? 1 : 0);
  writer.varint(dictionary);
  write(writer, feature.skeleton.bytes);
  write(writer, feature.page);
  writer.varint(feature.solids.size());
  for (const StoredSolid& solid : feature.solids) {
    write(writer, solid.object_id);
    writer.varint(solid.geometry);
    writer.varint(solid.ordinal);
    write(writer, solid.lod);
    write(writer, solid.blob);
    writer.u8(solid.is_proven ? 1 : 0);
  }
}

/// Reads what write_feature() wrote; the caller checks reader.failed().
StoredFeature read_feature(ByteReader& reader, const std::vector<SharedText>& headers,
                           const std::vector<packing::DictionaryPointer>& dictionaries) {
  StoredFeature feature;
  feature.collection = read_text(reader);
  feature.id = read_text(reader);
  feature.type = read_text(reader);
  feature.srid = static_cast<std::uint32_t>(reader.varint());
  feature.format = read_text(reader);
  const std::uint64_t header = reader.varint();
  if (header < headers.size()) feature.header = headers[header];
  if (reader.u8() != 0) feature.box.emplace();
  for (std::size_t axis = 0; feature.box && axis < 3; ++axis) {
    feature.box->min[axis] = reader.f64();
    feature.box->max[axis] = reader.f64();
  }
  feature.has_findings = reader.u8() != 0;
  const std::uint64_t dictionary = reader.varint();
  if (dictionary < dictionaries.size()) feature.skeleton.dictionary = dictionaries[dictionary];
  feature.skeleton.bytes = read_copy(reader);
  feature.page = read_copy(reader);
  const std::uint64_t solids = reader.varint();
  for (std::uint64_t i = 0; i < solids && !reader.failed(); ++i) {
    StoredSolid& solid = feature.solids.emplace_back();
    solid.object_id = read_text(reader);
    solid.geometry = static_cast<std::uint32_t>(reader.varint());
    solid.ordinal = static_cast<std::uint32_t>(reader.varint());
    solid.lod = read_text(reader);
    solid.blob = read_copy(reader);
    solid.is_proven = reader.u8() != 0;
  }
  return feature;
}

}  // namespace

Status FeatureSpool::add(StoredFeature feature) {
  const std::size_t bytes = bytes_of(feature);
  const bool is_full = open_bytes_ + bytes > batch_bytes_ || open_.size() == kBatchFeatures;
  if (is_full && !open_.empty()) {
    if (Status written = write_batch(); !written) return written;
  }
  open_bytes_ += bytes;
  open_.push_back(std::move(feature));
  ++size_;
  return Done{};
}

void FeatureSpool::clear() { *this = FeatureSpool(batch_bytes_); }

std::uint64_t FeatureSpool::number_of(const SharedText& header) {
  const auto [number, is_new] = header_numbers_.try_emplace(header, headers_.size());
  if (is_new) headers_.push_back(header);
  return number->second;
}

std::uint64_t FeatureSpool::number_of(const packing::DictionaryPointer& dictionary) {
  const auto found = std::find(dictionaries_.begin(), dictionaries_.end(), dictionary);
  if (found == dictionaries_.end()) {
    dictionaries_.push_back(dictionary);
    return dictionaries_.size() - 1;
  }
  return static_cast<std::uint64_t>(found - dictionaries_.begin());
}

Status FeatureSpool::write_batch() {
  if (!file_) {
    auto made = TemporaryFile::make();
    if (!made) return std::move(made).error();
    file_ = *std::move(made);
  }
  ByteWriter writer;
  for (const StoredFeature& feature : open_) {
    write_feature(writer, feature, number_of(feature.header),
                  number_of(feature.skeleton.dictionary));
  }
  batches_.push_back({open_.size(), file_->size(), writer.size()});
  if (Status written = file_->append(writer.bytes()); !written) return written;
  open_.clear();
  open_bytes_ = 0;
  return Done{};
}

Status FeatureSpool::rewind() {
  given_ = 0;
  return Done{};
}

Result<std::span<const StoredFeature>> FeatureSpool::next() {
  const std::size_t number = given_++;
  read_.clear();
  if (number > batches_.size()) return std::span<const StoredFeature>();
  if (number == batches_.size()) return std::span<const StoredFeature>(open_);
  if (Status status = read_batch(batches_[number]); !status) return std::move(status).error();
  return std::span<const StoredFeature>(read_);
}

Status FeatureSpool::read_batch(const Batch& batch) {
  const auto bytes = file_->read(batch.offset, batch.bytes);
  if (!bytes) return bytes.error();
  ByteReader reader(*bytes);
  for (std::uint64_t i = 0; i < batch.features; ++i) {
    read_.push_back(read_feature(reader, headers_, dictionaries_));
  }
  if (reader.failed() || reader.remaining() > 0) return damaged();
  return Done{};
}

}  // namespace watertight::pipeline
