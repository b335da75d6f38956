/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The facts in a value of the type `solid`, and boxes, for the C files of the extension.
 */
#ifndef WATERTIGHT_SQL_SOLID_FACTS_H
#define WATERTIGHT_SQL_SOLID_FACTS_H

#include "postgres.h"

#include "sql/module/backend.h"
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

/** Raises an error unless two solids are in one reference system. */
void check_one_system(const SolidFacts* left, const SolidFacts* right);

/** The blob of a value, as a job of the bridge. */
wt_job job_on_solid(Datum solid);
/** The reply of a function of the bridge on a value; its failure is raised. */
wt_reply* run_on_solid(bridge_function function, Datum solid);

/** Three numbers of the arguments, from number `first` on; raises an error unless they are finite.
 */
void read_place(FunctionCallInfo fcinfo, int first, double place[3]);

/** An array of three numbers. */
Datum array_of(const double numbers[3]);

/** A value of the type `wt_box`. */
typedef struct SolidBox {
  double min[3];
  double max[3];
} SolidBox;

#endif
