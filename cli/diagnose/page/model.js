'use strict';
// What the page knows. Everything that is shown goes through textContent: names in a log come from strangers.
const byId = (id) => document.getElementById(id);
const failures = [];
window.addEventListener('error', (event) => {
  failures.push(event.message);
  document.body.dataset.errors = failures.length;
  byId('errors').hidden = false;
  byId('errors').textContent = 'This page failed: ' + failures.join('; ');
});
const D = JSON.parse(byId('data').textContent);
const actors = D.actors.map(([name, kind]) => ({ name, kind }));
const events = D.events.map((e, index) => ({ index, kind: e[0], actor: e[1], object: e[2], value: e[3], frame: e[4],
  begin: e[5], end: e[6], signal: e[7], sequence: e[8], never: (e[9] & 1) !== 0, timedOut: (e[9] & 2) !== 0,
  idleBefore: (e[9] & 4) !== 0, findings: [] }));
const frames = D.frames.map((f) => ({ number: f[0], begin: f[1], end: f[2], stalled: f[3], achieved: f[4],
  possible: f[5], path: f[6].map(([actor, begin, end, entered, waited]) => ({ actor, begin, end, entered, waited: waited === 1 })), stalls: f[7],
  handOff: f[8], events: [], worst: '' }));
if (frames.length === 0) {  // a log without frames is one
  const begin = Math.min(...events.slice(0, 20000).map((e) => e.begin), 0);
  const end = events.reduce((most, e) => Math.max(most, e.end), 1);
  frames.push({ number: 0, begin, end, stalled: 0, achieved: 0, possible: 0, path: [], stalls: [],
    handOff: [0, 0, 0, 0, 0], events: [], worst: '' });
}
const frameAt = new Map(frames.map((frame, place) => [frame.number, place]));
const outside = [];  // events of no frame
for (const event of events) {
  const place = frameAt.get(event.frame);
  (place === undefined ? outside : frames[place].events).push(event);
}
const rank = { info: 1, warning: 2, error: 3 };
D.findings.forEach((finding, index) => {
  finding.index = index;
  const place = frameAt.get(finding.frame);
  if (place !== undefined && (rank[frames[place].worst] || 0) < rank[finding.severity]) {
    frames[place].worst = finding.severity;
  }
  if (finding.second >= 0) events[finding.second].findings.push(finding);
});

const view = { place: 0, count: 2, begin: 0, end: 1, lit: -1 };
function shownFrames() { return frames.slice(view.place, view.place + view.count); }
function windowOf() {
  const shown = shownFrames();
  const begin = Math.min(...shown.map((f) => f.begin)), end = Math.max(...shown.map((f) => f.end));
  const margin = Math.max((end - begin) * 0.03, 1);
  return { begin: begin - margin, end: end + margin };
}

function time(ns) {
  const size = Math.abs(ns);
  if (size < 1e3) return Math.round(ns) + ' ns';
  if (size < 1e6) return (ns / 1e3).toFixed(1) + ' \u00b5s';
  if (size < 1e9) return (ns / 1e6).toFixed(2) + ' ms';
  return (ns / 1e9).toFixed(2) + ' s';
}
const count = (n, one, several) => n.toLocaleString('en') + ' ' + (n === 1 ? one : several);

function element(name, attributes = {}, text) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (text !== undefined) made.textContent = text;
  return made;
}
function shape(name, attributes = {}, text) {
  const made = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (text !== undefined) made.textContent = text;
  return made;
}
