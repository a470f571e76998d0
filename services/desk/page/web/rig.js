// SPDX-License-Identifier: Apache-2.0
// Services, looks, cues and hands.

import {$, el, figure, post, say, setText} from '/dom.js';
import {drawHistogram} from '/chart.js';
import {settingRow} from '/controls.js';

function dotOf(service) {
  if (service.state === 'ready') return 'dot on';
  return service.state === 'stopped' || service.state === 'starting' ? 'dot' : 'dot bad';
}

function duration(seconds) {
  if (seconds < 90) return `${Math.round(seconds)} s`;
  if (seconds < 5400) return `${Math.round(seconds / 60)} min`;
  return `${(seconds / 3600).toFixed(1)} h`;
}

/** The table of services. Rows are made once, so that the focus stays where it is. */
export class Services {
  constructor(backends, isOwner) {
    this.backends = backends;
    this.isOwner = isOwner;
    this.rows = new Map();
  }

  row(name) {
    if (this.rows.has(name)) return this.rows.get(name);
    const row = {
      dot: el('span', {className: 'dot', 'aria-hidden': 'true'}), name: el('span', {className: 'name'}, name), rate: el('span', {className: 'rate dim'}),
      state: el('span', {className: 'dim'}), why: el('span', {className: 'why', hidden: true}), log: el('pre', {hidden: true}),
      restart: el('button', {className: 'restart', 'aria-label': `Restart ${name}`}, 'Restart'), backend: this.backendOf(name),
    };
    row.restart.disabled = !this.isOwner || name === 'desk';
    row.restart.addEventListener('click', () => this.change(row, '/api/service/restart', {service: name}, `${name} is ready again`));
    row.backend.addEventListener('change', () =>
      this.change(row, '/api/service/swap', {service: name, backend: row.backend.value}, `${name} is ready with ${row.backend.value}`));
    const label = el('span', {}, row.name, ' ', row.state);
    row.all = el('div', {className: row.backend.classList.contains('none') ? 'service plain' : 'service'}, row.dot, label, row.backend, row.rate, row.restart, row.why, row.log);
    $('service-list').append(row.all);
    this.rows.set(name, row);
    return row;
  }

  backendOf(name) {
    const known = this.backends[name] ?? [];
    const select = el('select', {className: 'backend', 'aria-label': `Back end of ${name}`},
      ...known.map((backend) => el('option', {value: backend.name, title: backend.sentence}, backend.name)));
    select.disabled = !this.isOwner || known.length < 2;
    select.classList.toggle('none', known.length === 0);
    return select;
  }

  async change(row, path, body, done) {
    row.isBusy = row.restart.disabled = row.backend.disabled = true;
    row.restart.textContent = 'Wait …';
    if (await post(path, body)) say(done);
    row.restart.textContent = 'Restart';
    row.isBusy = row.restart.disabled = false;
    row.backend.disabled = row.backend.options.length < 2;
  }

  take(status) {
    if (status.fault) return setText($('uptime'), status.fault);
    setText($('uptime'), `up ${duration(status.uptime_s ?? 0)}`);
    const services = status.services ?? {};
    for (const [name, service] of Object.entries(services)) this.show(this.row(name), name, service, status);
    for (const [name, row] of this.rows)
      if (!(name in services)) row.all.remove(), this.rows.delete(name);
    showStages(status.stage_us ?? {});
    showFacts(status);
  }

  show(row, name, service, status) {
    row.dot.className = dotOf(service);
    setText(row.state, service.state === 'ready' ? (service.restarts ? `restarted ${service.restarts}×` : '') : service.state);
    if (service.backend && !row.isBusy && document.activeElement !== row.backend) row.backend.value = service.backend;
    const ring = Object.entries(status.rings ?? {}).find(([stream]) => stream.startsWith(`${name}.`) || (name === 'projector' && stream.startsWith('projection.')));
    setText(row.rate, ring ? `${figure(ring[1].held_hz, 0)}${ring[1].wanted_hz ? ` / ${figure(ring[1].wanted_hz, 0)}` : ''} Hz` : '');
    const why = [service.instead_of ? `instead of ${service.instead_of}` : '', service.reason ?? ''].filter(Boolean).join(': ');
    row.why.hidden = why === '';
    setText(row.why, why);
    const log = (service.log ?? []).join('\n');
    row.log.hidden = log === '';
    setText(row.log, log);
  }
}

