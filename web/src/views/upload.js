// SPDX-License-Identifier: GPL-3.0-or-later
// A file is dropped or chosen, sent to be judged, shown with its findings, and stored on request.
import {readCityModel} from '../documents/city_json.js';
import {findingsOfReport} from '../documents/findings.js';
import {ask, counted, element, grouped, kService, save, size} from '../page.js';

import {ModelView} from './model_view.js';
import {isLong, kArchives, storeForm, storeLongForm, upload} from './store_form.js';

const kTypes = new Map([
  ['.jsonl', 'application/city+json-seq'], ['.json', 'application/city+json'],
  ['.gml', 'application/gml+xml'], ['.xml', 'application/gml+xml'], ['.obj', 'model/obj'],
  ['.off', 'model/vnd.off'], ['.stl', 'model/stl'], ['.ply', 'model/x-ply'], ['.wkt', 'text/wkt']
]);
const kReports = [
  ['report.html', 'text/html', 'Report (HTML, to print)'],
  ['report.json', 'application/json', 'Report (JSON)'],
  ['findings.geojson', 'application/geo+json', 'Findings as a layer (GeoJSON)']
];

const kAnyType = 'application/octet-stream';  // the service looks at the first bytes
const typeOf = (name) =>
    kTypes.get(name.toLowerCase().match(/\.[a-z]+$/)?.[0] ?? '') ?? 'application/octet-stream';

class Upload {
  constructor(container) {
    this.input = element('input', {
      type: 'file',
      id: 'file',
      accept: [...kTypes.keys(), ...kArchives].join(','),
      onchange: () => this.take(this.input.files[0])
    });
    this.state = element('p', {role: 'status'});
    this.progress = element('progress', {hidden: true, max: 1, 'aria-label': 'Progress'});
    this.result = element('div');
    const zone = element(
        'div', {class: 'drop'},
        element(
            'label',
            {for: 'file'
            },
            'Drop a file here, or choose one: '),
        this.input,
        element(
            'p', {}, 'CityJSON, CityJSONSeq, GML, OBJ, OFF, STL, PLY, WKT. Nothing is stored.'));
    for (const name of ['dragenter', 'dragover', 'dragleave', 'drop']) {
      zone.addEventListener(name, (event) => {
        event.preventDefault();
        zone.classList.toggle('over', name === 'dragenter' || name === 'dragover');
        if (name === 'drop') this.take(event.dataTransfer.files[0]);
      });
    }
    container.replaceChildren(zone, this.progress, this.state, this.result);
  }

  /// Judges a file and shows the result.
  async take(file) {
    if (!file) return;
    this.result.replaceChildren();
    this.stored = null;  // the document as a city model
    if (isLong(file)) {
      this.state.textContent = `${file.name} (${size(file.size)}) is too long to be shown here. ` +
          'It can be stored, and judged meanwhile.';
      this.result.replaceChildren(storeLongForm(file));
      return;
    }
    this.progress.hidden = false;
    this.progress.value = 0;
    this.state.textContent = `Sending ${file.name} (${size(file.size)})`;
    try {
      const fields = {'Content-Type': typeOf(file.name), Accept: 'application/json'};
      const report = await upload(`${kService}validate`, file, fields, (sent, all) => {
        this.progress.value = sent / all;
        if (sent === all) {
          this.progress.removeAttribute('value');
          this.state.textContent = `Judging ${file.name}`;
        }
      });
      await this.#show(file, report);
    } catch (error) {
      this.state.textContent = `${file.name}: ${error.message}`;
    }
    this.progress.hidden = true;
  }

  async #show(file, report) {
    const solids = (report.primitives_overview ?? []).reduce((sum, {total}) => sum + total, 0);
    this.state.textContent = `${file.name} is ${report.verdict}: ${counted(solids, 'solid')}.`;
    const view = element('div');
    this.result.replaceChildren(
        view, this.#downloads(file), this.#counts(report), storeForm(file, () => this.stored));
    const findings = findingsOfReport(report);
    let model;
    try {
      const text = await this.#cityModelOf(file, report);
      model = readCityModel(text);
      this.stored = new File([text], file.name, {type: kAnyType});
    } catch (error) {
      this.state.append(` There is no picture: ${error.message}.`);
      model = {features: []};
    }
    this.view = new ModelView(view, model.features, findings);
  }

  /// The document as a city model, which the service makes of it if it is none.
  async #cityModelOf(file, report) {
    if (report.input_file_type.startsWith('CityJSON')) return file.text();
    const answer = await ask(kService + 'convert', {
      method: 'POST',
      body: file,
      headers: {'Content-Type': typeOf(file.name), Accept: 'application/city+json'}
    });
    return answer.text();
  }

  #counts(report) {
    const rows = [...(report.features_overview ?? [])].map(
        ({type, total, valid}) => element(
            'tr', {}, element('th', {scope: 'row'}, type),
            element('td', {class: 'number'}, grouped(total)),
            element('td', {class: 'number'}, grouped(valid))));
    const head = element(
        'tr', {}, element('th', {scope: 'col'}, 'Features'),
        element('th', {scope: 'col', class: 'number'}, 'Number'),
        element('th', {scope: 'col', class: 'number'}, 'Valid'));
    return element('table', {}, head, ...rows);
  }

  #downloads(file) {
    const buttons = kReports.map(
        ([name, type, text]) => element(
            'button', {
              type: 'button',
              onclick: async () => {
                try {
                  const answer = await ask(kService + 'validate', {
                    method: 'POST',
                    body: file,
                    headers: {'Content-Type': typeOf(file.name), Accept: type}
                  });
                  save(name, type, await answer.blob());
                } catch (error) {
                  this.state.textContent = error.message;
                }
              }
            },
            text));
    return element('p', {class: 'tools'}, ...buttons);
  }
}

export function showUpload(container) {
  return new Upload(container);
}
