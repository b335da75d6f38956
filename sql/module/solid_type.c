/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The type `solid`: input and output, casts, comparison, and the facts that stand in its values
 * (sql/solid_value.h). A value is made by the bridge alone, so that none holds an invalid solid.
 */
#include "postgres.h"

#include <math.h>

#include "catalog/pg_type.h"
#include "common/hashfn.h"
#include "funcapi.h"
#include "libpq/pqformat.h"
#include "mb/pg_wchar.h"
#include "utils/array.h"
#include "utils/builtins.h"

#include "sql/module/backend.h"
#include "sql/module/solid_facts.h"

/* The fewest bytes of a value: facts, and a blob that is not empty. */
#define LEAST_SIZE (WATERTIGHT_SOLID_BLOB + 1)

static void
refuse_damaged(void)
{
	ereport(ERROR,
			(errcode(ERRCODE_DATA_CORRUPTED), errmsg("a solid is damaged, or of a later version")));
}

void
read_solid_facts(Datum solid, SolidFacts *facts)
{
	struct varlena *value = (struct varlena *) DatumGetPointer(solid);
	struct varlena *head = value;
	const char *bytes;

	/* Only a value that lies elsewhere is fetched, and of that only the start. */
	if (VARATT_IS_EXTERNAL(value) || VARATT_IS_COMPRESSED(value))
		head = PG_DETOAST_DATUM_SLICE(solid, 0, LEAST_SIZE);
	bytes = VARDATA_ANY(head);
	if (VARSIZE_ANY_EXHDR(head) < LEAST_SIZE || bytes[0] != WATERTIGHT_SOLID_LAYOUT)
		refuse_damaged();
	memcpy(facts->box, bytes + WATERTIGHT_SOLID_BOX, sizeof facts->box);
	memcpy(&facts->volume, bytes + WATERTIGHT_SOLID_VOLUME, sizeof facts->volume);
	memcpy(&facts->area, bytes + WATERTIGHT_SOLID_AREA, sizeof facts->area);
	memcpy(&facts->hash, bytes + WATERTIGHT_SOLID_HASH, sizeof facts->hash);
	memcpy(&facts->srid, bytes + WATERTIGHT_SOLID_SRID, sizeof facts->srid);
	if (head != value)
		pfree(head);
}

wt_job
job_on_solid(Datum solid)
{
	struct varlena *value = PG_DETOAST_DATUM_PACKED(solid);

	if (VARSIZE_ANY_EXHDR(value) < LEAST_SIZE || *VARDATA_ANY(value) != WATERTIGHT_SOLID_LAYOUT)
		refuse_damaged();
	return new_job((const uint8_t *) VARDATA_ANY(value) + WATERTIGHT_SOLID_BLOB,
				   VARSIZE_ANY_EXHDR(value) - WATERTIGHT_SOLID_BLOB, NULL, false);
}

wt_reply *
run_on_solid(bridge_function function, Datum solid)
{
	wt_reply   *reply = new_reply();
	wt_job		job = job_on_solid(solid);

	function(&job, reply);
	check_reply(reply);
	return reply;
}

static Datum
value_of(bridge_function function, const char *bytes, size_t size, const wt_rule_choice *rules)
{
	wt_reply   *reply = new_reply();
	wt_job		job = new_job((const uint8_t *) bytes, size, rules, true);

	function(&job, reply);
	check_reply(reply);
	return bytea_of(reply);
}

static bool
is_hexadecimal(const char *text, size_t length)
{
	return length > 0 && length % 2 == 0 && strspn(text, "0123456789abcdefABCDEF") == length;
}

