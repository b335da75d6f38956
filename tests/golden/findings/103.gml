<?xml version="1.0" encoding="UTF-8"?>
<gml:Solid xmlns:gml="http://www.opengis.net/gml/3.2" gml:id="sample" srsDimension="3">
  <gml:exterior>
   <gml:Shell>
     <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 0 4 0 4 0 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
     <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 4 0 0 0 0 4 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
     <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>4 0 0 0 4 0 0 0 4</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
     <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 4 0 0 0 0 0 0 4 0 4 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
   </gml:Shell>
  </gml:exterior>
</gml:Solid>
