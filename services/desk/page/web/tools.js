// SPDX-License-Identifier: Apache-2.0
// Recordings, the MIDI controller, the calibration and the doctor.

import {$, el, figure, post, say, setText} from '/dom.js';

const kCommands = ['cue.go', 'cue.back', 'cue.hold', 'undo', 'redo'];

function length(seconds) {
  const minutes = Math.floor(seconds / 60);
  return minutes === 0 ? `${figure(seconds, 1)} s` : `${minutes}:${String(Math.floor(seconds % 60)).padStart(2, '0')} min`;
}

function size(bytes) {
  return bytes >= 1e9 ? `${figure(bytes / 1e9, 1)} GB` : `${figure(bytes / 1e6, bytes < 1e7 ? 1 : 0)} MB`;
}

export class Tools {
  constructor(settings, isOwner) {
    this.settings = settings;
    this.isOwner = isOwner;
    this.bindings = '';
    $('record').addEventListener('submit', async (event) => {
      event.preventDefault();
      if (await post('/api/record/start', {name: $('recording-name').value.trim()})) $('recording-name').value = '';
    });
    $('record-stop').addEventListener('click', () => post('/api/record/stop'));
    $('doctor-start').addEventListener('click', () => post('/api/doctor'));
    for (const id of ['recording-name', 'record-start', 'doctor-start', 'midi-learn', 'midi-command', 'midi-bind']) $(id).disabled = !isOwner;
    $('midi-command').append(...kCommands.map((name) => el('option', {value: name}, name)));
    $('midi-bind').addEventListener('click', () => post('/api/midi/learn', {path: $('midi-command').value}));
    $('midi-learn').addEventListener('click', () => {
      const isOn = document.body.classList.toggle('learning');
      $('midi-learn').setAttribute('aria-pressed', String(isOn));
      if (isOn) say('Press MIDI beside a setting, and move a knob.');
      else if (this.learning) post('/api/midi/stop');
    });
  }

  takeRecordings({folder, running, fault, all}) {
    setText($('recording-text'), running ? `recording ${running.name}, ${length(running.seconds)}` : fault);
    $('recording-text').classList.toggle('fault', !running && fault !== '');
    $('record-start').disabled = $('recording-name').disabled = !this.isOwner || running !== null || folder === '';
    $('record-stop').disabled = !this.isOwner || running === null;
    const shown = all.filter((each) => each.name !== running?.name);
    const rows = shown.map((each) => el('div', {}, el('span', {className: 'name', title: `${folder}/${each.name}`}, each.name),
      el('span', {className: 'dim'}, length(each.seconds)), el('span', {className: 'dim'}, size(each.bytes))));
    if (rows.length === 0) rows.push(el('p', {className: 'dim'}, folder ? `None yet in ${folder}` : 'No folder is set: see desk.page.recordings.'));
    this.show($('recording-list'), JSON.stringify([folder, shown]), rows);
  }

  /** Replaces rows only if they differ: what has the focus keeps it. */
  show(list, text, rows) {
    if (list.dataset.shown === text) return;
    list.dataset.shown = text;
    list.replaceChildren(...rows);
  }

  takeMidi(midi) {
    $('midi').hidden = midi === null;
    if (midi === null) return document.body.classList.remove('learning');
    this.learning = midi.learning;
    setText($('midi-text'), midi.learning ? `move a knob, or press a key, for ${midi.learning}` : midi.device || 'the controller is not there');
    const rows = midi.bindings.map(({path, source}) => {
      const forget = el('button', {className: 'reset', title: `Unbind ${path}`, 'aria-label': `Unbind ${path}`}, '✕');
      forget.disabled = !this.isOwner;
      forget.addEventListener('click', () => post('/api/midi/forget', {path}));
      return el('div', {}, el('span', {className: 'name'}, path), el('span', {className: 'dim'}, source), forget);
    });
    if (rows.length === 0) rows.push(el('p', {className: 'dim'}, 'No knob or key is bound.'));
    this.show($('midi-list'), JSON.stringify(midi.bindings), rows);
    const sources = new Map(midi.bindings.map(({path, source}) => [path, source]));
    for (const [path, buttons] of this.settings.knobs)
      for (const button of buttons) {
        button.setAttribute('aria-pressed', String(path === midi.learning));
        setText(button, path === midi.learning ? 'move a knob …' : sources.get(path) ?? 'MIDI');
        button.classList.toggle('bound', sources.has(path));
      }
  }

  takeCalibration({file, age_days: days, steps}) {
    const age = days === null ? '' : days === 0 ? ', written today' : days === 1 ? ', written yesterday' : `, written ${days} days ago`;
    setText($('calibration-text'), file ? `${file.slice(file.lastIndexOf('/') + 1)}${age}` : 'that of the reference rig');
    $('calibration-list').replaceChildren(...steps.map(({step, what, made, command}) =>
      el('li', {}, el('span', {className: made ? 'dot on' : 'dot', 'aria-hidden': 'true'}), el('strong', {}, what), el('span', {className: 'name'}, step),
        el('span', {className: 'made'}, made || 'It is not known when this was measured.'), el('code', {}, command))));
  }

  takeDoctor({running, findings, fault}) {
    $('doctor-start').disabled = !this.isOwner || running;
    const count = (grade) => (findings ?? []).filter((finding) => finding.grade === grade).length;
    const faults = count('fault') === 1 ? '1 fault' : `${count('fault')} faults`;
    setText($('doctor-text'), running ? 'at work …' : findings ? `${faults}, ${count('advice')} advice, ${count('good')} good` : fault);
    $('doctor-text').classList.toggle('fault', !running && (fault !== '' || count('fault') > 0));
    const order = ['fault', 'advice', 'good'];
    const sorted = [...(findings ?? [])].sort((a, b) => order.indexOf(a.grade) - order.indexOf(b.grade));
    this.show($('doctor-list'), JSON.stringify(sorted), sorted.map(({check, grade, sentence, remedy}) =>
      el('li', {className: grade}, el('span', {className: 'grade'}, grade), el('strong', {}, check), el('span', {}, sentence),
        remedy ? el('span', {className: 'dim'}, `→ ${remedy}`) : null)));
  }
}
