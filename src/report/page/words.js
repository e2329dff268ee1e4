'use strict';
(() => {
  const {known} = counterflex.units;

  /** "1 move", "2 moves". */
  const counted = (count, what) => `${count} ${what}${count === 1 ? '' : 's'}`;

  const inLine = (line) => (line > 0 ? `line ${line}` : '');

  /** How many times smaller the largest deviation became; '' where that is not worth saying. */
  function factor(before, after) {
    if (!before || !after || !(after.max_mm > 0)) return '';
    const ratio = before.max_mm / after.max_mm;
    if (ratio < 1.5) return '';
    return ratio.toFixed(ratio < 10 ? 1 : 0);
  }

  function fileName(report, role) {
    const input = report.inputs[role];
    if (!input) return role;
    return input.path === '-' ? 'standard input' : input.path.split('/').pop();
  }

  function title(report) {
    const program = fileName(report, 'program');
    if (report.command === 'verify') return `${fileName(report, 'corrected')} for ${program}`;
    return program;
  }

  function failed(report) {
    const {failure} = report;
    const where = failure.line > 0 ? `Line ${failure.line}: ` : '';
    const outcome = report.command === 'compensate' ? ' No corrected program was written.' : '';
    const end = /[.!?]$/.test(failure.what) ? '' : '.';
    return `Failed. ${where}${failure.what}${end}${outcome}`;
  }

  function predicted(before, units) {
    return `Run as it is, the program is off by up to ${units.format(before.max_mm)} (${inLine(before.max_line)}). ` +
        'This is a prediction: nothing was corrected.';
  }

  function corrected(before, after, units) {
    const times = factor(before, after);
    return `Off by up to ${units.format(before.max_mm)} before, ${units.format(after.max_mm)} after (model residual)` +
        (times ? `: ${times} times smaller.` : '.');
  }

  /** The result of a run in a sentence, and whether it is a good one: 'good', 'bad' or 'neutral'. */
  function verdict(report, units) {
    const {before, after} = report.summary;
    if (report.failure) return {text: failed(report), kind: 'bad'};
    if (!before) return {text: 'Nothing was solved: the program has no feed move whose deviation could be told.', kind: 'neutral'};
    if (!after) return {text: predicted(before, units), kind: 'neutral'};
    return {text: corrected(before, after, units), kind: 'good'};
  }

  /** Which of two runs leaves less, in a sentence. */
  function comparison(runs, units) {
    const left = (run) => run.report.summary.after || run.report.summary.before;
    const [a, b] = runs.map(left);
    if (!a || !b) return 'One of the runs has no deviation to compare.';
    const difference = b.max_mm - a.max_mm;
    const values = `A ${units.format(a.max_mm)}, B ${units.format(b.max_mm)}`;
    if (difference === 0) return `Both leave the same: ${values}.`;
    return `B leaves ${units.format(Math.abs(difference))} ${difference < 0 ? 'less' : 'more'} than A at its worst: ${values}.`;
  }

  const partNames = {
    geometry_mm: 'Errors of assembly',
    load_mm: 'Cutting force',
    gravity_mm: 'Weight of the parts',
    discrepancy_mm: 'Discrepancy',
  };
  const partSentences = {
    geometry_mm: 'mostly errors of assembly',
    load_mm: 'mostly the cutting force bends the machine',
    gravity_mm: 'mostly the weight of its parts bends the machine',
    discrepancy_mm: 'mostly what assembly and force do together, more than each alone',
  };

  /** The parts of a deviation that are known: [{key, name, mm}], as they are listed above. */
  function parts(causes) {
    if (!causes) return [];
    return Object.keys(partNames).filter((key) => known(causes[key])).map((key) => ({key, name: partNames[key], mm: causes[key]}));
  }

  /** What bends the machine there, in words: of several parts, one that is more than twice the next is "mostly". */
  function cause(causes) {
    const sorted = parts(causes).filter((part) => part.mm > 0).sort((a, b) => b.mm - a.mm);
    if (sorted.length === 0) return '';
    if (sorted.length === 1 || sorted[0].mm > 2 * sorted[1].mm) return partSentences[sorted[0].key];
    return `${sorted[0].name.toLowerCase()} and ${sorted[1].name.toLowerCase()}`;
  }

  const toolName = (tool) => (tool > 0 ? `T${tool}` : '\u2013');

  counterflex.words = {counted, inLine, factor, fileName, title, verdict, comparison, parts, cause, toolName};
})();
