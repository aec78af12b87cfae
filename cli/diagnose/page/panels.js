// Everything around the drawing, and what the hand does.
const kFirstFindings = 30;

function table(heads, rows, numbers) {
  const made = element('table'), head = element('tr');
  heads.forEach((text, i) => head.append(element('th', numbers.includes(i) ? { class: 'number' } : {}, text)));
  made.append(head);
  for (const row of rows) {
    const line = element('tr');
    row.forEach((text, i) => line.append(element('td', numbers.includes(i) ? { class: 'number' } : {}, text)));
    made.append(line);
  }
  return made;
}
function stallTable(stalls) {
  if (stalls.length === 0) return element('p', { class: 'none' }, 'Nobody stood still.');
  return table(['stood still', 'for', 'signalled by', 'waits', 'total', 'longest'],
    stalls.map(([who, sync, by, n, total, longest]) => [who, sync, by || 'nobody', n, time(total), time(longest)]),
    [3, 4, 5]);
}
function overlapText([achieved, possible]) {
  return possible === 0 ? 'nothing could have run side by side'
    : `${time(achieved)} of ${time(possible)} possible (${Math.round(100 * achieved / possible)} %)`;
}
function spread([n, min, median, p99, max]) {
  return n === 0 ? ['none', '', '', '', ''] : [n, time(min), time(median), time(p99), time(max)];
}

function drawHeader() {
  document.title = D.log + ': ' + D.verdict;
  byId('verdict').textContent = D.verdict;
  byId('verdict').className = D.clean ? 'clean' : 'found';
  const part = frames.length < D.totalFrames
    ? `; this page has frames ${frames[0].number} to ${frames[frames.length - 1].number} (sluice diagnose --frames)` : '';
  byId('subject').textContent = `${D.log}: ${count(D.totalEvents, 'event', 'events')} of ` +
    `${count(actors.length, 'actor', 'actors')} in ${count(D.totalFrames, 'frame', 'frames')}${part}` +
    (D.closed ? '' : '; the log was cut off, not closed') +
    (D.dropped > 0 ? `; ${count(D.dropped, 'further finding', 'further findings')} not kept` : '') +
    (D.unheard.length > 0 ? `; not judged: ${D.unheard.join('; ')}` : '');
}

// Few frames do not fill the strip.
const overviewWidth = (width) => Math.min(width, frames.length * 60);

function drawOverview() {
  const svg = byId('overview'), width = Math.max(svg.clientWidth, 300), height = 46;
  const bins = Math.min(frames.length, Math.floor(width / 3)), perBin = frames.length / bins;
  const longest = frames.reduce((most, f) => Math.max(most, f.end - f.begin), 1);
  svg.setAttribute('viewBox', `0 0 ${width} ${height}`);
  svg.replaceChildren();
  for (let bin = 0; bin < bins; ++bin) {
    const members = frames.slice(Math.floor(bin * perBin), Math.max(Math.floor((bin + 1) * perBin), Math.floor(bin * perBin) + 1));
    const span = Math.max(...members.map((f) => f.end - f.begin));
    const worst = members.map((f) => f.worst).sort((a, b) => (rank[b] || 0) - (rank[a] || 0))[0];
    const tall = Math.max(span / longest * (height - 6), 3), wide = overviewWidth(width) / bins;
    const bar = shape('rect', { class: 'bar ' + worst, x: bin * wide, y: height - tall, width: Math.max(wide - 1, 1), height: tall });
    bar.append(shape('title', {}, `frame ${members[0].number}: ${time(span)}`));
    svg.append(bar);
  }
  svg.append(shape('rect', { class: 'here', x: view.place / frames.length * overviewWidth(width), y: 1, height: height - 2,
    width: Math.max(Math.min(view.count, frames.length) / frames.length * overviewWidth(width) - 1, 4) }));
}

function drawFindings() {
  const list = byId('list'), groups = new Map();
  for (const finding of D.findings) {
    if (!groups.has(finding.id)) groups.set(finding.id, []);
    groups.get(finding.id).push(finding);
  }
  if (groups.size === 0) list.append(element('p', { class: 'none' }, 'Nothing was found.'));
  for (const [id, members] of groups) {
    const group = element('div', { class: 'group' }), total = members.reduce((sum, f) => sum + f.count, 0);
    const head = element('h3');
    head.append(element('span', { class: 'severity ' + members[0].severity }, members[0].severity),
      element('span', { class: 'id' }, id), ` \u2013 ${members[0].title}, ${total.toLocaleString('en')} \u00d7`);
    group.append(head);
    const put = (from, to) => members.slice(from, to).forEach((finding) => group.append(findingButton(finding)));
    put(0, kFirstFindings);
    if (members.length > kFirstFindings) {
      const more = element('button', {}, `show ${count(members.length - kFirstFindings, 'more', 'more')}`);
      more.addEventListener('click', () => { more.remove(); put(kFirstFindings); });
      group.append(more);
    }
    list.append(group);
  }
}
function findingButton(finding) {
  const made = element('div', { class: 'finding ' + finding.severity, 'data-finding': finding.index, tabindex: 0, role: 'button' });
  made.append(element('b', {}, finding.frame ? `frame ${finding.frame} ` : ''), finding.sentence);
  const more = element('div', { class: 'more' });
  if (finding.edge) more.append(element('div', {}, 'edge: ' + finding.edge));
  more.append(element('div', {}, 'remedy: ' + finding.remedy));
  if (finding.cost) more.append(element('div', {}, 'cost: ' + time(finding.cost)));
  if (finding.chain.length) more.append(element('div', { class: 'chain' }, finding.chain.join('\n')));
  made.append(more);
  return made;
}

