#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Counts the bytes that chosen attributes take in PostgreSQL, and times their filling.

    attribute_bytes.py WATERTIGHT FILE...

Each document is stored alone (invalid=keep) in a private database; then one, five and all of its
attributes are chosen, those with the most values first, and their rows repeated for as many other
features as make about 10,000, so that whole pages count little. Prints the bytes a feature of the table of
values and of its indexes after VACUUM, and beside them the sizes of two other designs with the same
values: one row of jsonb a feature with a GIN index (jsonb_path_ops), and one row of typed columns a
feature, each with an index of its own.
"""
import json
import pathlib
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "bench/city"))
from stored_bytes import TYPES, psql  # noqa: E402
from service import Service, temporary_folder  # noqa: E402

SIZE = """SELECT sum(pg_relation_size(c.oid)) FROM pg_class c JOIN pg_namespace n ON n.oid = relnamespace
          WHERE nspname = '{}' AND relkind IN ('r', 'i') AND (relname LIKE '{}%')"""
COPY = """INSERT INTO watertight.attribute_value
    SELECT feature + n, attribute, truth, object, number, text FROM watertight.attribute_value, generate_series(1, {}) n"""
JSONB = """CREATE SCHEMA other; CREATE TABLE other.other AS
    SELECT n.collection, v.feature, jsonb_object_agg(n.name, a.value) AS attributes
    FROM watertight.attribute_value v JOIN watertight.attribute_name n ON n.key = v.attribute
    CROSS JOIN LATERAL (SELECT coalesce(to_jsonb(number), to_jsonb(text), to_jsonb(truth)) AS value) a GROUP BY 1, 2;
  CREATE UNIQUE INDEX other_feature ON other.other (collection, feature);
  CREATE INDEX other_gin ON other.other USING gin (attributes jsonb_path_ops)"""


def command(service, *words):
    return subprocess.run([*service.prefix, "env", f"HOME={service.folder}", service.program, *words, "--data-dir",
                           str(service.folder / "data")], capture_output=True, text=True, check=True,
                          cwd=service.folder).stdout


def bytes_of(service, schema, start):
    psql(service, "VACUUM FULL watertight.attribute_value")
    return int(psql(service, SIZE.format(schema, start)))


def typed_columns(names):
    """A table with a column for each attribute, of the type that most of its values have."""
    columns, indexes = [], []
    for key, number, text in names:
        column = "number" if number >= text else "text"
        columns.append(f"max({column}) FILTER (WHERE attribute = {key}) AS a{key}" if max(number, text) else
                       f"bool_or(truth) FILTER (WHERE attribute = {key}) AS a{key}")
        indexes.append(f"CREATE INDEX other_{key} ON other.other (left(a{key}, 200))" if column == "text" and text else
                       f"CREATE INDEX other_{key} ON other.other (a{key})")
    return ("CREATE SCHEMA other; CREATE TABLE other.other AS SELECT feature, " + ", ".join(columns) +
            " FROM watertight.attribute_value GROUP BY feature;"
            " CREATE UNIQUE INDEX other_feature ON other.other (feature);" + ";".join(indexes))


def other_bytes(service, statements):
    psql(service, statements)
    size = int(psql(service, SIZE.format("other", "other")))
    psql(service, "DROP SCHEMA other CASCADE")
    return size


def measure(service, path):
    status, body = service.request("POST", "/collections/c/items?invalid=keep", path.read_bytes(), 600,
                                   {"Content-Type": TYPES[path.suffix]})
    if status != 201:
        raise SystemExit(f"{path.name}: {status} {body[:300]!r}")
    features = int(psql(service, "SELECT count(*) FROM watertight.feature"))
    empty = bytes_of(service, "watertight", "attribute_")
    found = [json.loads(line) for line in command(service, "collections", "attributes", "c", "--found", "--json")
             .splitlines()]
    counts = {one["name"]: one["numbers"] + one["texts"] + one["truth values"] for one in found}
    names = sorted((name for name in counts if counts[name]), key=lambda name: (-counts[name], name))
    print(f"\n{path.name}: {features} features, {len(names)} attributes, nothing chosen: {empty} bytes\n\n| chosen | values a feature | bytes a"
          " feature | of them indexes | jsonb and GIN | typed columns | filling, ms a feature |\n"
          "|---|---|---|---|---|---|---|")
    for chosen in (names[:1], names[:5], names):
        words = [word for name in chosen for word in ("--add", name)]
        start = time.perf_counter()
        command(service, "collections", "attributes", "c", *words)
        seconds = time.perf_counter() - start
        copies = 10_000 // features
        psql(service, COPY.format(copies))
        whole = bytes_of(service, "watertight", "attribute_") - empty
        heap = int(psql(service, "SELECT pg_relation_size('watertight.attribute_value')"))
        all_features = features * (copies + 1)
        values = int(psql(service, "SELECT count(*) FROM watertight.attribute_value"))
        keys = [line.split() for line in psql(service, """SELECT attribute || ' ' || count(number) || ' ' || count(text)
            FROM watertight.attribute_value GROUP BY attribute ORDER BY attribute""").splitlines()]
        columns = other_bytes(service, typed_columns([tuple(map(int, key)) for key in keys]))
        print(f"| {len(chosen)} | {values / all_features:.1f} | {whole / all_features:.0f} | {(whole - heap) / all_features:.0f}"
              f" | {other_bytes(service, JSONB) / all_features:.0f} | {columns / all_features:.0f}"
              f" | {seconds / features * 1000:.2f} |", flush=True)
        psql(service, "TRUNCATE watertight.attribute_value")
        command(service, "collections", "attributes", "c", *[word for name in chosen for word in ("--remove", name)])


def main():
    for name in sys.argv[2:]:
        with temporary_folder("attribute-bytes") as folder, Service(sys.argv[1], folder) as service:
            measure(service, pathlib.Path(name))


main()
