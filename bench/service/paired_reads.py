#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares how fast two programs read features: paired_reads.py BEFORE NOW CITY [--rounds N].

Each program runs a service of its own with a private database, into which CITY (CityJSON or CityJSONSeq)
is stored with invalid=keep. In each round both services start anew, so that no answer is cached, read the first feature, so
that their dictionaries are loaded, and are then asked for each other feature once, in turn. Prints the median of the times of answers, and the processor time of services and databases
for each answer, of both programs and as a ratio.
"""
import argparse
import http.client
import json
import os
import pathlib
import statistics
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tests" / "siege"))
from service import Service, temporary_folder  # noqa: E402

TICKS = os.sysconf("SC_CLK_TCK")


def processor_seconds(process):
    """Of a process and all its children, those that ended too."""
    fields = pathlib.Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    seconds = sum(map(int, fields[11:15])) / TICKS
    for task in pathlib.Path(f"/proc/{process}/task").iterdir():
        for child in (task / "children").read_text().split():
            seconds += processor_seconds(child)
    return seconds


def store(service, city):
    kind = "application/city+json-seq" if city.suffix == ".jsonl" else "application/city+json"
    status, body = service.request("POST", "/collections/city/items?invalid=keep", city.read_bytes(),
                                   headers={"Content-Type": kind})
    if status != 201:
        raise SystemExit(f"paired_reads: storing gave {status}: {body[:300]!r}")
    ids = []
    path = "/collections/city/items?limit=1000&f=summary"
    while path:
        page = json.loads(service.request("GET", path)[1])
        ids += [feature["id"] for feature in page["features"]]
        path = next((link["href"] for link in page["links"] if link["rel"] == "next"), None)
    return ids


def read(connection, name):
    start = time.perf_counter()
    connection.request("GET", f"/collections/city/items/{name}?f=cityjsonseq")
    answer = connection.getresponse()
    body = answer.read()
    if answer.status != 200:
        raise SystemExit(f"paired_reads: {name} gave {answer.status}")
    return time.perf_counter() - start, body


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("before")
    parser.add_argument("now")
    parser.add_argument("city", type=pathlib.Path)
    parser.add_argument("--rounds", type=int, default=6)
    options = parser.parse_args()
    with temporary_folder("before") as folder, temporary_folder("now") as other:
        with Service(options.before, folder) as before, Service(options.now, other) as now:
            services = [before, now]
            ids = [store(service, options.city) for service in services][0]
            times, seconds = ([], []), [0.0, 0.0]
            for round_number in range(options.rounds):
                for service in services:
                    service.stop()
                    service.start()
                connections = [http.client.HTTPConnection("127.0.0.1", service.port, timeout=60) for service in services]
                for connection in connections:
                    read(connection, ids[0])
                starts = [processor_seconds(service.process.pid) for service in services]
                for i, name in enumerate(ids[1:]):
                    order = (0, 1) if (i + round_number) % 2 == 0 else (1, 0)
                    bodies = [None, None]
                    for which in order:
                        took, bodies[which] = read(connections[which], name)
                        times[which].append(took)
                    if bodies[0] != bodies[1]:
                        raise SystemExit(f"paired_reads: the answers for {name} differ")
                for which, service in enumerate(services):
                    seconds[which] += processor_seconds(service.process.pid) - starts[which]
            reads = options.rounds * (len(ids) - 1)
            medians = [1e3 * statistics.median(of) for of in times]
            each = [1e3 * of / reads for of in seconds]
            print(f"{options.city.name}: {len(ids)} features, {reads} reads of each program")
            print(f"median      {medians[0]:.2f} ms before, {medians[1]:.2f} ms now: {medians[1] / medians[0]:.2f}")
            print(f"processor   {each[0]:.2f} ms before, {each[1]:.2f} ms now: {each[1] / each[0]:.2f}")
            for service in services:
                service.stop()
    return 0


if __name__ == "__main__":
    sys.exit(main())
