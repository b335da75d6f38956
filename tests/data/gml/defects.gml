<?xml version="1.0" encoding="UTF-8"?>
<!-- One building per defect; its gml:id begins with the code. -->
<CityModel xmlns="http://www.opengis.net/citygml/2.0" xmlns:bldg="http://www.opengis.net/citygml/building/2.0" xmlns:gml="http://www.opengis.net/gml">
<cityObjectMember><bldg:Building gml:id="b-valid-cube"><bldg:lod1Solid><gml:Solid><gml:exterior><gml:CompositeSurface>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 0 10 0 10 10 0 10 0 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 10 10 0 10 10 10 10 0 10 10 0 0 10</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 10 0 0 10 0 10 0 0 10 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 0 0 10 10 0 10 10 10 10 0 10 10 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 10 0 0 10 0 0 10 10 10 10 10 10 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 10 0 0 0 0 0 0 10 0 10 10 0 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
</gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod1Solid></bldg:Building></cityObjectMember>
<cityObjectMember><bldg:Building gml:id="b-valid-three-triangles"><bldg:lod1Solid><gml:Solid><gml:exterior><gml:CompositeSurface>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 0 10 0 10 10 0 10 0 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 10 10 0 10 10 10 10 0 0 10</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember><gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 10 10 10 10 0 10 10 0 0 10</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 10 0 0 10 0 10 0 0 10 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 0 0 10 10 0 10 10 10 10 0 10 10 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 10 0 0 10 0 0 10 10 10 10 10 10 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 10 0 0 0 0 0 0 10 0 10 10 0 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
</gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod1Solid></bldg:Building></cityObjectMember>
<cityObjectMember><bldg:Building gml:id="b-valid-far"><bldg:lod1Solid><gml:Solid><gml:exterior><gml:CompositeSurface>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>99999990 99999990 0 99999990 100000000 0 100000000 100000000 0 100000000 99999990 0 99999990 99999990 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>99999990 99999990 10 100000000 99999990 10 100000000 100000000 10 99999990 100000000 10 99999990 99999990 10</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>99999990 99999990 0 100000000 99999990 0 100000000 99999990 10 99999990 99999990 10 99999990 99999990 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>100000000 99999990 0 100000000 100000000 0 100000000 100000000 10 100000000 99999990 10 100000000 99999990 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>100000000 100000000 0 99999990 100000000 0 99999990 100000000 10 100000000 100000000 10 100000000 100000000 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>99999990 100000000 0 99999990 99999990 0 99999990 99999990 10 99999990 100000000 10 99999990 100000000 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
</gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod1Solid></bldg:Building></cityObjectMember>
<cityObjectMember><bldg:Building gml:id="b-valid-below-zero"><bldg:lod1Solid><gml:Solid><gml:exterior><gml:CompositeSurface>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 -100 0 10 -100 10 10 -100 10 0 -100 0 0 -100</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 -90 10 0 -90 10 10 -90 0 10 -90 0 0 -90</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 -100 10 0 -100 10 0 -90 0 0 -90 0 0 -100</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 0 -100 10 10 -100 10 10 -90 10 0 -90 10 0 -100</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 10 -100 0 10 -100 0 10 -90 10 10 -90 10 10 -100</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 10 -100 0 0 -100 0 0 -90 0 10 -90 0 10 -100</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
</gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod1Solid></bldg:Building></cityObjectMember>
<cityObjectMember><bldg:Building gml:id="b-valid-roof"><bldg:lod1Solid><gml:Solid><gml:exterior><gml:CompositeSurface>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 0 10 0 10 10 0 10 0 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 10 10 0 10 5 5 14 0 0 10</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember><gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 0 10 10 10 10 5 5 14 10 0 10</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember><gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 10 10 0 10 10 5 5 14 10 10 10</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember><gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 10 10 0 0 10 5 5 14 0 10 10</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 10 0 0 10 0 10 0 0 10 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 0 0 10 10 0 10 10 10 10 0 10 10 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 10 0 0 10 0 0 10 10 10 10 10 10 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 10 0 0 0 0 0 0 10 0 10 10 0 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
</gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod1Solid></bldg:Building></cityObjectMember>
<cityObjectMember><bldg:Building gml:id="b-valid-filled-hole"><bldg:lod1Solid><gml:Solid><gml:exterior><gml:CompositeSurface>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 0 10 0 10 10 0 10 0 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 10 10 0 10 10 10 10 0 10 10 0 0 10</gml:posList></gml:LinearRing></gml:exterior><gml:interior><gml:LinearRing><gml:posList>3 3 10 3 7 10 7 7 10 7 3 10 3 3 10</gml:posList></gml:LinearRing></gml:interior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 10 0 0 10 0 10 0 0 10 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 0 0 10 10 0 10 10 10 10 0 10 10 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 10 0 0 10 0 0 10 10 10 10 10 10 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 10 0 0 0 0 0 0 10 0 10 10 0 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>7 3 10 7 7 10 3 7 10 3 3 10 7 3 10</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
</gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod1Solid></bldg:Building></cityObjectMember>
<cityObjectMember><bldg:Building gml:id="b-101"><bldg:lod1Solid><gml:Solid><gml:exterior><gml:CompositeSurface>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 0 10 0 10 10 0 10 0 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 10 10 0 10 0 0 10</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 10 0 0 10 0 10 0 0 10 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 0 0 10 10 0 10 10 10 10 0 10 10 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 10 0 0 10 0 0 10 10 10 10 10 10 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 10 0 0 0 0 0 0 10 0 10 10 0 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
</gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod1Solid></bldg:Building></cityObjectMember>
<cityObjectMember><bldg:Building gml:id="b-102"><bldg:lod1Solid><gml:Solid><gml:exterior><gml:CompositeSurface>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 0 10 0 10 10 0 10 0 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 10 10 0 10 10 0 10 10 10 10 0 10 10 0 0 10</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 10 0 0 10 0 10 0 0 10 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 0 0 10 10 0 10 10 10 10 0 10 10 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 10 0 0 10 0 0 10 10 10 10 10 10 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 10 0 0 0 0 0 0 10 0 10 10 0 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
</gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod1Solid></bldg:Building></cityObjectMember>
<cityObjectMember><bldg:Building gml:id="b-103"><bldg:lod1Solid><gml:Solid><gml:exterior><gml:CompositeSurface>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 0 10 0 10 10 0 10 0 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 10 10 0 10 10 10 10 0 10 10</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 10 0 0 10 0 10 0 0 10 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 0 0 10 10 0 10 10 10 10 0 10 10 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 10 0 0 10 0 0 10 10 10 10 10 10 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 10 0 0 0 0 0 0 10 0 10 10 0 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
</gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod1Solid></bldg:Building></cityObjectMember>
<cityObjectMember><bldg:Building gml:id="b-104"><bldg:lod1Solid><gml:Solid><gml:exterior><gml:CompositeSurface>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 0 10 0 10 10 0 10 0 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 10 10 10 10 10 0 10 0 10 10 0 0 10</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 10 0 0 10 0 10 0 0 10 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 0 0 10 10 0 10 10 10 10 0 10 10 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 10 0 0 10 0 0 10 10 10 10 10 10 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 10 0 0 0 0 0 0 10 0 10 10 0 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
</gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod1Solid></bldg:Building></cityObjectMember>
<cityObjectMember><bldg:Building gml:id="b-104-collapsed-hole"><bldg:lod1Solid><gml:Solid><gml:exterior><gml:CompositeSurface>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 0 10 0 10 10 0 10 0 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 10 10 0 10 10 10 10 0 10 10 0 0 10</gml:posList></gml:LinearRing></gml:exterior><gml:interior><gml:LinearRing><gml:posList>3 3 10 7 3 10 5 3 10 3 3 10</gml:posList></gml:LinearRing></gml:interior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 10 0 0 10 0 10 0 0 10 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 0 0 10 10 0 10 10 10 10 0 10 10 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 10 0 0 10 0 0 10 10 10 10 10 10 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 10 0 0 0 0 0 0 10 0 10 10 0 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
</gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod1Solid></bldg:Building></cityObjectMember>
<cityObjectMember><bldg:Building gml:id="b-201"><bldg:lod1Solid><gml:Solid><gml:exterior><gml:CompositeSurface>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 0 10 0 10 10 0 10 0 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 10 10 0 10 10 10 10 0 10 10 0 0 10</gml:posList></gml:LinearRing></gml:exterior><gml:interior><gml:LinearRing><gml:posList>6 3 10 6 7 10 12 7 10 12 3 10 6 3 10</gml:posList></gml:LinearRing></gml:interior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 10 0 0 10 0 10 0 0 10 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 0 0 10 10 0 10 10 10 10 0 10 10 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 10 0 0 10 0 0 10 10 10 10 10 10 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 10 0 0 0 0 0 0 10 0 10 10 0 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
</gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod1Solid></bldg:Building></cityObjectMember>
<cityObjectMember><bldg:Building gml:id="b-202"><bldg:lod1Solid><gml:Solid><gml:exterior><gml:CompositeSurface>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 0 10 0 10 10 0 10 0 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 10 10 0 10 10 10 10 0 10 10 0 0 10</gml:posList></gml:LinearRing></gml:exterior><gml:interior><gml:LinearRing><gml:posList>3 3 10 3 7 10 7 7 10 7 3 10 3 3 10</gml:posList></gml:LinearRing></gml:interior><gml:interior><gml:LinearRing><gml:posList>3 3 10 3 7 10 7 7 10 7 3 10 3 3 10</gml:posList></gml:LinearRing></gml:interior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 10 0 0 10 0 10 0 0 10 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 0 0 10 10 0 10 10 10 10 0 10 10 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 10 0 0 10 0 0 10 10 10 10 10 10 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 10 0 0 0 0 0 0 10 0 10 10 0 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>7 3 10 7 7 10 3 7 10 3 3 10 7 3 10</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
</gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod1Solid></bldg:Building></cityObjectMember>
<cityObjectMember><bldg:Building gml:id="b-204"><bldg:lod1Solid><gml:Solid><gml:exterior><gml:CompositeSurface>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 0 10 0 10 10 0 10 0 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 10 5 0 10 5.0005 0 10.004 5.001 0 10 10 0 10 10 10 10 5.001 10 10 5.0005 10 10.004 5 10 10 0 10 10 0 0 10</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 10 0 0 10 0 10 5.001 0 10 5.0005 0 10.004 5 0 10 0 0 10 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 0 0 10 10 0 10 10 10 10 0 10 10 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 10 0 0 10 0 0 10 10 5 10 10 5.0005 10 10.004 5.001 10 10 10 10 10 10 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 10 0 0 0 0 0 0 10 0 10 10 0 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
</gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod1Solid></bldg:Building></cityObjectMember>
<cityObjectMember><bldg:Building gml:id="b-205"><bldg:lod1Solid><gml:Solid><gml:exterior><gml:CompositeSurface>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 0 10 0 10 10 0 10 0 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 10 10 0 10 10 10 10 0 10 10 0 0 10</gml:posList></gml:LinearRing></gml:exterior><gml:interior><gml:LinearRing><gml:posList>0 0 10 2 5 10 10 10 10 5 2 10 0 0 10</gml:posList></gml:LinearRing></gml:interior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 10 0 0 10 0 10 0 0 10 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 0 0 10 10 0 10 10 10 10 0 10 10 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 10 0 0 10 0 0 10 10 10 10 10 10 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 10 0 0 0 0 0 0 10 0 10 10 0 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
</gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod1Solid></bldg:Building></cityObjectMember>
<cityObjectMember><bldg:Building gml:id="b-206"><bldg:lod1Solid><gml:Solid><gml:exterior><gml:CompositeSurface>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 0 10 0 10 10 0 10 0 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 10 10 0 10 10 10 10 0 10 10 0 0 10</gml:posList></gml:LinearRing></gml:exterior><gml:interior><gml:LinearRing><gml:posList>12 12 10 12 14 10 14 14 10 14 12 10 12 12 10</gml:posList></gml:LinearRing></gml:interior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 10 0 0 10 0 10 0 0 10 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 0 0 10 10 0 10 10 10 10 0 10 10 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 10 0 0 10 0 0 10 10 10 10 10 10 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 10 0 0 0 0 0 0 10 0 10 10 0 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
</gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod1Solid></bldg:Building></cityObjectMember>
<cityObjectMember><bldg:Building gml:id="b-207"><bldg:lod1Solid><gml:Solid><gml:exterior><gml:CompositeSurface>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 0 10 0 10 10 0 10 0 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 10 10 0 10 10 10 10 0 10 10 0 0 10</gml:posList></gml:LinearRing></gml:exterior><gml:interior><gml:LinearRing><gml:posList>2 2 10 2 8 10 8 8 10 8 2 10 2 2 10</gml:posList></gml:LinearRing></gml:interior><gml:interior><gml:LinearRing><gml:posList>4 4 10 4 6 10 6 6 10 6 4 10 4 4 10</gml:posList></gml:LinearRing></gml:interior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 10 0 0 10 0 10 0 0 10 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 0 0 10 10 0 10 10 10 10 0 10 10 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 10 0 0 10 0 0 10 10 10 10 10 10 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 10 0 0 0 0 0 0 10 0 10 10 0 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
</gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod1Solid></bldg:Building></cityObjectMember>
<cityObjectMember><bldg:Building gml:id="b-208"><bldg:lod1Solid><gml:Solid><gml:exterior><gml:CompositeSurface>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 0 10 0 10 10 0 10 0 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 10 10 0 10 10 10 10 0 10 10 0 0 10</gml:posList></gml:LinearRing></gml:exterior><gml:interior><gml:LinearRing><gml:posList>7 3 10 7 7 10 3 7 10 3 3 10 7 3 10</gml:posList></gml:LinearRing></gml:interior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 10 0 0 10 0 10 0 0 10 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 0 0 10 10 0 10 10 10 10 0 10 10 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 10 0 0 10 0 0 10 10 10 10 10 10 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 10 0 0 0 0 0 0 10 0 10 10 0 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>7 3 10 7 7 10 3 7 10 3 3 10 7 3 10</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
</gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod1Solid></bldg:Building></cityObjectMember>
<cityObjectMember><bldg:Building gml:id="b-301"><bldg:lod1Solid><gml:Solid><gml:exterior><gml:CompositeSurface>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 0 10 0 10 10 0 10 0 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 10 0 0 10 0 10 0 0 10 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 0 0 10 10 0 10 10 10 10 0 10 10 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
</gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod1Solid></bldg:Building></cityObjectMember>
<cityObjectMember><bldg:Building gml:id="b-302"><bldg:lod1Solid><gml:Solid><gml:exterior><gml:CompositeSurface>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 10 10 0 10 10 10 10 0 10 10 0 0 10</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 10 0 0 10 0 10 0 0 10 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 0 0 10 10 0 10 10 10 10 0 10 10 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 10 0 0 10 0 0 10 10 10 10 10 10 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 10 0 0 0 0 0 0 10 0 10 10 0 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
</gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod1Solid></bldg:Building></cityObjectMember>
<cityObjectMember><bldg:Building gml:id="b-303"><bldg:lod1Solid><gml:Solid><gml:exterior><gml:CompositeSurface>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 0 10 0 10 10 0 10 0 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 10 10 0 10 10 10 10 0 10 10 0 0 10</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 10 0 0 10 0 10 0 0 10 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 0 0 10 10 0 10 10 10 10 0 10 10 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 10 0 0 10 0 0 10 10 10 10 10 10 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 10 0 0 0 0 0 0 10 0 10 10 0 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 10 10 14 12 14 12 14 14 10 10 10</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
</gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod1Solid></bldg:Building></cityObjectMember>
<cityObjectMember><bldg:Building gml:id="b-302-vertex-on-edge"><bldg:lod1Solid><gml:Solid><gml:exterior><gml:CompositeSurface>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 0 10 0 10 10 0 10 0 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 10 5 0 10 10 0 10 10 10 10 0 10 10 0 0 10</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 10 0 0 10 0 10 0 0 10 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 0 0 10 10 0 10 10 10 10 0 10 10 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 10 0 0 10 0 0 10 10 10 10 10 10 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 10 0 0 0 0 0 0 10 0 10 10 0 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
</gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod1Solid></bldg:Building></cityObjectMember>
<cityObjectMember><bldg:Building gml:id="b-305"><bldg:lod1Solid><gml:Solid><gml:exterior><gml:CompositeSurface>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 0 10 0 10 10 0 10 0 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 10 10 0 10 10 10 10 0 10 10 0 0 10</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 10 0 0 10 0 10 0 0 10 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 0 0 10 10 0 10 10 10 10 0 10 10 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 10 0 0 10 0 0 10 10 10 10 10 10 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 10 0 0 0 0 0 0 10 0 10 10 0 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>20 20 20 24 20 20 20 24 20 20 20 20</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
</gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod1Solid></bldg:Building></cityObjectMember>
<cityObjectMember><bldg:Building gml:id="b-306"><bldg:lod1Solid><gml:Solid><gml:exterior><gml:CompositeSurface>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 0 10 0 10 10 0 10 0 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 10 10 0 10 5 5 -4 0 0 10</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember><gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 0 10 10 10 10 5 5 -4 10 0 10</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember><gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 10 10 0 10 10 5 5 -4 10 10 10</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember><gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 10 10 0 0 10 5 5 -4 0 10 10</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 10 0 0 10 0 10 0 0 10 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 0 0 10 10 0 10 10 10 10 0 10 10 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 10 0 0 10 0 0 10 10 10 10 10 10 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 10 0 0 0 0 0 0 10 0 10 10 0 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
</gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod1Solid></bldg:Building></cityObjectMember>
<cityObjectMember><bldg:Building gml:id="b-305-face-in-face"><bldg:lod1Solid><gml:Solid><gml:exterior><gml:CompositeSurface>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 0 10 0 10 10 0 10 0 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 10 10 0 10 10 10 10 0 10 10 0 0 10</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 10 0 0 10 0 10 0 0 10 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 0 0 10 10 0 10 10 10 10 0 10 10 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 10 0 0 10 0 0 10 10 10 10 10 10 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 10 0 0 0 0 0 0 10 0 10 10 0 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>3 3 10 7 3 10 7 7 10 3 7 10 3 3 10</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
</gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod1Solid></bldg:Building></cityObjectMember>
<cityObjectMember><bldg:Building gml:id="b-307"><bldg:lod1Solid><gml:Solid><gml:exterior><gml:CompositeSurface>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 0 10 0 10 10 0 10 0 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 10 10 0 10 10 10 10 0 10 10 0 0 10</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 10 10 0 10 10 0 0 0 0 0 0 0 10</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 0 0 10 10 0 10 10 10 10 0 10 10 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 10 0 0 10 0 0 10 10 10 10 10 10 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 10 0 0 0 0 0 0 10 0 10 10 0 10 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
</gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod1Solid></bldg:Building></cityObjectMember>
<cityObjectMember><bldg:Building gml:id="b-405"><bldg:lod1Solid><gml:Solid><gml:exterior><gml:CompositeSurface>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 0 0 10 10 0 0 10 0 0 0 0 10 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 10 10 10 10 10 10 0 10 0 0 10 0 10 10</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 10 10 0 10 10 0 0 0 0 0 0 0 10</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 0 10 10 10 10 10 10 0 10 0 0 10 0 10</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>10 10 10 0 10 10 0 10 0 10 10 0 10 10 10</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
  <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 10 10 0 0 10 0 0 0 0 10 0 0 10 10</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
</gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod1Solid></bldg:Building></cityObjectMember>
</CityModel>
