#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads a collection with GDAL's and QGIS's clients of OGC API Features, and compares it with the document.

    map_programs.py WATERTIGHT DOCUMENT.city.jsonl

The document is in a projected EPSG system. gdaltransform is the oracle for coordinates, the document itself
for attributes and facets. Exit code 1 after a difference.
"""
import json
import os
import pathlib
import sys

PROGRAM, DOCUMENT = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/siege"))
from checks import check, failures, run  # noqa: E402
from service import Service, temporary_folder  # noqa: E402

DEGREES = 2e-9  # nine decimals, and as much for another version of PROJ
QGIS = r"""
import os, sys
os.environ["QT_QPA_PLATFORM"] = "offscreen"
from qgis.core import QgsApplication, QgsRectangle, QgsVectorLayer, QgsWkbTypes
import json
application = QgsApplication([], False)
application.initQgis()
is_file = sys.argv[1].endswith(".gpkg")
source = f"{sys.argv[1]}|layername={sys.argv[2]}" if is_file else f"url='{sys.argv[1]}' typename='{sys.argv[2]}'"
layer = QgsVectorLayer(source, "layer", "ogr" if is_file else "OAPIF")
extent, count = QgsRectangle(), 0
extent.setMinimal()
for feature in layer.getFeatures():
    count += 1
    extent.combineExtentWith(feature.geometry().boundingBox())
box = lambda r: [r.xMinimum(), r.yMinimum(), r.xMaximum(), r.yMaximum()]
print("RESULT " + json.dumps({
    "valid": layer.isValid(), "count": layer.featureCount(), "read": count, "crs": layer.crs().authid(),
    "type": QgsWkbTypes.displayString(layer.wkbType()), "extent": box(layer.extent()), "seen": box(extent),
    "fields": [field.name() for field in layer.fields()]}))
