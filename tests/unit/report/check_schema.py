#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""check_schema.py WRITE_REPORTS ROOT

Reports of all golden samples, of several files at once and of broken input are valid under
docs/schema/report-2.schema.json; the schema describes every member, and each member it describes
occurs in some report. The same reports have every member that val3dity's report browser reads.
"""
import itertools
import json
import pathlib
import subprocess
import sys
import tempfile

import jsonschema

# Members that need a time, an engine, or input that no sample has.
ABSENT = {"time", "seconds", "undecided_reason", "tolerant", "tolerant_snap_tol", "lod", "solids"}


# A cube without its upper facet, whose border lies on no plane; and a cube with a second one that
# shares an edge with the border, so that the border cannot be cut into simple loops.
BOWL = """OFF
8 5 0
0 0 0\n4 0 0\n4 4 0\n0 4 0\n0 0 4\n4 0 5\n4 4 4\n0 4 6
4 3 2 1 0\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7
"""
STRIP = """OFF
6 6 0
0 0 0\n4 0 1\n4 4 0\n0 4 2\n2 2 5\n7 1 3
3 0 1 4\n3 1 2 4\n3 2 3 4\n3 3 0 4\n3 0 1 5\n3 1 0 2
"""


def open_cube():
    """A cube of 6 x 6 squares a side without four of them in the middle of its upper side, as OFF."""
    places, facets = {}, []
    for axis in range(3):
        for level in (0, 6):
            for a, b in itertools.product(range(6), repeat=2):
                if (axis, level, a // 2, b // 2) == (2, 6, 1, 1):
                    continue
                corners = []
                for i, j in ((0, 0), (1, 0), (1, 1), (0, 1)):
                    place = [0, 0, 0]
                    place[axis], place[(axis + 1) % 3], place[(axis + 2) % 3] = level, a + i, b + j
                    corners.append(places.setdefault(tuple(place), len(places)))
                facets.append(corners if level else corners[::-1])
    lines = [f"OFF\n{len(places)} {len(facets)} 0"]
    lines += [" ".join(map(str, place)) for place in places]
    lines += [" ".join(map(str, (4, *corners))) for corners in facets]
    return "\n".join(lines) + "\n"


def reports_of(program, files, kind="json"):
    out = subprocess.run([program, kind, *map(str, files)], capture_output=True, check=True)
    return [json.loads(line) for line in out.stdout.decode("utf-8").splitlines()]


def undescribed(schema, path="#"):
    if not isinstance(schema, dict):
        return
    for name, member in schema.get("properties", {}).items():
        if "description" not in member and "$ref" not in member:
            yield f"{path}/{name}"
        yield from undescribed(member, f"{path}/{name}")
    for name, member in schema.get("$defs", {}).items():
        yield from undescribed(member, f"{path}/{name}")
    yield from undescribed(schema.get("items"), path + "/items")


def members_of(schema):
    names = set(schema.get("properties", {}))
    for member in schema.get("properties", {}).values():
        names |= members_of(member)
        names |= members_of(member.get("items", {}))
    for member in schema.get("$defs", {}).values():
        names |= members_of(member)
    return names


def seen_in(value):
    if isinstance(value, dict):
        return set(value).union(*map(seen_in, value.values()))
    return set().union(*map(seen_in, value)) if isinstance(value, list) else set()


def browse(report):
    """Reads a report as the pages of val3dity's report browser do; any missing member raises."""
    assert report["type"] == "val3dity_report"
    for name in ("input_file", "input_file_type", "val3dity_version"):
        assert isinstance(report[name], str)
    assert all(not isinstance(value, (dict, list)) for value in report["parameters"].values())
    assert isinstance(report["validity"], bool)
    for name in ("features_overview", "primitives_overview"):
        for row in report[name]:
            assert row["type"] is not None and row["total"] - row["valid"] >= 0
        assert sum(row["total"] for row in report[name]) >= sum(row["valid"] for row in report[name])
    # The browser looks each code up in a table of its own and fails on any other code.
    assert all(code < 800 or code >= 900 for code in report["all_errors"])
    for error in report["dataset_errors"]:
        assert error["code"] and error["description"] and error["info"]
    for feature in report["features"]:
        assert isinstance(feature["id"], str) and isinstance(feature["validity"], bool)
        assert feature["type"] is not None
        assert isinstance(feature["primitives"], list)
        for error in feature["errors"]:
            assert error["code"] in report["all_errors"]
            assert error["description"] and error["id"] and isinstance(error["info"], str)
        assert feature["validity"] or feature["errors"] or feature["verdict"] == "undecided"


def main():
    program, root = sys.argv[1], pathlib.Path(sys.argv[2])
    schema = json.loads((root / "docs/schema/report-2.schema.json").read_text())
    validator = jsonschema.Draft202012Validator(schema)
    samples = sorted(path for path in (root / "tests/golden/findings").iterdir()
                     if not path.name.endswith(".report.json") and path.is_file())
    assert samples
    # The sample has a facet that is not planar and that the proof fills otherwise than the exact
    # tests.
    samples.append(root / "tests/golden/solids/slab-depends-on-diagonal.city.json")
    # A curved solid with a face that is left out.
    samples.append(root / "tests/golden/curved/lost-side.step")
    # Findings between elements of the document, and in polygons with ids.
    samples += [root / "tests/data/gml" / name
                for name in ("defects.gml", "ogc_Building_LOD3-EPSG25832.gml")]
    # Surfaces that close, and surfaces with findings.
    samples.append(root / "tests/data/cityjson/surfaces.city.json")
    failures = [f"{path}: no description" for path in undescribed(schema)]
    reports = reports_of(program, samples)
    if len(reports) != len(samples):
        failures.append(f"{len(samples)} files gave {len(reports)} reports")
    with tempfile.TemporaryDirectory() as folder:
        broken = pathlib.Path(folder) / "broken.city.json"
        broken.write_bytes(b'{"type":"CityJSON",\xff')
        unknown = pathlib.Path(folder) / "unknown.bin"
        unknown.write_bytes(b"\x00\x01")
        bowl = pathlib.Path(folder) / "bowl.off"
        bowl.write_text(BOWL)
        strip = pathlib.Path(folder) / "strip.off"
        strip.write_text(STRIP)
        cube = pathlib.Path(folder) / "cube.off"
        cube.write_text(open_cube())
        mended = [root / "examples/invalid.city.jsonl", bowl, strip]
        reports += reports_of(program, mended, "repaired")
        reports += reports_of(program, [cube, bowl, strip], "smoothed")
        reports += reports_of(program, [broken, unknown])
    if reports[-2]["all_errors"] != [901] or reports[-2]["verdict"] != "undecided":
        failures.append("a broken file is not reported as 901, undecided")
    for report in reports:
        name = report["input_file"]
        failures += [f"{name}: {'/'.join(map(str, error.path))}: {error.message[:200]}"
                     for error in validator.iter_errors(report)]
        try:
            browse(report)
        except (AssertionError, KeyError) as error:
            failures.append(f"{name}: val3dity's report browser would fail: {error!r}")
    seen = set().union(*map(seen_in, reports))
    for name in sorted(members_of(schema) - seen - ABSENT):
        failures.append(f"{name}: described, but in no report")
    wrong = dict(reports[0], verdict="perhaps")
    if not list(validator.iter_errors(wrong)):
        failures.append("the schema accepts anything")
    print("\n".join(failures) or f"{len(reports)} reports fit the schema")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
