// The drawing: a lane per actor, time to the right.
const kGutter = 150, kLane = 74, kTop = 34, kRight = 60;
const kOrderRow = 26, kAccessRow = 48, kPathRow = 66;  // heights within a lane
const kMostShapes = 6000;

function laneList() {
  const seen = new Set();
  for (const event of shownEvents()) seen.add(event.actor);
  return actors.length <= 12 ? actors.map((_, i) => i) : [...seen].sort((a, b) => a - b);
}
function shownEvents() {
  const all = [];
  for (const frame of shownFrames()) {
    for (const event of frame.events) all.push(event);
  }
  for (const event of outside) {
    if (event.end >= view.begin && event.begin <= view.end) all.push(event);
  }
  return all;
}

function isOrder(kind) { return kind === 'signal' || kind === 'wait' || kind === 'submit' || kind === 'frame'; }
function glyphClass(kind) {
  if (kind === 'signal' || kind === 'wait' || kind === 'read' || kind === 'write') return kind;
  return 'other';
}
function glyph(kind, x, y) {
  const size = 6;
  let d = `M${x - 4},${y} a4,4 0 1,0 8,0 a4,4 0 1,0 -8,0`;
  if (kind === 'signal') d = `M${x - size},${y + size} L${x + size},${y + size} L${x},${y - size} Z`;
  if (kind === 'wait') d = `M${x - size},${y - size} L${x + size},${y - size} L${x},${y + size} Z`;
  if (kind === 'write' || kind === 'read') d = `M${x - 5},${y - 5} h10 v10 h-10 Z`;
  if (kind === 'submit') d = `M${x},${y - 6} L${x + 6},${y} L${x},${y + 6} L${x - 6},${y} Z`;
  return shape('path', { d, class: 'glyph ' + glyphClass(kind) });
}

// The time at which an event's glyph stands: a wait at its end, where its actor goes on.
function instant(event) { return event.kind === 'wait' ? event.end : event.begin; }

function ticks(begin, end, most) {
  const rough = (end - begin) / most, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= rough) || rough;
  const list = [];
  for (let t = Math.ceil(begin / step) * step; t <= end; t += step) list.push(t);
  return list;
}

// Time between an actor's events of one frame in which it neither waited nor had nothing to do.
function busyParts(frame) {
  const cursor = new Map(), parts = [];
  for (const event of frame.events) {
    const from = cursor.get(event.actor);
    if (from !== undefined && event.begin > from && !event.idleBefore) parts.push([event.actor, from, event.begin]);
    if (event.kind !== 'wait' && event.end > event.begin) parts.push([event.actor, event.begin, event.end]);
    cursor.set(event.actor, Math.max(from || 0, event.end));
  }
  return parts;
}

