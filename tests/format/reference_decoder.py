#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads blobs, pages and page files of format version 1: as docs/format*.md describes it.

  reference_decoder.py MODELS FILE...          prints the solids as JSON
  reference_decoder.py MODELS --check FOLDER   reads the golden files of a folder

MODELS is the folder with the files of priors. The standard library is all that is needed. It is
slow (seconds for a hundred vertices): made to be read and to check others.
"""
import csv
import json
import pathlib
import sys

from entropy import LimitExceeded, Malformed, Unsupported
from page import BLOB, FILE_MAGIC, PAGE, read_page, read_page_file

CODES = {Malformed: "malformed", Unsupported: "unsupported", LimitExceeded: "limit-exceeded"}
ERRORS = tuple(CODES)
PAGE_FILE = "page file"
KINDS = {".blob": BLOB, ".page": PAGE, ".wtpf": PAGE_FILE}
LEAST_GOLDENS = 51


def as_json(page):
    """The content of a page as JSON values, its solids in canonical form."""
    frame = page.frame
    return {"tolerances": frame.tolerances, "proof": ["tetrahedralization", "boundary"][frame.proof],
            "rule_set": frame.rule_set, "srid": frame.srid,
            "lattice": ["decimal", "binary", "float64"][frame.kind], "steps": frame.steps,
            "solids": [{"mode": name, "origin": origin, "vertices": solid.vertices,
                        "shells": solid.shells, "order": order, "checksum": f"{checksum:08x}"}
                       for name, (solid, origin, order), checksum in
                       zip(page.names, page.solids, page.checksums)]}


def pages_of(models, data, kind):
    """The pages in data of the given kind."""
    if kind == PAGE_FILE:
        return read_page_file(models, data)[0]
    return [read_page(models, data, kind)]


def kind_of(data):
    """The kind that the first bytes of the data indicate."""
    if data[:4] == FILE_MAGIC:
        return PAGE_FILE
    return PAGE if data[2:3] == bytes([PAGE]) else BLOB


def main(arguments):
    """Decodes files, or checks a folder of golden files."""
    models = pathlib.Path(arguments[0])
    if arguments[1] == "--check":
        return check(models, pathlib.Path(arguments[2]))
    for name in arguments[1:]:
        data = pathlib.Path(name).read_bytes()
        for page in pages_of(models, data, kind_of(data)):
            print(json.dumps(as_json(page)))
    return 0


def check(models, folder):
    """Reads the golden files of a folder, and checks that malformed data is refused with the stated
    errors."""
    wrong, found = 0, 0
    for path in sorted(path for path in folder.iterdir() if path.suffix in KINDS):
        found += 1
        try:
            pages = pages_of(models, path.read_bytes(), KINDS[path.suffix])
            sums = [f"{name} {checksum:08x}" for page in pages
                    for name, checksum in zip(page.names, page.checksums)]
            print(f"{path.name}: {', '.join(sums)}")
        except ERRORS as error:
            print(f"FAILED: {path.name}: {CODES[type(error)]}: {error}")
            wrong += 1
    wrong += check_refused(models, folder / "refused.csv")
    print(f"{found} golden files, {wrong} otherwise than stated")
    return 1 if wrong or found < LEAST_GOLDENS else 0


def check_refused(models, path):
    """Checks that data which no encoder writes is refused with its error."""
    wrong = 0
    with path.open(newline="", encoding="ascii") as file:
        for row in csv.DictReader(file):
            try:
                pages_of(models, bytes.fromhex(row["bytes"]), KINDS["." + row["kind"]])
                found, reason = "no error", ""
            except ERRORS as error:
                found, reason = CODES[type(error)], str(error)
            print(f"{row['name']}: {found}: {reason}")
            if found != row["error"]:
                print(f"FAILED: {row['name']}; expected: {row['error']}")
                wrong += 1
    return wrong


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