function drawReports() {
  const frame = frames[view.place], box = byId('framereport');
  byId('frametitle').textContent = frame.number ? `Frame ${frame.number}` : 'Whole log';
  box.replaceChildren(
    element('p', {}, `${time(frame.end - frame.begin)} long; stood still ${time(frame.stalled)}; overlap ${overlapText([frame.achieved, frame.possible])}`),
    element('h3', {}, 'Critical path'),
    table(['at', 'for', 'actor', 'entered by'], frame.path.map((part) => [time(part.begin - frame.begin),
      time(part.end - part.begin), actors[part.actor].name, enteredBy(part)]), [0, 1]),
    element('h3', {}, 'Stalls'), stallTable(frame.stalls));
  if (byId('logreport').childElementCount > 0) return;
  byId('logreport').append(
    table(['', 'count', 'min', 'median', 'p99', 'max'], [['frame', ...spread(D.frameSpan)],
      ['hand-off latency', ...spread(D.handOff)], ['wake-up latency', ...spread(D.wakeUp)]], [1, 2, 3, 4, 5]),
    element('p', {}, 'Overlap: ' + overlapText(D.overlap)), stallTable(D.stalls));
}
function enteredBy(part) {
  if (part.entered < 0) return 'its own work';
  const event = events[part.entered];
  return part.waited ? `wait for ${event.object} \u2265 ${event.value}` : 'its submission';
}

function drawLegend() {
  const kinds = [['signal', 'signal'], ['wait', 'wait (at its end)'], ['write', 'write'], ['read', 'read'],
    ['submit', 'submit'], ['layout', 'other']];
  for (const [kind, text] of kinds) {
    const svg = shape('svg', { viewBox: '0 0 22 14' }), item = element('span');
    svg.append(glyph(kind, 11, 7));
    item.append(svg, text);
    byId('legend').append(item);
  }
  const bars = [['busy', 'busy'], ['stall', 'stands still'], ['critical', 'critical path']];
  for (const [cls, text] of bars) {
    const svg = shape('svg', { viewBox: '0 0 22 14' }), item = element('span');
    svg.append(shape('rect', { class: cls, x: 1, y: cls === 'critical' ? 5 : 2, width: 20, height: cls === 'critical' ? 5 : 10 }));
    item.append(svg, text);
    byId('legend').append(item);
  }
  byId('legend').append(element('span', {}, 'arrow: a signal and the wait it satisfied (orange: it was waited for); ' +
    'dashed red: the order that is missing; ring: a finding'));
}

function describe(event) {
  const lines = [`${event.kind} ${event.object}${event.value ? ' ' + event.value : ''}`,
    `${actors[event.actor].name}, frame ${event.frame || 'none'}, event ${event.sequence}`];
  const frame = frames[frameAt.get(event.frame) ?? view.place];
  lines.push(`at ${time(event.begin - frame.begin)}` + (event.end > event.begin ? ` for ${time(event.end - event.begin)}` : ''));
  if (event.kind === 'wait') {
    if (event.never) lines.push('nobody signals it');
    else if (event.timedOut) lines.push('timed out');
    else if (event.signal >= 0) {
      const signal = events[event.signal];
      lines.push(`signalled by ${actors[signal.actor].name} (event ${signal.sequence}), ${time(Math.max(event.end - signal.end, 0))} before the wait ended`);
    }
  }
  for (const finding of event.findings) lines.push(finding.id + ': ' + finding.sentence);
  return lines.join('\n');
}
function tipFor(target) {
  const at = target.closest('[data-finding],[data-event],[data-path]');
  if (!at || !at.closest('#timeline')) return '';
  if (at.dataset.finding !== undefined) {
    const finding = D.findings[at.dataset.finding];
    return `${finding.id}\n${finding.sentence}\n${finding.remedy}`;
  }
  if (at.dataset.event !== undefined) return describe(events[at.dataset.event]);
  const [number, i] = at.dataset.path.split(':').map(Number), part = frames[frameAt.get(number)].path[i];
  return `critical path of frame ${number}\n${actors[part.actor].name} for ${time(part.end - part.begin)}\nentered by ${enteredBy(part)}`;
}