/* Reads a blob or EWKB in hexadecimal digits (after \x, as bytea is written, or without), or WKT. */
PG_FUNCTION_INFO_V1(wt_solid_in);
Datum
wt_solid_in(PG_FUNCTION_ARGS)
{
	char	   *text = PG_GETARG_CSTRING(0);
	size_t		length;
	char	   *bytes;
	bool		is_bytea;

	text += strspn(text, " \t\r\n");
	length = strlen(text);
	while (length > 0 && strchr(" \t\r\n", text[length - 1]) != NULL)
		--length;
	text = pnstrdup(text, length);
	is_bytea = strncmp(text, "\\x", 2) == 0;
	if (is_bytea)
	{
		text += 2;
		length -= 2;
	}
	if (!is_bytea && !is_hexadecimal(text, length))
	{
		text = pg_server_to_any(text, (int) length, PG_UTF8);
		return value_of(wt_bridge_solid_of_wkt, text, strlen(text), NULL);
	}
	bytes = palloc(length / 2 + 1);
	length = hex_decode(text, length, bytes);
	return value_of(wt_bridge_solid, bytes, length, NULL);
}

/* The blob in hexadecimal digits: nothing is lost. */
PG_FUNCTION_INFO_V1(wt_solid_out);
Datum
wt_solid_out(PG_FUNCTION_ARGS)
{
	wt_job		job = job_on_solid(PG_GETARG_DATUM(0));
	char	   *text = palloc(2 * job.size + 1);

	text[hex_encode((const char *) job.bytes, job.size, text)] = '\0';
	PG_RETURN_CSTRING(text);
}

PG_FUNCTION_INFO_V1(wt_solid_recv);
Datum
wt_solid_recv(PG_FUNCTION_ARGS)
{
	StringInfo	message = (StringInfo) PG_GETARG_POINTER(0);
	int			size = message->len - message->cursor;

	return value_of(wt_bridge_solid, pq_getmsgbytes(message, size), (size_t) size, NULL);
}

PG_FUNCTION_INFO_V1(wt_solid_blob);
Datum
wt_solid_blob(PG_FUNCTION_ARGS)
{
	wt_job		job = job_on_solid(PG_GETARG_DATUM(0));
	bytea	   *blob = palloc(VARHDRSZ + job.size);

	SET_VARSIZE(blob, VARHDRSZ + job.size);
	memcpy(VARDATA(blob), job.bytes, job.size);
	PG_RETURN_BYTEA_P(blob);
}

/* The solid of EWKB or of a blob; by the rules of a second argument, if there is one. */
static wt_reply *
judge_solid(FunctionCallInfo fcinfo)
{
	bytea	   *input = PG_GETARG_BYTEA_PP(0);
	wt_rule_choice rules = PG_NARGS() < 2 ? wt_default_rules() : rules_of_jsonb(PG_GETARG_JSONB_P(1));
	wt_reply   *reply = new_reply();
	wt_job		job = new_job((const uint8_t *) VARDATA_ANY(input), VARSIZE_ANY_EXHDR(input), &rules,
							  true);

	wt_bridge_solid(&job, reply);
	return reply;
}

PG_FUNCTION_INFO_V1(wt_solid_of_bytes);
Datum
wt_solid_of_bytes(PG_FUNCTION_ARGS)
{
	wt_reply   *reply = judge_solid(fcinfo);

	check_reply(reply);
	PG_RETURN_DATUM(bytea_of(reply));
}

/* The same; NULL if the solid is invalid. What cannot be read, or is undecided, is an error. */
PG_FUNCTION_INFO_V1(wt_try_solid);
Datum
wt_try_solid(PG_FUNCTION_ARGS)
{
	wt_reply   *reply = judge_solid(fcinfo);

	if (reply->failure.is_invalid)
		PG_RETURN_NULL();
	check_reply(reply);
	PG_RETURN_DATUM(bytea_of(reply));
}

PG_FUNCTION_INFO_V1(wt_solid_info);
Datum
wt_solid_info(PG_FUNCTION_ARGS)
{
	PG_RETURN_DATUM(jsonb_of(run_on_solid(wt_bridge_info, PG_GETARG_DATUM(0))));
}

PG_FUNCTION_INFO_V1(wt_solid_rules);
Datum
wt_solid_rules(PG_FUNCTION_ARGS)
{
	PG_RETURN_DATUM(jsonb_of(run_on_solid(wt_bridge_rules_of, PG_GETARG_DATUM(0))));
}

/* Measures that stand in the value. */

