#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The measures that 3DBAG states of its buildings, as rows for COPY: given_measures.py FILE

A row is the feature, the name and the value of an attribute b3_volume_* (cubic metres, of the level of detail in its
name) or b3_opp_* (square metres of ground, roofs and walls).
"""
import json
import sys

for line in open(sys.argv[1], encoding="utf-8"):
    feature = json.loads(line)
    for city_object in feature.get("CityObjects", {}).values():
        for name, value in city_object.get("attributes", {}).items():
            if name.startswith(("b3_volume_", "b3_opp_")) and value is not None:
                print(feature["id"], name, value, sep="\t")
