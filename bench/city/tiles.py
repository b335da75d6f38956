#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures how many buildings a second become tiles: tiles.py PROGRAM [--buildings N] [--stored M] DOCUMENT...

Each DOCUMENT (CityJSON or CityJSONSeq) is copied until it has N buildings (20,000), each copy beside the one before;
`watertight tiles` reads the sequence from a file. Then a made city of M buildings (made_city.py) is stored, and the
service is asked for its tileset, once for all buildings and once for the findings, and for every tile.
"""
import argparse
import http.client
import json
import math
import pathlib
import resource
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "service"), str(HERE.parents[1] / "tests" / "siege")]
from ingest import Template, sequence  # noqa: E402
from made_city import city  # noqa: E402
from service import Service, temporary_folder  # noqa: E402


def write_copies(path, header, templates, buildings):
    """Writes copies of features, in a square of copies of the document, until there are so many."""
    side = math.isqrt(buildings // len(templates)) + 1
    wide, deep = [max(template.high[axis] for template in templates) -
                  min(template.low[axis] for template in templates) + 10_000 for axis in range(2)]
    with path.open("w") as file:
        file.write(header + "\n")
        for number in range(buildings):
            template = templates[number % len(templates)]
            copy = number // len(templates)
            file.write(template.copy(copy, copy % side * wide, copy // side * deep))


def measure_program(program, document, buildings):
    header, *lines = sequence(program, document)
    with temporary_folder("tiles") as folder:
        write_copies(folder / "city.city.jsonl", header, [Template(line) for line in lines], buildings)
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        start = time.monotonic()
        ended = subprocess.run([program, "tiles", str(folder / "city.city.jsonl"), "-o", str(folder / "tiles")],
                               capture_output=True, text=True)
        seconds = time.monotonic() - start
        if ended.returncode not in (0, 1):
            raise SystemExit(f"tiles: {document.name}: {ended.stderr[-2000:]}")
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        size = sum(path.stat().st_size for path in (folder / "tiles").rglob("*.glb"))
    used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    print(f"{document.name:36} {buildings:>9} buildings {seconds:7.2f} s {used:7.2f} CPU s {buildings / seconds:8.0f} a second "
          f"{size / buildings:7.0f} bytes each  {ended.stdout.strip()}", flush=True)


def addresses_of(tile):
    if "content" in tile:
        yield tile["content"]["uri"]
    for child in tile.get("children", []):
        yield from addresses_of(child)


def measure_layer(connection, layer):
    def ask(path):
        connection.request("GET", path)
        answer = connection.getresponse()
        body = answer.read()
        if answer.status != 200:
            raise SystemExit(f"tiles: {path}: {answer.status} {body[:300]}")
        return body

    start = time.monotonic()
    text = ask(f"/collections/city/3dtiles?layer={layer}")
    tree = time.monotonic() - start
    addresses = list(addresses_of(json.loads(text)["root"]))
    times, size = [], 0
    for address in addresses:
        start = time.monotonic()
        size += len(ask(f"/collections/city/{address}"))
        times.append(time.monotonic() - start)
    times.sort()
    print(f"  {layer}: tileset {tree:.2f} s, {len(text) / 1e6:.1f} MB; {len(addresses)} tiles in {sum(times):.1f} s, {size / 1e6:.0f} MB", end="")
    if times:
        print(f"; a tile {1e3 * times[len(times) // 2]:.0f} ms, p99 {1e3 * times[len(times) * 99 // 100]:.0f} ms", end="")
    print(flush=True)


def memory_of(process):
    status = pathlib.Path(f"/proc/{process.pid}/status").read_text()
    return int(next(line for line in status.splitlines() if line.startswith("VmHWM")).split()[1]) // 1024


def measure_service(program, buildings):
    with temporary_folder("tiles") as folder, Service(program, folder) as service:
        file = folder / "city.city.jsonl"
        with file.open("w") as made:
            made.writelines(line + "\n" for line in city(buildings))
        start = time.monotonic()
        service.run("ingest", "--collection", "city", "--invalid", "keep", "--quiet", str(file), code=0)
        print(f"made city: {buildings} buildings, stored in {time.monotonic() - start:.0f} s")
        connection = http.client.HTTPConnection("127.0.0.1", service.port, timeout=600)
        for layer in ("features", "findings"):
            measure_layer(connection, layer)
        print(f"  the service had {memory_of(service.process)} MB at most")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--buildings", type=int, default=20_000)
    parser.add_argument("--stored", type=int, default=0)
    parser.add_argument("documents", nargs="*", type=pathlib.Path)
    options = parser.parse_intermixed_args()
    program = str(pathlib.Path(options.program).resolve())
    for document in options.documents:
        measure_program(program, document, options.buildings)
    if options.stored:
        measure_service(program, options.stored)


if __name__ == "__main__":
    main()