PG_FUNCTION_INFO_V1(wt_solid_volume);
Datum
wt_solid_volume(PG_FUNCTION_ARGS)
{
	SolidFacts	facts;

	read_solid_facts(PG_GETARG_DATUM(0), &facts);
	PG_RETURN_FLOAT8(facts.volume);
}

PG_FUNCTION_INFO_V1(wt_solid_area);
Datum
wt_solid_area(PG_FUNCTION_ARGS)
{
	SolidFacts	facts;

	read_solid_facts(PG_GETARG_DATUM(0), &facts);
	PG_RETURN_FLOAT8(facts.area);
}

PG_FUNCTION_INFO_V1(wt_solid_srid);
Datum
wt_solid_srid(PG_FUNCTION_ARGS)
{
	SolidFacts	facts;

	read_solid_facts(PG_GETARG_DATUM(0), &facts);
	PG_RETURN_INT32((int32) facts.srid);
}

/* Measures that take the coordinates. */

static wt_measures
measures_of_argument(FunctionCallInfo fcinfo)
{
	wt_reply   *reply = new_reply();
	wt_job		job = job_on_solid(PG_GETARG_DATUM(0));
	wt_measures measures;

	wt_bridge_measures(&job, &measures, reply);
	check_reply(reply);
	return measures;
}

PG_FUNCTION_INFO_V1(wt_solid_bbox);
Datum
wt_solid_bbox(PG_FUNCTION_ARGS)
{
	wt_measures measures = measures_of_argument(fcinfo);
	SolidBox   *box = palloc(sizeof(SolidBox));

	memcpy(box->min, measures.box_min, sizeof box->min);
	memcpy(box->max, measures.box_max, sizeof box->max);
	PG_RETURN_POINTER(box);
}

PG_FUNCTION_INFO_V1(wt_solid_vertex_count);
Datum
wt_solid_vertex_count(PG_FUNCTION_ARGS)
{
	PG_RETURN_INT32((int32) measures_of_argument(fcinfo).vertices);
}

PG_FUNCTION_INFO_V1(wt_solid_facet_count);
Datum
wt_solid_facet_count(PG_FUNCTION_ARGS)
{
	PG_RETURN_INT32((int32) measures_of_argument(fcinfo).facets);
}

PG_FUNCTION_INFO_V1(wt_solid_shell_count);
Datum
wt_solid_shell_count(PG_FUNCTION_ARGS)
{
	PG_RETURN_INT32((int32) measures_of_argument(fcinfo).shells);
}

PG_FUNCTION_INFO_V1(wt_solid_genus);
Datum
wt_solid_genus(PG_FUNCTION_ARGS)
{
	wt_reply   *reply = new_reply();
	wt_job		job = job_on_solid(PG_GETARG_DATUM(0));
	int64_t		genus;

	wt_bridge_genus(&job, &genus, reply);
	check_reply(reply);
	PG_RETURN_INT64(genus);
}

Datum
array_of(const double numbers[3])
{
	Datum		elements[3];

	for (int i = 0; i < 3; ++i)
		elements[i] = Float8GetDatum(numbers[i]);
	return PointerGetDatum(construct_array(elements, 3, FLOAT8OID, sizeof(float8), FLOAT8PASSBYVAL,
										   TYPALIGN_DOUBLE));
}

PG_FUNCTION_INFO_V1(wt_solid_centroid);
Datum
wt_solid_centroid(PG_FUNCTION_ARGS)
{
	wt_reply   *reply = new_reply();
	wt_job		job = job_on_solid(PG_GETARG_DATUM(0));
	double		centroid[3];

	wt_bridge_centroid(&job, centroid, reply);
	check_reply(reply);
	PG_RETURN_DATUM(array_of(centroid));
}

PG_FUNCTION_INFO_V1(wt_solid_volume_below);
Datum
wt_solid_volume_below(PG_FUNCTION_ARGS)
{
	wt_reply   *reply = new_reply();
	wt_job		job = job_on_solid(PG_GETARG_DATUM(0));
	double		height = PG_GETARG_FLOAT8(1);
	double		volume;

	if (!isfinite(height))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE), errmsg("the height is not a finite number")));
	wt_bridge_volume_below(&job, height, &volume, reply);
	check_reply(reply);
	PG_RETURN_FLOAT8(volume);
}

