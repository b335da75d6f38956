<?xml version="1.0" encoding="UTF-8"?>
<CityModel xmlns="http://www.opengis.net/citygml/3.0" xmlns:bldg="http://www.opengis.net/citygml/building/3.0" xmlns:con="http://www.opengis.net/citygml/construction/3.0" xmlns:frn="http://www.opengis.net/citygml/cityfurniture/3.0" xmlns:gml="http://www.opengis.net/gml/3.2" xmlns:xlink="http://www.w3.org/1999/xlink" gml:id="model">
  <cityObjectMember><bldg:Building gml:id="tower">
    <gml:boundedBy><gml:Envelope srsName="urn:adv:crs:ETRS89_UTM33*DE_DHHN2016_NH" srsDimension="3"><gml:lowerCorner>0 0 0</gml:lowerCorner><gml:upperCorner>1 1 1</gml:upperCorner></gml:Envelope></gml:boundedBy>
    <boundary><con:GroundSurface gml:id="tower-ground"><lod2MultiSurface><gml:MultiSurface><gml:surfaceMember>
      <gml:Polygon gml:id="p0"><gml:exterior><gml:LinearRing><gml:posList>0.00 0 0 0 0.10 0 0.10 0 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon>
    </gml:surfaceMember></gml:MultiSurface></lod2MultiSurface></con:GroundSurface></boundary>
    <lod2Solid><gml:Solid><gml:exterior><gml:Shell>
      <gml:surfaceMember xlink:href="#p0"/>
      <gml:surfaceMember><gml:Polygon gml:id="p1"><gml:exterior><gml:LinearRing><gml:posList>0 0 0 0.1 0 0 0 0 0.1 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
      <gml:surfaceMember><gml:Polygon gml:id="p2"><gml:exterior><gml:LinearRing><gml:posList>1e-1 0 0 0 1E-1 0 0 0 .1 0.1 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
      <gml:surfaceMember><gml:Polygon gml:id="p3"><gml:exterior><gml:LinearRing><gml:posList>0 0.1 0 <!-- origin --> 0 0 0 <![CDATA[0 0 0.1]]>
        0 0.1 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
    </gml:Shell></gml:exterior></gml:Solid></lod2Solid>
    <bldg:buildingPart><bldg:BuildingPart gml:id="tower-part"><lod1Solid><gml:MultiSolid>
      <gml:solidMember xlink:href="#bench-solid"/>
    </gml:MultiSolid></lod1Solid></bldg:BuildingPart></bldg:buildingPart>
  </bldg:Building></cityObjectMember>
  <cityObjectMember><frn:CityFurniture gml:id="bench">
    <lod3ImplicitRepresentation><ImplicitGeometry><relativeGeometry>
      <gml:Solid gml:id="bench-solid"><gml:exterior><gml:Shell><gml:surfaceMembers>
        <gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 0 1 0 1 0 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon>
        <gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 1 0 0 0 0 1 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon>
        <gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>1 0 0 0 1 0 0 0 1 1 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon>
        <gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 1 0 0 0 0 0 0 1 0 1 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon>
      </gml:surfaceMembers></gml:Shell></gml:exterior></gml:Solid>
    </relativeGeometry></ImplicitGeometry></lod3ImplicitRepresentation>
  </frn:CityFurniture></cityObjectMember>
</CityModel>
