/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The interface between PostgreSQL (C) and geometry (C++): bytes in, bytes or a failure out. The
 * code behind it knows nothing of PostgreSQL, and no exception leaves it. Callers may leave by
 * longjmp at any time, except out of wt_poll: no C++ object lives in a frame above these functions.
 */
#ifndef WATERTIGHT_SQL_BRIDGE_H
#define WATERTIGHT_SQL_BRIDGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#define WATERTIGHT_NOEXCEPT noexcept
#else
#define WATERTIGHT_NOEXCEPT
#endif

/** Called every few milliseconds of a long computation; true ends the computation. Must return. */
typedef bool (*wt_poll)(void);

/** The helper processes of one backend. */
typedef struct wt_engine wt_engine;

/** The reason why there is no value. All texts are UTF-8. */
typedef struct wt_failure {
  char sqlstate[6];  /* "" = no failure */
  char message[512]; /* one sentence */
  char* detail;      /* may be NULL; owned by the reply */
  bool is_invalid;   /* the solid was judged, and is invalid; the detail has its findings */
} wt_failure;

/** The SQLSTATE of a solid that is undecided: a helper process crashed or reached its limits. */
#define WATERTIGHT_UNDECIDED "WT001"

/** The answer of a function, all zero bytes at first; wt_reply_clear() frees and zeroes it. */
typedef struct wt_reply {
  uint8_t* bytes; /* the value: a blob, EWKB, or JSON text */
  size_t size;
  bool truth; /* the value of wt_bridge_is_valid, wt_bridge_contains, wt_bridge_meets_segment */
  wt_failure failure;
} wt_reply;

void wt_reply_clear(wt_reply* reply) WATERTIGHT_NOEXCEPT;

/** Makes an engine with helpers from the folder `libexec`, or from their usual places when it is
 *  "". Starts no helper yet. NULL when there is no memory. */
wt_engine* wt_engine_make(const char* libexec) WATERTIGHT_NOEXCEPT;
/** Kills the helpers. NULL does nothing. */
void wt_engine_end(wt_engine* engine) WATERTIGHT_NOEXCEPT;

/** The ranges of the tolerances; both ends are allowed. */
#define WATERTIGHT_LEAST_PLANARITY 1e-9 /* metres */
#define WATERTIGHT_MOST_PLANARITY 1000.0
#define WATERTIGHT_LEAST_ANGLE 1e-6 /* degrees */
#define WATERTIGHT_MOST_ANGLE 90.0

/** The rules by which a solid is judged. */
typedef struct wt_rule_choice {
  double planarity;       /* metres: the largest distance of a vertex from the plane of its facet */
  double planarity_angle; /* degrees: the largest angle between two triangles of a facet */
  bool is_boundary_enough; /* exact tests alone; false: also a certified tetrahedralization */
  bool is_strict;          /* only the canonical triangles of facets count */
} wt_rule_choice;

/** The rules where none are stated, which are the same in every session. */
wt_rule_choice wt_default_rules(void) WATERTIGHT_NOEXCEPT;
/** The number of the rule set that this program applies; blobs state it. */
uint32_t wt_rule_set(void) WATERTIGHT_NOEXCEPT;

/** A blob, page or EWKB to work on, the helpers to do it with, and when to stop. */
typedef struct wt_job {
  const uint8_t* bytes;
  size_t size;
  wt_engine* engine;
  wt_poll poll;
  /** The longest time of a call in seconds; 0: no limit. Validation ends within milliseconds of it;
   *  reading, encoding and decoding, whose time max_memory bounds, are ended after their step. */
  uint32_t max_seconds;
  /** The most memory in MiB; 0: no limit. The address space of a helper process, and the memory of
   *  the call itself: a value is refused before the work if its bytes and facets, at 4 KiB a facet
   *  or vertex, need more. */
  uint32_t max_memory;
  const wt_rule_choice* rules; /* NULL: the default ones */
  int32_t slot;                /* the number of a solid of a page, from 0 */
} wt_job;

/* Each function below fills a reply that is all zero. An undecided solid is a failure
 * (WATERTIGHT_UNDECIDED, can be tried again), never a value; a reached limit is a failure too
 * (54000). */

