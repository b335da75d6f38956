<?xml version="1.0" encoding="UTF-8"?>
<core:CityModel xmlns:core="http://www.opengis.net/citygml/2.0" xmlns:bldg="http://www.opengis.net/citygml/building/2.0" xmlns:gen="http://www.opengis.net/citygml/generics/2.0" xmlns:g="http://www.opengis.net/gml" xmlns:x="http://www.w3.org/1999/xlink" xmlns:ade="http://example.org/ade">
  <g:boundedBy><g:Envelope srsName="urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::5783" srsDimension="3"><g:lowerCorner>0 0 0</g:lowerCorner><g:upperCorner>20 10 10</g:upperCorner></g:Envelope></g:boundedBy>
  <core:cityObjectMember>
    <bldg:Building g:id="house">
      <g:name>Two parts that share a wall</g:name>
      <gen:stringAttribute name="note"><gen:value>1 &lt; 2</gen:value></gen:stringAttribute>
      <bldg:lod2Solid><g:Solid g:id="house-solid"><g:exterior><g:CompositeSurface>
        <!-- forward references -->
        <g:surfaceMember x:href="#ground"/>
        <g:surfaceMember x:href="#west"/>
        <g:surfaceMember x:href="#east"/>
        <g:surfaceMember x:href="#slopes"/>
      </g:CompositeSurface></g:exterior></g:Solid></bldg:lod2Solid>
      <bldg:boundedBy><bldg:GroundSurface g:id="ground-surface"><bldg:lod2MultiSurface><g:MultiSurface><g:surfaceMember>
        <g:Polygon g:id="ground"><g:exterior><g:LinearRing><g:posList>0 0 0 0 10 0 10 10 0 10 0 0 0 0 0</g:posList></g:LinearRing></g:exterior></g:Polygon>
      </g:surfaceMember></g:MultiSurface></bldg:lod2MultiSurface></bldg:GroundSurface></bldg:boundedBy>
      <bldg:boundedBy><bldg:WallSurface><bldg:lod2MultiSurface><g:MultiSurface>
        <g:surfaceMember><g:Polygon g:id="west"><g:exterior><g:LinearRing g:id="west-ring"><g:pos>0 0 0</g:pos><g:pos>5 5 10</g:pos><g:pos>0 10 0</g:pos><g:pos>0 0 0</g:pos></g:LinearRing></g:exterior></g:Polygon></g:surfaceMember>
        <!-- written from inside -->
        <g:surfaceMember><g:OrientableSurface g:id="east" orientation="-"><g:baseSurface><g:Polygon g:id="east-inside"><g:exterior><g:LinearRing><g:posList srsDimension="3">10 0 0 5 5 10 10 10 0 10 0 0</g:posList></g:LinearRing></g:exterior></g:Polygon></g:baseSurface></g:OrientableSurface></g:surfaceMember>
      </g:MultiSurface></bldg:lod2MultiSurface></bldg:WallSurface></bldg:boundedBy>
      <bldg:boundedBy><bldg:RoofSurface><bldg:lod2MultiSurface><g:MultiSurface g:id="slopes">
        <g:surfaceMembers>
          <g:Polygon g:id="south"><g:exterior><g:LinearRing><g:coordinates>0,0,0 10,0,0 5,5,10 0,0,0</g:coordinates></g:LinearRing></g:exterior></g:Polygon>
          <g:Polygon><g:exterior><g:LinearRing><g:coordinates decimal="," cs=";" ts="|">10,0;10;0|0;10;0|5;5;10|10;10;0</g:coordinates></g:LinearRing></g:exterior></g:Polygon>
        </g:surfaceMembers>
      </g:MultiSurface></bldg:lod2MultiSurface></bldg:RoofSurface></bldg:boundedBy>
      <ade:remark><ade:Remark><ade:geometry x:href="#house-solid"/></ade:Remark></ade:remark>
      <bldg:consistsOfBuildingPart><bldg:BuildingPart g:id="part">
        <bldg:lod3Solid x:href="#house-solid"/>
      </bldg:BuildingPart></bldg:consistsOfBuildingPart>
    </bldg:Building>
  </core:cityObjectMember>
</core:CityModel>
