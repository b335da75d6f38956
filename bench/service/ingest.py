#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures how many solids a second are proven and stored: ingest.py PROGRAM SOLIDS DOCUMENT...

Each DOCUMENT (CityJSON or CityJSONSeq) is copied until it has SOLIDS solids, each copy beside the one before and
with ids of its own; `watertight ingest` reads the sequence from a pipe and stores it in a private database of its
own, durably, with full proof, and keeps what is not valid. Prints for each document solids a second and the most
memory of the ingesting process, and at the end the rate of an equal mix.
"""
import json
import os
import pathlib
import subprocess
import sys
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tests" / "siege"))
from service import temporary_folder, unprivileged  # noqa: E402


def sequence(program, document):
    """The lines of a document as a sequence."""
    if document.name.endswith(".jsonl"):
        return document.read_text().splitlines()
    model = json.loads(document.read_text())
    if "transform" not in model:  # a sequence needs one; millimetres are exact for what is measured here
        model["transform"] = {"scale": [0.001] * 3, "translate": [0, 0, 0]}
        model["vertices"] = [[round(1000 * value) for value in vertex] for vertex in model["vertices"]]
    with temporary_folder("convert") as folder:
        whole, made = folder / "document.city.json", folder / "document.city.jsonl"
        whole.write_text(json.dumps(model))
        subprocess.run([program, "convert", str(whole), "-o", str(made)], check=True, capture_output=True)
        return made.read_text().splitlines()


def solids_of(feature):
    return sum(geometry["type"].endswith("Solid")
               and (1 if geometry["type"] == "Solid" else len(geometry["boundaries"]))
               for thing in feature["CityObjects"].values() for geometry in thing.get("geometry", []))


class Template:
    """A feature as the texts around its ids and vertices, so that a copy costs little."""

    def __init__(self, line):
        feature = json.loads(line)
        self.solids = solids_of(feature)
        self.vertices = feature.pop("vertices")
        self.width = max((v[0] for v in self.vertices), default=0)
        self.low = [min((v[axis] for v in self.vertices), default=0) for axis in range(2)]
        self.high = [max((v[axis] for v in self.vertices), default=0) for axis in range(2)]
        text = json.dumps(feature, separators=(",", ":"))
        for name in sorted(feature["CityObjects"], key=len, reverse=True):
            text = text.replace(json.dumps(name), json.dumps(name)[:-1] + "\0\"")
        self.parts = text[:-1].split("\0")

    def copy(self, number, shift, shift_y=0):
        vertices = ",".join(f"[{x + shift},{y + shift_y},{z}]" for x, y, z in self.vertices)
        return f"-{number}".join(self.parts) + f',"vertices":[{vertices}]}}\n'


def feed(pipe, header, templates, solids):
    """Writes copies until there are so many solids."""
    shift = max(template.width for template in templates) + 10_000
    with pipe:
        pipe.write(header + "\n")
        written = number = 0
        while written < solids:
            for template in templates:
                pipe.write(template.copy(number, number * shift))
                written += template.solids
                if written >= solids:
                    break
            number += 1


def peak_megabytes(process):
    """The most memory that a process has had, until it ends."""
    peak = 0
    while process.poll() is None:
        try:
            status = pathlib.Path(f"/proc/{process.pid}/status").read_text()
        except OSError:
            break
        for line in status.splitlines():
            if line.startswith("VmHWM"):
                peak = max(peak, int(line.split()[1]) // 1024)
        time.sleep(0.2)
    return peak


def measure(program, document, solids):
    header, *lines = sequence(program, document)
    templates = [Template(line) for line in lines]
    prefix, user = unprivileged()
    with temporary_folder("ingest") as folder:
        data = folder / "data"
        data.mkdir()
        if user:
            os.chown(data, user.pw_uid, user.pw_gid)
        start = time.monotonic()
        process = subprocess.Popen([*prefix, program, "ingest", "--data-dir", str(data), "--collection", "city",
                                    "--invalid", "keep", "--json", "-q", "-"], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        writer = threading.Thread(target=feed, args=(process.stdin, header, templates, solids))
        writer.start()
        peak = peak_megabytes(process)
        writer.join()
        seconds = time.monotonic() - start
        out, errors = process.stdout.read(), process.stderr.read()
        if process.returncode not in (0, 1):
            raise SystemExit(f"{document.name}: {errors[-2000:]}")
        table = json.loads(out.strip().splitlines()[-1])
    return table, seconds, peak


def main():
    program, solids = str(pathlib.Path(sys.argv[1]).resolve()), int(sys.argv[2])
    rates = []
    for document in map(pathlib.Path, sys.argv[3:]):
        table, seconds, peak = measure(program, document, solids)
        done = table["solids"]
        rates.append(done / seconds)
        print(f"{document.name:40} {done:>9} solids {seconds:8.1f} s {done / seconds:8.0f} solids/s {peak:5} MB", flush=True)
    print(f"{'equal mix':40} {len(rates) / sum(1 / rate for rate in rates):48.0f} solids/s")


if __name__ == "__main__":
    main()
