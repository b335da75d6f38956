/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The function that makes polyhedra of curved solids.
 */
#include "postgres.h"

#include "mb/pg_wchar.h"
#include "utils/jsonb.h"

#include "sql/module/backend.h"

PG_FUNCTION_INFO_V1(wt_tessellate);
Datum
wt_tessellate(PG_FUNCTION_ARGS)
{
	wt_reply   *reply = new_reply();
	Jsonb	   *brep = PG_GETARG_JSONB_P(0);
	char	   *text = JsonbToCString(NULL, &brep->root, VARSIZE(brep));
	const char *utf8 = pg_server_to_any(text, (int) strlen(text), PG_UTF8);
	wt_job		job = new_job((const uint8_t *) utf8, strlen(utf8), NULL, true);

	wt_bridge_tessellate(&job, PG_GETARG_FLOAT8(1), reply);
	check_reply(reply);
	PG_RETURN_DATUM(bytea_of(reply));
}
