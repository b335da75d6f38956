<?xml version="1.0" encoding="UTF-8"?>
<gml:Solid xmlns:gml="http://www.opengis.net/gml/3.2" gml:id="nested" srsName="http://www.opengis.net/def/crs/EPSG/0/7415" srsDimension="3">
  <gml:exterior><gml:Shell><gml:surfaceMember>
    <gml:TriangulatedSurface gml:id="hull"><gml:patches>
      <gml:Triangle><gml:exterior><gml:LinearRing><gml:posList>0 0 0 0 9 0 9 0 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Triangle>
      <gml:Triangle><gml:exterior><gml:LinearRing><gml:posList>0 0 0 9 0 0 0 0 9 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Triangle>
      <gml:Triangle><gml:exterior><gml:LinearRing><gml:posList>9 0 0 0 9 0 0 0 9 9 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Triangle>
      <gml:Triangle><gml:exterior><gml:LinearRing><gml:posList>0 9 0 0 0 0 0 0 9 0 9 0</gml:posList></gml:LinearRing></gml:exterior></gml:Triangle>
    </gml:patches></gml:TriangulatedSurface>
  </gml:surfaceMember></gml:Shell></gml:exterior>
  <gml:interior><gml:Shell>
    <gml:surfaceMember><gml:Surface><gml:patches>
      <gml:PolygonPatch><gml:exterior><gml:LinearRing><gml:posList>1 1 1 2 1 1 1 2 1 1 1 1</gml:posList></gml:LinearRing></gml:exterior></gml:PolygonPatch>
      <gml:PolygonPatch><gml:exterior><gml:LinearRing><gml:posList>1 1 1 1 1 2 2 1 1 1 1 1</gml:posList></gml:LinearRing></gml:exterior></gml:PolygonPatch>
      <gml:PolygonPatch><gml:exterior><gml:LinearRing><gml:posList>2 1 1 1 1 2 1 2 1 2 1 1</gml:posList></gml:LinearRing></gml:exterior></gml:PolygonPatch>
    </gml:patches></gml:Surface></gml:surfaceMember>
    <gml:surfaceMember><gml:Polygon gml:id="last"><gml:exterior><gml:LinearRing><gml:pos>1 2 1</gml:pos><gml:pos>1 1 2</gml:pos><gml:pos>1 1 1</gml:pos><gml:pos>1 2 1</gml:pos></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  </gml:Shell></gml:interior>
</gml:Solid>
