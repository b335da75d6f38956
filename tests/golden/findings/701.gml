<?xml version="1.0" encoding="UTF-8"?>
<IndoorFeatures xmlns="http://www.opengis.net/indoorgml/1.0/core" xmlns:gml="http://www.opengis.net/gml/3.2"
    xmlns:xlink="http://www.w3.org/1999/xlink" gml:id="model">
  <primalSpaceFeatures>
    <PrimalSpaceFeatures gml:id="primal">
      <cellSpaceMember>
        <CellSpace gml:id="kitchen">
          <cellSpaceGeometry>
            <Geometry3D>
              <gml:Solid><gml:exterior><gml:Shell>
                <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 0 0 3 0 3 3 0 3 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
                <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>4 0 0 4 3 0 4 3 3 4 0 3 4 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
                <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 4 0 0 4 0 3 0 0 3 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
                <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 3 0 0 3 3 4 3 3 4 3 0 0 3 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
                <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 0 3 0 4 3 0 4 0 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
                <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 3 4 0 3 4 3 3 0 3 3 0 0 3</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
              </gml:Shell></gml:exterior></gml:Solid>
            </Geometry3D>
          </cellSpaceGeometry>
          <duality xlink:href="#kitchen-state"/>
        </CellSpace>
      </cellSpaceMember>
      <cellSpaceMember>
        <CellSpace gml:id="hall">
          <cellSpaceGeometry>
            <Geometry3D>
              <gml:Solid><gml:exterior><gml:Shell>
                <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>3 0 0 3 0 3 3 3 3 3 3 0 3 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
                <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>9 0 0 9 3 0 9 3 3 9 0 3 9 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
                <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>3 0 0 9 0 0 9 0 3 3 0 3 3 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
                <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>3 3 0 3 3 3 9 3 3 9 3 0 3 3 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
                <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>3 0 0 3 3 0 9 3 0 9 0 0 3 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
                <gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>3 0 3 9 0 3 9 3 3 3 3 3 3 0 3</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
              </gml:Shell></gml:exterior></gml:Solid>
            </Geometry3D>
          </cellSpaceGeometry>
          <duality xlink:href="#hall-state"/>
        </CellSpace>
      </cellSpaceMember>
    </PrimalSpaceFeatures>
  </primalSpaceFeatures>
  <multiLayeredGraph>
    <MultiLayeredGraph gml:id="graph">
      <spaceLayers gml:id="layers">
        <spaceLayerMember>
          <SpaceLayer gml:id="layer">
            <nodes gml:id="nodes">
              <stateMember>
                <State gml:id="kitchen-state">
                  <duality xlink:href="#kitchen"/>
                  <connects xlink:href="#door"/>
                  <geometry>
                    <gml:Point gml:id="kitchen-state-point"><gml:pos>2 1.5 1</gml:pos></gml:Point>
                  </geometry>
                </State>
              </stateMember>
              <stateMember>
                <State gml:id="hall-state">
                  <duality xlink:href="#hall"/>
                  <connects xlink:href="#door"/>
                  <geometry>
                    <gml:Point gml:id="hall-state-point"><gml:pos>6.5 1.5 1</gml:pos></gml:Point>
                  </geometry>
                </State>
              </stateMember>
            </nodes>
            <edges gml:id="edges">
              <transitionMember>
                <Transition gml:id="door">
                  <weight>1.0</weight>
                  <connects xlink:href="#kitchen-state"/>
                  <connects xlink:href="#hall-state"/>
                </Transition>
              </transitionMember>
            </edges>
          </SpaceLayer>
        </spaceLayerMember>
      </spaceLayers>
    </MultiLayeredGraph>
  </multiLayeredGraph>
</IndoorFeatures>
