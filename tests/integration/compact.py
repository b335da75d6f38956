#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compacts a collection while others write it, and opens a database that a newer program made.

    compact.py WATERTIGHT ROOT

Exit code 1 after a difference.
"""
import os
import pathlib
import random
import re
import sys
import threading

PROGRAM, ROOT = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
FEATURES = 600
COMPACTS = 4
sys.path.insert(0, str(ROOT / "tests/siege"))
from service import Service, box_feature, sequence, temporary_folder  # noqa: E402


class Writer(threading.Thread):
    """Replaces and removes features until it is stopped; each writer has features of its own. `stored` has
    the line of each feature that was acknowledged."""

    def __init__(self, service, stored, first, step):
        super().__init__()
        self.service, self.stored, self.is_over, self.writes, self.failure = service, stored, False, 0, None
        self.numbers = range(first, FEATURES, step)

    def run(self):
        while not self.is_over and self.failure is None:
            number = random.choice(self.numbers)
            if random.random() < 0.3:
                status, body = self.service.request("DELETE", f"/collections/town/items/b{number}")
                self.stored.pop(number, None)
            else:
                line = box_feature(f"b{number}", random.randrange(100_000))
                status, body = self.service.request("POST", "/collections/town/items", sequence([line]))
                self.stored[number] = line
            if status not in (201, 204, 404):
                self.failure = f"a write got {status}: {body[:500]!r}"
            self.writes += 1


def counts_of(output):
    return {name: int(value) for name, value in re.findall(r"^(\S.*?)  +(\d+)$", output, re.MULTILINE)}


def check(service, stored):
    status, body = service.request("GET", "/collections/town/export?f=cityjsonseq")
    lines = set(body.decode().splitlines()[1:])
    if status != 200 or lines != set(stored.values()):
        raise SystemExit(f"{status}: {len(lines)} features, {len(lines ^ set(stored.values()))} of them differ")


def compacted_beside_writers(service):
    stored = {n: box_feature(f"b{n}", n) for n in range(FEATURES)}
    service.post("town", sequence(stored.values()))
    writers = [Writer(service, dict(), first, 2) for first in range(2)]
    for first, writer in enumerate(writers):
        writer.stored.update((n, line) for n, line in stored.items() if n % 2 == first)
        writer.start()
    try:
        for _ in range(COMPACTS):
            counts = counts_of(service.run("compact", "town"))
            if not 0 < counts["features"] <= FEATURES or counts["packed again"] > counts["features"]:
                raise SystemExit(f"compact says {counts}")
    finally:
        for writer in writers:
            writer.is_over = True
            writer.join()
    for writer in writers:
        if writer.failure:
            raise SystemExit(writer.failure)
    stored = {**writers[0].stored, **writers[1].stored}
    check(service, stored)
    counts = counts_of(service.run("compact", "town"))
    if counts["features"] != len(stored) or counts["bytes of texts after"] > counts["bytes of texts before"]:
        raise SystemExit(f"compact says {counts} of {len(stored)} features")
    check(service, stored)
    error = service.run("compact", "village", code=2)
    if "village" not in error:
        raise SystemExit(f"compact of an unknown collection says: {error}")
    return sum(writer.writes for writer in writers)


def newer_database_is_refused(service):
    newest = int(service.ask("SELECT max(number) FROM watertight.migration"))
    service.ask(f"INSERT INTO watertight.migration (number, name) VALUES ({newest + 1}, 'of tomorrow')")
    error = service.run("collections", "list", code=2)
    if f"schema {newest + 1}" not in error or f"knows {newest}" not in error:
        raise SystemExit(f"a newer database gives: {error}")


with temporary_folder("compact") as folder, Service(PROGRAM, folder) as service:
    print(f"{COMPACTS + 1} compacts beside {compacted_beside_writers(service)} writes")
    newer_database_is_refused(service)
