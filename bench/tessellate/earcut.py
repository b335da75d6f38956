#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The speed of Mapbox's earcut.hpp on the regions of `regions speed`: earcut.py BUILD

Needs Debian's python3-mapbox-earcut, the C++ program with a thin layer around it.
"""
import subprocess
import sys
import time

import mapbox_earcut
import numpy


def regions_of(build, count, holes):
    text = subprocess.run([f"{build}/bin/regions", "loops", str(count), str(holes)], check=True, capture_output=True, text=True).stdout
    for block in text.strip().split("\n\n"):
        loops = [numpy.array(line.split(), dtype=numpy.float64).reshape(-1, 2) for line in block.split("\n")]
        ends = numpy.cumsum([len(loop) for loop in loops]).astype(numpy.uint32)
        yield numpy.concatenate(loops), ends


def main():
    print("vertices  holes  million triangles a second: earcut.hpp")
    for count, holes in ((8, 0), (20, 0), (100, 3), (1000, 8), (10000, 20)):
        regions = list(regions_of(sys.argv[1], count, holes))
        least = float("inf")
        for _ in range(5):
            start = time.perf_counter()
            triangles = sum(len(mapbox_earcut.triangulate_float64(points, ends)) // 3 for points, ends in regions)
            least = min(least, time.perf_counter() - start)
        print(f"{count:8}  {holes:5}  {triangles / 1e6 / least:38.2f}")


if __name__ == "__main__":
    main()
