#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares 3D Tiles with the document that they show, by programs of others.

    tiles.py WATERTIGHT DOCUMENT.city.jsonl NODE_FOLDER OTHER_DOCUMENT...

Khronos' glTF validator finds no error and no warning, meshoptimizer's own decoder expands the tiles, and
gdaltransform says where the features are: each has the area of its facets, at its place on the Earth, once
among all tiles; from the command line, uncompressed, and from the service. The other documents are only made
tiles of and validated. Cesium's 3d-tiles-tools walks each tileset. NODE_FOLDER is where npm puts the packages of gltf/package.json. Exit code 1 after a
difference.
"""
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys

PROGRAM, DOCUMENT = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
NODE, OTHERS = pathlib.Path(sys.argv[3]).resolve(), sys.argv[4:]
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/siege"))
from checks import check, failures, run  # noqa: E402
from service import Service, temporary_folder  # noqa: E402

METRES = 0.02  # the rounding to 1/1024 m, and another version of PROJ
SHARE = 0.002  # of an area: facets that are not flat have several triangulations


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


class Expected:
    """For each feature the area of the facets of each object's highest level, and its middle."""

    def __init__(self):
        lines = [json.loads(line) for line in DOCUMENT.read_text().splitlines()]
        self.transform = lines[0]["transform"]
        self.features = {feature["id"]: self.measure(feature) for feature in lines[1:]}

    def measure(self, feature):
        area, middle = 0, [0, 0, 0]
        for item in feature["CityObjects"].values():
            solids = [g for g in item.get("geometry", []) if g["type"] == "Solid"]
            for shell in max(solids, key=lambda g: float(g["lod"]))["boundaries"] if solids else []:
                for rings in shell:
                    own, moment = self.facet(feature, rings)
                    area += own
                    middle = [m + n for m, n in zip(middle, moment)]
        return area, [m / area for m in middle]

    def facet(self, feature, rings):
        """The area of a facet by the shoelace formula, and the middle times the area."""
        place = [[[v * s + t for v, s, t in zip(feature["vertices"][i], self.transform["scale"], self.transform["translate"])]
                  for i in ring] for ring in rings]
        origin, total, moments = place[0][0], [0, 0, 0], []
        for ring in place:
            for a, b in zip(ring, ring[1:] + ring[:1]):
                vector = cross(minus(a, origin), minus(b, origin))
                total = [t + v for t, v in zip(total, vector)]
                moments.append((vector, [(o + x + y) / 3 for o, x, y in zip(origin, a, b)]))
        length = math.hypot(*total)
        if length == 0:
            return 0, [0, 0, 0]
        weights = [sum(v * t for v, t in zip(vector, total)) / length / 2 for vector, _ in moments]
        return length / 2, [sum(w * m[axis] for w, (_, m) in zip(weights, moments)) for axis in range(3)]


def on_earth(positions):
    """Earth-centred coordinates of positions in the Dutch system, heights as they are."""
    text = "\n".join(f"{x!r} {y!r}" for x, y, _ in positions)
    out = run("gdaltransform", "-output_xy", "-s_srs", "EPSG:28992", "-t_srs", "OGC:CRS84", input=text)
    found, major, flattening = [], 6378137.0, 1 / 298.257223563
    squared = flattening * (2 - flattening)
    for line, (_, _, height) in zip(out.splitlines(), positions):
        longitude, latitude = (math.radians(float(word)) for word in line.split())
        normal = major / math.sqrt(1 - squared * math.sin(latitude) ** 2)
        found.append([(normal + height) * math.cos(latitude) * math.cos(longitude),
                      (normal + height) * math.cos(latitude) * math.sin(longitude),
                      (normal * (1 - squared) + height) * math.sin(latitude)])
    return found


def times(a, b):
    return [sum(a[k * 4 + row] * b[column * 4 + k] for k in range(4)) for column in range(4) for row in range(4)]


