#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures how late a statement ends that is out of time: cancel.py BUILD [--times N] MESH

The solid of MESH (OBJ, OFF, PLY) in a server of its own. Each function takes it once to its end; then N times (10) with a
statement_timeout at even parts of that time. Printed is by how much the statement outlasts it: the most and the median. Functions that
are done in less than 20 ms are left out.
"""
import argparse
import pathlib
import statistics
import subprocess
import sys

from rows import ROOT, Server, copy_solids, say

sys.path.insert(0, str(ROOT / "tests" / "siege"))
from service import temporary_folder  # noqa: E402

CALLS = (
    "length(ewkb) FROM raw", "wt_is_valid(ewkb) FROM raw", "wt_is_valid(ewkb, wt_rules(proof => 'boundary')) FROM raw", "length(wt_validate(ewkb)::text) FROM raw",
    "count(*) FROM raw, wt_findings(ewkb)", "length(wt_encode(ewkb)) FROM raw", "wt_solid(ewkb) IS NULL FROM raw", "(SELECT text FROM texts)::solid IS NULL",
    "wt_solid(blob) IS NULL FROM raw", "length(wt_decode(blob)) FROM raw", "length(shape::text) FROM town", "length(wt_as_ewkb(shape)) FROM town",
    "length(wt_as_text(shape)) FROM town", "length(wt_as_obj(shape)) FROM town", "length(wt_as_cityjson(shape)::text) FROM town", "length(wt_as_glb(shape)) FROM town",
    "wt_centroid(shape) FROM town", "wt_genus(shape) FROM town", "count(*) FROM town, wt_faces(shape)", "wt_volume_below(shape, 0) FROM town",
    "count(*) FROM town, wt_clip_z(shape, -1e9, 0)", "wt_contains(shape, 0, 0, 0) FROM town", "wt_distance(a.shape, b.shape) FROM town a, town b",
    "wt_intersects(a.shape, b.shape) FROM town a, town b", "wt_overlaps(a.shape, b.shape) FROM town a, town b", "wt_shared_area(a.shape, b.shape) FROM town a, town b",
    "wt_translate(shape, 1, 0, 0) IS NULL FROM town", "count(*) FROM town, wt_tetrahedra(shape)", "length(wt_repair(ewkb, 'all')::text) FROM raw", "length(wt_page_agg(shape)) FROM town",
)


def beyond(server, call, limit):
    """Milliseconds that the statement takes beyond `limit`, without those of the client's start; None if it was done in time."""
    out = subprocess.run([*server.prefix, f"{server.bin}/psql", "-X", "-q", "-At", "-h", str(server.folder), "-U", "watertight", "-d", "postgres",
                          "-c", "SELECT wt_is_valid('\\x00') IS NULL", "-c", f"SET statement_timeout = {limit}", "-c", "\\timing on", "-c", f"SELECT {call}"],
                         check=False, capture_output=True, text=True)
    taken = [float(line.split()[1]) for line in out.stdout.splitlines() if line.startswith("Time:")]
    if not taken:
        raise SystemExit(f"cancel: {call}: {out.stderr}")
    failure = out.stderr.splitlines()[-1] if out.stderr else ""
    if limit and "statement timeout" not in out.stderr:
        return None
    if not limit and "ERROR" in failure and "\\x00" not in failure and len(out.stderr.splitlines()) > 3:
        raise SystemExit(f"cancel: {call}: {out.stderr}")
    return taken[-1] - limit


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build")
    parser.add_argument("--times", type=int, default=10)
    parser.add_argument("mesh", type=pathlib.Path)
    options = parser.parse_intermixed_args()
    build = str(pathlib.Path(options.build).resolve())
    with temporary_folder("cancel") as folder:
        server = Server(build, folder)
        try:
            server.ask("CREATE EXTENSION watertight")
            copy_solids(server, build, [options.mesh], "raw")
            server.ask("ALTER TABLE raw ADD blob bytea", "CREATE TABLE town AS SELECT wt_solid(ewkb) AS shape FROM raw", "UPDATE raw SET blob = shape::bytea FROM town",
                       "CREATE TABLE texts AS SELECT wt_as_text(shape) AS text FROM town")
            say("EWKB", f"{int(server.ask('SELECT length(ewkb) FROM raw')) / 1e6:9.1f} MB")
            for call in CALLS:
                whole = beyond(server, call, 0)
                if whole < 20:
                    continue
                late = [beyond(server, call, max(1, round(whole * (i + 0.5) / options.times))) for i in range(options.times)]
                late = [value for value in late if value is not None]
                say(call, f"{whole:9.0f} ms" + (f", late by {max(late):6.0f} ms at most, median {statistics.median(late):5.0f}" if late else ", always in time"))
        finally:
            server.stop()


if __name__ == "__main__":
    main()