function show(place, lit = -1) {
  view.place = Math.max(0, Math.min(place, frames.length - 1));
  view.count = Number(byId('count').value);
  view.lit = lit;
  Object.assign(view, windowOf());
  byId('frame').value = frames[view.place].number;
  for (const item of document.querySelectorAll('.finding.lit')) item.classList.remove('lit');
  const item = document.querySelector(`.finding[data-finding="${lit}"]`);
  if (item) item.classList.add('lit');
  drawTimeline();
  drawOverview();
  drawReports();
}
function showFinding(index) {
  const finding = D.findings[index], place = frameAt.get(finding.frame);
  show(place ?? view.place, index);
}
function zoom(factor, centre = (view.begin + view.end) / 2) {
  const whole = windowOf(), least = 50;
  view.begin = Math.max(centre - (centre - view.begin) * factor, whole.begin);
  view.end = Math.min(centre + (view.end - centre) * factor, whole.end);
  if (view.end - view.begin < least) view.end = view.begin + least;
  drawTimeline();
}
function pan(by) {
  const whole = windowOf(), move = Math.max(whole.begin - view.begin, Math.min(by, whole.end - view.end));
  view.begin += move;
  view.end += move;
  drawTimeline();
}
function nextFinding() {
  for (let step = 1; step <= frames.length; ++step) {
    const place = (view.place + step) % frames.length;
    const found = D.findings.find((f) => f.frame === frames[place].number && f.severity !== 'info');
    if (found) return showFinding(found.index);
  }
}

function listen() {
  const stage = byId('timeline'), perPixel = () => (view.end - view.begin) / (stage.clientWidth - kGutter - kRight);
  const actions = { previous: () => show(view.place - 1), next: () => show(view.place + 1), in: () => zoom(0.6),
    out: () => zoom(1 / 0.6), all: () => show(view.place, view.lit), nextfinding: nextFinding };
  for (const [id, action] of Object.entries(actions)) byId(id).addEventListener('click', action);
  byId('count').addEventListener('change', () => show(view.place, view.lit));
  byId('frame').addEventListener('change', () => {
    const wanted = Number(byId('frame').value);
    const place = frames.findIndex((frame) => frame.number >= wanted);
    show(place < 0 ? frames.length - 1 : place);
  });
  byId('overview').addEventListener('click', (event) => {
    const box = byId('overview').getBoundingClientRect();
    show(Math.floor((event.clientX - box.left) / overviewWidth(box.width) * frames.length));
  });
  document.addEventListener('keydown', (event) => {
    if (event.target.matches('input, select')) return;
    if ((event.key === 'Enter' || event.key === ' ') && event.target.dataset.finding) return showFinding(event.target.dataset.finding);
    const keys = { ArrowLeft: actions.previous, ArrowRight: actions.next, '+': actions.in, '-': actions.out, 0: actions.all, n: nextFinding };
    if (keys[event.key]) { event.preventDefault(); keys[event.key](); }
  });
  document.addEventListener('click', (event) => {
    const at = event.target.closest('[data-finding]');
    if (at) showFinding(Number(at.dataset.finding));
  });
  stage.addEventListener('wheel', (event) => {
    if (!event.ctrlKey) return;
    event.preventDefault();
    const left = stage.getBoundingClientRect().left + kGutter;
    zoom(event.deltaY > 0 ? 1.25 : 0.8, view.begin + (event.clientX - left) * perPixel());
  }, { passive: false });
  let dragged = null;
  stage.addEventListener('pointerdown', (event) => { dragged = event.clientX; stage.classList.add('dragging'); });
  window.addEventListener('pointerup', () => { dragged = null; stage.classList.remove('dragging'); });
  window.addEventListener('pointermove', (event) => {
    if (dragged !== null) { pan((dragged - event.clientX) * perPixel()); dragged = event.clientX; }
    const tip = byId('tip'), text = tipFor(event.target);
    tip.hidden = text === '';
    tip.textContent = text;
    tip.style.left = Math.min(event.clientX + 14, window.innerWidth - 430) + 'px';
    tip.style.top = Math.min(event.clientY + 16, window.innerHeight - tip.offsetHeight - 8) + 'px';
  });
  window.addEventListener('resize', () => { drawTimeline(); drawOverview(); });
}

drawHeader();
drawLegend();
drawFindings();
listen();
// Where something was found; "#frame=12" in the address asks for another place.
const asked = /#frame=(\d+)/.exec(location.hash), worst = D.findings.find((f) => f.severity !== 'info' && frameAt.has(f.frame));
if (asked && frameAt.has(Number(asked[1]))) show(frameAt.get(Number(asked[1])));
else if (worst) showFinding(worst.index);
else show(0);
document.body.dataset.errors = failures.length;
document.body.dataset.ready = '1';
