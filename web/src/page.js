// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of a page: elements, and answers of the service.

/// The address of the service, as this program was loaded from it.
export const kService = new URL(/* @vite-ignore */ '..', import.meta.url).pathname;

/// The path of the page, without a slash at its end.
export const pagePath = () => location.pathname.replace(/\/$/, '');

/// An element with attributes and children. Attributes that begin with "on" are listeners; true
/// stands for an attribute without value, and false, null and undefined for none.
export function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith('on')) {
      made.addEventListener(key.slice(2), value);
    } else if (value !== false && value !== null && value !== undefined) {
      made.setAttribute(key, value === true ? '' : value);
    }
  }
  made.append(...children.filter((child) => child !== null && child !== undefined));
  return made;
}

/// A check box with its label.
export function checkBox(text, isOn, onChange) {
  const box =
      element('input', {type: 'checkbox', checked: isOn, onchange: () => onChange(box.checked)});
  return element('label', {class: 'choice'}, box, ` ${text}`);
}

/// A list to choose from, with its label; `choices` are pairs of value and text.
export function choice(text, choices, chosen, onChange) {
  const list = element('select', {onchange: () => onChange(list.value)});
  for (const [value, name] of choices) {
    list.append(element('option', {value, selected: value === chosen}, name));
  }
  return element('label', {class: 'choice'}, `${text} `, list);
}

/// The reason that an answer gives for its failure.
export async function problemOf(response) {
  const text = await response.text();
  try {
    const problem = JSON.parse(text);
    return problem.detail ?? problem.title ?? text;
  } catch {
    return text.slice(0, 200) || `the service answers ${response.status}`;
  }
}

/// Asks the service and throws its reason if it refuses.
export async function ask(address, options = {}) {
  let response;
  try {
    response = await fetch(address, options);
  } catch {
    throw new Error('the service does not answer');
  }
  if (!response.ok) throw new Error(await problemOf(response));
  return response;
}

/// A number with a space between thousands.
export function grouped(number) {
  return String(number).replace(/\B(?=(\d{3})+(?!\d))/g, '\u2009');
}

/// A count with its noun.
export function counted(number, one, many = `${one}s`) {
  return `${grouped(number)} ${number === 1 ? one : many}`;
}

/// Bytes in a unit that is easy to read.
export function size(bytes) {
  if (bytes < 1000) return `${bytes} B`;
  if (bytes < 1e6) return `${(bytes / 1e3).toFixed(1)} kB`;
  return `${(bytes / 1e6).toFixed(1)} MB`;
}

/// Makes the browser save a text or bytes as a file.
export function save(name, type, content) {
  const address = URL.createObjectURL(new Blob([content], {type}));
  element('a', {href: address, download: name}).click();
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}
