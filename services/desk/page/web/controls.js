// SPDX-License-Identifier: Apache-2.0
// The live settings: their values, and the widgets that show and change them.

import {$, el, post, say, setText} from '/dom.js';

const kSendEvery_ms = 33;   // a slider that is moved
const kEcho_ms = 1000;      // by then the desk has told of what was sent to it
const kOwnHand_ms = 500;    // so long after a person has moved a widget, it does not follow others

/** The value of TOML text: numbers, texts, toggles and lists are written as in JSON. */
export function parse(toml) {
  if (toml === undefined) return undefined;
  try {
    return JSON.parse(toml);
  } catch {
    if (toml === 'inf' || toml === '+inf') return Infinity;
    if (toml === '-inf') return -Infinity;
    return toml.replace(/^'([^']*)'$/, '$1');
  }
}

/** The controls and their values, which the desk tells. */
export class Settings {
  constructor(controls) {
    this.controls = controls;
    this.byPath = new Map(controls.map((control) => [control.path, control]));
    this.toml = new Map();
    this.followers = new Map(controls.map((control) => [control.path, []]));
    this.waiting = new Map();   // path -> TOML that is not sent yet
    this.unheard = new Map();   // path -> TOML of which the desk has not told yet, and when it was set
    this.isSending = false;
    this.mayChange = false;
    this.mayLearn = false;      // knobs of a MIDI controller
    this.knobs = new Map();     // path -> the buttons that bind it
  }

  follow(path, follower) {
    this.followers.get(path)?.push(follower);
    if (this.toml.has(path)) follower(this.toml.get(path));
  }

  take(values) {
    for (const [path, toml] of Object.entries(values)) {
      this.toml.set(path, toml);
      if (String(parse(this.unheard.get(path)?.toml)) === String(parse(toml))) this.unheard.delete(path);
      for (const follower of this.followers.get(path) ?? []) follower(toml);
    }
  }

  isChanged(path) {
    return this.toml.has(path) && this.toml.get(path) !== this.byPath.get(path).filed;
  }

  /** Changes a setting soon. What is turned quickly is sent thirty times a second. */
  set(path, toml) {
    this.waiting.set(path, toml);
    this.unheard.set(path, {toml: toml ?? this.byPath.get(path).filed, when: performance.now()});
    if (!this.isSending) this.send();
  }

  /** All values as the one who turns them knows them: also those that were set a moment ago. */
  current() {
    const values = new Map(this.toml);
    for (const [path, {toml, when}] of this.unheard) if (performance.now() - when < kEcho_ms) values.set(path, toml);
    return values;
  }

  async send() {
    this.isSending = true;
    while (this.waiting.size > 0) {
      const assignments = [...this.waiting].map(([path, toml]) => (toml === null ? path : `${path}=${toml}`));
      const paths = [...this.waiting.keys()];
      this.waiting.clear();
      const isDone = await post('/api/set', {set: assignments});
      if (!isDone) this.show(paths);
      await new Promise((resolve) => setTimeout(resolve, kSendEvery_ms));
    }
    this.isSending = false;
  }

  /** Shows what the desk last told. */
  show(paths) {
    for (const path of paths) this.unheard.delete(path);
    for (const path of paths)
      if (this.toml.has(path)) for (const follower of this.followers.get(path) ?? []) follower(this.toml.get(path), true);
  }

  /** Back to the value of the rig file. */
  reset(path) { this.set(path, null); }
}

function stepOf(control) {
  if (control.kind === 'whole') return 1;
  const span = control.max - control.min;
  return control.min === null || control.max === null ? 'any' : 10 ** Math.floor(Math.log10(span / 500));
}

/** A widget that is not moved by others while a person moves it; a moment later it shows what they have set. */
function guarded(show) {
  let touched = -Infinity, newest, timer = 0;
  const settle = () => {
    const wait_ms = touched + kOwnHand_ms - performance.now();
    timer = wait_ms > 0 ? setTimeout(settle, wait_ms) : 0;
    if (!timer) show(newest);
  };
  return {
    touch() { touched = performance.now(); },
    show(toml, isForced) {
      newest = toml;
      if (isForced) show(toml);
      else if (!timer) settle();
    },
  };
}

