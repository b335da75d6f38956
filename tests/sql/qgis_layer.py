#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Opens a table of PostgreSQL in QGIS, without a screen, and prints what QGIS makes of it.

    qgis_layer.py HOST DATABASE USER TABLE      the geometry is `geom`, the key `id`

Prints the number of features that were read, their geometry and their reference system.
"""
import os
import sys

os.environ["QT_QPA_PLATFORM"] = "offscreen"
from qgis.core import QgsApplication, QgsDataSourceUri, QgsVectorLayer, QgsWkbTypes  # pylint: disable=wrong-import-position

host, database, user, table = sys.argv[1:]
application = QgsApplication([], False)
application.initQgis()
source = QgsDataSourceUri()
source.setConnection(host, "", database, user, "")
source.setDataSource("public", table, "geom", "", "id")
layer = QgsVectorLayer(source.uri(False), table, "postgres")
read = sum(feature.hasGeometry() and not feature.geometry().isEmpty() for feature in layer.getFeatures())
print(read, QgsWkbTypes.displayString(layer.wkbType()), layer.crs().authid())
is_valid = layer.isValid()
del layer  # QGIS crashes if it outlives the application
application.exitQgis()
sys.exit(0 if is_valid else 1)
