#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Spreads a table of solids over servers: shards.py BUILD [--measure DOCUMENT]

A coordinator and three shards, each a PostgreSQL server of its own. Rows go straight to the shards that own them;
queries do their work there; a shard is killed while rows come and comes back; parts move to the third shard while
others write. With --measure the solids of a document are loaded and queried with one shard and with two.
"""
import argparse
import pathlib
import subprocess
import sys
import threading
import time

from postgres_servers import expect, servers_in

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "siege"))
from service import temporary_folder  # noqa: E402


def boxes(first, last):
    """A query of boxes with ids, as WKT; each has a volume of its own."""
    corner = "%s %s %s"
    corners = {"a": "000", "b": "100", "c": "110", "d": "010", "e": "001", "f": "101", "g": "111", "h": "011"}
    place = {"0": ("i * 10", "0", "0"), "1": ("i * 10 + 5", "4", "3 + i / 1000.0")}
    rings = ",".join("((" + ",".join(corner for _ in ring) + "))" for ring in ("adcba", "efghe", "abfea", "bcgfb", "cdhgc", "daehd"))
    values = ", ".join(place[bit][axis] for ring in ("adcba", "efghe", "abfea", "bcgfb", "cdhgc", "daehd") for c in ring
                       for axis, bit in enumerate(corners[c]))
    return (f"SELECT 'box' || i AS id, i % 7 AS kind, format('POLYHEDRALSURFACE Z ({rings})', {values}) AS shape"
            f" FROM generate_series({first}, {last}) i")


TABLE = """CREATE TABLE city (id text COLLATE "C" NOT NULL, kind int, shape solid NOT NULL,
  volume float8 GENERATED ALWAYS AS (wt_volume(shape)) STORED) PARTITION BY HASH (id)"""
EVERYTHING = "SELECT count(*), count(DISTINCT id), round(sum(volume)::numeric, 3) FROM city"


def volume_of(count):
    return f"{count}|{count}|{sum(5 * 4 * (3 + i / 1000) for i in range(count)):.3f}"


def start_city(servers):
    coordinator, *shards = servers.values()
    for server in servers.values():
        server.ask("CREATE EXTENSION watertight")
    coordinator.ask("CREATE EXTENSION watertight_shards CASCADE")
    for name, shard in zip(list(servers)[1:], shards):
        coordinator.ask(f"SELECT wt_add_shard('{name}', '{shard.folder}', 5432, 'postgres', 'watertight')")
    coordinator.ask(TABLE, "SELECT wt_spread('city', 6, '{east,west}')")


def load(coordinator, query, **options):
    return coordinator.psql(f"SELECT sum(stored) FROM wt_load('city', $query${query}$query$)", **options)


def test_queries(coordinator):
    def plan(query):
        return coordinator.ask("SET enable_partitionwise_aggregate = on", f"EXPLAIN (VERBOSE, COSTS OFF) {query}")

    for what, query, part in (
            ("a condition on a function", "SELECT id FROM city WHERE wt_area(shape) > 100", "wt_area(shape) >"),
            ("a condition on boxes", "SELECT id FROM city WHERE shape && wt_box(0, 0, 0, 100, 9, 9)", "shape OPERATOR(public.&&)"),
            ("a sum by key", "SELECT id, sum(volume) FROM city GROUP BY id", "SELECT id, sum(volume)")):
        text = plan(query)
        if not any(part in line for line in text.splitlines() if "Remote SQL" in line):
            raise SystemExit(f"{what} does not work on the shards:\n{text}")
    expect("both shards work at once", plan("SELECT id FROM city WHERE wt_area(shape) > 100").count("Async Foreign Scan"), 6)
    expect("a key is asked of one shard", plan("SELECT shape FROM city WHERE id = 'box7'").count("Foreign Scan"), 1)
    expect("sums of the parts", coordinator.ask(
        "SELECT count(*), sum((answer->>'n')::int), round(sum((answer->>'v')::numeric), 3) FROM"
        " wt_ask_parts('city', 'SELECT count(*) AS n, sum(wt_volume(shape)) AS v FROM $part')"), "6|" + volume_of(2000).split("|", 1)[1])
    expect("boxes", coordinator.ask("SELECT count(*) FROM city WHERE shape && wt_box(995, 0, 0, 2015, 9, 9)"), "103")
    expect("a volume", coordinator.ask("SELECT wt_volume(shape) FROM city WHERE id = 'box100'"), "62")


def test_refusals(coordinator, servers):
    bad = boxes(0, 0).replace("'box' || i", "'bad'").replace("i * 10 + 5, 4, 3 + i / 1000.0, i * 10 + 5, 0", "i * 10 + 5, 4, 99, i * 10 + 5, 0")
    done = load(coordinator, bad, check=False)
    expect("an invalid solid is refused with the shard's findings", "the solid is invalid" in done.stderr, True)
    done = coordinator.psql(f"SELECT * FROM wt_load('city', $query${boxes(0, 0)}$query$, skip_invalid => true)", check=False)
    expect("WKT where bytes are expected", "the byte order is neither 0 nor 1" in done.stderr, True)
    for what, statement, part in (
            ("a column that is not there", "SELECT wt_load('city', 'SELECT 1 AS number')", "has columns that city does not have"),
            ("a table without parts", "SELECT wt_spread('pg_class', 2, '{east}')", "is not partitioned by a hash"),
            ("no shards", "SELECT wt_spread('city', 2, '{}')", "at least one part and one shard"),
            ("an unknown shard", "SELECT wt_on_shard('nowhere', 'SELECT 1')", "nowhere"),
            ("no part", "CALL wt_move_part('pg_class', 'east')", "is not a part")):
        done = coordinator.psql(statement, check=False)
        expect(what, part in done.stderr, True)
    done = coordinator.psql("CREATE TABLE bare (id text) PARTITION BY HASH (id)", "SELECT wt_load('bare', $$SELECT 'a' AS id$$)", check=False)
    expect("a row without a part", "a row belongs to no part of bare" in done.stderr, True)
    servers["east"].ask("CREATE DATABASE plain")
    done = coordinator.psql(f"SELECT wt_add_shard('plain', '{servers['east'].folder}', 5432, 'plain', 'watertight')", check=False)
    expect("a shard without the extension", "has version none" in done.stderr, True)


def test_broken_connection(coordinator, shard):
    """A connection that broke just before rows went into it: the call fails, and can be made again."""
    postmaster = (shard.folder / "postmaster.pid").read_text().split()[0]
    call = f"SELECT sum(stored) FROM wt_load('city', $query${boxes(2000, 2199)}$query$)"
    done = coordinator.psql("SELECT dblink_connect('wt_load_west', 'west')", f"\\! pkill -9 -P {postmaster}", call, check=False)
    expect("a load whose shard is gone fails", done.returncode != 0, True)
    for _ in range(100):
        if coordinator.psql(call, check=False).returncode == 0:
            break
        time.sleep(0.1)
    expect("all rows are there once", coordinator.ask(EVERYTHING), volume_of(2200))


def test_outage(coordinator, shard):
    """Rows come in calls of 200; a shard is killed meanwhile. A call that failed is made again."""
    acknowledged = 2200
    failures = 0
    killer = threading.Timer(0.8, shard.kill)
    killer.start()
    while acknowledged < 6000:
        done = load(coordinator, boxes(acknowledged, acknowledged + 199), check=False)
        if done.returncode == 0:
            acknowledged += 200
            continue
        failures += 1
        if failures == 1:
            killer.join()
            done = coordinator.psql(EVERYTHING, check=False)
            expect("a query that needs a shard that is away fails", "could not connect" in done.stderr, True)
            expect("a key of the other shard is found", coordinator.ask("SELECT count(*) FROM city_0 WHERE kind = 3") != "0", True)
            shard.start()
        elif failures > 20:
            raise SystemExit(f"the shard does not come back: {done.stderr}")
    if failures == 0:
        raise SystemExit("no call failed while the shard was away")
    expect("all rows are there once", coordinator.ask(EVERYTHING), volume_of(6000))


def test_moves(coordinator, servers):
    """Parts move to a third shard while rows come."""
    failures = []
    is_done = threading.Event()

    def write():
        here = 6000
        while here < 7000 or not is_done.is_set():
            done = load(coordinator, boxes(here, here + 49), check=False)
            if done.returncode == 0:
                here += 50
            else:
                failures.append(done.stderr)
        written.append(here)

    written = []
    writer = threading.Thread(target=write)
    writer.start()
    time.sleep(0.3)
    before = coordinator.ask("SELECT count(*) FROM city WHERE substr(id, 4)::int < 6000")
    for part in ("city_0", "city_1"):
        coordinator.ask(f"CALL wt_move_part('{part}', 'north')")
        expect("no row is lost", coordinator.ask("SELECT count(*) FROM city WHERE substr(id, 4)::int < 6000"), before)
    is_done.set()
    writer.join()
    other = [text for text in failures if "is being moved" not in text and "does not exist" not in text]
    expect("writers fail only because parts move", other, [])
    expect("all rows are there once", coordinator.ask(EVERYTHING), volume_of(written[0]))
    expect("shards of the parts", coordinator.ask("SELECT string_agg(shard, ' ' ORDER BY remainder) FROM wt_parts WHERE parent = 'city'::regclass"),
           "north north east west east west")
    expect("the old part is gone", servers["east"].ask("SELECT to_regclass('city_0') IS NULL"), "t")
    # A statement that began before a move sees the part where it was, not a table without it.
    here = f"host={coordinator.folder} dbname=postgres user=watertight"
    seen = coordinator.ask("BEGIN ISOLATION LEVEL REPEATABLE READ", "SELECT shard FROM wt_parts WHERE part::text = 'city_3'",
                           f"SELECT dblink_exec('{here}', $$CALL wt_move_part('city_3', 'north')$$)",
                           "SELECT count(*) FROM wt_parts WHERE parent = 'city'::regclass", "COMMIT")
    expect("parts during a move", seen.split(), ["west", "CALL", "6"])
    # A move that was broken off after its copy is made again: nothing is there twice.
    servers["north"].ask("CREATE TABLE city_2 (id text)")
    coordinator.ask("CALL wt_move_part('city_2', 'north')")
    expect("all rows are there once", coordinator.ask(EVERYTHING), volume_of(written[0]))


def measure(servers, document, build):
    """The times of loading and querying with one shard and with two."""
    coordinator = servers["coordinator"]
    rows = subprocess.run([f"{build}/bin/watertight", "rows", document], check=True, capture_output=True, text=True).stdout
    coordinator.ask("CREATE TABLE raw (feature text, object text, lod text, ewkb bytea)")
    coordinator.run("psql", "-X", "-q", "-h", str(coordinator.folder), "-U", "watertight", "-d", "postgres", "-c", "COPY raw FROM STDIN", input=rows)
    for shards in ("{east}", "{east,west}"):
        coordinator.ask("CREATE TABLE town (id text NOT NULL, shape solid, volume float8 GENERATED ALWAYS AS (wt_volume(shape)) STORED) PARTITION BY HASH (id)",
                        f"SELECT wt_spread('town', 4, '{shards}')")
        query = "SELECT object || '/' || row_number() OVER () AS id, ewkb AS shape FROM raw, generate_series(1, 5)"
        start = time.perf_counter()
        stored = coordinator.ask(f"SELECT sum(stored) FROM wt_load('town', $query${query}$query$, skip_invalid => true)")
        loaded = time.perf_counter() - start
        print(f"{shards:12} {stored} solids judged and stored in {loaded:6.2f} s, {int(stored) / loaded:7.0f} solids/s")
        for what, query in (("volumes summed", "SELECT sum(volume) FROM town"), ("centres of all", "SELECT count(*) FROM town WHERE wt_centroid(shape) IS NULL"),
                            ("centres of all, asked of the parts", "SELECT * FROM wt_ask_parts('town', 'SELECT count(wt_centroid(shape)) FROM $part')"),
                            ("a solid by id", "SELECT wt_srid(shape) FROM town WHERE id = 'x'")):
            times = []
            for _ in range(5):
                out = coordinator.ask("SET enable_partitionwise_aggregate = on", "\\timing on", query)
                times.append(float(out.split("Time: ")[1].split()[0]))
            print(f"{shards:12} {what:40} {sorted(times)[2]:9.2f} ms")
        coordinator.ask("DROP TABLE town")
        for name in ("east", "west"):
            servers[name].ask("DROP TABLE IF EXISTS town_0, town_1, town_2, town_3")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build")
    parser.add_argument("--measure", type=pathlib.Path)
    options = parser.parse_args()
    build = pathlib.Path(options.build).resolve()
    with temporary_folder("shards") as folder:
        with servers_in(folder, build, ("coordinator", "east", "west", "north")) as servers:
            start_city(servers)
            coordinator = servers["coordinator"]
            if options.measure:
                return measure(servers, options.measure.resolve(), build)
            expect("rows that were stored", load(coordinator, boxes(0, 1999)).stdout.strip(), "2000")
            expect("rows that are there are left out", load(coordinator, boxes(0, 1999)).stdout.strip(), "0")
            expect("all rows are there once", coordinator.ask(EVERYTHING), volume_of(2000))
            test_queries(coordinator)
            test_refusals(coordinator, servers)
            test_broken_connection(coordinator, servers["west"])
            test_outage(coordinator, servers["west"])
            test_moves(coordinator, servers)
    print("a table spread over shards lost nothing")
    return None


if __name__ == "__main__":
    main()
