-- SPDX-License-Identifier: GPL-3.0-or-later
-- Tables of solids spread over several servers (docs/scale.md). The coordinator has a table that is partitioned by a
-- hash; its partitions, the parts, are foreign tables (postgres_fdw), whose rows are in tables of the same name on
-- the shards. What changes shards goes through dblink, and is committed there at once; each step can be done again.
\echo Use "CREATE EXTENSION watertight_shards" to load this file. \quit

-- The bounds are read without the table they belong to (0): otherwise a part that has just moved is missing for a
-- statement that began before.
CREATE VIEW wt_parts AS
  SELECT i.inhparent::regclass AS parent, c.oid::regclass AS part, s.srvname::text AS shard,
         b.bound[1]::int AS modulus, b.bound[2]::int AS remainder
  FROM pg_inherits i
  JOIN pg_class c ON c.oid = i.inhrelid
  JOIN pg_foreign_table t ON t.ftrelid = c.oid
  JOIN pg_foreign_server s ON s.oid = t.ftserver
  CROSS JOIN LATERAL regexp_match(pg_get_expr(c.relpartbound, 0), 'modulus (\d+), remainder (\d+)') AS b(bound)
  WHERE b.bound IS NOT NULL;
GRANT SELECT ON wt_parts TO PUBLIC;
COMMENT ON VIEW wt_parts IS 'the parts of spread tables, and the shards that have their rows';

-- Runs statements on a shard, and gives the one text of the last row, if there is one.
CREATE FUNCTION wt_on_shard(shard text, statement text) RETURNS text LANGUAGE plpgsql AS $$
  DECLARE
    answer text;
  BEGIN
    IF NOT 'wt_' || shard = ANY (coalesce(dblink_get_connections(), '{}')) THEN
      PERFORM dblink_connect('wt_' || shard, shard);
    END IF;
    SELECT t.answer INTO answer FROM dblink('wt_' || shard, statement) AS t(answer text);
    PERFORM dblink_disconnect('wt_' || shard);
    RETURN answer;
  EXCEPTION WHEN OTHERS THEN
    IF 'wt_' || shard = ANY (dblink_get_connections()) THEN
      PERFORM dblink_disconnect('wt_' || shard);
    END IF;
    RAISE;
  END $$;
COMMENT ON FUNCTION wt_on_shard(text, text) IS 'the answer of a shard to a statement, which is committed there at once';

-- Closes the connections whose names begin with a text.
CREATE FUNCTION wt_hang_up(start text) RETURNS void LANGUAGE sql AS $$
  SELECT dblink_disconnect(name) FROM unnest(dblink_get_connections()) AS name WHERE starts_with(name, start)
$$;
COMMENT ON FUNCTION wt_hang_up(text) IS 'closes the connections of dblink whose names begin with a text';

-- dblink_send_query answers 0 and goes on where the connection broke; rows would be lost without an error.
CREATE FUNCTION wt_send(connection text, statements text) RETURNS void LANGUAGE plpgsql AS $$
  BEGIN
    IF dblink_send_query(connection, statements) <> 1 THEN
      RAISE 'the connection % broke before its shard got the statements', connection
        USING ERRCODE = 'connection_failure', DETAIL = dblink_error_message(connection), HINT = 'Make the call again.';
    END IF;
  END $$;
COMMENT ON FUNCTION wt_send(text, text) IS 'sends statements to a shard through a connection of dblink, whose results are fetched later';

