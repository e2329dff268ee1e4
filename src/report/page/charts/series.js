'use strict';
(() => {
  /** Null for unknown values: lines are drawn through them. */
  const orNull = (value) => (Number.isNaN(value) ? null : value);

  /**
   * The order in which least and largest value of a stretch are drawn: first the one nearer to the previous value, so
   * that a smooth curve stays smooth and a peak stays a peak.
   */
  function pair(least, largest, previous) {
    const falls = previous !== null && Math.abs(previous - largest) < Math.abs(previous - least);
    return falls ? [largest, least] : [least, largest];
  }

  /** The points of a curve: path length and stretch of each, and breaks at rapids. */
  function places(curves) {
    const {s_mm: s, after_rapid: rapid, waypoints_per_stretch: merged} = curves;
    const points = [];
    for (let i = 0; i < s.length; ++i) {
      const begin = i > 0 ? s[i - 1] : 0;
      if (merged === 1 && i > 0 && rapid[i]) points.push({s: begin, stretch: i - 1, gap: true});
      if (merged > 1) points.push({s: (begin + s[i]) / 2, stretch: i, second: false, merged: true});
      points.push({s: s[i], stretch: i, second: merged > 1, merged: merged > 1});
    }
    return points;
  }

  /** Values of a quantity at `points`, each multiplied by `scale`; NaN breaks the line. */
  function valuesAt(points, quantity, scale) {
    const values = new Array(points.length);
    let previous = null, next = null;
    points.forEach((point, k) => {
      if (point.gap) return void (values[k] = NaN);
      const i = point.stretch;
      if (point.second) values[k] = next;
      else if (quantity.least === quantity.largest) values[k] = next = orNull(quantity.largest[i] * scale);
      else [values[k], next] = pair(quantity.least[i] * scale, quantity.largest[i] * scale, previous).map(orNull);
      if (values[k] !== null) previous = values[k];
    });
    return values;
  }

  /** Points of a run's values at the places {s_mm, line}. Their stretches are those of the curves, so that a click selects one. */
  function along({curves}, {s_mm: all, line: lines}) {
    const stretch = (s, line) => (curves ? counterflex.lines.stretchNear(curves, line, s) : -1);
    return Array.from(all, (s, i) => ({s, stretch: stretch(s, lines[i]), line: lines[i]}));
  }

  /**
   * Rows for dygraphs of several series. `series`: {run, points, values}, where series of one run share `points`.
   * Returns {rows: [[s, value of each series]], places: [{run, stretch, line: of the point, if it has one, twin: the
   * other row of a merged stretch}] of each row}.
   */
  function tabulate(series, total, lengthScale) {
    const groups = [];
    series.forEach((one, index) => {
      let group = groups.find((g) => g.points === one.points);
      if (!group) groups.push(group = {points: one.points, run: one.run, members: []});
      group.members.push({index, values: one.values});
    });
    const rows = groups.flatMap((group) => groupRows(group, series.length, lengthScale));
    if (groups.length > 1) rows.sort((a, b) => a.row[0] - b.row[0]);
    const end = (s) => ({row: [s * lengthScale, ...new Array(series.length).fill(null)], run: 0, stretch: -1});
    const all = [end(0), ...rows, end(total)];
    return {rows: all.map(({row}) => row), places: all.map(({row, ...place}) => place)};
  }

  function groupRows({points, run, members}, width, lengthScale) {
    const rows = points.map((point, k) => {
      const row = new Array(width + 1).fill(null);
      row[0] = point.s * lengthScale;
      for (const {index, values} of members) row[index + 1] = values[k];
      return row;
    });
    return points.map(({stretch, line, merged, second}, k) =>
      ({row: rows[k], run, stretch, line, twin: merged ? rows[second ? k - 1 : k + 1] : undefined}));
  }

  /** A row with the larger absolute values of the two rows of a merged stretch; the row itself for a single one. */
  const largestOfTwo = (row, twin) => (!twin ? row : row.map((v, c) => (c > 0 && Math.abs(twin[c]) > Math.abs(v) ? twin[c] : v)));

  counterflex.series = {largestOfTwo, places, along, valuesAt, tabulate};
})();
