#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Uses the pages of the service in Chromium as a person would.

    web.py WATERTIGHT REPOSITORY NODE_FOLDER [PICTURE_FOLDER]

First the files in web/dist are what Vite makes of web/src, byte for byte. Then web/use.js goes through the
pages: an invalid file is judged, its findings are flown to, the report is downloaded, the file is stored, and
the collection and a feature are seen. NODE_FOLDER is where npm puts the packages. Exit code 1 after a
difference, 77 where there is no Chromium.
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys

PROGRAM, ROOT = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
NODE = pathlib.Path(sys.argv[3]).resolve()
PICTURES = pathlib.Path(sys.argv[4] if len(sys.argv) > 4 else NODE / "pictures").resolve()
PAGES = ROOT / "tests/integration/web"
sys.path.insert(0, str(ROOT / "tests/siege"))
from checks import check, failures, run  # noqa: E402
from service import Service, temporary_folder  # noqa: E402


def check_built_files():
    """Makes web/dist anew from the versions in package-lock.json, and compares."""
    again = NODE / "again"
    shutil.rmtree(again, ignore_errors=True)
    shutil.copytree(ROOT / "web", again, ignore=shutil.ignore_patterns("node_modules", "dist"))
    run("npm", "ci", "--ignore-scripts", "--no-audit", "--no-fund", cwd=again)
    run("npm", "run", "build", cwd=again)
    names = {file.name for folder in (ROOT / "web/dist", again / "dist") for file in folder.iterdir()}
    for name in sorted(names):
        kept, made = ROOT / "web/dist" / name, again / "dist" / name
        check(kept.is_file() and made.is_file() and kept.read_bytes() == made.read_bytes(),
              f"web/dist/{name} is what Vite makes of web/src (else: cd web && npm run build)")
    packed = sum(len(subprocess.run(["gzip", "-9", "-c", str(file)], capture_output=True, check=True).stdout)
                 for file in (ROOT / "web/dist").iterdir())
    check(packed <= 1_000_000, f"all files together have {packed} bytes by gzip, at most 1,000,000")


def volume(solid):
    """The volume that the tetrahedra of a solid fill."""
    total = 0
    for tetrahedron in solid["tetrahedra"]:
        o, *others = (solid["vertices"][index] for index in tetrahedron)
        a, b, c = ([p - q for p, q in zip(corner, o)] for corner in others)
        total += abs(a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
                     + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6
    return total


def check_insides(service):
    """The tetrahedra of each solid fill the volume that its facets bound. (A facet that is not exactly planar can
    be filled with other triangles than those by which volumes are measured.)"""
    ask = lambda address: json.loads(service.request("GET", address)[1])  # noqa: E731
    solids, worst = 0, 0.0
    for feature in ask("/collections/delft/items?f=summary&limit=1000")["features"]:
        address = f"/collections/delft/items/{feature['id']}?f="
        measured = [solid["measures"]["volume"] for solid in ask(address + "proof")["solids"] if solid["proven"]]
        filled = [volume(solid) for solid in ask(address + "structure")["solids"]]
        worst = max([worst] + [abs(a - b) / a for a, b in zip(measured, filled, strict=True)])
        solids += len(filled)
    check(solids == 470 and worst < 1e-3, f"tetrahedra fill {solids} solids, to {worst:.1e} of their volume")


def main():
    if not shutil.which("chromium"):
        print("there is no Chromium")
        return 77
    NODE.mkdir(parents=True, exist_ok=True)
    PICTURES.mkdir(parents=True, exist_ok=True)
    check_built_files()
    shutil.copy(PAGES / "package.json", NODE)
    shutil.copy(PAGES / "use.js", NODE)
    run("npm", "install", "--no-package-lock", "--no-audit", "--no-fund", "--ignore-scripts", cwd=NODE)
    with temporary_folder("web") as folder, Service(PROGRAM, folder) as service:
        status, _ = service.request("POST", "/collections/delft/items?invalid=keep",
                                    (ROOT / "examples/delft.city.jsonl").read_bytes())
        check(status == 201, "the service takes the features of Delft")
        check_insides(service)
        done = subprocess.run(["node", "use.js", f"http://127.0.0.1:{service.port}/",
                               str(ROOT / "examples"), str(PICTURES)],
                              cwd=NODE, capture_output=True, text=True, timeout=400, check=False)
        print(done.stderr)
        check(done.returncode == 0, "the visit ends")
        for seen in json.loads(done.stdout or "[]"):
            check(seen["isRight"], seen["name"])
        service.stop()
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
