// SPDX-License-Identifier: GPL-3.0-or-later
//
// Based on: Verbree & Si 2008, section 4.1: one bit per face, faces ordered by their nodes.
// Departures: the bits may be arithmetic coded. An even number of the faces around each edge is
// marked, nearly always none or two, so that the marks before often decide the next one.
#include "codec/mode_bitmap/face_marks.h"

#include <algorithm>
#include <array>
#include <tuple>

namespace watertight::codec::bitmap {
namespace {

/// Finds the faces on the convex hull, which belong to one tetrahedron instead of two.
std::vector<bool> find_hull(const delaunay::CanonicalDelaunay& delaunay) {
  std::vector<Triangle> sides;
  sides.reserve(delaunay.tetrahedra.size() * 4);
  for (geometry::Tetrahedron t : delaunay.tetrahedra) {
    std::sort(t.begin(), t.end());
    sides.push_back({t[0], t[1], t[2]});
    sides.push_back({t[0], t[1], t[3]});
    sides.push_back({t[0], t[2], t[3]});
    sides.push_back({t[1], t[2], t[3]});
  }
  std::sort(sides.begin(), sides.end());
  std::vector<bool> is_hull(delaunay.faces.size(), false);
  std::size_t side = 0;
  for (std::size_t face = 0; face < delaunay.faces.size(); ++face) {
    std::size_t count = 0;
    for (; side < sides.size() && sides[side] == delaunay.faces[face]; ++side) ++count;
    is_hull[face] = count == 1;
  }
  return is_hull;
}

/// The three edges of each face, as numbers of edges.
struct FaceEdges {
  std::vector<std::array<Index, 3>> edges_of;
  Index edge_count = 0;
};

FaceEdges number_edges(std::span<const Triangle> faces) {
  struct Use {
    Index from;
    Index to;
    Index face;
    Index edge;  // the index of the edge in its face: 0 to 2
  };
  std::vector<Use> uses;
  uses.reserve(faces.size() * 3);
  for (Index i = 0; i < faces.size(); ++i) {
    uses.push_back({faces[i][0], faces[i][1], i, 0});
    uses.push_back({faces[i][0], faces[i][2], i, 1});
    uses.push_back({faces[i][1], faces[i][2], i, 2});
  }
  std::sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) {
    return std::tie(a.from, a.to, a.face) < std::tie(b.from, b.to, b.face);
  });
  FaceEdges result;
  result.edges_of.resize(faces.size());
  for (std::size_t i = 0; i < uses.size(); ++i) {
    const bool is_new = i == 0 || uses[i].from != uses[i - 1].from || uses[i].to != uses[i - 1].to;
    if (is_new) ++result.edge_count;
    result.edges_of[uses[i].face][uses[i].edge] = result.edge_count - 1;
  }
  return result;
}

/// The models of the marks, and for each edge the counts that choose a model.
class MarkModels {
 public:
  explicit MarkModels(const delaunay::CanonicalDelaunay& delaunay)
      : edges_(number_edges(delaunay.faces)),
        is_hull_(find_hull(delaunay)),
        to_come_(edges_.edge_count, 0),
        marked_(edges_.edge_count, 0) {
    for (const auto& edges : edges_.edges_of) {
      for (const Index edge : edges) ++to_come_[edge];
    }
    for (std::size_t context = 0; context < models_.size(); ++context) {
      models_[context] = first_estimate(context);
    }
  }

  AdaptiveBit& model(std::size_t face) {
    bool is_forced = false;   // an edge has one marked face, and this face is its last
    bool is_blocked = false;  // an edge has two marked faces already
    bool is_alone = false;    // an edge has no marked face, and this face is its last
    std::size_t open = 0;     // number of edges with one marked face
    for (const Index edge : edges_.edges_of[face]) {
      const bool is_last = to_come_[edge] == 1;
      const bool is_open = marked_[edge] == 1;
      if (is_open) ++open;
      if (is_open && is_last) is_forced = true;
      if (marked_[edge] == 2) is_blocked = true;
      if (marked_[edge] == 0 && is_last) is_alone = true;
    }
    return models_[(is_forced ? 1U : 0U) | (is_blocked ? 2U : 0U) | (is_alone ? 4U : 0U) |
                   (is_hull_[face] ? 8U : 0U) | (open << 4U)];
  }

  void advance(std::size_t face, bool is_marked) {
    for (const Index edge : edges_.edges_of[face]) {
      --to_come_[edge];
      if (is_marked) ++marked_[edge];
    }
  }

