#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Validity and volume beside SFCGAL's functions in PostGIS: beside_sfcgal.py BUILD DOCUMENT...

Valid solids without cavities of the documents, as EWKB and as geometry in one table. SFCGAL judges a solid when it computes its
volume (ST_Volume(ST_MakeSolid(...))), as ST_IsValid refuses POLYHEDRALSURFACE. Solids are taken by their number of facets, and as
many as SFCGAL can do in a minute. The volumes are compared.
"""
import pathlib
import subprocess
import sys
import time

from rows import ROOT, Server, say, timed  # noqa: F401

sys.path.insert(0, str(ROOT / "tests" / "siege"))
from service import temporary_folder  # noqa: E402

CLASSES = ((1, 12), (13, 25), (26, 60), (61, 200), (201, 400), (401, 1000))
SECONDS = 60


def main():
    build = str(pathlib.Path(sys.argv[1]).resolve())
    with temporary_folder("sfcgal") as folder:
        server = Server(build, folder)
        try:
            rows = folder / "rows"
            with rows.open("w") as out:
                subprocess.run([f"{build}/bin/watertight", "rows", *sys.argv[2:]], check=True, stdout=out)
            server.ask("CREATE EXTENSION watertight", "CREATE EXTENSION postgis", "CREATE EXTENSION postgis_sfcgal",
                       "CREATE TABLE raw (feature text, object text, lod text, ewkb bytea)")
            with rows.open() as source:
                server.ask("COPY raw FROM STDIN", stdin=source)
            # Moved to the origin, where SFCGAL's doubles lose nothing.
            server.ask("""CREATE TABLE small AS SELECT row_number() OVER () AS id, wt_facet_count(s) AS facets, ewkb, s AS shape,
                ST_Translate(ST_GeomFromEWKB(ewkb), -wt_bound(wt_box(s), 1), -wt_bound(wt_box(s), 2), -wt_bound(wt_box(s), 3)) AS geom
                FROM (SELECT ewkb, wt_try_solid(ewkb) AS s FROM raw) r WHERE s IS NOT NULL AND wt_shell_count(s) = 1""")
            for low, high in CLASSES:
                ids = server.ask(f"SELECT id FROM small WHERE facets BETWEEN {low} AND {high} ORDER BY id LIMIT 200").split()
                done = []
                start = time.perf_counter()
                for number in ids:
                    found = server.ask("SET statement_timeout = '120s'", f"SELECT ST_Volume(ST_MakeSolid(geom)) - wt_volume(shape) FROM small WHERE id = {number}")
                    done.append((number, float(found)))
                    if time.perf_counter() - start > SECONDS:
                        break
                chosen = ",".join(number for number, _ in done)
                if not done:
                    continue
                theirs = server.seconds(f"SELECT count(ST_Volume(ST_MakeSolid(geom))) FROM small WHERE id IN ({chosen})")
                ours = server.seconds("SELECT count(*) FROM generate_series(1, 5)", f"SELECT count(*) FROM small, generate_series(1, 5) WHERE id IN ({chosen}) AND wt_is_valid(ewkb)") / 5
                volume = server.seconds(f"SELECT sum(wt_volume(shape)) FROM small, generate_series(1, 100) WHERE id IN ({chosen})") / 100
                say(f"{low} to {high} facets, {len(done)} solids, a solid", f"SFCGAL volume {1e3 * theirs / len(done):9.2f} ms, wt_is_valid {1e3 * ours / len(done):7.3f} ms, "
                    f"wt_volume {1e3 * volume / len(done):7.4f} ms, largest difference {max(abs(d) for _, d in done):.1e} m3")
        finally:
            server.stop()


if __name__ == "__main__":
    main()
