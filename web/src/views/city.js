// SPDX-License-Identifier: GPL-3.0-or-later
// The view of a collection: its features in 3D and from above, and what is not proven.
import * as THREE from 'three';

import {findingsOfProof} from '../documents/findings.js';
import {ask, checkBox, counted, element, pagePath} from '../page.js';
import {City} from '../scene/city.js';
import {stageIn} from '../scene/stage.js';

import {earthCentred} from './earth.js';

const kMostFacts = 14;
const kPageOfIds = 1000;

class CityView {
  constructor(container) {
    this.items = `${pagePath()}/items`;
    this.frame = element('div', {class: 'stage'});
    this.tools = element('div', {class: 'tools', role: 'toolbar', 'aria-label': 'View'});
    this.side = element(
        'div', {class: 'side', 'aria-live': 'polite'},
        element('p', {}, 'Choose a feature in the picture, or by its id.'));
    this.state = element('p', {role: 'status', class: 'said'}, 'Loading');
    container.replaceChildren(
        element('div', {class: 'viewer'}, this.tools, this.frame, this.side), this.state);
    this.stage = stageIn(this.frame, {
      label: 'The collection in 3D',
      onFrame: () => this.#frameDone(),
      onPick: (x, y) => this.#pick(x, y)
    });
    if (!this.stage) return;
    this.city = new City(`${pagePath()}/3dtiles`, this.stage, (text) => this.#complain(text));
    this.#addTools();
    this.stage.draw();
  }

  #addTools() {
    const button = (text, onclick) => element('button', {type: 'button', onclick}, text);
    const id = element('input', {id: 'feature', size: 24, 'aria-label': 'Id of a feature'});
    const search = element(
        'form', {
          class: 'choice',
          onsubmit: (event) => {
            event.preventDefault();
            if (id.value.trim() !== '') this.show(id.value.trim());
          }
        },
        id, element('button', {}, 'Find'));
    this.tools.append(
        button('Next finding', () => this.#nextUnproven()), button('All', () => this.#home()),
        checkBox('From above', false, (isOn) => this.stage.setMap(isOn)),
        checkBox('Not proven in red', true, (isOn) => this.city.setProof(isOn)),
        checkBox('Pins of findings', false, (isOn) => this.#showPins(isOn)), search);
  }

  #frameDone() {
    const isLoading = [this.city, this.pins].map((layer) => layer?.update()).some(Boolean);
    if (!this.isPlaced && this.city.isPlaced) {
      this.isPlaced = true;
      this.#home();
      if (this.wantsPins) this.#showPins(true);
      const wanted = new URLSearchParams(location.hash.slice(1)).get('feature');
      if (wanted) this.show(wanted);
    }
    if (!isLoading && this.state.textContent === 'Loading') this.state.textContent = '';
    return isLoading;
  }

  /// Shows or hides the layer of the findings, which is loaded when it is first wanted.
  #showPins(isOn) {
    this.wantsPins = isOn;
    if (!this.city.isPlaced || (!isOn && !this.pins)) return;
    this.pins ??= new City(
        `${pagePath()}/3dtiles?layer=findings`, this.stage, (text) => this.#complain(text),
        this.city);
    this.pins.setVisible(isOn);
  }

  #complain(text) {
    this.state.textContent = `A part could not be loaded: ${text}`;
  }

  #home() {
    const sphere = this.city.sphere();
    if (sphere) this.stage.lookFromSouth(sphere.center, Math.max(1, 0.6 * sphere.radius));
  }

  #pick(x, y) {
    const values = this.pins?.pick(x, y) ?? this.city.pick(x, y);
    if (values?.id) this.show(values.id, false);
  }

  /// Shows a feature: flies to it unless it is in view, and lists what is known of it.
  async show(id, isFlight = true) {
    this.state.textContent = '';
    const address = `${this.items}/${encodeURIComponent(id)}`;
    try {
      const [feature, proof] = await Promise.all([
        ask(`${address}?f=geojson${this.city.isOnEarth ? '' : `&crs=${this.#unknownCrs()}`}`)
            .then((a) => a.json()),
        ask(`${address}?f=proof`).then((a) => a.json())
      ]);
      this.city.choose(id);
      this.#list(id, address, feature, findingsOfProof(proof));
      if (isFlight) this.#flyTo(feature.bbox);
      history.replaceState(null, '', `#feature=${encodeURIComponent(id)}`);
    } catch (error) {
      this.state.textContent = `${id}: ${error.message}`;
    }
  }

  #unknownCrs() {
    return 'http://www.opengis.net/def/nil/OGC/0/unknown';
  }

  /// The place in the scene of a position in the bbox of a feature.
  #place(position) {
    if (this.city.isOnEarth) return this.city.place(earthCentred(position));
    const frame =
        new URL(this.city.tiles.root.content.uri, location.href).searchParams.get('frame');
    const [x, y] = frame.split(',').map(Number);
    return new THREE.Vector3(position[0] - x, position[1] - y, position[2]);
  }

  #flyTo(bbox) {
    if (!bbox) return;
    const box = new THREE.Box3();
    for (const x of [bbox[0], bbox[3]]) {
      for (const y of [bbox[1], bbox[4]]) {
        for (const z of [bbox[2], bbox[5]]) box.expandByPoint(this.#place([x, y, z]));
      }
    }
    const sphere = box.getBoundingSphere(new THREE.Sphere());
    this.stage.lookAt(sphere.center, Math.max(2, 1.8 * sphere.radius), {isFlight: true});
  }

  #list(id, address, feature, findings) {
    const {properties} = feature;
    const facts = Object.entries(properties).filter(([, value]) => typeof value !== 'object');
    const rows = facts.slice(0, kMostFacts)
                     .map(
                         ([name, value]) => element(
                             'tr', {}, element('th', {scope: 'row'}, name),
                             element('td', {}, String(value))));
    const items = findings.map(
        (finding, i) => element(
            'li', {class: finding.severity},
            element('a', {href: `${address}#finding=${i}`}, `${finding.code} ${finding.name}`),
            ` ${finding.text}`));
    this.side.replaceChildren(
        element('h2', {}, element('a', {href: address}, id)),
        element('p', {}, properties.wt_proven ? 'All its solids are proven.' : 'It is not proven.'),
        findings.length > 0 ? element('h3', {}, counted(findings.length, 'finding')) : '',
        element('ol', {}, ...items), element('table', {}, ...rows));
  }

  /// Flies to the next feature that is not proven, in the order of the service.
  async #nextUnproven() {
    try {
      if (!this.unproven) {
        const answer = await ask(`${this.items}?proven=false&f=summary&limit=${kPageOfIds}`);
        this.unproven = (await answer.json()).features.map((feature) => feature.id);
        this.at = -1;
      }
      if (this.unproven.length === 0) {
        this.state.textContent = 'Every solid of this collection is proven.';
        return;
      }
      this.at = (this.at + 1) % this.unproven.length;
      await this.show(this.unproven[this.at]);
      this.state.textContent = `${this.at + 1} of ${this.unproven.length} that are not proven`;
    } catch (error) {
      this.state.textContent = error.message;
    }
  }
}

/// The page is that of the collection, so its address is the collection's.
export function showCity(container) {
  return new CityView(container);
}
