'use strict';
/**
 * The data of the path views: places of one run relative to an origin nearby (for single precision), deviations there,
 * and their fractions of the range of colours. Pure functions of the decoded curves.
 */
(() => {
  const kinds = ['wanted', 'before', 'after'];

  /** Whether the curves have a known deviation of that kind. */
  const has = (curves, kind) => kind === 'wanted' ||
    (Boolean(curves.quantities[`${kind}_mm`]) && curves[`place_${kind}_mm`].some(Number.isFinite));

  /** The box around the places of all curves, mm in the machine frame; null without places. */
  function bounds(allCurves) {
    const low = [Infinity, Infinity, Infinity];
    const high = [-Infinity, -Infinity, -Infinity];
    for (const {place_mm} of allCurves)
      place_mm.forEach((v, i) => {
        low[i % 3] = Math.min(low[i % 3], v);
        high[i % 3] = Math.max(high[i % 3], v);
      });
    return low[0] <= high[0] ? {low, high} : null;
  }

  const sizeOf = ({low, high}) => Math.max(...high.map((v, i) => v - low[i])) || 10;

  /** The least and the largest deviation of a kind over all `paths` of `valued`, mm: {low, high}; zeros if all are unknown. */
  function rangeOf(paths) {
    let [low, high] = [Infinity, -Infinity];
    for (const {value} of paths)
      for (const v of value) if (Number.isFinite(v)) [low, high] = [Math.min(low, v), Math.max(high, v)];
    return low <= high ? {low, high} : {low: 0, high: 0};
  }

  /** The nearest number, by ratio, of the form 1, 2 or 5 times a power of ten. */
  function oneTwoFive(value) {
    const decade = 10 ** Math.floor(Math.log10(value));
    const near = (m) => Math.abs(Math.log(value / (m * decade)));
    const m = [1, 2, 5, 10].reduce((best, each) => (near(each) < near(best) ? each : best));
    return Number((m * decade).toPrecision(3));
  }

  /** The exaggeration that makes the largest deviation about a twentieth of the path's size; 1 at least. */
  const exaggeration = (size_mm, deviation_mm) =>
    (deviation_mm > 0 ? Math.max(1, oneTwoFive((0.05 * size_mm) / deviation_mm)) : 1);

  /** The factor, or the usual one if it draws the deviation larger than half the path. */
  const bearable = (factor, size_mm, deviation_mm) =>
    (factor * deviation_mm > 0.5 * size_mm ? exaggeration(size_mm, deviation_mm) : factor);

  /** 1, 2, 5, 10 ... up to the factor that makes the smallest of the largest deviations half as large as the path. */
  function exaggerations(size_mm, deviations_mm) {
    const known = deviations_mm.filter((v) => v > 0);
    const top = known.length > 0 ? (0.5 * size_mm) / Math.min(...known) : 1;
    const steps = [1];
    for (let decade = 1; steps[steps.length - 1] < top && decade < 1e9; decade *= 10)
      steps.push(2 * decade, 5 * decade, 10 * decade);
    return steps;
  }

  /** Ranges of stretches [from, to) without a rapid inside. */
  function feedRuns(after_rapid) {
    const runs = [];
    let from = 0;
    for (let i = 1; i <= after_rapid.length; ++i)
      if (i === after_rapid.length || after_rapid[i]) {
        runs.push([from, i]);
        from = i;
      }
    return runs;
  }

  /**
   * Values with gaps filled. In a run of feed moves they are linear in path length between known neighbours, and
   * constant beyond the first and last known one. Without known values they stay NaN. `width` values for each stretch.
   */
  function filled(values, width, s_mm, runs) {
    const result = Float32Array.from(values);
    const known = (i) => Number.isFinite(values[width * i]);
    const between = (i, a, b, k) => {
      const t = s_mm[b] > s_mm[a] ? (s_mm[i] - s_mm[a]) / (s_mm[b] - s_mm[a]) : 0;
      return values[width * a + k] + t * (values[width * b + k] - values[width * a + k]);
    };
    for (const [from, to] of runs) {
      let last = -1;
      for (let i = from; i <= to; ++i) {
        const end = i === to;
        if (!end && !known(i)) continue;
        if (end && last < 0) break;
        for (let gap = last < 0 ? from : last + 1; gap < i; ++gap)
          for (let k = 0; k < width; ++k)
            result[width * gap + k] = between(gap, last < 0 ? i : last, end ? last : i, k);
        last = i;
      }
    }
    return result;
  }

  /** The mean of the deviations of a kind over the path, each weighed by the length of its stretch: [x, y, z] in mm. */
  function meanOf(curves, kind) {
    const sum = [0, 0, 0];
    let length = 0, before = 0;
    curves.s_mm.forEach((s, i) => {
      const vector = curves[`place_${kind}_mm`].subarray(3 * i, 3 * i + 3);
      if (vector.every(Number.isFinite)) {
        vector.forEach((v, k) => { sum[k] += v * (s - before); });
        length += s - before;
      }
      before = s;
    });
    return length > 0 ? sum.map((v) => v / length) : [0, 0, 0];
  }

  /**
   * The deviations of a kind at all stretches, without `shift` ([x, y, z] in mm): {deviation (0 if unknown), value: its
   * size, NaN if unknown}. An unknown one is interpolated.
   */
  function valued(curves, kind, shift = [0, 0, 0]) {
    const count = curves.place_mm.length / 3;
    if (kind === 'wanted' || !has(curves, kind)) return {deviation: new Float32Array(3 * count), value: new Float32Array(count).fill(NaN)};
    const runs = feedRuns(curves.after_rapid);
    const {largest} = curves.quantities[`${kind}_mm`];
    const vectors = filled(curves[`place_${kind}_mm`], 3, curves.s_mm, runs);
    const moved = vectors.map((v, i) => v - shift[i % 3]);
    const size = (i) => Math.hypot(moved[3 * i], moved[3 * i + 1], moved[3 * i + 2]);
    const isShifted = shift.some((v) => v !== 0);
    const value = largest.map((v, i) => (isShifted || Number.isNaN(v) ? size(i) : v));
    return {deviation: moved.map((v) => (Number.isFinite(v) ? v : 0)), value};
  }

  /**
   * The path of one run and kind, relative to `origin` (mm, machine frame), as points: {count, place, deviation, value,
   * fraction (0 to 1 of `range` {low, high}; -1 if unknown), rapid (1: a rapid leads to here), stretch: of each point,
   * last: the last point of each stretch}. An arc has more points than its stretch.
   */
  function build(curves, kind, origin, range, shift) {
    const place = Float32Array.from(curves.place_mm, (v, i) => v - origin[i % 3]);
    const path = counterflex.arcs.refined({place, rapid: curves.after_rapid, direction: curves.direction, ...valued(curves, kind, shift)});
    const size = range.high - range.low;
    path.fraction = path.value.map((v) => (Number.isNaN(v) ? -1 : size > 0 ? (v - range.low) / size : 0));
    return path;
  }

  /** The drawn place of point `i` of a path: [x, y, z]. */
  const drawnAt = ({place, deviation}, i, factor) =>
    [0, 1, 2].map((k) => place[3 * i + k] + factor * deviation[3 * i + k]);

  /** The box around the drawn path and the wanted path. */
  function boxOf(path, factor) {
    const drawn = path.place.map((v, i) => v + factor * path.deviation[i]);
    return bounds([{place_mm: path.place}, {place_mm: drawn}]);
  }

  counterflex.pathModel = {kinds, has, bounds, sizeOf, rangeOf, meanOf, valued, oneTwoFive, exaggeration, exaggerations, bearable,
    filled, feedRuns, build, drawnAt, boxOf};
})();
