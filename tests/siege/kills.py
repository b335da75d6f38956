#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Kills, stops and shuts down parts of a service under writers, and looks for what was lost.

    kills.py PROGRAM [--rounds N] [--writers W] [--seed S]

Each round lets W clients store, replace and delete features for a moment, does one thing to the
service or its private database (kill -9 of the service, of the database's first process, of one or
all of its processes; SIGSTOP of them all for two seconds; a smart shutdown), and requires that the
service is ready again within five seconds, started anew if it was killed. Then every feature whose
last write was acknowledged is exactly as it was acknowledged; a write without an answer is done as a
whole or not at all; and the list has each feature once. Prints a line a round and the sums; exit
code 1 after the first violation.
"""
import argparse
import http.client
import json
import os
import pathlib
import random
import signal
import sys
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from service import Service, box_feature, sequence, temporary_folder  # noqa: E402

READY_SECONDS = 5
TOGETHER = 20  # features of a document that is stored as a whole or not at all
IDS = 400  # features that the writers of one run change
ABSENT = None


class Writer(threading.Thread):
    """Stores and deletes its own features until told to end. `known` has, by id, the states that the
    feature may be in: one after an answer, two after a write without an answer."""

    def __init__(self, service, number, writers, seed):
        super().__init__(daemon=True)
        self.service = service
        self.ids = [f"w{number}-{n}" for n in range(IDS // writers)]
        self.known = {name: [ABSENT] for name in self.ids}
        self.together = [f"t{number}-{n}" for n in range(TOGETHER)]  # always written in one document
        self.random = random.Random(seed * 1000 + number)
        self.last_together = ABSENT
        self.has_written_together = False
        self.acknowledged = 0
        self.in_doubt = 0
        self.is_over = threading.Event()
        self.may_write = threading.Event()
        self.is_writing = threading.Lock()

    def run(self):
        while not self.is_over.is_set():
            if not self.may_write.wait(0.1):
                continue
            with self.is_writing:
                if self.may_write.is_set():
                    self.write_once()

    def write_once(self):
        if self.random.random() < 0.2:
            self.write_together()
            return
        name = self.random.choice(self.ids)
        state = ABSENT if self.random.random() < 0.2 else self.random.randrange(1 << 30)
        try:
            if state is ABSENT:
                status, _ = self.service.request("DELETE", f"/collections/town/items/{name}", timeout=20)
            else:
                line = box_feature(name, state)
                status, _ = self.service.request("POST", "/collections/town/items", sequence([line]), timeout=20)
        except (OSError, http.client.HTTPException):
            status = 0
        if status in (201, 204) or (status == 404 and state is ABSENT):
            self.known[name] = [state]
            self.acknowledged += 1
        else:  # 503, or no answer: done or not
            if state not in self.known[name]:
                self.known[name] = [*self.known[name], state]
            self.in_doubt += 1
            time.sleep(0.02)

    def write_together(self):
        state = self.random.randrange(1 << 30)
        document = sequence([box_feature(name, state) for name in self.together])
        try:
            status, _ = self.service.request("POST", "/collections/together/items", document, timeout=20)
        except (OSError, http.client.HTTPException):
            status = 0
        self.last_together = state if status == 201 else None  # None: this state or the one before
        self.has_written_together |= status == 201
        self.acknowledged += status == 201
        self.in_doubt += status != 201


def read(service, path):
    """An answer other than 503, which is right for a moment after a smart shutdown: it ends sessions
    only seconds later, perhaps after the service was ready."""
    end = time.monotonic() + READY_SECONDS
    while True:
        status, body = service.request("GET", path)
        if status != 503 or time.monotonic() > end:
            return status, body
        time.sleep(0.05)


def state_of(service, name, collection="town"):
    """The line of the feature that is stored under a name, or ABSENT."""
    status, body = read(service, f"/collections/{collection}/items/{name}?f=cityjsonseq")
    if status == 404:
        return ABSENT
    if status != 200:
        raise SystemExit(f"kills: {name}: status {status}: {body[:300]!r}")
    return body.decode().splitlines()[1]


def check_together(service, writer):
    """Whether all features of a writer's document are there in one state, the acknowledged one."""
    found = [state_of(service, name, "together") for name in writer.together]
    shapes = {None if line is ABSENT else json.dumps(json.loads(line)["vertices"]) for line in found}
    if len(shapes) != 1:
        return [f"a document of {TOGETHER} features is stored in {len(shapes)} states: {writer.together[0]}"]
    if writer.has_written_together and shapes == {None}:
        return [f"an acknowledged document is gone: {writer.together[0]}"]
    wanted = writer.last_together
    if wanted is not None and shapes != {json.dumps(json.loads(box_feature("x", wanted))["vertices"])}:
        return [f"a document is not as it was acknowledged: {writer.together[0]}"]
    return []


