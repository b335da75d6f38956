#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures tables of the type solid: rows.py BUILD [--rows N] DOCUMENT...

The valid solids of the documents are moved to places of their own until there are N rows (100,000), in a server of its
own with PostgreSQL's default settings but 1 GB of shared buffers and the cost of a random page that fits solid-state disks (1.1).
Measured are: judging EWKB with full proof, the sizes of tables of solids, blobs, EWKB (in bytea, compressed by PostgreSQL) beside
each other, of PostGIS's geometry and of jsonb, indexes, queries, those of the CityParquet benchmark among them, a dump and its return. Needs what
tests/sql/run_regress.sh needs.
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "siege"))
from service import temporary_folder, unprivileged  # noqa: E402


class Server:
    def __init__(self, build, folder):
        self.folder = folder
        self.bin = subprocess.run([ROOT / "scripts" / "relocated-postgres", build, str(folder / "prefix")], check=True,
                                  capture_output=True, text=True).stdout.strip()
        self.prefix, user = unprivileged()
        if user:
            subprocess.run(["chown", "-R", user.pw_name, str(folder)], check=True)
        self.run("initdb", "-D", str(folder / "data"), "-N", "--username=watertight", "--encoding=UTF8", "--no-locale", "--auth=trust")
        self.run("pg_ctl", "-D", str(folder / "data"), "-w", "-s", "-l", str(folder / "log"), "-o",
                 f"-c listen_addresses= -c unix_socket_directories={folder} -c shared_buffers=1GB -c random_page_cost=1.1", "start")

    def run(self, name, *words, **options):
        return subprocess.run([*self.prefix, name if name == "bash" else f"{self.bin}/{name}", *words], check=True, capture_output=True, text=True, **options).stdout

    def ask(self, *statements, database="postgres", stdin=None):
        commands = [word for statement in statements for word in ("-c", statement)]
        return self.run("psql", "-X", "-q", "-At", "-v", "ON_ERROR_STOP=1", "-h", str(self.folder), "-U", "watertight",
                        "-d", database, *commands, stdin=stdin).strip()

    def seconds(self, *statements):
        start = time.perf_counter()
        self.ask(*statements)
        return time.perf_counter() - start

    def timed_file(self, name):
        """Seconds that psql takes for a file of commands in the server's folder."""
        start = time.perf_counter()
        self.run("psql", "-X", "-q", "-v", "ON_ERROR_STOP=1", "-h", str(self.folder), "-U", "watertight", "-d", "postgres", "-f", str(self.folder / name))
        return time.perf_counter() - start

    def stop(self):
        self.run("pg_ctl", "-D", str(self.folder / "data"), "-s", "-m", "immediate", "stop")


def say(what, value):
    print(f"{what:62} {value}", flush=True)


def copy_solids(server, build, documents, table):
    """Makes a table of the solids of documents as they are: feature, object, lod, ewkb."""
    file = server.folder / table
    with file.open("w") as out:
        subprocess.run([f"{build}/bin/watertight", "rows", *map(str, documents)], check=True, stdout=out)
    server.ask(f"CREATE TABLE {table} (feature text, object text, lod text, ewkb bytea)")
    with file.open() as source:
        server.ask(f"COPY {table} FROM STDIN", stdin=source)


