#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the blocks of a guide to SQL in their order, as a reader would.

    run_guide.py ROOT GUIDE

Blocks that begin with ```sql go to psql, those with ```sh to bash, in a folder with a copy of
ROOT/examples; psql finds the database by its environment (PGHOST, PGDATABASE, ...). A block succeeds,
unless its first line says `fails`. If the next block begins with ```text, the output is compared with
that. `[...]` in a line of it stands for any text. Prints the number of blocks; exit status 1 and the
outputs after a difference.
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

PSQL = ["psql", "-X", "-q", "-v", "ON_ERROR_STOP=1"]
BASH = ["bash", "-euo", "pipefail"]


def blocks(text):
    """The kind, what its line says besides, the content, and the text that should be printed or None."""
    found = re.findall(r"^```(sql|sh|text)( fails)?\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    for number, (kind, fails, content) in enumerate(found):
        if kind != "text":
            next_kind, _, shown = found[number + 1] if number + 1 < len(found) else ("", "", "")
            yield kind, bool(fails), content, shown if next_kind == "text" else None


def is_output(shown, printed):
    """Whether the lines are those that the guide shows."""
    lines = [[line.rstrip() for line in text.strip("\n").split("\n")] for text in (shown, printed)]
    patterns = [re.escape(line).replace(re.escape("[...]"), ".*") for line in lines[0]]
    return len(patterns) == len(lines[1]) and all(map(re.fullmatch, patterns, lines[1]))


def main():
    root, guide = map(pathlib.Path, sys.argv[1:])
    count = 0
    compared = 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        shutil.copytree(root / "examples", folder / "examples")
        for kind, fails, content, shown in blocks(guide.read_text()):
            done = subprocess.run(PSQL if kind == "sql" else BASH, input=content, cwd=folder, text=True, check=False,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
            is_wrong = (done.returncode != 0) != fails
            if is_wrong or (shown is not None and not is_output(shown, done.stdout)):
                print(f"{guide.name}: status {done.returncode} of\n{content}\nwhich prints\n{done.stdout}")
                return 1
            count += 1
            compared += shown is not None
    if count == 0:
        print(f"{guide.name} has no blocks")
        return 1
    print(f"{count} blocks of {guide.name} do what it says; {compared} outputs are those that it shows")
    return 0


if __name__ == "__main__":
    sys.exit(main())
