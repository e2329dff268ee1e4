'use strict';
/** Vectors along the path: deviations, their causes and corrections at a stretch. Pure functions of decoded curves. */
(() => {
  const axes = ['x', 'y', 'z'];

  const norm = (v) => Math.hypot(...v);
  const sum = (vectors) => vectors.reduce((total, v) => total.map((c, k) => c + v[k]), [0, 0, 0]);

  /** A function that gives the vector of a quantity at a stretch, NaN if unknown; null if the curves do not have it. */
  function reader(curves, base) {
    const columns = axes.map((axis) => curves.quantities[`${base}_${axis}_mm`]);
    if (columns.some((column) => !column)) return null;
    return (i) => columns.map((column) => column.largest[i]);
  }

  /** The nearest stretch with a known vector from `i` in steps of `step`, on the same feed run; -1 without one. */
  function neighbour(curves, read, i, step) {
    for (let k = i; k >= 0 && k < curves.s_mm.length; k += step) {
      if (step > 0 && k > i && curves.after_rapid[k]) return -1;
      if (read(k).every(Number.isFinite)) return k;
      if (step < 0 && curves.after_rapid[k]) return -1;
    }
    return -1;
  }

  /**
   * The vector of a quantity at stretch `i`: {vector, about: whether it is interpolated}; null if unknown. Stretches of
   * several waypoints have no vectors.
   */
  function at(curves, base, i) {
    const read = curves.waypoints_per_stretch > 1 ? null : reader(curves, base);
    if (!read) return null;
    const a = neighbour(curves, read, i, -1), b = neighbour(curves, read, i, 1);
    if (a < 0 && b < 0) return null;
    if (a < 0 || b < 0 || a === b) return {vector: read(a < 0 ? b : a), about: a !== i && b !== i};
    const length = curves.s_mm[b] - curves.s_mm[a];
    const t = length > 0 ? (curves.s_mm[i] - curves.s_mm[a]) / length : 0;
    const [from, to] = [read(a), read(b)];
    return {vector: from.map((v, k) => v + t * (to[k] - v)), about: true};
  }

  /** The causes at a place of the report, [{key, name, vector}]. */
  function causesOf(place) {
    const vectors = {...place, discrepancy_mm: place.before_mm.map((v, k) => v - place.superposition_mm[k])};
    return counterflex.words.allParts.filter(({key}) => vectors[key]).map(({key, name}) => ({key, name, vector: vectors[key]}));
  }

  /** Sizes of causes under the keys of a report's row. */
  const sizesOf = (causes) => Object.fromEntries(causes.map(({key, vector}) => [key, norm(vector)]));

  counterflex.vectors = {at, norm, sum, causesOf, sizesOf};
})();
