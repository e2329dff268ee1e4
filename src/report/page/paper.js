'use strict';
(() => {
  let printing = false;

  /** A text as a string of CSS. */
  const quoted = (text) => `"${text.replace(/["\\\n<]/g, (c) => `\\${c.charCodeAt(0).toString(16)} `)}"`;

  /** The foot of each page: program and machine, the day, and the number of the page. */
  function setFoot(title) {
    const box = (where, content) => `@${where} { content: ${content}; font: 8pt sans-serif; color: #555; }`;
    const day = new Date().toLocaleDateString('sv');  // 2026-01-31
    const sheet = new CSSStyleSheet();
    sheet.replaceSync(`@page { ${box('bottom-left', quoted(title))} ${box('bottom-center', quoted(`printed ${day}`))}
        ${box('bottom-right', '"page " counter(page) " of " counter(pages)')} }`);
    document.adoptedStyleSheets = [...document.adoptedStyleSheets, sheet];
  }

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
    setFoot(document.title);
    window.addEventListener('beforeprint', () => set(true, views));
    window.addEventListener('afterprint', () => set(false, views));
    window.matchMedia('print').addEventListener('change', (event) => set(event.matches, views));
  };
})();