/** Answers EWKB with the report as JSON, without times; its parameters are the rules. */
void wt_bridge_validate(const wt_job* job, wt_reply* reply) WATERTIGHT_NOEXCEPT;
/** Answers EWKB with whether the solid is valid. */
void wt_bridge_is_valid(const wt_job* job, wt_reply* reply) WATERTIGHT_NOEXCEPT;
/** The remedies for an invalid solid (repair/repair.h). */
typedef struct wt_repair_choice {
  const char* remedies; /* UTF-8: names parted by commas, or "all" */
  double weld;          /* metres, from 0 to WATERTIGHT_MOST_WELD */
} wt_repair_choice;
#define WATERTIGHT_MOST_WELD 1000.0
/** Answers EWKB with the EWKB of the solid as it is, if it is valid, or of the repaired one. A
 * solid that no remedy mends fails with 22023; its findings are the detail. */
void wt_bridge_repair(const wt_job* job, const wt_repair_choice* choice,
                      wt_reply* reply) WATERTIGHT_NOEXCEPT;
/** Answers EWKB with what a repair does, as JSON (repair/summary_json.h). */
void wt_bridge_repair_report(const wt_job* job, const wt_repair_choice* choice,
                             wt_reply* reply) WATERTIGHT_NOEXCEPT;
/** Answers a boundary representation of one solid in JSON, UTF-8 (docs/formats.md), with the EWKB
 * of a valid polyhedron that is nowhere farther than `chord` metres from it. A face that cannot be
 *  tessellated fails with 0A000; an invalid polyhedron with 22023, its findings are the detail. */
void wt_bridge_tessellate(const wt_job* job, double chord, wt_reply* reply) WATERTIGHT_NOEXCEPT;
/** Answers EWKB with a blob, which states the rules. An invalid solid fails with 22023; its
 * findings are the detail. */
void wt_bridge_encode(const wt_job* job, wt_reply* reply) WATERTIGHT_NOEXCEPT;
/** Answers a blob with EWKB. */
void wt_bridge_decode(const wt_job* job, wt_reply* reply) WATERTIGHT_NOEXCEPT;
/** Answers a page with the blob of its solid number `slot`. Without such a solid it fails with
 * 22023.
 */
void wt_bridge_blob(const wt_job* job, wt_reply* reply) WATERTIGHT_NOEXCEPT;
/** Answers a blob with its header, counts and part sizes as JSON. */
void wt_bridge_info(const wt_job* job, wt_reply* reply) WATERTIGHT_NOEXCEPT;
/** Answers a blob with the rules under which its solid was accepted, as JSON. A blob does not say
 *  whether they were strict: strict rules accept fewer solids, and none by another proof. */
void wt_bridge_rules_of(const wt_job* job, wt_reply* reply) WATERTIGHT_NOEXCEPT;

/** Answers EWKB, or a blob, with a value of the type `solid` (sql/solid_value.h). EWKB is judged by
 *  the rules; a blob by the exact tests and the rules that it states, whatever those of the job
 *  are. An invalid solid fails with 22023, and is_invalid. */
void wt_bridge_solid(const wt_job* job, wt_reply* reply) WATERTIGHT_NOEXCEPT;
/** Answers WKT, UTF-8, in the same way. */
void wt_bridge_solid_of_wkt(const wt_job* job, wt_reply* reply) WATERTIGHT_NOEXCEPT;
/** Answers a blob with the value of its solid moved by `way`, in units of the reference system,
 *  without rounding; it is judged again as one that comes in. */
void wt_bridge_translate(const wt_job* job, const double way[3],
                         wt_reply* reply) WATERTIGHT_NOEXCEPT;
/** Answers a blob with the value of its solid in EPSG system `srid`: x and y by PROJ, longitude
 *  first, rounded to 0.0001 units or 1e-9 degrees; z as it is. It is judged as a new solid, by the
 *  rules that the blob states. Fails with 0A000 where PROJ has no way from one to the other. */
