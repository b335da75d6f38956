// SPDX-License-Identifier: GPL-3.0-or-later
//
// STEP and IFC texts of small solids, made by code.
#pragma once

#include <string>

namespace watertight::test {

/// A cylinder of radius 200 mm and height 1000 mm, with a seam, in millimetres.
std::string step_cylinder();
/// The same solid as a part: a pair of it, once upright and once along x, is twice in the whole,
/// the second time with the whole named first; and it is there once more as a mapped item.
std::string step_assembly();
/// The same solid as the body of a wall, 10 m east of its storey, without a seam.
std::string ifc_cylinder();
/// A mapped item that shows a faceted tetrahedron twice: as it is, and mirrored, twice as large.
std::string ifc_mapped_tetrahedron();
/// A cube of 2 m as a polygonal face set with a hole through it, and a triangulated tetrahedron.
std::string ifc_face_sets();

/// The text with a part replaced. Requires that the text has it.
std::string replaced(std::string text, const std::string& part, const std::string& by);

}  // namespace watertight::test
