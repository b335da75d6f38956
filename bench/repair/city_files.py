#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Repairs files of cities, and checks what became of them.

    city_files.py PROGRAM FILE...

For each file: the solids, those that are invalid, those that were repaired; whether the solids that
were valid are the same, position by position, in the document that was written; whether a second
repair changes no byte; the seconds of `validate` and of `repair` (two threads). Exits with 1 if a
solid or a byte changed that should not. All remedies, weld 0.01 m.
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import time

REMEDIES = ["--remedies", "all", "--weld", "0.01", "-q", "-j", "2"]


def run(*arguments):
    """Seconds of a command; its status may say that solids are invalid."""
    start = time.monotonic()
    done = subprocess.run([str(a) for a in arguments], capture_output=True, text=True)
    if done.returncode not in (0, 1, 3):
        sys.exit(f"{' '.join(map(str, arguments))}: {done.stderr}")
    return time.monotonic() - start


def city_objects(text):
    """The city objects of a CityJSON or a CityJSONSeq, each with its document's vertices."""
    try:
        documents = [json.loads(text)]
    except json.JSONDecodeError:
        documents = [json.loads(line) for line in text.splitlines() if line.strip()]
    for document in documents:
        for name, thing in document.get("CityObjects", {}).items():
            yield name, thing, document.get("vertices", [])


def solids(path, program, folder):
    """(object, geometry, solid) -> shells of facets of rings of integer positions."""
    if path.suffix in (".gml", ".xml"):
        city = folder / (path.name + ".city.json")
        run(program, "convert", path, "-o", city)
        path = city
    found = {}
    for name, thing, vertices in city_objects(path.read_text(encoding="utf-8-sig")):
        for number, geometry in enumerate(thing.get("geometry", [])):
            kind = geometry["type"]
            if kind not in ("Solid", "MultiSolid", "CompositeSolid"):
                continue
            members = [geometry["boundaries"]] if kind == "Solid" else geometry["boundaries"]
            for ordinal, shells in enumerate(members):
                found[name, number, ordinal] = [
                    [[[tuple(vertices[v]) for v in ring] for ring in facet] for facet in shell]
                    for shell in shells]
    return found


def repaired_keys(report):
    """The solids that a report says something of."""
    keys = {}
    for line in report.read_text().splitlines():
        for feature in json.loads(line)["features"]:
            for primitive in feature["primitives"]:
                if "repair" not in primitive:
                    continue
                place = dict(part.split("=", 1) for part in primitive["id"].split("|"))
                key = primitive["object"], int(place["geom"]), int(place["solid"])
                keys[key] = primitive["repair"]["outcome"] == "repaired"
    return keys


def main():
    program = sys.argv[1]
    sums = dict.fromkeys(("solids", "invalid", "repaired", "validate", "repair"), 0)
    is_wrong = False
    print(f"{'file':<40} {'solids':>7} {'invalid':>7} {'repaired':>8} {'kept':>6} "
          f"{'again':>6} {'validate':>8} {'repair':>7}")
    for name in sys.argv[2:]:
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            source = pathlib.Path(name)
            out = folder / source.name
            again = folder / ("again-" + source.name)
            report = folder / "report.json"
            validated = run(program, "validate", "-q", "-j", "2", source)
            repaired = run(program, "repair", source, "-o", out, *REMEDIES)
            run(program, "repair", source, "-o", again, *REMEDIES, "--report", report)
            if again.read_bytes() != out.read_bytes():
                sys.exit(f"{name}: two repairs differ")
            run(program, "repair", out, "-o", again, *REMEDIES)
            is_stable = again.read_bytes() == out.read_bytes()
            keys = repaired_keys(report)
            before = solids(source, program, folder)
            after = solids(out, program, folder)
            kept = before.keys() == after.keys() and all(
                before[key] == after[key] for key in before if not keys.get(key, False))
            mended = sum(keys.values())
            print(f"{source.name:<40} {len(before):>7} {len(keys):>7} {mended:>8} "
                  f"{'yes' if kept else 'NO':>6} {'same' if is_stable else 'OTHER':>6} "
                  f"{validated:>8.2f} {repaired:>7.2f}", flush=True)
            is_wrong = is_wrong or not kept or not is_stable
            for key, value in zip(sums, (len(before), len(keys), mended, validated, repaired)):
                sums[key] += value
    print(f"{'all':<40} {sums['solids']:>7} {sums['invalid']:>7} {sums['repaired']:>8} "
          f"{'':>6} {'':>6} {sums['validate']:>8.2f} {sums['repair']:>7.2f}")
    sys.exit(1 if is_wrong else 0)


if __name__ == "__main__":
    main()
