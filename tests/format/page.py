# SPDX-License-Identifier: GPL-3.0-or-later
"""Blobs, pages and page files, from docs/format.md, "Container" and "Solid"."""
import struct

from bitmap import Bits, Facets, read_bitmap
from columns import Columns
from delaunay import delaunay
from entropy import (Limits, Malformed, Models, Stream, Unsupported, bank_bytes, crc32c, varint)
from flags import Flags
from frame import FLOAT64, Frame, frame_bank
from order import Order, order_bank
from parallelogram import Triangles, parallelogram_bank
from polygon_positions import Positions
from polygon_surface import Surface, polygon_bank
from sections import Section
from solid import Solid
from walk import Walk, walk_bank

RAW, BITMAP, WALK, POLYGON, PARALLELOGRAM = 0, 1, 2, 3, 5
MODE_NAMES = {RAW: "raw", BITMAP: "bitmap", WALK: "walk", POLYGON: "polygon",
              PARALLELOGRAM: "parallelogram"}
BLOB, PAGE = 0x01, 0x81
FILE_MAGIC = b"WTPF"


BANKS = {"frame": frame_bank, "order": order_bank, "polygon": polygon_bank, "walk": walk_bank,
         "parallelogram": parallelogram_bank}


class ModelSet:
    """The banks of a set of priors, each bound to the stream when a part first uses it."""

    def __init__(self, folder, number, stream):
        self.stream, self.states, self.bound = stream, {}, {}
        if number:
            path = folder / f"model-{number}.bin"
            if not path.exists():
                raise Unsupported("model set")
            self.states = bank_bytes(path.read_bytes(), number)

    def __getitem__(self, name):
        if name not in self.bound:
            bank = BANKS[name]()
            if self.states:
                bank.load(self.states[name])
            self.bound[name] = Models(self.stream, bank)
        return self.bound[name]


