#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Encodes city models with --invalid keep, decodes them, and compares the bytes.

    any_city.py WATERTIGHT FILE...

Prints a row for each file: features, solids, proven and unproven ones, the codes of those that are
not proven, bytes of the file and of its Watertight file, and whether the very bytes came back. Exit
code 1 if a file that can be read did not come back; a file that cannot be read has the reason.
"""
import collections
import json
import pathlib
import subprocess
import sys
import tempfile


def run(*command):
    return subprocess.run([str(part) for part in command], capture_output=True)


def codes_of(info):
    codes = collections.Counter()
    for solid in info["unproven"]["solids"]:
        codes.update(solid["errors"] or ["undecided"])
    return " ".join(f"{code}:{count}" for code, count in sorted(codes.items(), key=str)) or "-"


def row(program, path, folder):
    packed = folder / "packed.wt"
    encoded = run(program, "encode", path, "-o", packed, "--invalid", "keep")
    if encoded.returncode == 2 or not packed.exists():
        reason = encoded.stderr.decode(errors="replace").strip().splitlines()
        return f"| {path.name} | {reason[-1] if reason else 'no reason'} |", True
    info = json.loads(run(program, "info", packed, "--json").stdout)
    back = run(program, "decode", packed, "-o", "-").stdout
    is_same = back == path.read_bytes()
    unproven = info["unproven"]["count"]
    cells = [path.name, info["features"], info["solids"], info["solids"] - unproven, unproven,
             codes_of(info), info["unproven"]["features"], path.stat().st_size,
             packed.stat().st_size, "same" if is_same else "DIFFERENT"]
    packed.unlink()
    return "| " + " | ".join(map(str, cells)) + " |", is_same


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    print("| file | features | solids | proven | unproven | codes | marked features | bytes | .wt | back |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    is_well = True
    with tempfile.TemporaryDirectory() as name:
        for path in map(pathlib.Path, sys.argv[2:]):
            text, is_same = row(program, path, pathlib.Path(name))
            print(text, flush=True)
            is_well = is_well and is_same
    return 0 if is_well else 1


if __name__ == "__main__":
    sys.exit(main())
