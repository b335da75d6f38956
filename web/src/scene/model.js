// SPDX-License-Identifier: GPL-3.0-or-later
// The facets of features as meshes of three.js: one for the triangles, one for the edges, and marks
// for findings.
import * as THREE from 'three';

import {kFacetColour, kOtherColour, kPlaceColour, surfaceColour} from './colours.js';
import {moved, trianglesOf} from './triangles.js';

/// A facet by its pointer, or by one that goes on to a ring or vertex of it; undefined if it is not
/// among `facets`.
export function facetAt(facets, pointer) {
  for (let part = pointer ?? ''; part !== '';) {
    if (facets.has(part)) return facets.get(part);
    part = part.slice(0, part.lastIndexOf('/'));
  }
  return undefined;
}

const floats = (corners) => new THREE.BufferAttribute(new Float32Array(corners.flat()), 3);

/// Pairs of ends of the edges of rings.
const edgesOf = (rings) =>
    rings.flatMap((ring) => ring.flatMap((at, i) => [at, ring[(i + 1) % ring.length]]));

export class FacetModel {
  /// Shows the geometries of `features` that have level of detail `lod` (null: each object's
  /// highest), with the origin of the scene at a position of the document.
  constructor(features, lod, origin = null) {
    this.group = new THREE.Group();
    this.facets = new Map();  // of each feature: facets by their pointers
    this.surfaces = new Set();
    this.clipping = new THREE.Plane(new THREE.Vector3(0, 0, -1), 0);
    this.count = 0;
    const shown = this.#collect(features, lod);
    this.origin = origin ?? shown[0]?.rings[0]?.[0] ?? [0, 0, 0];
    this.#build(shown);
    this.marks = new THREE.Group();
    this.group.add(this.marks);
  }

  /// The box around what is shown.
  box() {
    return this.mesh ? new THREE.Box3().setFromObject(this.mesh) : new THREE.Box3();
  }

  /// The position in the scene of a position in the document.
  place(at) {
    return new THREE.Vector3(...at.map((value, axis) => value - this.origin[axis]));
  }

  setEdges(isOn) {
    this.edges.visible = isOn;
  }

  /// Cuts away what is above a height in the scene; null shows all.
  setSection(height) {
    const planes = height === null ? null : [this.clipping];
    this.clipping.constant = height ?? 0;
    for (const part of [this.mesh, this.edges]) part.material.clippingPlanes = planes;
  }

  /// Marks a finding: its facets and its place. Returns a sphere around them, null without a place.
  mark(finding) {
    this.unmark();
    if (!finding) return null;
    const facets = this.facets.get(finding.feature) ?? new Map();
    const around = new THREE.Box3();
    const facet = facetAt(facets, finding.pointer), other = facetAt(facets, finding.other);
    if (other) this.#paint(other, kOtherColour, around);
    if (facet) this.#paint(facet, kFacetColour, around);
    let centre = null;
    if (finding.witness) {
      centre = this.place(finding.witness);
      around.expandByPoint(centre);
      this.#point(centre);
    }
    if (around.isEmpty()) return null;
    const sphere = around.getBoundingSphere(new THREE.Sphere());
    return {centre: centre ?? sphere.center, radius: Math.max(1, 1.6 * sphere.radius)};
  }

  unmark() {
    for (const part of this.marks.children) {
      part.geometry?.dispose();
      part.material.dispose();
    }
    this.marks.clear();
  }

  dispose() {
    this.unmark();
    for (const part of [this.mesh, this.edges]) {
      part?.geometry.dispose();
      part?.material.dispose();
    }
  }

  #collect(features, lod) {
    const shown = [];
    for (const feature of features) {
      const facets = new Map();
      this.facets.set(feature.id, facets);
      for (const object of feature.objects) {
        const highest = Math.max(...object.geometries.filter(({facets: own}) => own.length > 0)
                                     .map((g) => Number(g.lod)));
        for (const geometry of object.geometries) {
          const isShown = lod === null ? Number(geometry.lod) === highest : geometry.lod === lod;
          for (const facet of isShown ? geometry.facets : []) {
            facets.set(facet.pointer, facet);
            facets.set(facet.path, facet);
            shown.push(facet);
          }
        }
      }
    }
    return shown;
  }

  #build(shown) {
    const corners = [], colours = [], ends = [];
    for (const facet of shown) {
      const rings = facet.rings.map((ring) => moved(ring, this.origin));
      const colour = new THREE.Color(surfaceColour(facet.surface));
      this.surfaces.add(facet.surface);
      const triangles = trianglesOf(rings);
      for (const corner of triangles) {
        corners.push(...corner);
        colours.push(colour.r, colour.g, colour.b);
      }
      for (const end of edgesOf(rings)) ends.push(...end);
      this.count += 1;
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(corners), 3));
    geometry.setAttribute('color', new THREE.BufferAttribute(new Float32Array(colours), 3));
    this.mesh = new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({
      vertexColors: true,
      flatShading: true,
      side: THREE.DoubleSide,
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 1
    }));
    const lines = new THREE.BufferGeometry();
    lines.setAttribute('position', new THREE.BufferAttribute(new Float32Array(ends), 3));
    this.edges = new THREE.LineSegments(
        lines, new THREE.LineBasicMaterial({color: 0x2b3440, transparent: true, opacity: 0.55}));
    this.group.add(this.mesh, this.edges);
  }

  /// Paints a facet and its edges; they show through the facets before them.
  #paint(facet, colour, around) {
    const rings = facet.rings.map((ring) => moved(ring, this.origin));
    for (const at of rings.flat()) around.expandByPoint(new THREE.Vector3(...at));
    const filled = new THREE.BufferGeometry();
    filled.setAttribute('position', floats(trianglesOf(rings)));
    const material = {color: colour, depthTest: false, transparent: true};
    const face = new THREE.Mesh(
        filled, new THREE.MeshBasicMaterial({...material, opacity: 0.55, side: THREE.DoubleSide}));
    const ends = new THREE.BufferGeometry();
    ends.setAttribute('position', floats(edgesOf(rings)));
    const edges = new THREE.LineSegments(ends, new THREE.LineBasicMaterial(material));
    face.renderOrder = edges.renderOrder = 1;
    this.marks.add(face, edges);
  }

  #point(at) {
    const mark = new THREE.Mesh(
        new THREE.SphereGeometry(1, 24, 16),
        new THREE.MeshBasicMaterial(
            {color: kPlaceColour, depthTest: false, transparent: true, opacity: 0.9}));
    mark.position.copy(at);
    mark.renderOrder = 2;
    mark.userData.pixels = 7;
    this.marks.add(mark);
  }

  /// Keeps marks of places as large as they are on the screen.
  scaleMarks(stage) {
    for (const mark of this.marks.children) {
      if (mark.userData.pixels) {
        mark.scale.setScalar(mark.userData.pixels * stage.metresOfPixel(mark.position));
      }
    }
  }
}
