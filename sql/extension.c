/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The SQL functions of the extension watertight. This file sees PostgreSQL and no geometry; the
 * work is behind bridge.h. Errors are raised here only, after the bridge has returned.
 */
#include "postgres.h"

#include "fmgr.h"
#include "mb/pg_wchar.h"
#include "miscadmin.h"
#include "storage/ipc.h"
#include "utils/builtins.h"
#include "utils/guc.h"
#include "utils/memutils.h"

#include "sql/bridge.h"

PG_MODULE_MAGIC;

void _PG_init(void);

/* A backend serves one connection in one thread, so its state can be static. */
static char *libexec_setting = NULL; /* watertight.libexec */
static int	max_seconds_setting = 300; /* watertight.max_seconds */
static int	max_memory_setting = 4096; /* watertight.max_memory, MB */
static wt_engine *engine = NULL;
static char *engine_libexec = NULL; /* the libexec with which `engine` was made */

static void
end_engine(int code, Datum argument)
{
	wt_engine_end(engine);
	engine = NULL;
}

static wt_engine *
current_engine(void)
{
	static bool registered = false;
	const char *libexec = libexec_setting == NULL ? "" : libexec_setting;

	if (engine != NULL && strcmp(engine_libexec, libexec) != 0)
		end_engine(0, (Datum) 0);
	if (engine != NULL)
		return engine;
	if (!registered)
	{
		on_proc_exit(end_engine, (Datum) 0);
		registered = true;
	}
	if (engine_libexec != NULL)
		pfree(engine_libexec);
	engine_libexec = NULL;
	engine_libexec = MemoryContextStrdup(TopMemoryContext, libexec);
	engine = wt_engine_make(libexec);
	if (engine == NULL)
		ereport(ERROR, (errcode(ERRCODE_OUT_OF_MEMORY), errmsg("out of memory")));
	return engine;
}

/* Whether the statement should end. Called from C++, so it must return. */
static bool
is_interrupted(void)
{
	return InterruptPending && (QueryCancelPending || ProcDiePending);
}

/* A reply that is freed with the memory context of the call, however the call is left. */
typedef struct OwnedReply
{
	MemoryContextCallback callback;
	wt_reply	reply;
} OwnedReply;

static void
clear_reply(void *owned)
{
	wt_reply_clear(&((OwnedReply *) owned)->reply);
}

static wt_reply *
new_reply(void)
{
	OwnedReply *owned = palloc0(sizeof(OwnedReply));

	owned->callback.func = clear_reply;
	owned->callback.arg = owned;
	MemoryContextRegisterResetCallback(CurrentMemoryContext, &owned->callback);
	return &owned->reply;
}

static char *
from_utf8(const char *text)
{
	return pg_any_to_server(text, (int) strlen(text), PG_UTF8);
}

static void
raise_failure(const wt_failure *failure)
{
	const char *state = failure->sqlstate;
	int			code = MAKE_SQLSTATE(state[0], state[1], state[2], state[3], state[4]);

	if (code == ERRCODE_QUERY_CANCELED)
	{
		/* PostgreSQL reports a requested end with its reason (statement_timeout, user, shutdown). */
		CHECK_FOR_INTERRUPTS();
		ereport(ERROR,
				(errcode(code), errmsg("%s", from_utf8(failure->message)),
				 errhint("Try again: a helper process crashed, or the solid needs more time or memory than it may use.")));
	}
	ereport(ERROR,
			(errcode(code), errmsg("%s", from_utf8(failure->message)),
			 failure->detail == NULL ? 0 : errdetail("%s", from_utf8(failure->detail))));
}

typedef void (*bridge_function) (const wt_job *job, wt_reply *reply);

/* Runs one bridge function on a bytea argument. Returns its reply, or raises. */
static wt_reply *
run(bridge_function function, Datum argument, bool needs_engine)
{
	wt_reply   *reply = new_reply();
	bytea	   *input = DatumGetByteaPP(argument);
	wt_job		job;

	job.bytes = (const uint8_t *) VARDATA_ANY(input);
	job.size = VARSIZE_ANY_EXHDR(input);
	job.engine = needs_engine ? current_engine() : NULL;
	job.poll = is_interrupted;
	job.max_seconds = (uint32_t) max_seconds_setting;
	job.max_memory = (uint32_t) max_memory_setting;
	function(&job, reply);
	CHECK_FOR_INTERRUPTS();
	if (reply->failure.sqlstate[0] != '\0')
		raise_failure(&reply->failure);
	return reply;
}

static Datum
bytea_of(wt_reply *reply)
{
	bytea	   *value = palloc(VARHDRSZ + reply->size);

	SET_VARSIZE(value, VARHDRSZ + reply->size);
	memcpy(VARDATA(value), reply->bytes, reply->size);
	wt_reply_clear(reply);
	return PointerGetDatum(value);
}

static Datum
jsonb_of(wt_reply *reply)
{
	Datum		value = DirectFunctionCall1(jsonb_in, CStringGetDatum(from_utf8((char *) reply->bytes)));

	wt_reply_clear(reply);
	return value;
}

PG_FUNCTION_INFO_V1(wt_validate);
Datum
wt_validate(PG_FUNCTION_ARGS)
{
	PG_RETURN_DATUM(jsonb_of(run(wt_bridge_validate, PG_GETARG_DATUM(0), true)));
}

PG_FUNCTION_INFO_V1(wt_is_valid);
Datum
wt_is_valid(PG_FUNCTION_ARGS)
{
	PG_RETURN_BOOL(run(wt_bridge_is_valid, PG_GETARG_DATUM(0), true)->truth);
}

PG_FUNCTION_INFO_V1(wt_encode);
Datum
wt_encode(PG_FUNCTION_ARGS)
{
	PG_RETURN_DATUM(bytea_of(run(wt_bridge_encode, PG_GETARG_DATUM(0), true)));
}

PG_FUNCTION_INFO_V1(wt_decode);
Datum
wt_decode(PG_FUNCTION_ARGS)
{
	PG_RETURN_DATUM(bytea_of(run(wt_bridge_decode, PG_GETARG_DATUM(0), false)));
}

PG_FUNCTION_INFO_V1(wt_info);
Datum
wt_info(PG_FUNCTION_ARGS)
{
	PG_RETURN_DATUM(jsonb_of(run(wt_bridge_info, PG_GETARG_DATUM(0), false)));
}

PG_FUNCTION_INFO_V1(wt_version);
Datum
wt_version(PG_FUNCTION_ARGS)
{
	PG_RETURN_TEXT_P(cstring_to_text(wt_bridge_version()));
}

void
_PG_init(void)
{
	DefineCustomStringVariable("watertight.libexec",
							   "Folder of the helper executables watertight-worker and watertight-tetgen.",
							   "Empty: the folder of the installation. No verdict depends on it.",
							   &libexec_setting, "", PGC_SUSET, GUC_SUPERUSER_ONLY, NULL, NULL, NULL);
	DefineCustomIntVariable("watertight.max_seconds",
							"Longest time of a call of a watertight function.",
							"0: no limit. A longer call raises program_limit_exceeded.",
							&max_seconds_setting, 300, 0, 86400, PGC_SUSET, GUC_UNIT_S, NULL, NULL, NULL);
	DefineCustomIntVariable("watertight.max_memory",
							"Most memory of a call of a watertight function, and of each of its helper processes.",
							"0: no limit but the built-in ones. A value that needs more raises program_limit_exceeded.",
							&max_memory_setting, 4096, 0, 1048576, PGC_SUSET, GUC_UNIT_MB, NULL, NULL, NULL);
	MarkGUCPrefixReserved("watertight");
}
