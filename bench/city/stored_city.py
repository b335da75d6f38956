#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Stores city models with invalid=keep, and compares every feature that comes back with its source.

    stored_city.py WATERTIGHT FILE...

Each CityJSON or CityJSONSeq is posted to a collection of its own of a private service. Features of a
sequence must be the very lines; objects of a CityJSON must be equal as decimals (city_models.py, which
shares no code with the program). Appearances are not compared, since features have lists of their
own. Prints a row for each file; exit code 1 after a difference.
"""
import json
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path += [str(ROOT / "tests/siege"), str(ROOT / "tests/integration")]
import city_models  # noqa: E402
from service import Service, temporary_folder  # noqa: E402


def items(service, collection):
    path = f"/collections/{collection}/items?limit=1000&f=summary"
    while path:
        page = json.loads(service.request("GET", path)[1])
        yield from page["features"]
        path = next((link["href"] for link in page["links"] if link["rel"] == "next"), None)


def stored_lines(service, collection):
    """The header and the line of each stored feature; without a transform, its CityJSON twice."""
    for item in items(service, collection):
        href = next(link["href"] for link in item["links"] if link["rel"] == "item")
        status, body = service.request("GET", href.replace("f=cityjson", "f=cityjsonseq"))
        if status == 406:  # a sequence needs a transform
            status, body = service.request("GET", href)
            body = body + b"\n" + body
        if status != 200:
            raise SystemExit(f"{href}: {status} {body[:300]!r}")
        header, line = body.decode().split("\n", 1)
        yield header, line.rstrip("\n")


def without_appearance(objects):
    for value in objects.values():
        for geometry in value["geometry"]:
            geometry.pop("material", None)
            geometry.pop("texture", None)
        value.pop("address", None)  # its vertices have numbers of their own
    return objects


def compare(path, text, lines):
    if path.suffix == ".jsonl":
        source = sorted(line.strip() for line in text.splitlines()[1:] if line.strip())
        back = sorted(line for _, line in lines)
        return None if source == back else "other lines"
    source = city_models.parse(text)
    expected = without_appearance(city_models.resolved_objects(source, source))
    actual = {}
    for header, line in lines:
        feature = city_models.parse(line)
        actual.update(city_models.resolved_objects(feature, city_models.parse(header)))
    return city_models.difference(expected, without_appearance(actual))


def row(service, number, path):
    text = path.read_text(encoding="utf-8-sig")
    name = f"c{number}"
    kind = "application/city+json-seq" if path.suffix == ".jsonl" else "application/city+json"
    status, body = service.request("POST", f"/collections/{name}/items?invalid=keep", text.encode(), 600,
                                   {"Content-Type": kind})
    if status != 201:
        return f"| {path.name} | {status} {json.loads(body).get('detail', body[:200])} |", True
    found = json.loads(service.request("GET", f"/collections/{name}")[1])
    difference = compare(path, text, list(stored_lines(service, name)))
    cells = [path.name, found["features"], found["solids"],
             found["solids"] - found["unproven"]["solids"], found["unproven"]["solids"],
             found["unproven"]["features"], difference or "equal"]
    return "| " + " | ".join(map(str, cells)) + " |", difference is None


def main():
    print("| file | features | solids | proven | unproven | marked features | back |")
    print("|---|---|---|---|---|---|---|")
    is_well = True
    with temporary_folder("city") as folder, Service(sys.argv[1], folder) as service:
        for number, path in enumerate(map(pathlib.Path, sys.argv[2:])):
            text, is_equal = row(service, number, path)
            print(text, flush=True)
            is_well = is_well and is_equal
    return 0 if is_well else 1


if __name__ == "__main__":
    sys.exit(main())
