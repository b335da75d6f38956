#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks the OpenAPI document: openapi.py WATERTIGHT DOCUMENT.city.jsonl NODE_FOLDER [SEED [RUNS]]

Redocly and Spectral, with the rules that they recommend, find nothing in what the service answers at /api. Then
fast-check makes RUNS requests for each operation (openapi/contract.js), and each answer is one of those that the
document describes. NODE_FOLDER is where npm puts the packages of openapi/package.json. Exit code 1 after a
difference.
"""
import os
import pathlib
import shutil
import subprocess
import sys

PROGRAM, DOCUMENT = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
NODE = pathlib.Path(sys.argv[3]).resolve()
SEED, RUNS = (sys.argv[4:] + ["1", "60"][len(sys.argv[4:]):])[:2]
PAGES = pathlib.Path(__file__).resolve().parent / "openapi"
sys.path.insert(0, str(PAGES.parents[1] / "siege"))
from checks import check, failures, run  # noqa: E402
from service import Service, temporary_folder  # noqa: E402


def lint(*words):
    done = subprocess.run(["npx", "--no-install", *words], cwd=NODE, capture_output=True, text=True, timeout=120,
                          check=False, env={**os.environ, "REDOCLY_TELEMETRY": "off"})
    out = done.stdout + done.stderr
    check(done.returncode == 0 and "You have" not in out, f"{words[0]} finds nothing")
    if failures:
        print(out[-3000:])


def main():
    NODE.mkdir(parents=True, exist_ok=True)
    for file in PAGES.iterdir():
        shutil.copy(file, NODE)
    run("npm", "install", "--no-package-lock", "--no-audit", "--no-fund", "--ignore-scripts", cwd=NODE)
    with temporary_folder("openapi") as folder, Service(PROGRAM, folder) as service:
        (NODE / "openapi.json").write_bytes(service.request("GET", "/api")[1])
        lint("redocly", "lint", "--format", "stylish", "openapi.json")
        lint("spectral", "lint", "--ruleset", "spectral.yaml", "--fail-severity", "warn", "openapi.json")
        contract = subprocess.run(["node", str(NODE / "contract.js"), f"http://127.0.0.1:{service.port}",
                                   "openapi.json", str(DOCUMENT), SEED, RUNS], cwd=NODE, timeout=600, check=False)
        check(contract.returncode == 0, "each answer is described")
        service.stop()
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
