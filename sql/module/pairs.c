/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Functions on a solid and another one, a place or a segment.
 */
#include "postgres.h"

#include <math.h>

#include "sql/module/backend.h"
#include "sql/module/solid_facts.h"

void
check_one_system(const SolidFacts *left, const SolidFacts *right)
{
	if (left->srid != right->srid)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("the solids are in different reference systems"),
				 errdetail("They are in %u and %u.", left->srid, right->srid)));
}

void
read_place(FunctionCallInfo fcinfo, int first, double place[3])
{
	for (int axis = 0; axis < 3; ++axis)
	{
		place[axis] = PG_GETARG_FLOAT8(first + axis);
		if (!isfinite(place[axis]))
			ereport(ERROR,
					(errcode(ERRCODE_INVALID_PARAMETER_VALUE), errmsg("a coordinate is not a finite number")));
	}
}

/* The largest distance of the boxes of the first two arguments along an axis; 0 or less if they
 * have a point in common. The solids must be in one reference system. */
static double
gap_of_arguments(FunctionCallInfo fcinfo)
{
	SolidFacts	facts[2];
	double		gap = -INFINITY;

	for (int i = 0; i < 2; ++i)
		read_solid_facts(PG_GETARG_DATUM(i), &facts[i]);
	check_one_system(&facts[0], &facts[1]);
	for (int axis = 0; axis < 3; ++axis)
		for (int i = 0; i < 2; ++i)
			gap = Max(gap, (double) facts[i].box[axis] - facts[1 - i].box[3 + axis]);
	return gap;
}

PG_FUNCTION_INFO_V1(wt_solid_contains_place);
Datum
wt_solid_contains_place(PG_FUNCTION_ARGS)
{
	wt_reply   *reply = new_reply();
	SolidFacts	facts;
	double		place[3];
	bool		is_in_box = true;
	wt_job		job;

	read_solid_facts(PG_GETARG_DATUM(0), &facts);
	read_place(fcinfo, 1, place);
	for (int axis = 0; axis < 3; ++axis)
		is_in_box &= place[axis] >= facts.box[axis] && place[axis] <= facts.box[3 + axis];
	if (!is_in_box)
		PG_RETURN_BOOL(false);
	job = job_on_solid(PG_GETARG_DATUM(0));
	wt_bridge_contains(&job, place, reply);
	check_reply(reply);
	PG_RETURN_BOOL(reply->truth);
}

/* How two solids meet. Those whose boxes are apart are not looked at. */
static wt_relation
relation_of_arguments(FunctionCallInfo fcinfo)
{
	wt_reply   *reply;
	wt_job		job;
	wt_job		other;
	wt_relation relation;

	if (gap_of_arguments(fcinfo) > 0)
		return WT_APART;
	reply = new_reply();
	job = job_on_solid(PG_GETARG_DATUM(0));
	other = job_on_solid(PG_GETARG_DATUM(1));
	relation = wt_bridge_relation(&job, other.bytes, other.size, reply);
	check_reply(reply);
	return relation;
}

PG_FUNCTION_INFO_V1(wt_solid_overlaps);
Datum
wt_solid_overlaps(PG_FUNCTION_ARGS)
{
	PG_RETURN_BOOL(relation_of_arguments(fcinfo) == WT_OVERLAPPING);
}

PG_FUNCTION_INFO_V1(wt_solid_intersects);
Datum
wt_solid_intersects(PG_FUNCTION_ARGS)
{
	PG_RETURN_BOOL(relation_of_arguments(fcinfo) != WT_APART);
}

PG_FUNCTION_INFO_V1(wt_solid_shares_area);
Datum
wt_solid_shares_area(PG_FUNCTION_ARGS)
{
	PG_RETURN_BOOL(relation_of_arguments(fcinfo) == WT_TOUCHING_BY_AREA);
}

/* The area in which two solids stand wall to wall. Those whose boxes are farther apart than the
 * tolerance are not looked at. */
PG_FUNCTION_INFO_V1(wt_solid_shared_area);
Datum
wt_solid_shared_area(PG_FUNCTION_ARGS)
{
	double		tolerance = PG_GETARG_FLOAT8(2);
	wt_reply   *reply;
	wt_job		job;
	wt_job		other;
	double		area = 0;

	if (!isfinite(tolerance) || tolerance < 0)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("the tolerance is not a finite number of 0 or more")));
	if (gap_of_arguments(fcinfo) > tolerance)
		PG_RETURN_FLOAT8(0);
	reply = new_reply();
	job = job_on_solid(PG_GETARG_DATUM(0));
	other = job_on_solid(PG_GETARG_DATUM(1));
	wt_bridge_shared_area(&job, other.bytes, other.size, tolerance, &area, reply);
	check_reply(reply);
	PG_RETURN_FLOAT8(area);
}

PG_FUNCTION_INFO_V1(wt_solid_distance);
Datum
wt_solid_distance(PG_FUNCTION_ARGS)
{
	wt_reply   *reply = new_reply();
	wt_job		job;
	wt_job		other;
	double		distance = 0;

	(void) gap_of_arguments(fcinfo); /* raises an error for two systems */
	job = job_on_solid(PG_GETARG_DATUM(0));
	other = job_on_solid(PG_GETARG_DATUM(1));
	wt_bridge_distance(&job, other.bytes, other.size, &distance, reply);
	check_reply(reply);
	PG_RETURN_FLOAT8(distance);
}

PG_FUNCTION_INFO_V1(wt_solid_distance_of_place);
Datum
wt_solid_distance_of_place(PG_FUNCTION_ARGS)
{
	wt_reply   *reply = new_reply();
	wt_job		job = job_on_solid(PG_GETARG_DATUM(0));
	double		place[3];
	double		distance = 0;

	read_place(fcinfo, 1, place);
	wt_bridge_distance_of_place(&job, place, &distance, reply);
	check_reply(reply);
	PG_RETURN_FLOAT8(distance);
}

PG_FUNCTION_INFO_V1(wt_solid_meets_segment);
Datum
wt_solid_meets_segment(PG_FUNCTION_ARGS)
{
	wt_reply   *reply = new_reply();
	SolidFacts	facts;
	double		ends[2][3];
	wt_job		job;

	read_solid_facts(PG_GETARG_DATUM(0), &facts);
	read_place(fcinfo, 1, ends[0]);
	read_place(fcinfo, 4, ends[1]);
	for (int axis = 0; axis < 3; ++axis)
		if (Min(ends[0][axis], ends[1][axis]) > facts.box[3 + axis] ||
			Max(ends[0][axis], ends[1][axis]) < facts.box[axis])
			PG_RETURN_BOOL(false);
	job = job_on_solid(PG_GETARG_DATUM(0));
	wt_bridge_meets_segment(&job, ends[0], ends[1], reply);
	check_reply(reply);
	PG_RETURN_BOOL(reply->truth);
}
