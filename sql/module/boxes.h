/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Relations of boxes, for the operators and the index.
 */
#ifndef WATERTIGHT_SQL_BOXES_H
#define WATERTIGHT_SQL_BOXES_H

#include "sql/module/solid_facts.h"

/** The box in the value of a solid. */
SolidBox box_of_solid(Datum solid);

/** Whether two closed boxes have a point in common. */
bool boxes_overlap(const SolidBox* left, const SolidBox* right);
bool box_contains(const SolidBox* outer, const SolidBox* inner);
/** Makes a box one around itself and another. */
void extend_box(SolidBox* box, const SolidBox* other);
/** The least distance of points of two boxes. */
double distance_of_boxes(const SolidBox* left, const SolidBox* right);

#endif
