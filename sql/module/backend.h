/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The parts that the C files of the extension share: jobs for the bridge, and what becomes of its
 * replies. Errors are raised here, after the bridge has returned.
 */
#ifndef WATERTIGHT_SQL_BACKEND_H
#define WATERTIGHT_SQL_BACKEND_H

#include "postgres.h"

#include "fmgr.h"
#include "utils/jsonb.h"

#include "sql/bridge.h"

typedef void (*bridge_function)(const wt_job* job, wt_reply* reply);

/** A reply that is freed with the current memory context, however the call is left. */
wt_reply* new_reply(void);
/** A job on bytes under the settings of the session; the bytes and rules stay the caller's. */
wt_job new_job(const uint8_t* bytes, size_t size, const wt_rule_choice* rules, bool needs_engine);
/** Raises the failure of a reply, or the reason why the statement ends, if there is one. */
void check_reply(const wt_reply* reply);

/** The rules in a jsonb object; those that it does not have are the default ones. */
wt_rule_choice rules_of_jsonb(Jsonb* json);

/** A UTF-8 text in the encoding of the database. */
char* from_utf8(const char* text);
/** The value of a reply as a varlena; frees the reply. */
Datum bytea_of(wt_reply* reply);
/** The JSON of a reply as jsonb; frees the reply. */
Datum jsonb_of(wt_reply* reply);

#endif
