#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compressed files, archives, folders and a CityJSONFeature alone, through the command line and the service.

    inputs.py WATERTIGHT

Makes its archives with Python's gzip and zipfile and with the program zstd, which share no code with
the program under test, and compares what comes back from files and from a store with what went in.
"""
import gzip
import json
import os
import pathlib
import subprocess
import sys
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path += [str(ROOT / "tests/siege")]
import service as town  # noqa: E402

SEQUENCE = "application/city+json-seq"


def zstd(data):
    return subprocess.run(["zstd", "-q", "-c"], input=data, capture_output=True, check=True).stdout


class Checks:
    def __init__(self, program, folder):
        self.program = os.path.abspath(program)
        self.folder = folder
        self.failures = []

    def run(self, *words, status=0, says="", stdin=None):
        done = subprocess.run([self.program, *map(str, words)], cwd=self.folder, input=stdin, capture_output=True)
        text = (done.stdout + done.stderr).decode(errors="replace")
        if done.returncode != status or says not in text:
            self.failures.append(f"{' '.join(map(str, words))}: status {done.returncode}, not {status}, "
                                 f"or without '{says}':\n{text[:600]}")
        return done.stdout

    def equal(self, what, actual, expected):
        if actual != expected:
            self.failures.append(f"{what}: {str(actual)[:300]!r} instead of {str(expected)[:300]!r}")


def files(checks):
    """Documents in compressed files, archives and folders are the documents themselves."""
    folder = checks.folder
    texts = {f"town{n}.city.jsonl": town.box_document(3 + n, f"t{n}_") for n in range(3)}
    (folder / "plain/sub").mkdir(parents=True)
    packed = folder / "packed"
    packed.mkdir()
    places = ["plain/{}", "plain/sub/{}", "plain/{}"]
    for place, (name, text) in zip(places, texts.items()):
        (folder / place.format(name)).write_bytes(text)
    (folder / "plain/readme.txt").write_text("no document")
    with zipfile.ZipFile(folder / "town.zip", "w", zipfile.ZIP_DEFLATED) as archive:
        for path in sorted((folder / "plain").rglob("*")):
            archive.write(path, path.relative_to(folder))
    first, second, third = texts
    (packed / (first + ".gz")).write_bytes(gzip.compress(texts[first]))
    (packed / (second + ".zst")).write_bytes(zstd(texts[second]))
    (packed / third).write_bytes(texts[third])
    for source in ("plain", "town.zip", "packed"):
        says = "All 12 features with solids are valid."
        checks.run("validate", source, "--report", f"{source}.json", "--no-times", says=says)
    names = [json.loads(line).get("input_file") or line[:80]
             for line in (folder / "town.zip.json").read_text().splitlines()]
    checks.equal("documents of the report", len(names), 3)
    checks.run("encode", "town.zip", "-o", "out/")
    checks.run("encode", "packed", "-o", "out/packed/")
    outputs = {"town.zip/plain/" + first: first, "town.zip/plain/sub/" + second: second,
               "packed/" + first + ".gz": first, "packed/" + second + ".zst": second}
    for output, name in outputs.items():
        back = checks.run("decode", f"out/{output}.wt", "-o", "-")
        checks.equal(output, back, texts[name])
    checks.run("validate", "town.zip", "nothing.obj", "packed", status=2, says="nothing.obj")
    checks.run("convert", "town.zip", "-o", "x.obj", status=2, says="reads one document")
    checks.run("validate", "-", stdin=gzip.compress(texts[first]))
    for size in range(0, 60, 7):
        (folder / "cut.city.jsonl.gz").write_bytes(gzip.compress(texts[first])[:size + 11])
        checks.run("validate", "cut.city.jsonl.gz", status=2, says="malformed: gzip: the data end too early")


def bodies(checks, service):
    """A compressed body is stored as the body that it expands to."""
    text = town.box_document(5)
    for number, (coding, pack) in enumerate({"gzip": gzip.compress, "zstd": zstd}.items()):
        headers = {"Content-Type": SEQUENCE, "Content-Encoding": coding}
        path = f"/collections/c{number}/items"
        checks.equal(coding, service.request("POST", path, pack(text), 60, headers)[0], 201)
        back = service.request("GET", f"/collections/c{number}/export?f=cityjsonseq")[1]
        checks.equal(coding, sorted(back.splitlines()), sorted(text.splitlines()))
        checks.equal("report", service.request("POST", "/validate", pack(text), 60, headers)[0], 200)
        large = town.box_document(2000)
        checks.equal("large", service.request("POST", "/validate", pack(large), 120, headers)[0], 200)
        status, body = service.request("POST", path, pack(text)[:-3], 60, headers)
        checks.equal("cut", (status, "byteOffset" in json.loads(body)), (400, True))
        status, body = service.request("POST", path, pack(b" " * (257 << 20)), 60, headers)
        checks.equal("bomb", (status, "expands to more than 268435456 bytes" in json.loads(body)["detail"]),
                     (413, True))
        status, body = service.request("POST", path, pack(b'{"type":"CityJSON"' + b" " * (120 << 20)), 60,
                                       {"Content-Type": "application/city+json", "Content-Encoding": coding})
        checks.equal("document in memory", status, 413)
        patch = {"Content-Type": "application/json", "Content-Encoding": coding}
        status, _ = service.request("PATCH", f"/collections/c{number}", pack(b'{"invalid":"keep"}'), 60, patch)
        checks.equal("patch", status, 200)
    status, _ = service.request("POST", "/validate", b"x", 60, {"Content-Type": SEQUENCE, "Content-Encoding": "br"})
    checks.equal("other coding", status, 415)


def features(checks, service):
    """A CityJSONFeature alone goes to a collection that has a header, over HTTP and by ingest."""
    pretty = {name: json.dumps(json.loads(town.box_feature(name, 7)), indent=2) for name in ("p", "q")}
    (checks.folder / "q.city.jsonl").write_text(pretty["q"])
    checks.run("validate", "q.city.jsonl", status=1, says="a CityJSONFeature alone has no transform")
    path = "/collections/alone/items"
    checks.equal("without header", service.request("POST", path, pretty["p"].encode())[0], 400)
    store = [*service.prefix, checks.program, "ingest", str(checks.folder / "q.city.jsonl"), "--collection", "alone",
             "--data-dir", str(service.folder / "data"), "-q"]
    done = subprocess.run(store, capture_output=True, cwd=service.folder)
    checks.equal("ingest without header", done.returncode, 1)
    service.post("alone", town.box_document(1))
    for kind in (SEQUENCE, "application/city+json"):
        status, _ = service.request("POST", path, pretty["p"].encode(), 60, {"Content-Type": kind})
        checks.equal("with header, as " + kind, status, 201)
    done = subprocess.run(store, capture_output=True, cwd=service.folder)
    checks.equal("ingest: " + done.stderr.decode(), done.returncode, 0)
    for name, text in pretty.items():
        status, body = service.request("GET", f"{path}/{name}?f=cityjsonseq")
        line = body.decode().split("\n", 1)[1].rstrip("\n")
        checks.equal(name, line, text.replace("\n", " "))


def archives(checks, service):
    """The documents of an archive are stored one by one, and a bad one stops no other."""
    with zipfile.ZipFile(checks.folder / "many.zip", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("b.city.jsonl", town.box_document(4, "b"))
        archive.writestr("a.city.jsonl", "{}")
        archive.writestr("c.city.jsonl", town.box_document(4, "c"))
    done = subprocess.run([*service.prefix, checks.program, "ingest", str(checks.folder / "many.zip"), "--collection",
                           "many", "--data-dir", str(service.folder / "data"), "-q"],
                          capture_output=True, cwd=service.folder)
    checks.equal("ingest of an archive: " + done.stderr.decode(), done.returncode, 2)
    checks.equal("the bad member is named", b"many.zip/a.city.jsonl" in done.stderr, True)
    found = json.loads(service.request("GET", "/collections/many")[1])
    checks.equal("features of the archive", found["features"], 8)


def main():
    with town.temporary_folder("inputs") as folder:
        (folder / "service").mkdir()
        checks = Checks(sys.argv[1], folder)
        files(checks)
        with town.Service(sys.argv[1], folder / "service") as service:
            bodies(checks, service)
            features(checks, service)
            archives(checks, service)
    print("\n".join(checks.failures) or "all inputs are what they hold")
    return 1 if checks.failures else 0


if __name__ == "__main__":
    sys.exit(main())
