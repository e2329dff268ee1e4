'use strict';
(() => {
  const scales = {
    um: {label: '\u00b5m', words: '\u00b5m', perMm: 1000, length: 'mm', lengthPerMm: 1, lengthDigits: 1},
    mm: {label: 'mm', words: 'mm', perMm: 1, length: 'mm', lengthPerMm: 1, lengthDigits: 1},
    inch: {label: 'in', words: 'inches', perMm: 1 / 25.4, length: 'in', lengthPerMm: 1 / 25.4, lengthDigits: 3},
  };

  /** Decimals of a deviation: about the resolution of workshop instruments, more for tiny values. */
  function decimals(unit, value) {
    const size = Math.abs(value);
    if (unit === 'um') return size >= 100 ? 0 : size >= 1 || size === 0 ? 1 : 2;
    if (unit === 'mm') return 4;
    return size >= 0.001 || size === 0 ? 5 : 6;
  }

  /** Whether a value is known. */
  const known = (value) => typeof value === 'number' && Number.isFinite(value);

  /**
   * The unit in which deviations are shown, one of 'um', 'mm', 'inch'. Lengths along the path are in mm for the first
   * two. Subscribers are called after each change.
   */
  function create(shown) {
    const listeners = [];
    const units = {
      names: Object.keys(scales),
      nameOf: (unit) => scales[unit].label,
      get shown() { return shown; },
      get label() { return scales[shown].label; },
      get words() { return scales[shown].words; },
      get lengthLabel() { return scales[shown].length; },
      get lengthScale() { return scales[shown].lengthPerMm; },
      get scale() { return scales[shown].perMm; },
      set(unit) {
        shown = unit;
        for (const listener of listeners) listener();
      },
      subscribe: (listener) => listeners.push(listener),
      number(mm) {
        if (!known(mm)) return '\u2013';
        const value = mm * scales[shown].perMm;
        return value.toFixed(decimals(shown, value));
      },
      format: (mm) => (known(mm) ? `${units.number(mm)} ${units.label}` : 'unknown'),
      lengthNumber: (mm) => (known(mm) ? (mm * units.lengthScale).toFixed(scales[shown].lengthDigits) : '\u2013'),
      length: (mm) => `${units.lengthNumber(mm)} ${units.lengthLabel}`,
    };
    return units;
  }

  /** A number with so many decimals, for values other than lengths. */
  const fixed = (value, digits) => (known(value) ? value.toFixed(digits) : '\u2013');

  /** Per cent, rounded down: never 100 % unless it is all. */
  function percent(value) {
    return known(value) ? `${(Math.floor(value * 10 + 1e-6) / 10).toFixed(value === 100 ? 0 : 1)} %` : '\u2013';
  }

  counterflex.units = {create, known, fixed, percent};
})();