function drawTimeline() {
  const svg = byId('timeline'), width = Math.max(byId('stage').clientWidth, 640);
  const lanes = laneList(), laneOf = new Map(lanes.map((actor, row) => [actor, row]));
  const height = kTop + lanes.length * kLane + 6;
  svg.setAttribute('viewBox', `0 0 ${width} ${height}`);
  svg.style.height = height + 'px';
  const x = (t) => kGutter + (t - view.begin) / (view.end - view.begin) * (width - kGutter - kRight);
  const inside = (a, b) => b >= view.begin && a <= view.end;
  const y = (actor, row) => kTop + laneOf.get(actor) * kLane + row;
  const parts = { back: shape('g'), bars: shape('g'), arrows: shape('g'), glyphs: shape('g'), marks: shape('g') };
  let budget = kMostShapes;
  const add = (layer, made) => { if (budget-- > 0) parts[layer].append(made); };
  const bar = (cls, actor, from, to, row, tall, extra = {}) => {
    const left = Math.max(x(from), kGutter - 20), right = Math.min(x(to), width + 20);
    return shape('rect', { class: cls, x: left, y: y(actor, row) - tall / 2, width: Math.max(right - left, 1),
      height: tall, ...extra });
  };

  svg.replaceChildren(definitions());
  lanes.forEach((actor, row) => {
    const lane = shape('g', { class: 'lane', 'data-actor': actor });
    lane.append(shape('rect', { class: 'back', x: 0, y: kTop + row * kLane, width, height: kLane - 4 }));
    parts.back.append(lane);
  });
  const origin = shownFrames()[0].begin, axis = shape('g', { class: 'axis' });
  for (const t of ticks(view.begin - origin, view.end - origin, width / 110)) {
    const at = x(t + origin);
    if (at < kGutter) continue;
    axis.append(shape('line', { x1: at, x2: at, y1: 18, y2: height }));
    axis.append(shape('text', { x: at + 3, y: 14 }, time(t)));
  }
  parts.back.append(axis);
  for (const frame of shownFrames()) {
    if (frame.number === 0 || !inside(frame.begin, frame.begin)) continue;
    const line = shape('g', { class: 'frameline' });
    line.append(shape('line', { x1: x(frame.begin), x2: x(frame.begin), y1: 20, y2: height }));
    line.append(shape('text', { x: x(frame.begin) + 4, y: 30 }, 'frame ' + frame.number));
    parts.back.append(line);
    for (const [actor, from, to] of busyParts(frame)) {
      if (inside(from, to)) add('bars', bar('busy', actor, from, to, kOrderRow, 12));
    }
  }
  for (const frame of shownFrames()) drawPath(frame, { add, bar, x, y, inside });

  const labelEnd = new Map(), glyphEnd = new Map(), placed = new Map();  // where the last label and glyph of a lane's row end
  for (const event of shownEvents()) {
    if (!laneOf.has(event.actor) || event.kind === 'wait-begin') continue;
    const last = event.never ? view.end : event.end;
    if (!inside(event.begin, last)) continue;
    if (event.kind === 'wait' && last > event.begin) {
      add('bars', bar('stall' + (event.never ? ' never' : ''), event.actor, event.begin, last, kOrderRow, 24,
        { 'data-event': event.index }));
    }
    if (event.kind === 'wait' && event.signal >= 0) drawArrow(events[event.signal], event, { add, x, y, laneOf });
    const row = isOrder(event.kind) ? kOrderRow : kAccessRow, line = event.actor + ':' + row;
    const exact = x(instant(event)), taken = glyphEnd.get(line) ?? -Infinity;
    // What happens at once stands side by side, a little late, rather than on top of each other.
    const at = exact < taken && taken - exact < 40 ? taken : exact;
    glyphEnd.set(line, at + 12);
    if (row === kAccessRow && event.end > event.begin) {
      add('bars', bar('busy', event.actor, event.begin, event.end, row, 6, { 'data-event': event.index }));
    }
    if (at < kGutter - 10) continue;
    const made = glyph(event.kind, at, y(event.actor, row));
    made.setAttribute('data-event', event.index);
    add('glyphs', made);
    placed.set(event.index, [at, y(event.actor, row)]);
    drawLabel(event, at, y(event.actor, row), labelEnd, add);
  }
  for (const [index] of placed) {
    for (const finding of events[index].findings) drawMark(finding, placed, add);
  }
  svg.append(parts.back, parts.bars, parts.arrows, parts.glyphs, parts.marks, names(lanes, height));
  byId('window').textContent = budget < 0
    ? `more than ${count(kMostShapes, 'shape', 'shapes')} here: some are left out; show fewer frames or zoom in`
    : `${time(view.end - view.begin)} of ${count(D.totalFrames, 'frame', 'frames')}`;
}

function definitions() {
  const defs = shape('defs');
  const hatch = shape('pattern', { id: 'hatch', width: 7, height: 7, patternUnits: 'userSpaceOnUse',
    patternTransform: 'rotate(45)' });
  hatch.append(shape('rect', { width: 7, height: 7 }), shape('line', { x1: 0, y1: 0, x2: 0, y2: 7 }));
  defs.append(hatch);
  for (const id of ['head', 'headheld']) {
    const marker = shape('marker', { id, viewBox: '0 0 8 8', refX: 7, refY: 4, markerWidth: 7, markerHeight: 7,
      markerUnits: 'userSpaceOnUse', orient: 'auto' });
    marker.append(shape('path', { d: 'M0,0 L8,4 L0,8 Z' }));
    defs.append(marker);
  }
  return defs;
}