def tiles_of(tile, matrix=None):
    """Each content's address with the matrix that leads to the Earth."""
    own = tile.get("transform", [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])
    matrix = own if matrix is None else times(matrix, own)
    if "content" in tile:
        yield tile["content"]["uri"], matrix, tile
    for child in tile.get("children", []):
        assert child["geometricError"] <= tile["geometricError"]
        yield from tiles_of(child, matrix)


def read(files):
    lines = run("node", str(NODE / "read_glb.js"), *map(str, files)).splitlines()
    return [json.loads(line) for line in lines]


def compare(name, tileset, files, expected):
    """`files` are the contents, in the order of tiles_of()."""
    tiles = list(tiles_of(tileset["root"]))
    contents = read(files)
    found = {}
    for (_, matrix, tile), content in zip(tiles, contents):
        check(content["errors"] == content["warnings"] == 0, f"{name}: the glTF validator is content {content['bad']}")
        box = tile["boundingVolume"]["box"]
        for feature in content["features"]:
            assert feature["id"] not in found, "a feature is in two tiles"
            x, y, z = feature["middle"][0], -feature["middle"][2], feature["middle"][1]
            assert all(abs(v - box[i]) <= box[3 + 4 * i] for i, v in enumerate([x, y, z])), "outside of the box"
            place = [sum(matrix[k * 4 + row] * v for k, v in enumerate([x, y, z, 1])) for row in range(3)]
            found[feature["id"]] = (feature["area"], place)
    check(set(found) == set(expected.features), f"{name}: {len(found)} features in {len(tiles)} tiles, each once")
    places = dict(zip(expected.features, on_earth([middle for _, middle in expected.features.values()])))
    far = max(math.dist(found[name][1], places[name]) for name in found)
    off = max(abs(found[name][0] / area - 1) for name, (area, _) in expected.features.items())
    check(off <= SHARE, f"{name}: the area of triangles is that of facets, to {off:.5f} of it")
    check(far <= METRES, f"{name}: features are where GDAL puts them, to {far * 1000:.1f} mm")


def walk(name, folders):
    """Cesium's 3d-tiles-tools traverses tilesets, reads all metadata, packs and unpacks them."""
    lines = run("node", str(NODE / "walk_tiles.js"), *map(str, folders)).splitlines()
    walked = [json.loads(line) for line in lines]
    wrong = [(one["folder"], one["wrong"]) for one in walked if one["wrong"]]
    tiles, features = sum(one["tiles"] for one in walked), sum(one["features"] for one in walked)
    check(len(walked) == len(folders) and not wrong, f"{name}: 3d-tiles-tools walk {tiles} tiles with {features} features {wrong}")


def compare_command(folder, expected):
    for words in ([], ["--uncompressed"]):
        out = folder / ("tiles" + "".join(words))
        run(PROGRAM, "tiles", str(DOCUMENT), "-o", str(out), *words)
        tileset = json.loads((out / "tileset.json").read_text())
        compare("tiles " + " ".join(words), tileset, [out / uri for uri, _, _ in tiles_of(tileset["root"])], expected)
    walk("tiles", [folder / "tiles", folder / "tiles--uncompressed"])
    again = folder / "again"
    run(PROGRAM, "tiles", str(DOCUMENT), "-o", str(again), "-j", "1")
    check(run("diff", "-r", str(again), str(folder / "tiles")) == "", "one thread writes the same bytes")
    refused = subprocess.run([PROGRAM, "tiles", str(DOCUMENT), "-o", str(again)], capture_output=True, check=False)
    check(refused.returncode == 2 and b"is there already" in refused.stderr, "a folder that is there is not written to")
    broken = folder / "broken.city.jsonl"
    broken.write_text("".join(DOCUMENT.read_text().splitlines(keepends=True)[:2]) + '{"type":\n')
    told = subprocess.run([PROGRAM, "tiles", str(broken), "-o", str(folder / "rest")], capture_output=True, text=True, check=False)
    check(told.returncode == 1 and "1 feature of 2" in told.stdout and told.stderr.count("line 3: ") == 1,
          "a broken line is named once, and the others become tiles")