function showStages(stages) {
  const all = Object.entries(stages).filter(([, times]) => (times.count ?? 1) > 0);
  const most = Math.max(1, ...all.map(([, times]) => times.p99));
  const rows = all.map(([name, times]) => {
    const wide = el('b', {className: 'wide'}), narrow = el('b');
    wide.style.width = `${100 * times.p99 / most}%`;
    narrow.style.width = `${100 * times.p50 / most}%`;
    return el('tr', {}, el('td', {}, name), el('td', {className: 'meter', 'aria-hidden': 'true'}, el('i', {}, wide, narrow)),
      el('td', {}, figure(times.p50 / 1000, 2)), el('td', {}, figure(times.p99 / 1000, 2)));
  });
  $('stages').replaceChildren(rows.length === 0 ? el('p', {className: 'dim'}, 'No frames yet.')
    : el('table', {}, el('tr', {}, el('th', {scope: 'col'}, 'stage'), el('th', {}, ''), el('th', {scope: 'col'}, 'p50 ms'), el('th', {scope: 'col'}, 'p99 ms')), ...rows));
}

const kRungsOver = 20;   // tellings of the status, two a second
const rungCounts = [];
/** The shares of the corrections that the gate has chosen lately, the most frequent first. */
function rungShares(counts) {
  rungCounts.push(counts);
  if (rungCounts.length > kRungsOver) rungCounts.shift();
  const grown = Object.entries(counts).map(([rung, count]) => [rung, count - (rungCounts[0][rung] ?? 0)]).filter(([, count]) => count > 0);
  const all = grown.reduce((sum, [, count]) => sum + count, 0);
  return grown.sort((a, b) => b[1] - a[1]).map(([rung, count]) => `${rung} ${Math.round(100 * count / all)} %`).join(', ');
}

function showFacts(status) {
  const facts = [];
  const sum = (counts) => Object.values(counts ?? {}).reduce((all, count) => all + count, 0);
  const lights = Object.entries(status.light ?? {});
  for (const [projector, light] of lights)
    facts.push([`missed refreshes${lights.length > 1 ? ` of ${projector}` : ''}`, String(light.missed_refreshes ?? 0)]);
  if (status.lost_images) facts.push(['lost images', String(sum(status.lost_images))]);
  if (status.tracker_faults) facts.push(['faults of the tracker', String(sum(status.tracker_faults))]);
  const rungs = rungShares(status.rungs ?? {});
  if (rungs) facts.push(['corrections that the gate chose', rungs]);
  const drift = status.tracker_drift;
  if (drift) facts.push(['tracker against calibration', `${figure(drift.across_mm)} mm, ${figure(drift.turn_deg)}°${drift.moved ? ': moved' : ''}`]);
  $('facts').replaceChildren(...facts.map(([name, value]) => el('div', {}, el('strong', {}, value), name)));
}

export function showAges(ages) {
  drawHistogram($('ages'), ages.bins, [['p50', ages.p50], ['p99', ages.p99]]);
  setText($('ages-text'), ages.p50 === null ? 'no light yet' : `p50 ${figure(ages.p50)} ms, p99 ${figure(ages.p99)} ms, over 10 s`);
}

/** What is on the hands, and the looks. */
export class Looks {
  constructor(looks, settings) {
    this.buttons = looks.map(({name, picture}) => {
      const image = picture ? el('img', {src: `/api/look/${name}`, alt: '', width: 96, height: 60, loading: 'lazy', decoding: 'async'}) : null;
      const button = el('button', {title: name}, image, el('span', {}, name));
      button.disabled = !settings.mayChange;
      button.addEventListener('click', () => this.show(name));
      return button;
    });
    $('look-list').replaceChildren(...this.buttons);
    $('what').addEventListener('submit', (event) => {
      event.preventDefault();
      if ($('content').value.trim() !== '') this.show($('content').value.trim());
    });
    for (const part of $('what').elements) part.disabled = !settings.mayChange;
    for (const path of ['content.transition', 'content.transition_s'])
      if (settings.byPath.has(path)) $('transition').append(settingRow(settings, settings.byPath.get(path), path.slice(8)));
    this.take([{content: ''}, {content: ''}]);
  }

  async show(content) {
    const hand = document.querySelector('input[name=hand]:checked').value;
    if (await post('/api/show', {hand, content})) say(hand === 'both' ? `${content} on both hands` : `${content} on the ${hand} hand`);
  }

