#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the commands of the guides, as a reader would.

    guides.py WATERTIGHT ROOT GUIDE...

Takes the lines of the blocks that begin with ```sh. Each must end with status 0, or with the status
that its comment states (`# status 1`). They run in a copy of the folders that they name.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile


def commands(guide):
    for block in re.findall(r"^```sh\n(.*?)^```", guide.read_text(), re.MULTILINE | re.DOTALL):
        for line in block.splitlines():
            stated = re.search(r"# status (\d)", line)
            yield line.split(" #")[0].strip(), int(stated.group(1)) if stated else 0


def main():
    program, root = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    failures = []
    count = 0
    for guide in map(pathlib.Path, sys.argv[3:]):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            shutil.copytree(root / "examples", folder / "examples")
            shutil.copytree(root / "tests/golden/findings", folder / "tests/golden/findings")
            path = f"{program.parent}{os.pathsep}{os.environ['PATH']}"
            for command, status in commands(guide):
                count += 1
                done = subprocess.run(command, shell=True, cwd=folder, env={**os.environ, "PATH": path},
                                      capture_output=True, text=True)
                if done.returncode != status:
                    failures.append(f"{guide.name}: {command}: status {done.returncode}, not {status}\n"
                                    f"{done.stderr[-500:]}")
    if count == 0:
        failures.append("the guides have no commands")
    print("\n".join(failures) or f"{count} commands do what the guides say")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