CREATE FUNCTION wt_add_shard(shard text, host text, port int, dbname text, username text, password text DEFAULT NULL)
  RETURNS void LANGUAGE plpgsql AS $$
  DECLARE
    here text := (SELECT extversion FROM pg_extension WHERE extname = 'watertight');
    there text;
  BEGIN
    EXECUTE format($s$CREATE SERVER %I FOREIGN DATA WRAPPER postgres_fdw OPTIONS (host %L, port %L, dbname %L,
      extensions 'watertight', async_capable 'true', batch_size '500', fetch_size '1000', connect_timeout '10')$s$, shard, host, port, dbname);
    EXECUTE format('CREATE USER MAPPING FOR CURRENT_USER SERVER %I OPTIONS (%s)', shard,
      concat_ws(', ', format('user %L', username), 'password ' || quote_literal(password)));
    there := @extschema@.wt_on_shard(shard, $s$SELECT coalesce((SELECT extversion FROM pg_extension WHERE extname = 'watertight'), 'none')$s$);
    IF there <> here THEN
      RAISE 'shard % has version % of the extension watertight, the coordinator %', shard, there, here
        USING ERRCODE = 'object_not_in_prerequisite_state',
          HINT = 'CREATE EXTENSION watertight, or ALTER EXTENSION watertight UPDATE, in the database of the shard.';
    END IF;
  END $$;
COMMENT ON FUNCTION wt_add_shard(text, text, int, text, text, text) IS
  'makes the server and user mapping of a shard, whose database must have the same version of the extension watertight';

-- The statements that make the table of a part on its shard: the columns of the parent, its partition key as primary
-- key, and an index on the boxes of each column of solids.
CREATE FUNCTION wt_part_statements(parent regclass, part text) RETURNS text LANGUAGE sql STABLE AS $$
  SELECT format('CREATE TABLE IF NOT EXISTS %I (%s, PRIMARY KEY (%s))', part,
           (SELECT string_agg(concat_ws(' ', quote_ident(a.attname), format_type(a.atttypid, a.atttypmod),
                (SELECT 'COLLATE ' || a.attcollation::regcollation WHERE a.attcollation <> t.typcollation),
                CASE WHEN a.attnotnull THEN 'NOT NULL' END,
                CASE WHEN a.attgenerated = 's' THEN 'GENERATED ALWAYS AS (' || pg_get_expr(d.adbin, d.adrelid) || ') STORED' END), ', ' ORDER BY a.attnum)
            FROM pg_attribute a JOIN pg_type t ON t.oid = a.atttypid
            LEFT JOIN pg_attrdef d ON d.adrelid = a.attrelid AND d.adnum = a.attnum
            WHERE a.attrelid = parent AND a.attnum > 0 AND NOT a.attisdropped),
           (SELECT string_agg(quote_ident(a.attname), ', ' ORDER BY k.place)
            FROM pg_partitioned_table p CROSS JOIN LATERAL unnest(p.partattrs::int[]) WITH ORDINALITY AS k(number, place)
            JOIN pg_attribute a ON a.attrelid = parent AND a.attnum = k.number WHERE p.partrelid = parent))
    || coalesce((SELECT string_agg(format('; CREATE INDEX IF NOT EXISTS %I ON %I USING gist (%I)', part || '_' || a.attname, part, a.attname), '' ORDER BY a.attnum)
                 FROM pg_attribute a WHERE a.attrelid = parent AND a.atttypid = 'solid'::regtype AND NOT a.attisdropped), '')
$$;
COMMENT ON FUNCTION wt_part_statements(regclass, text) IS 'the statements that make the table of a part on its shard';

-- Makes the foreign table of a part, whose rows are on a shard.
CREATE FUNCTION wt_attach_part(parent regclass, part text, modulus int, remainder int, shard text) RETURNS void LANGUAGE plpgsql AS $$
  BEGIN
    EXECUTE format('CREATE FOREIGN TABLE %I.%I PARTITION OF %s FOR VALUES WITH (MODULUS %s, REMAINDER %s) SERVER %I OPTIONS (schema_name %L, table_name %L)',
      (SELECT relnamespace::regnamespace::text FROM pg_class WHERE oid = parent), part, parent, modulus, remainder, shard, 'public', part);
  END $$;
COMMENT ON FUNCTION wt_attach_part(regclass, text, int, int, text) IS 'makes the foreign table of a part';

