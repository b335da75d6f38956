// SPDX-License-Identifier: GPL-3.0-or-later
//
// Boundary representations in JSON: every solid is a feature. Source: docs/formats.md and
// docs/schema/brep-1.schema.json.
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "formats/curved/brep_geometry.h"
#include "formats/curved/curved_files.h"
#include "formats/curved/curved_solid.h"

namespace watertight::formats {
namespace {

constexpr std::int64_t kGreatestSrid = 999'999;  // as in PostGIS

/// Reads one solid, in the unit of its document.
class BrepSolidReader {
 public:
  BrepSolidReader(const BrepValue& from, const Limits& limits) : from_(from), limits_(limits) {}

  Result<surfaces::BoundaryRepresentation> read() {
    if (!from_.json.is_object()) return from_.wrong("an object should stand here");
    if (Status status = vertices(); !status) return status.error();
    if (Status status = edges(); !status) return status.error();
    if (Status status = faces(); !status) return status.error();
    if (Status status = shells(); !status) return status.error();
    return std::move(solid_);
  }

 private:
  Result<BrepValue> list(std::string_view key, std::uint64_t most) const {
    auto found = from_.array(key);
    if (found && found->json.size() > most) {
      return Error{ErrorCode::limit_exceeded,
                   std::to_string(found->json.size()) + " in one solid; the limit is " +
                       std::to_string(most),
                   {},
                   found->pointer};
    }
    return found;
  }

  static Result<Index> index(const BrepValue& value, std::size_t size) {
    const auto number = value.whole(0, static_cast<std::int64_t>(size) - 1);
    if (!number) return number.error();
    return static_cast<Index>(*number);
  }

  Status vertices() {
    const auto points = list("vertices", limits_.vertices);
    if (!points) return points.error();
    for (std::size_t i = 0; i < points->json.size(); ++i) {
      const auto place = points->at(i).point();
      if (!place) return place.error();
      solid_.vertices.push_back(*place);
    }
    return Done{};
  }

  Status edges() {
    const auto all = list("edges", limits_.vertices);
    if (!all) return all.error();
    for (std::size_t i = 0; i < all->json.size(); ++i) {
      if (Status status = edge(all->at(i)); !status) return status;
    }
    return Done{};
  }

  Status edge(const BrepValue& from) {
    const auto ends = from.array("vertices", 2);
    if (!ends) return ends.error();
    if (ends->json.size() != 2) return ends->wrong("an edge has two vertices");
    surfaces::BoundaryEdge edge;
    for (const std::size_t end : {0, 1}) {
      const auto vertex = index(ends->at(end), solid_.vertices.size());
      if (!vertex) return vertex.error();
      (end == 0 ? edge.start : edge.end) = *vertex;
    }
    if (from.has("curve")) {
      auto curve = curve_in(*from.member("curve"));
      if (!curve) return curve.error();
      edge.curve = *std::move(curve);
    }
    const auto is_reversed = from.flag("reversed");
    if (!is_reversed) return is_reversed.error();
    edge.is_along_curve = !*is_reversed;
    solid_.edges.push_back(std::move(edge));
    return Done{};
  }

  Status faces() {
    const auto all = list("faces", limits_.facets);
    if (!all) return all.error();
    for (std::size_t i = 0; i < all->json.size(); ++i) {
      if (Status status = face(all->at(i)); !status) return status;
    }
    return Done{};
  }

  Status face(const BrepValue& from) {
    surfaces::BoundaryFace face;
    face.name = "face " + std::to_string(solid_.faces.size());
    if (from.has("surface")) {
      auto surface = surface_in(*from.member("surface"));
      if (surface) {
        face.surface = *std::move(surface);
      } else if (surface.error().code == ErrorCode::unsupported) {
        face.unreadable = surface.error().message;
      } else {
        return surface.error();
      }
    }
    const auto is_reversed = from.flag("reversed");
    if (!is_reversed) return is_reversed.error();
    face.is_along_surface = !*is_reversed;
    const auto loops = from.array("loops");
    if (!loops) return loops.error();
    if (loops->json.empty()) face.unreadable = "the face has no loop";
    for (std::size_t i = 0; i < loops->json.size(); ++i) {
      auto read = loop(loops->at(i));
      if (!read) return read.error();
      face.loops.push_back(*std::move(read));
    }
    face.outer = 0;
    solid_.faces.push_back(std::move(face));
    return Done{};
  }

