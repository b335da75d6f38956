// SPDX-License-Identifier: GPL-3.0-or-later
// A file is dropped or chosen, sent to be judged, shown with its findings, and stored on request.
import {readCityModel} from '../documents/city_json.js';
import {findingsOfReport} from '../documents/findings.js';
import {ask, counted, element, grouped, kService, save, size} from '../page.js';

import {ModelView} from './model_view.js';

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

/// Sends a file and says how much is sent; the report.
function judged(address, file, onProgress) {
  return new Promise((resolve, reject) => {
    const request = new XMLHttpRequest();
    request.open('POST', address);
    request.setRequestHeader('Content-Type', typeOf(file.name));
    request.setRequestHeader('Accept', 'application/json');
    request.upload.onprogress = (event) => onProgress(event.loaded, event.total);
    request.onerror = () => reject(new Error('the service does not answer'));
    request.onload = () => {
      let answer;
      try {
        answer = JSON.parse(request.responseText);
      } catch {
        answer = {};
      }
      if (request.status === 200) {
        resolve(answer);
      } else {
        reject(new Error(answer.detail ?? `the service answers ${request.status}`));
      }
    };
    request.send(file);
  });
}

class Upload {
  constructor(container) {
    this.input = element('input', {
      type: 'file',
      id: 'file',
      accept: [...kTypes.keys()].join(','),
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
    this.progress.hidden = false;
    this.progress.value = 0;
    this.state.textContent = `Sending ${file.name} (${size(file.size)})`;
    try {
      const report = await judged(kService + 'validate', file, (sent, all) => {
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
        view, this.#downloads(file), this.#counts(report), this.#storing(file));
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

  /// The form that stores the file in a collection.
  #storing(file) {
    const suggestion = file.name.replace(/\..*$/, '').replace(/[^A-Za-z0-9_.-]/g, '-').slice(0, 64);
    const id = element('input', {
      id: 'collection',
      required: true,
      pattern: '[A-Za-z0-9_.\\-]{1,64}',
      value: suggestion,
      title: 'letters, digits, and _ . -'
    });
    const policy = element(
        'select', {id: 'policy'},
        element('option', {value: 'keep'}, 'keep it, marked as not proven'),
        element('option', {value: 'skip'}, 'leave it out'),
        element('option', {value: 'refuse'}, 'store nothing'));
    const said = element('p', {role: 'status'});
    const store = async (event) => {
      event.preventDefault();
      said.textContent = 'Storing';
      const address = `${kService}collections/${encodeURIComponent(id.value)}`;
      try {
        const answer = await ask(
            `${address}/items?invalid=${policy.value}`,
            {method: 'POST', body: this.stored ?? file, headers: {'Content-Type': kAnyType}});
        const outcome = await answer.json();
        said.replaceChildren(
            `${counted(outcome.stored, 'feature')} stored in `,
            element('a', {href: address}, id.value));
      } catch (error) {
        said.textContent = error.message;
      }
    };
    return element(
        'details', {class: 'store'}, element('summary', {}, 'Store this file'),
        element('form', {onsubmit: store}, element('label', {for: 'collection'
                }, 'Collection '), id, element('label', {for: 'policy'
                }, ' What is not valid: '), policy, element('button', {}, 'Store')), said);
  }
}

export function showUpload(container) {
  return new Upload(container);
}
