/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The bytes of a value of the type `solid`, behind PostgreSQL's own header: facts that queries need
 * often, at fixed places in the byte order of the machine, then the blob. Text, binary transfer and
 * dumps have the blob alone, so the facts are made again from it, and their layout can change.
 */
#ifndef WATERTIGHT_SQL_SOLID_VALUE_H
#define WATERTIGHT_SQL_SOLID_VALUE_H

/** The number of this layout. */
#define WATERTIGHT_SOLID_LAYOUT 1

/** The offsets of the facts, none of which is aligned. */
enum {
  WATERTIGHT_SOLID_BOX = 1,     /* 6 floats: the least x, y, z, then the largest, rounded outward */
  WATERTIGHT_SOLID_VOLUME = 25, /* a double, cubic units of the reference system */
  WATERTIGHT_SOLID_AREA = 33,   /* a double, square units */
  WATERTIGHT_SOLID_HASH = 41,   /* 64 bits of the canonical form, equal for equal solids */
  WATERTIGHT_SOLID_SRID = 49,   /* 32 bits, 0: not stated */
  WATERTIGHT_SOLID_BLOB = 53    /* the blob, to the end */
};

#endif
