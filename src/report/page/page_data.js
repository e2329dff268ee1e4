'use strict';
/** The only global of the page. Each script adds its part. */
const counterflex = {};

(() => {
  const arrays = {F64: Float64Array, F32: Float32Array, I32: Int32Array, U8: Uint8Array};

  /** A typed array of little-endian numbers in base64. `kind` is a key of `arrays`. */
  function typed(kind, base64) {
    const text = atob(base64);
    const bytes = new Uint8Array(text.length);
    for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
    return new arrays[kind](bytes.buffer);
  }

  /** Least and largest are the same array if no waypoints were merged. */
  function quantity(q) {
    const largest = typed('F32', q.largest);
    return {least: q.least === undefined ? largest : typed('F32', q.least), largest};
  }

  /** Curves with typed arrays under the names of the data; null without stretches. */
  function decodeCurves(c) {
    if (!c || c.stretches === 0) return null;
    const quantities = {};
    for (const [name, q] of Object.entries(c.quantities)) quantities[name] = quantity(q);
    return {
      ...c,
      s_mm: typed('F64', c.s_mm),
      first_line: typed('I32', c.first_line),
      last_line: typed('I32', c.last_line),
      operation: typed('I32', c.operation),
      after_rapid: typed('U8', c.after_rapid),
      place_mm: typed('F32', c.place_mm),
      place_before_mm: typed('F32', c.place_before_mm),
      place_after_mm: typed('F32', c.place_after_mm),
      direction: c.direction ? typed('F32', c.direction) : null,
      quantities,
    };
  }

  /** A node of the machine's lines: its one place, or its places. */
  const decodeNode = (node) => (Array.isArray(node) ? node : typed('F32', node));

  /** The machine along the path with typed arrays under the names of the data; null without places. */
  function decodeMachine(m) {
    if (!m || m.s_mm === '') return null;
    const withValues = (one) => ({...one, values: typed('F32', one.values)});
    return {
      ...m,
      s_mm: typed('F64', m.s_mm),
      line: typed('I32', m.line),
      axes: m.axes.map(withValues),
      margins: m.margins.map(withValues),
      conditioning: m.conditioning ? typed('F32', m.conditioning) : null,
      skeleton: m.skeleton && {...m.skeleton, lines: m.skeleton.lines.map((line) => line.map(decodeNode))},
    };
  }

  /** {lines: of the original program, [] if its text is unknown; output: the path of the corrected program, or ''}. */
  function decodeSource(source) {
    const {text, output} = source || {};
    return {lines: typeof text === 'string' ? text.replace(/\n$/, '').split('\n') : [], output: output || ''};
  }

  /** With two runs each has a letter, A or B, besides its name. */
  function decodeRun(run, index, count) {
    const letter = 'AB'[index] || String(index + 1);
    return {
      letter: count > 1 ? letter : '',
      name: run.name || (count > 1 ? letter : ''),
      report: run.report,
      curves: decodeCurves(run.curves),
      loads: run.loads || null,
      machine: decodeMachine(run.machine),
      source: decodeSource(run.source),
    };
  }

  /** The runs of a page's data: {letter, name, report, curves | null, loads | null, machine | null, source}. Throws on another schema. */
  function decode(json) {
    if (json.schema !== 'counterflex-page 1') throw new Error(`the data is of the schema ${json.schema}`);
    return json.runs.map((run, index) => decodeRun(run, index, json.runs.length));
  }

  /** Index of the stretch at cutting path length `s`. */
  function stretchAt(curves, s) {
    let low = 0, high = curves.s_mm.length - 1;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (curves.s_mm[middle] < s - 1e-9) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  /** The conclusion for two runs, a sentence, or ''. */
  const conclusion = (json) => (typeof json.conclusion === 'string' ? json.conclusion : '');

  counterflex.data = {decode, conclusion, stretchAt};
})();
