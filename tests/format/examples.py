#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The worked examples and the table of model files of the specification, and the traces of golden files.

  examples.py MODELS GOLDENS DOCUMENTS           checks that they are up to date
  examples.py MODELS GOLDENS DOCUMENTS --write   writes them

DOCUMENTS is the folder of format.md and format-plain.md.

A trace lists what a decoder reads, item by item: what it is, its value, and the decisions that say
so, each as its bit and the p it was read with. All files traced have the neutral set of priors, so
that they never change.
"""
import itertools
import pathlib
import sys

from entropy import crc32c
from page import BLOB, PAGE, Page
from sections import Section

TRACED = ["box-neutral.blob", "box-walk-neutral.blob", "schoenhardt-parallelogram-neutral.blob",
          "houses-neutral.page"]
# the number of items shown of each file
EXAMPLES = {"box-neutral.blob": 44, "houses-neutral.page": 24}
SECTIONS = "box-bitmap.blob"  # the file whose sections are shown
BYTES_IN_ROW = 8


def read(models, path):
    """The page in a file, with its trace."""
    page = Page(models, path.read_bytes(), PAGE if path.suffix == ".page" else BLOB)
    page.read()
    return page


def decisions(bits):
    """The decisions of one item as text: consecutive bits that have one p are joined."""
    parts = []
    for p, group in itertools.groupby(bits, key=lambda bit: bit[1]):
        parts.append(" ".join(str(bit) for bit, _ in group) + f" @ {p}")
    return ", ".join(parts)


def trace_of(page):
    """The text of a trace, one item on each line."""
    lines = ["item,value,decisions"]
    for what, value, bits in page.stream.trace:
        lines.append(f'"{what}",{value},"{decisions(bits)}"')
    return "\n".join(lines) + "\n"


def hex_row(data):
    """The bytes in hexadecimal."""
    return " ".join(f"{byte:02x}" for byte in data)


def example_of(path, page, items):
    """The block of the document for one file: its bytes, then the first items and the last ones."""
    data = path.read_bytes()
    tail = len(page.stored)
    stream = data[4:-tail]
    kind = "a blob of version 1" if page.kind == BLOB else "a page of version 1"
    lines = ["```", f"{hex_row(data[:4])}              magic, {kind}, model set {data[3]}"]
    for i in range(0, len(stream), BYTES_IN_ROW):
        row = hex_row(stream[i:i + BYTES_IN_ROW])
        lines.append(f"{row:<{3 * BYTES_IN_ROW}} the stream" if i == 0 else row)
    sums = ", ".join(f"{checksum:08x}" for checksum in page.checksums)
    what = "lower bytes of that of the solid" if page.kind == BLOB else "over those of the solids"
    lines.append(f"{hex_row(data[-tail:]):<{3 * BYTES_IN_ROW}} checksum: {what}, {sums}")
    lines += ["```", "", "| item | value | decisions |", "|---|---|---|"]
    trace = page.stream.trace
    shown = trace[:items] + [None] + trace[-6:]
    for row in shown:
        if row is None:
            lines.append(f"| ... {len(trace) - items - 6} more | | |")
        else:
            lines.append(f"| {row[0]} | {row[1]} | {decisions(row[2])} |")
    return "\n".join(lines) + "\n"


def sections_of(page):
    """The block of the document that shows the sections of a blob in mode bitmap, in integers."""
    vertices, bitmap, facets = page.sections
    head = f"vertices, {len(vertices.data)} bytes: integers, {vertices.data[1]} vertices"
    rows = [(vertices.data[:2], head)]
    reader, point = Section(vertices.data), (0, 0, 0)
    reader.at = 2
    for i in range(vertices.data[1]):
        begin = reader.at
        x = reader.varint() if i else reader.zigzag()
        point = point[0] + x, point[1] + reader.zigzag(), point[2] + reader.zigzag()
        rows.append((vertices.data[begin:reader.at], "  " + " ".join(map(str, point))))
    rows.append((bitmap.data, "bitmap"))
    rows.append((facets.data, "facets"))
    lines = [f"{hex_row(data):<{3 * BYTES_IN_ROW}} {what}" for data, what in rows]
    return "\n".join(["```"] + lines + ["```"]) + "\n"


def model_table(models):
    """The table of the files of priors."""
    lines = ["| set | file | bytes | CRC-32C |", "|---|---|---|---|"]
    for path in sorted(models.glob("model-*.bin")):
        data = path.read_bytes()
        lines.append(f"| {data[3]} | `codec/models/{path.name}` | {len(data):,} | "
                     f"`{crc32c(data):08x}` |")
    return "\n".join(lines) + "\n"


def with_example(text, name, block):
    """The document with the example between its marks replaced."""
    begin, end = f"<!-- {name}: made by tests/format/examples.py -->\n", f"<!-- end of {name} -->\n"
    first = text.index(begin) + len(begin)
    return text[:first] + block + text[text.index(end):]


def main(arguments):
    """Writes the examples and traces, or checks them."""
    models, goldens, documents = (pathlib.Path(name) for name in arguments[:3])
    document, plain = documents / "format.md", documents / "format-plain.md"
    text = document.read_text(encoding="utf-8")
    wanted, changed = with_example(text, "models", model_table(models)), []
    contents = {}
    for name in TRACED:
        path = goldens / name
        page = read(models, path)
        contents[goldens / "traces" / f"{path.stem}.csv"] = trace_of(page)
        if name in EXAMPLES:
            wanted = with_example(wanted, name, example_of(path, page, EXAMPLES[name]))
    contents[document] = wanted
    contents[plain] = with_example(plain.read_text(encoding="utf-8"), SECTIONS,
                                   sections_of(read(models, goldens / SECTIONS)))
    for path, content in contents.items():
        if path.exists() and path.read_text(encoding="utf-8") == content:
            continue
        changed.append(path.name)
        if arguments[3:] == ["--write"]:
            path.parent.mkdir(exist_ok=True)
            path.write_text(content, encoding="utf-8")
    print("not up to date: " + ", ".join(changed) if changed else "all up to date")
    return 1 if changed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
