/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The SQL functions of the extension watertight. This file sees PostgreSQL and no geometry; the
 * work is behind bridge.h. Errors are raised here only, after the bridge has returned.
 */
#include "postgres.h"

#include "access/parallel.h"
#include "common/shortest_dec.h"
#include "fmgr.h"
#include "mb/pg_wchar.h"
#include "miscadmin.h"
#include "storage/ipc.h"
#include "utils/builtins.h"
#include "utils/guc.h"
#include "utils/jsonb.h"
#include "utils/memutils.h"
#include "utils/numeric.h"

#include "sql/module/backend.h"

PG_MODULE_MAGIC;

void _PG_init(void);

/* A backend serves one connection in one thread, so its state can be static. */
static char *libexec_setting = NULL; /* watertight.libexec */
static int	max_seconds_setting = 300; /* watertight.max_seconds */
static int	max_memory_setting = 4096; /* watertight.max_memory, MB */
/* The rules that wt_rules() takes where a call states none; no other function reads them. */
static double planarity_setting = 0; /* watertight.planarity, metres */
static double planarity_angle_setting = 0; /* watertight.planarity_angle, degrees */
static int	proof_setting = 0; /* watertight.proof */
static bool strict_setting = false; /* watertight.strict */
static const struct config_enum_entry proofs[] = {
	{"tetrahedralization", 0, false},
	{"boundary", 1, false},
	{NULL, 0, false}
};
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

wt_reply *
new_reply(void)
{
	OwnedReply *owned = palloc0(sizeof(OwnedReply));

	owned->callback.func = clear_reply;
	owned->callback.arg = owned;
	MemoryContextRegisterResetCallback(CurrentMemoryContext, &owned->callback);
	return &owned->reply;
}

char *
from_utf8(const char *text)
{
	return pg_any_to_server(text, (int) strlen(text), PG_UTF8);
}

static void
raise_failure(const wt_failure *failure)
{
	const char *state = failure->sqlstate;
	int			code = MAKE_SQLSTATE(state[0], state[1], state[2], state[3], state[4]);
	const char *hint = NULL;

	if (strcmp(state, WATERTIGHT_UNDECIDED) == 0)
		hint = "Try again: a helper process crashed, or the solid needs more time or memory than it may use.";
	else if (failure->is_invalid)
		hint = "wt_validate() gives the whole report, and wt_try_solid() NULL instead of this error.";
	ereport(ERROR,
			(errcode(code), errmsg("%s", from_utf8(failure->message)),
			 failure->detail == NULL ? 0 : errdetail("%s", from_utf8(failure->detail)),
			 hint == NULL ? 0 : errhint("%s", hint)));
}

wt_job
new_job(const uint8_t *bytes, size_t size, const wt_rule_choice *rules, bool needs_engine)
{
	wt_job		job;

	job.bytes = bytes;
	job.size = size;
	job.engine = needs_engine ? current_engine() : NULL;
	job.poll = is_interrupted;
	job.max_seconds = (uint32_t) max_seconds_setting;
	job.max_memory = (uint32_t) max_memory_setting;
	job.rules = rules;
	job.slot = 0;
	return job;
}

void
check_reply(const wt_reply *reply)
{
	/* PostgreSQL reports a requested end with its reason (statement_timeout, user, shutdown). */
	CHECK_FOR_INTERRUPTS();
	if (reply->failure.sqlstate[0] != '\0')
		raise_failure(&reply->failure);
}

/* Runs one bridge function on a bytea argument by some rules (NULL: the default ones), or for a
 * solid of a page. Returns its reply, or raises. */
static wt_reply *
run_on(bridge_function function, Datum argument, const wt_rule_choice *rules, bool needs_engine,
	   int32 slot)
{
	wt_reply   *reply = new_reply();
	bytea	   *input = DatumGetByteaPP(argument);
	wt_job		job = new_job((const uint8_t *) VARDATA_ANY(input), VARSIZE_ANY_EXHDR(input), rules,
							  needs_engine);

	job.slot = slot;
	function(&job, reply);
	check_reply(reply);
	return reply;
}

static wt_reply *
run(bridge_function function, Datum argument, const wt_rule_choice *rules, bool needs_engine)
{
	return run_on(function, argument, rules, needs_engine, 0);
}

/* The number of a rule within its range, or an error. */
static double
number_of_rule(const char *name, const char *unit, double value, double least, double most)
{
	if (!(value >= least && value <= most))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("rule \"%s\" is outside its range", name),
				 errdetail("It is %g; it can be from %g to %g %s.", value, least, most, unit)));
	return value;
}

static double
planarity_of(double value)
{
	return number_of_rule("planarity", "metres", value, WATERTIGHT_LEAST_PLANARITY,
						  WATERTIGHT_MOST_PLANARITY);
}

