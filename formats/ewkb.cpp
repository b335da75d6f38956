// SPDX-License-Identifier: GPL-3.0-or-later
//
// Well-known binary as PostGIS extends it: the type word carries flags for Z, M and SRID. Types of
// ISO, with thousands instead of flags (1015), are read too. docs/formats.md gives the layout of a
// SOLID Z.
#include "formats/ewkb.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

#include "formats/mesh/mesh_text.h"
#include "formats/surface.h"

namespace watertight::formats {
namespace {

constexpr std::uint32_t kHasZ = 0x80000000;
constexpr std::uint32_t kHasM = 0x40000000;
constexpr std::uint32_t kHasSrid = 0x20000000;
constexpr std::uint32_t kPolygon = 3;
constexpr std::uint32_t kMultiPolygon = 6;
constexpr std::uint32_t kPolyhedralSurface = 15;
constexpr std::uint32_t kTin = 16;
constexpr std::uint32_t kTriangle = 17;
constexpr std::uint32_t kSolid = 101;  // the number that SFCGAL gives its Solid; PostGIS has none

constexpr std::uint32_t kFacetsBetweenPolls = 4096;

/// Leaves each point once, at the place of the first of its kind, and numbers them anew in
/// `ring_vertices`, which has the numbers of all points in order.
void merge_equal(std::vector<std::array<double, 3>>& points, std::vector<Index>& ring_vertices) {
  std::vector<Index> by_place(points.size());
  std::iota(by_place.begin(), by_place.end(), Index{0});
  std::sort(by_place.begin(), by_place.end(), [&](Index a, Index b) {
    return points[a] != points[b] ? points[a] < points[b] : a < b;
  });
  std::vector<Index> first(points.size());
  for (std::size_t i = 0; i < by_place.size(); ++i) {
    const bool is_same = i > 0 && points[by_place[i]] == points[by_place[i - 1]];
    first[by_place[i]] = is_same ? first[by_place[i - 1]] : by_place[i];
  }
  Index count = 0;
  std::vector<Index>& number = by_place;  // of points that are the first of their kind
  for (Index i = 0; i < points.size(); ++i) {
    if (first[i] == i) {
      number[i] = count;
      points[count++] = points[i];
    }
    ring_vertices[i] = number[first[i]];
  }
  points.resize(count);
}

class EwkbReader {
 public:
  EwkbReader(ByteView bytes, const Limits& limits) : reader_(bytes), limits_(limits) {}

  std::size_t position() const { return reader_.position(); }
  bool is_at_end() const { return reader_.remaining() == 0; }

  Result<SubmittedSolid> read() {
    arrays_ = {};
    positions_.clear();
    srid_ = 0;
    auto type = head();
    if (!type) return std::move(type).error();
    if (*type != kPolyhedralSurface && *type != kSolid && *type != kTin) {
      return Error{ErrorCode::unsupported,
                   "geometry type " + std::to_string(*type) +
                       " is not a POLYHEDRALSURFACE Z, SOLID Z or TIN Z",
                   position(),
                   {}};
    }
    auto status = *type == kSolid ? shells() : shell();
    if (!status) return status.error();
    merge_equal(positions_, arrays_.ring_vertices);
    if (limits_.is_cancelled()) return Error{ErrorCode::cancelled, "the reading was cancelled"};
    auto points = geometry::lattice_of_doubles(positions_);
    if (!points) return std::move(points).error();
    const char* name = *type == kSolid ? "SOLID Z"
                       : *type == kTin ? "TIN Z"
                                       : "POLYHEDRALSURFACE Z";
    return solid_of_points(std::move(arrays_), *points, SolidSource{"", name, "", 0, 0, ""}, srid_,
                           limits_);
  }

 private:
  Error wrong(std::string message) const {
    return Error{ErrorCode::malformed, std::move(message), position(), {}};
  }

