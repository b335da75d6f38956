#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Memory of a backend over a million calls: calls.py BUILD [--calls N] DOCUMENT

The solids of the document, valid and invalid: N calls (1,000,000) of five functions together, each in one session. Printed is the
memory of the backend, without what it shares with others, after a tenth and after all of the calls. Plans are not compiled (jit),
because compiled plans of PostgreSQL keep memory until the session ends.
"""
import argparse
import pathlib
import sys

from rows import ROOT, Server, copy_solids, say

sys.path.insert(0, str(ROOT / "tests" / "siege"))
from service import temporary_folder  # noqa: E402

CALLS = ("wt_is_valid(ewkb)", "wt_try_solid(ewkb) IS NULL", "wt_validate(ewkb) IS NULL", "wt_as_ewkb(shape) IS NULL", "wt_centroid(shape) IS NULL")
MEMORY = "SELECT (regexp_match(pg_read_file('/proc/self/status'), 'RssAnon:\\s+(\\d+)'))[1]"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build")
    parser.add_argument("--calls", type=int, default=1_000_000)
    parser.add_argument("document", type=pathlib.Path)
    options = parser.parse_args()
    build = str(pathlib.Path(options.build).resolve())
    with temporary_folder("calls") as folder:
        server = Server(build, folder)
        try:
            server.ask("CREATE EXTENSION watertight")
            copy_solids(server, build, [options.document], "raw")
            server.ask("CREATE TABLE both_kinds AS SELECT ewkb, wt_try_solid(ewkb) AS shape FROM raw")
            count = int(server.ask("SELECT count(*) FROM both_kinds"))
            calls = options.calls // len(CALLS)
            for call in CALLS:
                def some(wanted):
                    return f"DO $$ BEGIN FOR i IN 1..{max(1, wanted // count)} LOOP PERFORM count({call}) FROM both_kinds; END LOOP; END $$"
                first, last = server.ask("SET jit = off", "SET max_parallel_workers_per_gather = 0", some(calls // 10), MEMORY, some(calls * 9 // 10), MEMORY).split()
                say(call, f"{int(first):9} kB, {int(last):9} kB in the end")
        finally:
            server.stop()


if __name__ == "__main__":
    main()
