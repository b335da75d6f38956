#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Validity and volume beside SFCGAL's functions in PostGIS: beside_sfcgal.py BUILD DOCUMENT...

Valid solids without cavities of the documents, and a sphere of 360 triangles, as EWKB and as geometry in one table. SFCGAL judges a
solid when it computes its volume (ST_Volume(ST_MakeSolid(...))), as ST_IsValid refuses POLYHEDRALSURFACE. Solids are taken by their
number of facets, and as many as SFCGAL can do in a minute. SFCGAL refuses facets that are not planar to the last bit; such solids are
counted and left out. The volumes of the others are compared.
"""
import math
import pathlib
import subprocess
import sys
import time

from rows import ROOT, Server, copy_solids, say

sys.path.insert(0, str(ROOT / "tests" / "siege"))
from service import temporary_folder  # noqa: E402

CLASSES = ((1, 12), (13, 25), (26, 60), (61, 200), (201, 400))
SECONDS = 60


def sphere(meridians=20, parallels=9):
    """2 x `meridians` x `parallels` triangles around a sphere of radius 5, coordinates in millimetres: WKT."""
    def point(i, j):  # j counts from the south pole
        if j in (0, parallels + 1):
            return f"0 0 {-5 if j == 0 else 5}"
        tilt, turn = math.pi * j / (parallels + 1), 2 * math.pi * (i % meridians) / meridians
        return f"{5 * math.sin(tilt) * math.cos(turn):.3f} {5 * math.sin(tilt) * math.sin(turn):.3f} {-5 * math.cos(tilt):.3f}"

    triangles = []
    for i in range(meridians):
        for j in range(parallels + 1):
            if j > 0:
                triangles.append((point(i, j), point(i + 1, j), point(i + 1, j + 1)))
            if j < parallels:
                triangles.append((point(i, j), point(i + 1, j + 1), point(i, j + 1)))
    # At the south pole the first triangle of a column has both lower points there, at the north pole both upper ones.
    found = [t for t in triangles if len(set(t)) == 3]
    return "POLYHEDRALSURFACE Z (" + ",".join(f"(({a},{b},{c},{a}))" for a, b, c in found) + ")"


def measure(server, what, ids):
    """Prints times of the solids `ids` that SFCGAL can do in a minute."""
    done, refused = [], 0
    start = time.perf_counter()
    for number in ids:
        try:
            found = server.ask("SET statement_timeout = '120s'", f"SELECT ST_Volume(ST_MakeSolid(geom)) - wt_volume(shape) FROM small WHERE id = {number}")
        except subprocess.CalledProcessError as failure:
            if "lie in the same plane" not in failure.stderr:
                raise SystemExit(f"beside_sfcgal: {failure.stderr[-300:]}") from failure
            refused += 1
            continue
        done.append((number, float(found)))
        if time.perf_counter() - start > SECONDS:
            break
    if not done:
        say(what, f"SFCGAL refuses all {refused}: not planar to the last bit")
        return
    chosen = ",".join(number for number, _ in done)
    theirs = server.seconds(f"SELECT count(ST_Volume(ST_MakeSolid(geom))) FROM small WHERE id IN ({chosen})")
    repeats = 50
    empty = server.seconds(f"SELECT count(*) FROM small, generate_series(1, {repeats}) WHERE id IN ({chosen})")
    valid = server.seconds(f"SELECT count(*) FILTER (WHERE wt_is_valid(ewkb)) FROM small, generate_series(1, {repeats}) WHERE id IN ({chosen})")
    volume = server.seconds(f"SELECT sum(wt_volume(shape)) FROM small, generate_series(1, {repeats}) WHERE id IN ({chosen})")
    count = len(done)
    say(f"{what}, {count} solids ({refused} refused by SFCGAL), a solid",
        f"SFCGAL volume {1e3 * theirs / count:9.2f} ms, wt_is_valid {1e3 * (valid - empty) / repeats / count:7.3f} ms, "
        f"wt_volume {1e3 * max(0, volume - empty) / repeats / count:7.4f} ms, largest difference {max(abs(d) for _, d in done):.1e} m3")


def main():
    build = str(pathlib.Path(sys.argv[1]).resolve())
    with temporary_folder("sfcgal") as folder:
        server = Server(build, folder)
        try:
            server.ask("CREATE EXTENSION watertight", "CREATE EXTENSION postgis", "CREATE EXTENSION postgis_sfcgal")
            copy_solids(server, build, sys.argv[2:], "raw")
            # Moved to the origin, where SFCGAL's doubles lose nothing.
            server.ask("""CREATE TABLE small AS SELECT row_number() OVER () AS id, wt_facet_count(s) AS facets, ewkb, s AS shape,
                ST_Translate(ST_GeomFromEWKB(ewkb), -wt_bound(wt_box(s), 1), -wt_bound(wt_box(s), 2), -wt_bound(wt_box(s), 3)) AS geom
                FROM (SELECT ewkb, wt_try_solid(ewkb) AS s FROM raw) r WHERE s IS NOT NULL AND wt_shell_count(s) = 1""",
                       f"""INSERT INTO small SELECT 0, wt_facet_count(s), wt_as_ewkb(s), s, ST_GeomFromEWKB(wt_as_ewkb(s)) FROM (SELECT '{sphere()}'::solid AS s) r""",
                       "CREATE INDEX ON small (id)", "VACUUM ANALYZE small")
            for low, high in CLASSES:
                ids = server.ask(f"SELECT id FROM small WHERE id > 0 AND facets BETWEEN {low} AND {high} ORDER BY id LIMIT 200").split()
                measure(server, f"{low} to {high} facets", ids)
            measure(server, f"sphere of {server.ask('SELECT facets FROM small WHERE id = 0')} triangles", ["0"])
        finally:
            server.stop()


if __name__ == "__main__":
    main()
