// SPDX-License-Identifier: GPL-3.0-or-later
//
// The layout of the messages:
//   job:     u8 Constraints | u32 vertices, then 3 f64 each | u32 triangles, then 4 u32 each (three
//            vertices, facet)
//   answer:  u8 1 | f64 CPU seconds | u32 Steiner points, then 3 f64 each | u32 tetrahedra, then 4
//            u32 each | u32 constrained faces, then 4 u32 each
//        or  u8 0 | f64 CPU seconds | text of the refusal
#include "delaunay/cdt_frames.h"

#include <algorithm>
#include <cmath>

namespace watertight::delaunay {
namespace {

/// The longest CPU time of an engine that is believed, in seconds.
constexpr double kLongestEngineTime = 1e9;

void write_points(ByteWriter& writer, const Point* begin, const Point* end) {
  writer.u32(static_cast<std::uint32_t>(end - begin));
  for (const Point* p = begin; p != end; ++p) {
    writer.f64(p->x);
    writer.f64(p->y);
    writer.f64(p->z);
  }
}

/// Reads a count of records of `size` bytes, never more than the bytes left can hold.
std::size_t read_count(ByteReader& reader, std::size_t size, bool& is_wrong) {
  const std::size_t count = reader.u32();
  if (count > reader.remaining() / size) {
    is_wrong = true;
    return 0;
  }
  return count;
}

bool read_points(ByteReader& reader, std::vector<Point>& points) {
  bool is_wrong = false;
  const std::size_t count = read_count(reader, 24, is_wrong);
  points.reserve(points.size() + count);
  for (std::size_t i = 0; i < count; ++i) {
    Point p{reader.f64(), reader.f64(), reader.f64()};
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) is_wrong = true;
    points.push_back(p);
  }
  return !is_wrong;
}

template <std::size_t size>
bool read_indices(ByteReader& reader, std::array<Index, size>& indices, std::size_t limit) {
  bool is_right = true;
  for (Index& index : indices) {
    index = reader.u32();
    is_right = is_right && index < limit;
  }
  return is_right;
}

Error malformed(const ByteReader& reader, const char* what) {
  return Error{ErrorCode::malformed, what, reader.position()};
}

}  // namespace

Bytes write_job(const CdtJob& job) {
  const PiecewiseLinearComplex& complex = job.complex;
  ByteWriter writer;
  writer.u8(static_cast<std::uint8_t>(job.constraints));
  write_points(writer, complex.vertices.data(), complex.vertices.data() + complex.vertices.size());
  writer.u32(static_cast<std::uint32_t>(complex.triangles.size()));
  for (std::size_t t = 0; t < complex.triangles.size(); ++t) {
    for (const Index vertex : complex.triangles[t]) writer.u32(vertex);
    writer.u32(complex.facet_of[t]);
  }
  return std::move(writer).bytes();
}

Result<CdtJob> read_job(ByteView bytes) {
  ByteReader reader(bytes);
  CdtJob job;
  const std::uint8_t constraints = reader.u8();
  if (constraints > 1) return malformed(reader, "unknown kind of constraints");
  job.constraints = static_cast<Constraints>(constraints);
  PiecewiseLinearComplex& complex = job.complex;
  if (!read_points(reader, complex.vertices))
    return malformed(reader, "malformed vertices of a job");
  bool is_wrong = false;
  const std::size_t count = read_count(reader, 16, is_wrong);
  Index facet_count = 0;
  for (std::size_t t = 0; t < count && !is_wrong; ++t) {
    Triangle triangle{};
    is_wrong = !read_indices(reader, triangle, complex.vertices.size());
    const Index facet = reader.u32();
    // Facets come in order and none is left out.
    is_wrong = is_wrong || facet > facet_count || facet + 1 < facet_count;
    if (facet == facet_count) ++facet_count;
    complex.triangles.push_back(triangle);
    complex.facet_of.push_back(facet);
  }
  if (is_wrong) return malformed(reader, "malformed triangles of a job");
  if (reader.failed() || reader.remaining() != 0) return malformed(reader, "job of a wrong length");
  return job;
}

Bytes write_answer(const CdtAnswer& answer) {
  ByteWriter writer;
  if (!answer.tetrahedralization) {
    writer.u8(0);
    writer.f64(answer.engine_seconds);
    writer.append(as_bytes(answer.refusal));
    return std::move(writer).bytes();
  }
  const Tetrahedralization& result = *answer.tetrahedralization;
  writer.u8(1);
  writer.f64(answer.engine_seconds);
  write_points(writer, result.points.data() + result.input_count,
               result.points.data() + result.points.size());
  writer.u32(static_cast<std::uint32_t>(result.tetrahedra.size()));
  for (const geometry::Tetrahedron& tetrahedron : result.tetrahedra) {
    for (const Index vertex : tetrahedron) writer.u32(vertex);
  }
  writer.u32(static_cast<std::uint32_t>(result.constrained.size()));
  for (const ConstrainedFace& face : result.constrained) {
    for (const Index vertex : face.vertices) writer.u32(vertex);
    writer.u32(face.facet);
  }
  return std::move(writer).bytes();
}

Result<CdtAnswer> read_answer(ByteView bytes, const std::vector<Point>& vertices,
                              Index facet_count) {
  ByteReader reader(bytes);
  CdtAnswer answer;
  const std::uint8_t is_success = reader.u8();
  answer.engine_seconds = reader.f64();
  // Not "<": a time that is not a number must fail.
  const bool has_time = answer.engine_seconds >= 0 && answer.engine_seconds <= kLongestEngineTime;
  if (reader.failed() || is_success > 1 || !has_time) {
    return malformed(reader, "malformed answer of an engine");
  }
  if (is_success == 0) {
    answer.refusal = std::string(as_text(reader.take(reader.remaining())));
    return answer;
  }
  Tetrahedralization result;
  result.points = vertices;
  result.input_count = static_cast<Index>(vertices.size());
  if (!read_points(reader, result.points)) return malformed(reader, "malformed Steiner points");
  bool is_wrong = false;
  std::size_t count = read_count(reader, 16, is_wrong);
  for (std::size_t i = 0; i < count && !is_wrong; ++i) {
    is_wrong = !read_indices(reader, result.tetrahedra.emplace_back(), result.points.size());
  }
  if (is_wrong) return malformed(reader, "malformed tetrahedra");
  count = read_count(reader, 16, is_wrong);
  for (std::size_t i = 0; i < count && !is_wrong; ++i) {
    ConstrainedFace& face = result.constrained.emplace_back();
    is_wrong = !read_indices(reader, face.vertices, result.points.size());
    face.facet = reader.u32();
    is_wrong = is_wrong || face.facet >= facet_count;
  }
  if (is_wrong) return malformed(reader, "malformed constrained faces");
  if (reader.failed() || reader.remaining() != 0)
    return malformed(reader, "answer of a wrong length");
  answer.tetrahedralization = std::move(result);
  return answer;
}

}  // namespace watertight::delaunay
