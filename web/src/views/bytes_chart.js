// SPDX-License-Identifier: GPL-3.0-or-later
// A table of what takes the bytes of a feature, with bars.
import {element, size} from '../page.js';

/// The bytes of all solids by part, and of the text with everything else.
function partsOf(structure) {
  const parts = new Map();
  for (const solid of structure.solids) {
    for (const {name, bytes} of solid.parts) parts.set(name, (parts.get(name) ?? 0) + bytes);
  }
  return [
    ...[...parts].map(([name, bytes]) => [`solids: ${name}`, bytes]),
    ['attributes, semantics and other geometry', structure.bytes.text]
  ];
}

/// The table for an answer of `f=structure`.
export function bytesChart(structure) {
  const parts = partsOf(structure);
  const most = Math.max(...parts.map(([, bytes]) => bytes), 1);
  const rows = parts.map(([name, bytes]) => {
    const bar = element('div', {class: 'bar'});
    bar.style.width = `${(12 * bytes / most).toFixed(2)}em`;
    return element(
        'tr', {}, element('th', {scope: 'row'}, name),
        element('td', {class: 'number'}, size(Number(bytes.toFixed(1)))),
        element('td', {'aria-hidden': 'true'}, bar));
  });
  return element(
      'table', {class: 'bytes'}, element('caption', {}, 'Bytes in the database'), ...rows);
}
