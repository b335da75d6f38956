#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shows 3D Tiles in Chromium by two renderers of others: CesiumJS, and 3DTilesRendererJS on three.js.

    renderers.py WATERTIGHT DOCUMENT.city.jsonl NODE_FOLDER [PICTURE_FOLDER]

Both load the tileset of the command line and that of the service, from which they take what a page of another
origin gets. They find each feature of the document once and the same triangles, and the picture has a city in
it. NODE_FOLDER is where npm puts the packages of renderers/package.json. Exit code 1 after a difference, 77
where there is no Chromium.
"""
import functools
import http.server
import json
import os
import pathlib
import shutil
import sys
import threading

PROGRAM, DOCUMENT = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
NODE = pathlib.Path(sys.argv[3]).resolve()
PICTURES = pathlib.Path(sys.argv[4] if len(sys.argv) > 4 else NODE / "pictures").resolve()
PAGES = pathlib.Path(__file__).resolve().parent / "renderers"
sys.path.insert(0, str(PAGES.parents[1] / "siege"))
from checks import check, failures, run  # noqa: E402
from service import Service, temporary_folder  # noqa: E402

SMALLEST_SHARE = 0.04  # of the picture that shows facets; both cameras see the whole of Delft's tile


class Files(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


def serve(folder):
    """Serves the files of a folder; the address."""
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Files, directory=str(folder)))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return f"http://127.0.0.1:{server.server_port}"


def view(pages, renderer, tileset, picture):
    """The result of a page, which was also checked for itself."""
    out = run("node", str(PAGES / "view.js"), f"{pages}/{renderer}.html?tileset={tileset}", str(picture), cwd=NODE)
    result = json.loads(out)
    name = f"{result.get('renderer', renderer)}, {picture.stem}"
    check(result["failures"] == [], f"{name}: loads ({result['failures']} {result['messages']})")
    if not result["failures"]:
        check(result["share"] > SMALLEST_SHARE, f"{name}: {100 * result['share']:.0f} % of the picture are facets")
    return result


def main():
    if not shutil.which("chromium"):
        print("there is no Chromium")
        return 77
    features = len(DOCUMENT.read_text().splitlines()) - 1
    NODE.mkdir(parents=True, exist_ok=True)
    PICTURES.mkdir(parents=True, exist_ok=True)
    for file in PAGES.iterdir():
        shutil.copy(file, NODE)
    run("npm", "install", "--no-package-lock", "--no-audit", "--no-fund", "--ignore-scripts", cwd=NODE)
    shutil.rmtree(NODE / "tiles", ignore_errors=True)  # of an earlier run
    run(PROGRAM, "tiles", str(DOCUMENT), "-o", str(NODE / "tiles"))
    pages = serve(NODE)
    with temporary_folder("renderers") as folder, Service(PROGRAM, folder, ["--cors", pages]) as service:
        status, body = service.request("POST", "/collections/town/items?invalid=keep", DOCUMENT.read_bytes())
        check(status == 201, f"the service takes the document ({body[:200]!r})")
        tilesets = {"files": "/tiles/tileset.json",
                    "service": f"http://127.0.0.1:{service.port}/collections/town/3dtiles"}
        seen = {}
        for source, address in tilesets.items():
            for renderer in ("three", "cesium"):
                result = view(pages, renderer, address, PICTURES / f"{renderer}-{source}.png")
                seen[source, renderer] = (result.get("features"), result.get("twice"), result.get("triangles"))
                if renderer == "cesium":
                    check(bool(result.get("picked")), f"Cesium picks the feature {result.get('picked')}")
        service.stop()
    check(all(found[:2] == (features, 0) for found in seen.values()), f"each of {features} features is there once: {seen}")
    check(len(set(seen.values())) == 1, "both renderers show the same triangles")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
