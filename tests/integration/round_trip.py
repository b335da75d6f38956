#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The round trip against a running service and database; see round_trip.sh.

1. Posts each feature of a tile; each is stored (201/200) or refused with a report (422).
2. Reads every stored feature back by REST and every solid by SQL (wt_decode), and compares both with
   the source exactly (city_models.py).
3. Invalid features are refused and leave nothing behind.
4. Posts the tile into a second collection from four connections, kills the database in the middle,
   starts it again, and compares every feature that was acknowledged; then posts the rest.
"""
import argparse
import concurrent.futures
import json
import shlex
import subprocess
import sys
import threading
import time
import urllib.error
import urllib.parse
import urllib.request

import city_models

SEQUENCE = "application/city+json-seq"


class Service:
    def __init__(self, address):
        self.address = address

    def request(self, method, path, body=None, content_type=None, accept=None, timeout=60):
        """Returns (status, text); the status is 0 when no answer came."""
        request = urllib.request.Request(self.address + path, data=body, method=method)
        if content_type:
            request.add_header("Content-Type", content_type)
        if accept:
            request.add_header("Accept", accept)
        try:
            with urllib.request.urlopen(request, timeout=timeout) as answer:
                return answer.status, answer.read().decode()
        except urllib.error.HTTPError as error:
            return error.code, error.read().decode(errors="replace")
        except (OSError, ValueError) as error:
            return 0, str(error)

    def post(self, collection, header, feature):
        return self.request("POST", f"/collections/{collection}/items",
                            (header + "\n" + feature + "\n").encode(), SEQUENCE)

    def get(self, collection, name):
        return self.request("GET", f"/collections/{collection}/items/"
                            f"{urllib.parse.quote(name, safe='')}?f=cityjsonseq")

    def wait_until_ready(self, seconds):
        deadline = time.monotonic() + seconds
        while time.monotonic() < deadline:
            status, text = self.request("GET", "/readyz", timeout=5)
            if status == 200:
                return
            time.sleep(0.3)
        fail(f"the service was not ready within {seconds} s: {status} {text[:500]}")


def fail(message):
    print(f"round trip: FAILED: {message}")
    sys.exit(1)


def say(message):
    print(f"round trip: {message}", flush=True)


def read_tile(path):
    with open(path, encoding="utf-8") as file:
        lines = [line for line in file.read().split("\n") if line.strip()]
    return lines[0], {json.loads(line)["id"]: line for line in lines[1:]}


def post_all(service, collection, header, features):
    stored, refused = [], []
    for name, line in features.items():
        status, text = service.post(collection, header, line)
        if status in (200, 201):
            stored.append(name)
        elif status == 422:
            report = json.loads(text)
            if not isinstance(report, dict) or "type" not in report:
                fail(f"the refusal of {name} is no problem document: {text[:300]}")
            refused.append(name)
        else:
            fail(f"POST of {name} answered {status}: {text[:500]}")
    return stored, refused


def compare_by_rest(service, collection, header, features, names):
    source_header = city_models.parse(header)
    for name in names:
        status, text = service.get(collection, name)
        if status != 200:
            fail(f"GET of {collection}/{name} answered {status}: {text[:300]}")
        answer = [city_models.parse(line) for line in text.split("\n") if line.strip()]
        answer_header = answer[0] if len(answer) == 2 else source_header
        found = city_models.difference(
            city_models.resolved_objects(city_models.parse(features[name]), source_header),
            city_models.resolved_objects(answer[-1], answer_header))
        if found:
            fail(f"{collection}/{name} came back by REST with a difference at {found}")


def query(database, sql):
    done = subprocess.run(["psql", "-X", "-A", "-t", "-F", "\t", "-v", "ON_ERROR_STOP=1", "-d", database,
                           "-c", sql], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        fail(f"psql: {done.stderr[:1000]}")
    return [line.split("\t") for line in done.stdout.split("\n") if line]


def compare_by_sql(database, collection, header, features, names):
    """Compares every solid of every named feature, as wt_decode gives it. Returns the number of
    solids."""
    rows = query(database,
                 "SELECT feature, object_id, geometry, ordinal, "
                 " encode(wt_decode(coalesce(blob, wt_blob(page, slot))), 'hex')"
                 f" FROM watertight.solid WHERE collection = '{collection}'")
    decoded = {}
    for feature, name, geometry, ordinal, ewkb in rows:
        decoded.setdefault(feature, {})[(name, int(geometry), int(ordinal))] = \
            city_models.canonical(city_models.read_ewkb(bytes.fromhex(ewkb))[0])
    if set(decoded) != set(names):
        fail(f"SQL has features {sorted(set(decoded) ^ set(names))[:5]} too many or too few")
    source_header = city_models.parse(header)
    count = 0
    for name in names:
        expected = city_models.solids_of(city_models.parse(features[name]), source_header)
        if expected != decoded[name]:
            fail(f"{collection}/{name} came back by SQL with other solids")
        count += len(expected)
    return count


def killed_ingest(service, header, features, names, kill, start):
    """Posts with four connections; kills the database after a third of the features and starts it
    again when the first request has failed. Returns the features that were acknowledged."""
    collection, acknowledged, failed = "killed", [], []
    # the commands for the database that are still to be done, the last one first
    steps = [start, kill]
    lock = threading.Lock()

    def post(name):
        status, text = service.post(collection, header, features[name])
        with lock:
            if status in (200, 201):
                acknowledged.append(name)
                due = steps.pop() if len(steps) == 2 and len(acknowledged) >= len(names) // 3 else None
            elif status in (0, 503):
                failed.append(name)
                due = steps.pop() if len(steps) == 1 else None
            else:
                fail(f"POST of {name} to a killed database answered {status}: {text[:300]}")
        if due:
            subprocess.run(shlex.split(due), check=True, stdout=subprocess.DEVNULL)

    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        list(pool.map(post, names))
    if steps:
        fail("no request failed although the database was killed: the test shows nothing")
    say(f"database killed and started: {len(acknowledged)} features acknowledged, {len(failed)} refused")
    service.wait_until_ready(60)
    compare_by_rest(service, collection, header, features, acknowledged)
    for name in failed:
        status, text = service.post(collection, header, features[name])
        if status not in (200, 201):
            fail(f"POST of {name} after the restart answered {status}: {text[:300]}")
    return len(acknowledged)


def main():
    parser = argparse.ArgumentParser()
    for option in ("service", "database", "kill", "start", "tile", "invalid"):
        parser.add_argument(f"--{option}", required=True)
    options = parser.parse_args()
    service = Service(options.service)
    service.wait_until_ready(120)

    header, features = read_tile(options.tile)
    stored, refused = post_all(service, "delft", header, features)
    say(f"{len(stored)} features stored, {len(refused)} refused with a report")
    if len(stored) < 0.9 * len(features):
        fail("less than nine in ten features of the tile were stored")
    compare_by_rest(service, "delft", header, features, stored)
    solids = compare_by_sql(options.database, "delft", header, features, stored)
    say(f"{len(stored)} features equal by REST, {solids} solids equal by SQL")

    invalid_header, invalid = read_tile(options.invalid)
    accepted, _ = post_all(service, "delft", invalid_header, invalid)
    if accepted:
        fail(f"invalid features were stored: {accepted}")
    for name in list(invalid) + refused:
        if service.get("delft", name)[0] != 404:
            fail(f"the refused feature {name} left something behind")
    say(f"{len(invalid)} invalid features refused, nothing of them stored")

    acknowledged = killed_ingest(service, header, features, stored, options.kill, options.start)
    compare_by_rest(service, "killed", header, features, stored)
    compare_by_sql(options.database, "killed", header, features, stored)
    say(f"all {acknowledged} acknowledged features survived; the rest went in after the restart")
    say("passed")


if __name__ == "__main__":
    main()
