// SPDX-License-Identifier: GPL-3.0-or-later
//
// The command tiles, which writes documents as a tileset of 3D Tiles: every geometry that can be
// read, also of solids that are not valid.
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "base/quantity.h"
#include "cli/commands.h"
#include "cli/sources/input_list.h"
#include "cli/terminal/printable.h"
#include "cli/terminal/progress.h"
#include "files/inputs.h"
#include "formats/geo_json/city_shapes.h"
#include "formats/gml/city/city.h"
#include "pipeline/streaming/feature_stream.h"
#include "tiles/feature_mesh.h"
#include "tiles/glb.h"
#include "tiles/tileset.h"

namespace watertight::cli {
namespace {

namespace fs = std::filesystem;
using formats::CityFeature;
using tiles::FeatureMesh;
using tiles::Frame;

/// A feature as triangles, or why there are none.
using Meshed = Result<FeatureMesh>;

bool is_city_model(Format format) {
  return format == Format::city_json || format == Format::city_json_seq;
}

/// Opens an input feature by feature. GML becomes a city model with all its surfaces.
Result<formats::FeatureReader> open_features(const files::InputFile& input) {
  auto opened = files::open_input(input, {});
  if (!opened) return std::move(opened).error();
  if (opened->reader.document().format != Format::gml || input.name == "-") {
    return std::move(opened->reader);
  }
  const auto whole = files::read_whole(input, {});
  if (!whole) return whole.error();
  if (files::kind_of_input(whole->bytes) != files::InputKind::document)
    return std::move(opened->reader);
  auto city = formats::city_model_of_gml(whole->bytes, {});
  if (!city) return std::move(city).error();
  return formats::FeatureReader::of(std::move(city->model));
}

/// The features of all documents, as triangles in one frame.
class TileRun {
 public:
  explicit TileRun(const TilesCommand& command) : command_(command) {}

  /// Adds the features of an input; says what could not be read or shown. Errors: those of the
  /// input.
  Status add(const files::InputFile& input, const std::string& position) {
    auto reader = open_features(input);
    if (!reader) return std::move(reader).error();
    file_ = input.name;
    if (Status read = read_header(reader->document()); !read) return read;
    if (Status found = find_frame(*reader); !found) return found;
    ProgressBar bar(input.name, position);
    pipeline::FeatureStreamOptions options{command_.jobs, {}, {}};
    options.progress = [&](std::uint64_t bytes) {
      bar.show(features_, share_done(features_, reader->feature_count(), bytes, std::nullopt));
    };
    const auto streamed = pipeline::stream_texts(
        *reader, options, [&](std::uint64_t, Result<formats::FeatureText> text) {
          auto mesh = std::make_shared<Meshed>(text ? mesh_of(*reader, *std::move(text))
                                                    : std::move(text).error());
          return [this, mesh]() -> Status {
            take(std::move(*mesh));
            return Done{};
          };
        });
    if (!streamed) return streamed.error();
    return Done{};
  }

  /// Writes the tileset to a new folder. Errors: unavailable with the reason.
  Status write();

  Exit exit() const { return unread_ == 0 && unfilled_ == 0 ? Exit::valid : Exit::invalid; }

 private:
  Status read_header(const Document& document) {
    header_.reset();
    shapes_.reset();
    if (!is_city_model(document.format)) return Done{};
    auto header = formats::read_city_json_header(document.header);
    if (!header) return std::move(header).error();
    auto shapes = formats::CityFeatureReader::make(document.header);
    if (!shapes) return std::move(shapes).error();
    header_ = *std::move(header);
    shapes_ = *std::move(shapes);
    return Done{};
  }

  /// Reads features one by one until one has a place, where the frame then is.
  Status find_frame(formats::FeatureReader& reader) {
    while (!frame_) {
      auto text = reader.next();
      if (!text) return std::move(text).error();
      if (!*text) return Done{};
      take(mesh_of(reader, **std::move(text)));
    }
    return Done{};
  }

  /// Makes the frame; one without a place on the Earth where there is no way to it.
  void make_frame(std::uint32_t srid, const Frame::Position& origin) {
    auto frame = Frame::at(srid, origin);
    if (!frame) {
      std::fprintf(stderr, "watertight: %s: the tileset has no place on the Earth: %s\n",
                   printable(file_).c_str(), printable(frame.error().message).c_str());
      frame = Frame::at(0, origin);
    }
    frame_ = *frame;
  }

  struct Shown {
    CityFeature city;
    std::uint32_t srid = 0;
  };

  /// A feature of a city model from its text alone. Errors have their place.
  Result<Shown> shown(const formats::FeatureReader& reader, formats::FeatureText& text) const {
    std::optional<std::string_view> lod;
    if (!command_.lod.empty()) lod = command_.lod;
    if (shapes_ && !text.ready) {
      auto city = shapes_->read(text.line, lod);
      if (!city) return formats::in_line(std::move(city).error(), text);
      return Shown{*std::move(city), header_->srid};
    }
    const auto feature = reader.read(text);
    if (!feature) return feature.error();
    if (!shapes_) return Shown{formats::city_feature_of(*feature), feature->srid};
    const auto line = formats::write_city_json_feature(*header_, *feature);
    auto city = line ? shapes_->read(*line, lod) : Result<CityFeature>(line.error());
    if (!city) return formats::at_place(std::move(city).error(), text.place, feature->id);
    return Shown{*std::move(city), feature->srid};
  }

