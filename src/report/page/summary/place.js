'use strict';
(() => {
  const {el} = counterflex.dom;
  const {known, fixed} = counterflex.units;
  const words = counterflex.words;

  /** Largest absolute value of a quantity in a stretch; null if unknown. */
  function at(curves, name, i) {
    const q = curves.quantities[name];
    const value = q ? q.largest[i] : NaN;
    return Number.isNaN(value) ? null : value;
  }

  /** The causes at a stretch, [{key, name, vector}]; [] if they are unknown. */
  function causesAt(curves, i) {
    const list = words.allParts.map(({base, key, name}) => ({key, name, ...counterflex.vectors.at(curves, base, i)}));
    return list.filter(({vector}) => vector);
  }

  const {causesOf, norm, sizesOf} = counterflex.vectors;

  /** The place of the largest deviation of a run, if it is in stretch `i`; else null. The report has its causes as vectors. */
  function largestIn({curves: c, report}, i) {
    const {at_worst: place} = (report.summary && report.summary.sources) || {};
    if (!place || !place.superposition_mm || place.line < c.first_line[i] || place.line > c.last_line[i]) return null;
    const size = norm(place.before_mm);
    return Math.abs(size - at(c, 'before_mm', i)) <= 1e-5 * size ? place : null;
  }

  /** What is known better of a stretch of several waypoints: from the report's largest deviation, or its row. */
  function ofMerged(run, i, row) {
    const has = ['s_mm', 'place_mm', 'before_mm', 'after_mm'].filter((key) => row[key] !== undefined && row[key] !== null);
    const own = Object.fromEntries(has.map((key) => [key, row[key]]));
    const place = largestIn(run, i);
    if (!place || (row.line && row.line !== place.line)) return own;
    const causes = causesOf(place);
    return {...own, line: place.line, last_line: place.line, s_mm: null, place_mm: place.place_mm, before_mm: norm(place.before_mm),
      vectors: {before: {vector: place.before_mm}}, causes, sizes: sizesOf(causes), text: lineText(run, place.line)};
  }

  /**
   * All values at one place, the end of a stretch: {line, last_line, s_mm, place_mm, before_mm, about: whether it is
   * interpolated, after_mm, points: number of waypoints of the stretch, merged: whether there are several, so that sizes are the
   * largest of them, vectors: {before, after, correction},
   * each {vector, about} or null, causes: vectors, sizes, force_N, tool, operation, text}. `row`: of the worst blocks, if it
   * was chosen there.
   */
  function ofStretch(run, i, row = {}) {
    const c = run.curves;
    const operation = (run.report.operations || [])[c.operation[i]];
    const vectors = Object.fromEntries(['before', 'after', 'correction'].map((base) => [base, counterflex.vectors.at(c, base, i)]));
    const causes = vectors.before ? causesAt(c, i) : [];
    const {before} = vectors, merged = c.waypoints_per_stretch > 1;
    return {
      line: row.line || c.first_line[i], last_line: row.line || c.last_line[i], s_mm: c.s_mm[i],
      place_mm: Array.from(c.place_mm.subarray(3 * i, 3 * i + 3)),
      before_mm: before ? norm(before.vector) : at(c, 'before_mm', i), merged, points: c.waypoints_per_stretch, about: Boolean(before && before.about),
      after_mm: at(c, 'after_mm', i), vectors, causes, sizes: causes.length > 0 ? sizesOf(causes) : row.causes,
      force_N: at(c, 'force_N', i), tool: operation ? operation.tool : 0, operation: operation ? operation.operation : '',
      text: row.text || lineText(run, c.first_line[i]),
      ...(merged ? ofMerged(run, i, row) : {}),
    };
  }

  /** The same for a row of a run without curves: it has sizes, but no vectors. */
  const ofRow = (row) => ({...row, about: false, vectors: {}, causes: [], sizes: row.causes});

  const lineText = (run, line) => (run.source && run.source.lines[line - 1]) || '';

  /** The deviation at a place and its cause in a sentence. */
  function sentence({before_mm: before, about, merged, after_mm: after, vectors, sizes}, units) {
    const cause = words.cause(sizes);
    if (!known(before)) return null;
    const most = about ? 'about ' : merged && !vectors.before ? 'up to ' : '';
    const size = `Off by ${most}${units.format(before)} before${cause ? `: ${cause}` : ''}.`;
    return el('p', {class: 'cause'}, size, known(after) ? ` After: ${merged ? 'up to ' : ''}${units.format(after)}.` : '');
  }

  function fact(name, value) {
    return [el('dt', null, name), el('dd', null, value)];
  }

  function facts(place, units) {
    const where = (place.place_mm || []).map((x) => units.lengthNumber(x)).join(', ');
    const ofForce = place.merged ? 'Cutting force, largest of the stretch' : 'Cutting force';
    return el('dl', {class: 'facts'},
        fact(ofForce, known(place.force_N) ? `${fixed(place.force_N, 1)} N` : 'unknown'),
        fact('Tool', words.toolName(place.tool)), place.operation && fact('Operation', place.operation),
        known(place.s_mm) && fact('Place on the path', units.length(place.s_mm)),
        where && fact('Machine x, y, z', `${where} ${units.lengthLabel}`));
  }

  function vectorTable({line, merged, vectors, causes}, units) {
    if (!vectors.before || causes.length === 0) return null;
    const others = [['Correction', vectors.correction], ['After (model residual)', vectors.after]]
        .filter(([, value]) => value).map(([name, value]) => [name, value.vector]);
    const where = merged ? `Causes at the largest deviation before, in line ${line}` : 'Causes at this place';
    return counterflex.vectorSum.render(`${where}, in ${units.words}, axes of the machine`, causes, vectors.before.vector, others, units);
  }

  /** What the numbers of a stretch of several waypoints are; '' for a single one. */
  function mergedText({report}, {merged, points, causes}) {
    if (!merged) return '';
    const {line} = (report.summary.sources || {}).at_worst || {};
    if (causes.length > 0) return `The causes are those at the largest deviation before. "Up to" is the largest value of a stretch of ${points} points.`;
    const sum = line ? ` Its causes are not shown as a sum: that is shown only for the largest deviation before, in line ${line}.` : '';
    return `This is a stretch of ${points} points. "Up to" is the largest value in it.${sum}`;
  }

  /** The card of a place: its line, and there the deviation, its causes as a sum of vectors, and the force. */
  function card(run, place, units) {
    const lines = place.last_line > place.line ? `Lines ${place.line} to ${place.last_line}` : `Line ${place.line}`;
    return el('div', {class: 'place-card', 'data-line': place.line},
        el('h3', null, words.ofRun(run, lines)),
        place.text ? el('pre', null, el('code', null, place.text)) : null,
        sentence(place, units), vectorTable(place, units),
        place.merged ? el('p', {class: 'note merged'}, mergedText(run, place)) : null, facts(place, units));
  }

  counterflex.place = {card, sentence, mergedText, ofStretch, ofRow};
})();