def load(server, build, documents, rows):
    rows_file = server.folder / "rows"
    with rows_file.open("w") as out:
        subprocess.run([f"{build}/bin/encode_documents", *map(str, documents)], check=True, stdout=out)
    server.ask("CREATE EXTENSION watertight", "CREATE TABLE documents (name text, ewkb bytea, blob bytea)")
    with rows_file.open() as source:
        server.ask("COPY documents FROM STDIN", stdin=source)
    server.ask("DELETE FROM documents WHERE blob IS NULL", "ANALYZE documents")
    count = int(server.ask("SELECT count(*) FROM documents"))
    for name, option in (("one process", "SET max_parallel_workers_per_gather = 0"),
                         ("parallel", "SET min_parallel_table_scan_size = 0; ALTER TABLE documents SET (parallel_workers = 1)")):
        elapsed = server.seconds(option, "SELECT count(wt_solid(ewkb)) FROM documents, generate_series(1, 5)")
        say(f"judged with full proof, {name}", f"{5 * count / elapsed:9.0f} solids/s")
    # The tables of the service have the attributes of the solids; a command that finds invalid solids ends with status 1.
    subprocess.run([*server.prefix, f"{build}/bin/watertight", "ingest", "-q", "--database-url", f"host={server.folder} user=watertight dbname=postgres",
                    "--collection", "city", "--invalid", "keep", *map(str, documents)], check=False, capture_output=True)
    server.ask("CREATE TABLE stock AS SELECT attributes, solid FROM watertight.city WHERE is_proven")
    count = int(server.ask("SELECT count(*) FROM stock"))
    copies = -(-rows // count)
    server.ask(f"CREATE TABLE whole AS SELECT (row_number() OVER ())::int AS id, attributes, wt_translate(solid, 2000 * (c % 40), 2000 * (c / 40), 0) AS shape"
               f" FROM stock, generate_series(0, {copies - 1}) AS c LIMIT {rows}",
               "CREATE TABLE town AS SELECT id, shape FROM whole ORDER BY id", "CREATE TABLE about AS SELECT id, attributes FROM whole ORDER BY id", "DROP TABLE whole")
    server.ask("ALTER TABLE town ADD PRIMARY KEY (id)", "ALTER TABLE about ADD PRIMARY KEY (id)", "VACUUM ANALYZE town", "VACUUM ANALYZE about")
    return int(server.ask("SELECT count(*) FROM town"))


def measure_sizes(server, rows):
    server.ask("CREATE EXTENSION postgis", "CREATE TABLE as_ewkb AS SELECT id, wt_as_ewkb(shape) AS ewkb FROM town", "CREATE TABLE as_blob AS SELECT id, shape::bytea AS blob FROM town",
               "CREATE TABLE as_jsonb AS SELECT id, wt_as_cityjson(shape)::jsonb AS model FROM town",  # a document of one solid, as there is no geometry without its vertices
               "CREATE TABLE as_geometry AS SELECT id, ST_GeomFromEWKB(wt_as_ewkb(shape)) AS geom FROM town WHERE wt_shell_count(shape) = 1")  # PostGIS has no cavities
    size = {name: int(server.ask(f"SELECT pg_table_size('{name}')")) for name in ("town", "as_ewkb", "as_blob", "as_geometry", "as_jsonb")}
    for name, value in size.items():
        say(f"table {name}", f"{value / 1e6:9.1f} MB, {value / rows:7.1f} bytes a row, {100 * value / size['as_ewkb']:5.1f} % of EWKB")
    say("a value", f"{float(server.ask('SELECT avg(pg_column_size(shape)) FROM town')):9.1f} bytes; its EWKB "
        + server.ask("SELECT round(avg(length(ewkb))) FROM as_ewkb") + " bytes")


def measure_index(server):
    say("index on boxes, made", f"{server.seconds('CREATE INDEX town_box ON town USING gist (shape)'):9.1f} s")
    size = int(server.ask("SELECT pg_relation_size('town_box')"))
    say("index on boxes, size", f"{size / 1e6:9.1f} MB")
    server.ask("VACUUM ANALYZE town")


def timed(server, statement, times=50):
    """The median and the 99th percentile in the server, milliseconds, warm."""
    script = server.folder / "script.sql"
    script.write_text(statement + ";\n")
    out = server.run("psql", "-X", "-At", "-h", str(server.folder), "-U", "watertight", "-d", "postgres", "-c", "\\timing on",
                     *[word for _ in range(times + 3) for word in ("-c", statement)])
    found = sorted(float(line.split()[1]) for line in out.splitlines() if line.startswith("Time:"))[:-3]
    return statistics.median(found), found[int(len(found) * 0.99)]


def measure_queries(server, rows):
    bounds = [float(server.ask(f"SELECT wt_bound(wt_extent(shape), {i}) FROM town")) for i in range(1, 7)]
    wide, deep = bounds[3] - bounds[0], bounds[4] - bounds[1]
    x, y = (float(server.ask(f"SELECT wt_bound(wt_box(shape), {i}) FROM town WHERE id = {rows // 2}")) for i in (1, 2))
    x, y = x - 0.05 * wide, y - 0.05 * deep  # around one of them
    box = f"wt_box({x}, {y}, -1000, {x + 0.1 * wide}, {y + 0.1 * deep}, 10000)"  # a hundredth of the area
    found = server.ask(f"SELECT count(*) FROM town WHERE shape && {box}")
    say("rows of table town analyzed", f"{server.seconds('ANALYZE town'):9.1f} s")
    plan = server.ask(f"EXPLAIN (FORMAT JSON) SELECT FROM town WHERE shape && {box}")
    say("rows in 1 % of the area, estimated", f"{json.loads(plan)[0]['Plan']['Plan Rows']:9} of {found}")
    for what, statement, times in (
            ("one solid by id", f"SELECT shape FROM town WHERE id = {rows // 2}", 200),
            (f"the first 100 of {found} in 1 % of the area", f"SELECT id FROM town WHERE shape && {box} LIMIT 100", 100),
            (f"all {found} in 1 % of the area, counted", f"SELECT count(*) FROM town WHERE shape && {box}", 20),
            ("the 10 nearest to a place", f"SELECT id FROM town ORDER BY shape <-> wt_box({x}, {y}, 0, {x}, {y}, 0) LIMIT 10", 100)):
        median, most = timed(server, statement, times)
        say(what, f"{median:9.2f} ms, p99 {most:.2f}")
    server.ask("CREATE TABLE by_place AS SELECT * FROM town ORDER BY floor(wt_bound(wt_box(shape), 1) / 500), wt_bound(wt_box(shape), 2)")
    elapsed = server.seconds("CREATE INDEX by_range ON by_place USING brin (shape)")
    size = int(server.ask("SELECT pg_relation_size('by_range')"))
    say("BRIN index of rows by place", f"{elapsed:9.1f} s, {size / 1e6:.3f} MB")
    median, most = timed(server, f"SELECT count(*) FROM by_place WHERE shape && {box}", 20)
    say(f"all {found} in 1 % of the area by it, counted", f"{median:9.2f} ms, p99 {most:.2f}")
    for what, expression in (("volumes and areas", "sum(wt_volume(shape)), sum(wt_area(shape))"), ("facets", "sum(wt_facet_count(shape))"),
                             ("EWKB", "sum(length(wt_as_ewkb(shape)))"), ("exact centres", "count(wt_centroid(shape))"),
                             ("volumes below a height", "sum(wt_volume_below(shape, 3))"), ("boxes without the index", "wt_extent(shape)")):
        elapsed = server.seconds("SET min_parallel_table_scan_size = 0", f"SELECT {expression} FROM town")
        say(f"{what} of all", f"{elapsed:9.2f} s, {rows / elapsed:9.0f} solids/s")


def measure_city(server, rows):
    """Queries of the CityParquet benchmark, fetched by a client; that by box is measure_queries()'s."""
    name = "b3_h_dak_max"
    say("attributes, size", f"{int(server.ask('SELECT pg_table_size($$about$$)')) / 1e6:9.1f} MB, those of the service as jsonb")
    for what, statement, times in (
            ("count", "SELECT count(*) FROM town", 7), ("attribute statistics", f"SELECT count(v), min(v), avg(v), max(v) FROM (SELECT (attributes->>'{name}')::float8 AS v FROM about) a", 7),
            ("id and attributes by id", f"SELECT * FROM town JOIN about USING (id) WHERE id = {rows // 3}", 50)):
        median, most = timed(server, statement, times)
        say(f"{what}, one process or more", f"{median:9.2f} ms, p99 {most:.2f}")
    for what, query in (("geometry scan: id and solid as blob", "SELECT id, shape FROM town"), ("full read: id, attributes, solid as blob", "SELECT id, attributes, shape FROM town JOIN about USING (id)"),
                        ("geometry scan: id and EWKB", "SELECT id, wt_as_ewkb(shape) FROM town")):
        start = time.perf_counter()
        bytes_read = server.run("bash", "-c", f"'{server.bin}/psql' -X -q -h '{server.folder}' -U watertight -d postgres -c 'COPY ({query}) TO STDOUT (FORMAT binary)' | wc -c")
        elapsed = time.perf_counter() - start
        say(f"{what}, to a client", f"{elapsed:9.2f} s, {int(bytes_read) / 1e6:.1f} MB, {rows / elapsed:9.0f} rows/s")


def measure_dump(server, rows):
    file = server.folder / "dump"
    elapsed = server.seconds(f"COPY town TO '{file}'")
    say("dumped (COPY TO)", f"{elapsed:9.1f} s, {rows / elapsed:9.0f} solids/s, {file.stat().st_size / 1e6:.1f} MB")
    server.ask("CREATE TABLE again (LIKE town)")
    elapsed = server.seconds(f"COPY again FROM '{file}'")
    say("came back (COPY FROM), judged by the exact tests", f"{elapsed:9.1f} s, {rows / elapsed:9.0f} solids/s")
    if server.ask("SELECT count(*) FROM town JOIN again USING (id) WHERE town.shape = again.shape") != str(rows):
        raise SystemExit("rows: other solids came back")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build")
    parser.add_argument("--rows", type=int, default=100_000)
    parser.add_argument("documents", nargs="+", type=pathlib.Path)
    options = parser.parse_intermixed_args()
    build = str(pathlib.Path(options.build).resolve())
    documents = [document.resolve() for document in options.documents]
    with temporary_folder("rows") as folder:
        server = Server(build, folder)
        try:
            rows = load(server, build, documents, options.rows)
            say("rows", f"{rows:9}")
            measure_sizes(server, rows)
            measure_index(server)
            measure_queries(server, rows)
            measure_city(server, rows)
            measure_dump(server, rows)
        finally:
            server.stop()


if __name__ == "__main__":
    main()
