#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Breaks a city model in one place after the other; all else must be judged and kept.

    half_broken.py WATERTIGHT SEQUENCE [--places N] [--seed S]

The CityJSON of the first features of SEQUENCE gets one fault: an index that is out of range, no
number or in the wrong depth, a geometry without type, an instance of no template, a texture that is
none, a child that is missing, an object that is its own parent, an object that is none. Requires
that `validate` gives all other features the verdicts that they have without the fault, and that
`encode` and `decode` give the very bytes back. Prints the number of places; exit code 1 after a
violation, with the fault.
"""
import argparse
import copy
import json
import pathlib
import random
import subprocess
import sys
import tempfile


def run(program, *arguments):
    return subprocess.run([program, *map(str, arguments)], capture_output=True, text=True)


def city_of(program, sequence, features, folder):
    """The first features of a sequence as one CityJSON."""
    part = folder / "part.city.jsonl"
    part.write_text("".join(sequence.read_text().splitlines(True)[:features + 1]))
    city = folder / "part.city.json"
    done = run(program, "convert", part, "-o", city)
    if done.returncode != 0:
        raise SystemExit(done.stderr)
    return json.loads(city.read_text())


def rings(boundaries):
    """The innermost arrays, which hold indices."""
    if boundaries and not isinstance(boundaries[0], list):
        yield boundaries
        return
    for part in boundaries:
        yield from rings(part)


def break_index(value, chance):
    ring = chance.choice(list(rings(chance.choice(value["geometry"])["boundaries"])))
    ring[chance.randrange(len(ring))] = chance.choice([10 ** 7, 2 ** 32 - 1, 2 ** 60, -1, 1.5, "7", None, [3], {}])


def break_depth(value, chance):
    geometry = chance.choice(value["geometry"])
    geometry["boundaries"] = chance.choice([[geometry["boundaries"]], geometry["boundaries"][0], "text", None, [[1]]])


def break_type(value, chance):
    del chance.choice(value["geometry"])["type"]


def add_instance(value, chance):
    value["geometry"].append({"type": "GeometryInstance", "template": chance.choice([0, 99, "0"]),
                              "boundaries": [0], "transformationMatrix": [1, 0, 0, 0] * 4})


def add_texture(value, chance):
    values = [[[[chance.choice([0, 7, "a"]), 0, 1, 2]]]]
    chance.choice(value["geometry"])["texture"] = {"theme": {"values": values}}


def add_child(value, chance):
    value.setdefault("children", []).append(chance.choice(["nobody", 7]))


def break_attributes(value, chance):
    value["attributes"] = chance.choice([5, "text", [], None])


FAULTS = [break_index, break_index, break_depth, break_type, add_instance, add_texture, add_child,
          break_attributes]


def verdicts(program, path, folder):
    """The verdict of each feature, or the reason why there are none."""
    report = folder / "report.json"
    report.unlink(missing_ok=True)
    done = run(program, "validate", path, "--report", report, "--no-times", "-q")
    if done.returncode not in (0, 1, 3) or not report.exists():
        return done.stderr
    return {feature["id"]: feature["validity"] for feature in json.loads(report.read_text())["features"]}


def violation(program, city, owner, expected, folder):
    """What is wrong with the treatment of a city with a fault in the feature `owner`, or None."""
    broken = folder / "broken.city.json"
    broken.write_text(json.dumps(city))
    found = verdicts(program, broken, folder)
    if isinstance(found, str):
        return f"refused: {found}"
    for name, is_valid in expected.items():
        if name != owner and found.get(name) != is_valid:
            return f"feature {name}: {is_valid} became {found.get(name)}"
    packed = folder / "broken.wt"
    packed.unlink(missing_ok=True)
    encoded = run(program, "encode", broken, "-o", packed)
    if encoded.returncode == 2:
        return f"not encoded: {encoded.stderr}"
    back = folder / "back.city.json"
    decoded = run(program, "decode", packed, "-o", back)
    if decoded.returncode != 0 or back.read_bytes() != broken.read_bytes():
        return f"other bytes came back: {decoded.stderr}"
    return None


def root_of(city, name):
    parents = city["CityObjects"][name].get("parents")
    return root_of(city, parents[0]) if parents else name


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("sequence", type=pathlib.Path)
    parser.add_argument("--places", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    chance = random.Random(options.seed)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        city = city_of(options.program, options.sequence, 12, folder)
        expected = verdicts(options.program, folder / "part.city.json", folder)
        candidates = [key for key, value in city["CityObjects"].items()
                      if any(geometry.get("boundaries") for geometry in value.get("geometry", []))]
        assert len(expected) == 12 and candidates
        for place in range(options.places):
            fault = FAULTS[place % len(FAULTS)]
            target = chance.choice(candidates)
            broken = copy.deepcopy(city)
            fault(broken["CityObjects"][target], chance)
            wrong = violation(options.program, broken, root_of(city, target), expected, folder)
            if wrong:
                print(f"{fault.__name__} in {target}, place {place}: {wrong}")
                return 1
    print(f"{options.places} places: all else was judged and kept")
    return 0


if __name__ == "__main__":
    sys.exit(main())
