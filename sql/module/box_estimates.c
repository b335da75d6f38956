/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * How many rows an operator on boxes selects. ANALYZE keeps cells of a column's boxes, by a k-d tree
 * over their middles: each cell has the bounds of its middles, the mean sides of its boxes, and its
 * share of all. A set is split where its middles leave a wide gap, else in halves, so that towns
 * far apart, in other reference systems too, are in different cells. An estimate counts the middles
 * in the region where a box of mean sides fulfils the operator.
 */
#include "postgres.h"

#include <math.h>

#include "access/htup_details.h"
#include "catalog/pg_type.h"
#include "commands/vacuum.h"
#include "fmgr.h"
#include "miscadmin.h"
#include "nodes/primnodes.h"
#include "utils/lsyscache.h"
#include "utils/selfuncs.h"

#include "sql/module/boxes.h"

/* The kind of the cells in pg_statistic; 10000 to 30000 are free for anyone. */
#define CELLS_KIND 20743
#define MOST_CELLS 256
#define BOXES_PER_CELL 4
#define WIDE_GAP 0.25			/* of the extent of a set */

/* Estimates where nothing is known, as PostgreSQL has them for its own boxes. */
#define OVERLAPS_UNKNOWN 0.005
#define CONTAINS_UNKNOWN 0.001

typedef enum BoxRelation
{
	OVERLAPS,
	CONTAINS,
	WITHIN
} BoxRelation;

/* What pg_statistic keeps of a part of the boxes, as numbers. */
typedef struct Cell
{
	float4		low[3];			/* bounds of the middles */
	float4		high[3];
	float4		sides[3];		/* mean */
	float4		share;			/* of all boxes */
} Cell;

typedef struct Cells
{
	Cell	   *cells;
	int			count;
} Cells;

static double
middle_of(const SolidBox *box, int axis)
{
	return box->min[axis] / 2 + box->max[axis] / 2;
}

#define COMPARISON(name, axis) \
	static int \
	name(const void *left, const void *right) \
	{ \
		double		one = middle_of((const SolidBox *) left, axis); \
		double		other = middle_of((const SolidBox *) right, axis); \
\
		return one < other ? -1 : one > other; \
	}

COMPARISON(by_x, 0)
COMPARISON(by_y, 1)
COMPARISON(by_z, 2)

static int	(*const by_axis[3]) (const void *, const void *) = {by_x, by_y, by_z};

static void
find_bounds(const SolidBox *boxes, int count, int axis, double *low, double *high)
{
	*low = *high = middle_of(&boxes[0], axis);
	for (int i = 1; i < count; ++i)
	{
		*low = Min(*low, middle_of(&boxes[i], axis));
		*high = Max(*high, middle_of(&boxes[i], axis));
	}
}

static Cell
cell_of(const SolidBox *boxes, int count, int all)
{
	Cell		cell;

	for (int axis = 0; axis < 3; ++axis)
	{
		double		low;
		double		high;
		double		sum = 0;

		find_bounds(boxes, count, axis, &low, &high);
		for (int i = 0; i < count; ++i)
			sum += boxes[i].max[axis] - boxes[i].min[axis];
		cell.low[axis] = (float4) low;
		cell.high[axis] = (float4) high;
		cell.sides[axis] = (float4) (sum / count);
	}
	cell.share = (float4) ((double) count / all);
	return cell;
}

/* The number of boxes before the widest gap of sorted ones, or half of them if no gap is wide. */
static int
find_split(const SolidBox *boxes, int count, int axis)
{
	double		extent = middle_of(&boxes[count - 1], axis) - middle_of(&boxes[0], axis);
	double		widest = 0;
	int			split = count / 2;

	for (int i = 1; i < count; ++i)
	{
		double		gap = middle_of(&boxes[i], axis) - middle_of(&boxes[i - 1], axis);

		if (gap > WIDE_GAP * extent && gap > widest)
		{
			widest = gap;
			split = i;
		}
	}
	return split;
}

/* Adds at most so many cells for boxes, which are sorted on the way. Each half of a split gets cells
 * by its number of boxes, and at least one. */
static void
add_cells(Cells *cells, SolidBox *boxes, int count, int most, int all)
{
	int			widest = 0;
	double		extent = 0;
	int			split;
	int			first;

	for (int axis = 0; axis < 3; ++axis)
	{
		double		low;
		double		high;

		find_bounds(boxes, count, axis, &low, &high);
		if (high - low > extent)
		{
			extent = high - low;
			widest = axis;
		}
	}
	if (most < 2 || !(extent > 0))
	{
		cells->cells[cells->count++] = cell_of(boxes, count, all);
		return;
	}
	CHECK_FOR_INTERRUPTS();
	qsort(boxes, count, sizeof(SolidBox), by_axis[widest]);
	split = find_split(boxes, count, widest);
	first = (int) ((int64) most * split / count);
	first = Min(Max(first, 1), most - 1);
	add_cells(cells, boxes, split, first, all);
	add_cells(cells, boxes + split, count - split, most - first, all);
}

