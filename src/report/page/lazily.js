'use strict';
(() => {
  const soon = window.requestIdleCallback || ((work) => setTimeout(work, 20));

  /** Builds plots one after another while the page has nothing else to do. */
  counterflex.lazily = (plots) => {
    const [next, ...rest] = plots;
    if (!next) return;
    soon(() => {
      next.ensure();
      counterflex.lazily(rest);
    });
  };
})();
