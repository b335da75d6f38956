#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the figures of docs/findings.md, one small SVG file for each finding: `draw.py` writes them
beside itself. Grey is the model, red is what the finding is about, blue is a hole or a cavity."""
import math
import pathlib

HERE = pathlib.Path(__file__).resolve().parent
GREY, RED, BLUE = "#c9d3dc", "#d4321f", "#4a90c2"


class Figure:
    def __init__(self):
        self.parts = []

    def area(self, points, fill=GREY, line="#44525e", opacity=0.8):
        path = " ".join(f"{x:g},{y:g}" for x, y in points)
        self.parts.append(f'<polygon points="{path}" fill="{fill}" fill-opacity="{opacity:g}" '
                          f'stroke="{line}" stroke-width="1.5" stroke-linejoin="round"/>')
        return self

    def line(self, points, colour=RED, width=2.5, dash=""):
        path = " ".join(f"{x:g},{y:g}" for x, y in points)
        dashes = f' stroke-dasharray="{dash}"' if dash else ""
        self.parts.append(f'<polyline points="{path}" fill="none" stroke="{colour}" '
                          f'stroke-width="{width:g}" stroke-linejoin="round"{dashes}/>')
        return self

    def dot(self, x, y, colour=RED):
        self.parts.append(f'<circle cx="{x:g}" cy="{y:g}" r="3.5" fill="{colour}"/>')
        return self

    def text(self, x, y, text, colour="#44525e"):
        self.parts.append(f'<text x="{x:g}" y="{y:g}" font-family="sans-serif" font-size="11" '
                          f'text-anchor="middle" fill="{colour}">{text}</text>')
        return self

    def turn(self, x, y, is_left, colour=RED):
        """A round arrow: which way a ring turns."""
        r = 9
        sweep = 0 if is_left else 1
        end = -1 if is_left else 1
        self.parts.append(f'<path d="M {x + r * end:g} {y:g} A {r} {r} 0 1 {1 - sweep} {x:g} {y - r:g}" '
                          f'fill="none" stroke="{colour}" stroke-width="2"/>')
        self.parts.append(f'<path d="M {x:g} {y - r:g} l {5 * end:g} -4 l 0 8 z" fill="{colour}"/>')
        return self

    def box(self, low, high, fill=GREY, line="#44525e", opacity=0.8, faces="left right top"):
        """An axis-parallel box seen from above; units of 10."""
        (a, b, c), (d, e, f) = low, high
        sides = {"bottom": [(a, b, c), (d, b, c), (d, e, c), (a, e, c)],
                 "back": [(a, e, c), (d, e, c), (d, e, f), (a, e, f)],
                 "left": [(a, b, c), (d, b, c), (d, b, f), (a, b, f)],
                 "right": [(d, b, c), (d, e, c), (d, e, f), (d, b, f)],
                 "top": [(a, b, f), (d, b, f), (d, e, f), (a, e, f)]}
        for face in faces.split():
            self.area([at(*p) for p in sides[face]], fill, line, opacity)
        return self

    def svg(self):
        return ('<!-- SPDX-License-Identifier: GPL-3.0-or-later -->\n'
                '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 160 120" width="160" '
                'height="120">\n' + "\n".join(self.parts) + "\n</svg>\n")


def at(x, y, z):
    """Space to paper: x to the right, y into the depth, z up; the cube 0..6 fills the figure."""
    return (22 + 12.5 * x + 6 * y, 104 - 11 * z - 4 * y + 1.5 * x)


SQUARE = [(30, 20), (130, 20), (130, 100), (30, 100)]
HOLE = [(55, 40), (85, 40), (85, 75), (55, 75)]
F = Figure
CUBE = ((0, 0, 0), (6, 6, 6))


def facet():
    return F().area(SQUARE)


def hole(figure, points=None, line=BLUE):
    return figure.area(points or HOLE, "white", line, 1)


def shifted(points, x, y):
    return [(a + x, b + y) for a, b in points]


def bowtie():
    return F().area([(30, 25), (130, 95), (130, 25), (30, 95)]).dot(80, 60)


def star(figure, x, y, r=7):
    for i in range(4):
        angle = math.pi * i / 4
        dx, dy = r * math.cos(angle), r * math.sin(angle)
        figure.line([(x - dx, y - dy), (x + dx, y + dy)], RED, 1.5)
    return figure


def solid_pair(first, second, figure=None):
    return (figure or F()).box(*first).box(*second, fill="#f2b8b0", line=RED)


def page(label, mark):
    figure = F().area([(50, 12), (95, 12), (112, 29), (112, 108), (50, 108)], "white")
    for y in (40, 52, 64, 76):
        figure.line([(60, y), (102, y)], "#9aa7b2", 1.5)
    return figure.text(81, 100, label).text(81, 32, mark, RED)


FIGURES = {
    101: lambda: facet().line([(55, 75), (105, 45)]).dot(55, 75).dot(105, 45),
    102: lambda: facet().dot(128, 20).dot(134, 20).text(118, 38, "twice", RED),
    103: lambda: F().line([(40, 95), (120, 95), (120, 25), (40, 25), (40, 75)], "#44525e")
        .dot(40, 95).dot(40, 75),
    104: bowtie,
    201: lambda: hole(facet(), [(100, 40), (145, 40), (145, 75), (100, 75)], RED)
        .dot(130, 40).dot(130, 75),
    202: lambda: hole(facet()).line(HOLE + HOLE[:1]).line(shifted(HOLE + HOLE[:1], 3, 3), RED, 1),
    203: lambda: F().area([(20, 80), (70, 100), (140, 85), (95, 62)])
        .line([(95, 62), (95, 30)], RED, 1.5, "3 3").dot(95, 30)
        .line([(20, 80), (95, 30), (140, 85)], "#44525e", 1.5).text(118, 45, "&gt; 1 cm", RED),
    204: lambda: F().area([(20, 50), (140, 50), (140, 90), (20, 90)])
        .area([(60, 50), (100, 50), (80, 38)], "#f2b8b0", RED).text(80, 28, "&gt; 20°", RED),
    205: lambda: hole(facet(), [(80, 20), (105, 60), (80, 100), (55, 60)], RED).dot(80, 20).dot(80, 100),
    206: lambda: F().area([(15, 20), (85, 20), (85, 100), (15, 100)])
        .area([(105, 40), (145, 40), (145, 80), (105, 80)], "white", RED, 1),
    207: lambda: hole(facet(), [(45, 32), (115, 32), (115, 88), (45, 88)])
        .area([(62, 46), (98, 46), (98, 74), (62, 74)], "white", RED, 1),
    208: lambda: hole(facet()).turn(112, 60, True, "#44525e").turn(70, 58, True),
    300: lambda: F().area([(20, 45), (70, 30), (140, 50), (140, 75), (75, 58), (20, 75)])
        .area([(20, 45), (20, 75), (70, 100), (140, 75), (140, 50), (80, 78)], "#f2b8b0", RED)
        .text(80, 20, "one side only", RED),
    301: lambda: F().box(*CUBE, faces="left right").text(80, 14, "2 facets", RED),
    302: lambda: F().box(*CUBE, faces="bottom back left right").line(
        [at(0, 0, 6), at(6, 0, 6), at(6, 6, 6), at(0, 6, 6), at(0, 0, 6)]),
    303: lambda: F().box((0, 3, 0), (3, 6, 4)).box((3, 0, 0), (6, 3, 4)).line([at(3, 3, 0), at(3, 3, 4)]),
    305: lambda: F().box((0, 0, 0), (3, 3, 3)).box((4, 3, 2), (6, 6, 4), "#f2b8b0", RED),
    306: lambda: F().box((0, 1, 0), (5, 5, 3)).box((2, 0, 1), (4, 6, 6), "#f2b8b0", RED)
        .line([at(2, 1, 3), at(4, 1, 3)]),
    307: lambda: F().box(*CUBE).turn(*at(3, 3, 6), False).turn(*at(3, 0, 3), True, "#44525e"),
    401: lambda: F().box(*CUBE, opacity=0.25).box((1, 1, 1), (4, 4, 4), BLUE, BLUE, 0.5)
        .box((3, 2, 2), (5, 5, 5), "#f2b8b0", RED, 0.5),
    402: lambda: F().box(*CUBE, opacity=0.25).box((2, 2, 2), (4, 4, 4), BLUE, BLUE, 0.5)
        .box((2.1, 2.1, 2.1), (4.1, 4.1, 4.1), "#f2b8b0", RED, 0.4),
    403: lambda: F().box((0, 0, 0), (4, 4, 4)).box((5, 1, 1), (7, 3, 3), "#f2b8b0", RED),
    404: lambda: F().box(*CUBE, opacity=0.25).box((2, 0, 0), (4, 6, 6), "#f2b8b0", RED, 0.5)
        .text(34, 60, "1").text(124, 60, "2"),
    405: lambda: F().box(*CUBE).line([at(3, 0, 3), (at(3, 0, 3)[0], at(3, 0, 3)[1] - 20)])
        .turn(*at(3, 3, 6), False).turn(*at(3, 0, 2.5), False).turn(*at(6, 3, 3), False),
    501: lambda: solid_pair(((0, 0, 0), (4, 4, 4)), ((2, 1, 2), (6, 5, 6))),
    502: lambda: solid_pair(((0.8, 0, 0), (5, 4, 4)), ((1, 0.2, 0.2), (5.2, 4.2, 4.2))),
    503: lambda: F().box((0, 2, 0), (3, 5, 3)).box((4.2, 1, 0), (7, 4, 3), "#f2b8b0", RED),
    601: lambda: solid_pair(((0, 0, 0), (4, 5, 3)), ((3, 1, 0), (6, 4, 5))).text(80, 18, "parts of one building"),
    701: lambda: solid_pair(((0, 0, 0), (4, 5, 3)), ((3, 0, 0), (7, 5, 3))).text(80, 18, "two cells"),
    702: lambda: F().box((0, 0, 0), (4, 5, 3), opacity=0.4).dot(*at(5.5, 3, 3)).text(120, 40, "state", RED),
    703: lambda: F().box((0, 1, 0), (3, 4, 2), opacity=0.4).box((4, 1, 0), (7, 4, 2), opacity=0.4)
        .dot(*at(1.5, 2.5, 5), "#44525e").dot(*at(5.5, 2.5, 5), "#44525e")
        .line([at(1.5, 2.5, 5), at(5.5, 2.5, 1)]).line([at(5.5, 2.5, 5), at(1.5, 2.5, 1)]),
    704: lambda: F().box((0, 1, 0), (2.6, 4, 3), opacity=0.4).box((4.4, 1, 0), (7, 4, 3), opacity=0.4)
        .dot(*at(1.3, 2.5, 1.5), "#44525e").dot(*at(5.7, 2.5, 1.5), "#44525e")
        .line([at(1.3, 2.5, 1.5), at(5.7, 2.5, 1.5)]),
    801: lambda: facet().dot(128, 20).dot(133, 25).text(110, 42, "&lt; 1 mm", RED),
    802: lambda: F().area([(20, 30), (100, 30), (100, 100), (20, 100)]).dot(132, 55).text(132, 75, "unused", RED),
    803: lambda: facet().area([(30, 20), (130, 20), (80, 24)], RED, RED, 1).text(80, 42, "&lt; 1 mm", RED),
    804: lambda: F().area([(20, 60), (75, 95), (140, 70), (85, 35)]).line([(20, 60), (140, 70)], "#44525e", 2)
        .line([(75, 95), (85, 35)], RED, 2, "4 3").text(80, 112, "another diagonal"),
    805: lambda: F().text(80, 45, "84616.4679999999999").text(80, 65, "84616.468", RED)
        .line([(60, 75), (100, 75)], RED, 1.5),
    806: lambda: F().area([(25, 85), (95, 95), (135, 60), (65, 45)]).line(
        [(25, 85), (95, 95), (135, 60), (65, 45), (25, 85)]).text(80, 30, "volume 0", RED),
    901: lambda: star(page("?", ""), 81, 64),
    902: lambda: F().line([(40, 30), (120, 30), (120, 95), (40, 95), (40, 30)], "#9aa7b2", 1.5, "4 4")
        .text(80, 66, "no facets", RED),
    903: lambda: F().text(80, 55, "tolerance").text(80, 75, "-1", RED),
    904: lambda: page(".dxf", "?"),
}


def main():
    for code, draw in FIGURES.items():
        (HERE / f"{code}.svg").write_text(draw().svg(), encoding="utf-8")


if __name__ == "__main__":
    main()
