/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The type `wt_box`: closed boxes in three dimensions, and how boxes of solids relate to them.
 */
#include "postgres.h"

#include <math.h>

#include "fmgr.h"
#include "libpq/pqformat.h"
#include "utils/builtins.h"
#include "utils/float.h"

#include "sql/module/boxes.h"

SolidBox
box_of_solid(Datum solid)
{
	SolidFacts	facts;
	SolidBox	box;

	read_solid_facts(solid, &facts);
	for (int axis = 0; axis < 3; ++axis)
	{
		box.min[axis] = facts.box[axis];
		box.max[axis] = facts.box[3 + axis];
	}
	return box;
}

bool
boxes_overlap(const SolidBox *left, const SolidBox *right)
{
	for (int axis = 0; axis < 3; ++axis)
		if (left->min[axis] > right->max[axis] || right->min[axis] > left->max[axis])
			return false;
	return true;
}

bool
box_contains(const SolidBox *outer, const SolidBox *inner)
{
	for (int axis = 0; axis < 3; ++axis)
		if (inner->min[axis] < outer->min[axis] || inner->max[axis] > outer->max[axis])
			return false;
	return true;
}

double
distance_of_boxes(const SolidBox *left, const SolidBox *right)
{
	double		sum = 0;

	for (int axis = 0; axis < 3; ++axis)
	{
		double		gap = Max(left->min[axis] - right->max[axis], right->min[axis] - left->max[axis]);

		if (gap > 0)
			sum += gap * gap;
	}
	return sqrt(sum);
}

void
extend_box(SolidBox *box, const SolidBox *other)
{
	for (int axis = 0; axis < 3; ++axis)
	{
		box->min[axis] = Min(box->min[axis], other->min[axis]);
		box->max[axis] = Max(box->max[axis], other->max[axis]);
	}
}

/* Reads a number of a box, and the character behind it if there is one; moves on. */
static double
number_in(char **text, const char *whole)
{
	char	   *end;
	double		number;

	errno = 0;
	number = strtod(*text, &end);
	if (end == *text || !isfinite(number))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_TEXT_REPRESENTATION),
				 errmsg("this is no box: \"%s\"", whole),
				 errhint("A box is BOX3D(x y z,x y z), the least corner first.")));
	*text = end;
	return number;
}

static void
expect(char **text, char wanted, const char *whole)
{
	*text += strspn(*text, " \t\r\n");
	if (**text != wanted)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_TEXT_REPRESENTATION),
				 errmsg("this is no box: \"%s\"", whole),
				 wanted == '\0' ? errdetail("More text follows.") : errdetail("'%c' is missing.", wanted),
				 errhint("A box is BOX3D(x y z,x y z), the least corner first.")));
	++*text;
}

static SolidBox *
checked_box(SolidBox box)
{
	SolidBox   *result = palloc(sizeof(SolidBox));

	for (int axis = 0; axis < 3; ++axis)
		if (!(box.min[axis] <= box.max[axis]) || !isfinite(box.max[axis] - box.min[axis]))
			ereport(ERROR,
					(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
					 errmsg("the least %c of a box is above the largest, or one is not finite",
							"xyz"[axis])));
	*result = box;
	return result;
}

/* Reads BOX3D(x y z,x y z), as PostGIS writes boxes. */
PG_FUNCTION_INFO_V1(wt_box_in);
Datum
wt_box_in(PG_FUNCTION_ARGS)
{
	char	   *whole = PG_GETARG_CSTRING(0);
	char	   *text = whole + strspn(whole, " \t\r\n");
	SolidBox	box;

	if (pg_strncasecmp(text, "BOX3D", 5) == 0)
		text += 5;
	expect(&text, '(', whole);
	for (int axis = 0; axis < 3; ++axis)
		box.min[axis] = number_in(&text, whole);
	expect(&text, ',', whole);
	for (int axis = 0; axis < 3; ++axis)
		box.max[axis] = number_in(&text, whole);
	expect(&text, ')', whole);
	expect(&text, '\0', whole);
	PG_RETURN_POINTER(checked_box(box));
}

PG_FUNCTION_INFO_V1(wt_box_out);
Datum
wt_box_out(PG_FUNCTION_ARGS)
{
	const SolidBox *box = (const SolidBox *) PG_GETARG_POINTER(0);
	char	   *numbers[6];

	for (int i = 0; i < 6; ++i)
		numbers[i] = float8out_internal(i < 3 ? box->min[i] : box->max[i - 3]);
	PG_RETURN_CSTRING(psprintf("BOX3D(%s %s %s,%s %s %s)", numbers[0], numbers[1], numbers[2],
							   numbers[3], numbers[4], numbers[5]));
}

