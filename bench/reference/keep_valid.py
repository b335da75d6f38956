#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""keep_valid.py REPORT FILE OUT: a CityJSON or CityJSONSeq without the geometries that are not valid.

REPORT is what `watertight validate --report` says of FILE. What is left is valid, so that the valid
solids of a feature can go through document, store and back although a neighbour in their feature is
broken. Vertices that only the removed geometries used stay, as nothing refers to them.
"""
import json
import sys


def refused(report):
    """The object and the index of each geometry with a solid that is not valid."""
    outcome = json.load(open(report, encoding="utf-8"))["files"][0]["outcome"]
    return {(solid["object"], solid["geometry"])
            for feature in outcome["features"] for solid in feature["solids"]
            if solid["report"]["verdict"] != "valid"}


def main():
    report, source, target = sys.argv[1:4]
    removed = refused(report)
    texts = open(source, encoding="utf-8").read()
    documents = texts.splitlines() if source.endswith(".jsonl") else [texts]
    with open(target, "w", encoding="utf-8") as out:
        for document in map(json.loads, documents):
            for name, item in document.get("CityObjects", {}).items():
                if "geometry" in item:
                    item["geometry"] = [geometry for index, geometry in enumerate(item["geometry"])
                                        if (name, index) not in removed]
            out.write(json.dumps(document, ensure_ascii=False) + "\n")


if __name__ == "__main__":
    main()
