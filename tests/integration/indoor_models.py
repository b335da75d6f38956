#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Indoor models through the program: codes, places, reports, files.

    indoor_models.py WATERTIGHT SOURCE [--labelled FOLDER]

Requires that the samples of 701 to 704 in SOURCE/tests/golden/findings have exactly their code in
every report, that two rooms with a door are valid, that encode keeps, skips and refuses cells with
findings, that decode gives the very bytes back, that a store keeps marks, that the service finds the
same, and that a model of 2,000 cells takes seconds. With --labelled, the files FOLDER/igml_*.gml must
have the codes of the list FOLDER/../../../expected.csv; prints a table of them. Exit code 1 after the
first violation.
"""
import argparse
import csv
import json
import pathlib
import subprocess
import sys
import tempfile
import time

CELL_KINDS = ["CellSpace", "TransferSpace", "GeneralSpace"]


def require(condition, *words):
    if not condition:
        raise SystemExit(" ".join(map(str, words)))


def run(program, *arguments):
    return subprocess.run([program, *map(str, arguments)], capture_output=True, text=True)


def report_of(program, file, folder, *options):
    report = folder / "report.json"
    done = run(program, "validate", file, "--report", report, *options)
    require(done.returncode in (0, 1), file, done.stderr)
    return done, json.loads(report.read_text())


def codes_of(report):
    return sorted({error["code"] for feature in report["features"] for error in feature["errors"]})


def check_samples(program, source, folder):
    for code in (701, 702, 703, 704):
        sample = source / "tests" / "golden" / "findings" / f"{code}.gml"
        done, report = report_of(program, sample, folder)
        require(done.returncode == 1, sample, "status", done.returncode)
        require(codes_of(report) == [code], sample, codes_of(report))
        require(report["all_errors"] == [code], sample, report["all_errors"])
        both = code in (701, 704)
        invalid = [feature["id"] for feature in report["features"] if not feature["validity"]]
        require(invalid == (["kitchen", "hall"] if both else ["kitchen"]), sample, invalid)
        for feature in report["features"]:
            require([group["kind"] for group in feature["groups"]] == ["indoor_cells"], sample, feature["groups"])
            for error in feature["errors"]:
                require(error["source"]["line"] > 1, sample, error)
                require("'kitchen' (line 7)" in error["info"] or "'kitchen-state' (line" in error["info"], sample, error)
        table = folder / "findings.csv"
        log = folder / "log.sarif"
        page = folder / "page.html"
        run(program, "validate", sample, "--csv", table, "--sarif", log, "--html", page)
        rows = list(csv.DictReader(table.open()))
        require({row["code"] for row in rows} == {str(code)}, sample, rows)
        results = json.loads(log.read_text())["runs"][0]["results"]
        require(len(results) == len(rows), sample, results)
        require(str(code) in page.read_text(), sample, "HTML")
        explained = run(program, "validate", "--explain", str(code))
        require(explained.returncode == 0 and str(code) in explained.stdout, explained)


def check_overlap_option(program, source, folder):
    golden = source / "tests" / "golden" / "findings"
    for code in (701, 704):  # an overlap and a gap of 1 m
        for metres, expected in (("0.99", [code]), ("1", [])):
            _, report = report_of(program, golden / f"{code}.gml", folder, "--overlap", metres)
            require(codes_of(report) == expected, code, metres, codes_of(report))


def check_files(program, source, folder):
    valid = source / "tests" / "data" / "gml" / "indoor_valid.gml"
    done, report = report_of(program, valid, folder)
    require(done.returncode == 0 and report["validity"], valid, done.stdout)
    overlapping = source / "tests" / "golden" / "findings" / "701.gml"
    for file, status in ((valid, 0), (overlapping, 1)):
        stored, back = folder / "model.wt", folder / "model.gml"
        done = run(program, "encode", file, "--invalid", "keep", "-o", stored)
        require(done.returncode == status, file, done.stderr)
        require(run(program, "decode", stored, "-o", back).returncode == 0, file)
        require(back.read_bytes() == file.read_bytes(), file, "other bytes came back")
    refused = folder / "refused.wt"
    done = run(program, "encode", overlapping, "--invalid", "refuse", "-o", refused)
    require(done.returncode == 1 and not refused.exists(), done.stderr)


def check_store(program, source):
    """Cells with findings in a store: refused, left out, or kept and marked; POST /validate finds the same."""
    sys.path.append(str(source / "tests" / "siege"))
    from service import Service, temporary_folder
    text = (source / "tests" / "golden" / "findings" / "701.gml").read_text()
    with temporary_folder("indoor") as folder:
        service = Service(program, folder)
        sample = folder / "overlap.gml"
        sample.write_text(text)
        sample.chmod(0o644)
        for policy, status in (("refuse", 1), ("skip", 1), ("keep", 1)):
            command = [*service.prefix, service.program, "ingest", "--data-dir", folder / "data", "--collection", policy,
                       "--invalid", policy, sample]
            done = subprocess.run(list(map(str, command)), capture_output=True, text=True, cwd=folder)
            require(done.returncode == status, policy, done.returncode, done.stdout, done.stderr)
        with service:
            answer, body = service.request("POST", "/validate", text.encode(), 60, {"Content-Type": "application/gml+xml"})
            require(answer == 200 and codes_of(json.loads(body)) == [701], answer, body[:300])
            for policy, features in (("refuse", 0), ("skip", 0), ("keep", 2)):
                answer, body = service.request("GET", f"/collections/{policy}")
                found = json.loads(body) if answer == 200 else {"features": 0, "solids": 0, "unproven": {"features": 0, "solids": 0}}
                require(found["features"] == found["solids"] == features, policy, found)
                require(found["unproven"] == {"features": features, "solids": 0}, policy, found)
            answer, body = service.request("GET", "/collections/keep/items/kitchen?f=proof")
            proof = json.loads(body)
            require(answer == 200 and not proof["proven"] and proof["solids"][0]["proven"], answer, body)
            group = proof["findings"][0]
            require(group["kind"] == "indoor_cells" and group["findings"][0]["code"] == 701, body)


def large_model(side, storeys):
    """Boxes of 4 m x 3 m x 3 m without walls, a door through each wall between two of them."""
    facets = ["0462", "1375", "0154", "2673", "0231", "4576"]
    cells, nodes, edges = [], [], []
    for number in range(side * side * storeys):
        x, y, z = number % side, number // side % side, number // side // side
        low, high = (4 * x, 3 * y, 3 * z), (4 * x + 4, 3 * y + 3, 3 * z + 3)
        members = []
        for facet in facets:
            ring = " ".join(str((low, high)[int(c) >> axis & 1][axis]) for c in facet + facet[0] for axis in range(3))
            members.append("<g:surfaceMember><g:Polygon><g:exterior><g:LinearRing><g:posList>" + ring +
                           "</g:posList></g:LinearRing></g:exterior></g:Polygon></g:surfaceMember>")
        kind = CELL_KINDS[number % len(CELL_KINDS)]
        prefix = "" if kind == "CellSpace" else "n:"
        cells.append(f'<cellSpaceMember><{prefix}{kind} g:id="c{number}"><cellSpaceGeometry><Geometry3D><g:Solid>'
                     f'<g:exterior><g:Shell>{"".join(members)}</g:Shell></g:exterior></g:Solid></Geometry3D>'
                     f'</cellSpaceGeometry><duality x:href="#s{number}"/></{prefix}{kind}></cellSpaceMember>')
        nodes.append(f'<stateMember><State g:id="s{number}"><duality x:href="#c{number}"/><geometry><g:Point><g:pos>'
                     f'{4 * x + 2} {3 * y + 1.5} {3 * z + 1}</g:pos></g:Point></geometry></State></stateMember>')
        for neighbour, is_there in ((number - 1, x > 0), (number - side, y > 0)):
            if is_there:
                edges.append(f'<transitionMember><Transition g:id="t{neighbour}-{number}"><connects x:href="#s{neighbour}"/>'
                             f'<connects x:href="#s{number}"/></Transition></transitionMember>')
    return ('<IndoorFeatures xmlns="http://www.opengis.net/indoorgml/1.0/core" xmlns:g="http://www.opengis.net/gml/3.2" '
            'xmlns:n="http://www.opengis.net/indoorgml/1.0/navigation" xmlns:x="http://www.w3.org/1999/xlink">\n'
            '<primalSpaceFeatures><PrimalSpaceFeatures>\n' + "\n".join(cells) +
            '\n</PrimalSpaceFeatures></primalSpaceFeatures><multiLayeredGraph><MultiLayeredGraph><spaceLayers>'
            '<spaceLayerMember><SpaceLayer><nodes>\n' + "\n".join(nodes) + '\n</nodes><edges>\n' + "\n".join(edges) +
            '\n</edges></SpaceLayer></spaceLayerMember></spaceLayers></MultiLayeredGraph></multiLayeredGraph></IndoorFeatures>\n')


def check_large(program, folder):
    text = large_model(20, 5)
    file = folder / "large.gml"
    file.write_text(text)
    start = time.monotonic()
    done, report = report_of(program, file, folder)
    seconds = time.monotonic() - start
    require(done.returncode == 0, done.stdout)
    require(seconds < 60, "2,000 cells took", seconds, "s")
    # One room grows into its neighbour, one state leaves its room, one door leads nowhere.
    broken = text.replace("<g:pos>2 1.5 1</g:pos>", "<g:pos>-2 1.5 1</g:pos>")
    broken = broken.replace('<Transition g:id="t0-1"><connects x:href="#s0"/>', '<Transition g:id="t0-1"><connects x:href="#x"/>')
    first = broken.index('g:id="c42"')
    end = broken.index("\n", first)
    broken = broken[:first] + broken[first:end].replace("12 6 ", "13 6 ").replace("12 9 ", "13 9 ") + broken[end:]
    file.write_text(broken)
    _, report = report_of(program, file, folder)
    found = {(feature["id"], error["code"]) for feature in report["features"] for error in feature["errors"]}
    require(found == {("c0", 702), ("c1", 703), ("c42", 701), ("c43", 701)}, found)


def check_labelled(program, labelled, folder):
    rows = csv.reader((labelled.parent.parent.parent / "expected.csv").open())
    expected = {pathlib.Path(row[0]).name: row[1] for row in rows if "indoorgml" in row[0]}
    require(expected, "no rows of IndoorGML in the list")
    print(f"{'file':20} {'expected':>10} {'found':>10}")
    for name, codes in sorted(expected.items()):
        _, report = report_of(program, labelled / name, folder)
        found = "+".join(map(str, codes_of(report))) or "valid"
        print(f"{name:20} {codes:>10} {found:>10}")
        require(found == codes, name)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("source", type=pathlib.Path)
    parser.add_argument("--labelled", type=pathlib.Path)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        check_samples(arguments.program, arguments.source, folder)
        check_overlap_option(arguments.program, arguments.source, folder)
        check_files(arguments.program, arguments.source, folder)
        check_large(arguments.program, folder)
        check_store(arguments.program, arguments.source)
        if arguments.labelled:
            check_labelled(arguments.program, arguments.labelled, folder)
    print("indoor models: all as expected")
    return 0


if __name__ == "__main__":
    sys.exit(main())
