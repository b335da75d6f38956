// SPDX-License-Identifier: GPL-3.0-or-later
//
// The public codec: a ValidSolid to a blob and back (docs/codec.md; the bytes:
// docs/format.md).
// Source: Verbree & Si 2008, section 4.1, decomposition steps 1-7 and composition steps 1-7.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/bytes.h"
#include "base/cancel.h"
#include "base/limits.h"
#include "geometry/valid_solid.h"

namespace watertight::delaunay {
struct Certificate;
}  // namespace watertight::delaunay

namespace watertight::codec {

inline constexpr std::uint8_t kFormatVersion = 1;

/// The set of priors that encoders use if their options name no other; 0 is the neutral one.
inline constexpr std::uint8_t kModelNumber = 1;

enum class Mode : std::uint8_t {
  raw = 0,            // vertices and rings listed
  bitmap = 1,         // the paper's mode: a bit for each face of the Delaunay tetrahedralization
  walk = 2,           // columns, then a walk over Delaunay faces
  polygon = 3,        // a walk over the facets, then coordinates by planes and right angles
  parallelogram = 5,  // triangles along a front, each vertex predicted from those around it
  automatic = 255     // the mode with the fewest bytes among those that can hold the solid
};
std::string_view to_string(Mode mode);

struct EncodeOptions {
  Mode mode = Mode::automatic;
  bool keep_order = true;              // true: decode() returns the solid in its source order
  std::uint8_t models = kModelNumber;  // the set of priors (codec/page/model_sets.h)
  /// A certificate whose Steiner vertices mode bitmap stores (the paper's setting), or null.
  const delaunay::Certificate* certificate = nullptr;
  const CancelPoll* cancel = nullptr;  // ends the work; null: nothing does
};

/// Encodes a solid, decodes the bytes, compares, and only then returns them (verify-after-write).
/// Errors: not_encodable if the mode cannot hold the solid (automatic always can); cancelled.
Result<Bytes> encode(const ValidSolid& solid, const EncodeOptions& options = {});

/// The header and the counts of a blob and the sizes of its parts, for `info` and `bench/ratio`.
struct BlobInfo {
  std::uint8_t version = 0;
  std::uint8_t models = 0;  // the number of the set of priors; 0: neutral
  Mode mode = Mode::raw;
  Acceptance acceptance;
  std::uint32_t srid = 0;
  Lattice lattice;
  Index vertices = 0;
  Index steiner_vertices = 0;
  Index facets = 0;
  Index rings = 0;
  Index shells = 0;
  Index delaunay_faces = 0;  // the number of bits of the bitmap (mode bitmap)
  Index marked_faces = 0;
  Index unrecovered_faces = 0;
  bool has_order = false;
  struct Part {
    std::string name;
    /// The size of this part in bytes, rounded to 0.01: parts may share a byte.
    double bytes = 0;
  };
  std::vector<Part> parts;
  std::uint32_t checksum = 0;  // the checksum of the blob, or of the whole page
};

struct Decoded {
  Solid solid;  // in source order if the blob holds that, else in canonical form
  BlobInfo info;
};

/// Decodes a blob. Trusts nothing: checks limits before it allocates, bounds every loop, checks the
/// structure and the checksum. A blob that decodes is a well-formed oriented boundary, not proven
/// valid: validate when the source is not trusted. Errors: malformed (with byte offset),
/// unsupported (version, mode), limit_exceeded, cancelled.
Result<Decoded> decode(ByteView blob, const Limits& limits = {});

/// Decodes a blob and returns its description only. Errors: those of decode().
Result<BlobInfo> describe(ByteView blob, const Limits& limits = {});

}  // namespace watertight::codec

namespace watertight {

using codec::decode;
using codec::Decoded;
using codec::encode;
using codec::EncodeOptions;
using codec::Mode;

}  // namespace watertight
