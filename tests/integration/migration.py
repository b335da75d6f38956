#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Opens a database of schema 8 and compacts it, and kills both at random.

    migration.py WATERTIGHT ROOT [ROUNDS]

tests/data/schema8/store.sql is a dump of a database that a program of schema 8 filled, answers.json
what that program answered for each feature. Copies of the rows make the migration long enough to be
killed: each round kills program and database once in a migration and once in a compact, and then
compares all answers. Prints a line for each step; exit code 1 after a difference.
"""
import json
import os
import pathlib
import random
import signal
import subprocess
import sys
import time
import urllib.parse

PROGRAM, ROOT = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
ROUNDS = int(sys.argv[3]) if len(sys.argv) > 3 else 1
COPIES = 20
sys.path.insert(0, str(ROOT / "tests/siege"))
from service import Service, temporary_folder  # noqa: E402

DATA = ROOT / "tests/data/schema8"
COPY = f"""
INSERT INTO watertight.feature (collection, id, type, format, srid, header, skeleton, solids, blob_bytes,
    min_x, min_y, min_z, max_x, max_y, max_z, place, unproven, is_proven, findings)
  SELECT collection, id || ' copy ' || n, type, format, srid, header, skeleton, solids, blob_bytes,
    min_x, min_y, min_z, max_x, max_y, max_z, place, unproven, is_proven, findings
  FROM watertight.feature, generate_series(1, {COPIES}) n;
INSERT INTO watertight.solid
  SELECT collection, feature || ' copy ' || n, object_id, geometry, ordinal, position, lod, blob, measures, report
  FROM watertight.solid, generate_series(1, {COPIES}) n;"""


def end(service):
    """Kills the program and its database, which may just be starting."""
    if service.process:
        service.process.kill()
        service.process.wait()
    while pids := service.database_processes():
        for pid in pids:
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
        time.sleep(0.05)


def killed(service, words, seconds):
    """Runs a command with the service's folder and kills it and its database after some seconds. Returns
    whether it had ended before."""
    service.process = subprocess.Popen(
        [*service.prefix, "env", f"HOME={service.folder}", PROGRAM, *words, "--data-dir",
         str(service.folder / "data")], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=service.folder)
    time.sleep(seconds)
    has_ended = service.process.poll() is not None
    end(service)
    return has_ended


def kills_until_done(service, words):
    """Runs a command until it has ended before it was killed, at most three times. Returns the number of kills."""
    kills = 0
    while kills < 3 and not killed(service, words, random.uniform(0.1, 1 + kills / 2)):
        kills += 1
    return kills


def check(service, versions, blobs):
    answers = json.loads((DATA / "answers.json").read_text())
    for name, expected in answers.items():
        collection, feature = name.split("/")
        path = f"/collections/{collection}/items/{urllib.parse.quote(feature)}"
        status, body = service.request("GET", path + "?f=cityjsonseq")
        if status != 200 or body.decode() != expected["cityjsonseq"]:
            raise SystemExit(f"{name}: {status}, another document")
        status, body = service.request("GET", path + "?f=proof")
        if status != 200 or json.loads(body) != json.loads(expected["proof"]):
            raise SystemExit(f"{name}: {status}, another proof: {body[:2000]!r} for {expected['proof'][:2000]}")
    for line in blobs:
        collection, feature, solid, expected = line.split("|")
        path = f"/collections/{collection}/items/{urllib.parse.quote(feature)}?f=blob&solid={solid}"
        status, body = service.request("GET", path)
        if status != 200 or body.hex() != expected:
            raise SystemExit(f"solid {solid} of {collection}/{feature}: {status}, another blob")
    if service.ask("SELECT count(*) || ' ' || sum(version) FROM watertight.feature") != versions:
        raise SystemExit("features or versions are missing")
    for collection in ("delft", "boxes"):
        found = json.loads(service.request("GET", f"/collections/{collection}")[1])
        count = service.ask(f"SELECT count(*) FROM watertight.feature WHERE collection = '{collection}'")
        if str(found["features"]) != count:
            raise SystemExit(f"{collection} says {found['features']} features and has {count}")


def one_round(number, service):
    service.ask("DROP SCHEMA watertight CASCADE")
    service.ask("", DATA / "store.sql")
    blobs = service.ask("SELECT concat_ws('|', collection, feature, position, encode(blob, 'hex'))"
                        " FROM watertight.solid WHERE blob IS NOT NULL").splitlines()
    service.ask(COPY)
    versions = service.ask("SELECT count(*) || ' ' || sum(version) FROM watertight.feature")
    service.stop()
    moves = kills_until_done(service, ["collections", "list"])
    service.start()
    check(service, versions, blobs)
    service.stop()
    compacts = kills_until_done(service, ["compact", "delft"])
    service.start()
    check(service, versions, blobs)
    paged = service.ask("SELECT count(*) FROM watertight.feature_row WHERE substring(packed_solids FOR 1) = '\\x1e'")
    if compacts < 3 and int(paged) == 0:
        raise SystemExit("no solids are in pages")
    bytes_now = service.ask("SELECT sum(octet_length(packed_text)) / count(*) FROM watertight.feature_row")
    print(f"round {number}: {versions.split()[0]} features moved with {moves} kills, compacted with {compacts},"
          f" {bytes_now} bytes of text a feature, {paged} features with a page", flush=True)
    return moves, compacts


with temporary_folder("migration") as folder, Service(PROGRAM, folder) as service:
    sums = [sum(kills) for kills in zip(*(one_round(at + 1, service) for at in range(ROUNDS)))]
print(f"{ROUNDS} rounds, {sums[0]} kills of migrations and {sums[1]} of compacts, nothing lost")