class Page:
    """Reads the solids of a page, or the one solid of a blob."""

    def __init__(self, models, data, kind):
        if len(data) < 4 or data[:2] != b"WT":
            raise Malformed("magic")
        if data[2] & 127 != 1:
            raise Unsupported("version")
        tail = 4 if kind == PAGE else 3
        if data[2] != kind or len(data) < 4 + tail:
            raise Malformed("a page for a blob, a blob for a page, or too short")
        self.kind, self.stored, data = kind, data[-tail:], data[:-tail]
        self.stream, self.limits = Stream(data[4:]), Limits(len(data) - 4)
        self.models = ModelSet(models, data[3], self.stream)
        self.mode, self.last_origin, self.origin_habit, self.order_kept = 7, (0, 0, 0), 0, 0
        self.last_position, self.columns = (0, 0, 0), []
        self.names, self.solids, self.checksums, self.sections = [], [], [], []

    def read(self):
        """Reads all solids; checks the end of the stream and the checksum."""
        count = self.models["frame"].uniform(256) + 1 if self.kind == PAGE else 1
        self.frame = Frame(self.models["frame"])
        for _ in range(count):
            self.read_solid()
        self.stream.finish()
        sums = self.checksums
        total = crc32c(struct.pack(f"<{count}I", *sums)) if self.kind == PAGE else sums[0]
        if total.to_bytes(4, "little")[:len(self.stored)] != self.stored:
            raise Malformed("checksum")

    def read_solid(self):
        """Reads one solid."""
        m, node, before = self.models["frame"], 1, self.mode
        for _ in range(3):
            node = 2 * node + m.decide("mode", 8 * before + node)
        self.mode = node - 8
        readers = {RAW: self.read_raw, BITMAP: self.read_bitmap, WALK: self.read_walk,
                   POLYGON: self.read_polygon, PARALLELOGRAM: self.read_parallelogram}
        if self.mode not in readers:
            raise Unsupported(f"mode {self.mode}")
        self.names.append(MODE_NAMES[self.mode])
        on_grid = self.mode not in (RAW, BITMAP)
        if on_grid and self.frame.kind == FLOAT64:
            raise Malformed("a mode for integers on a float64 lattice")
        points, shells, is_listed = readers[self.mode]()
        origin = self.read_origin(points, on_grid)
        values = self.frame.lattice_origin(origin)
        if on_grid:
            if max(abs(c) for p in points for c in p) >= 2**53:
                raise Malformed("a grid point out of range")
            placed = [tuple(c - o for c, o in zip(p, origin)) for p in points]
            if max(abs(c) for p in placed for c in p) >= 2**53:
                raise Malformed("a coordinate out of range")
        solid = Solid(placed if on_grid else points, shells, self.limits)
        if is_listed and solid.shells != shells:
            raise Malformed("listed facets in another order")
        self.order_kept, arrangement = m.decide("order", self.order_kept), None
        if self.order_kept:
            arrangement = Order(self.models["order"], solid).read()
        self.checksums.append(solid.checksum(self.frame, values, arrangement))
        self.solids.append((solid, values, arrangement))
        self.limits.take(points, shells)
        if on_grid:
            self.last_position = min(points)
            self.columns = sorted(set(self.columns) | {p[:2] for p in points})

    def read_origin(self, points, on_grid):
        """Reads the origin of a solid, as a grid point."""
        m = self.models["frame"]
        if self.frame.kind == FLOAT64:
            return 0, 0, 0
        s, corner = self.origin_habit, self.last_position
        if on_grid:
            corner = tuple(min(p[axis] for p in points) for axis in range(3))
        if on_grid and m.decide("origin", 2 * s):
            self.origin_habit, origin = 1, corner
        elif on_grid and m.decide("origin", 2 * s + 1):
            self.origin_habit, origin = 2, self.last_origin
        else:
            self.origin_habit = 3 if on_grid else s
            origin = tuple(corner[a] + m.signed("offset", a, bits=55) for a in range(3))
        self.last_origin = origin
        return origin

    def read_section(self):
        """Reads the bytes of a section."""
        size = self.models["frame"].number("section", 0, bits=40)
        self.sections.append(Section(bytes(self.models["frame"].plain(8) for _ in range(size))))
        return self.sections[-1]

    def read_raw(self):
        """Reads a solid in mode raw."""
        points, facets = self.read_section(), self.read_section()
        points = points.vertices(self.limits)
        return points, facets.facets(len(points), self.limits), True

    def read_bitmap(self):
        """Reads a solid in mode bitmap."""
        flags = self.models["frame"].plain(8)
        if flags & ~0x7C or flags & 0x60 == 0x60:
            raise Malformed("flags")
        points, steiner = self.read_section(), self.read_section() if flags & 4 else None
        bitmap, unrecovered = self.read_section(), self.read_section() if flags & 8 else None
        facets = self.read_section()
        points = points.vertices(self.limits)
        nodes = points + (steiner.steiner() if steiner else [])
        if any(c and not 2.0**-100 <= abs(c) <= 2.0**100 for p in nodes for c in p):
            raise Malformed("a coordinate that mode bitmap does not hold")
        faces = read_bitmap(Bits(bitmap.data, flags & 16), delaunay(nodes, 64))
        if unrecovered:
            faces += unrecovered.unrecovered(len(nodes))
            if len(set(faces)) < len(faces):
                raise Malformed("a face that is marked and listed")
        if flags & 64:
            return points, facets.facets(len(points), self.limits), True
        facets = Facets(Bits(facets.data, flags & 32), nodes, len(points), faces)
        return points, facets.read(), False

    def read_walk(self):
        """Reads a solid in mode walk: columns, triangles, facets."""
        m = self.models["walk"]
        points = Columns(m, self.last_position, self.columns, self.limits).read()
        walk = Walk(m, points)
        walk.read()
        self.limits.shells(len(walk.component_first) - 1)
        self.limits.facets((len(walk.triangles) + 3) // 4)
        return points, Flags(m, walk).read(), False

    def read_parallelogram(self):
        """Reads a solid in mode parallelogram; vertices at one position become one vertex."""
        triangles = Triangles(self.models["parallelogram"], self.last_position, not self.columns,
                              self.limits)
        points, shells = triangles.read()
        return points, shells, False

    def read_polygon(self):
        """Reads a solid in mode polygon; a vertex that is a copy is joined to the earlier one."""
        surface = Surface(self.models["polygon"], self.limits)
        surface.read()
        positions = Positions(surface, self.last_position, self.columns)
        positions.read()
        points = list(dict.fromkeys(positions.place))
        number = {place: i for i, place in enumerate(points)}
        bounds = surface.shell_begin + [len(surface.facet_level)]
        shells = []
        for begin, end in zip(bounds, bounds[1:]):
            shell = []
            for facet in range(begin, end):
                rings = []
                for ring in surface.facet_rings[facet]:
                    corners = surface.origin[surface.ring_begin[ring]:surface.ring_end[ring]]
                    rings.append([number[positions.place[v]] for v in corners])
                exterior = rings.pop(surface.facet_exterior[facet])
                shell.append([exterior] + rings)
            shells.append(shell)
        return points, shells, False


def read_page(models, data, kind):
    """Reads and checks a blob or page; an index outside of a list means malformed data."""
    try:
        page = Page(models, data, kind)
        page.read()
    except (IndexError, ValueError, OverflowError, StopIteration, struct.error,
            ZeroDivisionError) as error:
        raise Malformed(f"{type(error).__name__}: {error}") from error
    return page


def read_page_file(models, data):
    """The pages of a page file, and for each solid its page and its index there."""
    if len(data) < 17 or data[:4] != FILE_MAGIC or data[-4:] != FILE_MAGIC:
        raise Malformed("magic of a page file")
    if data[4] != 1:
        raise Unsupported("version of a page file")
    checksum, size = struct.unpack("<II", data[-12:-4])
    body = data[5:-12]
    if size > len(body):
        raise Malformed("an index that is too long")
    index, body = Section(body[len(body) - size:]), body[:len(body) - size]
    if crc32c(index.data) != checksum:
        raise Malformed("checksum of the index")
    count, pages, begin, place_of = index.varint(), [], 0, {}
    for _ in range(index.varint()):
        end = begin + index.varint()
        number, solids = 0, index.varint()
        if end > len(body) or not 1 <= solids <= 256:
            raise Malformed("a page that is not there")
        for place in range(solids):
            number += index.varint()
            if number in place_of or number >= count:
                raise Malformed("a number twice, or too large")
            place_of[number] = len(pages), place
            number += 1
        pages.append(read_page(models, body[begin:end], PAGE))
        if len(pages[-1].solids) != solids:
            raise Malformed("a page of another size")
        begin = end
    index.finish()
    if begin != len(body) or len(place_of) != count:
        raise Malformed("an index that does not fit")
    return pages, place_of
