'use strict';
(() => {
  const {el, bar, table, textColumn, radios} = counterflex.dom;
  const {known} = counterflex.units;
  const {series: tables, words} = counterflex;

  /** Kinds of loads: name in the data, words, unit; null: the unit of deviations. */
  const quantities = [
    ['moment_max_Nm', 'Moment at the end', 'N m'], ['spring_translation_max_mm', 'Spring deflection', null],
    ['spring_rotation_max_deg', 'Spring rotation', 'deg'], ['spring_force_max_N', 'Spring force', 'N'],
    ['spring_torque_max_Nm', 'Spring torque', 'N m'], ['group_moment_max_Nm', 'Group moment', 'N m'],
    ['passive_change_max_deg', "Passive joint's change", 'deg'],
  ];

  const least = 1e-6;  // of a load that counts, in any of its units: smaller ones are rounding errors of the solver

  const counts = (load) => Boolean(load) && load.largest > least;

  const colours = ['--x', '--y', '--z', '--gravity', '--sum', '--discrepancy'];
  const lineDashes = [null, [8, 4], [2, 3], [10, 3, 2, 3]];

  function textOf(value, unit, units) {
    if (!known(value)) return '\u2013';
    return unit ? `${Number(value.toPrecision(4))} ${unit}` : units.format(value);
  }

  const exceeds = ({largest, limit}) => known(limit) && largest > limit;

  /** Share of its limit that a load uses, as a bar and in words. */
  function use(load) {
    const share = load.largest / load.limit;
    const drawing = bar(share, exceeds(load) ? 'over' : 'within');
    return el('span', {class: 'use'}, drawing, `${(100 * share).toFixed(0)} %${exceeds(load) ? ': above the limit' : ''}`);
  }

  /** The place of a chain's largest load in a run: {s_mm}, or {} if unknown. */
  function placeOfLargest(run, chain, name) {
    const values = run.loads && (run.loads.chains.find((one) => one.name === chain.name) || {})[name];
    if (!values) return {};
    const size = (i) => (known(values[i]) ? values[i] : -Infinity);
    const best = values.reduce((b, _, i) => (size(i) > size(b) ? i : b), 0);
    return {s_mm: run.loads.s_mm[best]};
  }

  const hasLimit = (chain) => quantities.some(([name]) => chain[name] && known(chain[name].limit));

  /** "23.3 N m, line 9", and the use of the limit. */
  function cellOf(chain, name, unit, context, index) {
    const load = chain[name];
    if (!counts(load)) return '\u2013';
    const line = counterflex.lines.link(context, index, load.line, placeOfLargest(context.runs[index], chain, name));
    const limit = known(load.limit) ? el('div', null, `limit ${textOf(load.limit, unit, context.units)} `, use(load)) : null;
    return [el('span', {class: exceeds(load) ? 'over' : null}, textOf(load.largest, unit, context.units)), ', line ', line, limit];
  }

  /** The largest loads: a row for each kind, those with a limit first; a column for each chain. */
  function tableOf(context, index) {
    const run = context.runs[index];
    const {loads} = run.report;
    if (!loads) return null;
    const {chains} = loads;
    const limited = (name) => chains.some((chain) => chain[name] && known(chain[name].limit));
    const present = quantities.filter(([name]) => chains.some((chain) => counts(chain[name])))
        .sort(([a], [b]) => limited(b) - limited(a));
    if (present.length === 0) return null;
    const columns = [{title: 'Load'}, ...chains.map((chain) => textColumn(chain.name))];
    const rows = present.map(([name, what, unit]) => [what, ...chains.map((chain) => cellOf(chain, name, unit, context, index))]);
    const caption = [`Largest loads of each chain at ${loads.places} places of the path`,
      loads.unsolved > 0 && `unknown at ${loads.unsolved} more`,
      !chains.some(hasLimit) && 'the machine file gives no limits'].filter(Boolean).join('; ');
    return table(words.ofRun(run, caption), columns, rows);
  }

  /** Whether a run has a load that counts. */
  const exist = ({runs}) => runs.some(({report}) => report.loads &&
    report.loads.chains.some((chain) => quantities.some(([name]) => counts(chain[name]))));

  const render = (context) => el('div', {class: 'runs'}, context.runs.map((_, i) => tableOf(context, i)));

  function seriesOf(context, points, name, scale) {
    return context.runs.flatMap((run, r) => (!run.loads ? [] : run.loads.chains.map((chain, c) => ({
      label: `${chain.name}${run.letter ? ` ${run.letter}` : ''}`, colour: colours[c % colours.length],
      dash: run.letter ? lineDashes[r] : lineDashes[c % lineDashes.length], run: r, points: points[r],
      values: chain[name].map((v) => (v === null ? null : v * scale)),
    }))));
  }

  /** Limits of the chains, each value once. */
  function levels(context, name, scale) {
    const limits = new Map();
    for (const run of context.runs)
      for (const chain of (run.report.loads && run.report.loads.chains) || []) {
        const limit = chain[name] && chain[name].limit;
        if (known(limit)) limits.set(limit, [...(limits.get(limit) || []), chain.name]);
      }
    const label = (names) => `limit of ${[...new Set(names)].join(', ')}`;
    return [...limits].map(([limit, names]) => ({value: limit * scale, label: label(names)}));
  }

  /** The kinds of loads that some chain has. */
  function present(context) {
    const chains = context.runs.flatMap((run) => (run.loads ? run.loads.chains : []));
    return quantities.filter(([name]) => chains.some((chain) => (chain[name] || []).some((v) => v > least)));
  }

  function describe(context, group, points, state) {
    const [name, what, unit] = quantities.find(([n]) => n === state.name);
    const scale = unit ? 1 : context.units.scale;
    const series = seriesOf(context, points, name, scale);
    return {
      title: `${what} of each chain, in ${unit || context.units.words}`,
      axis: `${what}, ${unit || context.units.label}`,
      series,
      ...tables.tabulate(series, group.total, context.units.lengthScale),
      levels: levels(context, name, scale), text: (v) => textOf(v / scale, unit, context.units),
      lineOf: ({line}) => (line > 0 ? line : ''),
      placeText: ({line}) => (line > 0 ? `line ${line}` : 'no line'),
      select: ({run, stretch}) => stretch >= 0 && context.selection.set(run, stretch),
    };
  }

  /** Loads over the path; null if they were not computed. */
  function plots(context, group) {
    const choices = present(context);
    if (choices.length === 0) return null;
    const state = {name: choices[0][0]};
    const points = context.runs.map((run) => (run.loads ? tables.along(run, run.loads) : []));
    const plot = counterflex.plot.create(context, group, () => describe(context, group, points, state), 'loads');
    const choice = radios('Show', 'load', choices, state.name, (name) => {
      state.name = name;
      plot.refresh();
    });
    return {plots: [plot], content: [el('div', {class: 'controls'}, choice), plot.node]};
  }

  counterflex.loads = {render, exist, plots, placeOfLargest};
})();
