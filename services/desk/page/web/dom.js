// SPDX-License-Identifier: Apache-2.0
// What all parts of the page use.

export const $ = (id) => document.getElementById(id);

/** An element with properties, attributes (with a dash, or role) and children. */
export function el(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name.includes('-') || name === 'role' || name === 'for') element.setAttribute(name, value);
    else element[name] = value;
  }
  element.append(...children.filter((child) => child !== null));
  return element;
}

/** Sets a text only if it differs: a screen reader says what changes. */
export function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

let toastTimer = 0;
/** Says a sentence at the lower edge for some seconds. */
export function say(sentence, isFault = false) {
  const toast = $('toast');
  toast.textContent = sentence;
  toast.classList.toggle('fault', isFault);
  clearTimeout(toastTimer);
  toastTimer = setTimeout(() => { toast.textContent = ''; }, isFault ? 8000 : 2500);
}

/** Sends a change. Returns whether it was done; says why if it was not. */
export async function post(path, body = {}) {
  let answer = null;
  // A setting may be set twice. A desk with too many visitors turns some away.
  for (let tries = path === '/api/set' ? 3 : 1; !answer && tries > 0; --tries) {
    try {
      answer = await fetch(path, {
        method: 'POST', headers: {'Content-Type': 'application/json'}, body: JSON.stringify(body), cache: 'no-store',
      });
    } catch {
      if (tries > 1) await new Promise((resolve) => setTimeout(resolve, 150));
    }
  }
  if (!answer) return say('The desk does not answer; nothing was changed.', true), false;
  if (answer.ok) return true;
  const told = await answer.json().catch(() => ({}));
  say(told.error || `The desk refused this (${answer.status}).`, true);
  return false;
}

/** A number with at most so many digits behind the point. */
export function figure(value, digits = 1) {
  return value === null || value === undefined || !isFinite(value) ? '–' : value.toFixed(digits);
}

export const kRoles = ['viewer', 'operator', 'owner'];
