// SPDX-License-Identifier: Apache-2.0
// The search of the handbook. A section is found if it has all words of the query, or words that contain them; those in headings count most.
'use strict';
(() => {
  const root = document.currentScript.dataset.root;
  const field = document.getElementById('search');
  const list = document.getElementById('found');
  const kMostFound = 12;
  let index = null;

  // The index is a script, because a page that is opened from a disk may load no other file.
  const load = () => index ??= new Promise((done) => {
    const script = document.createElement('script');
    script.onload = () => done(handbookIndex);
    script.src = root + 'handbook-index.js';
    document.head.append(script);
  });

  const score = (terms, title, heading, words) => {
    let sum = 0;
    for (const term of terms) {
      const places = [[heading, 4], [title, 2], [words, 1]].filter(([text]) => text.includes(term));
      if (places.length === 0) return 0;
      sum += Math.max(...places.map(([text, worth]) => (` ${text} `.includes(` ${term} `) ? 2 : 1) * worth));
    }
    return sum;
  };

  const search = ({pages, sections}, query) => {
    const terms = query.toLowerCase().split(/\s+/).filter(Boolean);
    if (terms.length === 0) return [];
    return sections
      .map(([page, anchor, heading, words]) => {
        const [address, title, worth] = pages[page];
        return {address, anchor, heading, title, score: worth * score(terms, title.toLowerCase(), heading.toLowerCase(), words)};
      })
      .filter((found) => found.score > 0)
      .sort((a, b) => b.score - a.score)
      .slice(0, kMostFound);
  };

  const entry = ({address, anchor, heading, title}) => {
    const item = document.createElement('li'), link = document.createElement('a');
    link.href = root + address + (anchor ? '#' + anchor : '');
    link.append(heading);
    if (heading !== title) link.append(Object.assign(document.createElement('small'), {textContent: title}));
    link.addEventListener('click', () => list.hidden = true);
    item.append(link);
    return item;
  };

  const show = async () => {
    const found = search(await load(), field.value).map(entry);
    const none = Object.assign(document.createElement('li'), {className: 'none', textContent: 'Nothing has all of these words.'});
    list.replaceChildren(...(found.length > 0 ? found : [none]));
    list.hidden = field.value.trim() === '';
  };

  const menu = document.getElementById('menu'), here = menu.querySelector('[aria-current]');
  if (here) menu.scrollTop = here.offsetTop - menu.clientHeight / 2;
  field.parentElement.hidden = false;
  field.addEventListener('focus', load);
  field.addEventListener('input', show);
  document.addEventListener('click', (event) => list.hidden ||= !field.parentElement.contains(event.target));
  document.addEventListener('keydown', (event) => {
    if (event.key === '/' && document.activeElement !== field) event.preventDefault(), field.focus();
    if (event.key === 'Escape') list.hidden = true, field.blur();
    if (event.key === 'Enter' && document.activeElement === field) list.querySelector('a')?.click();
  });
})();
