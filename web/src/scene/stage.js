// SPDX-License-Identifier: GPL-3.0-or-later
// A scene in a page: drawn when something changed, moved by mouse, touch and keys. z points up.
import * as THREE from 'three';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';

import {element} from '../page.js';

const kFieldOfView = 45;  // degrees
const kFlight = 700;      // milliseconds
const kFromSouth = new THREE.Vector3(-0.35, -0.8, 0.55).normalize();
const kStep = 0.12;  // of the distance, for a key

const prefersStill = () => matchMedia('(prefers-reduced-motion: reduce)').matches;

export class Stage {
  /// Puts the scene into a container. `onFrame(stage)` is called before each picture and returns
  /// whether another must follow. Throws where the browser has no WebGL.
  constructor(container, {label, onFrame = () => false, onPick = null}) {
    this.renderer = new THREE.WebGLRenderer({antialias: true, preserveDrawingBuffer: true});
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.localClippingEnabled = true;
    this.canvas = this.renderer.domElement;
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute('role', 'application');
    this.canvas.setAttribute(
        'aria-label', `${label}. Arrow keys turn, with Shift they move; plus and minus zoom.`);
    container.append(this.canvas);
    this.container = container;
    this.scene = new THREE.Scene();
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x9a9a90, 2.2));
    this.sun = new THREE.DirectionalLight(0xffffff, 1.5);
    this.scene.add(this.sun, this.sun.target);
    this.perspective = new THREE.PerspectiveCamera(kFieldOfView, 1, 0.1, 1000);
    this.orthographic = new THREE.OrthographicCamera(-1, 1, 1, -1, 0.1, 1000);
    for (const camera of [this.perspective, this.orthographic]) camera.up.set(0, 0, 1);
    this.camera = this.perspective;
    this.onFrame = onFrame;
    this.extent = 1;  // metres: the radius of all that is shown
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.zoomToCursor = true;
    this.controls.addEventListener('change', () => this.draw());
    this.canvas.addEventListener('keydown', (event) => this.#key(event));
    if (onPick) this.#listenForPicks(onPick);
    const scheme = matchMedia('(prefers-color-scheme: dark)');
    const paint = () => {
      this.scene.background = new THREE.Color(scheme.matches ? 0x1d2632 : 0xe4ecf4);
      this.draw();
    };
    scheme.addEventListener('change', paint);
    paint();
    new ResizeObserver(() => this.#resize()).observe(container);
    this.#resize();
  }

  get isMap() {
    return this.camera === this.orthographic;
  }

  /// Has the scene drawn soon.
  draw() {
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame(() => this.#frame());
  }

  /// Looks at a sphere, from the side where the camera is, from `from`, or in a flight.
  lookAt(centre, radius, {from = null, isFlight = false} = {}) {
    const direction = from ?? this.camera.position.clone().sub(this.controls.target).normalize();
    if (direction.lengthSq() === 0) direction.copy(kFromSouth);
    const aspect = Math.min(1, this.#aspect());
    const distance = radius / Math.sin(THREE.MathUtils.degToRad(kFieldOfView / 2)) / aspect;
    const end = {
      target: centre.clone(),
      position: centre.clone().addScaledVector(direction, distance),
      zoom: 1 / radius
    };
    if (!isFlight || prefersStill()) {
      this.flight = null;
      this.#place(end);
    } else {
      this.flight = {
        begin: performance.now(),
        from: {
          target: this.controls.target.clone(),
          position: this.camera.position.clone(),
          zoom: this.camera.zoom
        },
        to: end
      };
    }
    this.draw();
  }

  /// Looks at everything from the south.
  lookFromSouth(centre, radius) {
    this.extent = radius;
    this.lookAt(centre, radius, {from: this.isMap ? new THREE.Vector3(0, 0, 1) : kFromSouth});
  }

  /// Shows the scene from above without perspective, north up, or as it is.
  setMap(isMap) {
    if (isMap === this.isMap) return;
    const target = this.controls.target.clone();
    const radius = this.#shownRadius();
    this.flight = null;
    this.camera = isMap ? this.orthographic : this.perspective;
    this.controls.object = this.camera;
    this.controls.enableRotate = !isMap;
    this.#resize();
    // Not from exactly above, where north could be anywhere.
    this.lookAt(target, radius, {from: isMap ? new THREE.Vector3(0, -1e-4, 1) : kFromSouth});
  }

  /// The first hit below a point of the page in objects.
  hit(clientX, clientY, objects) {
    const box = this.canvas.getBoundingClientRect();
    const at = new THREE.Vector2(
        2 * (clientX - box.left) / box.width - 1, 1 - 2 * (clientY - box.top) / box.height);
    const ray = new THREE.Raycaster();
    ray.setFromCamera(at, this.camera);
    return ray.intersectObjects(objects, true)[0] ?? null;
  }

  /// Metres of a pixel at a position.
  metresOfPixel(position) {
    const height = this.canvas.clientHeight || 1;
    if (this.isMap) return 2 / this.orthographic.zoom / height;
    const distance = this.camera.position.distanceTo(position);
    return 2 * distance * Math.tan(THREE.MathUtils.degToRad(kFieldOfView / 2)) / height;
  }

  #aspect() {
    return this.container.clientWidth / Math.max(1, this.container.clientHeight);
  }

  #shownRadius() {
    if (this.isMap) return 1 / this.orthographic.zoom;
    return this.camera.position.distanceTo(this.controls.target) *
        Math.sin(THREE.MathUtils.degToRad(kFieldOfView / 2)) * Math.min(1, this.#aspect());
  }

  #place({target, position, zoom}) {
    this.controls.target.copy(target);
    this.camera.position.copy(position);
    if (this.isMap) this.camera.zoom = zoom;
    this.camera.updateProjectionMatrix();
    this.controls.update();
  }

  #resize() {
    const {clientWidth: width, clientHeight: height} = this.container;
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height, false);
    this.perspective.aspect = width / height;
    const aspect = this.#aspect();
    const half = aspect < 1 ? [1, 1 / aspect] : [aspect, 1];
    this.orthographic.left = -half[0];
    this.orthographic.right = half[0];
    this.orthographic.top = half[1];
    this.orthographic.bottom = -half[1];
    this.perspective.updateProjectionMatrix();
    this.orthographic.updateProjectionMatrix();
    this.draw();
  }

  #fly() {
    const {begin, from, to} = this.flight;
    const share = Math.min(1, (performance.now() - begin) / kFlight);
    const eased = share * share * (3 - 2 * share);
    this.#place({
      target: from.target.clone().lerp(to.target, eased),
      position: from.position.clone().lerp(to.position, eased),
      zoom: from.zoom * (to.zoom / from.zoom) ** eased
    });
    if (share === 1) this.flight = null;
  }

  #frame() {
    this.pending = false;
    if (this.flight) this.#fly();
    const distance = this.camera.position.distanceTo(this.controls.target);
    this.camera.near = this.isMap ? 0.1 : Math.max(0.01, distance / 1000);
    this.camera.far = 4 * (distance + this.extent);
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
    this.sun.target.position.copy(this.controls.target);
    this.sun.position.copy(this.controls.target).add(new THREE.Vector3(-0.5, -0.8, 1.2));
    const goesOn = this.onFrame(this);
    this.renderer.render(this.scene, this.camera);
    if (goesOn || this.flight) this.draw();
  }

  #key(event) {
    const turn = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]};
    const zoom = {'+': 1 - kStep, '=': 1 - kStep, '-': 1 + kStep};
    const offset = this.camera.position.clone().sub(this.controls.target);
    if (turn[event.key]) {
      const [x, y] = turn[event.key];
      if (event.shiftKey || this.isMap) {
        const side = new THREE.Vector3().setFromMatrixColumn(this.camera.matrixWorld, 0);
        const ahead = new THREE.Vector3(0, 0, 1).cross(side);
        const step = kStep * 2 * this.#shownRadius();
        const move = side.multiplyScalar(x * step).addScaledVector(ahead, y * step);
        this.controls.target.add(move);
        this.camera.position.add(move);
      } else {
        const at =
            new THREE.Spherical().setFromVector3(new THREE.Vector3(offset.y, offset.z, offset.x));
        at.theta += x * kStep;
        at.phi = THREE.MathUtils.clamp(at.phi - y * kStep, 0.01, Math.PI - 0.01);
        const turned = new THREE.Vector3().setFromSpherical(at);
        offset.set(turned.z, turned.x, turned.y);
        this.camera.position.copy(this.controls.target).add(offset);
      }
    } else if (zoom[event.key]) {
      if (this.isMap) {
        this.camera.zoom /= zoom[event.key];
      } else {
        this.camera.position.copy(this.controls.target).addScaledVector(offset, zoom[event.key]);
      }
    } else {
      return;
    }
    event.preventDefault();
    this.flight = null;
    this.controls.update();
    this.draw();
  }

  /// A click that is not the end of a drag.
  #listenForPicks(onPick) {
    let down = null;
    this.canvas.addEventListener('pointerdown', (event) => {
      down = [event.clientX, event.clientY];
      this.flight = null;
    });
    this.canvas.addEventListener('pointerup', (event) => {
      if (!down || event.button !== 0) return;
      const distance = Math.hypot(event.clientX - down[0], event.clientY - down[1]);
      if (distance < 5) onPick(event.clientX, event.clientY);
      down = null;
    });
  }
}

/// A stage, or null and a message in the container where the browser cannot draw in 3D.
export function stageIn(container, options) {
  try {
    return new Stage(container, options);
  } catch {
    container.append(
        element('p', {class: 'message'}, 'This browser does not draw in 3D (WebGL 2 is needed).'));
    return null;
  }
}
