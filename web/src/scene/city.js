// SPDX-License-Identifier: GPL-3.0-or-later
// A tileset in a scene, in metres east, north and up of its middle; z points up.
import {TilesRenderer} from '3d-tiles-renderer';
import {GLTFExtensionsPlugin} from '3d-tiles-renderer/plugins';
import * as THREE from 'three';
import {MeshoptDecoder} from 'three/addons/libs/meshopt_decoder.module.js';

import {kChosenColour, kUnprovenColour} from './colours.js';

const kIds = '_feature_id_0';  // the attribute of EXT_mesh_features, as three.js names it
const kDeepest = 6e6;          // metres from the middle of the Earth to any place on it
const kErrorTarget = 8;        // pixels by which what is left out may be wrong

/// The values of a feature of a mesh by the names that the source gave them.
function valuesOf(mesh, feature) {
  const table = mesh.userData.meshFeatures?.getFeatureInfo()[0]?.propertyTable;
  if (table === undefined || table === null) return {};
  return mesh.userData.structuralMetadata.getPropertyTableData(table, feature);
}

export class City {
  /// `onFailure(text)` is called when a part cannot be loaded. `base`: the tileset, loaded already,
  /// in whose place this one is; without it the scene is that of this tileset.
  constructor(address, stage, onFailure, base = null) {
    this.stage = stage;
    this.base = base;
    this.chosen = null;
    this.showsProof = true;
    this.meshes = new Set();
    this.tiles = new TilesRenderer(address);
    this.tiles.registerPlugin(
        new GLTFExtensionsPlugin({metadata: true, meshoptDecoder: MeshoptDecoder}));
    this.tiles.errorTarget = kErrorTarget;
    this.tiles.addEventListener('load-tileset', () => this.#begin());
    this.tiles.addEventListener('load-model', ({scene}) => this.#add(scene));
    this.tiles.addEventListener('dispose-model', ({scene}) => this.#remove(scene));
    this.tiles.addEventListener('load-error', ({error}) => onFailure(error.message));
    this.tiles.addEventListener('needs-update', () => stage.draw());
    this.tiles.addEventListener('needs-render', () => stage.draw());
    stage.scene.add(this.tiles.group);
  }

  /// Loads what the camera sees. True while parts are missing.
  update() {
    for (const camera of [this.stage.perspective, this.stage.orthographic]) {
      if (camera === this.stage.camera) {
        this.tiles.setCamera(camera);
        this.tiles.setResolutionFromRenderer(camera, this.stage.renderer);
      } else {
        this.tiles.deleteCamera(camera);
      }
    }
    this.tiles.update();
    const {queued = 0, downloading = 0, parsing = 0} = this.tiles.stats;
    this.isLoading = !this.tiles.root || queued + downloading + parsing > 0;
    return this.isLoading;
  }

  /// The sphere around the city in the scene; null before the tileset is loaded.
  sphere() {
    const sphere = new THREE.Sphere();
    if (!this.tiles.getBoundingSphere(sphere)) return null;
    return sphere.applyMatrix4(this.tiles.group.matrix);
  }

  /// The place in the scene of an earth-centred position.
  place(earthCentred) {
    return new THREE.Vector3(...earthCentred).applyMatrix4(this.tiles.group.matrix);
  }

  /// The feature under a point of the page: its values; null without one.
  pick(clientX, clientY) {
    if (!this.tiles.group.visible) return null;
    const hit = this.stage.hit(clientX, clientY, [...this.meshes]);
    const ids = hit?.object.geometry.attributes[kIds];
    if (!hit || !ids || !hit.face) return null;
    return valuesOf(hit.object, ids.getX(hit.face.a));
  }

  /// Shows one feature in another colour.
  choose(id) {
    this.chosen = id;
    this.#repaint();
  }

  /// Shows or hides all of it.
  setVisible(isOn) {
    this.tiles.group.visible = isOn;
    this.stage.draw();
  }

  /// Shows in red what is not proven, or not.
  setProof(isOn) {
    this.showsProof = isOn;
    this.#repaint();
  }

  #begin() {
    const root = this.tiles.root;
    if (!root || this.isPlaced) return;
    this.isPlaced = true;
    const matrix = new THREE.Matrix4();
    const {transform} = (this.base ?? this).tiles.root;
    if (transform) matrix.fromArray(transform);
    // A frame without a place on the Earth is around the origin of its coordinates.
    this.isOnEarth = new THREE.Vector3().setFromMatrixPosition(matrix).length() > kDeepest;
    matrix.invert();
    this.tiles.group.matrixAutoUpdate = false;
    this.tiles.group.matrix.copy(matrix);
    this.tiles.group.updateMatrixWorld(true);
    this.stage.draw();
  }

  #add(scene) {
    scene.traverse((mesh) => {
      if (!mesh.isMesh) return;
      const colour = mesh.material.color.clone();
      mesh.userData.colour = colour;
      mesh.material.dispose();
      mesh.material = new THREE.MeshLambertMaterial(
          {vertexColors: true, flatShading: true, side: THREE.DoubleSide});
      this.meshes.add(mesh);
      this.#paint(mesh);
    });
    this.stage.draw();
  }

  #remove(scene) {
    scene.traverse((mesh) => {
      if (this.meshes.delete(mesh)) mesh.material.dispose();
    });
  }

  #repaint() {
    for (const mesh of this.meshes) this.#paint(mesh);
    this.stage.draw();
  }

  #colourOf(mesh, values) {
    if (values.id === this.chosen) return new THREE.Color(kChosenColour);
    if (this.showsProof && (values.wt_proven === 0 || values.wt_proven === 'false')) {
      return new THREE.Color(kUnprovenColour);
    }
    return mesh.userData.colour;
  }

  #paint(mesh) {
    const ids = mesh.geometry.attributes[kIds];
    const count = mesh.geometry.attributes.position.count;
    const colours = new Float32Array(3 * count);
    const known = new Map();
    for (let i = 0; i < count; ++i) {
      const id = ids ? ids.getX(i) : -1;
      if (!known.has(id)) {
        known.set(id, this.#colourOf(mesh, id < 0 ? {} : valuesOf(mesh, id)));
      }
      known.get(id).toArray(colours, 3 * i);
    }
    mesh.geometry.setAttribute('color', new THREE.BufferAttribute(colours, 3));
  }
}
