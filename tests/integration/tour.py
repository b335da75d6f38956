#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs docs/curl.md against a service: tour.py WATERTIGHT ROOT

Every command ends with status 0, and together they use every route of the OpenAPI document. Exit code 1 after a
difference.
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

PROGRAM, ROOT = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
sys.path.insert(0, str(ROOT / "tests/siege"))
from checks import check, failures  # noqa: E402
from guides import commands  # noqa: E402
from service import Service, temporary_folder  # noqa: E402


def used_routes(command):
    """Methods and paths of the requests of a command."""
    for call in re.split(r"\bcurl\b", command)[1:]:
        stated = re.search(r"-X (\w+)", call)
        method = stated.group(1) if stated else "POST" if re.search(r" (--data-binary|-d) ", call) else "GET"
        for path in re.findall(r"\$URL(/[^\s\"?|)]*)", call):
            yield method, path


def route_of(method, path, paths):
    """The route of the OpenAPI document that a request uses."""
    segments = path.rstrip("/").split("/")
    for pattern in paths:
        parts = pattern.rstrip("/").split("/")
        fits = len(parts) == len(segments) and all(
            part == segment or part.startswith("{") for part, segment in zip(parts, segments))
        if fits and method.lower() in paths[pattern]:
            return method, pattern
    return None


def main():
    with temporary_folder("tour") as folder, Service(PROGRAM, folder) as service:
        work = folder / "work"
        shutil.copytree(ROOT / "examples", work / "examples")
        environment = {**os.environ, "URL": f"http://127.0.0.1:{service.port}"}
        paths = json.loads(service.request("GET", "/api")[1])["paths"]
        missing = {(method.upper(), path) for path, methods in paths.items()
                   for method in methods if method in ("get", "post", "put", "patch", "delete")}
        for command, status in commands(ROOT / "docs/curl.md"):
            done = subprocess.run(["bash", "-o", "pipefail", "-c", command], cwd=work, env=environment, capture_output=True, text=True,
                                  timeout=120, check=False)
            check(done.returncode == status, f"{command[:100]} ({done.returncode}) {done.stderr[-300:]}")
            missing -= {route_of(*used, paths) for used in used_routes(command)}
        # The address of a tile stands in the tileset.
        missing -= {("GET", "/collections/{collectionId}/3dtiles/content")}
        check(not missing, f"every route has a command; missing: {sorted(missing)}")
        service.stop()
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
