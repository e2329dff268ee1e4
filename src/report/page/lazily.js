'use strict';
(() => {
  /** Builds plots when they come into view, a little before they do. */
  counterflex.lazily = (plots) => {
    const observer = new IntersectionObserver((entries) => {
      for (const entry of entries) {
        if (!entry.isIntersecting) continue;
        observer.unobserve(entry.target);
        const plot = plots.find(({host}) => host === entry.target);
        plot.ensure();
      }
    }, {rootMargin: '200px'});
    for (const plot of plots) observer.observe(plot.host);
  };
})();
