/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The operator classes by which GiST and BRIN find solids by their boxes. Keys are boxes (`wt_box`).
 * Those of GiST's leaves are the boxes in the values, so that nothing is looked at twice; that of
 * BRIN is around all solids of a range of pages.
 */
#include "postgres.h"

#include <math.h>

#include "access/brin_internal.h"
#include "access/brin_tuple.h"
#include "access/gist.h"
#include "access/stratnum.h"
#include "fmgr.h"

#include "sql/module/boxes.h"

/* The numbers of the operators in the class; with a box on the right they are BOX_STRATEGIES more. */
#define OVERLAPS 3
#define CONTAINS 7
#define WITHIN 8
#define DISTANCE 15
#define BOX_STRATEGIES 20

static SolidBox
box_of_query(Datum query, StrategyNumber strategy)
{
	return strategy > BOX_STRATEGIES ? *(const SolidBox *) DatumGetPointer(query) : box_of_solid(query);
}

static const SolidBox *
box_of_key(const GISTENTRY *entry)
{
	return (const SolidBox *) DatumGetPointer(entry->key);
}

/* The sum of the sides; unlike the volume it tells flat boxes apart. */
static double
margin_of(const SolidBox *box)
{
	double		sum = 0;

	for (int axis = 0; axis < 3; ++axis)
		sum += box->max[axis] - box->min[axis];
	return sum;
}

PG_FUNCTION_INFO_V1(wt_gist_compress);
Datum
wt_gist_compress(PG_FUNCTION_ARGS)
{
	GISTENTRY  *entry = (GISTENTRY *) PG_GETARG_POINTER(0);
	GISTENTRY  *compressed;
	SolidBox   *box;

	if (!entry->leafkey)
		PG_RETURN_POINTER(entry);
	compressed = palloc(sizeof(GISTENTRY));
	box = palloc(sizeof(SolidBox));
	*box = box_of_solid(entry->key);
	gistentryinit(*compressed, PointerGetDatum(box), entry->rel, entry->page, entry->offset, false);
	PG_RETURN_POINTER(compressed);
}

PG_FUNCTION_INFO_V1(wt_gist_consistent);
Datum
wt_gist_consistent(PG_FUNCTION_ARGS)
{
	const GISTENTRY *entry = (const GISTENTRY *) PG_GETARG_POINTER(0);
	StrategyNumber strategy = (StrategyNumber) PG_GETARG_UINT16(2);
	bool	   *recheck = (bool *) PG_GETARG_POINTER(4);
	const SolidBox query = box_of_query(PG_GETARG_DATUM(1), strategy);
	const SolidBox *key = box_of_key(entry);

	*recheck = false;
	switch (strategy % BOX_STRATEGIES)
	{
		case OVERLAPS:
			PG_RETURN_BOOL(boxes_overlap(key, &query));
		case CONTAINS:
			PG_RETURN_BOOL(box_contains(key, &query));
		case WITHIN:
			PG_RETURN_BOOL(GIST_LEAF(entry) ? box_contains(&query, key) : boxes_overlap(key, &query));
		default:
			elog(ERROR, "the index has no operator of number %d", strategy);
	}
	PG_RETURN_BOOL(false);		/* not reached */
}

PG_FUNCTION_INFO_V1(wt_gist_distance);
Datum
wt_gist_distance(PG_FUNCTION_ARGS)
{
	const GISTENTRY *entry = (const GISTENTRY *) PG_GETARG_POINTER(0);
	const SolidBox query = box_of_query(PG_GETARG_DATUM(1), (StrategyNumber) PG_GETARG_UINT16(2));

	PG_RETURN_FLOAT8(distance_of_boxes(box_of_key(entry), &query));
}

PG_FUNCTION_INFO_V1(wt_gist_union);
Datum
wt_gist_union(PG_FUNCTION_ARGS)
{
	const GistEntryVector *entries = (const GistEntryVector *) PG_GETARG_POINTER(0);
	int		   *size = (int *) PG_GETARG_POINTER(1);
	SolidBox   *all = palloc(sizeof(SolidBox));

	*all = *box_of_key(&entries->vector[0]);
	for (int i = 1; i < entries->n; ++i)
		extend_box(all, box_of_key(&entries->vector[i]));
	*size = sizeof(SolidBox);
	PG_RETURN_POINTER(all);
}

/* How much the sides of a key grow with a new box. */
PG_FUNCTION_INFO_V1(wt_gist_penalty);
Datum
wt_gist_penalty(PG_FUNCTION_ARGS)
{
	const SolidBox *key = box_of_key((const GISTENTRY *) PG_GETARG_POINTER(0));
	const SolidBox *added = box_of_key((const GISTENTRY *) PG_GETARG_POINTER(1));
	float	   *penalty = (float *) PG_GETARG_POINTER(2);
	SolidBox	grown = *key;

	extend_box(&grown, added);
	*penalty = (float) (margin_of(&grown) - margin_of(key));
	PG_RETURN_POINTER(penalty);
}