static double
planarity_angle_of(double value)
{
	return number_of_rule("planarity_angle", "degrees", value, WATERTIGHT_LEAST_ANGLE,
						  WATERTIGHT_MOST_ANGLE);
}

/* Whether the proof of this name is that by exact tests alone. */
static bool
is_boundary_proof(const char *name, size_t length)
{
	for (const struct config_enum_entry *proof = proofs; proof->name != NULL; ++proof)
		if (strlen(proof->name) == length && memcmp(proof->name, name, length) == 0)
			return proof->val == 1;
	ereport(ERROR,
			(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
			 errmsg("rule \"proof\" is tetrahedralization or boundary")));
	return false;				/* not reached */
}

static void
require_kind(const char *name, bool is_right, const char *kind)
{
	if (!is_right)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("rule \"%s\" is not %s", name, kind)));
}

static double
float_of(const char *name, const JsonbValue *value)
{
	require_kind(name, value->type == jbvNumeric, "a number");
	return DatumGetFloat8(DirectFunctionCall1(numeric_float8_no_overflow, NumericGetDatum(value->val.numeric)));
}

/* Sets the rule that a member of the rules states. */
static void
take_rule(wt_rule_choice *rules, const char *name, const JsonbValue *value)
{
	if (strcmp(name, "planarity") == 0)
		rules->planarity = planarity_of(float_of(name, value));
	else if (strcmp(name, "planarity_angle") == 0)
		rules->planarity_angle = planarity_angle_of(float_of(name, value));
	else if (strcmp(name, "proof") == 0)
	{
		require_kind(name, value->type == jbvString, "a string");
		rules->is_boundary_enough =
			is_boundary_proof(value->val.string.val, (size_t) value->val.string.len);
	}
	else if (strcmp(name, "strict") == 0)
	{
		require_kind(name, value->type == jbvBool, "true or false");
		rules->is_strict = value->val.boolean;
	}
	else if (strcmp(name, "rule_set") == 0)
		require_kind(name, float_of(name, value) == (double) wt_rule_set(),
					 "the set of rules that this version applies");
	else
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE), errmsg("there is no rule \"%s\"", name),
				 errhint("The rules are planarity (metres), planarity_angle (degrees), proof, strict and rule_set.")));
}

/* The rules in a jsonb object; those that it does not have are the default ones, whatever the
 * settings are, so that equal arguments give equal results. */
wt_rule_choice
rules_of_jsonb(Jsonb *json)
{
	wt_rule_choice	rules = wt_default_rules();
	JsonbIterator *iterator = JsonbIteratorInit(&json->root);
	JsonbValue	value;
	JsonbIteratorToken token = JsonbIteratorNext(&iterator, &value, false);

	if (token != WJB_BEGIN_OBJECT)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("rules are a JSON object, such as {\"planarity\": 0.02}")));
	while ((token = JsonbIteratorNext(&iterator, &value, true)) == WJB_KEY)
	{
		char	   *name = pnstrdup(value.val.string.val, value.val.string.len);

		(void) JsonbIteratorNext(&iterator, &value, true);
		take_rule(&rules, name, &value);
		pfree(name);
	}
	return rules;
}

/* Runs a bridge function on a solid, by the rules of the second argument if there is one. */
static wt_reply *
judge(bridge_function function, FunctionCallInfo fcinfo)
{
	wt_rule_choice	rules;

	if (PG_NARGS() < 2)
		return run(function, PG_GETARG_DATUM(0), NULL, true);
	rules = rules_of_jsonb(PG_GETARG_JSONB_P(1));
	return run(function, PG_GETARG_DATUM(0), &rules, true);
}

Datum
bytea_of(wt_reply *reply)
{
	bytea	   *value = palloc(VARHDRSZ + reply->size);

	SET_VARSIZE(value, VARHDRSZ + reply->size);
	memcpy(VARDATA(value), reply->bytes, reply->size);
	wt_reply_clear(reply);
	return PointerGetDatum(value);
}

Datum
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
	PG_RETURN_DATUM(jsonb_of(judge(wt_bridge_validate, fcinfo)));
}

PG_FUNCTION_INFO_V1(wt_is_valid);
Datum
wt_is_valid(PG_FUNCTION_ARGS)
{
	PG_RETURN_BOOL(judge(wt_bridge_is_valid, fcinfo)->truth);
}

PG_FUNCTION_INFO_V1(wt_encode);
Datum
wt_encode(PG_FUNCTION_ARGS)
{
	PG_RETURN_DATUM(bytea_of(judge(wt_bridge_encode, fcinfo)));
}

PG_FUNCTION_INFO_V1(wt_decode);
Datum
wt_decode(PG_FUNCTION_ARGS)
{
	PG_RETURN_DATUM(bytea_of(run(wt_bridge_decode, PG_GETARG_DATUM(0), NULL, false)));
}

