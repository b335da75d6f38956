#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Appends to a Watertight file and deletes from it, and kills the program at random.

    append.py WATERTIGHT ROOT [ROUNDS]

Each round starts `append` or `delete`, kills it (SIGKILL) at a random moment, twice in three rounds, and then
reads the file. A command that had ended with status 0 is done; one that was killed is done as a whole or not at
all; the bytes that counted before have not changed; a part that does not count is left out with a warning.
Prints a line for each tenth round and the sums; exit code 1 after a difference.
"""
import json
import os
import pathlib
import random
import subprocess
import sys
import time

PROGRAM, ROOT = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
ROUNDS = int(sys.argv[3]) if len(sys.argv) > 3 else 3
FEATURES = 120
sys.path.insert(0, str(ROOT / "tests/siege"))
from service import box_feature, sequence, temporary_folder  # noqa: E402


class Town:
    """The file, and the line of each feature that it has."""

    def __init__(self, folder):
        self.folder, self.path = folder, folder / "town.wt"
        self.lines = {f"b{n}": box_feature(f"b{n}", n) for n in range(FEATURES)}
        document = self.document(self.lines)
        self.run("encode", str(document), "-o", str(self.path), "--for", "ranges")
        self.committed = self.path.read_bytes()
        self.seconds = 0.2  # that a command takes
        self.torn = 0

    def document(self, lines):
        path = self.folder / "some.city.jsonl"
        path.write_bytes(sequence(lines.values()))
        return path

    def run(self, *words, codes=(0,)):
        done = subprocess.run([PROGRAM, *words], capture_output=True, text=True, check=False)
        if done.returncode not in codes:
            raise SystemExit(f"{words}: exit code {done.returncode}: {done.stderr[-1000:]}")
        return done

    def change(self):
        """A command, and the lines after it."""
        after = dict(self.lines)
        numbers = random.sample(range(2 * FEATURES), random.choice([1, 10, 60]))
        if random.random() < 0.3:
            gone = [name for name in (f"b{n}" for n in numbers) if name in after][:20]
            if gone:
                for name in gone:
                    del after[name]
                return ["delete", str(self.path), *gone], after
        new = {f"b{n}": box_feature(f"b{n}", random.randrange(100_000)) for n in numbers}
        after.update(new)
        return ["append", str(self.path), str(self.document(new))], after

    def read(self):
        """The lines of the file as the program reads them."""
        output = self.folder / "all.city.jsonl"
        output.unlink(missing_ok=True)
        done = self.run("decode", str(self.path), "-o", str(output), codes=(0, 1))
        counts = json.loads(self.run("info", str(self.path), "--json", codes=(0, 1)).stdout)
        torn = counts.get("tornBytes", 0)
        if (done.returncode == 1) != (torn > 0) or (torn > 0 and "torn" not in done.stderr):
            raise SystemExit(f"exit code {done.returncode} with {torn} bytes after the last commit: {done.stderr}")
        self.torn += torn > 0
        lines = output.read_text().splitlines()[1:]
        found = {json.loads(line)["id"]: line for line in lines}
        if len(found) != len(lines):
            raise SystemExit("a feature is there twice")
        whole = self.path.read_bytes()
        return found, whole[:len(whole) - torn]

    def round(self):
        words, after = self.change()
        kill_at = random.uniform(0, 1.2 * self.seconds) if random.random() < 2 / 3 else None
        start = time.monotonic()
        process = subprocess.Popen([PROGRAM, *words], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        try:
            _, error = process.communicate(timeout=kill_at)
            if process.returncode != 0:
                raise SystemExit(f"{words}: exit code {process.returncode}: {error[-1000:]}")
            self.seconds = time.monotonic() - start
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
        is_acknowledged = process.returncode == 0
        found, committed = self.read()
        if found not in ([after] if is_acknowledged else [self.lines, after]):
            raise SystemExit(f"{words[0]}, acknowledged: {is_acknowledged}: {len(found)} features, of which"
                             f" {len(found.items() ^ after.items())} differ from those that should be there,"
                             f" {len(found.items() ^ self.lines.items())} from those that were")
        if not committed.startswith(self.committed):
            raise SystemExit(f"{words[0]} changed bytes that counted before")
        is_done = committed != self.committed
        self.lines, self.committed = found, committed
        return is_acknowledged, is_done


with temporary_folder("append") as folder:
    town = Town(folder)
    acknowledged = killed = done = 0
    for number in range(1, ROUNDS + 1):
        is_acknowledged, is_done = town.round()
        acknowledged += is_acknowledged
        killed += not is_acknowledged
        done += is_done and not is_acknowledged
        if number % 10 == 0:
            print(f"round {number}: {len(town.lines)} features in {len(town.committed)} bytes", flush=True)
    print(f"{ROUNDS} rounds: {acknowledged} commands acknowledged, {killed} killed, of which {done} were done and"
          f" {town.torn} left a torn end; nothing lost")