function numberWidget(settings, control, names) {
  const hasRange = control.min !== null && control.max !== null;
  const bounds = hasRange ? {min: control.min, max: control.max} : {};
  const box = el('input', {type: 'number', step: 'any', ...bounds, ...names});
  if (control.min !== null) box.min = control.min;
  const slider = hasRange ? el('input', {type: 'range', min: control.min, max: control.max, step: stepOf(control), ...names}) : null;
  const guard = guarded((toml) => {
    const value = parse(toml);
    box.value = String(value);
    if (slider) slider.value = value;
  });
  const change = (value) => {
    guard.touch();
    settings.set(control.path, control.kind === 'whole' ? String(Math.round(value)) : String(value));
  };
  slider?.addEventListener('input', () => { box.value = slider.value; change(Number(slider.value)); });
  box.addEventListener('change', () => {
    if (box.value === '' || !box.checkValidity()) {
      say(`${control.path}: ${box.validationMessage || 'a number is missing'}`, true);
      settings.show([control.path]);
      return;
    }
    if (slider) slider.value = box.value;
    change(Number(box.value));
  });
  settings.follow(control.path, guard.show);
  return [slider, box, el('span', {className: 'unit'}, control.unit)];
}

function toggleWidget(settings, control, names) {
  const button = el('button', {className: 'switch', role: 'switch', 'aria-checked': 'false', ...names});
  button.addEventListener('click', () => settings.set(control.path, String(button.getAttribute('aria-checked') !== 'true')));
  settings.follow(control.path, (toml) => button.setAttribute('aria-checked', toml));
  return [button];
}

function choiceWidget(settings, control, names) {
  const select = el('select', names, ...control.words.map((word) => el('option', {value: word}, word)));
  select.addEventListener('change', () => settings.set(control.path, JSON.stringify(select.value)));
  settings.follow(control.path, (toml) => { select.value = parse(toml); });
  return [select];
}

/** A text, and lists as TOML. */
function textWidget(settings, control, names) {
  const isText = control.kind === 'text';
  const box = el('input', {type: 'text', spellcheck: false, autocomplete: 'off', ...names});
  const guard = guarded((toml) => {
    if (document.activeElement !== box) box.value = isText ? parse(toml) : toml;
  });
  box.addEventListener('change', () => {
    guard.touch();
    settings.set(control.path, isText ? JSON.stringify(box.value) : box.value);
  });
  box.addEventListener('keydown', (event) => { if (event.key === 'Escape') box.blur(), settings.show([control.path]); });
  settings.follow(control.path, (toml, isForced) => {
    if (isForced) box.value = isText ? parse(toml) : toml;
    else guard.show(toml);
  });
  return [box];
}

const kWidgets = {
  toggle: toggleWidget, whole: numberWidget, number: numberWidget, choice: choiceWidget,
  text: textWidget, numbers: textWidget, texts: textWidget,
};

/** A value for people. */
function shown(control, toml) {
  const value = parse(toml);
  if (control.kind === 'toggle') return value ? 'on' : 'off';
  if (value === '' || (Array.isArray(value) && value.length === 0)) return 'empty';
  return Array.isArray(value) ? toml : String(value);
}

function rangeText(control) {
  const parts = [];
  const unit = control.unit ? ` ${control.unit}` : '';
  if (control.min !== null && control.max !== null) parts.push(`${control.min} to ${control.max}${unit}`);
  else if (control.min !== null) parts.push(`from ${control.min}${unit}`);
  parts.push(`default ${shown(control, control.initial)}`);
  if (control.filed !== control.initial) parts.push(`in the rig file ${shown(control, control.filed)}`);
  return parts.join(' · ');
}

/** The button that binds a setting to a knob; empty of what no knob can turn. It says what turns the setting. */
function knobOf(settings, control) {
  if (!settings.mayLearn || ['text', 'texts', 'numbers'].includes(control.kind)) return null;
  const button = el('button', {className: 'knob', 'aria-label': `Learn a MIDI knob for ${control.path}`}, 'MIDI');
  button.addEventListener('click', () => post(`/api/midi/${button.getAttribute('aria-pressed') === 'true' ? 'stop' : 'learn'}`, {path: control.path}));
  settings.knobs.set(control.path, [...(settings.knobs.get(control.path) ?? []), button]);
  return button;
}

let rows = 0;
/** The row of a setting: name, sentence, range, widget, reset. */
export function settingRow(settings, control, name) {
  const id = `setting-${++rows}`;
  const names = {'aria-labelledby': `${id}-name`, 'aria-describedby': `${id}-about`};
  const widget = el('div', {className: 'widget'}, ...kWidgets[control.kind](settings, control, names));
  if (!settings.mayChange) for (const part of widget.children) part.disabled = true;
  const reset = el('button', {className: 'reset', title: 'Back to the value of the rig file', 'aria-label': `Reset ${control.path}`}, '↺');
  reset.disabled = !settings.mayChange;
  reset.addEventListener('click', () => settings.reset(control.path));
  const row = el('div', {className: 'setting', role: 'group', 'aria-labelledby': `${id}-name`},
    el('div', {className: 'about'},
      el('div', {className: 'name', id: `${id}-name`, title: control.path}, name),
      el('div', {id: `${id}-about`},
        el('div', {className: 'sentence'}, control.sentence),
        el('div', {className: 'range'}, rangeText(control)))),
    widget, reset, knobOf(settings, control));
  settings.follow(control.path, () => row.classList.toggle('changed', settings.isChanged(control.path)));
  return row;
}

