# SPDX-License-Identifier: GPL-3.0-or-later
# cmake -DINPUT=page.css -DOUTPUT=page.css.cpp -DNAMESPACE=watertight::report -DNAME=kPageStyle
#   -DKIND=TEXT -P embed.cmake
# Writes a file as a constant of C++: BYTES as std::span<const std::uint8_t>, TEXT as
# std::string_view, which leaves out the comment at the head of the file.
if(KIND STREQUAL "TEXT")
  file(READ "${INPUT}" text)
  string(REGEX REPLACE "^((//[^\n]*|/[*][^*]*[*]/)\n)+" "" text "${text}")
  file(WRITE "${OUTPUT}" "#include <string_view>
namespace ${NAMESPACE} {
using namespace std::string_view_literals;
extern const std::string_view ${NAME};
constinit const std::string_view ${NAME} = R\"embedded(${text})embedded\"sv;
}
")
else()
  file(READ "${INPUT}" bytes HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
  file(WRITE "${OUTPUT}" "#include <cstdint>
#include <span>
namespace ${NAMESPACE} {
namespace {
constexpr std::uint8_t kBytes[] = {${bytes}};
}
extern const std::span<const std::uint8_t> ${NAME};
constinit const std::span<const std::uint8_t> ${NAME}(kBytes);
}
")
endif()
