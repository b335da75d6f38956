#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures how solids get into a table: load.py BUILD [--solids N] DOCUMENT...

From each document, and from an equal number of solids of each ("mix"), N valid solids (10,000; documents are repeated) are stored with
full proof by one process, durably: by COPY into a column of type solid, by INSERT of arrays of 100 (unnest), and from a table of
bytes in the server. The time is split by what the steps add to each other. The share of each rung of the ladder among the valid solids
of a document is that of `watertight validate`, because functions of the server do not state it.
"""
import argparse
import collections
import json
import pathlib
import subprocess
import sys

from rows import ROOT, Server, copy_solids, say

sys.path.insert(0, str(ROOT / "tests" / "siege"))
from service import temporary_folder  # noqa: E402

BATCH = 100


def valid_solids(server, build, document):
    """The EWKB of the document's valid solids, hexadecimal."""
    copy_solids(server, build, [document], "delivery")
    found = server.ask("SELECT encode(ewkb, 'hex') FROM delivery WHERE wt_try_solid(ewkb) IS NOT NULL", "DROP TABLE delivery").split()
    if not found:
        raise SystemExit(f"load: {document} has no valid solid")
    return found


def rungs_of(value):
    """The rungs of the valid solids anywhere in a report."""
    if isinstance(value, dict):
        if "rung" in value and value.get("validity"):
            yield value["rung"]
        value = list(value.values())
    if isinstance(value, list):
        for member in value:
            yield from rungs_of(member)


def say_rungs(build, document, folder):
    subprocess.run([f"{build}/bin/watertight", "validate", "-q", "--report", str(folder / "report.json"), str(document)], check=False, capture_output=True)
    counts = collections.Counter(rungs_of(json.loads((folder / "report.json").read_text())))
    say(f"{document.name.split('.')[0]}, rungs of the valid solids", ", ".join(f"{rung} {100 * n / counts.total():.2f} %" for rung, n in counts.most_common()))


def repeated(solids, count):
    return [solids[i % len(solids)] for i in range(count)]


def measure(server, name, solids):
    """Loads `solids` (hexadecimal EWKB) in three ways into tables that are empty."""
    count = len(solids)
    texts, arrays = server.folder / "texts", server.folder / "arrays.sql"
    texts.write_text("".join(f"{i}\t\\\\x{solid}\n" for i, solid in enumerate(solids)))
    with arrays.open("w") as out:
        for begin in range(0, count, BATCH):
            batch = ",".join(f'"\\\\x{solid}"' for solid in solids[begin:begin + BATCH])
            out.write(f"INSERT INTO by_unnest SELECT {begin} + n - 1, wt_solid(e) FROM unnest('{{{batch}}}'::bytea[]) WITH ORDINALITY AS t (e, n);\n")
    server.ask("CREATE TABLE raw (id int, ewkb bytea)", *(f"CREATE TABLE {table} (id int, shape solid)" for table in ("by_copy", "by_unnest", "by_select")))
    with texts.open() as source:
        server.ask("COPY raw FROM STDIN", "VACUUM ANALYZE raw", stdin=source)
    alone = "SET max_parallel_workers_per_gather = 0"

    def seconds(*statements):
        return server.seconds(alone, *statements)

    exact = seconds("SELECT count(*) FROM raw WHERE wt_is_valid(ewkb, wt_rules(proof => 'boundary'))")
    proven = seconds("SELECT count(*) FROM raw WHERE wt_is_valid(ewkb)")
    coded = seconds("SELECT count(wt_solid(ewkb)) FROM raw")
    stored = seconds("INSERT INTO by_select SELECT id, wt_solid(ewkb) FROM raw")
    server.folder.joinpath("copy.sql").write_text(f"\\copy by_copy FROM '{texts}'\n")
    ways = {"COPY": server.timed_file("copy.sql"), f"INSERT, unnest of {BATCH}": server.timed_file("arrays.sql"), "INSERT, SELECT": stored}
    for way, elapsed in ways.items():
        say(f"{name}, {way}", f"{elapsed:8.2f} s, {count / elapsed:7.0f} solids/s")
    say(f"{name}, microseconds a solid", ", ".join(f"{what} {1e6 * elapsed / count:.0f}" for what, elapsed in (
        ("exact tests", exact), ("proof", proven - exact), ("blob", coded - proven), ("row", stored - coded), ("text and client of COPY", ways["COPY"] - stored))))
    same = server.ask("SELECT count(*) FROM by_copy JOIN by_unnest USING (id) JOIN by_select s USING (id) WHERE by_copy.shape = s.shape AND by_unnest.shape = s.shape")
    if int(same) != count:
        raise SystemExit(f"load: {same} of {count} rows are the same in the three tables")
    server.ask("DROP TABLE raw, by_copy, by_unnest, by_select")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build")
    parser.add_argument("--solids", type=int, default=10_000)
    parser.add_argument("documents", nargs="+", type=pathlib.Path)
    options = parser.parse_intermixed_args()
    build = str(pathlib.Path(options.build).resolve())
    with temporary_folder("load") as folder:
        server = Server(build, folder)
        try:
            server.ask("CREATE EXTENSION watertight")
            found = {document.name.split(".")[0]: valid_solids(server, build, document.resolve()) for document in options.documents}
            for document in options.documents:
                say_rungs(build, document.resolve(), folder)
            sets = {name: repeated(solids, options.solids) for name, solids in found.items()}
            if len(sets) > 1:
                share = options.solids // len(sets)
                sets["mix"] = [solid for chosen in zip(*(repeated(solids, share) for solids in found.values())) for solid in chosen]
            for name, solids in sets.items():
                measure(server, name, solids)
        finally:
            server.stop()


if __name__ == "__main__":
    main()
