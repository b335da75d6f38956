// SPDX-License-Identifier: GPL-3.0-or-later
// The view of a stored feature: what the service has of it, with its findings.
import {readCityModel} from '../documents/city_json.js';
import {findingsOfProof} from '../documents/findings.js';
import {ask, pagePath} from '../page.js';

import {ModelView} from './model_view.js';

/// The page is that of the feature, so its address is the feature's.
export async function showItem(container) {
  const address = pagePath();
  const [document, proof] = await Promise.all([
    ask(`${address}?f=cityjsonseq`).then((response) => response.text()),
    ask(`${address}?f=proof`).then((response) => response.json())
  ]);
  const view = new ModelView(container, readCityModel(document).features, findingsOfProof(proof));
  const wanted = new URLSearchParams(location.hash.slice(1)).get('finding');
  if (wanted !== null) view.list.choose(Number(wanted) || 0);
}
