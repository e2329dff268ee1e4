'use strict';
(() => {
  const {el, table, textColumn, numberColumn} = counterflex.dom;
  const {fixed, known} = counterflex.units;
  const words = counterflex.words;

  const unknown = '\u2013';

  /** A table with a column for each run; rows whose values differ are marked. `rows`: [name, value of each run]. */
  function compared(caption, runs, rows) {
    const columns = [{title: 'What'}, ...runs.map((run) => textColumn(run.letter || 'Value'))];
    const marked = rows.map(([name, ...values]) => {
      const differ = values.length > 1 && values.some((v) => v !== values[0]);
      const cells = [differ ? [name, el('b', {class: 'differs'}, ' differs')] : name, ...values];
      return Object.assign(cells, {mark: differ ? 'different' : ''});
    });
    return table(caption, columns, marked);
  }

  /** Keys of all objects, each once, in order of first appearance. */
  const keysOf = (objects) => [...new Set(objects.flatMap((o) => Object.keys(o)))];

  function optionText(name, value, units) {
    if (value === undefined) return unknown;
    if (name === 'tolerance-mm' && known(value)) return units.format(value);
    if (typeof value === 'boolean') return value ? 'yes' : 'no';
    return Array.isArray(value) ? value.join('; ') : String(value);
  }

  function inputs(runs) {
    const rows = [];
    for (const role of keysOf(runs.map((run) => run.report.inputs))) {
      const of = (key) => runs.map((run) => (run.report.inputs[role] ? run.report.inputs[role][key] : unknown));
      rows.push([role, ...of('path')], [`${role}, SHA-256`, ...of('sha256')]);
    }
    return compared('Inputs', runs, rows);
  }

  function options(runs, units) {
    const rows = keysOf(runs.map((run) => run.report.options))
        .map((name) => [name === 'tolerance-mm' ? 'tolerance' : name,
          ...runs.map((run) => optionText(name, run.report.options[name], units))]);
    const of = (what, get) => [what, ...runs.map((run) => get(run.report) || unknown)];
    const heads = [of('tool', (r) => r.tool), of('command', (r) => r.command), of('machine', (r) => r.machine)];
    return compared('Options', runs, [...heads, ...rows]);
  }

  function notModelled(run) {
    const {not_modelled: list = []} = run.report.assumptions || {};
    if (list.length === 0) return null;
    return el('div', {class: 'stack'}, el('h3', null, words.ofRun(run, 'Not modelled')),
        el('ul', null, list.map((sentence) => el('li', null, sentence))));
  }

  /** What is not modelled, inputs with their hashes, options and version. */
  function render({runs, units}) {
    return el('div', {class: 'stack'}, el('div', {class: 'runs'}, runs.map(notModelled)), inputs(runs), options(runs, units));
  }

  const blockRows = [['Blocks', 'total'], ['Moves', 'moves'], ['Corrected individually', 'corrected'],
    ['Corrected in part', 'corrected_in_part'], ['With one shift for their contour', 'grouped'],
    ['Held: with the correction of the block before', 'held'], ['Not corrected', 'not_corrected'], ['Points added', 'inserted']];

  const countText = (n) => (known(n) ? String(n) : unknown);

  function shortBlocks(report) {
    const short = report.control.short_blocks;
    if (!short) return unknown;
    if (short.count === 0) return 'none';
    return `${short.count}, shortest ${fixed(short.shortest_ms, 2)} ms, ${words.inLine(short.shortest_line)}`;
  }

  function pathTolerances(report, units) {
    const of = (t) => `${words.inLine(t.line)}: ${known(t.path_mm) ? units.format(t.path_mm) : 'no path tolerance'}`;
    return report.control.path_tolerances.map(of).join('; ') || 'not stated';
  }

  function longestLine({control: {lines}}) {
    return lines ? `${lines.longest} characters of ${lines.limit}` : unknown;
  }

  function largestForce({forces}) {
    const where = forces.wrench_at === 'platform' ? " at the platform's reference point" : '';
    return known(forces.largest_N) ? `${fixed(forces.largest_N, 1)} N, ${fixed(forces.largest_Nm, 2)} N m${where}` : unknown;
  }

  function forceSteps({forces}) {
    const steps = `${words.counted(forces.ramps, 'ramp')}, ${words.counted(forces.jumps, 'jump')}`;
    return `${steps}, largest ${fixed(forces.largest_step_N, 1)} N`;
  }

  /** What --free spin chose. */
  function freeSpin({free_spin: spin}, units) {
    if (!spin) return 'as programmed';
    const programmed = `largest deviation before correction ${units.format(spin.programmed_mm)}`;
    if (spin.turned === 0) return `as programmed, ${programmed}: no turn gains 1 %`;
    const range = `${fixed(spin.least_deg, 0)} to ${fixed(spin.most_deg, 0)}\u00b0`;
    return `${range}, ${spin.turned} of ${spin.targets} targets; ${programmed} \u2192 ${units.format(spin.turned_mm)}`;
  }

  function controlRows(runs, units) {
    const of = (what, get) => [what, ...runs.map((run) => get(run.report))];
    const spin = runs.some((run) => run.report.free_spin) ? [of('Turn about the spindle', (r) => freeSpin(r, units))] : [];
    return [
      ...spin,
      of('Blocks of the text, before and after', (r) => `${r.text.blocks_before} / ${countText(r.text.blocks_after)}`),
      of('Bytes, before and after', (r) => `${r.text.bytes_before} / ${countText(r.text.bytes_after)}`),
      of('Feed moves with less time than --min-block-ms', shortBlocks),
      of('Longest line', longestLine),
      of('Path tolerance of the control', (r) => pathTolerances(r, units)),
      of('Largest cutting force', largestForce),
      of('Steps of the force', forceSteps),
    ];
  }

  function toolTable(run, units) {
    const {tools} = run.report;
    if (!tools || tools.length === 0) return null;
    const columns = [{title: 'Tool'}, numberColumn(`Length, ${units.lengthLabel}`),
      numberColumn('Stiffness at its tip, N/\u00b5m'), textColumn('From')];
    const stiffness = (tool) => (known(tool.radial_N_per_um) ? fixed(tool.radial_N_per_um, 2) : 'rigid');
    const rows = tools.map((t) => [`T${t.number}`, units.lengthNumber(t.length_mm), stiffness(t), words.unitsOf(t.stiffness)]);
    return table(words.ofRun(run, 'Tools'), columns, rows);
  }

  /** What --only-significant leaves. */
  function asProgrammed(runs, units) {
    const text = ({only_significant: left}) => {
      if (!left) return unknown;
      const largest = left.line > 0 ? `, largest deviation ${units.format(left.largest_mm)} \u00b1 ${units.format(left.band_mm)}, ${words.inLine(left.line)}` : '';
      const share = known(left.length_percent) ? `, ${fixed(left.length_percent, 0)} % of the feed length` : '';
      return `${left.as_programmed} of ${words.counted(left.targets, 'target')}${share}${largest}`;
    };
    if (!runs.some((run) => run.report.only_significant)) return [];
    return [['As programmed, below the band', ...runs.map((run) => text(run.report))]];
  }

  /** Counts of blocks, checks against limits of the control, and tools. */
  function program({runs, units}) {
    const blocks = blockRows.map(([what, key]) => [what, ...runs.map((run) => countText(run.report.blocks[key]))]);
    const counts = compared('Blocks and control', runs, [...blocks, ...asProgrammed(runs, units), ...controlRows(runs, units)]);
    return el('div', {class: 'stack'}, counts, runs.map((run) => toolTable(run, units)));
  }

  counterflex.facts = {render, program, optionText, pathTolerances, freeSpin};
})();
