/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The facts in a value of the type `solid`, and boxes, for the C files of the extension.
 */
#ifndef WATERTIGHT_SQL_SOLID_FACTS_H
#define WATERTIGHT_SQL_SOLID_FACTS_H

#include "postgres.h"

#include "sql/solid_value.h"

typedef struct SolidFacts {
  float box[6];  /* the least x, y, z, then the largest, rounded outward */
  double volume; /* cubic units of the reference system */
  double area;   /* square units */
  uint64 hash;
  uint32 srid;
} SolidFacts;

/** Reads the facts of a value, without the rest of it where that lies elsewhere. Raises an error
 *  for damaged bytes. */
void read_solid_facts(Datum solid, SolidFacts* facts);

/** A value of the type `wt_box`. */
typedef struct SolidBox {
  double min[3];
  double max[3];
} SolidBox;

#endif
