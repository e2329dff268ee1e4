'use strict';
(() => {
  const {el, table, numberColumn, jump} = counterflex.dom;
  const {fixed, known} = counterflex.units;
  const words = counterflex.words;

  /** The stretch of a row of the worst blocks. */
  function stretchOf(curves, row) {
    const {lines} = counterflex;
    if (known(row.s_mm)) return lines.stretchNear(curves, row.line, row.s_mm);
    return lines.stretchOf(curves, row.line, known(row.after_mm) ? 'after_mm' : 'before_mm');
  }

  function columnsOf(report) {
    const after = Boolean(report.summary.after);
    return [
      {title: 'Line'}, numberColumn('Before'), ...(after ? [numberColumn('After')] : []), numberColumn('Force'),
      {title: 'Tool', class: 'minor'}, {title: 'Operation', class: 'text minor'}, {title: 'Mostly from'},
    ];
  }

  /** Shortens long comments; the card of the place shows all of it. */
  const clamped = (text) => (text ? el('span', {class: 'clamp', title: text}, text) : '\u2013');

  function cells(row, report, units, go) {
    const line = jump(`${row.line}`, 'place', go, `Line ${row.line}: show it in all views`);
    return [
      line, units.number(row.before_mm), ...(report.summary.after ? [units.number(row.after_mm)] : []),
      known(row.force_N) ? `${fixed(row.force_N, 0)} N` : '\u2013', words.toolName(row.tool), clamped(row.operation),
      words.causeInShort(row.causes) || '\u2013',
    ];
  }

  /** Whole rows are targets for the mouse; their links are targets for the keyboard. */
  function clickable(node, run, rows, go) {
    node.querySelectorAll('tbody tr').forEach((tr, i) => {
      tr.dataset.line = rows[i].line;
      tr.dataset.run = run;
      tr.addEventListener('click', (event) => {
        if (!event.target.closest('a')) go(rows[i]);
      });
    });
    return node;
  }

  function tableOf(run, index, context) {
    const {report} = run;
    const {units} = context;
    if (report.worst.length === 0) return el('p', null, 'No feed move was solved.');
    const go = (row) => context.goToRow(index, row);
    const rows = report.worst.map((row) => cells(row, report, units, () => go(row)));
    const order = report.summary.after ? ', the largest after correction first' : '';
    const caption = words.ofRun(run, `Largest deviation of each block, in ${units.words}${order}`);
    return clickable(table(caption, columnsOf(report), rows), index, report.worst, go);
  }

  /** Tables of the blocks with the largest deviations. A click on a row shows the place in all views. */
  function render(context) {
    return el('div', {class: 'stack'}, context.runs.map((run, i) => tableOf(run, i, context)));
  }

  /** Marks the row of a run's line as the selected one. */
  function mark(body, run, line) {
    for (const tr of body.querySelectorAll('tbody tr')) {
      const chosen = tr.dataset.line === String(line) && tr.dataset.run === String(run);
      tr.classList.toggle('chosen', chosen);
      tr.querySelector('a').setAttribute('aria-current', String(chosen));
    }
  }

  counterflex.worst = {render, stretchOf, mark};
})();
