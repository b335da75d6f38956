#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs clang-tidy (the list in .clang-tidy) over the product's translation units.

    check_tidy.py SOURCE_ROOT BUILD_ROOT [FILE...]

Left out, because each would cost clang-tidy most of a minute for headers that are not ours:
  - units that include CGAL, directly or through a header of ours (their headers' inline code is
    seen from other units; the compiler's -Werror list covers the rest);
  - units that include Boost (Beast and Asio coroutines, which clang 14 cannot parse with this
    standard library).
A unit that passed is not run again until it, a header of ours that it includes, the list, or its
compile command changes (stamps in BUILD_ROOT/tidy).
"""
import concurrent.futures
import hashlib
import json
import pathlib
import re
import shutil
import subprocess
import sys

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^">]+)[">]', re.M)
FOLDERS = ("base", "workers", "geometry", "tessellate", "delaunay", "validate", "codec",
           "columns", "archives", "formats", "packing", "store", "cql2", "pipeline", "geopackage", "files", "report", "server", "cli", "sql")
TOO_HEAVY = ("CGAL/", "boost/", "tetgen.h")


def closure(root, name, cache):
    """The file, every header of the repository that it includes, and the foreign headers that these
    files name."""
    ours, foreign, stack = set(), set(), [name]
    while stack:
        current = stack.pop()
        if current in ours:
            continue
        ours.add(current)
        if current not in cache:
            cache[current] = INCLUDE.findall((root / current).read_text(errors="replace"))
        for path in cache[current]:
            if (root / path).is_file():
                stack.append(path)
            else:
                foreign.add(path)
    return sorted(ours), foreign


def main(arguments):
    root, build = pathlib.Path(arguments[0]).resolve(), pathlib.Path(arguments[1]).resolve()
    only = set(arguments[2:])
    commands = json.loads((build / "compile_commands.json").read_text())
    program = shutil.which("clang-tidy-14") or shutil.which("clang-tidy")
    if not program:
        print("clang-tidy is not installed: scripts/install-dependencies test")
        return 2
    stamps = build / "tidy"
    stamps.mkdir(exist_ok=True)
    settings = (root / ".clang-tidy").read_bytes()
    cache, jobs, heavy, unchanged, seen = {}, [], [], 0, set()
    for entry in commands:
        path = pathlib.Path(entry["directory"], entry["file"]).resolve()
        if root not in path.parents:
            continue
        name = str(path.relative_to(root))
        if name in seen or name.split("/")[0] not in FOLDERS or (only and name not in only):
            continue
        if not name.endswith(".cpp"):
            continue
        seen.add(name)
        ours, foreign = closure(root, name, cache)
        if any(header.startswith(TOO_HEAVY) for header in foreign):
            heavy.append(name)
            continue
        digest = hashlib.sha256(settings + entry["command"].encode())
        for part in ours:
            digest.update(part.encode() + b"\0" + (root / part).read_bytes())
        stamp = stamps / (hashlib.sha256(name.encode()).hexdigest()[:16] + ".ok")
        if stamp.is_file() and stamp.read_text() == digest.hexdigest():
            unchanged += 1
            continue
        jobs.append((name, stamp, digest.hexdigest()))

    def run(job):
        name, stamp, digest = job
        done = subprocess.run(
            [program, "--quiet", f"-p={build}", "--extra-arg=-Wno-unknown-warning-option",
             "--extra-arg=-Wno-error", str(root / name)],
            capture_output=True, text=True, check=False)
        if done.returncode == 0:
            stamp.write_text(digest)
        return name, done

    failures = 0
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        for name, done in pool.map(run, jobs):
            if done.returncode != 0:
                failures += 1
                print(f"{name}:\n{done.stdout}\n{done.stderr[-2000:]}", flush=True)
    print(f"clang-tidy: {len(jobs)} units run, {failures} with findings, {unchanged} unchanged since they "
          f"passed, {len(heavy)} left out (CGAL or Boost)")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
