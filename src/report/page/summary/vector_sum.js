'use strict';
/** Causes of a deviation as a sum of vectors: along each axis a bar begins where that of the cause above ends. */
(() => {
  const {el, svg, table, numberColumn} = counterflex.dom;

  /** Begin and end of each bar: lists [x, y, z] of [from, to]; causes follow each other, the sum begins at zero. */
  function spans(causes, total) {
    let at = [0, 0, 0];
    const rows = causes.map(({vector}) => {
      const begin = at;
      at = at.map((v, k) => v + vector[k]);
      return begin.map((from, k) => [from, at[k]]);
    });
    return [...rows, total.map((v) => [0, v])];
  }

  /** A bar from one value to another, on a scale from `low` to `high` with a line at zero. */
  function bar([from, to], [low, high], className) {
    const x = (v) => (high > low ? (100 * (v - low)) / (high - low) : 0);
    const width = Math.abs(x(to) - x(from));
    return svg('svg', {viewBox: '0 0 100 10', preserveAspectRatio: 'none', 'aria-hidden': 'true', class: `part span ${className}`},
        svg('rect', {x: Math.min(x(from), x(to)).toFixed(2), y: 0, width: width.toFixed(2), height: 10}),
        svg('line', {x1: x(0).toFixed(2), x2: x(0).toFixed(2), y1: 0, y2: 10}));
  }

  /** "+0.0123", "\u22120.0045"; "0" for a value without shown digits. */
  function signed(mm, units) {
    const text = units.number(mm);
    if (Number(text) === 0) return '0';
    return (mm > 0 ? '+' : '') + text.replace('-', '\u2212');
  }

  /**
   * `causes`: [{key, name, vector}]; `total`: their sum; `others`: more rows [name, vector] without a bar. Vectors in mm.
   */
  function render(caption, causes, total, others, units) {
    const bars = spans(causes, total);
    const ends = bars.flat(2);
    const scale = [Math.min(0, ...ends), Math.max(0, ...ends)];
    const columns = [{title: ''}, ...['x', 'y', 'z', 'Size'].map((title) => numberColumn(title))];
    const size = (vector) => signed(counterflex.vectors.norm(vector), units).replace('+', '');
    const row = (name, vector, key, spansOfRow) => [name,
      ...vector.map((v, k) => [signed(v, units), spansOfRow ? bar(spansOfRow[k], scale, key) : null]), size(vector)];
    const rows = [...causes.map(({name, vector, key}, i) => row(name, vector, key, bars[i])),
      Object.assign(row('Sum: before', total, 'total', bars[causes.length]), {mark: 'total'}),
      ...others.map(([name, vector]) => row(name, vector, '', null))];
    const node = table(caption, columns, rows);
    node.classList.add('vector-sum');
    return el('div', null, node);
  }

  counterflex.vectorSum = {render, spans};
})();
