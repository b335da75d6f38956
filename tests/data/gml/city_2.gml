<?xml version="1.0" encoding="UTF-8"?>
<!-- Written for the tests of the conversion to CityJSON: one of everything of CityGML 2.0. -->
<core:CityModel xmlns:core="http://www.opengis.net/citygml/2.0"
    xmlns:bldg="http://www.opengis.net/citygml/building/2.0"
    xmlns:gen="http://www.opengis.net/citygml/generics/2.0"
    xmlns:tran="http://www.opengis.net/citygml/transportation/2.0"
    xmlns:veg="http://www.opengis.net/citygml/vegetation/2.0"
    xmlns:dem="http://www.opengis.net/citygml/relief/2.0"
    xmlns:frn="http://www.opengis.net/citygml/cityfurniture/2.0"
    xmlns:grp="http://www.opengis.net/citygml/cityobjectgroup/2.0"
    xmlns:app="http://www.opengis.net/citygml/appearance/2.0"
    xmlns:xAL="urn:oasis:names:tc:ciq:xsdschema:xAL:2.0"
    xmlns:ade="https://example.org/ade" xmlns:gml="http://www.opengis.net/gml"
    xmlns:xlink="http://www.w3.org/1999/xlink">
  <gml:description>no place in CityJSON</gml:description>
  <gml:name>Sample town</gml:name>
  <gml:boundedBy><gml:Envelope srsName="EPSG:25832" srsDimension="3">
    <gml:lowerCorner>0 0 0</gml:lowerCorner><gml:upperCorner>30 10 10.50</gml:upperCorner>
  </gml:Envelope></gml:boundedBy>
  <core:cityObjectMember>
    <bldg:Building gml:id="house">
      <gml:name>A house</gml:name>
      <gml:name codeSpace="https://example.org/names">Ein Haus</gml:name>
      <core:creationDate>2026-11-23</core:creationDate>
      <core:externalReference>
        <core:informationSystem>https://example.org/register</core:informationSystem>
        <core:externalObject><core:name>H-1</core:name></core:externalObject>
      </core:externalReference>
      <gen:stringAttribute name="key"><gen:value>007</gen:value></gen:stringAttribute>
      <gen:intAttribute name="flats"><gen:value>3</gen:value></gen:intAttribute>
      <gen:doubleAttribute name="share"><gen:value>0.330</gen:value></gen:doubleAttribute>
      <gen:doubleAttribute name="odd"><gen:value>+.5</gen:value></gen:doubleAttribute>
      <gen:dateAttribute name="approved"><gen:value>2012-03-09</gen:value></gen:dateAttribute>
      <gen:uriAttribute name="page"><gen:value>https://example.org</gen:value></gen:uriAttribute>
      <gen:measureAttribute name="width"><gen:value uom="m">20.75</gen:value></gen:measureAttribute>
      <gen:stringAttribute name="function"><gen:value>taken</gen:value></gen:stringAttribute>
      <gen:genericAttributeSet name="masses">
        <gen:measureAttribute name="volume"><gen:value uom="m3">1260.00</gen:value></gen:measureAttribute>
        <gen:stringAttribute name="source"><gen:value>survey</gen:value></gen:stringAttribute>
      </gen:genericAttributeSet>
      <bldg:class codeSpace="https://example.org/class">1000</bldg:class>
      <bldg:function>1010</bldg:function>
      <bldg:function>1020</bldg:function>
      <bldg:yearOfConstruction>1907</bldg:yearOfConstruction>
      <bldg:measuredHeight uom="m">10.50</bldg:measuredHeight>
      <bldg:storeysAboveGround>2</bldg:storeysAboveGround>
      <bldg:storeyHeightsAboveGround uom="m">5.0 5.50</bldg:storeyHeightsAboveGround>
      <ade:owner><ade:Person gml:id="p1"><ade:name>Ada</ade:name><ade:area uom="m2">80.0</ade:area></ade:Person></ade:owner>
      <bldg:lod0RoofEdge><gml:MultiSurface><gml:surfaceMember>
        <gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 9 1 0 9 0 1 9 0 0 9</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon>
      </gml:surfaceMember></gml:MultiSurface></bldg:lod0RoofEdge>
      <bldg:lod2Solid><gml:Solid><gml:exterior><gml:CompositeSurface>
        <gml:surfaceMember xlink:href="#base"/>
        <gml:surfaceMember xlink:href="#west"/>
        <gml:surfaceMember xlink:href="#south"/>
        <gml:surfaceMember><gml:OrientableSurface orientation="-"><gml:baseSurface xlink:href="#slope"/></gml:OrientableSurface></gml:surfaceMember>
      </gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod2Solid>
      <bldg:lod2MultiCurve><gml:MultiCurve><gml:curveMember>
        <gml:LineString><gml:posList>0 0 0 0 0 1</gml:posList></gml:LineString>
      </gml:curveMember></gml:MultiCurve></bldg:lod2MultiCurve>
      <bldg:lod2TerrainIntersection><gml:MultiCurve><gml:curveMember>
        <gml:LineString><gml:posList>0 0 0 1 0 0</gml:posList></gml:LineString>
      </gml:curveMember></gml:MultiCurve></bldg:lod2TerrainIntersection>
      <bldg:outerBuildingInstallation>
        <bldg:BuildingInstallation gml:id="chimney">
          <bldg:lod2Geometry><gml:MultiSurface><gml:surfaceMember>
            <gml:Polygon gml:id="lid"><gml:exterior><gml:LinearRing gml:id="lid-ring"><gml:posList>0 0 8 1 0 8 0 1 8 0 0 8</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon>
          </gml:surfaceMember></gml:MultiSurface></bldg:lod2Geometry>
        </bldg:BuildingInstallation>
      </bldg:outerBuildingInstallation>
      <bldg:boundedBy><bldg:GroundSurface gml:id="ground"><bldg:lod2MultiSurface><gml:MultiSurface><gml:surfaceMember>
        <gml:Polygon gml:id="base"><gml:exterior><gml:LinearRing><gml:posList>0 0 0 0 1 0 1 0 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon>
      </gml:surfaceMember></gml:MultiSurface></bldg:lod2MultiSurface></bldg:GroundSurface></bldg:boundedBy>
      <bldg:boundedBy><bldg:WallSurface gml:id="walls">
        <gml:name>walls of the house</gml:name>
        <gen:doubleAttribute name="area"><gen:value>1.0</gen:value></gen:doubleAttribute>
        <bldg:lod2MultiSurface><gml:MultiSurface gml:id="walls-2">
          <gml:surfaceMember><gml:Polygon gml:id="west"><gml:exterior><gml:LinearRing gml:id="west-ring"><gml:posList>0 0 0 0 0 1 0 1 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
          <gml:surfaceMember><gml:Polygon gml:id="south"><gml:exterior><gml:LinearRing><gml:posList>0 0 0 1 0 0 0 0 1 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
        </gml:MultiSurface></bldg:lod2MultiSurface>
        <bldg:opening><bldg:Door gml:id="door">
          <bldg:lod3MultiSurface><gml:MultiSurface><gml:surfaceMember>
            <gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0.1 0 0 0.1 0.5 0 0.2 0.5 0 0.1 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon>
          </gml:surfaceMember></gml:MultiSurface></bldg:lod3MultiSurface>
        </bldg:Door></bldg:opening>
      </bldg:WallSurface></bldg:boundedBy>
      <bldg:boundedBy><bldg:RoofSurface gml:id="roof"><bldg:lod2MultiSurface><gml:MultiSurface><gml:surfaceMember>
        <gml:Polygon gml:id="slope"><gml:exterior><gml:LinearRing gml:id="slope-ring"><gml:posList>1 0 0 0 0 1 0 1 0 1 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon>
      </gml:surfaceMember></gml:MultiSurface></bldg:lod2MultiSurface></bldg:RoofSurface></bldg:boundedBy>
      <bldg:boundedBy><bldg:ClosureSurface gml:id="nowhere"/></bldg:boundedBy>
      <bldg:interiorRoom><bldg:Room gml:id="room"><bldg:roomInstallation>
        <bldg:IntBuildingInstallation gml:id="stove"><bldg:class>8000</bldg:class></bldg:IntBuildingInstallation>
      </bldg:roomInstallation></bldg:Room></bldg:interiorRoom>
      <bldg:consistsOfBuildingPart><bldg:BuildingPart><bldg:lod1Solid><gml:Solid><gml:exterior><gml:CompositeSurface>
        <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>5 0 0 5 1 0 6 0 0 5 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
        <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>5 0 0 5 0 1 5 1 0 5 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
        <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>5 0 0 6 0 0 5 0 1 5 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
        <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>6 0 0 5 1 0 5 0 1 6 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
      </gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod1Solid></bldg:BuildingPart></bldg:consistsOfBuildingPart>
      <bldg:address><core:Address gml:id="address">
        <core:xalAddress><xAL:AddressDetails><xAL:Country><xAL:CountryName>Germany</xAL:CountryName>
          <xAL:Locality Type="Town"><xAL:LocalityName>Selfkant</xAL:LocalityName>
            <xAL:Thoroughfare Type="Street"><xAL:ThoroughfareNumber>59</xAL:ThoroughfareNumber><xAL:ThoroughfareName>Straße</xAL:ThoroughfareName></xAL:Thoroughfare>
            <xAL:PostalCode><xAL:PostalCodeNumber>52538</xAL:PostalCodeNumber></xAL:PostalCode>
          </xAL:Locality></xAL:Country></xAL:AddressDetails></core:xalAddress>
        <core:multiPoint><gml:MultiPoint><gml:pointMember><gml:Point><gml:pos>0 0.15 0</gml:pos></gml:Point></gml:pointMember></gml:MultiPoint></core:multiPoint>
      </core:Address></bldg:address>
    </bldg:Building>
  </core:cityObjectMember>
  <core:cityObjectMember><veg:SolitaryVegetationObject gml:id="tree">
    <veg:species>1040</veg:species><veg:height uom="m">7.5</veg:height>
    <veg:lod1ImplicitRepresentation><core:ImplicitGeometry><core:mimeType>image/x</core:mimeType></core:ImplicitGeometry></veg:lod1ImplicitRepresentation>
  </veg:SolitaryVegetationObject></core:cityObjectMember>
  <core:cityObjectMember><dem:ReliefFeature gml:id="relief"><gml:name>Terrain</gml:name><dem:lod>1</dem:lod>
    <dem:reliefComponent><dem:TINRelief gml:id="tin"><dem:lod>1</dem:lod><dem:tin><gml:TriangulatedSurface><gml:trianglePatches>
      <gml:Triangle><gml:exterior><gml:LinearRing><gml:posList>0 0 0 9 0 0 0 9 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Triangle>
    </gml:trianglePatches></gml:TriangulatedSurface></dem:tin></dem:TINRelief></dem:reliefComponent>
  </dem:ReliefFeature></core:cityObjectMember>
  <core:cityObjectMember><tran:Road gml:id="road"><tran:trafficArea><tran:TrafficArea gml:id="lane"><tran:function>1</tran:function>
    <tran:lod2MultiSurface><gml:MultiSurface><gml:surfaceMember>
      <gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>20 0 0 21 0 0 20 1 0 20 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon>
    </gml:surfaceMember></gml:MultiSurface></tran:lod2MultiSurface></tran:TrafficArea></tran:trafficArea></tran:Road></core:cityObjectMember>
  <core:cityObjectMember><frn:CityFurniture gml:id="flat">
    <frn:lod1Geometry><gml:MultiSurface srsDimension="2"><gml:surfaceMember>
      <gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 1 0 0 1 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon>
    </gml:surfaceMember></gml:MultiSurface></frn:lod1Geometry></frn:CityFurniture></core:cityObjectMember>
  <core:cityObjectMember><ade:Mast gml:id="mast"><ade:lod2MultiSurface><gml:MultiSurface><gml:surfaceMember>
      <gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>25 0 0 26 0 0 25 1 0 25 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon>
    </gml:surfaceMember></gml:MultiSurface></ade:lod2MultiSurface></ade:Mast></core:cityObjectMember>
  <core:cityObjectMember><ade:Rumour gml:id="rumour"><ade:text>not mapped</ade:text></ade:Rumour></core:cityObjectMember>
  <core:cityObjectMember><grp:CityObjectGroup gml:id="group"><grp:groupMember role="shade" xlink:href="#tree"/><grp:groupMember role="main" xlink:href="#house"/></grp:CityObjectGroup></core:cityObjectMember>
  <app:appearanceMember><app:Appearance><app:theme>summer</app:theme>
    <app:surfaceDataMember><app:X3DMaterial gml:id="red"><app:diffuseColor>1.0 0 0</app:diffuseColor><app:shininess>0.20</app:shininess><app:target>#slope</app:target><app:target>#walls-2</app:target></app:X3DMaterial></app:surfaceDataMember>
    <app:surfaceDataMember><app:ParameterizedTexture><app:imageURI>roof.png</app:imageURI><app:wrapMode>none</app:wrapMode>
      <app:target uri="#slope"><app:TexCoordList><app:textureCoordinates ring="#slope-ring">0 0 1 0 0 1 0 0</app:textureCoordinates></app:TexCoordList></app:target>
      <app:target uri="#lid"><app:TexCoordList><app:textureCoordinates ring="#lid-ring">0 0 1 0 0 0</app:textureCoordinates></app:TexCoordList></app:target>
    </app:ParameterizedTexture></app:surfaceDataMember>
    <app:surfaceDataMember><app:GeoreferencedTexture><app:imageURI>ortho.jpg</app:imageURI></app:GeoreferencedTexture></app:surfaceDataMember>
  </app:Appearance></app:appearanceMember>
</core:CityModel>
