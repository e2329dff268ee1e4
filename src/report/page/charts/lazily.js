'use strict';
(() => {
  const soon = window.requestIdleCallback || ((work) => setTimeout(work, 20));

  /** Builds plots one after another while the page is idle. */
  counterflex.lazily = (plots) => {
    const [next, ...rest] = plots;
    if (!next) return;
    soon(() => {
      next.ensure();
      counterflex.lazily(rest);
    });
  };
})();
