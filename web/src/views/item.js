// SPDX-License-Identifier: GPL-3.0-or-later
// The view of a stored feature: what the service has of it, with its findings and its inside.
import {readCityModel} from '../documents/city_json.js';
import {findingsOfProof} from '../documents/findings.js';
import {ask, checkBox, counted, element, pagePath} from '../page.js';

import {bytesChart} from './bytes_chart.js';
import {ModelView} from './model_view.js';

/// Adds the switch for the inside of the solids, which is asked for when it is first wanted.
function addInside(view, address) {
  const said = element('div', {'aria-live': 'polite'});
  let structure = null;
  const show = async (isOn) => {
    if (!isOn) {
      view.setInside(null);
      said.replaceChildren();
      return;
    }
    try {
      structure ??= await (await ask(`${address}?f=structure`)).json();
    } catch (error) {
      said.textContent = error.message;
      return;
    }
    const sum = (count) => structure.solids.reduce((all, solid) => all + count(solid), 0);
    const tetrahedra = sum((solid) => solid.tetrahedra?.length ?? 0);
    const steiner = sum((solid) => solid.steinerVertices ?? 0);
    const missing = sum((solid) => solid.unrecoveredFaces?.length ?? 0);
    view.setInside(structure.solids);
    said.replaceChildren(
        element(
            'p', {},
            `${counted(structure.solids.length, 'proven solid')}: ${
                counted(tetrahedra, 'tetrahedron', 'tetrahedra')}, ${
                counted(steiner, 'Steiner point')} (red), ${
                counted(missing, 'face')} that the Delaunay tetrahedralization lacks (blue).`),
        bytesChart(structure));
  };
  view.tools.append(checkBox('Inside and bytes', false, show));
  view.root.after(said);
}

/// The page is that of the feature, so its address is the feature's.
export async function showItem(container) {
  const address = pagePath();
  const [document, proof] = await Promise.all([
    ask(`${address}?f=cityjsonseq`).then((response) => response.text()),
    ask(`${address}?f=proof`).then((response) => response.json())
  ]);
  const view = new ModelView(container, readCityModel(document).features, findingsOfProof(proof));
  if (view.stage) addInside(view, address);
  const wanted = new URLSearchParams(location.hash.slice(1)).get('finding');
  if (wanted !== null) view.list.choose(Number(wanted) || 0);
}
