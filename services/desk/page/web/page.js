// SPDX-License-Identifier: Apache-2.0
// The page: who one is, the stream of events, keys and tabs.

import {$, el, kRoles, post, say, setText} from '/dom.js';
import {Settings, showCompare, showLight, showSettings} from '/controls.js';
import {Cues, Hands, Looks, Services, showAges} from '/rig.js';
import {Picture} from '/picture.js';
import {Tools} from '/tools.js';

const kRetry_ms = 2000;

function notice(sentence) {
  $('notice').textContent = sentence;
  $('notice').hidden = sentence === '';
}

function link(state, text) {
  document.querySelector('#link .dot').className = `dot ${state}`;
  if ($('link-text').textContent === text) return;
  const [first, ...more] = text.split(' as ');
  $('link-text').replaceChildren(first, ...more.map((role) => el('span', {className: 'as'}, ` as ${role}`)));
}

/** Trades the token of the address for a cookie, and takes it out of the address and the history. */
async function openSession() {
  const token = new URLSearchParams(location.hash.slice(1)).get('token');
  if (!token) return;
  history.replaceState(null, '', location.pathname);
  await post('/api/session', {token});
}

/** What the desk says at the start; null if it does not let us in, or is not there. */
async function askStart() {
  try {
    const answer = await fetch('/api/start', {cache: 'no-store'});
    const told = await answer.json();
    if (answer.ok) return notice(''), told;
    notice(told.error);
    link('bad', 'no access');
    // From another computer: a code is traded for a cookie.
    $('pair').hidden = answer.status !== 401 || location.protocol !== 'https:';
  } catch {
    link('bad', 'the desk is away');
  }
  return null;
}

class Page {
  constructor(start) {
    $('pair').hidden = true;
    this.start = JSON.stringify(start);
    const may = kRoles.indexOf(start.role);
    this.role = start.role;
    setText($('rig'), start.rig);
    document.title = `${start.rig} · handcast desk`;
    $('main').hidden = false;
    const settings = this.settings = new Settings(start.controls);
    settings.mayChange = may >= 1;
    settings.mayLearn = may >= 2;
    this.filter = showSettings(settings);
    showLight(settings);
    showCompare(settings);
    this.services = new Services(start.backends, may >= 2);
    this.tools = new Tools(settings, may >= 2);
    this.looks = new Looks(start.looks, settings);
    this.cues = new Cues(settings.mayChange);
    this.hands = new Hands();
    this.picture = new Picture();
    this.changes(settings.mayChange, may >= 2);
    this.events = null;
    // A browser has six connections to the desk for all of its tabs.
    document.addEventListener('visibilitychange', () => (document.hidden ? this.events?.close() : this.listen()));
    this.listen();
  }

  changes(mayChange, isOwner) {
    this.mayChange = mayChange;
    for (const what of ['undo', 'redo']) $(what).addEventListener('click', () => post(`/api/${what}`));
    $('save').disabled = $('preset-store').disabled = $('preset-name').disabled = !isOwner;
    $('preset-load').disabled = $('preset').disabled = !mayChange;
    $('save').addEventListener('click', async () => { if (await post('/api/save')) say('Saved for the next start of the rig'); });
    $('preset-load').addEventListener('click', async () => {
      if ($('preset').value && await post('/api/preset/load', {name: $('preset').value})) say(`Preset ${$('preset').value}`);
    });
    $('preset-store').addEventListener('click', async () => {
      const name = $('preset-name').value.trim() || $('preset').value;
      if (!name) return say('Give the preset a name.', true);
      if (await post('/api/preset/store', {name})) say(`Preset ${name} is stored`), $('preset-name').value = '';
    });
  }

  listen() {
    this.events?.close();
    const events = this.events = new EventSource('/api/events');
    const on = (name, take) => events.addEventListener(name, (event) => take(JSON.parse(event.data)));
    events.addEventListener('open', () => link('on', `connected as ${this.role}`));
    events.addEventListener('error', () => {
      if (events !== this.events) return;
      link('bad', 'the desk is away');
      if (events.readyState === EventSource.CLOSED) setTimeout(() => this.return(), kRetry_ms);
    });
    on('values', (told) => this.takeValues(told));
    on('status', (status) => this.services.take(status));
    on('content', (hands) => this.looks.take(hands));
    on('ages', showAges);
    on('hands', (hands) => this.hands.take(hands));
    on('cues', (cues) => this.cues.take(cues));
    on('cue_list', (list) => this.cues.takeList(list));
    on('midi', (midi) => this.tools.takeMidi(midi));
    on('recordings', (recordings) => this.tools.takeRecordings(recordings));
    on('doctor', (doctor) => this.tools.takeDoctor(doctor));
    on('calibration', (calibration) => this.tools.takeCalibration(calibration));
    on('presets', (names) => {
      const chosen = $('preset').value;
      $('preset').replaceChildren(...(names.length ? names : ['']).map((name) => el('option', {value: name}, name || 'No presets yet')));
      if (names.includes(chosen)) $('preset').value = chosen;
    });
  }

  /** The stream was refused: the token is no longer valid, or the desk was replaced. */
  async return() {
    const start = await askStart();
    if (!start) return setTimeout(() => this.return(), kRetry_ms);
    if (JSON.stringify(start) !== this.start) return location.reload();
    this.listen();
  }

  takeValues(told) {
    this.settings.take(told.values);
    $('undo').disabled = !this.mayChange || !told.undo;
    $('redo').disabled = !this.mayChange || !told.redo;
    setText($('last'), told.change ? `${told.source}: ${told.change}` : '');
    if ($('only-changed').checked) this.filter();
  }
}

/** Keys that are no letters of a text; those of the cues come first. */
function listenToKeys() {
  document.addEventListener('keydown', (event) => {
    const isText = event.target.matches('input:not([type=range]):not([type=checkbox]):not([type=radio]), select, textarea');
    if (isText || event.altKey) return;
    const press = (id) => { event.preventDefault(); if (!$(id).disabled) $(id).click(); };
    if (event.ctrlKey || event.metaKey) {
      if (event.key === 'z') press('undo');
      if (event.key === 'y' || event.key === 'Z') press('redo');
    } else if (page?.cues.hasKey(event.key)) post('/api/cue', {do: 'key', key: event.key});
    else if (event.key === 'B') press('blackout');
    else if (event.key === 'F') press('freeze');
    else if (event.key === '/') event.preventDefault(), $('search').focus();
  });
}

/** On a phone, one part is shown: that of the address. */
function showTabs() {
  const show = () => {
    const tabs = [...$('tabs').querySelectorAll('a')];
    const chosen = tabs.find((tab) => tab.hash === location.hash) ?? tabs[0];
    for (const tab of tabs) {
      if (tab === chosen) tab.setAttribute('aria-current', 'page');
      else tab.removeAttribute('aria-current');
      document.querySelector(tab.hash).classList.toggle('shown', tab === chosen);
    }
    if (getComputedStyle($('tabs')).display !== 'none') window.scrollTo(0, 0);
  };
  window.addEventListener('hashchange', show);
  show();
}

function listenToCode() {
  $('pair').addEventListener('submit', async (event) => {
    event.preventDefault();
    if (await post('/api/pair', {code: $('code').value.replace(/\D/g, '')})) $('pair').hidden = true;
    $('code').value = '';
  });
}

let page = null;

async function begin() {
  listenToKeys();
  listenToCode();
  await openSession();
  showTabs();
  for (;;) {
    const start = await askStart();
    if (start) return page = new Page(start);
    await new Promise((resolve) => setTimeout(resolve, kRetry_ms));
  }
}

begin();
