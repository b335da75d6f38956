#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Chooses attributes of a collection while others write it, and kills program and database at random.

    attributes.py WATERTIGHT ROOT [ROUNDS]

Each round fills in the values of a city while a client replaces, adds and removes features, kills both
in the middle, goes on until the attributes are complete, and then compares the answers by SQL, by HTTP
and by the export with the documents. Prints a line for each round; exit code 1 after a difference.
"""
import json
import os
import pathlib
import random
import signal
import subprocess
import sys
import threading
import time
import urllib.parse

PROGRAM, ROOT = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
ROUNDS = int(sys.argv[3]) if len(sys.argv) > 3 else 1
FEATURES = 2000
sys.path.insert(0, str(ROOT / "tests/siege"))
from service import Service, box_feature, sequence, temporary_folder  # noqa: E402

# Names and values that SQL, URLs or JSON could take for something else.
QUOTED = "it's \"so\" & 100 % über"
NAMES = ["height", QUOTED, "roof.type", "flat", "big"]


def feature(number, height):
    whole = json.loads(box_feature(f"b{number}", number))
    whole["CityObjects"][f"b{number}"]["attributes"] = {
        "height": height, QUOTED: f"{QUOTED} {number % 7}", "roof": {"type": number % 3}, "flat": number % 2 == 0,
        "big": 9007199254740992 + number % 2, "long": "x" * 300}
    return json.dumps(whole, separators=(",", ":"))


class Writer(threading.Thread):
    """Changes features until it is stopped. `heights` has what was acknowledged, `unsure` the numbers of the
    features whose last change was not."""

    def __init__(self, service, heights):
        super().__init__()
        self.service, self.heights, self.unsure, self.is_over, self.writes = service, heights, set(), False, 0

    def run(self):
        while not self.is_over:
            number = random.randrange(FEATURES + 200)
            height = random.randrange(50)
            is_put = random.random() < 0.8
            try:
                if is_put:
                    status, _ = self.service.request("POST", "/collections/town/items",
                                                     sequence([feature(number, height)]), timeout=5)
                else:
                    status, _ = self.service.request("DELETE", f"/collections/town/items/b{number}", timeout=5)
            except OSError:
                status = 0
            if status in (201, 204, 404):
                self.unsure.discard(number)
                self.heights.pop(number, None)
                if is_put:
                    self.heights[number] = height
                self.writes += 1
            else:
                self.unsure.add(number)
                time.sleep(0.02)


def ids_by_http(service, query):
    path, ids = f"/collections/town/items?limit=1000&{query}", set()
    while path:
        status, body = service.request("GET", path)
        if status != 200:
            raise SystemExit(f"{path}: {status} {body[:500]!r}")
        page = json.loads(body)
        ids |= {item["id"] for item in page["features"]}
        path = next((link["href"] for link in page["links"] if link["rel"] == "next"), None)
    return ids


def exported(service, *conditions):
    """The ids of the features that an export with conditions has."""
    words = [word for condition in conditions for word in ("--where", condition)]
    output = service.folder / "out.city.jsonl"
    service.run("export", "town", "-o", str(output), *words)
    return {json.loads(line)["id"] for line in output.read_text().splitlines()[1:]}


def check(service, heights, unsure):
    """Compares all answers with the documents of the service, and those with what was acknowledged."""
    service.run("export", "town", "-o", str(service.folder / "all.city.jsonl"))
    stored = {}
    for line in (service.folder / "all.city.jsonl").read_text().splitlines()[1:]:
        one = json.loads(line)
        stored[one["id"]] = one["CityObjects"][one["id"]]["attributes"]
    for number in set(range(FEATURES + 200)) - unsure:
        found = stored.get(f"b{number}", {}).get("height")
        if found != heights.get(number):
            raise SystemExit(f"b{number} has height {found}, acknowledged was {heights.get(number)}")
    rows = json.loads(service.ask("""SELECT json_agg(json_build_array(feature, object, name, value))
                                       FROM watertight.attribute WHERE collection = 'town'"""))
    by_sql = {(identity, name): value for identity, of, name, value in rows if identity == of}
    expected = {(identity, name): values["roof"]["type"] if name == "roof.type" else values[name]
                for identity, values in stored.items() for name in NAMES}
    if by_sql != expected or len(rows) != len(expected):
        wrong = [key for key in by_sql.keys() | expected.keys() if by_sql.get(key) != expected.get(key)]
        raise SystemExit(f"{len(wrong)} values of {len(expected)} differ: {wrong[:5]}; {len(rows)} rows")
    if service.ask("SELECT count(*) FROM watertight.attribute_value") != str(len(rows)):
        raise SystemExit("there are values that belong to no feature")
    chosen = {identity for identity, values in stored.items() if values["height"] == 7 and not values["flat"]}
    for found in (ids_by_http(service, "height=7&flat=false"), exported(service, "height=7", "flat=false")):
        if found != chosen:
            raise SystemExit(f"found {len(found)} features of {len(chosen)}")
    quoted = {identity for identity, values in stored.items() if values[QUOTED].endswith("3")}
    if ids_by_http(service, urllib.parse.urlencode({QUOTED: QUOTED + " 3"})) != quoted:
        raise SystemExit("the quoted attribute finds others")
    big = service.ask("SELECT count(*) FROM watertight.attribute WHERE collection = 'town' AND name = 'big'"
                        " AND number = 9007199254740993")
    if int(big) != sum(values["big"] == 9007199254740993 for values in stored.values()):
        raise SystemExit("whole numbers were rounded")
    return len(stored)


def one_round(number):
    with temporary_folder("attributes") as folder, Service(PROGRAM, folder) as service:
        heights = {n: n % 50 for n in range(FEATURES)}
        for start in range(0, FEATURES, 250):
            service.post("town", sequence(feature(n, heights[n]) for n in range(start, start + 250)))
        if service.request("GET", "/collections/town/items?height=7")[0] != 400:
            raise SystemExit("an attribute that is not chosen was queried")
        names = [word for name in NAMES for word in ("--add", name)]
        writer = Writer(service, heights)
        writer.start()
        kills = 0
        while True:
            filling = service.command("collections", "attributes", "town", *names)
            try:
                filling.communicate(timeout=random.uniform(0.1, 0.5 + kills))
                if filling.returncode == 0 and kills > 0:
                    break
                if filling.returncode == 0:  # too early for a kill
                    service.run("collections", "attributes", "town",
                        *[word for name in NAMES for word in ("--remove", name)])
                    continue
            except subprocess.TimeoutExpired:
                filling.kill()
                filling.communicate()
            kills += 1
            if kills % 2 == 1:  # with the database, which the service starts again
                for pid in service.database_processes():
                    try:
                        os.kill(pid, signal.SIGKILL)
                    except ProcessLookupError:
                        pass
            if kills > 40:
                raise SystemExit("the filling does not end")
        writer.is_over = True
        writer.join()
        for _ in range(100):
            if service.request("GET", "/readyz")[0] == 200:
                break
            time.sleep(0.1)
        count = check(service, heights, writer.unsure)
        found = service.run("collections", "attributes", "town", "--found")
        if f"long: {count} texts" not in found or f"flat: {count} truth values" not in found:
            raise SystemExit(f"other attributes were found:\n{found}")
        service.run("collections", "attributes", "town", "--remove", "height")
        error = service.run("export", "town", "-o", str(folder / "none.wt"), "--where", "height=7", code=2)
        if "'height'" not in error or service.ask("SELECT count(*) FROM watertight.attribute_value") != str(4 * count):
            raise SystemExit(f"a removed attribute is still there: {error}")
        status, body = service.request("PUT", "/collections/town/attributes", b'{"attributes":["flat","roof.type"]}',
                                       headers={"Content-Type": "application/json"})
        if status != 200 or [one["name"] for one in json.loads(body)["attributes"]] != ["flat", "roof.type"]:
            raise SystemExit(f"PUT of attributes: {status} {body[:500]!r}")
        print(f"round {number}: {count} features, {kills} kills, {writer.writes} writes meanwhile,"
              f" {len(writer.unsure)} unanswered", flush=True)
        service.stop()


for at in range(ROUNDS):
    one_round(at + 1)
