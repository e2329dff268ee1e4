'use strict';
(() => {
  const holds = (curves, i, line) => curves.first_line[i] <= line && line <= curves.last_line[i];

  /** Size of a quantity in a stretch; -1 where it is unknown. */
  function sizeAt(curves, quantity, i) {
    const q = quantity && curves.quantities && curves.quantities[quantity];
    if (!q || Number.isNaN(q.largest[i])) return -1;
    return Math.max(Math.abs(q.largest[i]), Math.abs(q.least[i]));
  }

  /**
   * The stretch of a program's line in which a quantity is largest, else the first of the line; -1 without such a
   * stretch.
   */
  function stretchOf(curves, line, quantity) {
    let best = -1;
    for (let i = 0; curves && i < curves.s_mm.length; ++i)
      if (holds(curves, i, line) && (best < 0 || sizeAt(curves, quantity, i) > sizeAt(curves, quantity, best))) best = i;
    return best;
  }

  /** Distances of stretch `i` and of its end from path length `s`, mm; distances within `slack` are 0. */
  function distances(curves, i, s, slack) {
    const begin = i > 0 ? curves.s_mm[i - 1] : 0, end = curves.s_mm[i];
    const outside = Math.max(begin - s, s - end);
    return [outside > slack ? outside : 0, Math.abs(end - s)];
  }

  /** The stretch in [from, to] with the line that is nearest to `s`; -1 without such a stretch. */
  function nearest(curves, line, s, [from, to], slack) {
    let best = -1, least = [Infinity, Infinity];
    for (let i = from; i <= to; ++i) {
      if (!holds(curves, i, line)) continue;
      const [outside, end] = distances(curves, i, s, slack);
      if (outside < least[0] || (outside === least[0] && end < least[1])) [best, least] = [i, [outside, end]];
    }
    return best;
  }

  /**
   * The stretch of a program's line nearest to path length `s`. `s` was written with few digits and may be in the next
   * stretch. Without the line: the stretch at `s`.
   */
  function stretchNear(curves, line, s) {
    const slack = 1e-6 * Math.max(1, Math.abs(s));
    const {stretchAt} = counterflex.data;
    const last = curves.s_mm.length - 1;
    const close = [stretchAt(curves, s - slack), Math.min(last, stretchAt(curves, s + slack) + 1)];
    const here = nearest(curves, line, s, close, slack);
    const found = here < 0 ? nearest(curves, line, s, [0, last], slack) : here;
    return found < 0 ? stretchAt(curves, s) : found;
  }

  /**
   * First and last stretch of an operation. If all merged stretches belong to other operations: the stretches of its
   * lines. [-1, -1] without such a stretch.
   */
  function ofOperation(curves, index, {first_line: from, last_line: to}) {
    const first = curves.operation.indexOf(index);
    if (first >= 0) return [first, curves.operation.lastIndexOf(index)];
    const begin = stretchOf(curves, from);
    return begin < 0 ? [-1, -1] : [begin, Math.max(begin, stretchOf(curves, to))];
  }

  /** "line 5", or "lines 5 to 9" for a stretch with several lines. */
  function words({first_line: first, last_line: last}, i) {
    return first[i] === last[i] ? `line ${first[i]}` : `lines ${first[i]} to ${last[i]}`;
  }

  /**
   * A line number as a link that shows the place in all views; a dash without a line. `where`: {s_mm} of the place, or
   * {quantity} that is largest there.
   */
  function link(context, run, line, where = {}) {
    if (!(line > 0)) return '\u2013';
    const {curves} = context.runs[run];
    const first = stretchOf(curves, line, where.quantity);
    if (first < 0) return String(line);
    const stretch = where.s_mm === undefined ? first : stretchNear(curves, line, where.s_mm);
    const go = () => context.goTo(run, stretch);
    return counterflex.dom.jump(String(line), 'curves', go, `Line ${line}: show it in all views`);
  }

  counterflex.lines = {stretchOf, stretchNear, ofOperation, words, link};
})();
