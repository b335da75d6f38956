// SPDX-License-Identifier: GPL-3.0-or-later
//
// The statement that lets the extension `watertight` make its view over the tables, where it is
// installed, the view is missing and the role may make it. Without the extension there is no view.
#pragma once

namespace watertight::store {

// The lock is that of migrations, so that of two programs that begin together one makes the view.
inline constexpr const char* kMakeCityView = R"(DO $$
  DECLARE
    maker regprocedure := (SELECT p.oid FROM pg_proc p JOIN pg_extension e
                             ON e.extname = 'watertight' AND e.extnamespace = p.pronamespace
                             WHERE p.proname = 'wt_make_city_view');
  BEGIN
    IF maker IS NOT NULL AND to_regclass('watertight.city') IS NULL
       AND has_schema_privilege('watertight', 'CREATE') THEN
      PERFORM pg_advisory_xact_lock(x'7761746572746967'::bigint);
      IF to_regclass('watertight.city') IS NULL THEN
        EXECUTE 'SELECT ' || maker;
      END IF;
    END IF;
  END $$)";

}  // namespace watertight::store
