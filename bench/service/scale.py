#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures requests to collections of 1, 120,000 and 1,000,000 features in turn.

    bench/service/scale.py URL SOCKET_FOLDER SEQUENCE [FEATURES ...]

URL is a running service with a private database, whose socket is in SOCKET_FOLDER (DATA/socket).
SEQUENCE is a CityJSONSeq whose features are stored and then copied in the database, each copy with
its box moved along x. Prints the median time of each kind of request, and its ratio to that of the
smallest collection.
"""
import json
import statistics
import subprocess
import sys
import time
import urllib.request

ROUNDS = 40

COPY = """
INSERT INTO watertight.feature (collection, id, type, format, srid, header, skeleton, solids, blob_bytes,
  min_x, min_y, min_z, max_x, max_y, max_z, place)
SELECT collection, id || '-' || n, type, format, srid, header, skeleton, solids, blob_bytes,
  min_x + 20 * n, min_y, min_z, max_x + 20 * n, max_y, max_z, place / 2 + n
FROM watertight.feature, generate_series(1, {copies}) n WHERE collection = '{name}';
INSERT INTO watertight.solid
SELECT s.collection, s.feature || '-' || n, object_id, geometry, ordinal, position, lod, blob, measures, report
FROM watertight.solid s, generate_series(1, {copies}) n WHERE collection = '{name}';
ANALYZE watertight.feature;
"""


def psql(folder, statements):
    subprocess.run(["psql", "-q", "-v", "ON_ERROR_STOP=1", "-h", folder, "-d", "postgres"],
                   input=statements, text=True, check=True)


def ask(request):
    started = time.perf_counter()
    with urllib.request.urlopen(request) as answer:
        first = answer.read(1)
        elapsed = time.perf_counter() - started
        return elapsed, first + answer.read()


def post(url, name, body):
    return ask(urllib.request.Request(f"{url}/collections/{name}/items", data=body, method="POST", headers={
        "Content-Type": "application/city+json-seq"}))


def main(arguments):
    if len(arguments) < 3:
        print(__doc__, file=sys.stderr)
        return 2
    url, folder, path = arguments[:3]
    sizes = [int(number) for number in arguments[3:]] or [1, 120_000, 1_000_000]
    with open(path, "rb") as file:
        header, *features = [line for line in file.read().split(b"\n") if line]
    one = header + b"\n" + features[0] + b"\n"
    names = {}
    for size in sizes:
        names[size] = f"scale-{size}"
        post(url, names[size], one)
        if size > 1:
            psql(folder, COPY.format(name=names[size], copies=size - 1))
        print(f"{names[size]}: {json.loads(ask(url + '/collections/' + names[size])[1])['features']} features",
              flush=True)
    items = json.loads(ask(f"{url}/collections/{names[sizes[0]]}/items")[1])
    box = items["features"][0]["bbox"]
    crs = json.loads(ask(f"{url}/collections/{names[sizes[0]]}")[1])["storageCrs"]
    few = ",".join(str(number) for number in [box[0], box[1], box[3], box[4]])
    kinds = {
        "items?limit=1": lambda name: ask(f"{url}/collections/{name}/items?limit=1"),
        "bbox page": lambda name: ask(f"{url}/collections/{name}/items?limit=1&bbox={few}&bbox-crs={crs}"),
        "collection": lambda name: ask(f"{url}/collections/{name}"),
        "POST one feature": lambda name: post(url, name, one),
    }
    for kind, request in kinds.items():
        times = {size: [] for size in sizes}
        for _ in range(ROUNDS):
            for size in sizes:
                times[size].append(request(names[size])[0])
        medians = [statistics.median(times[size]) for size in sizes]
        print(f"| {kind} | " + " | ".join(f"{1e3 * median:.2f} ms ({median / medians[0]:.2f})" for median in medians)
              + " |", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
