#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares the program's verdicts on labelled cases with their truths.

    bench/verdict/check_cases.py [--program build/release/bin/watertight] [--keep DIR] DIR

DIR holds cases.tsv (columns: file, truth, anything) and its files. A truth is `valid`, `invalid`
(any code) or `invalid CODE`. Each document is
validated as it is, mirrored in each axis (every ring turned, so that it stays the same kind of
solid) and renumbered (vertices, facets and ring starts in another order), each with the options of
OPTIONS below. One line is printed for each wrong verdict and a count at the end; the exit status
is 1 when one is wrong. --keep DIR leaves the written documents in DIR.
"""
import argparse
import copy
import csv
import json
import pathlib
import random
import re
import subprocess
import sys
import tempfile

OPTIONS = {
    "default": [],
    "boundary": ["--proof", "boundary"],
    "strict": ["--strict"],
    "cgal": ["--engine", "cgal"],
    "tetgen": ["--engine", "tetgen"],
}
# The truths of files that cases.tsv does not list: one truth for each feature.
MORE_CASES = {"D10_micro_204.wkt": ["invalid 203"] + ["valid"] * 9}


def is_ring(boundaries):
    return all(isinstance(entry, int) for entry in boundaries)


def rewrite_rings(boundaries, rewrite):
    """The nested boundaries with a function applied to every ring."""
    if is_ring(boundaries):
        return rewrite(boundaries)
    return [rewrite_rings(entry, rewrite) for entry in boundaries]


def geometries_of(document):
    for city_object in document["CityObjects"].values():
        yield from city_object.get("geometry", [])


def templates_of(document):
    return document.get("geometry-templates", {}).get("templates", [])


def solids_of(document):
    for geometry in list(geometries_of(document)) + templates_of(document):
        if geometry["type"] in ("Solid", "MultiSolid", "CompositeSolid"):
            yield geometry


def mirrored(document, axis):
    """The document with vertices, templates and matrices mirrored: each instance becomes its mirror
    image."""
    document = copy.deepcopy(document)
    if "transform" in document:
        document["transform"]["translate"][axis] *= -1
    for vertex in document["vertices"]:
        vertex[axis] = -vertex[axis]
    for vertex in document.get("geometry-templates", {}).get("vertices-templates", []):
        vertex[axis] = -vertex[axis]
    for geometry in geometries_of(document):
        matrix = geometry.get("transformationMatrix")
        for i in range(4) if matrix else ():
            if i != axis:
                matrix[4 * axis + i] = -matrix[4 * axis + i]
                matrix[4 * i + axis] = -matrix[4 * i + axis]
    for geometry in solids_of(document):
        geometry["boundaries"] = rewrite_rings(geometry["boundaries"], lambda ring: ring[::-1])
    return document


def renumber(vertices, geometries, numbers):
    """Puts vertices in another order and changes the numbers in the rings of geometries."""
    order = list(range(len(vertices)))
    numbers.shuffle(order)
    place = {old: new for new, old in enumerate(order)}

    def moved(ring):
        start = numbers.randrange(len(ring)) if ring else 0
        return [place[vertex] for vertex in ring[start:] + ring[:start]]

    for geometry in geometries:
        geometry["boundaries"] = rewrite_rings(geometry["boundaries"], moved)
        shells = [geometry["boundaries"]]
        if geometry["type"] in ("MultiSolid", "CompositeSolid"):
            shells = geometry["boundaries"]
        for solid in shells if geometry["type"] != "GeometryInstance" else ():
            for shell in solid:
                numbers.shuffle(shell)
    vertices[:] = [vertices[old] for old in order]


def renumbered(document, seed):
    document = copy.deepcopy(document)
    numbers = random.Random(seed)
    renumber(document["vertices"], list(geometries_of(document)), numbers)
    if templates_of(document):
        renumber(document["geometry-templates"]["vertices-templates"], templates_of(document),
                 numbers)
    return document


def mirrored_wkt(text, axis):
    def turned(match):
        points = [point.split() for point in match[1].split(",")][::-1]
        for point in points:
            point[axis] = point[axis][1:] if point[axis][0] == "-" else "-" + point[axis]
        return "(" + ",".join(" ".join(point) for point in points) + ")"

    return re.sub(r"\(([^()]+)\)", turned, text)


def variants_of(path):
    """The variants of a document: pairs of a name and a text."""
    text = path.read_text()
    yield "as it is", text
    if path.suffix == ".wkt":
        for axis in range(3):
            yield "mirrored in " + "xyz"[axis], mirrored_wkt(text, axis)
        return
    document = json.loads(text)
    for axis in range(3):
        yield "mirrored in " + "xyz"[axis], json.dumps(mirrored(document, axis))
    yield "renumbered", json.dumps(renumbered(document, path.name))


def read_cases(folder):
    """Pairs of a file and its list of truths: one truth for the document, or one for each
    feature."""
    with open(folder / "cases.tsv", newline="") as table:
        rows = [row for row in csv.reader(table, delimiter="\t", quoting=csv.QUOTE_NONE) if row]
    cases = [(folder / row[0], [row[1]]) for row in rows[1:]]
    listed = {path.name for path, _ in cases}
    for name, truths in MORE_CASES.items():
        if name not in listed and (folder / name).exists():
            cases.append((folder / name, truths))
    return cases


def write_variants(cases, folder):
    """Writes every variant into `folder`; returns (path, case, variant, truths) of each."""
    written = []
    for number, (path, truths) in enumerate(cases):
        for variant, text in variants_of(path):
            name = f"{number:03}-{variant.replace(' ', '-')}-{path.name}"
            (folder / name).write_text(text)
            written.append((folder / name, path.name, variant, truths))
    return written


def ask(program, paths, options):
    """The report of each document, in the order of the paths."""
    command = [program, "validate", *map(str, paths), *options, "--report", "-", "-q", "--no-times"]
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    reports = [json.loads(line) for line in result.stdout.splitlines() if line.startswith("{")]
    if len(reports) != len(paths):
        sys.exit(f"{command[:2]} gave {len(reports)} reports for {len(paths)} documents:"
                 f" {result.stderr[-2000:]}")
    return reports


def codes_of(report):
    return sorted({error["code"] for feature in report["features"] for error in feature["errors"]})


def said_of(report, truths):
    """Pairs of a truth and the program's answer: verdict, codes, reason."""
    parts = [report] if len(truths) == 1 else report["features"]
    assert len(parts) == len(truths), "a truth for each feature"
    for truth, part in zip(truths, parts):
        inner = {"features": [part]} if "features" not in part else part
        reasons = [primitive.get("undecided_reason", "") for feature in inner["features"]
                   for primitive in feature["primitives"]]
        yield truth, part["verdict"], codes_of(inner), " ".join(" ".join(reasons).split())[:200]


