// SPDX-License-Identifier: GPL-3.0-or-later
//
// The header of a PLY file: elements, their properties, and where the data start.
// Internal to formats/.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/bytes.h"
#include "base/result.h"

namespace watertight::formats {

enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// The number of bytes of a value.
std::size_t size_of(PlyType type);
bool is_integer(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;     // type of the value, or of the items of a list
  std::optional<PlyType> list_length;  // integer type of a list's length; nullopt for a single
                                       // value
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
  std::uint64_t offset = 0;  // start of the line that declares the element, bytes

  std::optional<std::size_t> property(std::string_view name) const;
};

enum class PlyEncoding : std::uint8_t { text, little_endian, big_endian };

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::text;
  std::vector<PlyElement> elements;
  std::size_t data_begin = 0;
};

/// Reads the header of a PLY file. Errors: malformed with byte offset; unsupported for versions
/// other than 1.0. Cost: linear in the header.
Result<PlyHeader> read_ply_header(ByteView bytes);

}  // namespace watertight::formats
