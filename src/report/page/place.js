'use strict';
(() => {
  const {el, bar} = counterflex.dom;
  const {known, fixed} = counterflex.units;
  const words = counterflex.words;

  /** Largest absolute value of a quantity in a stretch; null if unknown. */
  function at(curves, name, i) {
    const q = curves.quantities[name];
    const value = q ? q.largest[i] : NaN;
    return Number.isNaN(value) ? null : value;
  }

  const partNames = ['geometry', 'load', 'gravity', 'preloads', 'discrepancy'];

  /**
   * The stretch of the same block nearest to `i` with a known deviation before and known parts (they are computed only
   * at ends of pieces); `i` without such a stretch.
   */
  function nearestKnown(c, i) {
    const present = partNames.filter((part) => c.quantities[`${part}_mm`]);
    const attributed = (k) => present.length === 0 || present.some((part) => at(c, `${part}_mm`, k) !== null);
    const knows = (k) => at(c, 'before_mm', k) !== null && attributed(k);
    const line = c.first_line[i];
    if (knows(i) || c.last_line[i] !== line) return i;
    const search = (step) => {
      let k = i + step;
      while (c.first_line[k] === line && c.last_line[k] === line && !knows(k)) k += step;
      return c.first_line[k] === line && knows(k) ? [k] : [];
    };
    const far = (k) => Math.abs(c.s_mm[k] - c.s_mm[i]);
    return [...search(-1), ...search(1)].sort((a, b) => far(a) - far(b))[0] ?? i;
  }

  /** The data of a stretch of the path, in the form of a row of the worst blocks. */
  function ofStretch(run, i) {
    const c = run.curves;
    const operation = (run.report.operations || [])[c.operation[i]];
    const from = nearestKnown(c, i);
    const causes = Object.fromEntries(partNames.map((part) => [`${part}_mm`, at(c, `${part}_mm`, from)]));
    return {
      line: c.first_line[i], last_line: c.last_line[i], s_mm: c.s_mm[i],
      place_mm: Array.from(c.place_mm.subarray(3 * i, 3 * i + 3)),
      before_mm: at(c, 'before_mm', from), about: from !== i, after_mm: at(c, 'after_mm', i), force_N: at(c, 'force_N', i),
      tool: operation ? operation.tool : 0, operation: operation ? operation.operation : '', text: null, causes,
    };
  }

  function barOf(part, largest, units) {
    const drawing = bar(largest > 0 ? part.mm / largest : 0, part.key);
    const size = el('span', null, units.format(part.mm));
    return el('div', {class: 'bar'}, el('dt', null, part.name), el('dd', null, drawing, size));
  }

  /** Parts of the deviation before; the longest bar has full length. */
  function bars(causes, units) {
    const parts = words.parts(causes);
    if (parts.length === 0) return null;
    const largest = Math.max(...parts.map((part) => part.mm));
    return el('dl', {class: 'bars'}, parts.map((part) => barOf(part, largest, units)));
  }

  function causeSentence(row, units) {
    const cause = words.cause(row.causes);
    if (!cause) return null;
    const size = known(row.before_mm) ? `Off by ${row.about ? 'about ' : ''}${units.format(row.before_mm)} before: ` : '';
    return el('p', {class: 'cause'}, `${size}${cause}.`);
  }

  function fact(name, value) {
    return [el('dt', null, name), el('dd', null, value)];
  }

  function facts(row, units) {
    const place = (row.place_mm || []).map((x) => units.lengthNumber(x)).join(', ');
    return el('dl', {class: 'facts'},
        known(row.after_mm) && fact('After (model residual)', units.format(row.after_mm)),
        fact('Cutting force', known(row.force_N) ? `${fixed(row.force_N, 1)} N` : 'unknown'),
        fact('Tool', words.toolName(row.tool)), row.operation && fact('Operation', row.operation),
        known(row.s_mm) && fact('Place on the path', units.length(row.s_mm)),
        place && fact('Machine x, y, z', `${place} ${units.lengthLabel}`));
  }

  /** The card of a place: its line, its cause in words and bars, and the force. */
  function card(run, row, units) {
    const lines = row.last_line > row.line ? `Lines ${row.line} to ${row.last_line}` : `Line ${row.line}`;
    return el('div', {class: 'place-card', 'data-line': row.line},
        el('h3', null, words.ofRun(run, lines)),
        row.text ? el('pre', null, el('code', null, row.text)) : null,
        causeSentence(row, units), bars(row.causes, units), facts(row, units));
  }

  counterflex.place = {card, ofStretch};
})();