def is_right(truth, verdict, codes):
    wanted, _, code = truth.partition(" ")
    return verdict == wanted and (not code or int(code) in codes)


def check(program, written):
    wrong = asked = 0
    for name, options in OPTIONS.items():
        reports = ask(program, [path for path, *_ in written], options)
        for (_, case, variant, truths), report in zip(written, reports):
            for number, (truth, verdict, codes, reason) in enumerate(said_of(report, truths)):
                asked += 1
                if is_right(truth, verdict, codes):
                    continue
                wrong += 1
                feature = f" feature {number}" if len(truths) > 1 else ""
                said = " ".join([verdict, *map(str, codes)])
                print(f"{case}{feature} ({variant}, {name}): {truth} expected, {said} said"
                      + (f": {reason}" if reason else ""))
    return wrong, asked


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder")
    parser.add_argument("--program", default="build/release/bin/watertight")
    parser.add_argument("--keep", help="folder for the documents that are validated")
    arguments = parser.parse_args()
    cases = read_cases(pathlib.Path(arguments.folder))
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(arguments.keep or temporary)
        folder.mkdir(parents=True, exist_ok=True)
        written = write_variants(cases, folder)
        wrong, asked = check(arguments.program, written)
    print(f"{len(cases)} cases, {len(written)} documents, {asked} verdicts, {wrong} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
