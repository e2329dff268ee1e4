'use strict';
(() => {
  const {el, jump} = counterflex.dom;
  const {known, percent, fixed} = counterflex.units;
  const words = counterflex.words;

  /** An important number with its name and place. `mark` is 'warn' for numbers that need attention. */
  function card(key, label, value, note, mark) {
    return el('div', {class: `card ${mark || ''}`, 'data-card': key},
        el('dt', null, label), el('dd', null, el('strong', null, value), el('span', null, note || '')));
  }

  /** A link "line 12" to the place where the quantity is largest in this line; '' without a line. */
  function lineNote({context, index}, line, quantity) {
    return line > 0 ? ['line ', counterflex.lines.link(context, index, line, {quantity})] : '';
  }

  function deviationCard(key, label, s, place) {
    const {units} = place.context;
    const note = [lineNote(place, s.max_line, `${key}_mm`)];
    if (known(s.p95_mm)) note.push(`, 95 % below ${units.format(s.p95_mm)}`);
    const band = s.band ? ` \u00b1 ${units.format(s.band.at_max_mm)}` : '';
    if (band) note.push('; \u00b1 is its band, k = 2');
    return card(key, label, (band ? units.number(s.max_mm) : units.format(s.max_mm)) + band, note);
  }

  function correctedCard(report) {
    const share = report.summary.corrected_percent;
    const {corrected, moves} = report.blocks;
    const left = report.only_significant;
    const rest = left ? ', the rest below its band' : '';
    const mark = (share < 100 && !left) || report.verdict === 'PARTLY' ? 'warn' : '';
    const note = `of the ${words.cuttingLength(report)}, within tolerance${rest}; ${corrected} of ${words.counted(moves, 'move')} ${left ? 'followed' : ''}`;
    return card('corrected', left ? 'Within tolerance' : 'Corrected', percent(share), note.trim(), mark);
  }

  function airCard(report, place) {
    const {air} = report.summary;
    const note = [lineNote(place, air.line, 'air_mm'), ': dry run, spring pass, broken insert'];
    const mark = air.max_mm > tolerance(report) ? 'warn' : '';
    return card('air', 'Off without the cutting force', place.context.units.format(air.max_mm), note, mark);
  }

  function correctionCard(report, place) {
    const {correction} = report.summary;
    const note = lineNote(place, correction.line, 'correction_mm');
    return card('correction', 'Largest correction', place.context.units.format(correction.max_mm), note);
  }

  /** The deviation at rim and flank of a tilted tool: of the tool with the largest one. */
  function toolCard(report, units) {
    const tool = (report.summary.tool_deviations || []).find((t) => t.after && typeof t.after.rim_mm === 'number');
    if (!tool) return null;
    const largest = Math.max(tool.after.rim_mm, tool.after.flank_mm || 0);
    const mark = largest > tolerance(report) ? 'warn' : '';
    const note = `${words.toolAndSize(tool, units)}: the tool stays tilted`;
    return card('tool', 'After, at rim and flank', units.format(largest), note, mark);
  }

  /** The harmful part of a deviation: across the path. */
  function acrossCard(s, units) {
    return card('across', 'Across the path', units.format(s.max_across_mm), 'the part along the path matters only at its ends');
  }

  /** Tolerance in mm; infinite for a run without tolerance. */
  function tolerance(report) {
    const value = report.options['tolerance-mm'];
    return typeof value === 'number' ? value : Infinity;
  }

  /** Whether a cutting force or a moment acts anywhere. */
  const forceActs = ({forces}) => forces.largest_N > 0 || forces.largest_Nm > 0;

  const namesOf = (report) => (report.command === 'predict'
    ? [['before', 'Deviation, as programmed']] : [['before', 'Before'], ['after', 'After (model residual)']]);

  /** The cards of a run without solved waypoints. */
  const emptyCards = (report) => namesOf(report).map(([key, label]) => card(key, label, '\u2013', 'no feed move was solved'));

  /** The cards of a run; those without a value are left out. */
  function cards(context, index) {
    const {report} = context.runs[index];
    const {units} = context;
    const place = {context, index};
    const {before, after, corrected_percent: share, air, correction} = report.summary;
    if (!report.failure && words.nothingSolved(report)) return emptyCards(report);
    const times = words.factor(before, after);
    return [
      before && deviationCard('before', after ? 'Before' : 'Deviation, as programmed', before, place),
      after && deviationCard('after', 'After (model residual)', after, place),
      after && toolCard(report, units),
      before && !after && acrossCard(before, units),
      times && card('factor', 'Factor', `${times} \u00d7`, 'largest before / largest after'),
      typeof share === 'number' && correctedCard(report),
      air && forceActs(report) && airCard(report, place),
      correction && correction.max_mm > 0 && correctionCard(report, place),
    ].filter(Boolean);
  }

  /** Points to check before the program runs: sentences, each with the section of its details. */
  function reminders(report, units) {
    const {air} = report.summary;
    const loads = exceeded(report);
    const list = [];
    const add = (text, target) => list.push({text, target});
    const others = words.otherMoves(report.blocks);
    if (others > 0) add(`${words.counted(others, 'move')} not corrected individually`, 'remarks');
    else if (report.blocks.left_alone_count > 0) add('some blocks are not or partly corrected', 'remarks');
    for (const {check, state, text} of report.sanity || [])
      if (state === 'doubtful') add(`${check}: ${words.unitsOf(text)}`, 'remarks');
    if (report.warning_count > 0) add(words.counted(report.warning_count, 'warning'), 'remarks');
    if (loads > 0) add(`${words.counted(loads, 'load')} above the limit of the machine file`, 'loads');
    if (report.forces.without_force.moves > 0 && forceActs(report))
      add(`${words.counted(report.forces.without_force.moves, 'feed move')} without a cutting force`, 'remarks');
    if (air && forceActs(report) && !report.failure && air.max_mm > tolerance(report))
      add(`without the cutting force the program is off by up to ${units.format(air.max_mm)}: do not run it dry on the finished part`,
          'sensitivity');
    return list;
  }

  /** How many loads exceed their limits. */
  function exceeded(report) {
    let count = 0;
    for (const chain of (report.loads && report.loads.chains) || [])
      for (const load of Object.values(chain)) if (load.limit && load.largest > load.limit) ++count;
    return count;
  }

  function reminderList(report, units) {
    const list = reminders(report, units);
    if (list.length === 0) return null;
    const item = ({text, target}) => el('li', null, jump(text, target, () => counterflex.goToSection(target)));
    const title = report.failure ? 'Found before the failure' : 'Check before you run it';
    return el('div', {class: 'reminders'}, el('h3', null, title), el('ul', null, list.map(item)));
  }

  /** Command and inputs of the run: one line below the title. */
  function subtitle(report, units) {
    const {options} = report;
    const bits = [`on ${report.machine || 'an unnamed machine'}`, report.command];
    if (options.method) bits.push(`method ${options.method}`);
    if (tolerance(report) < Infinity && report.command !== 'predict')
      bits.push(`tolerance ${units.format(tolerance(report))}`);
    return bits.join(', ');
  }

  /** A band with the verdict in a word, and a sentence. */
  function verdictOf(run, units) {
    const {text, kind} = words.verdict(run.report, units);
    const [word, rest] = words.verdictWord(run.report, text);
    return el('p', {class: `verdict ${kind}`, role: kind === 'bad' ? 'alert' : null},
        word ? [el('b', {class: 'word'}, word), ' '] : null, el('span', null, rest));
  }

  /** The file that the machine runs, with its folders. */
  function writtenTo({report, source}) {
    if (!report.output) return null;
    return el('p', {class: 'subtitle'}, 'Written to ', el('code', null, (source && source.output) || report.output));
  }

  function forceSentence(report) {
    const {without_force: without, largest_N: force, largest_Nm: moment} = report.forces;
    if (!forceActs(report)) return report.failure ? '' : 'No cutting force acts.';
    const size = `Cutting force: up to ${force > 0 ? `${fixed(force, 0)} N` : `${fixed(moment, 2)} N m`}.`;
    return without.moves > 0 ? `${size} ${words.counted(without.moves, 'feed move')} without a force.` : size;
  }

  /** What the numbers rest on: place and datum of the part, force, tools, weights, temperature. */
  function assumptionList({report}) {
    const {work, datum, tools, gravity, thermal, unmeasured} = report.assumptions || {};
    const list = [unmeasured, work, datum, forceSentence(report), tools, gravity, thermal].filter(Boolean);
    return el('div', {class: 'assumptions'}, el('h3', null, 'Assumed'), el('ul', null, list.map((text) => el('li', null, words.unitsOf(text)))));
  }

  function headingOf(run) {
    if (!run.letter) return el('h1', null, words.title(run.report));
    const name = run.name === run.letter ? words.title(run.report) : run.name;
    return el('h2', null, el('b', {class: `letter ${run.letter}`}, run.letter), ` ${name}`);
  }

  function runSummary(context, index) {
    const run = context.runs[index];
    const {units} = context;
    const line = el('p', {class: 'subtitle'}, subtitle(run.report, units));
    return el('div', {class: 'run'}, headingOf(run), line, verdictOf(run, units), writtenTo(run),
        el('div', {class: 'before-you-run'}, assumptionList(run), reminderList(run.report, units)),
        el('dl', {class: 'cards'}, cards(context, index)));
  }

  /** Title, verdict, assumptions, points to check and cards: of one run, or of two side by side below their conclusion. */
  function render(context) {
    const {runs, conclusion} = context;
    if (runs.length === 1) return runSummary(context, 0);
    const both = el('div', {class: 'runs'}, runs.map((_, i) => runSummary(context, i)));
    const sentence = conclusion ? el('p', {class: 'verdict neutral'}, conclusion) : null;
    return [el('h1', null, 'Two runs compared'), sentence, both];
  }

  counterflex.summary = {render, subtitle, reminders, forceSentence, tolerance};
})();