/* The share of middles between two bounds of a cell, which are spread evenly. */
static double
share_between(double from, double to, double low, double high)
{
	if (low > high || to < low || from > high)
		return 0;
	if (!(to > from))
		return 1;
	return (Min(to, high) - Max(from, low)) / (to - from);
}

/* Where the middle of a box with a side of this length is, if the box and another have the relation. */
static void
find_region(BoxRelation relation, const SolidBox *other, int axis, double side, double *low, double *high)
{
	double		half = relation == OVERLAPS ? -side / 2 : side / 2;

	*low = (relation == CONTAINS ? other->max[axis] - side : other->min[axis]) + half;
	*high = (relation == CONTAINS ? other->min[axis] + side : other->max[axis]) - half;
}

/* The share of boxes that have a relation to another box. */
static double
share_of(const Cells *cells, BoxRelation relation, const SolidBox *other)
{
	double		sum = 0;

	for (int i = 0; i < cells->count; ++i)
	{
		const Cell *cell = &cells->cells[i];
		double		share = cell->share;

		for (int axis = 0; axis < 3 && share > 0; ++axis)
		{
			double		low;
			double		high;

			find_region(relation, other, axis, cell->sides[axis], &low, &high);
			share *= share_between(cell->low[axis], cell->high[axis], low, high);
		}
		sum += share;
	}
	return sum;
}

/* The mean share of boxes that have a relation to a box of other cells, each in the middle of its own. */
static double
share_of_pairs(const Cells *cells, BoxRelation relation, const Cells *others)
{
	double		sum = 0;

	for (int i = 0; i < others->count; ++i)
	{
		const Cell *cell = &others->cells[i];
		SolidBox	box;

		for (int axis = 0; axis < 3; ++axis)
		{
			double		middle = ((double) cell->low[axis] + cell->high[axis]) / 2;

			box.min[axis] = middle - cell->sides[axis] / 2;
			box.max[axis] = middle + cell->sides[axis] / 2;
		}
		sum += cell->share * share_of(cells, relation, &box);
	}
	return sum;
}

/* PostgreSQL's own statistics of the column, which `=` and `<` use, are made by these. */
typedef struct OwnStatistics
{
	AnalyzeAttrComputeStatsFunc compute;
	void	   *extra_data;
} OwnStatistics;

static void
keep_cells(VacAttrStats *statistics, AnalyzeAttrFetchFunc fetch, int rows)
{
	SolidBox   *boxes = palloc_extended(sizeof(SolidBox) * Max(rows, 1), MCXT_ALLOC_HUGE);
	int			count = 0;
	int			slot = 0;
	Cells		cells = {NULL, 0};

	for (int row = 0; row < rows; ++row)
	{
		bool		is_null;
		Datum		value = fetch(statistics, row, &is_null);

		CHECK_FOR_INTERRUPTS();
		if (!is_null)
			boxes[count++] = box_of_solid(value);
	}
	while (slot < STATISTIC_NUM_SLOTS && statistics->stakind[slot] != 0)
		++slot;
	if (count == 0 || slot == STATISTIC_NUM_SLOTS)
		return;
	cells.cells = MemoryContextAlloc(statistics->anl_context, sizeof(Cell) * MOST_CELLS);
	add_cells(&cells, boxes, count, Min(Max(count / BOXES_PER_CELL, 1), MOST_CELLS), count);
	statistics->stakind[slot] = CELLS_KIND;
	statistics->stanumbers[slot] = (float4 *) cells.cells;
	statistics->numnumbers[slot] = (int) (sizeof(Cell) / sizeof(float4)) * cells.count;
	statistics->stats_valid = true;
}

static void
compute_statistics(VacAttrStats *statistics, AnalyzeAttrFetchFunc fetch, int rows, double all_rows)
{
	OwnStatistics *own = (OwnStatistics *) statistics->extra_data;

	statistics->extra_data = own->extra_data;
	own->compute(statistics, fetch, rows, all_rows);
	statistics->extra_data = own;
	keep_cells(statistics, fetch, rows);
}

