'use strict';
(() => {
  const {known, percent} = counterflex.units;

  /** "1 move", "2 moves". */
  const counted = (count, what) => `${count} ${what}${count === 1 ? '' : 's'}`;

  /** A heading for one run, with its letter if there are two. */
  const ofRun = (run, text) => (run.letter ? `${run.letter}: ${text}` : text);

  const inLine = (line) => (line > 0 ? `line ${line}` : '');

  /** By how many times the largest deviation became smaller; '' if it is not meaningful. */
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

  /** A report of an older version does not count the feed moves. */
  const feedMoves = (report) => report.feed_moves || {};

  /** "cutting length"; "known cutting length" if some feed moves have an unknown length. */
  const cuttingLength = (report) => `${feedMoves(report).unknown_length > 0 ? 'known ' : ''}cutting length`;

  const isMissed = ({summary, options}) => Boolean(summary.after) && summary.after.max_mm > options['tolerance-mm'];

  /** Whether the share of the cutting length and the largest deviation are all that the reason of the verdict has. */
  function hasShareAlone(report) {
    const {corrected_percent: share} = report.summary;
    return isMissed(report) && known(share) && share < 100 && !(feedMoves(report).unknown > 0);
  }

  /** A warning if the residual exceeds the tolerance, because some blocks cannot be corrected. */
  function missed(report, units) {
    if (!isMissed(report)) return '';
    const share = hasShareAlone(report)
      ? `; ${percent(report.summary.corrected_percent)} of the cutting length is within it` : '';
    return ` That is more than the tolerance of ${units.format(report.options['tolerance-mm'])}${share}.`;
  }

  /** Whether a run has solved no place of a feed move or of a hole: it has no numbers then. */
  const nothingSolved = ({summary}) => !summary.before;

  /** The moves that the numbers do not include. */
  function leftOut({blocks}) {
    const count = (blocks && blocks.not_corrected) || 0;
    if (count === 0) return '';
    return ` ${counted(count, 'move')} ${count === 1 ? 'is' : 'are'} not corrected and not included in these numbers.`;
  }

  const kinds = {PARTLY: 'warn', 'NOTHING CORRECTED': 'bad', FAILED: 'bad'};

  /** Moves that are not corrected individually; 0 if the run does not count them. */
  const otherMoves = ({grouped, held, corrected_in_part: inPart, not_corrected: left}) =>
    (grouped || 0) + (held || 0) + (inPart || 0) + (left || 0);

  /**
   * The verdict as the terminal shows it; '' for a report of an older version. What the sentence behind it has in the unit
   * of the page is left out: the largest deviation above the tolerance, and the reason if it has the share alone.
   */
  function verdictLine(report) {
    const {verdict, verdict_reason: reason} = report;
    if (!verdict) return '';
    if (verdict !== 'PARTLY' || !reason || hasShareAlone(report)) return verdict;
    return `PARTLY (${isMissed(report) ? reason.replace(/, worst [\d.]+ mm > [\d.]+/, '') : reason})`;
  }

  /** The result of a run: its verdict and a sentence, and the kind: 'good', 'warn', 'bad' or 'neutral'. */
  function verdict(report, units) {
    const {text, kind} = sentence(report, units);
    const line = verdictLine(report);
    if (!line) return {text, kind};
    if (report.failure) return {text: text.replace(/^Failed/, line), kind};
    const unwritten = report.command === 'compensate' && report.verdict !== 'OK' && !report.output;
    const end = unwritten ? ' No corrected program was written.' : '';
    return {text: `${line}. ${text}${end}`, kind: kinds[report.verdict] || kind};
  }

  /** The first word of a verdict, and the text behind it: ['OK', 'Off by ...']. */
  function verdictWord({verdict: word}, text) {
    if (!word || !text.startsWith(word)) return ['', text];
    return [word, text.slice(word.length).replace(/^[.:]?\s*/, '')];
  }

  function sentence(report, units) {
    const {before, after} = report.summary;
    if (report.failure) return {text: failed(report), kind: 'bad'};
    if (!before && report.summary.path_mm === 0) return {text: `No waypoint was solved: the program has no feed move.${leftOut(report)}`, kind: 'warn'};
    if (!before) return {text: 'No waypoint was solved: the deviation of all feed moves is unknown.', kind: 'warn'};
    const without = leftOut(report);
    if (!after) return {text: predicted(before, units) + without, kind: without ? 'warn' : 'neutral'};
    const more = missed(report, units) + without;
    return {text: corrected(before, after, units) + more, kind: more ? 'warn' : 'good'};
  }

  /** The causes of a deviation, in the order of all lists: `base` is their name in the report and the curves. */
  const causes = [
    {base: 'geometry', name: 'Errors of assembly', short: 'assembly', mostly: 'mostly errors of assembly'},
    {base: 'load', name: 'Cutting force', short: 'force', mostly: 'mostly the cutting force bends the machine'},
    {base: 'fixture', name: 'Deflection of the part', short: 'fixture', mostly: 'mostly the cutting force bends part and fixture'},
    {base: 'gravity', name: 'Weight of the parts', short: 'weight', mostly: 'mostly the weight of its parts bends the machine'},
    {base: 'preloads', name: 'Preloads', short: 'preloads', mostly: 'mostly preloaded joints and springs bend the machine'},
  ];

  /** The parts of a deviation: its causes, and what all together add to their sum. */
  const allParts = [...causes,
    {base: 'discrepancy', name: 'Discrepancy', short: 'both together', mostly: 'mostly the interaction of assembly errors and force'},
  ].map((part) => ({...part, key: `${part.base}_mm`}));

  /** The known parts of a deviation: [{key, name, short, mostly, mm}], in the order above. */
  function parts(sizes) {
    if (!sizes) return [];
    return allParts.filter(({key}) => known(sizes[key])).map((part) => ({...part, mm: sizes[part.key]}));
  }

  /** The relevant parts, the largest first: only one if it is more than twice the next. */
  function leading(sizes) {
    const sorted = parts(sizes).filter((part) => part.mm > 0).sort((a, b) => b.mm - a.mm);
    return sorted.length > 1 && sorted[0].mm <= 2 * sorted[1].mm ? sorted.slice(0, 2) : sorted.slice(0, 1);
  }

  /** The cause of the deviation in words; '' if unknown. */
  function cause(sizes) {
    const [first, second] = leading(sizes);
    if (!first) return '';
    return second ? `${first.name.toLowerCase()} and ${second.name.toLowerCase()}` : first.mostly;
  }

  /** The same in a word or two. */
  const causeInShort = (sizes) => leading(sizes).map(({short}) => short).join(', ');

  /** "tolerance"; of two runs with their letters: "tolerance of A", "tolerance of A and B". */
  const tolerance = (letters) => (letters.length > 0 ? `tolerance of ${letters.join(' and ')}` : 'tolerance');

  /** A text of the report, which is ASCII, with the spelling of units on pages. */
  const unitsOf = (text) => text.replace(/\bum\b/g, '\u00b5m');

  /** "T3, 10.0 mm"; only the diameter of a tool without a number. */
  const toolAndSize = ({tool, diameter_mm: diameter}, units) =>
    [tool > 0 ? `T${tool}` : '', known(diameter) ? units.length(diameter) : 'diameter unknown'].filter(Boolean).join(', ');

  const toolName = (tool) => (tool > 0 ? `T${tool}` : '\u2013');

  counterflex.words = {counted, ofRun, fileName, inLine, factor, title, verdict, verdictWord, cuttingLength, otherMoves, nothingSolved, causes, allParts, parts, cause, causeInShort, toolName, toolAndSize, tolerance, unitsOf};
})();
