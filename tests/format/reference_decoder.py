#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads blobs and pages of format version 1: written from docs/format*.md and nothing else.

  reference_decoder.py MODELS FILE...          prints the solids as JSON
  reference_decoder.py MODELS --check FOLDER   reads the golden blobs of a folder

MODELS is the folder with the files of priors. The standard library is all that is needed.
"""
import json
import pathlib
import struct
import sys

from bitmap import Bits, Facets, delaunay, read_bitmap
from entropy import Bank, Malformed, Models, NotRead, Stream, crc32c, varint
from order import Order, order_bank
from polygon_positions import Positions
from polygon_surface import Walk, polygon_bank
from solid import Solid

RAW, BITMAP, WALK, POLYGON, PARALLELOGRAM = 0, 1, 2, 3, 5
MODE_NAMES = {RAW: "raw", BITMAP: "bitmap", WALK: "walk", POLYGON: "polygon",
              PARALLELOGRAM: "parallelogram"}
# Every golden blob is in one of these lists; the check fails on any other outcome.
GOLDENS_READ = set("""
    box-bitmap box-canonical box-neutral box-polygon box-raw cavities-polygon cavity doubles-bitmap
    doubles-raw edge-polygon hole-touches-ring holes-in-facets holes-polygon schoenhardt-steiner
    schoenhardt-unrecovered shells-touch-at-edge stated-tolerances terrain-polygon terrain-shuffled
    terrain-unrecovered torus-polygon
    """.split())
GOLDENS_NOT_READ = set("""
    box-walk cavities-walk edge-walk holes-walk terrain-walk torus-walk torus-parallelogram
    """.split())
IMPLIED_TOLERANCES = (0.01, 20.0, 0.0)


def frame_bank():
    """The bank of the frame."""
    return Bank({"implied": ([1],), "proof": ([1],), "kind": ([3],), "one step": ([1],),
                 "phase": ([1],), "mode": ([64],), "origin": ([8],), "order": ([2],)},
                {"rule set": ([1],), "SRID": ([1],), "mantissa": ([2],), "exponent": ([2],),
                 "offset": ([3],), "section": ([1],)})


def banks_of(models, number):
    """The banks, from the neutral set 0 or from a file."""
    banks = {"frame": frame_bank(), "order": order_bank(), "polygon": polygon_bank()}
    if number == 0:
        return banks
    path = models / f"model-{number}.bin"
    if not path.exists():
        raise NotRead("model set")
    data, at = path.read_bytes(), 4
    if data[:4] != b"WTM" + bytes([number]):
        raise Malformed("model file")
    for name in ("frame", "order", "polygon", "walk", "parallelogram"):
        size, at = varint(data, at)
        if name in banks:
            banks[name].load(data[at:at + size])
        at += size
    return banks


class Frame:
    """What the solids of a page share."""

    def __init__(self, m):
        stream = m.stream
        self.tolerances = IMPLIED_TOLERANCES
        if not m.decide("implied", 0):
            self.tolerances = tuple(struct.unpack("<d", struct.pack("<Q", stream.plain(64)))[0]
                                    for _ in range(3))
        self.proof = m.decide("proof", 0)
        self.rule_set = m.number("rule set", 0, bits=16)
        self.srid = m.number("SRID", 0, bits=32)
        high = m.decide("kind", 0)
        self.kind = 2 * high + m.decide("kind", 1 + high)
        self.base = 2 if self.kind == 1 else 10
        self.steps, self.phases = [(1, 0)] * 3, [(0, 0)] * 3
        if self.kind == 2:
            return
        if self.kind > 2:
            raise Malformed("lattice kind")
        if m.decide("one step", 0):
            self.steps = [self.read_value(m, 0)] * 3
        else:
            self.steps = [self.read_value(m, 0) for _ in range(3)]
        self.phases = [(0, 0) if m.decide("phase", 0) else self.read_value(m, 1) for _ in range(3)]

    @staticmethod
    def read_value(m, context):
        """A mantissa and an exponent."""
        mantissa = m.signed("mantissa", context, bits=63)
        return mantissa, m.signed("exponent", context, bits=20)

    def value(self, axis, g):
        """phase + g * step in its simplest form."""
        (sm, se), (pm, pe) = self.steps[axis], self.phases[axis]
        exponent = min(se, pe) if pm else se
        mantissa = g * sm * self.base ** (se - exponent)
        if pm:
            mantissa += pm * self.base ** (pe - exponent)
        if mantissa == 0:
            return 0, 0
        while mantissa % self.base == 0:
            mantissa, exponent = mantissa // self.base, exponent + 1
        return mantissa, exponent


class Sections:
    """Bytes of version 0, read front to back."""

    def __init__(self, data):
        self.data, self.at = data, 0

    def varint(self):
        """An unsigned number."""
        value, self.at = varint(self.data, self.at)
        return value

    def zigzag(self):
        """A signed number."""
        value = self.varint()
        return -(value + 1) // 2 if value & 1 else value // 2

    def vertices(self):
        """The section of vertices."""
        kind, self.at = self.data[0], 1
        count = self.varint()
        if kind == 1:
            values = struct.unpack_from(f"<{3 * count}d", self.data, self.at)
            self.at += 24 * count
            return [values[3 * i:3 * i + 3] for i in range(count)]
        result = []
        for i in range(count):
            if i == 0:
                result.append((self.zigzag(), self.zigzag(), self.zigzag()))
            else:
                x, y, z = result[-1]
                result.append((x + self.varint(), y + self.zigzag(), z + self.zigzag()))
        return result

    def steiner(self):
        """The section of Steiner vertices."""
        result = []
        for _ in range(self.varint()):
            whole, self.at, point = self.data[self.at], self.at + 1, []
            for axis in range(3):
                if whole >> axis & 1:
                    point.append(self.zigzag())
                else:
                    point.append(struct.unpack_from("<d", self.data, self.at)[0])
                    self.at += 8
            result.append(tuple(point))
        return result

    def unrecovered(self):
        """The section of unrecovered faces."""
        result, a = [], 0
        for _ in range(self.varint()):
            a += self.varint()
            b = a + 1 + self.varint()
            result.append((a, b, b + 1 + self.varint()))
        return result

    def facets(self):
        """The section of listed facets."""
        shells = []
        for _ in range(self.varint()):
            shell = []
            for _ in range(self.varint()):
                head = self.varint()
                sizes = [head // 2]
                if head & 1:
                    sizes = [0] * self.varint()
                    sizes = [head // 2] + [self.varint() for _ in sizes]
                shell.append([[self.varint() for _ in range(size)] for size in sizes])
            shells.append(shell)
        return shells


class Page:
    """Reads the solids of a page, or the one of a blob."""

    def __init__(self, models, data):
        if len(data) < 7 or data[:2] != b"WT" or data[2] not in (0x01, 0x81):
            raise Malformed("magic")
        self.paged = data[2] == 0x81
        self.banks = banks_of(models, data[3])
        tail = 4 if self.paged else 3
        self.stored = data[-tail:]
        self.stream = Stream(data[4:-tail])
        self.models = {name: Models(self.stream, bank) for name, bank in self.banks.items()}
        self.mode, self.last_origin, self.origin_habit, self.order_kept = 7, (0, 0, 0), 0, 0
        self.last_position, self.columns = (0, 0, 0), []
        self.names, self.solids, self.checksums = [], [], []

    def read(self):
        """All solids; checks ending and checksum."""
        count = self.stream.uniform(256) + 1 if self.paged else 1
        self.frame = Frame(self.models["frame"])
        for _ in range(count):
            self.read_solid()
        self.stream.finish()
        sums = self.checksums
        total = crc32c(struct.pack(f"<{count}I", *sums)) if self.paged else sums[0]
        if total.to_bytes(4, "little")[:len(self.stored)] != self.stored:
            raise Malformed("checksum")

    def read_solid(self):
        """One solid."""
        m, node, before = self.models["frame"], 1, self.mode
        for _ in range(3):
            node = 2 * node + m.decide("mode", 8 * before + node)
        self.mode = node - 8
        self.names.append(MODE_NAMES.get(self.mode, str(self.mode)))
        if self.mode == POLYGON:
            points, shells = self.read_polygon()
            on_grid = True
        elif self.mode in (RAW, BITMAP):
            points, shells = self.read_raw() if self.mode == RAW else self.read_bitmap()
            on_grid = False
        else:
            raise NotRead("mode " + self.names[-1])
        self.finish_solid(points, shells, on_grid)

    def finish_solid(self, points, shells, on_grid):
        """Origin, order, checksum."""
        m, origin = self.models["frame"], (0, 0, 0)
        values = [(0, 0)] * 3
        if self.frame.kind != 2:
            origin = self.read_origin(m, points, on_grid)
            values = [self.frame.value(axis, origin[axis]) for axis in range(3)]
        if on_grid:
            solid = Solid([tuple(c - o for c, o in zip(p, origin)) for p in points], shells)
        else:
            solid = Solid(points, shells)
        self.order_kept = m.decide("order", self.order_kept)
        arrangement = None
        if self.order_kept:
            arrangement = Order(self.stream, self.banks["order"], solid).read()
        self.checksums.append(solid.checksum(self.frame, values, arrangement))
        self.solids.append((solid, values, arrangement))
        if on_grid:
            self.last_position = min(points)
            self.columns = sorted(set(self.columns) | {p[:2] for p in points})

    def read_origin(self, m, points, on_grid):
        """The lattice origin, a grid point."""
        if not on_grid:
            return tuple(self.last_position[a] + m.signed("offset", a, bits=55) for a in range(3))
        s = self.origin_habit
        corner = tuple(min(p[axis] for p in points) for axis in range(3))
        if m.decide("origin", 2 * s):
            self.origin_habit, origin = 1, corner
        elif m.decide("origin", 2 * s + 1):
            self.origin_habit, origin = 2, self.last_origin
        else:
            self.origin_habit = 3
            origin = tuple(corner[a] + m.signed("offset", a, bits=55) for a in range(3))
        self.last_origin = origin
        return origin

    def read_section(self):
        """The bytes of a section."""
        size = self.models["frame"].number("section", 0, bits=40)
        return Sections(bytes(self.stream.plain(8) for _ in range(size)))

    def read_raw(self):
        """Mode raw."""
        points = self.read_section().vertices()
        return points, self.read_section().facets()

    def read_bitmap(self):
        """Mode bitmap."""
        flags = self.stream.plain(8)
        points = self.read_section().vertices()
        nodes = points + (self.read_section().steiner() if flags & 4 else [])
        bits = Bits(self.read_section().data, flags & 16)
        faces = read_bitmap(bits, delaunay(nodes))
        if flags & 8:
            faces += self.read_section().unrecovered()
        section = self.read_section()
        if flags & 64:
            return points, section.facets()
        return points, Facets(Bits(section.data, flags & 32), nodes, len(points), faces).read()

    def read_polygon(self):
        """Mode polygon: fans, joined where they are copies."""
        walk = Walk(self.models["polygon"])
        walk.read()
        positions = Positions(walk, self.last_position, self.columns)
        positions.read()
        number, points, shells = {}, [], []
        for v, place in enumerate(positions.place):
            if place not in number:
                number[place] = len(points)
                points.append(place)
        bounds = walk.shell_begin + [len(walk.facet_level)]
        for begin, end in zip(bounds, bounds[1:]):
            shell = []
            for facet in range(begin, end):
                rings = []
                for ring in walk.facet_rings[facet]:
                    corners = walk.origin[walk.ring_begin[ring]:walk.ring_end[ring]]
                    rings.append([number[positions.place[v]] for v in corners])
                exterior = rings.pop(walk.facet_exterior[facet])
                shell.append([exterior] + rings)
            shells.append(shell)
        return points, shells


def as_json(page):
    """What a page holds, in canonical form."""
    frame = page.frame
    return {"tolerances": frame.tolerances, "proof": ["tetrahedralization", "boundary"][frame.proof],
            "rule_set": frame.rule_set, "srid": frame.srid,
            "lattice": ["decimal", "binary", "float64"][frame.kind], "steps": frame.steps,
            "solids": [{"mode": name, "origin": origin, "vertices": solid.vertices,
                        "shells": solid.shells, "order": order, "checksum": f"{checksum:08x}"}
                       for name, (solid, origin, order), checksum in
                       zip(page.names, page.solids, page.checksums)]}


def decode(models, path):
    """The page of a file, read and checked."""
    page = Page(models, path.read_bytes())
    try:
        page.read()
    except (IndexError, ValueError, OverflowError, StopIteration) as error:
        raise Malformed(f"{type(error).__name__}: {error}") from error
    return page


def main(arguments):
    """Decodes files, or checks a folder of golden blobs."""
    models = pathlib.Path(arguments[0])
    if arguments[1] != "--check":
        for name in arguments[1:]:
            print(json.dumps(as_json(decode(models, pathlib.Path(name)))))
        return 0
    return check(models, pathlib.Path(arguments[2]))


def check(models, folder):
    """Reads the golden blobs; each must be read, or be of a mode stated as not read."""
    wrong, found = 0, {}
    for path in sorted(folder.glob("*.blob")):
        try:
            page = decode(models, path)
            found[path.stem] = f"read, mode {page.names[0]}, checksum {page.checksums[0]:08x}"
        except NotRead as error:
            found[path.stem] = f"not read by this decoder: {error}"
        except Malformed as error:
            found[path.stem] = f"malformed: {error}"
        print(f"{path.stem}: {found[path.stem]}")
    for name in sorted(GOLDENS_READ | GOLDENS_NOT_READ | set(found)):
        expected = "read," if name in GOLDENS_READ else "not read by this decoder"
        if name not in GOLDENS_READ | GOLDENS_NOT_READ:
            expected = "a golden listed in this script"
        if not found.get(name, "missing").startswith(expected):
            print(f"FAILED: {name} is {found.get(name, 'missing')}; expected: {expected}")
            wrong += 1
    print(f"{len(GOLDENS_READ)} goldens to be read, {len(GOLDENS_NOT_READ)} of modes not read, "
          f"{wrong} otherwise")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
