'use strict';
(() => {
  const {el, table, textColumn, numberColumn, jump} = counterflex.dom;
  const {known, percent} = counterflex.units;
  const words = counterflex.words;

  const unknown = '\u2013';
  const value = (s, key, axis) => (!s ? null : axis === undefined ? s[key] : s[key][axis]);

  /** [label, key of the statistics, axis]; the unit of angles is fixed. */
  const statistics = [
    ['Largest', 'max_mm'], ['95 % of the length is below', 'p95_mm'], ['Root mean square', 'rms_mm'],
    ['Mean', 'mean_mm'],
    ['Largest in x', 'max_axis_mm', 0], ['Largest in y', 'max_axis_mm', 1], ['Largest in z', 'max_axis_mm', 2],
    ['Largest across the path', 'max_across_mm'], ['Largest along the tool axis', 'max_tool_axis_mm'],
    ['Along the path (matters at ends)', 'max_along_mm'], ['Largest rotation, in degrees', 'max_rotation_deg'],
  ];

  /** Of the bands of a machine with [uncertainty]. */
  const bandStatistics = [['Band of the largest, k = 2: \u00b1', 'at_max_mm'], ['Widest band', 'largest_mm'],
    ['Root mean square of the bands', 'rms_mm']];

  const show = (key, x, units) => (!known(x) ? unknown : key.endsWith('_deg') ? x.toFixed(4) : units.number(x));
  function signed(key, x, units) {
    const text = show(key, x, units);
    return x > 0 && Number(text) !== 0 ? `+${text}` : text;
  }

  /** The cells of one number: for each run, and for two runs the difference B - A. */
  function across(values, key, units) {
    const cells = values.map((x) => show(key, x, units));
    if (values.length === 2) cells.push(values.every(known) ? signed(key, values[1] - values[0], units) : unknown);
    return cells;
  }

  /** Their columns. */
  function acrossTitles(runs, what) {
    if (runs.length === 1) return [numberColumn(what)];
    return [...runs.map((run) => numberColumn(`${what} ${run.letter}`)), numberColumn('B \u2212 A')];
  }

  const beforeAndAfter = (runs, corrected) =>
    [...acrossTitles(runs, 'Before'), ...(corrected ? acrossTitles(runs, 'After') : [])];

  /** For runs without a stated datum: the part of the deviation before that touching off would remove, and the rest. */
  function shiftRows(runs, units, corrected) {
    const shifts = runs.map((run) => run.report.summary.common_shift);
    const blank = corrected ? acrossTitles(runs, '').map(() => '') : [];
    const row = (what, get) => [what, ...across(shifts.map((s) => (s ? get(s) : null)), 'max_mm', units), ...blank];
    return [row('Common shift (datum not stated)', (s) => s.max_mm),
      row('Largest without the common shift', (s) => s.rest.max_mm)];
  }

  const toolParts = [['tip', 'tip_mm'], ['rim', 'rim_mm'], ['flank', 'flank_mm'], ['tilt, in degrees', 'tilt_deg']];

  /** The deviation at rim and flank of each tilted tool. */
  function toolDeviations(context, index) {
    const {units} = context;
    const run = context.runs[index];
    const tools = run.report.summary.tool_deviations || [];
    if (tools.length === 0) return null;
    const corrected = tools.some((tool) => tool.after);
    const columns = [textColumn('Tool'), {title: 'Where'}, numberColumn('Before'), ...(corrected ? [numberColumn('After')] : [])];
    const has = {rim_mm: 'diameter_mm', flank_mm: 'flute_mm'};  // the size of the tool that a part needs
    const rows = tools.flatMap((tool) => toolParts.filter(([, key]) => !has[key] || known(tool[has[key]])).map(([part, key]) => {
      return [words.toolAndSize(tool, units), part, show(key, value(tool.before, key), units),
        ...(corrected ? [show(key, value(tool.after, key), units)] : [])];
    }));
    return table(words.ofRun(run, `Largest over the tool, in ${units.words}`), columns, rows);
  }

  /** Statistics of the deviation before and after. */
  function numbers(context) {
    const {runs, units} = context;
    const before = runs.map((run) => run.report.summary.before), after = runs.map((run) => run.report.summary.after);
    if (!before.some(Boolean)) return null;
    const corrected = after.some(Boolean);
    const columns = [{title: `In ${units.words}`}, ...beforeAndAfter(runs, corrected)];
    const rows = statistics.map(([what, key, axis]) => {
      const cells = (list) => across(list.map((s) => value(s, key, axis)), key, units);
      return [what, ...cells(before), ...(corrected ? cells(after) : [])];
    });
    const bandsOf = (list) => list.map((s) => (s && s.band) || null);
    if (bandsOf(before).some(Boolean))
      for (const [what, key] of bandStatistics) {
        const cells = (list) => across(bandsOf(list).map((s) => value(s, key)), key, units);
        rows.push([what, ...cells(before), ...(corrected ? cells(after) : [])]);
      }
    const link = (s, run, quantity) => counterflex.lines.link(context, run, s ? s.max_line : 0, {quantity});
    const line = (list, quantity) => [...list.map((s, run) => link(s, run, quantity)), ...(runs.length === 2 ? [''] : [])];
    rows.splice(1, 0, ['  in program line', ...line(before, 'before_mm'), ...(corrected ? line(after, 'after_mm') : [])]);
    if (before.some((_, r) => runs[r].report.summary.common_shift)) rows.splice(2, 0, ...shiftRows(runs, units, corrected));
    const lengths = runs.map(({report}) => (known(report.summary.path_mm) ? units.length(report.summary.path_mm) : unknown)).join(' and ');
    return [table('Deviation of the tool tip', columns, rows), runs.map((_, run) => toolDeviations(context, run)),
      el('p', {class: 'note'}, `Over ${lengths} of feed moves, weighted by length. `,
          corrected ? 'After: model residual, the deviation that the model leaves. It is not the accuracy of the part.' : '')];
  }

  /** One line; the title has all of a long comment. */
  const nameCell = (title, link) => Object.assign(link, {title, className: 'clamp'});

  const nameOf = (operation, isOnly) => operation.operation || (isOnly ? '(whole program)' : '(no name)');

  /** The runs' operations aligned by tool and name: [{operation, of: [operation or undefined, ...]}]. */
  function aligned(runs) {
    const rows = [];
    runs.forEach((run, r) => {
      for (const operation of run.report.operations || []) {
        const same = (other) => other.tool === operation.tool && other.operation === operation.operation;
        let row = rows.find((one) => !one.of[r] && same(one.operation));
        if (!row) rows.push(row = {operation, of: []});
        row.of[r] = operation;
      }
    });
    return rows;
  }

  function operationRow({operation, of}, context, corrected, isOnly) {
    const {runs, units} = context;
    const run = of.findIndex(Boolean);
    const go = () => context.goToOperation(run, runs[run].report.operations.indexOf(of[run]));
    const text = nameOf(operation, isOnly);
    const name = nameCell(text, jump(text, 'curves', go, `${text}: show it in the curves`));
    const largest = (key) => across(runs.map((_, r) => value(of[r] && of[r][key], 'max_mm')), 'max_mm', units);
    const shares = runs.map((_, r) => (of[r] ? percent(of[r].corrected_percent) : unknown)).join(' / ');
    const lines = `${operation.first_line}\u2013${operation.last_line}`;
    return [name, words.toolName(operation.tool), lines, String(operation.moves), units.lengthNumber(operation.length_mm),
      ...(corrected ? [shares] : []), ...largest('before'), ...(corrected ? largest('after') : [])];
  }

  /** Each tool and operation with its largest deviations. A click on one zooms the curves to it. */
  function operations(context) {
    const {runs, units} = context;
    const rows = aligned(runs);
    if (rows.length === 0) return null;
    const corrected = runs.some((run) => run.report.summary.after);
    const columns = [textColumn('Operation'), {title: 'Tool', class: 'minor'}, {title: 'Lines', class: 'lines'},
      numberColumn('Moves', 'minor'), numberColumn(`Length, ${units.lengthLabel}`, 'minor'), ...(corrected ? [numberColumn('Corrected')] : []),
      ...beforeAndAfter(runs, corrected)];
    const cells = rows.map((row) => operationRow(row, context, corrected, rows.length === 1));
    return table(`Largest deviation, in ${units.words}`, columns, cells);
  }

  /** Their labels, and the quantity of the curves that is largest at their places. */
  const otherForces = [['force_plus_30', 'Force 30 % higher (wear, override)', 'load_mm'],
    ['force_minus_30', 'Force 30 % lower', 'load_mm'],
    ['without_force', 'Force missing (dry run, spring pass, broken insert)', 'air_mm']];

  function sensitivityRow(what, s, units, link) {
    if (!s) return [what, 'no stable equilibrium', unknown, unknown, unknown];
    return [what, units.number(s.max_mm), link(s.max_line), units.number(s.p95_mm), units.number(s.max_across_mm)];
  }

  function sensitivityOf(context, index) {
    const {units} = context;
    const run = context.runs[index];
    const {sensitivity, after, before} = run.report.summary;
    if (!sensitivity) return null;
    const columns = [{title: `In ${units.words}`},
      ...['Largest', 'Line', '95 % below', 'Across the path'].map((title) => numberColumn(title))];
    const link = (line, quantity) => counterflex.lines.link(context, index, line, {quantity});
    const cases = [['Force as given', after || before, after ? 'after_mm' : 'before_mm'],
      ...otherForces.map(([key, what, quantity]) => [what, sensitivity[key], quantity])];
    const rows = cases.map(([what, s, quantity]) => sensitivityRow(what, s, units, (line) => link(line, quantity)));
    return table(words.ofRun(run, `Deviation of the ${after ? 'corrected' : 'original'} program`), columns, rows);
  }

  /** The deviation of the program under more, less or no force. */
  function sensitivity(context) {
    const tables = context.runs.map((_, i) => sensitivityOf(context, i)).filter(Boolean);
    return tables.length > 0 ? el('div', {class: 'runs'}, tables) : null;
  }

  counterflex.tables = {numbers, operations, sensitivity, aligned};
})();
