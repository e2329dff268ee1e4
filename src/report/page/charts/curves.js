'use strict';
(() => {
  const {el, fill, radios} = counterflex.dom;
  const {series: tables} = counterflex;

  /** Components of a deviation: [part of the quantity's name, label]. */
  const components = [['', 'total'], ['x_', 'x'], ['y_', 'y'], ['z_', 'z'], ['along_', 'along the path'],
    ['across_', 'across the path'], ['tool_axis_', 'along the tool axis'], ['rotation_', 'rotation']];
  const axes = components.slice(0, 4);

  const quantityName = (base, part) => (part === 'rotation_' ? `${base}_rotation_deg` : `${base}_${part}mm`);

  const dashes = [null, [7, 4]];

  /** Points of each run's curves, computed once for all its quantities. */
  function pointsOf(context) {
    return context.runs.map((run) => (run.curves ? tables.places(run.curves) : []));
  }

  /** Series of quantities: `wanted` are {name, label, colour, dash, width}; with two runs there are two of each. */
  function seriesOf(context, points, wanted, scale) {
    const result = [];
    context.runs.forEach((run, r) => {
      for (const w of wanted) {
        const quantity = run.curves && run.curves.quantities[w.name];
        if (!quantity) continue;
        const label = run.letter ? `${w.label} ${run.letter}` : w.label;
        const dash = run.letter ? dashes[r] : w.dash;
        const colour = run.letter && w.colours ? w.colours[r] : w.colour;
        const values = tables.valuesAt(points[r], quantity, scale);
        result.push({label, dash, colour, width: w.width, run: r, points: points[r], values});
      }
    });
    return result;
  }

  /** The common parts of all plots of quantities along the path. */
  function describe(context, group, points, wanted, scale, rest) {
    const list = seriesOf(context, points, wanted, scale);
    return {
      series: list,
      ...tables.tabulate(list, group.total, context.units.lengthScale),
      placeText: ({run, stretch}) => (stretch < 0 ? 'no line' : counterflex.lines.words(context.runs[run].curves, stretch)),
      lineOf: ({run, stretch}) => (stretch < 0 ? '' : context.runs[run].curves.first_line[stretch]),
      select: ({run, stretch}) => stretch >= 0 && context.selection.set(run, stretch),
      ...rest,
    };
  }

  const labelOf = (part) => components.find(([p]) => p === part)[1];
  const unitOf = (part, units) => (part === 'rotation_' ? 'degrees' : units.words);
  const scaleOf = (part, units) => (part === 'rotation_' ? 1 : units.scale);

  /** Deviations as text; the values are already in the displayed unit. */
  const textIn = (part, units) => (v) => (part === 'rotation_' ? `${v.toFixed(4)} deg` : units.format(v / units.scale));

  /**
   * Tolerances of the runs that have a residual, each once: [{mm, label}]. On a page of two runs the label has the letters
   * of the runs with this tolerance.
   */
  function tolerances({runs, units}) {
    const judged = runs.filter(({report}) => report.summary.after).map(({letter, report}) => ({letter, mm: counterflex.summary.tolerance(report)}));
    const sizes = [...new Set(judged.map(({mm}) => mm))].filter((mm) => mm < Infinity);
    return sizes.map((mm) => {
      const letters = judged.filter((run) => run.mm === mm && run.letter).map(({letter}) => letter);
      return {mm, label: `${counterflex.words.tolerance(letters)} ${units.format(mm)}`};
    });
  }

  /** The tolerances as levels on a scale of signed values or of sizes. */
  function toleranceLevels(context, part, log) {
    if (part === 'rotation_') return [];
    const signed = ['x_', 'y_', 'z_'].includes(part) && !log;
    return tolerances(context).flatMap(({mm, label}) => {
      const value = mm * context.units.scale;
      return signed ? [{value, label}, {value: -value, label: ''}] : [{value, label}];
    });
  }

  /** The tolerance in the title of a plot: its line may be outside the plot. */
  function toleranceText(context, part) {
    return toleranceLevels(context, part, true).map(({label}) => `; ${label}`).join('');
  }

  /**
   * The contents of the plot of the deviation `base`. `look`: {title, colour, colours: of two runs, levels: whether the
   * tolerance is drawn}.
   */
  function deviation(context, group, points, state, base, look) {
    const {units} = context;
    return () => {
      const {part, log} = state;
      const wanted = [{name: quantityName(base, part), label: base, colour: look.colour, colours: look.colours},
        ...(part === '' ? [{name: `${base}_band_mm`, label: 'its band, k = 2', colour: '--ink', dash: [3, 3]}] : [])];
      const tolerance = look.levels ? toleranceText(context, part) : '';
      const title = `${look.title}: ${labelOf(part)}, in ${unitOf(part, units)}${tolerance}`;
      const levels = look.levels ? toleranceLevels(context, part, log) : [];
      const axis = `${part === 'rotation_' ? 'Rotation' : 'Deviation'}, ${part === 'rotation_' ? 'deg' : units.label}`;
      const rest = {title, axis, log, text: textIn(part, units), levels};
      return describe(context, group, points, wanted, scaleOf(part, units), rest);
    };
  }

  const has = (context, name) => context.runs.some((run) => run.curves && run.curves.quantities[name]);

  function logBox(state) {
    return el('label', {class: 'choice'}, el('input', {type: 'checkbox', change: (event) => {
      state.log = event.target.checked;
      state.plots.forEach((plot) => plot.refresh());
    }}), el('span', null, 'logarithmic'));
  }

  function componentChoice(context, state, name, choices) {
    return radios('Show', name, choices, state.part, (part) => {
      state.part = part;
      state.plots.forEach((plot) => plot.refresh());
    });
  }

  const help = 'Drag: zoom. Shift and drag: move. Double click: show all. Click: show the place in space.';

  /** A note if not all marks are drawn. */
  function thinnedNote({runs}, {marks}) {
    return marks.map(({thinned: {rapids, steps}}, i) => {
      const thinned = [rapids && `${rapids} rapids`, steps && `${steps} steps of the force`].filter(Boolean);
      const text = `One of every ${thinned.join(' and one of every ')} is marked.`;
      return thinned.length > 0 ? el('p', {class: 'note'}, counterflex.words.ofRun(runs[i], text)) : null;
    });
  }

  /** Notes on curves of merged waypoints, one for each run that has them. */
  function mergedNotes({runs}, end) {
    const points = ({curves}) => (curves ? curves.waypoints_per_stretch : 1);
    return runs.filter((run) => points(run) > 1).map((run) => el('p', {class: 'note'},
        counterflex.words.ofRun(run, `Each stretch of ${points(run)} points is drawn with its least and its largest value${end}.`)));
  }

  const looks = {
    before: {title: 'Before', colour: '--before', colours: ['--before', '--other-run']},
    after: {title: 'After (model residual)', colour: '--after', colours: ['--after', '--other-run'], levels: true},
  };

  /** Before and after, each on its own scale. */
  function deviations(context, group, points) {
    const state = {part: '', log: false, plots: []};
    for (const [base, look] of Object.entries(looks)) {
      if (!has(context, `${base}_mm`)) continue;
      const content = deviation(context, group, points, state, base, look);
      state.plots.push(counterflex.plot.create(context, group, content, base));
    }
    const present = components.filter(([part]) => has(context, quantityName('before', part)));
    const choice = componentChoice(context, state, 'component', present);
    const controls = el('div', {class: 'controls'}, choice, logBox(state));
    return {plots: state.plots, content: [controls, counterflex.plotGroup.controls(context, group),
      state.plots.map((plot) => plot.node), el('p', {class: 'note help'}, help), mergedNotes(context, '; all peaks are visible'),
      thinnedNote(context, group)]};
  }

  const causeDashes = {fixture: [12, 3], gravity: [10, 3, 2, 3], preloads: [6, 2, 2, 2]};

  const sourceSeries = (part) => [
    {name: quantityName('before', part), label: 'all together', colour: '--ink', width: 2.5},
    ...counterflex.words.causes.map(({base}) => (
      {name: quantityName(base, part), label: base, colour: `--${base}`, dash: causeDashes[base]})),
    {name: quantityName('superposition', part), label: 'their sum', colour: '--sum', dash: [8, 4]},
    {name: quantityName('discrepancy', part), label: 'discrepancy', colour: '--discrepancy', dash: [2, 3]},
  ];

  function largestOf(run, name) {
    const {least, largest} = run.curves.quantities[name];
    let result = 0;
    for (let i = 0; i < largest.length; ++i)
      for (const v of [least[i], largest[i]]) if (Math.abs(v) > result) result = Math.abs(v);
    return result;
  }

  /** "at most 1.3 \u00b5m"; "less than 0.01 \u00b5m" for a value without shown digits. */
  const atMost = (mm, units) => (Number(units.number(mm)) === 0 ? `less than ${units.format(mm || 1e-9).replace('0 ', '1 ')}`
    : `at most ${units.format(mm)}`);

  /**
   * The difference between the sum of the parts and all together, in a sentence. A small one hides one curve below the
   * other.
   */
  function discrepancySentence(context) {
    const known = (run) => Boolean(run.curves && run.curves.quantities.discrepancy_mm);
    const of = (run) => (known(run) ? atMost(largestOf(run, 'discrepancy_mm'), context.units) : 'unknown');
    const values = context.runs.map((run) => (run.letter ? `${of(run)} in ${run.letter}` : of(run))).join(', ');
    return `All causes together differ from the sum of the parts by ${values} (discrepancy).`;
  }

  /** The causes, their sum and all together: as in Figs 7 and 8 of the paper. */
  function sources(context, group, points) {
    if (!has(context, 'superposition_mm')) return null;
    const state = {part: '', log: false, plots: []};
    const note = el('p', {class: 'note'});
    const update = () => fill(note, discrepancySentence(context));
    const content = () => describe(context, group, points, sourceSeries(state.part), context.units.scale, {
      title: `Causes of the deviation before: ${labelOf(state.part)}, in ${context.units.words}`,
      axis: `Deviation, ${context.units.label}`, log: state.log, text: textIn('', context.units)});
    state.plots.push(counterflex.plot.create(context, group, content, 'sources'));
    context.units.subscribe(update);
    update();
    const choice = componentChoice(context, state, 'source-component', axes);
    const controls = el('div', {class: 'controls'}, choice, logBox(state));
    return {plots: state.plots, content: [controls, state.plots[0].node, note,
      mergedNotes(context, ' of each cause. These may be at different points, so the drawn causes need not add up')]};
  }

  const forceSeries = [
    {name: 'force_N', label: 'total', colour: '--ink', width: 2.5},
    {name: 'force_x_N', label: 'x', colour: '--x'},
    {name: 'force_y_N', label: 'y', colour: '--y', dash: [8, 4]},
    {name: 'force_z_N', label: 'z', colour: '--z', dash: [2, 3]},
  ];

  /** The cutting force on the tool. */
  function force(context, group, points) {
    const acts = context.runs.some((run) => run.report.forces.largest_N > 0);
    if (!has(context, 'force_N') || !acts) return null;
    const content = () => describe(context, group, points, forceSeries, 1, {
      title: 'Cutting force on the tool, machine axes, in N', axis: 'Force, N', text: (v) => `${v.toFixed(1)} N`});
    const plots = [counterflex.plot.create(context, group, content, 'force')];
    return {plots, content: plots[0].node};
  }

  counterflex.curves = {tolerances, pointsOf, deviations, sources, force};
})();