// Over everything, so that what is scrolled out at the left goes under the names.
function names(lanes, height) {
  const group = shape('g', { class: 'lane' });
  group.append(shape('rect', { class: 'gutter', x: 0, y: 0, width: kGutter - 12, height }));
  lanes.forEach((actor, row) => {
    const name = actors[actor].name, short = name.length > 17 ? name.slice(0, 16) + '\u2026' : name;
    const title = shape('text', { class: 'name', x: 10, y: kTop + row * kLane + 30 }, short);
    title.append(shape('title', {}, name));
    group.append(title, shape('text', { class: 'kind', x: 10, y: kTop + row * kLane + 46 }, actors[actor].kind));
  });
  return group;
}

function drawPath(frame, { add, bar, x, y, inside }) {
  frame.path.forEach((part, i) => {
    if (!inside(part.begin, part.end)) return;
    add('bars', bar('critical', part.actor, part.begin, part.end, kPathRow, 5, { 'data-path': `${frame.number}:${i}` }));
    if (i > 0) {
      const at = x(part.begin);
      add('bars', shape('line', { class: 'criticaljump', x1: at, x2: at, y1: y(frame.path[i - 1].actor, kPathRow),
        y2: y(part.actor, kPathRow) }));
    }
  });
}

function drawArrow(signal, wait, { add, x, y, laneOf }) {
  if (!laneOf.has(signal.actor)) return;
  const x1 = x(signal.begin), y1 = y(signal.actor, kOrderRow), x2 = x(wait.end), y2 = y(wait.actor, kOrderRow);
  const down = y2 > y1 ? 1 : -1, held = wait.end > wait.begin && signal.end > wait.begin;
  const from = y1 + 7 * down, to = y2 - 8 * down, middle = (from + to) / 2;
  const d = signal.actor === wait.actor ? `M${x1},${y1 - 7} C${x1},${y1 - 24} ${x2},${y2 - 24} ${x2},${y2 - 8}`
    : `M${x1},${from} C${x1},${middle} ${x2},${middle} ${x2},${to}`;
  add('arrows', shape('path', { class: 'arrow' + (held ? ' held' : ''), d, 'data-event': wait.index,
    'marker-end': held ? 'url(#headheld)' : 'url(#head)' }));
}

function drawLabel(event, at, y, labelEnd, add) {
  if (event.kind === 'frame' || event.kind === 'wait-begin' || event.object === '') return;
  const text = event.kind === 'submit' ? 'to ' + event.object : event.object + (event.value ? ' ' + event.value : '');
  const short = text.length > 22 ? text.slice(0, 21) + '\u2026' : text, key = event.actor + ':' + y;
  if (at + 8 < (labelEnd.get(key) ?? -Infinity)) return;
  labelEnd.set(key, at + 14 + short.length * 6.2);
  add('glyphs', shape('text', { class: 'label', x: at + 8, y: y - 5 }, short));
}

// A ring where the finding showed, and the missing order as a line from where it should have come from.
function drawMark(finding, placed, add) {
  const [x2, y2] = placed.get(finding.second), lit = finding.index === view.lit ? ' lit' : '';
  const first = placed.get(finding.first);
  if (first && finding.first !== finding.second && finding.severity !== 'info') {
    add('marks', shape('path', { class: 'missing', d: `M${first[0]},${first[1]} L${x2},${y2}`, 'data-finding': finding.index }));
  }
  add('marks', shape('circle', { class: 'mark ' + finding.severity + lit, cx: x2, cy: y2, r: 10,
    'data-finding': finding.index }));
}
