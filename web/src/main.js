// SPDX-License-Identifier: GPL-3.0-or-later
// Brings the parts of a page to life that ask for it by `data-view`. Without this program the pages
// have all facts as text.
import './style.css';

import {element} from './page.js';
import {showCity} from './views/city.js';
import {showFilter} from './views/filter.js';
import {showItem} from './views/item.js';
import {showJob} from './views/job.js';
import {showUpload} from './views/upload.js';

const kViews = {
  city: showCity,
  filter: showFilter,
  item: showItem,
  job: showJob,
  upload: showUpload
};

for (const container of document.querySelectorAll('[data-view]')) {
  container.hidden = false;
  Promise.resolve()
      .then(() => kViews[container.dataset.view](container))
      .catch(
          (error) => container.replaceChildren(element(
              'p', {class: 'message', role: 'alert'},
              `This part of the page cannot be shown: ${error.message}`)));
}