/** The section "cascade.predict" of "cascade.predict.method". */
const sectionOf = (path) => path.slice(0, path.lastIndexOf('.'));

/** Fills the list of settings, and lets it be searched. */
export function showSettings(settings) {
  const groups = new Map();
  const shown = [];
  for (const control of settings.controls) {
    const section = sectionOf(control.path) || 'rig';
    if (!groups.has(section)) {
      const count = el('span', {className: 'dim'});
      const group = el('details', {className: 'group', open: true}, el('summary', {}, section, count));
      groups.set(section, {group, count});
      $('groups').append(group);
    }
    const row = settingRow(settings, control, control.path.slice(control.path.lastIndexOf('.') + 1));
    groups.get(section).group.append(row);
    shown.push({control, section, row, text: `${control.path} ${control.sentence}`.toLowerCase()});
  }
  const filter = () => {
    const words = $('search').value.toLowerCase().split(/\s+/).filter(Boolean);
    const onlyChanged = $('only-changed').checked;
    const counts = new Map();
    let all = 0;
    for (const {control, section, row, text} of shown) {
      const isShown = words.every((word) => text.includes(word)) && (!onlyChanged || settings.isChanged(control.path));
      row.hidden = !isShown;
      if (isShown) counts.set(section, (counts.get(section) ?? 0) + 1), ++all;
    }
    for (const [section, {group, count}] of groups) {
      group.hidden = !counts.has(section);
      setText(count, String(counts.get(section) ?? 0));
      if (words.length > 0) group.open = true;
    }
    setText($('settings-count'), `${all} of ${shown.length}`);
  };
  $('search').addEventListener('input', filter);
  $('only-changed').addEventListener('change', filter);
  filter();
  return filter;
}

/** Blackout, freeze and master, which are always in sight. */
export function showLight(settings) {
  for (const name of ['blackout', 'freeze']) {
    const path = `light.${name}`;
    const button = $(name);
    button.disabled = !settings.mayChange || !settings.byPath.has(path);
    button.addEventListener('click', () => settings.set(path, String(settings.toml.get(path) !== 'true')));
    settings.follow(path, (toml) => button.setAttribute('aria-pressed', toml));
  }
  const fader = $('master');
  fader.disabled = !settings.mayChange || !settings.byPath.has('light.master');
  const show = (value) => setText($('master-text'), `${Math.round(value * 100)} %`);
  const guard = guarded((toml) => { fader.value = 100 * parse(toml); show(parse(toml)); });
  fader.addEventListener('input', () => {
    guard.touch();
    show(fader.value / 100);
    settings.set('light.master', String(fader.value / 100));
  });
  settings.follow('light.master', guard.show);
  for (const path of ['light.blackout', 'light.master']) settings.follow(path, () => dimPictures(settings));
}

/** Shows the projectors' pictures as they leave: frames in the rings have neither blackout nor master. */
function dimPictures(settings) {
  const isOff = settings.toml.get('light.blackout') === 'true';
  const light = isOff ? 0 : parse(settings.toml.get('light.master') ?? '1');
  for (const name of ['light', 'light2']) $(name).style.filter = light < 1 ? `brightness(${light ** (1 / 2.2)})` : '';
  setText($('light-caption'), light > 0 ? 'Light' : `Light: off (${isOff ? 'blackout' : 'master'})`);
}

/** Two states to compare: what is turned belongs to the one that is shown. */
export function showCompare(settings) {
  const states = {A: null, B: null};
  let now = 'A';
  const label = () => {
    const other = now === 'A' ? 'B' : 'A';
    $('ab').replaceChildren(...(now === 'A' ? ['A', el('span', {'aria-hidden': 'true'}, ' / b')] : [el('span', {'aria-hidden': 'true'}, 'a / '), 'B']));
    $('ab').setAttribute('aria-label', `Compare: state ${now} is shown; switch to ${other}`);
  };
  $('ab').addEventListener('click', () => {
    const left = states[now] = settings.current();
    now = now === 'A' ? 'B' : 'A';
    label();
    const wanted = states[now];
    if (!wanted) return say(`State ${now} begins as a copy; change it, and switch to compare.`);
    const different = [...wanted].filter(([path, toml]) => String(parse(left.get(path))) !== String(parse(toml)));
    // In the order in which a person turns them: what is turned next belongs to the state that is shown now.
    for (const [path, toml] of different) settings.set(path, toml);
    say(different.length === 0 ? `State ${now}, which is the same` : `State ${now}: ${different.length} settings differ`);
  });
  $('ab').disabled = !settings.mayChange;
}