def check(service, writers):
    """Compares what is stored with what was acknowledged; the complaints."""
    complaints = []
    expected = set()
    for writer in writers:
        for name, states in writer.known.items():
            found = state_of(service, name)
            matching = [state for state in states
                        if (found is ABSENT) == (state is ABSENT)
                        and (state is ABSENT or json.loads(found)["vertices"] == json.loads(
                            box_feature(name, state))["vertices"])]
            if not matching:
                complaints.append(f"{name}: {len(states)} possible states, none of them is stored: {str(found)[:200]}")
                continue
            writer.known[name] = matching[:1]
            if matching[0] is not ABSENT:
                expected.add(name)
        complaints += check_together(service, writer)
    listed = []
    path = "/collections/town/items?limit=1000&f=summary"
    while path:
        status, body = read(service, path)
        if status != 200:
            return [*complaints, f"{path}: status {status}"]
        page = json.loads(body)
        listed += [feature["id"] for feature in page["features"]]
        path = next((link["href"] for link in page["links"] if link["rel"] == "next"), None)
    if sorted(listed) != sorted(expected):
        complaints.append(f"the list has {len(listed)} entries, {len(expected)} are expected")
    counted = json.loads(read(service, "/collections/town")[1]).get("features")
    if counted != len(expected):
        complaints.append(f"the collection counts {counted} features, {len(expected)} are expected")
    return complaints


def harm(service, kind, choice):
    """Does one thing to the service, and starts it again if it was killed. Returns the moment from
    which it has to become ready."""
    begin = time.monotonic()
    if kind == "service":
        service.process.kill()
        service.process.wait()
        service.start()
        return begin
    pids = service.database_processes()
    if not pids:
        return begin
    if kind == "postmaster":
        kill_if_there(pids[0], signal.SIGKILL)
    elif kind == "one":
        kill_if_there(choice.choice(pids), signal.SIGKILL)
    elif kind == "all":
        for pid in pids:
            kill_if_there(pid, signal.SIGKILL)
    elif kind == "stop":
        for pid in pids:
            kill_if_there(pid, signal.SIGSTOP)
        time.sleep(choice.uniform(0.5, 4))
        for pid in pids:
            kill_if_there(pid, signal.SIGCONT)
        begin = time.monotonic()
    elif kind == "smart":
        kill_if_there(pids[0], signal.SIGTERM)
        while pathlib.Path(f"/proc/{pids[0]}").exists() and time.monotonic() < begin + 2 * READY_SECONDS:
            time.sleep(0.02)
    elif kind == "both":
        service.process.kill()
        for pid in pids:
            kill_if_there(pid, signal.SIGKILL)
        service.process.wait()
        service.start()
    return begin


def kill_if_there(pid, what):
    try:
        os.kill(pid, what)
    except ProcessLookupError:
        pass


def seconds_until_ready(service, start):
    """Ready is a /readyz of 200 and a write that is acknowledged."""
    while time.monotonic() - start < 60:
        try:
            if service.request("GET", "/readyz", timeout=5)[0] == 200:
                status, _ = service.request("POST", "/collections/probe/items", sequence([box_feature("p", 1)]), 5)
                if status == 201:
                    return time.monotonic() - start
        except (OSError, http.client.HTTPException):
            pass
        time.sleep(0.05)
    return 60.0


def run(options, folder):
    choice = random.Random(options.seed)
    kinds = ["service", "postmaster", "one", "all", "stop", "smart", "both"]
    slowest = 0.0
    with Service(options.program, folder) as service:
        writers = [Writer(service, n, options.writers, options.seed) for n in range(options.writers)]
        for writer in writers:
            writer.start()
        for number in range(options.rounds):
            if number % len(kinds) == 0:
                choice.shuffle(kinds)
            kind = kinds[number % len(kinds)]
            for writer in writers:
                writer.may_write.set()
            time.sleep(choice.uniform(0.2, 1.0))
            ready = seconds_until_ready(service, harm(service, kind, choice))
            slowest = max(slowest, ready)
            for writer in writers:
                writer.may_write.clear()
            for writer in writers:
                with writer.is_writing:
                    pass
            complaints = check(service, writers)
            if ready > READY_SECONDS:
                complaints.append(f"ready after {ready:.1f} s (at most {READY_SECONDS})")
            acknowledged = sum(writer.acknowledged for writer in writers)
            print(f"round {number + 1:3} {kind:10} ready after {ready:5.2f} s, {acknowledged} writes acknowledged, "
                  f"{sum(writer.in_doubt for writer in writers)} in doubt", flush=True)
            if complaints:
                for complaint in complaints[:20]:
                    print(f"kills: round {number + 1} ({kind}): {complaint}", file=sys.stderr)
                return 1
        for writer in writers:
            writer.is_over.set()
        stop = service.stop()
    print(f"{options.rounds} rounds, {acknowledged} acknowledged writes, none lost or doubled; "
          f"slowest ready after {slowest:.2f} s; stopped in {stop:.1f} s")
    return 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--writers", type=int, default=4)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    with temporary_folder("kills") as folder:
        return run(options, folder)


if __name__ == "__main__":
    sys.exit(main())
