# SPDX-License-Identifier: GPL-3.0-or-later
"""Packed texts and single texts, from docs/format-columns.md, "Packed texts" and "Single texts"."""
import copy
import lzma

from entropy import Unsupported, varint
from json_path import JsonPath
from marks import Marks
from mixer import Mixer, TextStream, require
from number_forms import whole_number
from place import COORDINATE, POSITION, VERTEX_COUNT, VERTEX_INDEX, VERTEX_RUN, Place
from positions import Positions
from rings import Rings
from string_model import Strings
from table_path import TablePath
from values import Values
from vertices import Vertices
from xml_path import XmlPath

BYTES = 0
BYTES_COLUMN = 0x42595445
BY_COLUMN, PLAIN = 0, 1
EXAMPLES = {"file": (18, 16, 8), "row": (17, 14, 4)}  # bits of counters and slots, examples


class TextCoder:
    """Reads texts from a stream."""

    def __init__(self, counter_bits, slot_bits):
        self.mixer, self.strings = Mixer(counter_bits), Strings()
        self.marks, self.values = Marks(slot_bits), Values(slot_bits)
        self.paths = {1: JsonPath(), 2: XmlPath(), 3: TablePath()}
        self.rings, self.vertices, self.positions = Rings(), Vertices(), Positions()
        self.last_value = 0

    def restart(self):
        """Starts another text."""
        self.marks.restart()
        self.values.restart()
        self.rings = Rings()
        self.vertices.restart(0)
        self.last_value = 0

    def learn(self, data, count, most_answers, most_mixed):
        """Reads examples, and makes what was learned count as little as stated."""
        self.read_all(data, count)
        self.mixer.soften(most_answers, most_mixed)
        self.restart()
        self.paths[1].restart()
        self.paths[2].restart()

    def read_all(self, data, count):
        """The texts of a stream, which ends with the last one."""
        stream = self.mixer.stream = TextStream(data)
        texts = [self.read() for _ in range(count)]
        stream.finish()
        return texts

    def read(self):
        """Reads a text."""
        kind = self.mixer.symbol("text_kind", [1], 2)
        if kind == BYTES:
            return self.values.read(self.mixer, self.strings, Place(column=BYTES_COLUMN))
        path = self.paths[kind]
        path.restart()
        self.restart()
        out = bytearray()
        while True:
            size = len(out)
            mark, is_last = self.marks.read(self.mixer, self.strings, path.place(), self.last_value)
            out += mark
            if is_last:
                return bytes(out)
            path.follow(mark)
            value = self.read_value(path.place())
            out += value
            path.follow_value(value)
            require(len(out) > size, "a mark and a value that are empty")

    def read_value(self, place):
        """Reads a value."""
        if place.role == VERTEX_INDEX and place.is_in_array:
            vertex = self.rings.read(self.mixer, place.index)
            if vertex is not None:
                self.values.skip(vertex)
                self.last_value = 0
                return str(vertex).encode()
        if place.role == COORDINATE and self.vertices.is_ready():
            coordinate = self.vertices.read(self.mixer, self.rings)
            if coordinate is not None:
                return coordinate
        if place.role == POSITION:
            coordinate = self.positions.read(self.mixer, place)
            if coordinate is not None:
                self.values.skip(None)
                self.last_value = 0
                return coordinate
        value = self.values.read(self.mixer, self.strings, place)
        self.last_value = self.values.last
        if place.role == VERTEX_COUNT:
            self.vertices.restart((whole_number(value) or 0) % 2**64)
        if place.role == VERTEX_RUN:
            number = whole_number(value)
            self.vertices.take_run(-1 if number is None else number)
        return value


class Texts:
    """Unpacks texts. `folder` has the examples of the format."""

    def __init__(self, folder):
        self.coders = {}
        for name, (counter_bits, slot_bits, count) in EXAMPLES.items():
            coder = TextCoder(counter_bits, slot_bits)
            coder.learn((folder / f"examples-{name}.bin").read_bytes(), count, 1, 8)
            self.coders[name] = coder

    def unpack(self, data):
        """The texts of packed texts."""
        head, at = varint(data, 0)
        count, form = head // 4, head % 4
        if form > PLAIN:
            raise Unsupported(f"texts of form {form} are not known")
        require(count <= 2**18 + 16 * len(data), "more texts than the bytes stand for")
        if form == BY_COLUMN:
            return copy.deepcopy(self.coders["file"]).read_all(data[at:], count)
        return unpack_plain(data[at:], count)

    def dictionary(self, content):
        """A coder that has learned from a dictionary; from none if it is empty."""
        coder = copy.deepcopy(self.coders["row"])
        if not content:
            coder.learn(b"", 0, 8, 64)
            return coder
        form, at = varint(content, 0)
        if form != BY_COLUMN:
            raise Unsupported(f"texts of form {form} are not known")
        _, at = varint(content, at)
        count, at = varint(content, at)
        coder.learn(content[at:], count, 8, 64)
        return coder


def unpack_row(dictionary, data):
    """A single text, packed with a dictionary."""
    return copy.deepcopy(dictionary).read_all(data, 1)[0]


def unpack_plain(data, count):
    """The texts of the plain form."""
    size, at = varint(data, 0)
    window = max(4096, min(64 << 20, 1 << (size - 1).bit_length() if size else 1))
    decoder = lzma.LZMADecompressor(lzma.FORMAT_RAW, filters=[
        {"id": lzma.FILTER_LZMA1, "dict_size": window, "lc": 3, "lp": 0, "pb": 0}])
    plain = decoder.decompress(data[at:])
    require(decoder.eof and not decoder.unused_data and len(plain) == size, "plain texts")
    at, texts, lengths = 0, [], []
    for _ in range(count):
        length, at = varint(plain, at)
        lengths.append(length)
    for length in lengths:
        texts.append(plain[at:at + length])
        at += length
    require(at == size, "lengths of plain texts")
    return texts