def as_files(out, tileset, files):
    """The tileset of the service as files, whose addresses have no parameters."""
    out.mkdir()
    for (_, _, tile), file in zip(tiles_of(tileset["root"]), files):
        shutil.copy(file, out / file.name)
        tile["content"]["uri"] = file.name
    (out / "tileset.json").write_text(json.dumps(tileset))
    return out


def fetched(service, folder, layer):
    """The tileset of a layer, and its contents as files in the order of tiles_of()."""
    tileset = json.loads(service.request("GET", f"/collections/town/3dtiles?layer={layer}")[1])
    files = []
    for uri, _, _ in tiles_of(tileset["root"]):
        status, body = service.request("GET", "/collections/town/" + uri)
        assert status == 200, body
        files.append(folder / f"{layer}-{len(files)}.glb")
        files[-1].write_bytes(body)
    return tileset, files


def check_findings(service, folder):
    """The layer of the findings is valid, and has a pin for each of them within the box of its tile."""
    tileset, files = fetched(service, folder, "findings")
    statistics = json.loads(service.request("GET", "/collections/town/statistics")[1])
    wanted = sum(finding["count"] for finding in statistics["findings"])
    contents = read(files)
    outside = 0
    for (_, _, tile), content in zip(tiles_of(tileset["root"]), contents):
        box = tile["boundingVolume"]["box"]
        for pin in content["features"]:
            x, y, z = pin["middle"][0], -pin["middle"][2], pin["middle"][1]
            outside += any(abs(v - box[i]) > box[3 + 4 * i] for i, v in enumerate([x, y, z]))
    bad = [content["bad"] for content in contents if content["errors"] or content["warnings"]]
    pins = sum(len(content["features"]) for content in contents)
    check(not bad and pins == wanted > 0 and outside == 0, f"{pins} pins of {wanted} findings, {outside} outside of their tiles {bad}")
    walk("findings", [as_files(folder / "walked-findings", tileset, files)])


def compare_service(folder, expected):
    with Service(PROGRAM, folder) as service:
        status, body = service.request("POST", "/collections/town/items?invalid=keep", DOCUMENT.read_bytes(), 300)
        assert status == 201, body
        tileset, files = fetched(service, folder, "features")
        compare("service", tileset, files, expected)
        walk("service", [as_files(folder / "walked", tileset, files)])
        check_findings(service, folder)
        one = next(iter(expected.features))
        _, body = service.request("GET", f"/collections/town/items/{one}?f=glb")
        (folder / "one.glb").write_bytes(body)
        content, = read([folder / "one.glb"])
        check(content["errors"] == content["warnings"] == 0 and content["features"][0]["id"] == one, "an item is a valid glTF")
        service.stop()


def validate_others(folder):
    files, folders = [], []
    for number, document in enumerate(OTHERS):
        out = folder / f"other-{number}"
        done = subprocess.run([PROGRAM, "tiles", document, "-o", str(out)], capture_output=True, text=True, timeout=300, check=False)
        assert done.returncode in (0, 1, 2), f"{document}: status {done.returncode}"
        assert (done.returncode == 2) == (not out.exists()), document
        folders += [out] if out.exists() else []
        files += sorted(out.glob("*/*/*.glb"))
    bad = [(content["file"], content["bad"]) for content in read(files) if content["errors"] or content["warnings"]]
    check(len(files) > 0 and not bad, f"{len(files)} tiles of {len(folders)} other documents are valid {bad}")
    walk("other documents", folders)


def main():
    NODE.mkdir(parents=True, exist_ok=True)
    for name in ("package.json", "read_glb.js", "walk_tiles.js"):
        shutil.copy(ROOT / "tests/integration/gltf" / name, NODE / name)
    run("npm", "install", "--no-package-lock", "--no-audit", "--no-fund", "--ignore-scripts", cwd=NODE)
    expected = Expected()
    with temporary_folder("tiles") as folder:
        compare_command(folder, expected)
        validate_others(folder)
    with temporary_folder("tiles") as folder:
        compare_service(folder, expected)
    print(f"{len(failures)} differences")
    sys.exit(1 if failures else 0)


main()
