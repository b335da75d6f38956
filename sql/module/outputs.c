/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Functions that give solids to other programs.
 */
#include "postgres.h"

#include "catalog/pg_type.h"
#include "funcapi.h"
#include "mb/pg_wchar.h"
#include "utils/array.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"

#include "sql/module/backend.h"
#include "sql/module/solid_facts.h"

/* The UTF-8 text of a reply; frees the reply. */
static text *
text_of(wt_reply *reply)
{
	text	   *result = cstring_to_text(from_utf8((const char *) reply->bytes));

	wt_reply_clear(reply);
	return result;
}

PG_FUNCTION_INFO_V1(wt_solid_ewkb);
Datum
wt_solid_ewkb(PG_FUNCTION_ARGS)
{
	PG_RETURN_DATUM(bytea_of(run_on_solid(wt_bridge_decode, PG_GETARG_DATUM(0))));
}

PG_FUNCTION_INFO_V1(wt_solid_wkt);
Datum
wt_solid_wkt(PG_FUNCTION_ARGS)
{
	PG_RETURN_TEXT_P(text_of(run_on_solid(wt_bridge_wkt, PG_GETARG_DATUM(0))));
}

PG_FUNCTION_INFO_V1(wt_solid_obj);
Datum
wt_solid_obj(PG_FUNCTION_ARGS)
{
	PG_RETURN_TEXT_P(text_of(run_on_solid(wt_bridge_obj, PG_GETARG_DATUM(0))));
}

PG_FUNCTION_INFO_V1(wt_solid_glb);
Datum
wt_solid_glb(PG_FUNCTION_ARGS)
{
	PG_RETURN_DATUM(bytea_of(run_on_solid(wt_bridge_glb, PG_GETARG_DATUM(0))));
}

PG_FUNCTION_INFO_V1(wt_solid_boundary);
Datum
wt_solid_boundary(PG_FUNCTION_ARGS)
{
	PG_RETURN_DATUM(bytea_of(run_on_solid(wt_bridge_boundary, PG_GETARG_DATUM(0))));
}

/* The elements of an array, none of which is NULL. */
static Datum *
elements_of(ArrayType *array, int *count)
{
	Oid			type = ARR_ELEMTYPE(array);
	int16		length;
	bool		is_by_value;
	char		alignment;
	Datum	   *elements;
	bool	   *nulls;

	get_typlenbyvalalign(type, &length, &is_by_value, &alignment);
	deconstruct_array(array, type, length, is_by_value, alignment, &elements, &nulls, count);
	for (int i = 0; i < *count; ++i)
		if (nulls[i])
			ereport(ERROR,
					(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
					 errmsg("element %d of the array is NULL", i + 1)));
	return elements;
}

static wt_blob_view *
blobs_of(ArrayType *array, int *count)
{
	Datum	   *solids = elements_of(array, count);
	wt_blob_view *blobs = palloc(sizeof(wt_blob_view) * Max(*count, 1));

	for (int i = 0; i < *count; ++i)
	{
		wt_job		job = job_on_solid(solids[i]);

		blobs[i].bytes = job.bytes;
		blobs[i].size = job.size;
	}
	return blobs;
}

/* One CityJSON document of solids and their ids. */
static Datum
city_json_of(const wt_blob_view *blobs, const char *const *names, int count)
{
	wt_reply   *reply = new_reply();
	wt_job		job = new_job(NULL, 0, NULL, false);
	wt_named_blobs solids = {blobs, names, (size_t) count};

	wt_bridge_city_json(&job, &solids, reply);
	check_reply(reply);
	PG_RETURN_TEXT_P(text_of(reply));
}

static const char *
name_of(Datum id)
{
	char	   *name = TextDatumGetCString(id);

	return pg_server_to_any(name, (int) strlen(name), PG_UTF8);
}

PG_FUNCTION_INFO_V1(wt_solid_city_json);
Datum
wt_solid_city_json(PG_FUNCTION_ARGS)
{
	wt_job		job = job_on_solid(PG_GETARG_DATUM(0));
	wt_blob_view blob = {job.bytes, job.size};
	const char *name = name_of(PG_GETARG_DATUM(1));

	return city_json_of(&blob, &name, 1);
}

