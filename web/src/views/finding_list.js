// SPDX-License-Identifier: GPL-3.0-or-later
// A list of findings of which one is chosen, by mouse, keys or "next".
import {element} from '../page.js';

const kMostShown = 500;

export class FindingList {
  /// `onChoose(finding)` is called when a finding is chosen.
  constructor(findings, onChoose) {
    this.findings = findings;
    this.onChoose = onChoose;
    this.chosen = -1;
    this.said = element('p', {'aria-live': 'polite', class: 'said'});
    this.buttons =
        findings.slice(0, kMostShown)
            .map(
                (finding, i) => element(
                    'button', {
                      type: 'button',
                      class: `finding ${finding.severity}`,
                      onclick: () => this.choose(i)
                    },
                    element('b', {}, `${finding.code} ${finding.name}`),
                    element('span', {}, finding.text), element('small', {}, finding.feature)));
    const items = this.buttons.map((button) => element('li', {}, button));
    const rest = findings.length - items.length;
    this.root = element(
        'div', {class: 'findings'}, this.said, element('ol', {}, ...items),
        rest > 0 ? element('p', {}, `and ${rest} more, which "next finding" shows too`) : null);
  }

  choose(number) {
    if (this.findings.length === 0) return;
    this.chosen = (number + this.findings.length) % this.findings.length;
    const finding = this.findings[this.chosen];
    this.buttons.forEach((button, i) => {
      if (i === this.chosen) {
        button.setAttribute('aria-current', 'true');
        button.scrollIntoView({block: 'nearest'});
      } else {
        button.removeAttribute('aria-current');
      }
    });
    this.said.textContent =
        `Finding ${this.chosen + 1} of ${this.findings.length}: ${finding.code}, ` +
        `${finding.text}. ${finding.hint}`;
    this.onChoose(finding);
  }

  next() {
    this.choose(this.chosen + 1);
  }
}