  /// Edges in turn: i runs forward, -1 - i backward.
  Result<surfaces::EdgeLoop> loop(const BrepValue& from) const {
    if (!from.json.is_array() || from.json.empty())
      return from.wrong("a loop is an array of edges");
    const auto count = static_cast<std::int64_t>(solid_.edges.size());
    surfaces::EdgeLoop loop;
    for (std::size_t i = 0; i < from.json.size(); ++i) {
      const auto number = from.at(i).whole(-count, count - 1);
      if (!number) return number.error();
      const std::int64_t edge = *number < 0 ? -1 - *number : *number;
      loop.push_back({static_cast<Index>(edge), *number >= 0});
    }
    for (std::size_t i = 0; i < loop.size(); ++i) {
      if (end_of(loop[i]) != start_of(loop[(i + 1) % loop.size()])) {
        return from.at(i).wrong("the edge does not end where the next one starts");
      }
    }
    return loop;
  }

  Index start_of(const surfaces::OrientedEdge& oriented) const {
    const surfaces::BoundaryEdge& edge = solid_.edges[oriented.edge];
    return oriented.is_forward ? edge.start : edge.end;
  }
  Index end_of(const surfaces::OrientedEdge& oriented) const {
    return start_of({oriented.edge, !oriented.is_forward});
  }

  /// Without shells, all faces are one.
  Status shells() {
    if (!from_.has("shells")) {
      std::vector<Index>& shell = solid_.shells.emplace_back();
      for (Index face = 0; face < solid_.faces.size(); ++face) shell.push_back(face);
      return Done{};
    }
    const auto all = list("shells", limits_.shells);
    if (!all) return all.error();
    std::vector<bool> is_used(solid_.faces.size());
    for (std::size_t i = 0; i < all->json.size(); ++i) {
      const BrepValue from = all->at(i);
      if (!from.json.is_array()) return from.wrong("a shell is an array of faces");
      std::vector<Index>& shell = solid_.shells.emplace_back();
      for (std::size_t k = 0; k < from.json.size(); ++k) {
        const auto face = index(from.at(k), solid_.faces.size());
        if (!face) return face.error();
        if (is_used[*face]) return from.at(k).wrong("the face is in a shell already");
        is_used[*face] = true;
        shell.push_back(*face);
      }
    }
    return Done{};
  }

  const BrepValue& from_;
  const Limits& limits_;
  surfaces::BoundaryRepresentation solid_;
};

class BrepReader {
 public:
  BrepReader(std::size_t bytes, const ReadOptions& options)
      : options_(options), budget_(options.limits.claimed_by(bytes)) {}

  Result<Document> read(const BrepValue& root) {
    document_.format = Format::brep;
    if (string_member(root.json, "type") != "BRep") {
      return root.wrong("the document is no object of the type \"BRep\"");
    }
    surfaces::Affine placement;
    if (root.has("unit")) {
      const auto metres = root.positive("unit");
      if (!metres) return metres.error();
      placement.columns = {{{*metres, 0, 0}, {0, *metres, 0}, {0, 0, *metres}}};
      metre_ = *metres;
    }
    std::uint32_t srid = 0;
    if (root.has("srid")) {
      const auto code = root.member("srid")->whole(0, kGreatestSrid);
      if (!code) return code.error();
      srid = static_cast<std::uint32_t>(*code);
    }
    const auto solids = root.array("solids");
    if (!solids) return solids.error();
    for (std::size_t i = 0; i < solids->json.size(); ++i) {
      if (Status status = solid(solids->at(i), placement, srid); !status) return status.error();
    }
    if (document_.features.empty()) document_.notes.push_back("the document has no solid");
    return std::move(document_);
  }

 private:
  Status solid(const BrepValue& from, const surfaces::Affine& placement, std::uint32_t srid) {
    const std::string id = string_member(from.json, "id");
    auto boundary = BrepSolidReader(from, options_.limits).read();
    if (boundary && from.has("tolerance")) {
      const auto tolerance = from.positive("tolerance");
      if (!tolerance) return tolerance.error();
      boundary->tolerance = *tolerance * metre_;
    }
    Feature& feature = document_.features.emplace_back();
    feature.id = id;
    feature.srid = srid;
    return add_curved_solid(std::move(boundary),
                            {placement, srid, SolidSource{id, "BRep", "", 0, 0, from.pointer}},
                            options_, budget_, feature);
  }

  const ReadOptions& options_;
  std::uint64_t budget_;  // add_curved_solid()
  double metre_ = 1;      // metres of a unit
  Document document_;
};

}  // namespace

Result<Document> read_brep(std::string_view text, const ReadOptions& options) {
  const auto root = parse_json(text, options.limits);
  if (!root) return root.error();
  return BrepReader(text.size(), options).read({*root, ""});
}

}  // namespace watertight::formats
