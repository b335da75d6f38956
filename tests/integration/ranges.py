#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Watertight files in parts: over HTTP, with few requests; added to, by one writer at a time, also when writers are
killed.

    ranges.py WATERTIGHT [--kills N]"""
import argparse
import fcntl
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path += [str(ROOT / "bench" / "city"), str(pathlib.Path(__file__).resolve().parent)]
import made_city  # noqa: E402
from range_server import RangeServer  # noqa: E402

FEATURES = 2000


class Test:
    def __init__(self, program, folder):
        self.program, self.folder = os.path.abspath(program), pathlib.Path(folder)
        self.failures = 0

    def run(self, *arguments, status=0):
        done = subprocess.run([self.program, *map(str, arguments)], capture_output=True, check=False, cwd=self.folder)
        if done.returncode != status:
            self.failures += 1
            print(f"{' '.join(map(str, arguments))}: status {done.returncode}, not {status}: "
                  f"{done.stderr.decode()[-400:]}")
        return done

    def check(self, condition, words):
        if not condition:
            self.failures += 1
            print("failed:", words)

    def ids(self, name):
        """The ids of the features that a file has."""
        text = self.run("decode", name, "-o", "-").stdout.decode()
        return [json.loads(line)["id"] for line in text.splitlines()[1:]]


def write_lines(path, lines):
    path.write_text("\n".join(lines) + "\n")


def over_http(test, lines):
    names = [json.loads(line)["id"] for line in lines[1:]]
    with RangeServer(test.folder) as server:
        url = server.url + "city.wt"
        for i in (0, 999, 1999):
            server.reset()
            found = test.run("get", url, names[i] + "-0").stdout.decode().splitlines()
            test.check(found == [lines[0], lines[i + 1]], f"feature {i} comes with the header")
            test.check(server.requests <= 4 and server.bytes <= 65536,
                       f"{server.requests} requests, {server.bytes} bytes for a feature")
        server.reset()
        box = "84100,445100,84150,445150"
        remote = test.run("get", url, "--bbox", box).stdout
        test.check(server.requests <= 6, f"{server.requests} requests for a box")
        test.check(remote == test.run("get", "city.wt", "--bbox", box).stdout, "URL and file give the same")
        test.check(len(remote.splitlines()) > 10, "the box has features")
        missing = test.run("get", url, "nobody", names[5], status=1)
        test.check(b"'nobody'" in missing.stderr and names[5].encode() in missing.stdout, "what is missing is named")
        test.check(b"404" in test.run("get", server.url + "none.wt", "a", status=2).stderr, "404 is reported")
        server.reset()
        test.run("get", server.url + "moved/city.wt", names[7])
        test.check(server.requests <= 5, "only the first request is redirected")
        test.check(test.run("decode", url, "-o", "-").stdout.decode() == "\n".join(lines) + "\n", "decode by URL")
        test.check(json.loads(test.run("info", "--json", url).stdout)["features"] == FEATURES, "info by URL")
        test.run("validate", server.url + "small.city.jsonl")
        test.run("get", server.url + "small.city.jsonl", "a", status=2)

        def change(number):
            if number == 2:
                server.tags["city.wt"] = '"another"'
        server.reset()
        server.on_request = change
        changed = test.run("get", url, names[3], status=2)
        test.check(b"changed" in changed.stderr, "a file that changes meanwhile is an error")
    with RangeServer(test.folder, "whole") as server:
        test.run("get", server.url + "city.wt", names[11])
        test.check(server.requests == 1, "a server without ranges gives a small file whole")
        with open(test.folder / "large.wt", "wb") as large:
            large.truncate(17 << 20)
        refused = test.run("get", server.url + "large.wt", "a", status=2)
        test.check(b"no byte ranges" in refused.stderr, "a large one is refused")
    with RangeServer(test.folder, "other") as server:
        test.run("get", server.url + "city.wt", names[12], status=2)
    refused = test.run("get", "http://127.0.0.1:9/city.wt", "a", status=2)
    test.check(b"unavailable" in refused.stderr, "no server")


def added(test, lines):
    """Adding and deleting by the command line, and a torn end."""
    write_lines(test.folder / "old.city.jsonl", lines[:1001])
    write_lines(test.folder / "new.city.jsonl", [lines[0], *lines[1000:1011]])
    test.run("encode", "old.city.jsonl", "-o", "grown.wt")
    before = (test.folder / "grown.wt").read_bytes()
    done = test.run("append", "grown.wt", "new.city.jsonl")
    test.check(b"11 features added, of which 1 replaced" in done.stderr, "counts of an append")
    test.check((test.folder / "grown.wt").read_bytes()[:len(before)] == before, "old bytes stay")
    names = [json.loads(line)["id"] for line in lines[1:1011]]
    test.check(sorted(test.ids("grown.wt")) == sorted(names), "all features are there")
    test.run("delete", "grown.wt", names[0], "nobody", status=1)
    test.run("get", "grown.wt", names[0], status=1)
    test.check(sorted(test.ids("grown.wt")) == sorted(names[1:]), "one is deleted")
    whole = (test.folder / "grown.wt").read_bytes()
    (test.folder / "grown.wt").write_bytes(whole + before[9:500])
    torn = test.run("decode", "grown.wt", "-o", "back.city.jsonl", status=1)
    test.check(b"torn" in torn.stderr, "a torn end is reported")
    test.check(b"tornBytes" in test.run("info", "grown.wt").stdout, "info says so")
    test.run("validate", "grown.wt", status=2)
    test.run("get", "grown.wt", names[3])
    test.run("append", "grown.wt", "new.city.jsonl")
    test.check(sorted(test.ids("grown.wt")) == sorted(names[1:]), "the next writer cuts it off")
    with open(test.folder / "grown.wt", "rb") as locked:
        fcntl.flock(locked, fcntl.LOCK_EX)
        test.run("delete", "grown.wt", names[5], status=2)


def killed(test, lines, kills):
    """Kills a writer at any time; what a finished writer has added stays."""
    chance = random.Random(3)
    write_lines(test.folder / "start.city.jsonl", lines[:101])
    test.run("encode", "start.city.jsonl", "--for", "ranges", "-o", "killed.wt")
    sure = {json.loads(line)["id"] for line in lines[1:101]}
    write_lines(test.folder / "round.city.jsonl", [lines[0], *lines[101:131]])
    begin = time.monotonic()
    shutil.copy(test.folder / "killed.wt", test.folder / "probe.wt")
    test.run("append", "probe.wt", "round.city.jsonl")
    duration = time.monotonic() - begin
    torn = finished = 0
    for number in range(kills):
        part = lines[101 + 30 * (number % 60):131 + 30 * (number % 60)]
        names = {json.loads(line)["id"] for line in part}
        write_lines(test.folder / "round.city.jsonl", [lines[0], *part])
        size = (test.folder / "killed.wt").stat().st_size
        writer = subprocess.Popen([test.program, "append", "killed.wt", "round.city.jsonl"], cwd=test.folder,
                                  stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        if number % 2:
            time.sleep(chance.random() * 1.3 * duration)
        else:  # while it writes
            deadline = time.monotonic() + 30
            while (test.folder / "killed.wt").stat().st_size == size and time.monotonic() < deadline:
                pass
        writer.send_signal(signal.SIGKILL)
        is_done = writer.wait() == 0
        finished += is_done
        info = json.loads(test.run("info", "--json", "killed.wt").stdout)
        torn += "tornBytes" in info
        decoded = subprocess.run([test.program, "decode", "killed.wt", "-o", "-"], capture_output=True,
                                 cwd=test.folder, check=False).stdout.decode()
        found = {json.loads(line)["id"] for line in decoded.splitlines()[1:]}
        test.check(sure <= found, f"round {number}: something is lost")
        test.check(found <= sure | names, f"round {number}: something is there that was not added")
        test.check(found == sure | names or not is_done, f"round {number}: what was acknowledged is lost")
        test.check(found in (sure, sure | names), f"round {number}: a part of an append is there")
        sure = found
    print(f"{kills} writers killed: {finished} had finished, {torn} left a torn end")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("--kills", type=int, default=3)
    arguments = parser.parse_args()
    lines = list(made_city.city(FEATURES))
    with tempfile.TemporaryDirectory() as folder:
        test = Test(arguments.program, folder)
        write_lines(test.folder / "city.city.jsonl", lines)
        write_lines(test.folder / "small.city.jsonl", lines[:5])
        test.run("encode", "city.city.jsonl", "--for", "ranges", "-o", "city.wt")
        over_http(test, lines)
        added(test, lines)
        killed(test, lines, arguments.kills)
    print(f"ranges: {test.failures} failures")
    return 1 if test.failures else 0


if __name__ == "__main__":
    sys.exit(main())
