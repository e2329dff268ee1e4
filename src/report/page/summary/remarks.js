'use strict';
(() => {
  const {el, table, textColumn, numberColumn} = counterflex.dom;
  const {known} = counterflex.units;
  const words = counterflex.words;

  /** Rows of a list that may be truncated. */
  function list(run, title, what, rows, count) {
    if (rows.length === 0) return null;
    return [table(words.ofRun(run, title), [{title: 'Line'}, textColumn(what)], rows),
      count > rows.length ? el('p', {class: 'note'}, `and ${count - rows.length} more`) : null];
  }

  const marks = {ok: '\u2713', unknown: '?', doubtful: '\u2717', wrong: '\u2717'};

  function sanity(run) {
    const checks = run.report.sanity || [];
    if (checks.length === 0) return null;
    const rows = checks.map(({check, state, text}) =>
      Object.assign([`${marks[state]} ${check}`, state, words.unitsOf(text)], {mark: state === 'ok' ? '' : 'different'}));
    return table(words.ofRun(run, 'Checks'), [{title: 'Check', class: 'lines'}, {title: 'State'}, textColumn('Found')], rows);
  }

  function warnings(run, link) {
    const {warnings: rows, warning_count: count} = run.report;
    const cells = rows.map(({line, what}) => [link(line), words.unitsOf(what)]);
    return list(run, words.counted(count, 'warning'), 'What', cells, count);
  }

  function leftAlone(run, link) {
    const {left_alone: rows, left_alone_count: count} = run.report.blocks;
    const moves = words.otherMoves(run.report.blocks);
    const title = moves > 0 ? `Not corrected individually: ${words.counted(moves, 'move')}` : 'Not or partly corrected';
    return list(run, title, 'Why, from this line on',
        rows.map(({line, why}) => [link(line), why]), count);
  }

  function machinePositions(run, link) {
    const {machine_positions: rows = [], machine_positions_count: count} = run.report.blocks;
    return list(run, `In machine coordinates, not changed: ${words.counted(count, 'block')}`, 'Why',
        rows.map(({line, why}) => [link(line), why]), count);
  }

  /** Feed moves without a force: their count and the length of those with a known one. */
  function unforced({moves, unknown_length: unknown, length_mm: length}, units) {
    const text = known(length) ? units.length(length) : 'length unknown';
    const more = known(length) && unknown > 0 ? `, ${unknown} of unknown length` : '';
    return `${words.counted(moves, 'feed move')}, ${text}${more}`;
  }

  function withoutForce(run, link, units) {
    const {without_force: without} = run.report.forces;
    const {reasons, moves} = without;
    if (moves === 0) return null;
    const rows = reasons.map((r) => [r.why, String(r.moves), units.lengthNumber(r.length_mm), link(r.first_line)]);
    const columns = [textColumn('Why'), numberColumn('Moves'), numberColumn(`Length, ${units.lengthLabel}`),
      numberColumn('First line')];
    const caption = `Without a cutting force: ${unforced(without, units)}`;
    return table(words.ofRun(run, caption), columns, rows);
  }

  /** The sanity block, warnings, blocks that are not corrected with their reasons, blocks in machine coordinates, and moves without a force. */
  function render(context) {
    return el('div', {class: 'runs'}, context.runs.map((run, i) => {
      const quantity = run.report.summary.after ? 'after_mm' : 'before_mm';
      const link = (line) => counterflex.lines.link(context, i, line, {quantity});
      const parts = [sanity(run), warnings(run, link), leftAlone(run, link), machinePositions(run, link),
        withoutForce(run, link, context.units)].filter(Boolean);
      return el('div', {class: 'stack'}, parts.length > 0 ? parts : el('p', null, words.ofRun(run, 'No warnings.')));
    }));
  }

  counterflex.remarks = {render, unforced};
})();
