// SPDX-License-Identifier: GPL-3.0-or-later
// The forms that store a file in a collection: at once, or as a job if it is long.
import {ask, counted, element, kService} from '../page.js';

const kAnyType = 'application/octet-stream';  // the service looks at the first bytes
const kLongBytes = 64e6;                      // more than a page shows of a document with ease
/// The endings of files that only a job takes.
export const kArchives = ['.zip', '.gz', '.zst', '.wt'];

/// Whether a file is one for a job.
export function isLong(file) {
  return file.size > kLongBytes || kArchives.some((end) => file.name.toLowerCase().endsWith(end));
}

/// Sends a file and says how much is sent; the answer.
export function upload(address, file, fields, onProgress) {
  return new Promise((resolve, reject) => {
    const request = new XMLHttpRequest();
    request.open('POST', address);
    for (const [name, value] of Object.entries(fields)) request.setRequestHeader(name, value);
    request.upload.onprogress = (event) => onProgress(event.loaded, event.total);
    request.onerror = () => reject(new Error('the service does not answer'));
    request.onload = () => {
      let answer;
      try {
        answer = JSON.parse(request.responseText);
      } catch {
        answer = {};
      }
      if (request.status < 300) {
        resolve(answer);
      } else {
        reject(new Error(answer.detail ?? `the service answers ${request.status}`));
      }
    };
    request.send(file);
  });
}

/// The fields for collection and policy, and what `store(collection, policy)` makes of them.
function form(file, store) {
  const suggestion = file.name.replace(/\..*$/, '').replace(/[^A-Za-z0-9_.-]/g, '-').slice(0, 64);
  const id = element('input', {
    id: 'collection',
    required: true,
    pattern: '[A-Za-z0-9_.\\-]{1,64}',
    value: suggestion,
    title: 'letters, digits, and _ . -'
  });
  const policy = element(
      'select', {id: 'policy'}, element('option', {value: 'keep'}, 'keep it, marked as not proven'),
      element('option', {value: 'skip'}, 'leave it out'),
      element('option', {value: 'refuse'}, 'store nothing'));
  const said = element('p', {role: 'status'});
  const take = async (event) => {
    event.preventDefault();
    said.textContent = 'Storing';
    try {
      said.replaceChildren(...await store(id.value, policy.value, said));
    } catch (error) {
      said.textContent = error.message;
    }
  };
  return [
    element(
        'form', {onsubmit: take},
        element(
            'label',
            {for: 'collection'
            },
            'Collection '),
        id,
        element(
            'label',
            {for: 'policy'
            },
            ' What is not valid: '),
        policy, element('button', {}, 'Store')),
    said
  ];
}

/// The form for a file that was judged; `document` gives it as a city model, if it was made one.
export function storeForm(file, document) {
  const store = async (collection, policy) => {
    const address = `${kService}collections/${encodeURIComponent(collection)}`;
    const answer = await ask(
        `${address}/items?invalid=${policy}`,
        {method: 'POST', body: document() ?? file, headers: {'Content-Type': kAnyType}});
    const outcome = await answer.json();
    return [
      `${counted(outcome.stored, 'feature')} stored in `, element('a', {href: address}, collection)
    ];
  };
  return element(
      'details', {class: 'store'}, element('summary', {}, 'Store this file'), ...form(file, store));
}

/// The form for a long file, which becomes a job.
export function storeLongForm(file) {
  const progress = element('progress', {hidden: true, max: 1, 'aria-label': 'Progress'});
  const store = async (collection, policy, said) => {
    const query = new URLSearchParams({collection, invalid: policy, name: file.name});
    progress.hidden = false;
    try {
      const fields = {'Content-Type': kAnyType};
      const job = await upload(`${kService}jobs?${query}`, file, fields, (sent, all) => {
        progress.value = sent / all;
        said.textContent = `Sending ${file.name}`;
      });
      const address = `${kService}jobs/${job.jobID}`;
      return [
        'The file is sent, and is stored ', element('a', {href: address}, 'as this job'), '.'
      ];
    } finally {
      progress.hidden = true;
    }
  };
  const parts = form(file, store);
  return element('div', {class: 'store'}, ...parts, progress);
}
