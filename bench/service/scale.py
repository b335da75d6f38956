#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures the same requests to collections of 1, 120,000 and 1,000,000 features in turn.

    scale.py PROGRAM [--features N ...] [--rounds R] [--largest-ratio X]

The features are boxes, each of its own size at a place of its own. The service and its private database run in a temporary folder.
Prints the median time of each kind of request for each collection, and its ratio to that of the
smallest one. A POST stores a feature of a new id. Exit code 1 if a ratio is above X (1.5).
"""
import argparse
import http.client
import itertools
import json
import pathlib
import statistics
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tests" / "siege"))
from service import Service, box_feature, sequence, temporary_folder  # noqa: E402

NUMBERS = itertools.count(10_000_000)
BATCH = 2000


class Client:
    """A kept connection; the seconds until the first byte of an answer's body."""

    def __init__(self, port):
        self.connection = http.client.HTTPConnection("127.0.0.1", port, timeout=120)

    def ask(self, method, path, body=None, reads_all=True):
        start = time.perf_counter()
        self.connection.request(method, path, body, {"Content-Type": "application/city+json-seq"})
        answer = self.connection.getresponse()
        answer.read(1)
        elapsed = time.perf_counter() - start
        if reads_all:
            answer.read()
        else:
            self.connection.close()
        if answer.status not in (200, 201):
            raise SystemExit(f"scale: {method} {path}: status {answer.status}")
        return elapsed


def fill(service, name, size):
    for first in range(0, size, BATCH):
        service.post(name, sequence(box_feature(f"b{n}", n) for n in range(first, min(size, first + BATCH))))
    if service.psql("VACUUM ANALYZE").wait() != 0:
        raise SystemExit("scale: VACUUM failed")
    counted = json.loads(service.request("GET", f"/collections/{name}")[1])["features"]
    print(f"{name}: {counted} features", flush=True)


def new_box():
    number = next(NUMBERS)
    return sequence([box_feature(f"b{number}", number)])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--features", type=int, nargs="+", default=[1, 120_000, 1_000_000])
    parser.add_argument("--rounds", type=int, default=60)
    parser.add_argument("--largest-ratio", type=float, default=1.5)
    options = parser.parse_args()
    worst = 0.0
    with temporary_folder("scale") as folder, Service(options.program, folder) as service:
        names = [f"scale-{size}" for size in options.features]
        for name, size in zip(names, options.features):
            fill(service, name, size)
        first = json.loads(service.request("GET", f"/collections/{names[0]}/items?f=summary")[1])["features"][0]
        crs = json.loads(service.request("GET", f"/collections/{names[0]}")[1])["storageCrs"]
        box = ",".join(str(first["bbox"][i]) for i in (0, 1, 3, 4))
        client = Client(service.port)
        kinds = {
            "items?limit=1": lambda path: client.ask("GET", f"{path}/items?limit=1"),
            "bbox page": lambda path: client.ask("GET", f"{path}/items?limit=1&bbox={box}&bbox-crs={crs}"),
            "collection": lambda path: client.ask("GET", path),
            "export, first byte": lambda path: client.ask("GET", f"{path}/export?f=cityjsonseq", None, False),
            "export as .wt, first byte": lambda path: client.ask("GET", f"{path}/export?f=wt", None, False),
            "POST of one box": lambda path: client.ask("POST", f"{path}/items", new_box())}
        for kind, request in kinds.items():
            times = {name: [] for name in names}
            for _ in range(options.rounds):
                for name in names:
                    times[name].append(request(f"/collections/{name}"))
            medians = [statistics.median(times[name]) for name in names]
            ratios = [median / medians[0] for median in medians]
            worst = max(worst, ratios[-1])
            print(f"| {kind} | " + " | ".join(
                f"{1e3 * median:.2f} ms ({ratio:.2f})" for median, ratio in zip(medians, ratios)) + " |", flush=True)
        service.stop()
    return 1 if worst > options.largest_ratio else 0


if __name__ == "__main__":
    sys.exit(main())