 private:
  static AdaptiveBit first_estimate(std::size_t context) {
    const bool is_forced = (context & 1U) != 0;
    const bool is_blocked = (context & 2U) != 0;
    const bool is_alone = (context & 4U) != 0;
    const bool is_hull = (context & 8U) != 0;
    const std::size_t open = context >> 4U;
    if (is_forced && !is_blocked && !is_alone) return AdaptiveBit(64000, 6);
    if (is_blocked || is_alone) return is_forced ? AdaptiveBit(32768, 0) : AdaptiveBit(1500, 6);
    const std::uint32_t base = is_hull ? 40000U : 16000U;
    return AdaptiveBit(base + static_cast<std::uint32_t>(open) * 6000U, 1);
  }

  FaceEdges edges_;
  std::vector<bool> is_hull_;
  std::vector<Index> to_come_;  // edge -> faces around it whose mark is not coded yet
  std::vector<Index> marked_;   // edge -> marked faces around it so far
  std::array<AdaptiveBit, 64> models_;
};

Error malformed_marks() { return {ErrorCode::malformed, "truncated or malformed bitmap section"}; }

Bytes write_plain_marks(const std::vector<bool>& marks) {
  BitEncoder encoder(BitCoding::plain);
  AdaptiveBit unused;
  for (const bool mark : marks) encoder.bit(mark, unused);
  return std::move(encoder).finish();
}

Result<std::vector<bool>> read_plain_marks(ByteView section, std::size_t count) {
  if (section.size() != (count + 7) / 8) return malformed_marks();
  BitDecoder decoder(section, BitCoding::plain);
  AdaptiveBit unused;
  std::vector<bool> marks(count);
  for (std::size_t i = 0; i < count; ++i) marks[i] = decoder.bit(unused);
  if (!decoder.is_finished()) return malformed_marks();
  return marks;
}

}  // namespace

Bytes write_marks(BitCoding coding, const delaunay::CanonicalDelaunay& delaunay,
                  const std::vector<bool>& marks) {
  if (coding == BitCoding::plain) return write_plain_marks(marks);
  BitEncoder encoder(coding);
  MarkModels models(delaunay);
  for (std::size_t face = 0; face < marks.size(); ++face) {
    encoder.bit(marks[face], models.model(face));
    models.advance(face, marks[face]);
  }
  return std::move(encoder).finish();
}

Result<std::vector<bool>> read_marks(ByteView section, BitCoding coding,
                                     const delaunay::CanonicalDelaunay& delaunay) {
  if (coding == BitCoding::plain) return read_plain_marks(section, delaunay.faces.size());
  BitDecoder decoder(section, coding);
  MarkModels models(delaunay);
  std::vector<bool> marks(delaunay.faces.size());
  for (std::size_t face = 0; face < marks.size(); ++face) {
    marks[face] = decoder.bit(models.model(face));
    models.advance(face, marks[face]);
    if (decoder.failed()) return malformed_marks();
  }
  if (!decoder.is_finished()) return malformed_marks();
  return marks;
}

Bytes write_face_list(std::span<const Triangle> faces) {
  ByteWriter writer;
  writer.varint(faces.size());
  Index last = 0;
  for (const Triangle& face : faces) {
    writer.varint(face[0] - last);
    writer.varint(face[1] - face[0] - 1);
    writer.varint(face[2] - face[1] - 1);
    last = face[0];
  }
  return std::move(writer).bytes();
}

Result<std::vector<Triangle>> read_face_list(ByteView section, std::size_t vertex_count) {
  const Error malformed{ErrorCode::malformed, "truncated or malformed list of unrecovered faces"};
  ByteReader reader(section);
  const std::uint64_t count = reader.varint();
  if (reader.failed() || count > reader.remaining() / 3) return malformed;
  std::vector<Triangle> faces;
  faces.reserve(static_cast<std::size_t>(count));
  std::uint64_t last = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t steps[3] = {reader.varint(), reader.varint(), reader.varint()};
    for (const std::uint64_t step : steps) {
      if (step >= vertex_count) return malformed;
    }
    const std::uint64_t a = last + steps[0];
    const std::uint64_t b = a + steps[1] + 1;
    const std::uint64_t c = b + steps[2] + 1;
    if (reader.failed() || c >= vertex_count) return malformed;
    faces.push_back({static_cast<Index>(a), static_cast<Index>(b), static_cast<Index>(c)});
    if (i > 0 && !(faces[faces.size() - 2] < faces.back())) return malformed;
    last = a;
  }
  if (reader.remaining() != 0) return malformed;
  return faces;
}

}  // namespace watertight::codec::bitmap
