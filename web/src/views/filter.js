// SPDX-License-Identifier: GPL-3.0-or-later
// A field that leaves the rows of the page's table in which a text occurs.
import {element} from '../page.js';

export function showFilter(container) {
  const rows = [...document.querySelectorAll('table tr')].slice(1);
  const said = element('span', {role: 'status'});
  const field = element('input', {
    id: 'filter',
    type: 'search',
    oninput: () => {
      const wanted = field.value.trim().toLowerCase();
      for (const row of rows) row.hidden = !row.textContent.toLowerCase().includes(wanted);
      const shown = rows.filter((row) => !row.hidden).length;
      said.textContent = wanted === '' ? '' : ` ${shown} of ${rows.length}`;
    }
  });
  container.replaceChildren(element('label', {for: 'filter'
                            }, 'Only rows with '), field, said);
}
