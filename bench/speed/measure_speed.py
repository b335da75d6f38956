#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Times `watertight validate` as a whole process on the inputs of make_inputs.py.

measure_speed.py WATERTIGHT FOLDER [RUNS]

Prints a table: median wall and processor seconds of RUNS runs (3), processor seconds with those of
the engines' processes, and the largest resident memory of any process.
"""
import os
import resource
import statistics
import subprocess
import sys
import time

CASES = [
    ("100k faces, one thread, no CDT", ["-j", "1", "--proof", "boundary"], "sphere-100000.obj"),
    ("1M faces, one thread, no CDT", ["-j", "1", "--proof", "boundary"], "sphere-1000000.obj"),
    ("100k faces, two threads, no CDT", ["-j", "2", "--proof", "boundary"], "sphere-100000.obj"),
    ("plate with 10,000 holes, no CDT", ["-j", "1", "--proof", "boundary"], "plate.city.json"),
    ("plate with 10,000 holes, with CDT", ["-j", "1"], "plate.city.json"),
    ("1,000 cavities, with CDT", ["-j", "1"], "cavities.city.json"),
    ("towns, all rules and CDT, one thread", ["-j", "1"], "towns.city.json"),
    ("towns, all rules and CDT, two threads", ["-j", "2"], "towns.city.json"),
    ("long sequence, two threads", ["-j", "2"], "long.city.jsonl"),
]


def measure(command):
    """Elapsed seconds, user + system seconds of all processes, peak resident KiB, last lines of the
    printed table."""
    start = time.monotonic()
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    process = subprocess.run(["/usr/bin/time", "-f", "%M"] + command, capture_output=True, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    wall = time.monotonic() - start
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    counts = {}
    for line in process.stdout.splitlines():
        words = line.split()
        if len(words) >= 2 and words[-1].isdigit():
            counts[words[0]] = int(words[-1])
    return wall, cpu, int(process.stderr.split()[-1]), counts


def main():
    program, folder = sys.argv[1], sys.argv[2]
    runs = int(sys.argv[3]) if len(sys.argv) > 3 else 3
    print("| case | solids | valid | wall s | CPU s | MiB |\n| --- | --- | --- | --- | --- | --- |")
    for name, options, file in CASES:
        path = os.path.join(folder, file)
        if not os.path.exists(path):
            continue
        repeats = 1 if file == "long.city.jsonl" else runs
        results = [measure([program, "validate", "-q", *options, path]) for _ in range(repeats)]
        wall, cpu, memory = (statistics.median(r[i] for r in results) for i in range(3))
        counts = results[0][3]
        print(f"| {name} | {counts.get('solids')} | {counts.get('valid')} | {wall:.2f} | {cpu:.2f} | "
              f"{memory / 1024:.0f} |", flush=True)


if __name__ == "__main__":
    main()
