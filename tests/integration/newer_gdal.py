#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads a collection with the GDAL of Debian 13, in a root folder of its own, and compares it with the document.

    newer_gdal.py WATERTIGHT DOCUMENT.city.jsonl DEBIAN_MIRROR

It reads JSON-FG with its polyhedra, OGC API Features in the storage CRS, and GeoPackages. Needs root and mmdebstrap.
Exit code 1 after a difference, 77 without them.
"""
import csv
import json
import os
import re
import shutil
import sys

from map_programs import DOCUMENT, PROGRAM, Expected
from checks import check, failures, run
from service import Service, temporary_folder

csv.field_size_limit(1 << 30)


def rings_of(text):
    """The rings of all facets of a WKT polyhedral surface or multipolygon, in order."""
    return [[[float(number) for number in point.split()] for point in ring.split(",")]
            for ring in re.findall(r"\(([^()]+)\)", text)]


def expected_rings(expected, feature):
    return [[[round(value, 6) for value in point] for point in [*ring, ring[0]]]
            for rings in expected.facets(feature) for ring in rings]


class Root:
    """Debian 13 with GDAL in a folder, which sees /tmp/exchange of the machine's `folder`."""

    def __init__(self, folder):
        self.path = folder / "root"
        run("mmdebstrap", "--quiet", "--variant=apt", "--include=gdal-bin", "--aptopt=APT::Install-Recommends false",
            "trixie", str(self.path), sys.argv[3])

    def give(self, name, data):
        (self.path / "tmp" / name).write_bytes(data)
        return f"/tmp/{name}"

    def run(self, *words):
        return run("chroot", str(self.path), *words)

    def table(self, source, *words):
        """The features of a source: their geometries as WKT."""
        out = self.run("ogr2ogr", "-f", "CSV", "/vsistdout/", "-lco", "GEOMETRY=AS_WKT", source, *words)
        rows = list(csv.reader(out.splitlines(True)))
        # A geometry column that has a name keeps it.
        place, identifier = next(i for i, name in enumerate(rows[0]) if name in ("WKT", "geom")), rows[0].index("id")
        return {row[identifier]: row[place] for row in rows[1:]}


def compare(found, expected, name, start, without=frozenset()):
    check(set(found) | without == set(expected.features), f"{name}: all {len(found)} features")
    wrong = sum(rings_of(found[key]) != expected_rings(expected, feature)
                for key, feature in expected.features.items() if key in found)
    check(wrong == 0, f"{name}: the facets are those of the document ({wrong} differ)")
    check(all(text.startswith(start) for text in found.values()), f"{name}: {start}")


def main():
    if os.getuid() != 0 or shutil.which("mmdebstrap") is None:
        print("needs root and mmdebstrap")
        sys.exit(77)
    expected = Expected()
    with temporary_folder("newer-gdal") as folder, Service(PROGRAM, folder) as service:
        root = Root(folder)
        print(root.run("ogr2ogr", "--version").strip())
        status, body = service.request("POST", "/collections/town/items?invalid=keep", DOCUMENT.read_bytes(), 300)
        if status != 201:
            raise SystemExit(f"storing gave {status}: {body[:500]!r}")
        for query in ("f=jsonfg", "f=geojson&profile=jsonfg"):
            text = service.request("GET", f"/collections/town/items?{query}&limit=1000")[1]
            places = {feature["id"]: feature["place"]["type"] for feature in json.loads(text)["features"]}
            found = root.table(root.give("town.json", text))
            # GDAL 3.10 knows Polyhedron, but no MultiPolyhedron.
            several = {name for name, kind in places.items() if kind == "MultiPolyhedron"}
            check(0 < len(several) < 9 and all(found[name] == "" for name in several), f"{query}: {len(several)} of several solids")
            compare({name: text for name, text in found.items() if name not in several}, expected, query,
                    "POLYHEDRALSURFACE Z", several)
        summary = root.run("ogrinfo", "-so", "-al", "/tmp/town.json")
        check("using driver `JSONFG'" in summary and "Amersfoort / RD New + NAP height" in summary, "JSON-FG has the storage CRS")
        compare(root.table(f"OAPIF:http://127.0.0.1:{service.port}", "town"), expected, "OGC API Features", "MULTIPOLYGON Z")
        package = root.give("town.gpkg", service.request("GET", "/collections/town/export?f=gpkg", None, 300)[1])
        compare(root.table(package, "town"), expected, "GeoPackage", "MULTIPOLYGON Z")
        layers = root.run("ogrinfo", package)
        check("town_findings (3D Point)" in layers, "GeoPackage: the findings are a layer of points")
        service.stop()
    print(f"{len(failures)} differences")
    sys.exit(1 if failures else 0)


main()