  take(hands) {
    $('on-hands').replaceChildren(...['Left hand', 'Right hand'].map((name, i) =>
      el('div', {}, el('span', {className: 'dim'}, name), el('strong', {}, hands[i].content || '–'),
        hands[i].fault ? el('span', {className: 'fault'}, hands[i].fault) : null)));
    for (const button of this.buttons)
      button.setAttribute('aria-current', String(hands.some((hand) => hand.content === button.title)));
  }
}

/** The cue list. */
export class Cues {
  constructor(mayChange) {
    this.mayChange = mayChange;
    this.names = null;
    this.about = [];
    this.buttons = [];
    for (const what of ['go', 'back', 'hold']) {
      $(`cue-${what}`).addEventListener('click', () => post('/api/cue', {do: what}));
      $(`cue-${what}`).disabled = true;
    }
  }

  take(cues) {
    this.newest = cues;
    const names = cues?.names ?? [];
    const current = cues?.current ?? -1, next = cues?.next ?? 0;
    for (const what of ['go', 'back', 'hold']) $(`cue-${what}`).disabled = !this.mayChange || names.length === 0;
    $('cue-go').disabled ||= next >= names.length;
    $('cue-back').disabled ||= current < 1;
    setText($('cue-go'), next < names.length ? `Go: ${names[next]}` : 'Go');
    $('no-cues').hidden = cues !== null;
    setText($('cue-text'), cues === null ? 'no list' : current < 0 ? `${names.length} cues` : `${current + 1} of ${names.length}`);
    $('cue-hold').setAttribute('aria-pressed', String(cues?.held ?? false));
    if (JSON.stringify(names) !== this.names) this.list(names);
    this.buttons.forEach((button, i) => {
      button.setAttribute('aria-current', String(i === current));
      button.classList.toggle('next', i === next);
      button.style.setProperty('--faded', i === current && cues.faded < 1 ? `${100 * cues.faded}%` : '0%');
    });
  }

  hasKey(key) { return this.mayChange && this.about.some(({on}) => on.split(', ').includes(`key ${key}`)); }

  /** What starts the cues, and what they do. */
  takeList(about) {
    this.about = about;
    this.names = null;
    if (this.newest !== undefined) this.take(this.newest);
  }

  list(names) {
    this.names = JSON.stringify(names);
    this.buttons = names.map((name, index) => {
      const {on = '', does = ''} = this.about[index] ?? {};
      const button = el('button', {}, el('i', {}, String(index + 1)),
        el('span', {className: 'cue'}, el('span', {className: 'name'}, name), on ? el('span', {className: 'on'}, on) : null,
          does ? el('span', {className: 'does'}, does) : null), el('span', {className: 'mark'}));
      button.disabled = !this.mayChange;
      button.addEventListener('click', () => post('/api/cue', {do: 'jump', cue: String(index + 1)}));
      return button;
    });
    $('cue-list').replaceChildren(...this.buttons.map((button) => el('li', {}, button)));
  }
}

const kGestures = [['pinch', (hand) => hand.pinch], ['spread', (hand) => hand.spread], ['fist', (hand) => hand.fist],
  ['palm up', (hand) => (hand.palm_up + 1) / 2], ['speed', (hand) => hand.speed / 2]];

/** What the hands do, as meters that are made once. */
export class Hands {
  constructor() {
    this.hands = ['Left', 'Right'].map((name) => {
      const title = el('span', {className: 'dim'});
      const bars = kGestures.map(() => el('b'));
      const all = el('div', {className: 'hand away'}, el('h3', {}, name, ' ', title),
        ...kGestures.flatMap(([word], i) => [el('span', {}, word), el('span', {className: 'meter', 'aria-hidden': 'true'}, el('i', {}, bars[i]))]));
      $('hands').append(all);
      return {title, bars, all};
    });
  }

  take(hands) {
    hands.forEach((hand, i) => {
      const shown = this.hands[i];
      shown.all.classList.toggle('away', !hand.there);
      setText(shown.title, hand.there ? [hand.pointing ? 'points' : '', hand.touching ? 'touches' : ''].filter(Boolean).join(', ') : 'not there');
      kGestures.forEach(([, value], k) => {
        shown.bars[k].style.width = hand.there ? `${Math.round(100 * Math.min(1, Math.max(0, value(hand))))}%` : '0';
      });
    });
  }
}
