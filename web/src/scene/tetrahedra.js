// SPDX-License-Identifier: GPL-3.0-or-later
// The inside of proven solids: tetrahedra apart from each other, Steiner points, and the faces of
// the boundary that the Delaunay tetrahedralization lacks.
import * as THREE from 'three';

import {kMissingColour, kSteinerColour, kTetrahedronColours} from './colours.js';

const kShrunk = 0.82;    // the size of a tetrahedron that is shown
const kPointPixels = 9;  // the size of a Steiner point
const kFaces = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]];

/// The corners of a tetrahedron, moved towards its middle.
function shrunk(corners) {
  const middle = new THREE.Vector3();
  for (const corner of corners) middle.addScaledVector(corner, 0.25);
  return corners.map((corner) => corner.clone().sub(middle).multiplyScalar(kShrunk).add(middle));
}

const positions = (points) => new THREE.BufferGeometry().setFromPoints(points);

/// The group of one solid of `f=structure`; `place` brings a position of the document into the
/// scene. A solid without proof has an empty group.
export function tetrahedraOf(solid, place) {
  const group = new THREE.Group();
  if (!solid.vertices) return group;
  const vertices = solid.vertices.map(place);
  const points = [], colours = [];
  solid.tetrahedra.forEach((tetrahedron, i) => {
    const corners = shrunk(tetrahedron.map((index) => vertices[index]));
    const colour = new THREE.Color(kTetrahedronColours[i % kTetrahedronColours.length]);
    for (const face of kFaces) {
      for (const corner of face) {
        points.push(corners[corner]);
        colours.push(colour.r, colour.g, colour.b);
      }
    }
  });
  const filled = positions(points);
  filled.setAttribute('color', new THREE.Float32BufferAttribute(colours, 3));
  group.add(new THREE.Mesh(
      filled,
      new THREE.MeshLambertMaterial(
          {vertexColors: true, flatShading: true, side: THREE.DoubleSide})));
  const missing = solid.unrecoveredFaces.flatMap(
      ([a, b, c]) => [a, b, b, c, c, a].map((index) => vertices[index]));
  group.add(new THREE.LineSegments(
      positions(missing),
      new THREE.LineBasicMaterial({color: kMissingColour, depthTest: false, transparent: true})));
  const steiner = vertices.slice(vertices.length - solid.steinerVertices);
  group.add(new THREE.Points(
      positions(solid.steinerVertices > 0 ? steiner : []), new THREE.PointsMaterial({
        color: kSteinerColour,
        size: kPointPixels * devicePixelRatio,
        sizeAttenuation: false,
        depthTest: false,
        transparent: true
      })));
  return group;
}