  std::uint32_t u32() {
    const std::uint32_t value = reader_.u32();
    return is_big_endian_ ? __builtin_bswap32(value) : value;
  }

  double f64() {
    const std::uint64_t bits = reader_.u64();
    return std::bit_cast<double>(is_big_endian_ ? __builtin_bswap64(bits) : bits);
  }

  // Reads byte order, type with flags, and SRID. Returns the type without flags.
  Result<std::uint32_t> head() {
    const std::uint8_t order = reader_.u8();
    if (reader_.failed()) return reader_.error("geometry");
    if (order > 1) return wrong("the byte order is neither 0 nor 1");
    is_big_endian_ = order == 0;
    std::uint32_t type = u32();
    if (reader_.failed()) return reader_.error("geometry type");
    bool has_z = (type & kHasZ) != 0;
    const bool has_srid = (type & kHasSrid) != 0;
    bool has_m = (type & kHasM) != 0;
    type &= ~(kHasZ | kHasM | kHasSrid);
    if (type >= 1000 && type < 4000) {
      has_z = has_z || type / 1000 != 2;
      has_m = has_m || type / 1000 != 1;
      type %= 1000;
    }
    if (has_m) {
      return Error{ErrorCode::unsupported, "measured coordinates (M) are not read", position(), {}};
    }
    if (has_srid) srid_ = u32();
    if (reader_.failed()) return reader_.error("SRID");
    if (srid_ > 999'999'999) return wrong("SRID is out of range");
    if (!has_z) return wrong("the geometry has no z coordinates");
    return type;
  }

  // Reads a number of elements, which take at least `least` bytes each.
  Result<std::uint32_t> count(std::size_t least, const char* what) {
    const std::uint32_t value = u32();
    if (reader_.failed()) return reader_.error(what);
    if (value > reader_.remaining() / least) {
      return wrong("more " + std::string(what) + " than the bytes can hold");
    }
    return value;
  }

  Status shells() {
    auto shell_count = count(9, "shells");
    if (!shell_count) return std::move(shell_count).error();
    if (*shell_count > limits_.shells) {
      return Error{ErrorCode::limit_exceeded, "more shells than the limit", position(), {}};
    }
    for (std::uint32_t i = 0; i < *shell_count; ++i) {
      auto type = head();
      if (!type) return std::move(type).error();
      if (*type != kPolyhedralSurface) return wrong("a shell is not a POLYHEDRALSURFACE Z");
      if (auto status = shell(); !status) return status;
    }
    if (*shell_count == 0) arrays_.end_shell();  // no shells are read as one empty shell
    return Done{};
  }

  Status shell() {
    auto polygon_count = count(9, "polygons");
    if (!polygon_count) return std::move(polygon_count).error();
    for (std::uint32_t i = 0; i < *polygon_count; ++i) {
      if (i % kFacetsBetweenPolls == 0 && limits_.is_cancelled()) {
        return Error{ErrorCode::cancelled, "the reading was cancelled"};
      }
      auto type = head();
      if (!type) return std::move(type).error();
      if (*type != kPolygon && *type != kTriangle) return wrong("a facet is not a POLYGON Z");
      if (auto status = polygon(); !status) return status;
    }
    arrays_.end_shell();
    return Done{};
  }

  Status polygon() {
    auto ring_count = count(4, "rings");
    if (!ring_count) return std::move(ring_count).error();
    for (std::uint32_t i = 0; i < *ring_count; ++i) {
      if (auto status = ring(); !status) return status;
    }
    arrays_.end_facet();
    return Done{};
  }

