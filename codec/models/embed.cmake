# SPDX-License-Identifier: GPL-3.0-or-later
# cmake -DINPUT=model-1.bin -DOUTPUT=model_1.cpp -DNAME=kModel1 -P embed.cmake
# Writes a file of bytes as C++.
file(READ "${INPUT}" bytes HEX)
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
file(WRITE "${OUTPUT}" "#include <cstdint>
#include <span>
namespace watertight::codec {
namespace {
constexpr std::uint8_t kBytes[] = {${bytes}};
}
extern const std::span<const std::uint8_t> ${NAME};
const std::span<const std::uint8_t> ${NAME}(kBytes);
}
")