del feature, layer  # QGIS crashes if they outlive it
application.exitQgis()
"""


class Expected:
    """The features of the document: attributes, facets of the highest level of detail and their positions."""

    def __init__(self):
        lines = [json.loads(line) for line in DOCUMENT.read_text().splitlines()]
        self.header = lines[0]
        self.srid = int(self.header["metadata"]["referenceSystem"].rsplit("/", 1)[1])
        self.features = {feature["id"]: feature for feature in lines[1:]}

    def facets(self, feature):
        """The facets of the solids of each object's highest level, as positions in the document's CRS."""
        transform, found = self.header["transform"], []
        for item in feature["CityObjects"].values():
            solids = [g for g in item.get("geometry", []) if g["type"] == "Solid"]
            if not solids:
                continue
            highest = max(solids, key=lambda geometry: float(geometry["lod"]))
            for shell in highest["boundaries"]:
                for rings in shell:
                    found.append([[[v * s + t for v, s, t in zip(feature["vertices"][index], transform["scale"],
                                                                 transform["translate"])] for index in ring]
                                  for ring in rings])
        return found


def transformed(srid, positions):
    """Longitude and latitude of positions, by GDAL. A compound system counts with its part for x and y."""
    horizontal = {7415: 28992}.get(srid, srid)
    text = "\n".join(f"{x!r} {y!r}" for x, y, _ in positions)
    out = run("gdaltransform", "-output_xy", "-s_srs", f"EPSG:{horizontal}", "-t_srs", "OGC:CRS84", input=text)
    return [[float(value) for value in line.split()] for line in out.splitlines()]


def as_geojson(url, *arguments):
    # GDAL takes the types of fields from its first request, of few features unless told otherwise.
    out = run("ogr2ogr", "-oo", "PAGE_SIZE=1000", "-f", "GeoJSON", "/vsistdout/", "-lco", "COORDINATE_PRECISION=12", f"OAPIF:{url}", "town",
              *arguments)
    return {feature["properties"]["id"]: feature for feature in json.loads(out)["features"]}


def compare_gdal(url, expected):
    found = as_geojson(url)
    check(set(found) == set(expected.features), f"GDAL reads all {len(expected.features)} features, it has {len(found)}")
    wrong_counts = wrong_attributes = 0
    stored, given = [], []
    for name, feature in expected.features.items():
        facets = expected.facets(feature)
        polygons = found[name]["geometry"]["coordinates"]
        if len(polygons) != len(facets):
            wrong_counts += 1
            continue
        stored += [position for rings in facets for ring in rings for position in [*ring, ring[0]]]
        given += [position for polygon in polygons for ring in polygon for position in ring]
        attributes = feature["CityObjects"][name].get("attributes", {})
        properties = found[name]["properties"]
        for key, value in attributes.items():
            # GDAL reads a text that looks like JSON as such.
            is_plain = value is not None and not isinstance(value, (dict, list)) and not str(value).startswith("[")
            wrong_attributes += is_plain and properties.get(key) != value
    wrong_places = sum(
        not (abs(want[0] - have[0]) <= DEGREES and abs(want[1] - have[1]) <= DEGREES and abs(source[2] - have[2]) < 1e-6)
        for want, have, source in zip(transformed(expected.srid, stored), given, stored))
    check(wrong_counts == 0, f"GDAL has the facets of every feature ({wrong_counts} differ)")
    check(len(given) == len(stored) > 1000 and wrong_places == 0, f"{len(given)} positions are where GDAL puts them ({wrong_places} are not)")
    check(wrong_attributes == 0, f"attributes have the values of the document ({wrong_attributes} differ)")
    return found


def box_of(feature):
    positions = [p for polygon in feature["geometry"]["coordinates"] for ring in polygon for p in ring]
    xs, ys = [p[0] for p in positions], [p[1] for p in positions]
    return [min(xs), min(ys), max(xs), max(ys)]


def compare_selections(url, found):
    boxes = {name: box_of(feature) for name, feature in found.items()}
    xs = sorted(box[0] for box in boxes.values())
    ys = sorted(box[1] for box in boxes.values())
    spat = [xs[len(xs) // 3], ys[len(ys) // 3], xs[2 * len(xs) // 3], ys[2 * len(ys) // 3]]
    selected = set(as_geojson(url, "-spat", *map(repr, spat)))
    touching = {name for name, box in boxes.items()
                if box[0] <= spat[2] and box[2] >= spat[0] and box[1] <= spat[3] and box[3] >= spat[1]}
    check(selected and selected <= touching, f"-spat selects {len(selected)} of the {len(touching)} with boxes there")
    inside = {name for name, box in boxes.items()
              if box[0] >= spat[0] and box[2] <= spat[2] and box[1] >= spat[1] and box[3] <= spat[3]}
    check(inside <= selected, f"-spat misses none of the {len(inside)} that are inside")
    years = sorted({feature["properties"]["oorspronkelijkbouwjaar"] for feature in found.values()})
    year = years[len(years) // 2]
    same = {name for name, feature in found.items() if feature["properties"]["oorspronkelijkbouwjaar"] == year}
    check(set(as_geojson(url, "-where", f"oorspronkelijkbouwjaar = {year}")) == same,
          f"-where selects the {len(same)} of {year}")
    name = sorted(found)[0]
    check(set(as_geojson(url, "-where", f"id = '{name}'")) == {name}, "-where selects one feature by its id")


def compare_geopackage(url, folder, count):
    target = folder / "town.gpkg"
    run("ogr2ogr", str(target), f"OAPIF:{url}", "town")
    summary = run("ogrinfo", "-so", str(target), "town")
    check(f"Feature Count: {count}" in summary, "a GeoPackage gets all features")
    check("3D Multi Polygon" in summary, "its geometry has heights")


def compare_collection_file(service, folder, expected):
    """The GeoPackage that the service makes, by GDAL, against the document: exact, in the storage CRS."""
    target = folder / "own.gpkg"
    status, body = service.request("GET", "/collections/town/export?f=gpkg", None, 300)
    check(status == 200, f"the service makes a GeoPackage ({status})")
    target.write_bytes(body)
    layers = json.loads(run("ogr2ogr", "-f", "GeoJSON", "/vsistdout/", "-lco", "COORDINATE_PRECISION=17", str(target), "town"))
    check(f"EPSG::{expected.srid}" in json.dumps(layers.get("crs", {})), f"its CRS is EPSG:{expected.srid}")
    found = {feature["properties"]["id"]: feature for feature in layers["features"]}
    check(set(found) == set(expected.features), f"it has all {len(found)} features")
    wrong = places = 0
    for name, feature in expected.features.items():
        facets = [[[[round(value, 6) for value in point] for point in [*ring, ring[0]]] for ring in rings]
                  for rings in expected.facets(feature)]  # the document has three decimals
        places += sum(len(ring) for rings in facets for ring in rings)
        wrong += found[name]["geometry"]["coordinates"] != facets
        for key, value in feature["CityObjects"][name].get("attributes", {}).items():
            is_plain = not isinstance(value, (dict, list)) and not str(value).startswith("[")
            column = "fid_2" if key == "fid" else key  # fid is the number of the row
            wrong += is_plain and found[name]["properties"].get(column) != value
    check(places > 1000 and wrong == 0, f"its {places} positions and the attributes are those of the document ({wrong} differ)")
    years = [feature["properties"]["oorspronkelijkbouwjaar"] for feature in found.values()]
    summary = run("ogrinfo", "-so", "-where", f"oorspronkelijkbouwjaar = {years[0]}", str(target), "town")
    check(f"Feature Count: {years.count(years[0])}" in summary, f"-where finds the {years.count(years[0])} of {years[0]}")
    check("oorspronkelijkbouwjaar: Integer" in summary, "a column of whole numbers is one of integers")
    boxes = [box_of(feature) for feature in found.values()]
    xs = sorted(box[0] for box in boxes)
    west = [xs[0], min(box[1] for box in boxes), xs[len(xs) // 2], max(box[3] for box in boxes)]
    count = int(run("ogrinfo", "-so", "-spat", *map(repr, west), str(target), "town").split("Feature Count: ")[1].split()[0])
    check(len(xs) // 2 <= count < len(xs), f"-spat finds the {count} in the west, by the index")
    run("ogrinfo", str(target), "-sql", "DELETE FROM town WHERE fid > 1")
    check("Feature Count: 1\n" in run("ogrinfo", "-so", str(target), "town"), "GDAL can change it")
    target.write_bytes(body)
    return target


def seen_by_qgis(source, folder):
    python = "/usr/bin/python3"  # QGIS's module is that of the system
    home = folder / "qgis"
    home.mkdir(mode=0o700, exist_ok=True)
    environment = {**os.environ, "HOME": str(home), "XDG_RUNTIME_DIR": str(home)}
    out = run(python, "-c", QGIS, source, "town", env=environment)
    return json.loads(next(line for line in out.splitlines() if line.startswith("RESULT "))[7:])


def compare_qgis_file(target, folder, expected):
    result = seen_by_qgis(str(target), folder)
    check(result["valid"] and result["read"] == len(expected.features), f"QGIS reads the {result['read']} features of the GeoPackage")
    check(result["crs"] == f"EPSG:{expected.srid}", f"QGIS takes its CRS for {result['crs']}")
    check(result["type"] == "MultiPolygonZ", f"QGIS takes its geometry for {result['type']}")


def compare_qgis(url, folder, found):
    result = seen_by_qgis(url, folder)
    boxes = [box_of(feature) for feature in found.values()]
    extent = [min(box[0] for box in boxes), min(box[1] for box in boxes), max(box[2] for box in boxes),
              max(box[3] for box in boxes)]
    check(result["valid"], "QGIS adds the layer")
    check(result["read"] == result["count"] == len(found), f"QGIS reads {result['read']} of {len(found)} features")
    check(result["crs"] in ("EPSG:4326", "OGC:CRS84"), f"QGIS takes the CRS for {result['crs']}")
    check(result["type"] == "MultiPolygonZ", f"QGIS takes the geometry for {result['type']}")
    check(all(abs(a - b) < DEGREES for a, b in zip(result["seen"], extent)), "QGIS sees the extent that GDAL sees")
    check("oorspronkelijkbouwjaar" in result["fields"] and "wt_proven" in result["fields"], "QGIS has the attributes")


def main():
    expected = Expected()
    with temporary_folder("maps") as folder, Service(PROGRAM, folder) as service:
        status, body = service.request("POST", "/collections/town/items?invalid=keep", DOCUMENT.read_bytes(), 300)
        if status != 201:
            raise SystemExit(f"storing gave {status}: {body[:500]!r}")
        url = f"http://127.0.0.1:{service.port}"
        found = compare_gdal(url, expected)
        compare_selections(url, found)
        compare_geopackage(url, folder, len(found))
        compare_qgis(url, folder, found)
        compare_qgis_file(compare_collection_file(service, folder, expected), folder, expected)
        service.stop()
    print(f"{len(failures)} differences")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
