-- SPDX-License-Identifier: GPL-3.0-or-later
-- Makes the shards of shards.compose.yaml known to the coordinator: psql COORDINATOR -v password=... -f docker/shards.sql
SELECT wt_add_shard(name, name, 5432, 'watertight', 'watertight', :'password') FROM (VALUES ('east'), ('west')) AS shard(name);
