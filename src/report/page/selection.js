'use strict';
(() => {
  /** The selected stretch of a run, shared by all views, or -1. Subscribers are called after a change. */
  counterflex.selection = {
    create() {
      const listeners = [];
      const selection = {
        run: 0,
        stretch: -1,
        subscribe: (listener) => listeners.push(listener),
        set(run, stretch) {
          if (run === selection.run && stretch === selection.stretch) return;
          selection.run = run;
          selection.stretch = stretch;
          for (const listener of listeners) listener(run, stretch);
        },
      };
      return selection;
    },
  };
})();
