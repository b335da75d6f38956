#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sends every document through a running service and back: every_document.py WATERTIGHT FILE_OR_FOLDER...

Each document that the service reads comes back byte for byte from its Watertight file (POST /encode and /decode,
what is not valid is kept), and each sequence also from a collection that it was stored in, where it holds each id
once. What the service cannot read is refused with a reason; it may not refuse what Python reads as a city model.
Exit code 1 after a difference.
"""
import json
import pathlib
import sys
import xml.etree.ElementTree

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/siege"))
from checks import check, failures  # noqa: E402
from service import Service, temporary_folder  # noqa: E402

BY_CONTENT = {"Content-Type": "application/octet-stream"}
SECONDS = 600


def documents(names):
    for name in names:
        path = pathlib.Path(name)
        yield from sorted(p for p in path.rglob("*") if p.is_file()) if path.is_dir() else [path]


def is_city_model(path, text):
    """Whether Python reads a document as JSON whose parts are CityJSON, or as XML."""
    try:
        if path.suffix == ".gml":
            xml.etree.ElementTree.fromstring(text)
            return True
        if path.suffix not in (".json", ".jsonl"):
            return False
        parts = [json.loads(line) for line in text.splitlines()] if path.suffix == ".jsonl" else [json.loads(text)]
        return all(str(part.get("type")).startswith("CityJSON") for part in parts)
    except (ValueError, xml.etree.ElementTree.ParseError):
        return False


def comes_back(service, path, text):
    """Whether a document is read and comes back from a Watertight file; None if it is refused with a reason."""
    status, packed = service.request("POST", "/encode?invalid=keep", text, SECONDS, BY_CONTENT)
    if status != 200:
        problem = json.loads(packed)
        is_right = 400 <= status < 500 and problem["detail"] and not is_city_model(path, text)
        check(is_right, f"{path}: is refused: {problem.get('detail')}")
        return None
    status, back = service.request("POST", "/decode", packed, SECONDS, BY_CONTENT)
    check(status == 200 and back == text, f"{path}: {len(text)} bytes come back from {len(packed)}")
    return status == 200


def comes_back_from_collection(service, path, text, collection):
    """Whether a sequence comes back from a collection; not if a document of its kind cannot be a collection."""
    status, answer = service.request("POST", f"/collections/{collection}/items?invalid=keep", text, SECONDS)
    if status != 201:
        check(status in (400, 422) and json.loads(answer)["detail"], f"{path}: is not stored: {json.loads(answer).get('detail')}")
        return False
    status, back = service.request("GET", f"/collections/{collection}/export?f=cityjsonseq", None, SECONDS, {})
    if status == 406:  # features of a header without transform
        check("transform" not in json.loads(text.splitlines()[0]), f"{path}: is no sequence: {json.loads(back)['detail']}")
        return False
    header, *lines = back.splitlines()
    sent, *features = text.splitlines()
    check(header == sent and sorted(lines) == sorted(features), f"{path}: its lines come back from a collection")
    return True


def main():
    program, names = sys.argv[1], sys.argv[2:]
    read, refused, stored = [], [], []
    with temporary_folder("documents") as folder, Service(program, folder) as service:
        for number, path in enumerate(documents(names)):
            text = path.read_bytes()
            (read if comes_back(service, path, text) else refused).append(path)
            if path.name.endswith(".jsonl") and comes_back_from_collection(service, path, text, f"c{number}"):
                stored.append(path)
    check(read and stored, f"{len(read)} documents come back, {len(stored)} also from a collection; {len(refused)} are refused")
    sys.exit(1 if failures else 0)


main()