void wt_bridge_transform(const wt_job* job, uint32_t srid, wt_reply* reply) WATERTIGHT_NOEXCEPT;
/** Answers a blob with the values of the parts of its solid between two heights, in no special
 *  order: four bytes with the size of a value before each. New corners are rounded
 *  (tessellate/clip_z.h); each part is judged as a new solid, by the rules that the blob states.
 *  Where the rest of a facet is too bent, the facets that are cut become triangles. Fails with
 *  22023 where a part is not valid all the same. */
void wt_bridge_clip_z(const wt_job* job, double low, double high,
                      wt_reply* reply) WATERTIGHT_NOEXCEPT;
/** Answers a blob with WKT, UTF-8. */
void wt_bridge_wkt(const wt_job* job, wt_reply* reply) WATERTIGHT_NOEXCEPT;
/** Answers a blob with an OBJ document; facets with holes are triangles there. Fails with 0A000 for
 *  a solid with cavities. */
void wt_bridge_obj(const wt_job* job, wt_reply* reply) WATERTIGHT_NOEXCEPT;
/** Answers a blob with a binary glTF, whose origin is the low corner of the box. */
void wt_bridge_glb(const wt_job* job, wt_reply* reply) WATERTIGHT_NOEXCEPT;
/** Answers a blob with the facets of all shells as EWKB of a MULTIPOLYGON Z. */
void wt_bridge_boundary(const wt_job* job, wt_reply* reply) WATERTIGHT_NOEXCEPT;

/** The bytes of a blob. */
typedef struct wt_blob_view {
  const uint8_t* bytes;
  size_t size;
} wt_blob_view;
/** Answers the packed text of a feature in the tables of the service with its city model as JSON;
 *  without bytes where it has none. `dictionary` is that of the row, without bytes for none, `id`
 * the id of the feature. */
void wt_bridge_stored_model(const wt_job* job, wt_blob_view dictionary, const char* id,
                            wt_reply* reply) WATERTIGHT_NOEXCEPT;
/** Answers the same with the repair of a solid of the feature as JSON (docs/report.md, "Repairs");
 *  without bytes for a solid that was not repaired. */
void wt_bridge_stored_repair(const wt_job* job, wt_blob_view dictionary, const char* id,
                             uint32_t solid, wt_reply* reply) WATERTIGHT_NOEXCEPT;
/** Blobs and the names of their solids, UTF-8. */
typedef struct wt_named_blobs {
  const wt_blob_view* blobs;
  const char* const* names;
  size_t count;
} wt_named_blobs;
/** Answers blobs with one CityJSON document, UTF-8, in which each solid is a city object. Fails
 *  with 0A000 for several reference systems, and for coordinates on no decimal grid. The job has
 *  the limits alone, here and below. */
void wt_bridge_city_json(const wt_job* job, const wt_named_blobs* solids,
                         wt_reply* reply) WATERTIGHT_NOEXCEPT;
/** Answers blobs with one page (codec/page.h), without bytes where there is none. */
void wt_bridge_page(const wt_job* job, const wt_blob_view* blobs, size_t count,
                    wt_reply* reply) WATERTIGHT_NOEXCEPT;
/** Answers the blobs of the parts of a building with an array of findings as JSON: solids that
 *  share interior (601), whose places name them by their numbers, from 0. */
void wt_bridge_parts(const wt_job* job, const wt_blob_view* blobs, size_t count,
                     wt_reply* reply) WATERTIGHT_NOEXCEPT;

/** A tetrahedron, in units of the reference system. */
typedef struct wt_tetrahedron {
  double corners[4][3];
} wt_tetrahedron;
/** Answers a blob with an array of wt_tetrahedron: the interior of the certified constrained
 *  Delaunay tetrahedralization, Steiner vertices included. Fails with WATERTIGHT_UNDECIDED if the
 *  helpers do not find it. */
void wt_bridge_tetrahedra(const wt_job* job, wt_reply* reply) WATERTIGHT_NOEXCEPT;

/** How two solids meet. */
typedef enum wt_relation {
  WT_APART,
  WT_TOUCHING_AT_POINTS, /* points or edges in common */
  WT_TOUCHING_BY_AREA,   /* areas in common, as of party walls */
  WT_OVERLAPPING         /* points inside both */
} wt_relation;
/** Compares the solids of two blobs, of the job and of `other`, exactly. They are in one reference
 *  system, which is not checked. */
