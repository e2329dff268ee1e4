'use strict';
(() => {
  const {el, bar} = counterflex.dom;
  const {known, fixed} = counterflex.units;
  const words = counterflex.words;

  /** Largest value of a quantity in a stretch, whatever its sign was; null where it is unknown. */
  function at(curves, name, i) {
    const q = curves.quantities[name];
    const value = q ? q.largest[i] : NaN;
    return Number.isNaN(value) ? null : value;
  }

  /** What is known of a stretch of the path, in the form of a row of the worst blocks. */
  function ofStretch(run, i) {
    const c = run.curves;
    const operation = (run.report.operations || [])[c.operation[i]];
    const causes = {};
    for (const part of ['geometry', 'load', 'gravity', 'discrepancy']) causes[`${part}_mm`] = at(c, `${part}_mm`, i);
    return {
      line: c.first_line[i], last_line: c.last_line[i], s_mm: c.s_mm[i],
      place_mm: Array.from(c.place_mm.subarray(3 * i, 3 * i + 3)),
      before_mm: at(c, 'before_mm', i), after_mm: at(c, 'after_mm', i), force_N: at(c, 'force_N', i),
      tool: operation ? operation.tool : 0, operation: operation ? operation.operation : '', text: null, causes,
    };
  }

  function barOf(part, largest, units) {
    const drawing = bar(largest > 0 ? part.mm / largest : 0, part.key);
    const size = el('span', null, units.format(part.mm));
    return el('div', {class: 'bar'}, el('dt', null, part.name), el('dd', null, drawing, size));
  }

  /** Parts of the deviation before, longest bar full. */
  function bars(causes, units) {
    const parts = words.parts(causes);
    if (parts.length === 0) return null;
    const largest = Math.max(...parts.map((part) => part.mm));
    return el('dl', {class: 'bars'}, parts.map((part) => barOf(part, largest, units)));
  }

  function causeSentence(row, units) {
    const cause = words.cause(row.causes);
    if (!cause) return null;
    const size = known(row.before_mm) ? `Off by ${units.format(row.before_mm)} before: ` : '';
    return el('p', {class: 'cause'}, `${size}${cause}.`);
  }

  function fact(name, value) {
    return [el('dt', null, name), el('dd', null, value)];
  }

  function facts(row, units) {
    const place = (row.place_mm || []).map((x) => units.lengthNumber(x)).join(', ');
    return el('dl', {class: 'facts'},
        known(row.after_mm) && fact('After (model residual)', units.format(row.after_mm)),
        fact('Cutting force', known(row.force_N) ? `${fixed(row.force_N, 1)} N` : 'not known'),
        fact('Tool', words.toolName(row.tool)), row.operation && fact('Operation', row.operation),
        known(row.s_mm) && fact('Place on the path', units.length(row.s_mm)),
        place && fact('Machine x, y, z', `${place} ${units.lengthLabel}`));
  }

  /** The card of a place: its line, its cause in words and bars, and what acts there. */
  function card(run, row, units) {
    const lines = row.last_line > row.line ? `Lines ${row.line} to ${row.last_line}` : `Line ${row.line}`;
    return el('div', {class: 'place-card', 'data-line': row.line},
        el('h3', null, words.ofRun(run, lines)),
        row.text ? el('pre', null, el('code', null, row.text)) : null,
        causeSentence(row, units), bars(row.causes, units), facts(row, units));
  }

  counterflex.place = {card, ofStretch};
})();