PG_FUNCTION_INFO_V1(wt_solid_city_json_of_array);
Datum
wt_solid_city_json_of_array(PG_FUNCTION_ARGS)
{
	int			count;
	int			names_count;
	wt_blob_view *blobs = blobs_of(PG_GETARG_ARRAYTYPE_P(0), &count);
	Datum	   *ids = elements_of(PG_GETARG_ARRAYTYPE_P(1), &names_count);
	const char **names = palloc(sizeof(char *) * Max(count, 1));

	if (names_count != count)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("there are %d solids and %d ids", count, names_count)));
	for (int i = 0; i < count; ++i)
		names[i] = name_of(ids[i]);
	return city_json_of(blobs, names, count);
}

/* A page of the solids of an array; NULL where there is none. */
PG_FUNCTION_INFO_V1(wt_solid_page);
Datum
wt_solid_page(PG_FUNCTION_ARGS)
{
	wt_reply   *reply = new_reply();
	wt_job		job = new_job(NULL, 0, NULL, false);
	int			count;
	wt_blob_view *blobs = blobs_of(PG_GETARG_ARRAYTYPE_P(0), &count);

	wt_bridge_page(&job, blobs, (size_t) count, reply);
	check_reply(reply);
	if (reply->size == 0)
		PG_RETURN_NULL();
	PG_RETURN_DATUM(bytea_of(reply));
}

/* The findings about the solids of an array as parts of one building. */
PG_FUNCTION_INFO_V1(wt_solid_parts);
Datum
wt_solid_parts(PG_FUNCTION_ARGS)
{
	wt_reply   *reply = new_reply();
	wt_job		job = new_job(NULL, 0, NULL, false);
	ArrayType  *array = PG_GETARG_ARRAYTYPE_P(0);
	int			count;
	wt_blob_view *blobs = blobs_of(array, &count);
	Datum	   *solids = elements_of(array, &count);
	SolidFacts	first;
	SolidFacts	other;

	for (int i = 0; i < count; ++i)
	{
		read_solid_facts(solids[i], i == 0 ? &first : &other);
		if (i > 0)
			check_one_system(&first, &other);
	}
	wt_bridge_parts(&job, blobs, (size_t) count, reply);
	check_reply(reply);
	PG_RETURN_DATUM(jsonb_of(reply));
}

/* The text of a feature in a row of the service. */
typedef struct StoredText
{
	wt_job		job;
	wt_blob_view dictionary;
	const char *id;
} StoredText;

/* The text that the first three arguments of a function are. */
static StoredText
stored_text(FunctionCallInfo fcinfo)
{
	bytea	   *packed = PG_GETARG_BYTEA_PP(0);
	bytea	   *dictionary = PG_GETARG_BYTEA_PP(1);
	StoredText	text;

	text.job = new_job((const uint8_t *) VARDATA_ANY(packed), VARSIZE_ANY_EXHDR(packed), NULL, false);
	text.dictionary.bytes = (const uint8_t *) VARDATA_ANY(dictionary);
	text.dictionary.size = VARSIZE_ANY_EXHDR(dictionary);
	text.id = name_of(PG_GETARG_DATUM(2));
	return text;
}

/* A reply as jsonb; NULL for one without bytes. */
static Datum
jsonb_or_null(FunctionCallInfo fcinfo, wt_reply *reply)
{
	check_reply(reply);
	if (reply->size == 0)
		PG_RETURN_NULL();
	PG_RETURN_DATUM(jsonb_of(reply));
}

/* The city model in a row of the service; NULL where there is none. */
PG_FUNCTION_INFO_V1(wt_solid_stored_model);
Datum
wt_solid_stored_model(PG_FUNCTION_ARGS)
{
	StoredText	text = stored_text(fcinfo);
	wt_reply   *reply = new_reply();

	wt_bridge_stored_model(&text.job, text.dictionary, text.id, reply);
	return jsonb_or_null(fcinfo, reply);
}

/* How the service has repaired a solid of a stored feature; NULL for one that came so. */
PG_FUNCTION_INFO_V1(wt_solid_stored_repair);
Datum
wt_solid_stored_repair(PG_FUNCTION_ARGS)
{
	StoredText	text = stored_text(fcinfo);
	wt_reply   *reply = new_reply();

	wt_bridge_stored_repair(&text.job, text.dictionary, text.id, (uint32_t) PG_GETARG_INT32(3), reply);
	return jsonb_or_null(fcinfo, reply);
}