PG_FUNCTION_INFO_V1(wt_solid_analyze);
Datum
wt_solid_analyze(PG_FUNCTION_ARGS)
{
	VacAttrStats *statistics = (VacAttrStats *) PG_GETARG_POINTER(0);
	OwnStatistics *own;

	if (!std_typanalyze(statistics))
		PG_RETURN_BOOL(false);
	own = palloc(sizeof(OwnStatistics));
	own->compute = statistics->compute_stats;
	own->extra_data = statistics->extra_data;
	statistics->compute_stats = compute_statistics;
	statistics->extra_data = own;
	PG_RETURN_BOOL(true);
}

/* The cells of a column; false if there are none. Sets the share of rows that are not NULL. */
static bool
find_column(VariableStatData *variable, Cells *cells, double *not_null)
{
	AttStatsSlot slot;
	size_t		bytes;

	*not_null = 1;
	if (!HeapTupleIsValid(variable->statsTuple))
		return false;
	*not_null = 1 - ((Form_pg_statistic) GETSTRUCT(variable->statsTuple))->stanullfrac;
	if (!get_attstatsslot(&slot, variable->statsTuple, CELLS_KIND, InvalidOid, ATTSTATSSLOT_NUMBERS))
		return false;
	bytes = slot.nnumbers * sizeof(float4);
	cells->count = (int) (bytes / sizeof(Cell));
	cells->cells = palloc(bytes);
	memcpy(cells->cells, slot.numbers, bytes);
	free_attstatsslot(&slot);
	return cells->count > 0;
}

static double
unknown_share(BoxRelation relation)
{
	return relation == OVERLAPS ? OVERLAPS_UNKNOWN : CONTAINS_UNKNOWN;
}

/* The relation of the right side to the left one. */
static BoxRelation
reversed(BoxRelation relation)
{
	return relation == CONTAINS ? WITHIN : relation == WITHIN ? CONTAINS : OVERLAPS;
}

static double
share_of_rows(FunctionCallInfo fcinfo, BoxRelation relation)
{
	PlannerInfo *root = (PlannerInfo *) PG_GETARG_POINTER(0);
	List	   *arguments = (List *) PG_GETARG_POINTER(2);
	VariableStatData variable;
	Node	   *other;
	bool		is_left;
	Cells		cells;
	double		not_null;
	double		share = unknown_share(relation);

	if (!get_restriction_variable(root, arguments, PG_GETARG_INT32(3), &variable, &other, &is_left))
		return share;
	if (find_column(&variable, &cells, &not_null))
	{
		const Const *constant = (const Const *) other;

		if (!is_left)
			relation = reversed(relation);
		if (!IsA(other, Const))
			share = not_null * share_of_pairs(&cells, relation, &cells);	/* a box like those of the column */
		else if (constant->constisnull)
			share = 0;
		else
		{
			/* The column is a solid, so the other side is one too or a box. */
			const SolidBox box = constant->consttype == variable.vartype ? box_of_solid(constant->constvalue)
				: *(const SolidBox *) DatumGetPointer(constant->constvalue);

			share = not_null * share_of(&cells, relation, &box);
		}
	}
	ReleaseVariableStats(variable);
	CLAMP_PROBABILITY(share);
	return share;
}

static double
share_of_joined(FunctionCallInfo fcinfo, BoxRelation relation)
{
	PlannerInfo *root = (PlannerInfo *) PG_GETARG_POINTER(0);
	List	   *arguments = (List *) PG_GETARG_POINTER(2);
	SpecialJoinInfo *join = (SpecialJoinInfo *) PG_GETARG_POINTER(4);
	VariableStatData left;
	VariableStatData right;
	bool		is_reversed;
	Cells		left_cells;
	Cells		right_cells;
	double		left_share;
	double		right_share;
	double		share = unknown_share(relation);

	get_join_variables(root, arguments, join, &left, &right, &is_reversed);
	if (find_column(&left, &left_cells, &left_share) && find_column(&right, &right_cells, &right_share))
		share = left_share * right_share * share_of_pairs(&left_cells, relation, &right_cells);
	ReleaseVariableStats(left);
	ReleaseVariableStats(right);
	CLAMP_PROBABILITY(share);
	return share;
}

#define ESTIMATES(name, relation) \
	PG_FUNCTION_INFO_V1(name##_sel); \
	Datum \
	name##_sel(PG_FUNCTION_ARGS) \
	{ \
		PG_RETURN_FLOAT8(share_of_rows(fcinfo, relation)); \
	} \
	PG_FUNCTION_INFO_V1(name##_joinsel); \
	Datum \
	name##_joinsel(PG_FUNCTION_ARGS) \
	{ \
		PG_RETURN_FLOAT8(share_of_joined(fcinfo, relation)); \
	}

ESTIMATES(wt_box_overlaps, OVERLAPS)
ESTIMATES(wt_box_contains, CONTAINS)
ESTIMATES(wt_box_within, WITHIN)
