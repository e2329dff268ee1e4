'use strict';
(() => {
  const {known, percent} = counterflex.units;

  /** "1 move", "2 moves". */
  const counted = (count, what) => `${count} ${what}${count === 1 ? '' : 's'}`;

  /** A heading of something of one run, which of two says its letter. */
  const ofRun = (run, text) => (run.letter ? `${run.letter}: ${text}` : text);

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

  /** What somebody who trusts the tolerance has to know: where blocks cannot be corrected more than it remains. */
  function missed({summary, options}, units) {
    const tolerance = options['tolerance-mm'];
    if (!(summary.after.max_mm > tolerance)) return '';
    const {corrected_percent: held} = summary;
    const share = known(held) ? `; ${percent(held)} of the cutting length is held to it` : '';
    return ` That is more than the tolerance of ${units.format(tolerance)}${share}.`;
  }

  /** Whether a run has solved anything: one without a feed move has numbers of nothing. */
  const nothingSolved = ({summary}) => summary.path_mm === 0 || !summary.before;

  /** What the numbers do not cover. */
  function leftOut({blocks}) {
    const count = (blocks && blocks.not_corrected) || 0;
    if (count === 0) return '';
    return ` ${counted(count, 'move')} ${count === 1 ? 'is' : 'are'} not corrected, and left out of these numbers.`;
  }

  const kinds = {OK: 'good', PARTLY: 'warn', 'NOTHING CORRECTED': 'bad', FAILED: 'bad'};

  /** Moves that are not corrected each on its own; 0 where the run does not count them. */
  const otherMoves = ({grouped, held, corrected_in_part: inPart, not_corrected: left}) =>
    (grouped || 0) + (held || 0) + (inPart || 0) + (left || 0);

  /** The verdict as the terminal shows it; '' for a report of an older version. */
  function verdictLine({verdict, verdict_reason: reason}) {
    if (!verdict) return '';
    return verdict === 'PARTLY' && reason ? `PARTLY (${reason})` : verdict;
  }

  /** The result of a run: its verdict and a sentence, and the kind: 'good', 'warn', 'bad' or 'neutral'. */
  function verdict(report, units) {
    const line = verdictLine(report);
    const {text, kind} = sentence(report, units);
    if (!line) return {text, kind};
    if (report.failure) return {text: text.replace(/^Failed/, line), kind};
    const unwritten = report.command === 'compensate' && report.verdict !== 'OK' && !report.output;
    const end = unwritten ? ' No corrected program was written.' : '';
    return {text: `${line}. ${text}${end}`, kind: report.verdict === 'OK' ? kind : kinds[report.verdict]};
  }

  function sentence(report, units) {
    const {before, after} = report.summary;
    if (report.failure) return {text: failed(report), kind: 'bad'};
    if (report.summary.path_mm === 0) return {text: `Nothing was solved: no feed move.${leftOut(report)}`, kind: 'warn'};
    if (!before) return {text: 'Nothing was solved: no feed move has a deviation that could be told.', kind: 'warn'};
    const without = leftOut(report);
    if (!after) return {text: predicted(before, units) + without, kind: without ? 'warn' : 'neutral'};
    const more = missed(report, units) + without;
    return {text: corrected(before, after, units) + more, kind: more ? 'warn' : 'good'};
  }

  const partNames = {
    geometry_mm: 'Errors of assembly',
    load_mm: 'Cutting force',
    gravity_mm: 'Weight of the parts',
    preloads_mm: 'Preloads',
    discrepancy_mm: 'Discrepancy',
  };
  const partSentences = {
    geometry_mm: 'mostly errors of assembly',
    load_mm: 'mostly the cutting force bends the machine',
    gravity_mm: 'mostly the weight of its parts bends the machine',
    preloads_mm: 'mostly preloaded joints and springs bend the machine',
    discrepancy_mm: 'mostly what assembly and force do together, more than each alone',
  };

  const shortNames = {geometry_mm: 'assembly', load_mm: 'force', gravity_mm: 'weight', preloads_mm: 'preloads', discrepancy_mm: 'both together'};

  /** The parts of a deviation that are known: [{key, name, mm}], as they are listed above. */
  function parts(causes) {
    if (!causes) return [];
    const present = Object.keys(partNames).filter((key) => known(causes[key]));
    return present.map((key) => ({key, name: partNames[key], mm: causes[key]}));
  }

  /** The parts that matter, the largest first: one that is more than twice the next is alone. */
  function leading(causes) {
    const sorted = parts(causes).filter((part) => part.mm > 0).sort((a, b) => b.mm - a.mm);
    return sorted.length > 1 && sorted[0].mm <= 2 * sorted[1].mm ? sorted.slice(0, 2) : sorted.slice(0, 1);
  }

  /** What bends the machine there, in words; '' where that is unknown. */
  function cause(causes) {
    const [first, second] = leading(causes);
    if (!first) return '';
    return second ? `${first.name.toLowerCase()} and ${second.name.toLowerCase()}` : partSentences[first.key];
  }

  /** The same in a word or two. */
  const causeInShort = (causes) => leading(causes).map(({key}) => shortNames[key]).join(', ');

  const toolName = (tool) => (tool > 0 ? `T${tool}` : '\u2013');

  counterflex.words = {counted, ofRun, inLine, factor, title, verdict, otherMoves, nothingSolved, parts, cause, causeInShort, toolName};
})();