wt_relation wt_bridge_relation(const wt_job* job, const uint8_t* other, size_t other_size,
                               wt_reply* reply) WATERTIGHT_NOEXCEPT;

/** Gives the area in which the boundaries of the solids of two blobs face each other at most
 *  `tolerance` apart, in square units; 0: in exactly one plane. They are in one reference system,
 *  which is not checked. */
void wt_bridge_shared_area(const wt_job* job, const uint8_t* other, size_t other_size,
                           double tolerance, double* area, wt_reply* reply) WATERTIGHT_NOEXCEPT;
/** Gives the distance of the solids of two blobs in the same way; 0 if they have a point in common.
 */
void wt_bridge_distance(const wt_job* job, const uint8_t* other, size_t other_size,
                        double* distance, wt_reply* reply) WATERTIGHT_NOEXCEPT;
/** Gives the distance of the solid of a blob from a place with finite coordinates. */
void wt_bridge_distance_of_place(const wt_job* job, const double place[3], double* distance,
                                 wt_reply* reply) WATERTIGHT_NOEXCEPT;
/** Whether the solid of a blob has a point in common with a segment, whose ends are finite; `truth`
 *  has it. */
void wt_bridge_meets_segment(const wt_job* job, const double from[3], const double to[3],
                             wt_reply* reply) WATERTIGHT_NOEXCEPT;

/** The measures of a solid that take its coordinates. */
typedef struct wt_measures {
  double box_min[3]; /* in units of the reference system */
  double box_max[3];
  uint32_t vertices;
  uint32_t facets;
  uint32_t rings;
  uint32_t shells;
} wt_measures;
/** Measures the solid of a blob; the reply has no value. */
void wt_bridge_measures(const wt_job* job, wt_measures* measures,
                        wt_reply* reply) WATERTIGHT_NOEXCEPT;

/** Gives the genus of the solid of a blob, the sum over all shells. */
void wt_bridge_genus(const wt_job* job, int64_t* genus, wt_reply* reply) WATERTIGHT_NOEXCEPT;
/** Gives the centre of mass of the solid of a blob, each coordinate rounded once. */
void wt_bridge_centroid(const wt_job* job, double centroid[3], wt_reply* reply) WATERTIGHT_NOEXCEPT;
/** Gives the volume of the part below a height, which is finite, rounded once. */
void wt_bridge_volume_below(const wt_job* job, double height, double* volume,
                            wt_reply* reply) WATERTIGHT_NOEXCEPT;

/** Whether the solid of a blob contains a place, inside or on its boundary; `truth` has it.
 *  Coordinates are finite. */
void wt_bridge_contains(const wt_job* job, const double place[3],
                        wt_reply* reply) WATERTIGHT_NOEXCEPT;

/** A facet of a solid. Lengths and areas are in units of the reference system, angles in degrees.
 */
typedef struct wt_face {
  uint32_t shell; /* 0: the exterior one */
  uint32_t facet; /* its number in the solid, from 0 */
  uint32_t rings;
  double area;
  double normal[3];   /* of length 1, out of the solid */
  double tilt;        /* of the normal from straight up: 0 a flat roof, 90 a wall, 180 a floor */
  double azimuth;     /* of the normal, clockwise from the y axis (north), 0 to 360; NaN without */
  double centroid[3]; /* of its triangles */
  double planarity;   /* the largest distance of a corner from the fitted plane */
} wt_face;
/** Answers a blob with an array of wt_face. */
void wt_bridge_faces(const wt_job* job, wt_reply* reply) WATERTIGHT_NOEXCEPT;

/** Compares the solids of two blobs, of the first job and of `other`: below, at or above 0, as the
 *  return value. 0 if they are equal (canonical form, lattice and reference system), and after a
 *  failure. */
int wt_bridge_compare(const wt_job* job, const uint8_t* other, size_t other_size,
                      wt_reply* reply) WATERTIGHT_NOEXCEPT;
/** The version, such as "0.1.0"; static. */
const char* wt_bridge_version(void) WATERTIGHT_NOEXCEPT;

#ifdef __cplusplus
}
#endif
#endif
