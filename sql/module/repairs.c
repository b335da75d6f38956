/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The functions that repair invalid solids.
 */
#include "postgres.h"

#include "mb/pg_wchar.h"
#include "utils/builtins.h"

#include "sql/module/backend.h"

typedef void (*repair_function) (const wt_job *job, const wt_repair_choice *choice, wt_reply *reply);

/* Runs a function of the bridge on EWKB, the names of remedies and the distance for welding. */
static wt_reply *
repair_by(repair_function function, FunctionCallInfo fcinfo)
{
	wt_reply   *reply = new_reply();
	bytea	   *input = PG_GETARG_BYTEA_PP(0);
	char	   *remedies = text_to_cstring(PG_GETARG_TEXT_PP(1));
	wt_repair_choice choice;
	wt_job		job = new_job((const uint8_t *) VARDATA_ANY(input), VARSIZE_ANY_EXHDR(input), NULL, true);

	choice.remedies = pg_server_to_any(remedies, (int) strlen(remedies), PG_UTF8);
	choice.weld = PG_GETARG_FLOAT8(2);
	if (!(choice.weld >= 0 && choice.weld <= WATERTIGHT_MOST_WELD))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE), errmsg("the distance for welding is outside its range"),
				 errdetail("It is %g; it can be from 0 to %g metres.", choice.weld, WATERTIGHT_MOST_WELD)));
	function(&job, &choice, reply);
	check_reply(reply);
	return reply;
}

PG_FUNCTION_INFO_V1(wt_repair);
Datum
wt_repair(PG_FUNCTION_ARGS)
{
	PG_RETURN_DATUM(bytea_of(repair_by(wt_bridge_repair, fcinfo)));
}

PG_FUNCTION_INFO_V1(wt_repair_report);
Datum
wt_repair_report(PG_FUNCTION_ARGS)
{
	PG_RETURN_DATUM(jsonb_of(repair_by(wt_bridge_repair_report, fcinfo)));
}
