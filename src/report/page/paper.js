'use strict';
(() => {
  let printing = false;

  /** Draws all plots and the view for paper, light and as wide as the paper, or for the screen again. */
  function set(on, {plots, scene}) {
    if (printing === on) return;
    printing = on;
    document.documentElement.toggleAttribute('data-printing', on);
    counterflex.theme.setPrinting(on);
    for (const plot of plots) plot.setPrinting(on);
    if (scene && on) scene.drawForPrint();
    if (scene && !on) scene.resize();
  }

  /** Redraws before and after printing, for any way to start it. */
  counterflex.paper = (views) => {
    window.addEventListener('beforeprint', () => set(true, views));
    window.addEventListener('afterprint', () => set(false, views));
    window.matchMedia('print').addEventListener('change', (event) => set(event.matches, views));
  };
})();