/* The tetrahedra of a solid, as rows. */
PG_FUNCTION_INFO_V1(wt_solid_tetrahedra);
Datum
wt_solid_tetrahedra(PG_FUNCTION_ARGS)
{
	ReturnSetInfo *result = (ReturnSetInfo *) fcinfo->resultinfo;
	wt_reply   *reply = new_reply();
	wt_job		blob = job_on_solid(PG_GETARG_DATUM(0));
	wt_job		job = new_job(blob.bytes, blob.size, NULL, true);
	const wt_tetrahedron *tetrahedra;
	size_t		count;

	wt_bridge_tetrahedra(&job, reply);
	check_reply(reply);
	tetrahedra = (const wt_tetrahedron *) reply->bytes;
	count = reply->size / sizeof(wt_tetrahedron);
	InitMaterializedSRF(fcinfo, 0);
	for (size_t i = 0; i < count; ++i)
	{
		Datum		values[5];
		bool		nulls[5] = {false};

		values[0] = Int32GetDatum((int32) i);
		for (int corner = 0; corner < 4; ++corner)
			values[1 + corner] = array_of(tetrahedra[i].corners[corner]);
		tuplestore_putvalues(result->setResult, result->setDesc, values, nulls);
	}
	wt_reply_clear(reply);
	return (Datum) 0;
}

PG_FUNCTION_INFO_V1(wt_solid_translate);
Datum
wt_solid_translate(PG_FUNCTION_ARGS)
{
	wt_reply   *reply = new_reply();
	wt_job		job = job_on_solid(PG_GETARG_DATUM(0));
	double		way[3];

	read_place(fcinfo, 1, way);
	wt_bridge_translate(&job, way, reply);
	check_reply(reply);
	PG_RETURN_DATUM(bytea_of(reply));
}

/* The parts of a solid between two heights, as an array. */
PG_FUNCTION_INFO_V1(wt_solid_clip_z);
Datum
wt_solid_clip_z(PG_FUNCTION_ARGS)
{
	wt_reply   *reply = new_reply();
	wt_job		blob = job_on_solid(PG_GETARG_DATUM(0));
	wt_job		job = new_job(blob.bytes, blob.size, NULL, true);
	double		low = PG_GETARG_FLOAT8(1);
	double		high = PG_GETARG_FLOAT8(2);
	Datum	   *parts;
	int			count = 0;

	if (!(low < high))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("the lower height %g is not below the upper one %g", low, high)));
	wt_bridge_clip_z(&job, low, high, reply);
	check_reply(reply);
	parts = palloc(sizeof(Datum) * (reply->size / sizeof(uint32) + 1));
	for (size_t at = 0; at < reply->size;)
	{
		uint32		size;
		bytea	   *value;

		memcpy(&size, reply->bytes + at, sizeof(size));
		value = palloc(VARHDRSZ + size);
		SET_VARSIZE(value, VARHDRSZ + size);
		memcpy(VARDATA(value), reply->bytes + at + sizeof(size), size);
		parts[count++] = PointerGetDatum(value);
		at += sizeof(size) + size;
	}
	wt_reply_clear(reply);
	PG_RETURN_ARRAYTYPE_P(construct_array(parts, count, get_fn_expr_argtype(fcinfo->flinfo, 0), -1, false,
										  TYPALIGN_INT));
}

PG_FUNCTION_INFO_V1(wt_solid_transform);
Datum
wt_solid_transform(PG_FUNCTION_ARGS)
{
	wt_reply   *reply = new_reply();
	wt_job		blob = job_on_solid(PG_GETARG_DATUM(0));
	wt_job		job = new_job(blob.bytes, blob.size, NULL, true);
	int32		srid = PG_GETARG_INT32(1);

	if (srid <= 0)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE), errmsg("an EPSG code is a number above 0")));
	wt_bridge_transform(&job, (uint32_t) srid, reply);
	check_reply(reply);
	PG_RETURN_DATUM(bytea_of(reply));
}
