'use strict';
/** The page's only global: each script adds its part to it. */
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

  /** Where every waypoint kept its own value, least and largest are one array. */
  function quantity(q) {
    const largest = typed('F32', q.largest);
    return {least: q.least === undefined ? largest : typed('F32', q.least), largest};
  }

  /** Curves with typed arrays under the names that the data gives them; null without any stretch. */
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
      quantities,
    };
  }

  /** One of two runs is called A or B, whatever else its name is. */
  function decodeRun(run, index, count) {
    const letter = 'AB'[index] || String(index + 1);
    return {
      letter: count > 1 ? letter : '',
      name: run.name || (count > 1 ? letter : ''),
      report: run.report,
      curves: decodeCurves(run.curves),
      loads: run.loads || null,
    };
  }

  /** The runs of a page's data: {letter, name, report, curves | null, loads | null}. Throws on another schema. */
  function decode(json) {
    if (json.schema !== 'counterflex-page 1') throw new Error(`the data is of the schema ${json.schema}`);
    return json.runs.map((run, index) => decodeRun(run, index, json.runs.length));
  }

  /** Index of the stretch in which cutting path length `s` lies. */
  function stretchAt(curves, s) {
    let low = 0, high = curves.s_mm.length - 1;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (curves.s_mm[middle] < s - 1e-9) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  /** What was concluded of two runs, a sentence; '' where none is said. */
  const conclusion = (json) => (typeof json.conclusion === 'string' ? json.conclusion : '');

  counterflex.data = {decode, conclusion, stretchAt};
})();
