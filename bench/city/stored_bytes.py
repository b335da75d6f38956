#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Counts the bytes that features take in PostgreSQL, and times the read of one feature.

    stored_bytes.py WATERTIGHT FILE... [--copies N] [--invalid skip] [--before OLD_WATERTIGHT]

Each document is stored alone (invalid=keep, or only what is valid) in a private database, after which
VACUUM is run. Prints
the bytes of each table (with TOAST) and index, those of an empty schema, and the difference of the
sums by feature. --copies N repeats the rows N times under other ids and place numbers and 1 km apart
first (tables of schema 10 and later). --before: the same with an older program, and the times of reads of one feature
(f=cityjsonseq, no cache) by both programs in turn, as a ratio.
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import sys
import time
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tests/siege"))
from service import Service, temporary_folder  # noqa: E402

SIZES = """SELECT relname || ' ' || CASE relkind WHEN 'i' THEN pg_relation_size(c.oid)
    ELSE pg_table_size(c.oid) END FROM pg_class c JOIN pg_namespace n ON n.oid = relnamespace
  WHERE nspname = 'watertight' AND relkind IN ('r', 'i') ORDER BY relname"""
COPY = """INSERT INTO watertight.feature_row (place, min_x, min_y, min_z, max_x, max_y, max_z, collection, kind,
    dictionary, solids, blob_bytes, unproven, is_proven, id, packed_solids, packed_text)
  SELECT place - n, min_x + n * 1000, min_y, min_z, max_x + n * 1000, max_y, max_z, collection, kind, dictionary,
    solids, blob_bytes, unproven, is_proven, left(id, -12) || left(md5(id || n), 12), packed_solids, packed_text
  FROM watertight.feature_row, generate_series(1, {}) n ORDER BY n ON CONFLICT DO NOTHING"""
TYPES = {".jsonl": "application/city+json-seq", ".json": "application/city+json"}


def psql(service, sql):
    lines = (service.folder / "data/postgres/postmaster.pid").read_text().split("\n")
    return subprocess.run([*service.prefix, "psql", "-X", "-q", "-A", "-t", "-v", "ON_ERROR_STOP=1", "-h", lines[4],
                           "-p", lines[3], "-d", "watertight", "-c", sql],
                          capture_output=True, text=True, check=True).stdout.strip()


def sizes(service):
    psql(service, "VACUUM ANALYZE")
    return {name: int(size) for name, size in (line.split() for line in psql(service, SIZES).split("\n"))}


def store(service, path, copies, invalid):
    empty = sizes(service)
    status, body = service.request("POST", f"/collections/c/items?invalid={invalid}", path.read_bytes(), 600,
                                   {"Content-Type": TYPES[path.suffix]})
    if status != 201:
        raise SystemExit(f"{path.name}: {status} {body[:300]!r}")
    if copies:
        psql(service, COPY.format(copies))
    return empty, sizes(service), int(psql(service, "SELECT count(*) FROM watertight.feature"))


def show(path, empty, full, features):
    print(f"\n{path.name}: {features} features\n\n| table or index | bytes | of an empty schema |\n|---|---|---|")
    for name in sorted(full, key=full.get, reverse=True):
        print(f"| {name} | {full[name]} | {empty.get(name, 0)} |")
    all_bytes, fixed = sum(full.values()), sum(empty.values())
    print(f"| all | {all_bytes} | {fixed} |\n\nbytes a feature: {(all_bytes - fixed) / features:.0f}"
          f" (with the empty schema {all_bytes / features:.0f})")


def read_in_turn(services, ids):
    """The seconds in which each service has read all features, one after the other in turn. They start
    anew, so that they have no answer in memory."""
    seconds = [0.0] * len(services)
    for service in services:
        service.stop()
        service.start()
        service.request("GET", f"/collections/c/items/{ids[0]}?f=obj")
    for name in ids:
        for i, service in enumerate(services):
            start = time.perf_counter()
            status, _ = service.request("GET", f"/collections/c/items/{name}?f=cityjsonseq")
            seconds[i] += time.perf_counter() - start
            assert status == 200
    return seconds


def ids_of(service):
    page = json.loads(service.request("GET", "/collections/c/items?limit=200")[1])
    return [urllib.parse.quote(item["id"], safe="") for item in page["features"]]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("files", nargs="+", type=pathlib.Path)
    parser.add_argument("--copies", type=int, default=0)
    parser.add_argument("--invalid", choices=["keep", "skip"], default="keep")
    parser.add_argument("--before")
    arguments = parser.parse_args()
    for path in arguments.files:
        with temporary_folder("bytes") as folder, Service(arguments.program, folder) as service:
            show(path, *store(service, path, arguments.copies, arguments.invalid))
            if not arguments.before:
                continue
            with temporary_folder("before") as other, Service(arguments.before, other) as old:
                print("\nbefore:")
                show(path, *store(old, path, 0, arguments.invalid))
                ids, ratios = ids_of(old), []
                for _ in range(7):
                    before, after = read_in_turn([old, service], ids)
                    ratios.append(after / before)
                print(f"\nread of one feature, this program to the one before: {statistics.median(ratios):.2f}"
                      f" (median of {len(ratios)} runs of {len(ids)} reads in turn,"
                      f" {before / len(ids) * 1000:.2f} ms before)")


if __name__ == "__main__":
    main()
