'use strict';
/** The machine as lines in the path view. Lines: lists of places [x, y, z], mm in the machine frame. */
(() => {
  /** Whether a run has lines of its machine. */
  const usable = ({curves, machine}) => Boolean(curves && machine && machine.skeleton);

  /** The place of a node at frame `f` of a skeleton. */
  const placeOf = (node, f) => (Array.isArray(node) ? node : Array.from(node.subarray(3 * f, 3 * f + 3)));

  /** Index of the first stretch number that is not below `stretch`. */
  function firstFrom(stretches, stretch) {
    let low = 0, high = stretches.length - 1;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (stretches[middle] < stretch) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  /**
   * The place of the machine's data that belongs to a stretch, a fraction between two of them. `stretches`: of each place,
   * ascending.
   */
  function indexOf({curves: {s_mm: s}}, stretches, stretch) {
    const k = firstFrom(stretches, stretch);
    if (k === 0 || stretches[k] <= stretch) return k;
    const [from, to] = [s[stretches[k - 1]], s[stretches[k]]];
    return to > from ? k - 1 + (s[stretch] - from) / (to - from) : k;
  }

  /** The lines at an index of the machine's data; [] if they are unknown. Between two frames they are interpolated. */
  function linesAt({skeleton: {every, lines}, s_mm: s}, index) {
    const last = Math.floor((s.length - 1) / every);
    const f = Math.min(last, index / every), from = Math.floor(f), t = f - from;
    const at = (node) => {
      const a = placeOf(node, from);
      return t > 0 ? placeOf(node, from + 1).map((v, i) => a[i] + t * (v - a[i])) : a;
    };
    const drawn = lines.map((line) => line.map(at));
    return drawn.flat(2).every(Number.isFinite) ? drawn : [];
  }

  /** A function that gives the lines of a run's machine at a stretch. */
  function follow(run) {
    const stretches = counterflex.series.along(run, run.machine).map(({stretch}) => stretch);
    return (stretch) => linesAt(run.machine, indexOf(run, stretches, stretch));
  }

  /** The box around the lines at all places. */
  function boxOf({skeleton: {lines}}) {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (const node of lines.flat())
      node.forEach((v, i) => {
        if (v < low[i % 3]) low[i % 3] = v;
        if (v > high[i % 3]) high[i % 3] = v;
      });
    return {low, high};
  }

  /** Draws lines moved by minus `origin`, see-through, with a dot at each node. */
  function draw(context, {lines, origin}, project, theme) {
    const onScreen = lines.map((line) => line.map((p) => project(...p.map((v, i) => v - origin[i]))));
    context.save();
    context.lineCap = context.lineJoin = 'round';
    context.strokeStyle = context.fillStyle = counterflex.colours.css(theme.ink);
    context.globalAlpha = 0.4;
    context.lineWidth = 5;
    context.beginPath();
    for (const line of onScreen) line.forEach(([x, y], i) => (i === 0 ? context.moveTo(x, y) : context.lineTo(x, y)));
    context.stroke();
    context.globalAlpha = 0.8;
    for (const [x, y] of onScreen.flat()) {
      context.beginPath();
      context.arc(x, y, 3.5, 0, 2 * Math.PI);
      context.fill();
    }
    context.restore();
  }

  counterflex.skeleton = {usable, indexOf, linesAt, follow, boxOf, draw};
})();
