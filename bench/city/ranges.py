#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Counts the requests and bytes for parts of a Watertight file on a static server.

    ranges.py WATERTIGHT [--features N] [--reads N] [--file city.wt] [--limits]

Makes a city of N features (bench/city/made_city.py), encodes it `--for ranges`, and reads single features by id and
boxes of 1 % of the area through a server that counts. Every answer is compared with the city. Prints a table for
bench/results/ranges.md. With --limits the exit status is 1 if a feature takes more than 4 requests or 64 KiB, or a
box more than 6 requests or twice the bytes of the blocks that have features in it."""
import argparse
import json
import os
import pathlib
import random
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path += [str(HERE), str(HERE.parent.parent / "tests" / "integration")]
import made_city  # noqa: E402
from range_server import RangeServer  # noqa: E402


def run(program, *arguments, statuses=(0,)):
    done = subprocess.run([program, *map(str, arguments)], capture_output=True, check=False)
    if done.returncode not in statuses:
        sys.exit(f"{' '.join(map(str, arguments))}: status {done.returncode}: {done.stderr.decode()[-500:]}")
    return done


def features_of(text):
    return {json.loads(line)["id"]: line for line in text.splitlines()[1:]}


def box_of(line):
    vertices = json.loads(line)["vertices"]
    low = [min(vertex[axis] for vertex in vertices) / 1000 for axis in (0, 1)]
    high = [max(vertex[axis] for vertex in vertices) / 1000 for axis in (0, 1)]
    return 84000 + low[0], 445000 + low[1], 84000 + high[0], 445000 + high[1]


def meets(a, b):
    return a[0] <= b[2] and b[0] <= a[2] and a[1] <= b[3] and b[1] <= a[3]


class Bench:
    def __init__(self, program, path, server, lines):
        self.program, self.server = program, server
        self.url = server.url + path.name
        self.lines = {json.loads(line)["id"]: line for line in lines[1:]}
        self.boxes = {name: box_of(line) for name, line in self.lines.items()}
        info = json.loads(run(program, "info", "--json", "--blocks", path).stdout)
        self.blocks = info["blockList"]
        self.bytes = info["bytes"]

    def get(self, *arguments):
        self.server.reset()
        done = run(self.program, "get", self.url, *arguments)
        return features_of(done.stdout.decode()), self.server.requests, self.server.bytes

    def by_id(self, name):
        found, requests, count = self.get(name)
        feature = name.removesuffix("-0")
        if found != {feature: self.lines[feature]}:
            sys.exit(f"get {name}: another feature came")
        return requests, count

    def by_box(self, box):
        found, requests, count = self.get("--bbox=" + ",".join(map(str, box)))
        wanted = {name for name, other in self.boxes.items() if meets(box, other)}
        if set(found) != wanted:
            sys.exit(f"--bbox {box}: {len(found)} features came, {len(wanted)} are there")
        own = 0
        for block in self.blocks:
            if any(meets(block["box"], self.boxes[name]) for name in wanted):
                own += block["bytes"]
        return requests, count, own


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("--features", type=int, default=100_000)
    parser.add_argument("--reads", type=int, default=50)
    parser.add_argument("--file", type=pathlib.Path)
    parser.add_argument("--limits", action="store_true")
    arguments = parser.parse_args()
    program = os.path.abspath(arguments.program)
    with tempfile.TemporaryDirectory() as folder:
        lines = list(made_city.city(arguments.features))
        city = pathlib.Path(folder) / "city.city.jsonl"
        city.write_text("\n".join(lines) + "\n")
        path = arguments.file or pathlib.Path(folder) / "city.wt"
        if not path.exists():
            run(program, "encode", city, "-o", path, "--for", "ranges")
        with RangeServer(path.parent) as server:
            bench = Bench(program, path, server, lines)
            chance = random.Random(2)
            ids = chance.sample(sorted(bench.lines), arguments.reads)
            single = [bench.by_id(name if i % 2 else name + "-0") for i, name in enumerate(ids)]
            x0, y0, x1, y1 = made_city.extent(arguments.features)
            boxes = []
            for i in range(arguments.reads):
                # The first box is around the middle, where the curve of places is farthest apart.
                x = x0 + (0.45 if i == 0 else chance.random() * 0.9) * (x1 - x0)
                y = y0 + (0.45 if i == 0 else chance.random() * 0.9) * (y1 - y0)
                boxes.append(bench.by_box((x, y, x + (x1 - x0) / 10, y + (y1 - y0) / 10)))
    print(f"{arguments.features} features, {city_bytes(lines)} bytes of CityJSONSeq, {bench.bytes} bytes as a file "
          f"of {len(bench.blocks)} blocks\n")
    print("| read | requests, most | mean | bytes, most | mean | to own blocks, most |\n|---|---|---|---|---|---|")
    row("one feature by id", single, None)
    ratios = [count / own for _, count, own in boxes]
    row("box of 1 %", boxes, f"{max(ratios):.2f}")
    good = (max(read[0] for read in single) <= 4 and max(read[1] for read in single) <= 64 * 1024 and
            max(read[0] for read in boxes) <= 6 and max(ratios) <= 2)
    return 0 if good or not arguments.limits else 1


def city_bytes(lines):
    return sum(len(line) + 1 for line in lines)


def row(name, reads, ratio):
    requests = [read[0] for read in reads]
    sizes = [read[1] for read in reads]
    print(f"| {name} | {max(requests)} | {sum(requests) / len(requests):.1f} | {max(sizes)} | "
          f"{sum(sizes) // len(sizes)} | {ratio or ''} |")


if __name__ == "__main__":
    sys.exit(main())
