// SPDX-License-Identifier: GPL-3.0-or-later
// Features with their findings: a scene, its tools and the list.
import * as THREE from 'three';

import {lodsOf} from '../documents/city_json.js';
import {checkBox, choice, counted, element, grouped} from '../page.js';
import {surfaceColour} from '../scene/colours.js';
import {FacetModel} from '../scene/model.js';
import {stageIn} from '../scene/stage.js';
import {tetrahedraOf} from '../scene/tetrahedra.js';

import {FindingList} from './finding_list.js';

const kMostFacets = 400_000;  // that are shown at once

/// The features that fit on a screen: all, or those with findings before the others.
function shownFeatures(features, findings) {
  const named = new Set(findings.map((finding) => finding.feature));
  const ordered = [
    ...features.filter((feature) => named.has(feature.id)),
    ...features.filter((feature) => !named.has(feature.id))
  ];
  const shown = [];
  let facets = 0;
  for (const feature of ordered) {
    for (const object of feature.objects) {
      for (const geometry of object.geometries) facets += geometry.facets.length;
    }
    if (facets > kMostFacets && shown.length > 0) break;
    shown.push(feature);
  }
  return shown;
}

/// The level of detail of the facet of a finding; null if there is none.
function lodOf(features, finding) {
  for (const feature of features) {
    if (feature.id !== finding.feature) continue;
    for (const object of feature.objects) {
      for (const geometry of object.geometries) {
        const isItsFacet = ({pointer, path}) =>
            path === finding.pointer || `${finding.pointer}/`.startsWith(`${pointer}/`);
        if (geometry.facets.some(isItsFacet)) return geometry.lod;
      }
    }
  }
  return null;
}

/// A square of a colour.
function sample(colour) {
  const made = element('span');
  made.style.background = colour;
  return made;
}

export class ModelView {
  /// `features` as documents/city_json.js reads them, `findings` as documents/findings.js.
  constructor(container, features, findings) {
    this.features = shownFeatures(features, findings);
    this.omitted = features.length - this.features.length;
    this.lods = lodsOf(this.features);
    this.frame = element('div', {class: 'stage'});
    this.tools = element('div', {class: 'tools', role: 'toolbar', 'aria-label': 'View'});
    this.legend = element('ul', {class: 'legend'});
    this.list = new FindingList(findings, (finding) => this.#show(finding));
    const side = element(
        'div', {class: 'side'},
        element(
            'h2', {}, findings.length === 0 ? 'No findings' : counted(findings.length, 'finding')),
        this.list.root);
    this.root = element('div', {class: 'viewer'}, this.tools, this.frame, side, this.legend);
    container.replaceChildren(this.root);
    this.stage = stageIn(this.frame, {
      label: 'Solids in 3D',
      onFrame: (stage) => {
        this.model?.scaleMarks(stage);
        return false;
      }
    });
    if (!this.stage) return;
    this.#addTools(findings);
    this.#load(null);
    this.home();
  }

  /// Looks at everything.
  home() {
    const box = this.model.box();
    if (box.isEmpty()) return;
    const sphere = box.getBoundingSphere(new THREE.Sphere());
    this.stage.lookFromSouth(sphere.center, Math.max(sphere.radius, 0.5));
  }

  #addTools(findings) {
    const button = (text, onclick) => element('button', {type: 'button', onclick}, text);
    this.lodChoice = choice(
        'LoD', [['', 'highest'], ...this.lods.map((lod) => [lod, lod || 'none'])], '',
        (lod) => this.#load(lod === '' ? null : lod));
    this.section = element('input', {
      type: 'range',
      min: 0,
      max: 100,
      value: 100,
      'aria-label': 'Cut at this height, in percent',
      oninput: () => this.#cut()
    });
    this.tools.append(
        ...[findings.length > 0 ? button('Next finding', () => this.list.next()) : null,
            button('All', () => this.home()),
            checkBox('From above', false, (isOn) => this.stage.setMap(isOn)),
            checkBox(
                'Edges', true,
                (isOn) => {
                  this.hasEdges = isOn;
                  this.model.setEdges(isOn);
                  this.stage.draw();
                }),
            this.lods.length > 1 ? this.lodChoice : null,
            element('label', {class: 'choice'}, 'Cut ', this.section)]
            .filter(Boolean));
  }

  #load(lod) {
    this.lod = lod;
    if (this.model) {
      this.stage.scene.remove(this.model.group);
      this.model.dispose();
    }
    const origin = this.model?.origin;
    this.model = new FacetModel(this.features, lod, origin);
    this.model.setEdges(this.hasEdges ?? true);
    this.stage.scene.add(this.model.group);
    this.legend.replaceChildren(
        ...[...this.model.surfaces].map(
            (surface) =>
                element('li', {}, sample(surfaceColour(surface)), surface ?? 'no semantics')),
        element('li', {}, `${grouped(this.model.count)} facets`),
        this.omitted > 0 ? element('li', {}, `${counted(this.omitted, 'feature')} not shown`) : '');
    this.#cut();
    this.#showInside();
    this.stage.draw();
  }

  /// Shows what is in the solids instead of their facets: the solids of `f=structure`; null shows
  /// the facets.
  setInside(solids) {
    this.inside = solids;
    this.#showInside();
    this.stage.draw();
  }

  #showInside() {
    for (const group of this.insideGroups ?? []) this.stage.scene.remove(group);
    const lod = this.lod ?? this.lods[0];
    this.insideGroups = (this.inside ?? [])
                            .filter((solid) => (solid.lod ?? '') === lod)
                            .map((solid) => tetrahedraOf(solid, (at) => this.model.place(at)));
    for (const group of this.insideGroups) this.stage.scene.add(group);
    this.model.mesh.visible = !this.inside;
  }

  #cut() {
    const box = this.model.box(), share = Number(this.section.value) / 100;
    this.model.setSection(
        share === 1 || box.isEmpty() ? null : box.min.z + share * (box.max.z - box.min.z));
    this.stage.draw();
  }

  #show(finding) {
    if (!this.stage) return;
    const lod = lodOf(this.features, finding);
    const highest = this.lods[0];
    if (lod !== null && lod !== (this.lod ?? highest)) {
      this.#load(lod);
      this.lodChoice.querySelector('select').value = lod;
    }
    const place = this.model.mark(finding);
    if (place) this.stage.lookAt(place.centre, Math.max(place.radius, 2), {isFlight: true});
    this.stage.draw();
  }
}