PG_FUNCTION_INFO_V1(wt_box_recv);
Datum
wt_box_recv(PG_FUNCTION_ARGS)
{
	StringInfo	message = (StringInfo) PG_GETARG_POINTER(0);
	SolidBox	box;

	for (int i = 0; i < 6; ++i)
	{
		double		bound = pq_getmsgfloat8(message);

		if (i < 3)
			box.min[i] = bound;
		else
			box.max[i - 3] = bound;
	}
	PG_RETURN_POINTER(checked_box(box));
}

PG_FUNCTION_INFO_V1(wt_box_send);
Datum
wt_box_send(PG_FUNCTION_ARGS)
{
	const SolidBox *box = (const SolidBox *) PG_GETARG_POINTER(0);
	StringInfoData message;

	pq_begintypsend(&message);
	for (int i = 0; i < 6; ++i)
		pq_sendfloat8(&message, i < 3 ? box->min[i] : box->max[i - 3]);
	PG_RETURN_BYTEA_P(pq_endtypsend(&message));
}

PG_FUNCTION_INFO_V1(wt_box_make);
Datum
wt_box_make(PG_FUNCTION_ARGS)
{
	SolidBox	box;

	for (int axis = 0; axis < 3; ++axis)
	{
		box.min[axis] = PG_GETARG_FLOAT8(axis);
		box.max[axis] = PG_GETARG_FLOAT8(3 + axis);
	}
	PG_RETURN_POINTER(checked_box(box));
}

/* The bounds of a box as an array: the least x, y, z, then the largest. */
PG_FUNCTION_INFO_V1(wt_box_bound);
Datum
wt_box_bound(PG_FUNCTION_ARGS)
{
	const SolidBox *box = (const SolidBox *) PG_GETARG_POINTER(0);
	int32		number = PG_GETARG_INT32(1);

	if (number < 1 || number > 6)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("a box has the bounds 1 to 6: the least x, y, z, then the largest")));
	PG_RETURN_FLOAT8(number <= 3 ? box->min[number - 1] : box->max[number - 4]);
}

/* The box of a solid as its value has it, rounded outward to single precision. */
PG_FUNCTION_INFO_V1(wt_solid_box);
Datum
wt_solid_box(PG_FUNCTION_ARGS)
{
	SolidBox   *box = palloc(sizeof(SolidBox));

	*box = box_of_solid(PG_GETARG_DATUM(0));
	PG_RETURN_POINTER(box);
}

/* Relations of the boxes of two solids, of that of a solid and a box, and of boxes. */

#define BOX_OF_SOLID(number) box_of_solid(PG_GETARG_DATUM(number))
#define BOX(number) (*(const SolidBox *) PG_GETARG_POINTER(number))

#define RELATION_OF(name, type, result, left_box, right_box) \
	PG_FUNCTION_INFO_V1(name); \
	Datum \
	name(PG_FUNCTION_ARGS) \
	{ \
		const SolidBox left = left_box(0); \
		const SolidBox right = right_box(1); \
\
		PG_RETURN_##type(result); \
	}

#define RELATION(name, type, result) \
	RELATION_OF(name##_solid, type, result, BOX_OF_SOLID, BOX_OF_SOLID) \
	RELATION_OF(name##_box, type, result, BOX_OF_SOLID, BOX) \
	RELATION_OF(name##_of_box_solid, type, result, BOX, BOX_OF_SOLID) \
	RELATION_OF(name##_of_box_box, type, result, BOX, BOX)

RELATION(wt_box_overlaps, BOOL, boxes_overlap(&left, &right))
RELATION(wt_box_contains, BOOL, box_contains(&left, &right))
RELATION(wt_box_within, BOOL, box_contains(&right, &left))
RELATION(wt_box_distance, FLOAT8, distance_of_boxes(&left, &right))

PG_FUNCTION_INFO_V1(wt_box_union);
Datum
wt_box_union(PG_FUNCTION_ARGS)
{
	SolidBox   *all = palloc(sizeof(SolidBox));

	*all = *(const SolidBox *) PG_GETARG_POINTER(0);
	extend_box(all, (const SolidBox *) PG_GETARG_POINTER(1));
	PG_RETURN_POINTER(all);
}

/* The state of wt_extent with one solid more; NULL counts as nothing. */
PG_FUNCTION_INFO_V1(wt_box_extend);
Datum
wt_box_extend(PG_FUNCTION_ARGS)
{
	SolidBox   *all;

	if (PG_ARGISNULL(1))
	{
		if (PG_ARGISNULL(0))
			PG_RETURN_NULL();
		PG_RETURN_DATUM(PG_GETARG_DATUM(0));
	}
	all = palloc(sizeof(SolidBox));
	*all = box_of_solid(PG_GETARG_DATUM(1));
	if (!PG_ARGISNULL(0))
		extend_box(all, (const SolidBox *) PG_GETARG_POINTER(0));
	PG_RETURN_POINTER(all);
}