CREATE FUNCTION wt_spread(parent regclass, parts int, shards text[]) RETURNS void LANGUAGE plpgsql AS $$
  DECLARE
    name name := (SELECT relname FROM pg_class WHERE oid = parent);
    part text;
    shard text;
  BEGIN
    IF NOT EXISTS (SELECT FROM pg_partitioned_table WHERE partrelid = parent AND partstrat = 'h' AND 0 <> ALL (partattrs::int[])) THEN
      RAISE '% is not partitioned by a hash of columns', parent
        USING ERRCODE = 'wrong_object_type', HINT = 'CREATE TABLE ... PARTITION BY HASH (id).';
    END IF;
    IF parts < 1 OR coalesce(cardinality(shards), 0) = 0 THEN
      RAISE 'a table needs at least one part and one shard' USING ERRCODE = 'invalid_parameter_value';
    END IF;
    FOR i IN 0 .. parts - 1 LOOP
      part := name || '_' || i;
      shard := shards[i % cardinality(shards) + 1];
      PERFORM @extschema@.wt_on_shard(shard, @extschema@.wt_part_statements(parent, part) || '; SELECT ''''');
      PERFORM @extschema@.wt_attach_part(parent, part, parts, i, shard);
    END LOOP;
  END $$;
COMMENT ON FUNCTION wt_spread(regclass, int, text[]) IS
  'makes the parts of a table that is partitioned by a hash, and deals them out to shards; more parts than shards leave room for shards to come';

CREATE FUNCTION wt_load(parent regclass, query text, batch int DEFAULT 500, skip_invalid boolean DEFAULT false,
    OUT shard text, OUT stored bigint) RETURNS SETOF record LANGUAGE plpgsql AS $$
  DECLARE
    columns text[];
    casts text;
    texts text;
    solids text;
    key text;
    statement record;
    status text;
    counts jsonb := '{}';
    one text;
  BEGIN
    EXECUTE 'CREATE TEMP TABLE wt_load_rows AS ' || query;
    SELECT array_agg(quote_ident(r.attname) ORDER BY r.attnum),
           string_agg(format(CASE WHEN a.atttypid = 'solid'::regtype AND skip_invalid THEN 'wt_try_solid(v.%I::bytea) AS %1$I'
                                  ELSE 'v.%I::' || format_type(a.atttypid, a.atttypmod) || ' AS %1$I' END, r.attname), ', ' ORDER BY r.attnum),
           string_agg(format('quote_nullable(r.%I::text)', r.attname), ', ' ORDER BY r.attnum),
           string_agg(format('w.%I IS NOT NULL', r.attname), ' AND ') FILTER (WHERE a.atttypid = 'solid'::regtype)
      INTO columns, casts, texts, solids
      FROM pg_attribute r LEFT JOIN pg_attribute a ON a.attrelid = parent AND a.attname = r.attname AND NOT a.attisdropped
      WHERE r.attrelid = 'pg_temp.wt_load_rows'::regclass AND r.attnum > 0;
    IF casts IS NULL OR cardinality(columns) <> (SELECT count(*) FROM pg_attribute r JOIN pg_attribute a USING (attname)
        WHERE r.attrelid = 'pg_temp.wt_load_rows'::regclass AND r.attnum > 0 AND a.attrelid = parent AND NOT a.attisdropped) THEN
      RAISE 'the query has columns that % does not have', parent USING ERRCODE = 'undefined_column';
    END IF;
    SELECT string_agg(format('r.%I::%s', a.attname, format_type(a.atttypid, a.atttypmod)), ', ' ORDER BY k.place) INTO key
      FROM pg_partitioned_table p CROSS JOIN LATERAL unnest(p.partattrs::int[]) WITH ORDINALITY AS k(number, place)
      JOIN pg_attribute a ON a.attrelid = parent AND a.attnum = k.number WHERE p.partrelid = parent;
    -- For each batch and shard one statement: the shards work on the rows of a batch at the same time.
    FOR statement IN EXECUTE format($q$
        SELECT b.batch, array_agg(b.shard ORDER BY b.shard) AS shards, array_agg(b.text ORDER BY b.shard) AS texts
        FROM (SELECT i.batch, i.shard, string_agg(format(
                'INSERT INTO public.%%I (%1$s) SELECT * FROM (SELECT %2$s FROM (VALUES %%s) v(%1$s)) w WHERE %3$s ON CONFLICT DO NOTHING',
                i.part, i.rows), '; ') AS text
              FROM (SELECT r.batch, coalesce(p.shard, '') AS shard, coalesce(c.relname, '') AS part, string_agg('(' || concat_ws(', ', %4$s) || ')', ', ') AS rows
                    FROM (SELECT (row_number() OVER () - 1) / %5$s AS batch, * FROM pg_temp.wt_load_rows) r
                    LEFT JOIN @extschema@.wt_parts p ON p.parent = %6$L::regclass AND satisfies_hash_partition(%7$s::oid, p.modulus, p.remainder, %8$s)
                    LEFT JOIN pg_class c ON c.oid = p.part
                    GROUP BY 1, 2, 3) i
              GROUP BY 1, 2) b
        GROUP BY 1 ORDER BY 1$q$,
        array_to_string(columns, ', '), replace(casts, '''', ''''''), coalesce(CASE WHEN skip_invalid THEN solids END, 'true'), texts, batch, parent, parent::oid, key) LOOP
      IF '' = ANY (statement.shards) THEN
        RAISE 'a row belongs to no part of %', parent USING ERRCODE = 'check_violation', HINT = 'SELECT wt_spread(...) makes the parts.';
      END IF;
      FOR i IN 1 .. cardinality(statement.shards) LOOP
        one := 'wt_load_' || statement.shards[i];
        IF NOT one = ANY (coalesce(dblink_get_connections(), '{}')) THEN
          PERFORM dblink_connect(one, statement.shards[i]);
        END IF;
        PERFORM @extschema@.wt_send(one, statement.texts[i]);
      END LOOP;
      FOR i IN 1 .. cardinality(statement.shards) LOOP
        LOOP
          status := NULL;
          SELECT t.status INTO status FROM dblink_get_result('wt_load_' || statement.shards[i]) AS t(status text);
          EXIT WHEN status IS NULL;
          counts := jsonb_set(counts, ARRAY[statement.shards[i]],
            to_jsonb(coalesce((counts ->> statement.shards[i])::bigint, 0) + split_part(status, ' ', 3)::bigint));
        END LOOP;
      END LOOP;
    END LOOP;
    DROP TABLE pg_temp.wt_load_rows;
    PERFORM @extschema@.wt_hang_up('wt_load_');
    RETURN QUERY SELECT c.key, c.value::bigint FROM jsonb_each_text(counts) c ORDER BY 1;
  EXCEPTION WHEN OTHERS THEN
    PERFORM @extschema@.wt_hang_up('wt_load_');
    RAISE;
  END $$;
COMMENT ON FUNCTION wt_load(regclass, text, int, boolean) IS
  'sends the rows of a query straight to the shards that own them, which judge them side by side; rows whose key is there are left out, so that a call that failed can be made again. Answers the number of rows that each shard has stored';

CREATE FUNCTION wt_ask_parts(parent regclass, query text, OUT part text, OUT shard text, OUT answer jsonb) RETURNS SETOF record
  LANGUAGE plpgsql AS $$
  DECLARE
    asked record;
    shards text[];
  BEGIN
    FOR asked IN
        SELECT p.shard, string_agg(format('SELECT %L::text, to_jsonb(q) FROM (%s) q', c.relname,
                 replace(query, '$part', format('public.%I', c.relname))), ' UNION ALL ' ORDER BY p.remainder) AS text
        FROM @extschema@.wt_parts p JOIN pg_class c ON c.oid = p.part WHERE p.parent = wt_ask_parts.parent GROUP BY 1 LOOP
      PERFORM dblink_connect('wt_ask_' || asked.shard, asked.shard);
      PERFORM @extschema@.wt_send('wt_ask_' || asked.shard, asked.text);
      shards := shards || asked.shard;
    END LOOP;
    FOR wt_ask_parts.shard IN SELECT s FROM unnest(shards) AS s ORDER BY 1 LOOP
      FOR wt_ask_parts.part, wt_ask_parts.answer IN
          SELECT t.part, t.answer FROM dblink_get_result('wt_ask_' || wt_ask_parts.shard) AS t(part text, answer jsonb) LOOP
        RETURN NEXT;
      END LOOP;
      PERFORM dblink_disconnect('wt_ask_' || wt_ask_parts.shard);
    END LOOP;
  EXCEPTION WHEN OTHERS THEN
    PERFORM @extschema@.wt_hang_up('wt_ask_');
    RAISE;
  END $$;
COMMENT ON FUNCTION wt_ask_parts(regclass, text) IS
  'the rows that a query gives for each part, where $part in it stands for the table of the part; the shards work side by side';

CREATE PROCEDURE wt_move_part(part regclass, target text) LANGUAGE plpgsql AS $$
  DECLARE
    home record;
    name name := (SELECT relname FROM pg_class WHERE oid = part);
    columns text;
    declared text;
    sum text := format('SELECT count(*) || '' '' || coalesce(sum(hashtextextended(x::text, 0)), 0) FROM public.%I x', name);
    before text;
  BEGIN
    SELECT * INTO home FROM @extschema@.wt_parts p WHERE p.part = wt_move_part.part;
    IF home.shard IS NULL THEN
      RAISE '% is not a part of a spread table', part USING ERRCODE = 'wrong_object_type';
    END IF;
    IF home.shard = target THEN
      RETURN;
    END IF;
    -- Writers get an error from here on, and try again later; readers go on.
    PERFORM @extschema@.wt_on_shard(home.shard, format($s$
      CREATE OR REPLACE FUNCTION public.wt_part_moves() RETURNS trigger LANGUAGE plpgsql AS
        'BEGIN RAISE ''part %% is being moved to another shard: try again'', TG_TABLE_NAME USING ERRCODE = ''object_in_use''; END';
      CREATE OR REPLACE TRIGGER wt_part_moves BEFORE INSERT OR UPDATE OR DELETE ON public.%I
        FOR EACH STATEMENT EXECUTE FUNCTION public.wt_part_moves(); SELECT ''$s$, name));
    before := @extschema@.wt_on_shard(home.shard, sum);
    -- What an earlier call has copied before it was broken off is copied anew.
    PERFORM @extschema@.wt_on_shard(target, format('DROP TABLE IF EXISTS public.%I; ', name)
      || @extschema@.wt_part_statements(home.parent, name) || '; SELECT ''''');
    -- Solids travel as text, so that only the shard where they arrive judges them.
    SELECT string_agg(quote_ident(attname), ', ' ORDER BY attnum),
           string_agg(format('%I %s', attname, CASE WHEN atttypid = 'solid'::regtype THEN 'text' ELSE format_type(atttypid, atttypmod) END), ', ' ORDER BY attnum)
      INTO columns, declared
      FROM pg_attribute WHERE attrelid = home.parent AND attnum > 0 AND NOT attisdropped AND attgenerated = '';
    EXECUTE format('CREATE FOREIGN TABLE pg_temp.wt_from (%s) SERVER %I OPTIONS (schema_name ''public'', table_name %L)', declared, home.shard, name);
    EXECUTE format('CREATE FOREIGN TABLE pg_temp.wt_to (%s) SERVER %I OPTIONS (schema_name ''public'', table_name %L)', declared, target, name);
    EXECUTE format('INSERT INTO pg_temp.wt_to (%s) SELECT %1$s FROM pg_temp.wt_from', columns);
    DROP FOREIGN TABLE pg_temp.wt_from, pg_temp.wt_to;
    COMMIT;
    IF @extschema@.wt_on_shard(target, sum) <> before THEN
      RAISE 'the rows of % are others on shard %', part, target USING ERRCODE = 'data_corrupted';
    END IF;
    EXECUTE format('DROP FOREIGN TABLE %s', part);
    PERFORM @extschema@.wt_attach_part(home.parent, name, home.modulus, home.remainder, target);
    COMMIT;
    PERFORM @extschema@.wt_on_shard(home.shard, format('DROP TABLE public.%I; SELECT ''''', name));
  END $$;
COMMENT ON PROCEDURE wt_move_part(regclass, text) IS
  'moves a part to another shard: nobody can write it meanwhile, all can read it. A call that was broken off can be made again';
