'use strict';
(() => {
  const root = document.documentElement;
  const dark = window.matchMedia('(prefers-color-scheme: dark)');
  const listeners = [];
  let chosen = 'auto';
  let printing = false;

  /** Paper is always white. */
  function apply() {
    const resolved = printing ? 'light' : chosen === 'auto' ? (dark.matches ? 'dark' : 'light') : chosen;
    if (root.dataset.theme === resolved) return;
    root.dataset.theme = resolved;
    for (const listener of listeners) listener();
  }

  dark.addEventListener('change', apply);
  apply();

  /** The current value of a colour of the style sheet. */
  const colour = (name) => getComputedStyle(root).getPropertyValue(name).trim();

  counterflex.theme = {
    names: ['auto', 'light', 'dark'],
    get chosen() { return chosen; },
    set(theme) {
      chosen = theme;
      apply();
    },
    setPrinting(on) {
      printing = on;
      apply();
    },
    subscribe: (listener) => listeners.push(listener),
    colour,
  };
})();
