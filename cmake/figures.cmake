# SPDX-License-Identifier: GPL-3.0-or-later
# cmake -DINPUT=docs/figures -DOUTPUT=figures.svg -P figures.cmake
# Writes all figures of a folder as symbols of SVG: <symbol id="figure-302" viewBox="...">, one on a
# line.
file(GLOB figures "${INPUT}/*.svg")
list(SORT figures)
set(symbols "")
foreach(figure IN LISTS figures)
  cmake_path(GET figure STEM code)
  file(READ "${figure}" text)
  string(REGEX MATCH "viewBox=\"[^\"]*\"" view "${text}")
  string(REGEX REPLACE "^.*<svg [^>]*>" "" text "${text}")
  string(REGEX REPLACE "</svg>.*$" "" text "${text}")
  string(REPLACE "\n" "" text "${text}")
  string(APPEND symbols "<symbol id=\"figure-${code}\" ${view}>${text}</symbol>\n")
endforeach()
file(WRITE "${OUTPUT}" "${symbols}")