  Status ring() {
    auto point_count = count(24, "points");
    if (!point_count) return std::move(point_count).error();
    const std::size_t first = positions_.size();
    if (first + *point_count > 8 * limits_.vertices || first + *point_count >= kNone) {
      return Error{ErrorCode::limit_exceeded, "more points than the limit", position(), {}};
    }
    for (std::uint32_t i = 0; i < *point_count; ++i) {
      std::array<double, 3> p{};
      for (double& axis : p) {
        axis = f64();
        if (!std::isfinite(axis)) return wrong("a coordinate is not a finite number");
      }
      positions_.push_back(p);
    }
    if (reader_.failed()) return reader_.error("ring");
    if (*point_count == 1 || (*point_count > 1 && positions_.back() != positions_[first])) {
      return wrong("the ring is not closed: its last point must be its first");
    }
    // The last point repeats the first and is dropped. A ring without points is read: the validator
    // reports it.
    if (*point_count > 0) positions_.pop_back();
    for (std::size_t i = first; i < positions_.size(); ++i) {
      arrays_.ring_vertices.push_back(static_cast<Index>(i));
    }
    arrays_.end_ring();
    return Done{};
  }

  ByteReader reader_;
  const Limits& limits_;
  bool is_big_endian_ = false;
  std::uint32_t srid_ = 0;
  SolidArrays arrays_;
  std::vector<std::array<double, 3>> positions_;
};

void write_head(ByteWriter& out, std::uint32_t type, std::uint32_t srid) {
  out.u8(1);
  out.u32(type | kHasZ | (srid != 0 ? kHasSrid : 0));
  if (srid != 0) out.u32(srid);
}

void write_ring(ByteWriter& out, const Solid& solid, Index ring) {
  const auto vertices = solid.ring(ring);
  const auto write_point = [&](Index vertex) {
    for (const double axis : solid.world(vertex)) out.f64(axis);
  };
  out.u32(static_cast<std::uint32_t>(vertices.empty() ? 0 : vertices.size() + 1));
  for (const Index vertex : vertices) write_point(vertex);
  if (!vertices.empty()) write_point(vertices.front());
}

void write_facets(ByteWriter& out, const Solid& solid, IndexRange facets) {
  out.u32(facets.size());
  for (Index facet = facets.begin; facet < facets.end; ++facet) {
    write_head(out, kPolygon, 0);
    const IndexRange rings = solid.rings_of(facet);
    out.u32(rings.size());
    for (Index ring = rings.begin; ring < rings.end; ++ring) write_ring(out, solid, ring);
  }
}

void write_shell(ByteWriter& out, const Solid& solid, Index shell, std::uint32_t srid) {
  write_head(out, kPolyhedralSurface, srid);
  write_facets(out, solid, solid.facets_of(shell));
}

}  // namespace

Result<SubmittedSolid> read_ewkb(ByteView bytes, const Limits& limits) {
  if (bytes.size() > limits.bytes) {
    return Error{ErrorCode::limit_exceeded, "the geometry is longer than the limit"};
  }
  EwkbReader reader(bytes, limits);
  auto solid = reader.read();
  if (solid && !reader.is_at_end()) {
    return Error{ErrorCode::malformed, "bytes after the geometry", reader.position(), {}};
  }
  return solid;
}

Result<Document> read_ewkb_document(ByteView bytes, const Limits& limits) {
  return document_of_geometries(EwkbReader(bytes, limits), Format::ewkb);
}

Bytes write_ewkb(const Solid& solid) {
  ByteWriter out;
  if (solid.shell_count() == 1) {
    write_shell(out, solid, 0, solid.srid());
  } else if (solid.shell_count() == 0) {
    write_head(out, kPolyhedralSurface, solid.srid());
    out.u32(0);
  } else {
    write_head(out, kSolid, solid.srid());
    out.u32(solid.shell_count());
    for (Index shell = 0; shell < solid.shell_count(); ++shell) write_shell(out, solid, shell, 0);
  }
  return std::move(out).bytes();
}

Bytes write_ewkb_of_boundary(const Solid& solid) {
  ByteWriter out;
  write_head(out, kMultiPolygon, solid.srid());
  write_facets(out, solid, {0, solid.facet_count()});
  return std::move(out).bytes();
}

}  // namespace watertight::formats
