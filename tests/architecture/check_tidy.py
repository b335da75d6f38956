#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs clang-tidy (the list in .clang-tidy) over the product's translation units.

    check_tidy.py SOURCE_ROOT BUILD_ROOT [FILE...]

Left out, because each would cost clang-tidy most of a minute for headers that are not ours:
  - units that include CGAL, directly or through a header of ours (their headers' inline code is
    seen from other units; the compiler's -Werror list covers the rest);
  - units that include Boost (Beast and Asio coroutines, which clang 14 cannot parse with this
    standard library).
Up to BATCH units of a folder are read as one, because headers take most of the time. A batch that
passed is not run again until a unit, a header of ours, the list, or the compiler's options change
(stamps in BUILD_ROOT/tidy).
"""
import concurrent.futures
import hashlib
import json
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^">]+)[">]', re.M)
FOLDERS = ("base", "workers", "geometry", "tessellate", "surfaces", "delaunay", "validate", "fill", "spline", "repair", "codec",
           "columns", "archives", "formats", "packing", "store", "cql2", "pipeline", "geopackage", "files", "report", "server", "cli", "sql")
BATCH = 12  # as CMAKE_UNITY_BUILD_BATCH_SIZE
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


def options_of(entry, path):
    """The compiler's options of a unit, without the names of its input and output."""
    words, options, skip = shlex.split(entry["command"]), [], False
    for word in words[1:]:
        if skip:
            skip = False
        elif word in ("-o", "-c", "-MF", "-MT"):
            skip = word != "-c"
        elif word != "-MD" and not word.endswith(("/c++", "/g++", "/cc")) and word != str(path):
            options.append(word)
    return tuple(options)


def sources_of(path, build):
    """The sources that a compiler reads for one entry of the database: several for a file of a unity build."""
    if build in path.parents and path.parent.name == "Unity":
        return [pathlib.Path(name) for name in INCLUDE.findall(path.read_text())]
    return [path]


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
    cache, heavy, seen, units = {}, [], set(), {}
    for entry in commands:
        given = pathlib.Path(entry["directory"], entry["file"]).resolve()
        options = options_of(entry, given)
        for path in sources_of(given, build):
            if root not in path.parents or path.suffix != ".cpp":
                continue
            name = str(path.relative_to(root))
            if name in seen or name.split("/")[0] not in FOLDERS or (only and name not in only):
                continue
            seen.add(name)
            ours, foreign = closure(root, name, cache)
            if any(header.startswith(TOO_HEAVY) for header in foreign):
                heavy.append(name)
                continue
            together = "" if given == path else str(given)  # what is compiled as one is read as one
            units.setdefault((name.split("/")[0], options, together), []).append((name, ours))
    missing = [str(path.relative_to(root)) for folder in FOLDERS for path in sorted((root / folder).rglob("*.cpp"))]
    missing = [name for name in missing if name not in seen and not only]
    if missing:
        print(f"not in {build / 'compile_commands.json'}, so not checked: {' '.join(missing)}")
        return 1

    batches, unchanged = [], 0
    for (folder, options, _), files in units.items():
        for start in range(0, len(files), BATCH):
            names = [name for name, _ in files[start:start + BATCH]]
            digest = hashlib.sha256(settings + "\0".join(options).encode())
            for part in sorted(set().union(*(ours for _, ours in files[start:start + BATCH]))):
                digest.update(part.encode() + b"\0" + (root / part).read_bytes())
            batch = stamps / (folder + "-" + hashlib.sha256(" ".join(names).encode()).hexdigest()[:16] + ".cpp")
            stamp = batch.with_suffix(".ok")
            if stamp.is_file() and stamp.read_text() == digest.hexdigest():
                unchanged += len(names)
                continue
            batch.write_text("".join(f'#include "{root / name}"\n' for name in names))
            batches.append((batch, names, options, stamp, digest.hexdigest()))

    def run(job):
        batch, names, options, stamp, digest = job
        done = subprocess.run(
            [program, "--quiet", f"--config-file={root / '.clang-tidy'}", str(batch), "--", *options,
             "-Wno-unknown-warning-option", "-Wno-error"],
            capture_output=True, text=True, check=False)
        if done.returncode == 0:
            stamp.write_text(digest)
        return names, done

    failures = 0
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        for names, done in pool.map(run, batches):
            if done.returncode != 0:
                failures += 1
                print(f"{' '.join(names)}:\n{done.stdout}\n{done.stderr[-2000:]}", flush=True)
    count = sum(len(names) for _, names, _, _, _ in batches)
    print(f"clang-tidy: {count} units run in {len(batches)} batches, {failures} batches with findings, {unchanged} "
          f"units unchanged since they passed, {len(heavy)} left out (CGAL or Boost)")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
