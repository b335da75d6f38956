#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes crs_table.cpp: the unit of every EPSG code, from PROJ's database (proj.db).

Usage: make_crs_table.py /usr/share/proj/proj.db > crs_table.cpp
The units are those of the first axis; of the third one where it is another.
"""
import sqlite3
import sys

UNITS = {
    "metre": "metre",
    "US survey foot": "us_survey_foot",
    "foot": "foot",
    "degree (supplier to define representation)": "degree",
    "degree minute second hemisphere": "degree",
    "grad": "grad",
    "kilometre": "kilometre",
    "German legal metre": "german_legal_metre",
    "Indian yard": "indian_yard",
    "Clarke's foot": "clarke_foot",
    "Clarke's link": "clarke_link",
    "Clarke's yard": "clarke_yard",
    "Gold Coast foot": "gold_coast_foot",
    "link": "link",
    "British yard (Sears 1922)": "sears_yard",
    "British foot (Sears 1922)": "sears_foot",
    "British chain (Sears 1922)": "sears_chain",
    "British chain (Sears 1922 truncated)": "sears_chain_truncated",
    "British chain (Benoit 1895 B)": "benoit_chain",
}
PER_LINE = 5


def rows(cursor, query):
    return cursor.execute(query).fetchall()


def units_by_code(cursor):
    unit = {code: name for code, name in rows(
        cursor, "select code, name from unit_of_measure where auth_name = 'EPSG'")}
    axes = {}
    for system, uom in rows(
            cursor, "select coordinate_system_code, uom_code from axis where auth_name = 'EPSG'"
                    " order by coordinate_system_code, coordinate_system_order"):
        axes.setdefault(system, []).append(UNITS.get(unit.get(uom)))
    result = {}
    for table in ("geodetic_crs", "projected_crs"):
        for code, system in rows(
                cursor, f"select code, coordinate_system_code from {table} where auth_name = 'EPSG'"):
            if axes.get(system, [None])[0]:
                result[int(code)] = axes[system]
    vertical = {code: axes.get(system) for code, system in rows(
        cursor, "select code, coordinate_system_code from vertical_crs where auth_name = 'EPSG'")}
    for code, horizontal, height in rows(
            cursor, "select code, horiz_crs_code, vertical_crs_code from compound_crs"
                    " where auth_name = 'EPSG'"):
        if int(horizontal) in result and vertical.get(height):
            result[int(code)] = result[int(horizontal)][:2] + vertical[height]
    return result


def name_of(units):
    plane = units[0]
    if len(units) < 3 or units[2] == plane or (plane in ("degree", "grad") and units[2] == "metre"):
        return plane
    return f"{plane}_{units[2]}"


def main():
    cursor = sqlite3.connect(sys.argv[1]).cursor()
    version = dict(rows(cursor, "select key, value from metadata"))["EPSG.VERSION"]
    runs = []
    for code, units in sorted(units_by_code(cursor).items()):
        name = name_of(units)
        if runs and runs[-1][2] == name and runs[-1][1] == code - 1:
            runs[-1][1] = code
        else:
            runs.append([code, code, name])
    print("// SPDX-License-Identifier: GPL-3.0-or-later")
    print("//")
    print(f"// Made by make_crs_table.py from PROJ's database, EPSG data set {version}")
    print("// (epsg.org, terms of use: epsg.org/terms-of-use.html). Not edited by hand.")
    print('#include "geometry/crs/crs_table.h"\n')
    print("namespace watertight {\nnamespace {\n")
    names = sorted({run[2] for run in runs})
    letters = {}
    for name in names:
        short = "".join(part[0] for part in name.split("_"))
        while short in letters.values():
            short += "x"
        letters[name] = short
        print(f"constexpr CrsUnit {short} = CrsUnit::{name};")
    print("\n// clang-format off\nconstexpr CrsRun kRuns[] = {")
    for i in range(0, len(runs), PER_LINE):
        print(" ", " ".join(f"{{{a}, {b}, {letters[n]}}}," for a, b, n in runs[i:i + PER_LINE]))
    print("};\n// clang-format on\n")
    print("}  // namespace\n")
    print("std::span<const CrsRun> crs_runs() { return kRuns; }\n")
    print("}  // namespace watertight")


if __name__ == "__main__":
    main()