PG_FUNCTION_INFO_V1(wt_blob);
Datum
wt_blob(PG_FUNCTION_ARGS)
{
	PG_RETURN_DATUM(
		bytea_of(run_on(wt_bridge_blob, PG_GETARG_DATUM(0), NULL, false, PG_GETARG_INT32(1))));
}

PG_FUNCTION_INFO_V1(wt_info);
Datum
wt_info(PG_FUNCTION_ARGS)
{
	PG_RETURN_DATUM(jsonb_of(run(wt_bridge_info, PG_GETARG_DATUM(0), NULL, false)));
}

PG_FUNCTION_INFO_V1(wt_rules_of);
Datum
wt_rules_of(PG_FUNCTION_ARGS)
{
	PG_RETURN_DATUM(jsonb_of(run(wt_bridge_rules_of, PG_GETARG_DATUM(0), NULL, false)));
}

/* The rules of the arguments, or of the settings where an argument is NULL, as jsonb. */
PG_FUNCTION_INFO_V1(wt_rules);
Datum
wt_rules(PG_FUNCTION_ARGS)
{
	double		planarity = PG_ARGISNULL(0) ? planarity_setting : planarity_of(PG_GETARG_FLOAT8(0));
	double		angle =
		PG_ARGISNULL(1) ? planarity_angle_setting : planarity_angle_of(PG_GETARG_FLOAT8(1));
	bool		is_boundary_enough = proof_setting == 1;
	bool		is_strict = PG_ARGISNULL(3) ? strict_setting : PG_GETARG_BOOL(3);
	char		planarity_text[DOUBLE_SHORTEST_DECIMAL_LEN];
	char		angle_text[DOUBLE_SHORTEST_DECIMAL_LEN];

	if (!PG_ARGISNULL(2))
	{
		text	   *proof = PG_GETARG_TEXT_PP(2);

		is_boundary_enough = is_boundary_proof(VARDATA_ANY(proof), VARSIZE_ANY_EXHDR(proof));
	}
	double_to_shortest_decimal_buf(planarity, planarity_text);
	double_to_shortest_decimal_buf(angle, angle_text);
	PG_RETURN_DATUM(DirectFunctionCall1(
		jsonb_in,
		CStringGetDatum(psprintf("{\"planarity\":%s,\"planarity_angle\":%s,\"proof\":\"%s\",\"strict\":%s}",
								 planarity_text, angle_text, proofs[is_boundary_enough ? 1 : 0].name,
								 is_strict ? "true" : "false"))));
}

PG_FUNCTION_INFO_V1(wt_version);
Datum
wt_version(PG_FUNCTION_ARGS)
{
	PG_RETURN_TEXT_P(cstring_to_text(wt_bridge_version()));
}

/* Says once in a session how the settings of rules take effect, because a call without rules
 * does not read them. */
static void
explain_rules(GucSource source)
{
	static bool is_said = false;

	if (is_said || source < PGC_S_INTERACTIVE || IsParallelWorker())
		return;
	is_said = true;
	ereport(NOTICE,
			(errmsg("the rules that are set apply to calls that take them: wt_is_valid(ewkb, wt_rules())")));
}

static bool
check_number(double *value, void **extra, GucSource source)
{
	explain_rules(source);
	return true;
}

static bool
check_proof(int *value, void **extra, GucSource source)
{
	explain_rules(source);
	return true;
}

static bool
check_strict(bool *value, void **extra, GucSource source)
{
	explain_rules(source);
	return true;
}

static void
define_rules(void)
{
	const wt_rule_choice rules = wt_default_rules();

	DefineCustomRealVariable("watertight.planarity",
							 "Largest distance of a vertex from the plane of its facet, in metres, where wt_rules() is given none.",
							 "Calls without rules do not read it.",
							 &planarity_setting, rules.planarity, WATERTIGHT_LEAST_PLANARITY,
							 WATERTIGHT_MOST_PLANARITY, PGC_USERSET, 0, check_number, NULL, NULL);
	DefineCustomRealVariable("watertight.planarity_angle",
							 "Largest angle between two triangles of a facet, in degrees, where wt_rules() is given none.",
							 "Calls without rules do not read it.",
							 &planarity_angle_setting, rules.planarity_angle, WATERTIGHT_LEAST_ANGLE,
							 WATERTIGHT_MOST_ANGLE, PGC_USERSET, 0, check_number, NULL, NULL);
	DefineCustomEnumVariable("watertight.proof",
							 "Proof of validity where wt_rules() is given none: tetrahedralization, or boundary (exact tests alone).",
							 "Calls without rules do not read it.",
							 &proof_setting, 0, proofs, PGC_USERSET, 0, check_proof, NULL, NULL);
	DefineCustomBoolVariable("watertight.strict",
							 "Whether only the canonical triangles of facets count, where wt_rules() is given none.",
							 "Calls without rules do not read it.",
							 &strict_setting, false, PGC_USERSET, 0, check_strict, NULL, NULL);
}

void
_PG_init(void)
{
	define_rules();
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
