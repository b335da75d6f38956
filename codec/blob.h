// SPDX-License-Identifier: GPL-3.0-or-later
//
// The public codec: a ValidSolid to a blob and back (docs/format.md, design section 5).
// Source: Verbree & Si 2008, section 4.1, decomposition steps 1-7 and composition steps 1-7.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/bytes.h"
#include "base/limits.h"
#include "delaunay/certificate.h"
#include "geometry/valid_solid.h"

namespace watertight {

inline constexpr std::uint8_t kFormatVersion = 0;

enum class Mode : std::uint8_t { automatic = 255, raw = 0, bitmap = 1 };
std::string_view to_string(Mode mode);

struct EncodeOptions {
  Mode mode = Mode::automatic;  // the smaller of raw and bitmap
  bool keep_order = true;       // write the order section: decode returns the source order
  /// With a certificate and mode bitmap: store its Steiner vertices (the paper's setting).
  const Certificate* certificate = nullptr;
};

/// Encodes, decodes, compares, and only then returns (verify-after-write).
/// Errors: not_encodable if the mode cannot hold the solid (automatic always can).
Result<Bytes> encode(const ValidSolid& solid, const EncodeOptions& options = {});

/// Bytes of each part of a blob, for `info` and `bench/ratio`.
struct BlobInfo {
  std::uint8_t version = 0;
  Mode mode = Mode::raw;
  Acceptance acceptance;
  std::uint32_t srid = 0;
  Lattice lattice;
  Index vertices = 0;
  Index steiner_vertices = 0;
  Index facets = 0;
  Index rings = 0;
  Index shells = 0;
  Index delaunay_faces = 0;  // bits of the bitmap
  Index marked_faces = 0;
  Index unrecovered_faces = 0;
  bool has_order = false;
  struct Part {
    std::string name;
    std::size_t bytes = 0;
  };
  std::vector<Part> parts;
  std::uint32_t checksum = 0;  // CRC-32C over the decoded canonical solid
};

struct Decoded {
  Solid solid;  // in source order if the blob has an order section, else canonical
  BlobInfo info;
};

/// Trusts nothing: caps before allocation, bounded loops, structural checks, checksum. A blob that
/// decodes is a well-formed oriented boundary, not proven valid: validate when the source is not
/// trusted. Errors: malformed (with byte offset), unsupported (version, mode), limit_exceeded.
Result<Decoded> decode(ByteView blob, const Limits& limits = {});

/// Header and part sizes. Same errors.
Result<BlobInfo> describe(ByteView blob, const Limits& limits = {});

}  // namespace watertight
