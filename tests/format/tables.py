#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares the tables of families in the specification with the banks of the decoder.

  tables.py DOCUMENTS     DOCUMENTS is the folder of format.md and the texts of the modes

Each family and number must have its number, name, selectors and inputs as in the decoder. Where a
context is a list of classes, the product of their numbers of classes must be the size of the input.
"""
import pathlib
import re
import sys

from frame import frame_bank
from order import order_bank
from parallelogram import parallelogram_bank
from polygon_surface import polygon_bank
from walk import walk_bank

# The banks that each document describes, each with the heading of its part.
BANKS = {"format.md": [("## Frame", frame_bank), ("## Order", order_bank)],
         "format-walk.md": [("# Mode walk", walk_bank)],
         "format-polygon.md": [("# Mode polygon", polygon_bank)],
         "format-parallelogram.md": [("# Mode parallelogram", parallelogram_bank)]}
DEFINES = ("class", "word", "value", "symbol", "function")
MODEL = re.compile(r"([FN])(\d+) ([\w ]+)")
CLASSES = re.compile(r" \[(\d+)\]$")


def cells_of(line):
    """The cells of a table row."""
    return [cell.strip().replace("\\|", "|") for cell in re.split(r"(?<!\\)\|", line.strip())[1:-1]]


def split_list(text):
    """The elements of a list in parentheses."""
    parts, depth = [""], 0
    for letter in text[1:-1]:
        depth += (letter == "(") - (letter == ")")
        if letter == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += letter
    return [part.strip() for part in parts]


class Tables:
    """The tables in one part of a document."""

    def __init__(self, lines):
        self.classes, self.models, self.errors = {}, {}, []
        self.checked = 0
        header, self.last = None, []
        for line, following in zip(lines, lines[1:] + [""]):
            if not line.lstrip().startswith("|"):
                header = None
            elif header is None:
                header, self.last = cells_of(line), []
                self.define(header[0])
            elif not set(line) <= set(" |-"):
                self.row(header, cells_of(line))

    def define(self, cell):
        """Notes the numbers of classes that a cell states: "a, b [4]"."""
        found = CLASSES.search(cell)
        for name in cell[:found.start()].split(", ") if found else []:
            self.classes[re.sub(r"\(.*", "", name)] = int(found.group(1))

    def row(self, header, cells):
        """Reads a row of definitions or of families."""
        if header[0].startswith(DEFINES):
            self.define(cells[0])
        for i, name in enumerate(header):
            if name.startswith(("family", "number")) and "size" in header[i:]:
                end = header.index("size", i)
                self.family(header[i:end + 1], cells[i:end + 1])

    def family(self, header, cells):
        """Reads a row of families: an input of those named in this row, or in a row before."""
        if cells[0]:
            found = MODEL.findall(cells[0])
            if not self.last or not self.last[-1].endswith(","):
                self.last = []
            self.last += [kind + number + " " + name for kind, number, name in found]
            selector = cells[header.index("selector")] if "selector" in header else ""
            count = CLASSES.search(selector) or re.search(r"\[(\d+)\]", selector)
            if selector == "likewise":
                self.models[self.last[-1]] = self.models[self.last[-2][:-1]]
            for name in self.last if selector != "likewise" else []:
                self.models[name] = (int(count.group(1)) if count else 1, [])
            if cells[0].endswith(","):
                self.last[-1] += ","
        if not self.last or not cells[-1]:
            return
        size = int(cells[-1].replace(",", ""))
        self.models[self.last[-1].rstrip(",")][1].append(size)
        contexts = [i for i, name in enumerate(header) if name.startswith("context")]
        if contexts:
            self.check(self.last[-1], cells[contexts[0]], size)

    def count(self, text):
        """The number of classes of an element, or none."""
        found = CLASSES.search(text) or re.match(r"(?:cap|bucket|log)\(.*, (\d+)\)$", text)
        if found:
            return int(found.group(1))
        return self.classes.get(re.sub(r"\(.*", "", text))

    def check(self, name, context, size):
        """Checks that the classes of a context make the size of its input."""
        listed = context.startswith("(") and context.endswith(")")
        counts = [self.count(part) for part in (split_list(context) if listed else [context])]
        if None in counts:
            if listed:
                self.errors.append(f"{name}: {context}: a class without its number of classes")
            return
        product = 1
        for count in counts:
            product *= count
        self.checked += 1
        if product != size:
            self.errors.append(f"{name}: {context} has {product} contexts, not {size}")


def compare(tables, bank):
    """The differences between the tables and the bank, as messages."""
    errors, kinds = list(tables.errors), {"F": 0, "N": 0}
    for name, model in bank.named.items():
        kind = "N" if hasattr(model, "length") else "F"
        family = model.sign if kind == "N" else model
        title = f"{kind}{kinds[kind]} {name}"
        kinds[kind] += 1
        wanted = (len(family.weights), [len(counts) for counts in family.counts])
        if tables.models.pop(title, None) != wanted:
            errors.append(f"{title}: the decoder has (selectors, inputs) {wanted}")
    return errors + [f"{title}: not in the decoder" for title in tables.models]


def main(arguments):
    """Compares the tables of all documents."""
    errors, checked = [], 0
    for document, banks in BANKS.items():
        text = (pathlib.Path(arguments[0]) / document).read_text(encoding="utf-8")
        for i, (title, bank) in enumerate(banks):
            begin = text.index(title + "\n")
            end = text.index(banks[i + 1][0] + "\n") if i + 1 < len(banks) else len(text)
            tables = Tables(text[begin:end].splitlines())
            errors += [f"{document}: {error}" for error in compare(tables, bank())]
            checked += tables.checked
    for error in errors:
        print(error)
    print(f"{checked} contexts make their sizes; {len(errors)} errors")
    return 1 if errors or checked < 100 else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