PG_FUNCTION_INFO_V1(wt_gist_same);
Datum
wt_gist_same(PG_FUNCTION_ARGS)
{
	const SolidBox *left = (const SolidBox *) PG_GETARG_POINTER(0);
	const SolidBox *right = (const SolidBox *) PG_GETARG_POINTER(1);
	bool	   *same = (bool *) PG_GETARG_POINTER(2);

	*same = box_contains(left, right) && box_contains(right, left);
	PG_RETURN_POINTER(same);
}

typedef struct Middle
{
	double		place;			/* on the axis of the split, twice the middle */
	OffsetNumber number;
} Middle;

static int
compare_middles(const void *left, const void *right)
{
	const Middle *one = (const Middle *) left;
	const Middle *other = (const Middle *) right;

	if (one->place != other->place)
		return one->place < other->place ? -1 : 1;
	return (int) one->number - (int) other->number;
}

/* The axis on which the middles of boxes are farthest apart. */
static int
widest_axis(const GistEntryVector *entries)
{
	int			widest = 0;
	double		width = -1;

	for (int axis = 0; axis < 3; ++axis)
	{
		double		least = INFINITY;
		double		most = -INFINITY;

		for (OffsetNumber i = FirstOffsetNumber; i < entries->n; i = OffsetNumberNext(i))
		{
			const SolidBox *box = box_of_key(&entries->vector[i]);
			double		middle = box->min[axis] + box->max[axis];

			least = Min(least, middle);
			most = Max(most, middle);
		}
		if (most - least > width)
		{
			width = most - least;
			widest = axis;
		}
	}
	return widest;
}

static void
put_in(OffsetNumber *list, int *count, SolidBox *around, const GistEntryVector *entries,
	   OffsetNumber number)
{
	const SolidBox *box = box_of_key(&entries->vector[number]);

	if (*count == 0)
		*around = *box;
	else
		extend_box(around, box);
	list[(*count)++] = number;
}

/* Halves the boxes of a page by their middles on the axis where these are farthest apart. */
PG_FUNCTION_INFO_V1(wt_gist_picksplit);
Datum
wt_gist_picksplit(PG_FUNCTION_ARGS)
{
	const GistEntryVector *entries = (const GistEntryVector *) PG_GETARG_POINTER(0);
	GIST_SPLITVEC *split = (GIST_SPLITVEC *) PG_GETARG_POINTER(1);
	int			count = entries->n - 1; /* the first place is not used */
	int			axis = widest_axis(entries);
	Middle	   *middles = palloc(sizeof(Middle) * count);
	SolidBox   *left = palloc(sizeof(SolidBox));
	SolidBox   *right = palloc(sizeof(SolidBox));

	for (int i = 0; i < count; ++i)
	{
		const SolidBox *box = box_of_key(&entries->vector[i + 1]);

		middles[i].place = box->min[axis] + box->max[axis];
		middles[i].number = (OffsetNumber) (i + 1);
	}
	qsort(middles, count, sizeof(Middle), compare_middles);
	split->spl_left = palloc(sizeof(OffsetNumber) * count);
	split->spl_right = palloc(sizeof(OffsetNumber) * count);
	split->spl_nleft = 0;
	split->spl_nright = 0;
	for (int i = 0; i < count; ++i)
	{
		if (i < count / 2)
			put_in(split->spl_left, &split->spl_nleft, left, entries, middles[i].number);
		else
			put_in(split->spl_right, &split->spl_nright, right, entries, middles[i].number);
	}
	split->spl_ldatum = PointerGetDatum(left);
	split->spl_rdatum = PointerGetDatum(right);
	PG_RETURN_POINTER(split);
}

/* What BRIN's inclusion classes keep of a range of pages: PostgreSQL's functions read it. */
#define RANGE_BOX 0
#define RANGE_IS_UNMERGEABLE 1
#define RANGE_HAS_EMPTY 2

/* Makes the box of a range hold a solid; whether it became larger. */
PG_FUNCTION_INFO_V1(wt_box_brin_add);
Datum
wt_box_brin_add(PG_FUNCTION_ARGS)
{
	BrinValues *range = (BrinValues *) PG_GETARG_POINTER(1);
	SolidBox   *kept;
	SolidBox	box;

	box = box_of_solid(PG_GETARG_DATUM(2));
	if (range->bv_allnulls)
	{
		kept = palloc(sizeof(SolidBox));
		*kept = box;
		range->bv_values[RANGE_BOX] = PointerGetDatum(kept);
		range->bv_values[RANGE_IS_UNMERGEABLE] = BoolGetDatum(false);
		range->bv_values[RANGE_HAS_EMPTY] = BoolGetDatum(false);
		range->bv_allnulls = false;
		PG_RETURN_BOOL(true);
	}
	kept = (SolidBox *) DatumGetPointer(range->bv_values[RANGE_BOX]);
	if (box_contains(kept, &box))
		PG_RETURN_BOOL(false);
	extend_box(kept, &box);
	PG_RETURN_BOOL(true);
}
