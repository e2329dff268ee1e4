'use strict';
/** What to do about a failure: its place, the deviation there by causes, the lines around it, and the cure. */
(() => {
  const {el} = counterflex.dom;
  const {known} = counterflex.units;
  const {vectors, words} = counterflex;

  const {causesOf, sizesOf} = vectors;

  const ofGeometry = 'If the part is touched off on this machine, state it: datum = { touched_at_mm = [x, y, z] } in [work] of the '
    + 'machine file. The shift that all deviations have in common is then not corrected.';
  const ofLoad = 'Check size and sign of the force (sense = on_tool or on_workpiece), and the stiffness in the machine file.';
  const cures = {
    geometry_mm: [ofGeometry, 'Check the errors of assembly in the machine file: units and signs.'],
    load_mm: [ofLoad],
    fixture_mm: ['Check [fixture] in the machine file: its place and its stiffness.'],
    gravity_mm: ['Check masses and gravity_m_s2 in the machine file.'],
    preloads_mm: ['Check the preloads in the machine file.'],
  };

  /** A limit that admits a correction of `mm`: rounded up to two digits. */
  function admitting(mm) {
    const unit = 10 ** (Math.floor(Math.log10(mm)) - 1);
    return String(Number((Math.ceil(mm / unit) * unit).toPrecision(2)));
  }

  /** Of a correction above the limit: by its largest cause. */
  function curesOfLimit({failure, options}) {
    const {at} = failure, size = at ? vectors.norm(at.before_mm) : 0;
    // Where the causes are not known, the message alone shows whether it is a correction or a travel.
    const isTooLarge = at ? size > options['max-correction-mm'] : failure.what.startsWith('the correction would ');
    if (!isTooLarge) return [
      'Move the part or the work offset (--work), so that the path is inside the travel of all axes.',
      'Check the length of the tool (--tool-length, --tool-table) and the travel in the machine file.'];
    if (!at) return [
      'Check the force, and the stiffness and the errors of assembly in the machine file.',
      'If the correction is right, allow it with a larger --max-correction-mm.'];
    const [cause] = Object.entries(sizesOf(causesOf(at))).sort((a, b) => b[1] - a[1])[0];
    return [...(cures[cause] || []), `If the correction is right, allow it: --max-correction-mm ${admitting(size)}.`];
  }

  function curesOf(report) {
    const {kind} = report.failure;
    if (kind === 'limit') return curesOfLimit(report);
    if (kind === 'not_compensated' && report.command === 'verify') return [
      'Compensate the original program again, with this machine file and these forces.',
      'If the deviation is acceptable, verify with a larger --tolerance-mm.'];
    if (kind === 'not_compensated') return [
      'Check the force and the stiffness at this place: counterflex analyze shows the machine there.',
      'Move the part or the work offset (--work) away from this place of the machine.'];
    if (kind === 'program') return ['Change the line of the program as the message states.'];
    return [];
  }

  /** Lines of the program around the failure; null without its text. */
  function excerpt({source}, line) {
    if (!(line > 0) || !source || source.lines.length < line) return null;
    const from = Math.max(1, line - 2), to = Math.min(source.lines.length, line + 2);
    const rows = Array.from({length: to - from + 1}, (_, i) => from + i);
    return el('pre', null, rows.map((n) => el('code', {class: n === line ? 'failed' : null}, `${String(n).padStart(6)}  ${source.lines[n - 1]}\n`)));
  }

  function deviationThere(failure, units) {
    const {at} = failure;
    if (!at) return null;
    const causes = causesOf(at), cause = words.cause(sizesOf(causes));
    const place = at.place_mm.map((x) => units.lengthNumber(x)).join(', ');
    const size = units.format(vectors.norm(at.before_mm));
    const sentence = `In this line the original program is off by up to ${size}${cause ? `: ${cause}` : ''}.`;
    return [el('p', {class: 'cause'}, sentence), el('p', null, `There the machine is at x, y, z = ${place} ${units.lengthLabel}. The correction has the opposite sign.`),
      counterflex.vectorSum.render(`Causes in line ${at.line}, in ${units.words}, axes of the machine`, causes, at.before_mm, [], units)];
  }

  /** The stretch of a failed verification: the first one of its line with a residual above the tolerance; -1 without one. */
  function stretchOf({report, curves}) {
    const {failure, options} = report;
    if (!failure || !curves || !(failure.line > 0)) return -1;
    const {largest} = curves.quantities.after_mm || curves.quantities.before_mm || {largest: []};
    const tolerance = options['tolerance-mm'];
    const misses = (i) => curves.first_line[i] <= failure.line && failure.line <= curves.last_line[i] && largest[i] > tolerance;
    const first = largest.findIndex((_, i) => misses(i));
    return first >= 0 ? first : counterflex.lines.stretchOf(curves, failure.line, 'after_mm');
  }

  function ofRun(run, units) {
    const {failure} = run.report;
    if (!failure) return null;
    const list = curesOf(run.report), stretch = stretchOf(run);
    const corrected = known(failure.corrected_line) && failure.corrected_line > 0 ? `, line ${failure.corrected_line} of the corrected program` : '';
    const title = failure.line > 0 ? `Line ${failure.line}${corrected}` : 'The whole program';
    return el('div', {class: 'place-card'}, el('h3', null, words.ofRun(run, title)), excerpt(run, failure.line),
        stretch >= 0 ? counterflex.place.sentence(counterflex.place.ofStretch(run, stretch, {line: failure.line}), units) : deviationThere(failure, units),
        list.length > 0 ? [el('h3', null, 'What to do'), el('ul', null, list.map((text) => el('li', null, text)))] : null);
  }

  /** Null if no run failed. */
  function render({runs, units}) {
    const parts = runs.map((run) => ofRun(run, units)).filter(Boolean);
    return parts.length > 0 ? el('div', {class: 'runs'}, parts) : null;
  }

  counterflex.failure = {render, stretchOf, curesOf};
})();