/* The facets of a solid, as rows. */
PG_FUNCTION_INFO_V1(wt_solid_faces);
Datum
wt_solid_faces(PG_FUNCTION_ARGS)
{
	ReturnSetInfo *result = (ReturnSetInfo *) fcinfo->resultinfo;
	wt_reply   *reply = run_on_solid(wt_bridge_faces, PG_GETARG_DATUM(0));
	const wt_face *faces = (const wt_face *) reply->bytes;
	size_t		count = reply->size / sizeof(wt_face);

	InitMaterializedSRF(fcinfo, 0);
	for (size_t i = 0; i < count; ++i)
	{
		const wt_face *face = &faces[i];
		Datum		values[9];
		bool		nulls[9] = {false};

		values[0] = Int32GetDatum((int32) face->shell);
		values[1] = Int32GetDatum((int32) face->facet);
		values[2] = Float8GetDatum(face->area);
		values[3] = array_of(face->normal);
		values[4] = Float8GetDatum(face->tilt);
		values[5] = Float8GetDatum(face->azimuth);
		nulls[5] = isnan(face->azimuth);
		values[6] = array_of(face->centroid);
		values[7] = Float8GetDatum(face->planarity);
		values[8] = Int32GetDatum((int32) face->rings);
		tuplestore_putvalues(result->setResult, result->setDesc, values, nulls);
	}
	wt_reply_clear(reply);
	return (Datum) 0;
}

/* Comparison, by canonical forms. Unequal solids nearly always have unequal hashes, so that their
 * coordinates are seldom compared. */

static int
compare(Datum left, Datum right)
{
	SolidFacts	one;
	SolidFacts	other;
	wt_job		job;
	wt_job		other_job;
	wt_reply   *reply;
	int			order;

	read_solid_facts(left, &one);
	read_solid_facts(right, &other);
	if (one.hash != other.hash)
		return one.hash < other.hash ? -1 : 1;
	job = job_on_solid(left);
	other_job = job_on_solid(right);
	if (job.size == other_job.size && memcmp(job.bytes, other_job.bytes, job.size) == 0)
		return 0;
	reply = new_reply();
	order = wt_bridge_compare(&job, other_job.bytes, other_job.size, reply);
	check_reply(reply);
	return order;
}

static int
compare_arguments(FunctionCallInfo fcinfo)
{
	return compare(PG_GETARG_DATUM(0), PG_GETARG_DATUM(1));
}

#define COMPARISON(name, statement) \
	PG_FUNCTION_INFO_V1(name); \
	Datum \
	name(PG_FUNCTION_ARGS) \
	{ \
		int			order = compare_arguments(fcinfo); \
\
		PG_RETURN_BOOL(statement); \
	}

COMPARISON(wt_solid_lt, order < 0)
COMPARISON(wt_solid_le, order <= 0)
COMPARISON(wt_solid_eq, order == 0)
COMPARISON(wt_solid_ne, order != 0)
COMPARISON(wt_solid_ge, order >= 0)
COMPARISON(wt_solid_gt, order > 0)

PG_FUNCTION_INFO_V1(wt_solid_cmp);
Datum
wt_solid_cmp(PG_FUNCTION_ARGS)
{
	PG_RETURN_INT32(compare_arguments(fcinfo));
}

PG_FUNCTION_INFO_V1(wt_solid_hash);
Datum
wt_solid_hash(PG_FUNCTION_ARGS)
{
	SolidFacts	facts;

	read_solid_facts(PG_GETARG_DATUM(0), &facts);
	return hash_any((const unsigned char *) &facts.hash, sizeof facts.hash);
}

PG_FUNCTION_INFO_V1(wt_solid_hash_extended);
Datum
wt_solid_hash_extended(PG_FUNCTION_ARGS)
{
	SolidFacts	facts;

	read_solid_facts(PG_GETARG_DATUM(0), &facts);
	return hash_any_extended((const unsigned char *) &facts.hash, sizeof facts.hash,
							 (uint64) PG_GETARG_INT64(1));
}
