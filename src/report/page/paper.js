'use strict';
(() => {
  let printing = false;

  /** All plots and the view, light and as wide as paper; and back. */
  function set(on, {plots, scene}) {
    if (printing === on) return;
    printing = on;
    document.documentElement.toggleAttribute('data-printing', on);
    counterflex.theme.setPrinting(on);
    for (const plot of plots) plot.setPrinting(on);
    if (scene && on) scene.drawForPrint();
    if (scene && !on) scene.resize();
  }

  /** Redraws before and after printing, whoever began it. */
  counterflex.paper = (views) => {
    window.addEventListener('beforeprint', () => set(true, views));
    window.addEventListener('afterprint', () => set(false, views));
    window.matchMedia('print').addEventListener('change', (event) => set(event.matches, views));
  };
})();
