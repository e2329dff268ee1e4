'use strict';
/** The axes of the machine against their limits, and its distance from singular poses, along the path. */
(() => {
  const {el, table, numberColumn, radios} = counterflex.dom;
  const {known} = counterflex.units;
  const {series: tables, words} = counterflex;

  const near = 0.05;  // share of the travel: a smaller margin is marked
  const colours = ['--x', '--y', '--z', '--step', '--sum', '--discrepancy'];
  const dashes = [null, [8, 4], [2, 3], [10, 3, 2, 3]];

  const shortName = ({name}) => name.replace(/^(axis|chain) /, '');
  const isLimited = ({min, max}) => known(min) && known(max) && max > min;
  const inUnit = (value, unit) => (known(value) ? `${Number(value.toFixed(unit === 'mm' ? 1 : 2))} ${unit}` : '\u2013');

  /** The least distance of an axis from a limit, rapids included: {margin, line, share of the travel or NaN}; null without a limit. */
  function leastMargin({least_margin: margin, margin_line: line, min, max}) {
    return known(margin) ? {margin, line, share: isLimited({min, max}) ? margin / (max - min) : NaN} : null;
  }

  /** 'over': outside the travel; 'near': close to a limit; '' else. */
  function stateOf(axis) {
    const least = leastMargin(axis);
    if (!least || least.share >= near) return '';
    return least.margin < 0 ? 'over' : least.share < near ? 'near' : '';
  }

  const remarks = {over: ' (outside its travel)', near: ' (near its limit)', '': ''};

  /** Values as a list, null where they are unknown: the line is drawn through. */
  const listed = (values, valueOf = (v) => v) => Array.from(values, (v) => (Number.isNaN(v) ? null : valueOf(v)));

  /** The look of curve `i` of a run: with two runs the dash is that of the run. */
  const lookOf = (run, r, i) => ({colour: colours[i % colours.length], run: r,
    dash: run.letter ? dashes[r] : i < colours.length ? null : dashes[1]});

  const labelOf = (run, text) => (run.letter ? `${text} ${run.letter}` : text);

  /** All axes with two limits as shares of their travel, in %. */
  function shares(context, points) {
    return context.runs.flatMap((run, r) => (!run.machine ? [] : run.machine.axes.flatMap((axis, i) => {
      if (!isLimited(axis)) return [];
      const {min, max, unit} = axis;
      return [{...lookOf(run, r, i), label: labelOf(run, shortName(axis) + remarks[stateOf(axis)]), points: points[r],
        width: stateOf(axis) ? 3.5 : 2, values: listed(axis.values, (v) => (100 * (v - min)) / (max - min)),
        text: (v) => inUnit(min + (v / 100) * (max - min), unit)}];
    })));
  }

  /** One axis in its unit. */
  function single(context, points, name) {
    return context.runs.flatMap((run, r) => (!run.machine ? [] : run.machine.axes.flatMap((axis, i) =>
      (axis.name !== name ? [] : [{...lookOf(run, r, i), label: labelOf(run, shortName(axis)), points: points[r], values: listed(axis.values)}]))));
  }

  const axesOf = (context) => context.runs.flatMap((run) => (run.machine ? run.machine.axes : []));

  /** The limits of an axis, each once. */
  function limitsOf(context, name) {
    const limits = new Map();
    for (const {name: other, min, max, unit} of axesOf(context))
      if (other === name) for (const v of [min, max]) if (known(v)) limits.set(v, `limit ${inUnit(v, unit)}`);
    return [...limits].map(([value, label]) => ({value, label}));
  }

  /** What the plots of this section have in common. */
  function contentOf(context, group, series, rest) {
    return {
      series,
      ...tables.tabulate(series, group.total, context.units.lengthScale),
      lineOf: ({line}) => (line > 0 ? line : ''),
      placeText: ({line}) => (line > 0 ? `line ${line}` : 'no line'),
      select: ({run, stretch}) => stretch >= 0 && context.selection.set(run, stretch),
      ...rest,
    };
  }

  function describeAxes(context, group, points, state) {
    if (state.name === '')
      return contentOf(context, group, shares(context, points), {
        title: 'Axes as the control shows them, in % of their travel', axis: 'Share of the travel, %', text: (v) => `${v.toFixed(1)} %`,
        levels: [{value: 0, label: 'lower limit', held: true}, {value: 100, label: 'upper limit', held: true}]});
    const {unit} = axesOf(context).find(({name}) => name === state.name);
    return contentOf(context, group, single(context, points, state.name), {
      title: `${state.name} as the control shows it, in ${unit}`, axis: `${shortName(state)}, ${unit}`,
      text: (v) => inUnit(v, unit), levels: limitsOf(context, state.name)});
  }

  /** The plot of the axes: all as shares of their travel, or one in its unit. */
  function axesPlot(context, group, points) {
    const names = [...new Map(axesOf(context).map((axis) => [axis.name, shortName(axis)]))];
    const choices = [...(axesOf(context).some(isLimited) ? [['', 'all']] : []), ...names];
    if (choices.length === 0) return null;
    const state = {name: choices[0][0]};
    const plot = counterflex.plot.create(context, group, () => describeAxes(context, group, points, state), 'axes');
    const choice = radios('Show', 'axis', choices, state.name, (name) => {
      state.name = name;
      plot.refresh();
    });
    return {plot, content: [el('div', {class: 'controls'}, choice), plot.node]};
  }

  /** Distances to singular poses: the margins of arms in degrees. */
  function marginSeries(context, points) {
    return context.runs.flatMap((run, r) => (!run.machine ? [] : run.machine.margins.map(({what, values}, i) =>
      ({...lookOf(run, r, i), label: labelOf(run, what.split(':')[0]), points: points[r], values: listed(values)}))));
  }

  function conditioningSeries(context, points) {
    return context.runs.flatMap((run, r) => (!run.machine || !run.machine.conditioning ? []
      : [{...lookOf(run, r, 2), label: labelOf(run, 'conditioning'), points: points[r], values: listed(run.machine.conditioning)}]));
  }

  /** The poses that margins are distances to, each once. */
  const posesOf = ({runs}) => [...new Set(runs.flatMap(({machine}) => (machine ? machine.margins.map(({what}) => what) : [])))];

  function marginsPlot(context, group, points) {
    if (posesOf(context).length === 0) return null;
    const limits = [...new Set(context.runs.map(({machine}) => machine && machine.refused_below_deg).filter(known))];
    const levels = limits.map((value) => ({value, label: `refused below ${value} deg`, held: true}));
    const plot = counterflex.plot.create(context, group, () => contentOf(context, group, marginSeries(context, points), {
      title: 'Distance from singular poses, in degrees', axis: 'Distance, deg', text: (v) => `${v.toFixed(2)} deg`, levels}), 'margins');
    return {plot, content: [plot.node, el('p', {class: 'note'}, `Singular poses: ${posesOf(context).join('; ')}.`)]};
  }

  function conditioningPlot(context, group, points) {
    if (!context.runs.some(({machine}) => machine && machine.conditioning)) return null;
    const plot = counterflex.plot.create(context, group, () => contentOf(context, group, conditioningSeries(context, points), {
      title: 'Distance from singular poses: conditioning', axis: 'Conditioning', text: (v) => v.toFixed(4)}), 'conditioning');
    const note = 'Conditioning is the reciprocal condition number of the matrix from the actuators to the tip, with lengths in units of the '
      + 'size of the machine. 1: the tip moves in all directions alike. 0: the machine is singular.';
    return {plot, content: [plot.node, el('p', {class: 'note'}, note)]};
  }

  function travelText({min, max, unit}) {
    if (!known(min) && !known(max)) return 'no limits';
    if (!known(min)) return `up to ${inUnit(max, unit)}`;
    return known(max) ? `${Number(min.toFixed(3))} to ${inUnit(max, unit)}` : `from ${inUnit(min, unit)}`;
  }

  function rowOf(context, r, axis) {
    const {unit} = axis, least = leastMargin(axis), state = stateOf(axis);
    const row = [axis.name, inUnit(axis.least, unit), inUnit(axis.largest, unit), travelText(axis),
      least ? [inUnit(least.margin, unit), remarks[state], ', line ', counterflex.lines.link(context, r, least.line)] : '\u2013'];
    if (state) row.mark = state === 'over' ? 'exceeded' : 'near';
    return row;
  }

  /** "External axis E1: 2350 mm along the whole program." */
  const constantText = ({name, unit, value}) => el('p', {class: 'note'}, `External axis ${name}: ${inUnit(value, unit)} along the whole program.`);

  function tableOf(context, r) {
    const run = context.runs[r];
    if (!run.machine) return null;
    const {axes, constant, s_mm: s} = run.machine;
    const caption = words.ofRun(run, `Axes as the control shows them, over all solved targets, rapids included; the curves are at ${words.counted(s.length, 'place')} of feed moves`);
    const columns = [{title: 'Axis'}, numberColumn('Least', 'minor'), numberColumn('Largest', 'minor'), numberColumn('Travel'), numberColumn('Least margin')];
    return [table(caption, columns, axes.map((axis) => rowOf(context, r, axis))), constant.map(constantText)];
  }

  const render = (context) => el('div', {class: 'runs'}, context.runs.map((run, r) => run.machine && el('div', {class: 'run'}, tableOf(context, r))));

  /** The plots of the section; null without a machine. */
  function plots(context, group) {
    const points = context.runs.map((run) => (run.machine ? tables.along(run, run.machine) : []));
    const made = [axesPlot, marginsPlot, conditioningPlot].map((make) => make(context, group, points)).filter(Boolean);
    return made.length === 0 ? null : {plots: made.map(({plot}) => plot), content: made.map(({content}) => content)};
  }

  counterflex.axes = {leastMargin, stateOf, plots, render};
})();