  /// Errors have their place.
  Meshed mesh_of(const formats::FeatureReader& reader, formats::FeatureText text) {
    auto found = shown(reader, text);
    if (!found) return std::move(found).error();
    CityFeature& city = found->city;
    std::string id = city.id;
    if (city.is_too_large) {
      return formats::at_place(
          {ErrorCode::limit_exceeded, "the geometry has more vertices than are shown"}, text.place,
          id);
    }
    if (!frame_) {
      if (city.shapes.positions.empty()) return FeatureMesh{};
      make_frame(found->srid, city.shapes.positions.front());
    }
    std::string type = std::move(city.type);
    auto mesh = tiles::mesh_of(std::move(city), id, std::move(type), found->srid, *frame_);
    if (!mesh) return formats::at_place(std::move(mesh).error(), text.place, id);
    return mesh;
  }

  void take(Meshed mesh) {
    ++features_;
    if (!mesh) {
      ++unread_;
      complain(file_, mesh.error());
      return;
    }
    if (mesh->unfilled_facets > 0) {
      unfilled_ += mesh->unfilled_facets;
      complain(file_, {ErrorCode::limit_exceeded,
                       quantity(mesh->unfilled_facets, "facet is", "facets are") +
                           " not shown, whose edges cross too often, in '" + mesh->id + "'"});
    }
    if (!mesh->is_empty()) meshes_.push_back(*std::move(mesh));
  }

  Status write_contents(const fs::path& folder, const std::vector<tiles::Tile>& tree);

  const TilesCommand& command_;
  std::string file_;
  std::optional<formats::CityHeader> header_;  // of the document in work, if it is a city model
  std::optional<formats::CityFeatureReader> shapes_;
  std::optional<Frame> frame_;
  std::vector<FeatureMesh> meshes_;
  std::uint64_t features_ = 0;
  std::uint64_t unread_ = 0;
  std::uint64_t unfilled_ = 0;
};

Error cannot_write(const fs::path& path) {
  const int code = errno;
  return {ErrorCode::unavailable, path.string() + ": " + std::generic_category().message(code)};
}

Status write_new(const fs::path& path, ByteView bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) return cannot_write(path);
  return Done{};
}

Status TileRun::write_contents(const fs::path& folder, const std::vector<tiles::Tile>& tree) {
  for (const tiles::Tile& tile : tree) {
    std::error_code failure;
    fs::create_directories((folder / tiles::content_name(tile)).parent_path(), failure);
  }
  std::atomic<std::size_t> next{0};
  std::mutex lock;
  Status status = Done{};
  const auto work = [&] {
    for (std::size_t number = next++; number < tree.size(); number = next++) {
      const tiles::Tile& tile = tree[number];
      std::vector<const FeatureMesh*> features;
      for (const std::size_t item : tile.items) features.push_back(&meshes_[item]);
      const Bytes glb = tiles::write_glb(features, tiles::origin_of(tile), command_.compression);
      const Status written = write_new(folder / tiles::content_name(tile), glb);
      if (written) continue;
      const std::lock_guard guard(lock);
      status = written;
      next = tree.size();
    }
  };
  std::vector<std::thread> threads;
  for (std::size_t i = 1; i < command_.jobs; ++i) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  return status;
}

Status TileRun::write() {
  std::vector<tiles::TileItem> items;
  for (const FeatureMesh& mesh : meshes_) {
    const tiles::TileBox box = mesh.box();
    const auto number = -static_cast<std::int64_t>(items.size());  // the first of equal ones first
    items.push_back(
        {box, {box.diagonal(), number}, std::max<std::uint64_t>(1, mesh.triangle_count())});
  }
  const std::vector<tiles::Tile> tree = tiles::tile_tree(items);
  const fs::path target = command_.output;
  const fs::path folder = command_.output + ".partial";
  std::error_code failure;
  fs::create_directory(folder, failure);
  if (failure) return Error{ErrorCode::unavailable, folder.string() + ": " + failure.message()};
  Status written = write_contents(folder, tree);
  if (written) {
    const std::string json =
        tiles::tileset_json(tree, frame_.value_or(Frame()), tiles::content_name);
    written = write_new(folder / "tileset.json", as_bytes(json));
  }
  if (written) {
    fs::rename(folder, target, failure);
    if (failure)
      written = Error{ErrorCode::unavailable, target.string() + ": " + failure.message()};
  }
  if (!written) {
    fs::remove_all(folder, failure);
    return written;
  }
  std::printf("%s of %s in %s\n", quantity(meshes_.size(), "feature").c_str(),
              quantity(features_, "feature").c_str(), quantity(tree.size(), "tile").c_str());
  return Done{};
}

}  // namespace

Exit run(const TilesCommand& command) {
  std::error_code failure;
  if (fs::exists(command.output, failure)) {
    complain(command.output, {ErrorCode::invalid_argument, "is there already; -o makes a folder"});
    return Exit::error;
  }
  const std::vector<files::InputFile> inputs = list_inputs(command.files);
  TileRun tile_run(command);
  Exit exit = Exit::valid;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const Status added = tile_run.add(inputs[i], position_among(i + 1, inputs.size()));
    if (added) continue;
    complain(inputs[i].name, added.error());
    exit = Exit::error;
  }
  if (exit == Exit::error) {
    std::fputs("watertight: nothing was written\n", stderr);
    return exit;
  }
  const Status written = tile_run.write();
  if (!written) {
    complain("-o", written.error());
    return Exit::error;
  }
  return tile_run.exit();
}

}  // namespace watertight::cli
