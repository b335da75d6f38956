#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""CityGML that the program writes says what the city model says: city_gml.py PROGRAM FILE...

Each FILE (CityJSON, CityJSONSeq or CityGML) becomes a CityJSON, that a CityGML 2.0, and that a CityJSON again; objects,
attributes, addresses, geometry with exact decimals and semantics of both are compared, except where a comment of the CityGML
says what was not written. GDAL reads the CityGML too. The first CityGML is stored in a service, and its items are compared in
the same way.
"""
import json
import pathlib
import re
import sys
import urllib.parse
from decimal import Decimal

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[0] / "siege")]
from checks import check, failures, run  # noqa: E402
from service import Service, temporary_folder  # noqa: E402

PROGRAM = str(pathlib.Path(sys.argv[1]).resolve())
FILES = [pathlib.Path(name).resolve() for name in sys.argv[2:]]


def spread(value, boundaries):
    """A value for each facet."""
    return value if isinstance(boundaries[0][0], int) else [spread(value, part) for part in boundaries]


class Model:
    """The objects of a CityJSON, with places in the stead of vertices and surfaces in that of their numbers."""

    def __init__(self, text):
        model = json.loads(text, parse_float=Decimal)
        transform = model.get("transform", {"scale": [1, 1, 1], "translate": [0, 0, 0]})
        self.vertices = [tuple((Decimal(v) * Decimal(s) + Decimal(t)).normalize()
                               for v, s, t in zip(vertex, transform["scale"], transform["translate"])) for vertex in model["vertices"]]
        self.appearance = model.get("appearance", {})
        self.objects = {name: self.read(value) for name, value in model["CityObjects"].items()}

    def read(self, value):
        return {"type": value["type"], "attributes": value.get("attributes", {}), "parents": value.get("parents"),
                "children": sorted(value.get("children", [])), "address": self.addresses(value.get("address", [])),
                "geometry": sorted(repr(self.geometry(geometry)) for geometry in value.get("geometry", []))}

    def addresses(self, addresses):
        return [{key: self.place(value["boundaries"]) if key == "location" else value for key, value in address.items()} for address in addresses]

    def place(self, boundaries):
        return self.vertices[boundaries] if isinstance(boundaries, int) else [self.place(part) for part in boundaries]

    def geometry(self, geometry):
        semantics = geometry.get("semantics", {"values": None})

        def surface(value):
            if isinstance(value, list):
                return [surface(part) for part in value]
            known = None if value is None else semantics["surfaces"][value]
            return known and {key: known[key] for key in sorted(known) if key not in ("parent", "children")}

        if str(geometry["lod"])[0] == "0" and all(surface["type"] == "GroundSurface" for surface in semantics.get("surfaces", [])):
            semantics = {"values": None}  # a footprint is one without being called so
        return (geometry["type"], str(geometry["lod"])[0], self.place(geometry["boundaries"]), surface(semantics["values"]),
                {kind: {theme or "unnamed": self.look(kind, look.get("values", spread(look.get("value"), geometry["boundaries"])))
                        for theme, look in sorted(geometry.get(kind, {}).items())} for kind in ("material", "texture")})

    def look(self, kind, value, is_first=True):
        """What the numbers of a theme mean: the first one of a ring is that of the texture."""
        if isinstance(value, list):
            return [self.look(kind, part, kind == "material" or i == 0 or isinstance(part, list)) for i, part in enumerate(value)]
        name = "materials" if kind == "material" else "textures" if is_first else "vertices-texture"
        return None if value is None else self.appearance[name][value]


def compare(name, first, second, gml):
    left_out = re.findall(r"<!-- not written: (.*) \(\d+ times?\) -->", gml)
    known = {"type": ("the type of objects",), "parents": ("places in a parent",), "children": ("places in a parent",),
             "address": ("the member ",), "attributes": ("attributes without", "the type of the values"),
             "geometry": ("semantics of facets", "geometries", "the type MultiSolid", "the type of the values")}
    differences = [(key, part) for key, value in first.objects.items() for part in value if value[part] != second.objects.get(key, {}).get(part)]
    unsaid = [(key, part) for key, part in differences if not any(text.startswith(known[part]) for text in left_out)]
    check(first.objects.keys() == second.objects.keys() and not unsaid,
          f"{name}: {len(first.objects)} objects come back from CityGML; {len(differences)} differences that it names, others: {unsaid[:3]}")


def there_and_back(folder, file):
    """The file as CityJSON, as CityGML, and as CityJSON of that."""
    first, gml, second = folder / "first.city.json", folder / "made.gml", folder / "second.city.json"
    for source, target in ((file, first), (first, gml), (gml, second)):
        run(PROGRAM, "convert", str(source), "-o", str(target))
    compare(file.name, Model(first.read_text()), Model(second.read_text()), gml.read_text())
    check("1:" in run("ogrinfo", "-ro", "-q", str(gml)), f"{file.name}: GDAL reads layers of the CityGML")
    for path in (first, gml, second, gml.with_suffix(".gfs")):
        path.unlink(missing_ok=True)


def from_service(folder, file):
    """Items that came as GML are given as GML."""
    with Service(PROGRAM, folder) as service:
        service.run("ingest", "--collection", "town", "--invalid", "keep", "--quiet", str(file), code=0)
        status, body = service.request("GET", "/collections/town/items?f=summary&limit=1000")
        features = json.loads(body)["features"]
        check(status == 200 and features, f"{len(features)} items are listed")
        for feature in features:
            path = "/collections/town/items/" + urllib.parse.quote(feature["id"], safe="")
            status, gml = service.request("GET", path + "?f=gml")
            check(status == 200 and gml.startswith(b"<?xml"), f"{feature['id']} is given as GML")
            _, first = service.request("GET", path + "?f=cityjson")
            _, second = service.request("POST", "/convert", gml, headers={"Content-Type": "application/gml+xml"})
            compare(feature["id"], Model(first), Model(second), gml.decode())


def main():
    with temporary_folder("city_gml") as folder:
        for file in FILES:
            there_and_back(folder, file)
    with temporary_folder("city_gml") as folder:
        from_service(folder, next(file for file in FILES if file.suffix == ".gml"))
    raise SystemExit(1 if failures else 0)


if __name__ == "__main__":
    main()
