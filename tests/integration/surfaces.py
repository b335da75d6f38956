#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Solids that are written as surfaces are judged, coded and converted like the solids.

    surfaces.py WATERTIGHT SEQUENCE

Writes each Solid of one shell in SEQUENCE as a MultiSurface, and as one that lacks a facet. Requires
that `--surfaces as-solids` gives each of the first the verdict and the codes of the solid, that
`encode` and `decode` give the very bytes back, that `convert` brings the solids back, and that
without a facet no surface is taken for a solid. Exit code 1 after a violation.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

PROGRAM = sys.argv[1]


def run(*arguments):
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)
    if done.returncode not in (0, 1, 3):
        raise SystemExit(f"{arguments}: {done.stderr}")
    return done


def report(path, *options):
    out = path.with_name("report.json")
    run("validate", "-q", "--no-times", path, "--report", out, *options)
    return json.loads(out.read_text())


def values(geometry):
    """The members with lists of values by facet."""
    for name in ("semantics", "material", "texture"):
        member = geometry.get(name, {})
        yield from [member] if name == "semantics" else member.values()


def as_surfaces(lines, facets_left_out):
    """The lines with a MultiSurface for each Solid; and the number of surfaces."""
    count = 0
    written = [lines[0]]
    for line in lines[1:]:
        feature = json.loads(line)
        for thing in feature["CityObjects"].values():
            for geometry in thing.get("geometry", []):
                if geometry["type"] != "Solid" or len(geometry["boundaries"]) != 1:
                    continue
                geometry["type"] = "MultiSurface"
                geometry["boundaries"] = geometry["boundaries"][0][facets_left_out:]
                for owner in values(geometry):
                    if "values" in owner:
                        owner["values"] = owner["values"][0][facets_left_out:]
                count += 1
        written.append(json.dumps(feature, separators=(",", ":")))
    return "\n".join(written) + "\n", count


def judged(features, names=("Solid", "MultiSurface")):
    """Verdict and codes of each solid that has a verdict of its own."""
    found = {}
    for feature in features:
        for number, primitive in enumerate(feature["primitives"]):
            if primitive["type"] not in names or "surface" in primitive:
                continue
            codes = sorted(error["code"] for error in feature["errors"]
                           if error["place"].get("solid") == number)
            place = (primitive["object"], primitive.get("lod"), primitive["id"])
            found[place] = (primitive["verdict"], codes)
    return found


def main():
    lines = pathlib.Path(sys.argv[2]).read_text().splitlines()
    failures = []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        solid = folder / "solid.city.jsonl"
        solid.write_text("\n".join(lines) + "\n")
        surface = folder / "surface.city.jsonl"
        text, count = as_surfaces(lines, 0)
        surface.write_text(text)
        truth = judged(report(solid)["features"])
        closed = {place: verdict for place, verdict in truth.items()
                  if not {302, 303, 305} & set(verdict[1])}
        taken = judged(report(surface, "--surfaces", "as-solids")["features"])
        if count == 0 or not closed:
            failures.append("there is no solid of one shell")
        failures += [f"{place}: {taken.get(place)}, as a solid {verdict}"
                     for place, verdict in closed.items() if taken.get(place) != verdict]
        checked = report(surface)
        if checked["surfaces"]["checked"] < count or checked["primitives_overview"]:
            failures.append(f"checked as surfaces: {checked['surfaces']}")
        valid = sum(verdict == "valid" for verdict, _ in truth.values())
        if checked["surfaces"]["closed_valid"] < valid:
            failures.append(f"{valid} valid solids, but {checked['surfaces']}")

        coded, back = folder / "coded.wt", folder / "back.city.jsonl"
        run("encode", "--surfaces", "as-solids", surface, "-o", coded)
        run("decode", coded, "-o", back)
        if back.read_bytes() != surface.read_bytes():
            failures.append("other bytes after encode and decode")
        info = json.loads(run("info", coded, "--json").stdout)
        if info["solids"] < len(taken):
            failures.append(f"{info['solids']} solids are coded, {len(taken)} were judged")

        converted = folder / "converted.city.jsonl"
        run("convert", "--surfaces", "as-solids", surface, "-o", converted)
        again = judged(report(converted)["features"])
        failures += [f"{place}: converted {again.get(place)}, as a solid {verdict}"
                     for place, verdict in closed.items() if again.get(place) != verdict]

        opened = folder / "opened.city.jsonl"
        opened.write_text(as_surfaces(lines, 1)[0])
        if judged(report(opened, "--surfaces", "as-solids")["features"], ("MultiSurface",)):
            failures.append("a surface without a facet is taken for a solid")
    print("\n".join(failures[:20]) or f"{count} surfaces, {len(closed)} closed, as the solids")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
