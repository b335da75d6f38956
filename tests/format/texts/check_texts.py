#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads packed texts as docs/format-columns*.md describe them, and compares with the program.

  check_texts.py EXAMPLES PACKED_TEXTS documents WATERTIGHT DOCUMENT...   the texts of Watertight files
  check_texts.py EXAMPLES PACKED_TEXTS texts FILE...                      files as each kind of text
  check_texts.py EXAMPLES PACKED_TEXTS rows FILE COUNT                    its first lines as rows of a database

EXAMPLES is the folder with the examples of the format, PACKED_TEXTS a program of the tests (packed_texts.cpp).
"""
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))

from entropy import Malformed, Unsupported  # noqa: E402
from text_coder import PLAIN, Texts, unpack_row  # noqa: E402
from watertight_file import packed_texts  # noqa: E402


def items_of(*command):
    """The items that a command of the tests prints."""
    data, at, items = subprocess.run(command, capture_output=True, check=True).stdout, 0, []
    while at < len(data):
        end = data.index(b"\n", at)
        size = int(data[at:end])
        items.append(data[end + 1:end + 1 + size])
        at = end + 1 + size
    return items


class Check:
    """Counts what was compared."""

    def __init__(self, folder, tool):
        self.texts, self.tool, self.wrong, self.found = Texts(folder), tool, 0, 0
        self.forms = set()

    def expect(self, what, condition):
        """Reports what is otherwise than stated."""
        self.found += 1
        if not condition:
            print(f"FAILED: {what}")
            self.wrong += 1

    def packed(self, what, data, folder):
        """Compares the texts of packed texts with those that the program reads."""
        path = folder / "packed"
        path.write_bytes(data)
        expected = items_of(self.tool, "unpack", path)
        found = self.texts.unpack(data)
        self.forms.add(data[0] % 4)
        print(f"{what}: {len(found)} texts, {sum(map(len, found)):,} bytes in {len(data):,}")
        self.expect(what, found == expected)
        return found

    def documents(self, watertight, names):
        """The texts of documents as Watertight files."""
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            for document in names:
                file = folder / "x.wt"
                file.unlink(missing_ok=True)
                subprocess.run([watertight, "encode", document, "-o", file, "--invalid", "keep"],
                               capture_output=True, check=False)
                self.expect(f"{document} as a file", file.exists())
                if not file.exists():
                    continue
                for packed in packed_texts(file.read_bytes()):
                    self.packed(pathlib.Path(document).name, packed, folder)

    def kinds(self, names):
        """Files as each kind of text."""
        with tempfile.TemporaryDirectory() as name:
            for file in names:
                expected = pathlib.Path(file).read_bytes()
                for kind in ("bytes", "json", "xml", "table"):
                    packed, = items_of(self.tool, "pack", kind, file)
                    what = f"{pathlib.Path(file).name} as {kind}"
                    self.expect(what, self.packed(what, packed, pathlib.Path(name)) == [expected])
            self.expect("a file without columns in the plain form", PLAIN in self.forms)
            self.refused(packed)

    def refused(self, packed):
        """Damaged texts and those of other forms are refused."""
        for what, data, error in (("a text that is cut", packed[:-1], Malformed),
                                  ("a text that goes on", packed + b"\0", Malformed),
                                  ("form 2", b"\x06" + packed[1:], Unsupported)):
            try:
                self.texts.unpack(data)
                self.expect(what, False)
            except error:
                self.expect(what, True)

    def rows(self, file, count):
        """The first lines of a file, packed with a dictionary, and one without."""
        lines = pathlib.Path(file).read_bytes().splitlines()[:int(count)]
        content, *packed, alone = items_of(self.tool, "rows", file, count)
        dictionary = self.texts.dictionary(content)
        step = max(1, len(lines) // 8)
        for i in range(0, len(lines), step):
            self.expect(f"row {i}", unpack_row(dictionary, packed[i]) == lines[i])
        self.expect("a row alone", unpack_row(self.texts.dictionary(b""), alone) == lines[0])
        sizes = sum(map(len, packed))
        print(f"{len(lines)} rows of {sum(map(len, lines)):,} bytes in {sizes:,}, dictionary "
              f"{len(content):,}; alone {len(alone)}")


def main(arguments):
    """Runs one of the comparisons."""
    check = Check(pathlib.Path(arguments[0]), arguments[1])
    what, *rest = arguments[2:]
    if what == "documents":
        check.documents(rest[0], rest[1:])
    elif what == "texts":
        check.kinds(rest)
    else:
        check.rows(*rest)
    print(f"{check.found} compared, {check.wrong} otherwise than the program has them")
    return 1 if check.wrong or not check.found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
