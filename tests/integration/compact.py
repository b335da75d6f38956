#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compacts a collection while others write it, and opens a database that a newer program made.

    compact.py WATERTIGHT ROOT [ROUNDS]

In each round a compact beside writers is killed at random (SIGKILL), and in each second round the database
with it; then each feature is as its last write was acknowledged. Exit code 1 after a difference.
"""
import http.client
import json
import os
import pathlib
import random
import re
import signal
import subprocess
import sys
import threading
import time

PROGRAM, ROOT = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
ROUNDS = int(sys.argv[3]) if len(sys.argv) > 3 else 3
FEATURES = 600
COMPACTS = 4
sys.path.insert(0, str(ROOT / "tests/siege"))
from service import Service, box_feature, sequence, temporary_folder  # noqa: E402


class Writer(threading.Thread):
    """Replaces and removes features until it is stopped; each writer has features of its own. `stored` has
    the line of each feature that was acknowledged, `unsure` the numbers of those whose last write was not,
    which `may_fail` allows."""

    def __init__(self, service, stored, first, step, collection="town", may_fail=False):
        super().__init__()
        self.service, self.stored, self.is_over, self.writes, self.failure = service, stored, False, 0, None
        self.numbers, self.path, self.may_fail = range(first, FEATURES, step), f"/collections/{collection}/items", may_fail
        self.unsure = set()

    def run(self):
        while not self.is_over and self.failure is None:
            number = random.choice(self.numbers)
            line = None if random.random() < 0.3 else box_feature(f"b{number}", random.randrange(100_000))
            try:
                if line is None:
                    status, body = self.service.request("DELETE", f"{self.path}/b{number}")
                else:
                    status, body = self.service.request("POST", self.path, sequence([line]))
            except (OSError, http.client.HTTPException) as failure:
                status, body = 0, str(failure)
            if status in (201, 204, 404):
                self.unsure.discard(number)
                self.stored.pop(number, None)
                if line is not None:
                    self.stored[number] = line
                self.writes += 1
            elif self.may_fail:
                self.unsure.add(number)
                time.sleep(0.02)
            else:
                self.failure = f"a write got {status}: {body[:500]!r}"


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


def kill(pid):
    try:
        os.kill(pid, signal.SIGKILL)
    except ProcessLookupError:
        pass


def killed_round(service, number):
    """Kills a compact beside writers. Returns whether it ran when it was killed, and the number of writes."""
    town = f"town{number}"
    stored = {n: box_feature(f"b{n}", n) for n in range(FEATURES)}
    service.post(town, sequence(stored.values()))
    writers = [Writer(service, {n: line for n, line in stored.items() if n % 2 == first}, first, 2, town, True)
               for first in range(2)]
    for writer in writers:
        writer.start()
    compact = service.command("compact", town)
    try:
        compact.communicate(timeout=random.uniform(0.05, 0.6))
    except subprocess.TimeoutExpired:
        compact.kill()
        if number % 2 == 0:
            for pid in service.database_processes():
                kill(pid)
        compact.communicate()
    if compact.returncode not in (0, -signal.SIGKILL):
        raise SystemExit(f"compact ended with {compact.returncode}")
    time.sleep(0.2)
    for writer in writers:
        writer.is_over = True
        writer.join()
    for _ in range(300):
        if service.request("GET", "/readyz")[0] == 200:
            break
        time.sleep(0.1)
    status, body = service.request("GET", f"/collections/{town}/export?f=cityjsonseq")
    if status != 200:
        raise SystemExit(f"export: {status} {body[:500]!r}")
    found = {json.loads(line)["id"]: line for line in body.decode().splitlines()[1:]}
    for writer in writers:
        wrong = [n for n in writer.numbers if n not in writer.unsure and found.get(f"b{n}") != writer.stored.get(n)]
        if wrong:
            raise SystemExit(f"{len(wrong)} features are not as their last write was acknowledged, as b{wrong[0]}")
    service.run("compact", town)
    status, body = service.request("GET", f"/collections/{town}/export?f=cityjsonseq")
    if {json.loads(line)["id"]: line for line in body.decode().splitlines()[1:]} != found:
        raise SystemExit("another compact changed features")
    service.run("collections", "delete", town)
    return compact.returncode != 0, sum(writer.writes for writer in writers)


def newer_database_is_refused(service):
    newest = int(service.ask("SELECT max(number) FROM watertight.migration"))
    service.ask(f"INSERT INTO watertight.migration (number, name) VALUES ({newest + 1}, 'of tomorrow')")
    error = service.run("collections", "list", code=2)
    if f"schema {newest + 1}" not in error or f"knows {newest}" not in error:
        raise SystemExit(f"a newer database gives: {error}")


with temporary_folder("compact") as folder, Service(PROGRAM, folder) as service:
    print(f"{COMPACTS + 1} compacts beside {compacted_beside_writers(service)} writes")
    rounds = [killed_round(service, number) for number in range(ROUNDS)]
    print(f"{ROUNDS} rounds with {sum(was_killed for was_killed, _ in rounds)} compacts killed beside"
          f" {sum(writes for _, writes in rounds)} writes, none lost")
    newer_database_is_refused(service)
