'use strict';
(() => {
  const {data} = counterflex;

  /**
   * Plots over the same path length: they zoom and pan together and show their values at one place. `context`: {runs,
   * units, selection}; what is in mm here is in units of the path on the axes.
   */
  function create(context) {
    const {runs, units} = context;
    const total = Math.max(...runs.map((run) => run.report.summary.path_mm || 0), ...runs.map(endOf), 1e-3);
    const group = {
      plots: [],
      total,
      window: null,
      shown: {blocks: true, rapids: true, steps: true},
      marks: counterflex.marks.of(runs[0]),
      /** Shows path length `range` (mm) in all plots; null: all of it. */
      setWindow(range) {
        group.window = range && clamped(range, total);
        for (const plot of group.plots) plot.showWindow();
      },
      /** Zooms by `factor` about the middle, and moves by `share` of what is in view. */
      zoom(factor, share) {
        const [from, to] = group.window || [0, total];
        const middle = (from + to) / 2 + share * (to - from), half = ((to - from) / 2) * factor;
        group.setWindow(2 * half >= total ? null : [middle - half, middle + half]);
      },
      /** Shows values at path length `s` (mm) in all plots; null: in none. */
      hover(s, from) {
        for (const plot of group.plots) if (plot !== from) plot.showValues(s);
      },
      redraw: () => group.plots.forEach((plot) => plot.redraw()),
      refresh: () => group.plots.forEach((plot) => plot.refresh()),
      /** Path length of the selected stretch; NaN: none. */
      selected() {
        const {run, stretch} = context.selection;
        const curves = runs[run] && runs[run].curves;
        return curves && stretch >= 0 ? curves.s_mm[stretch] : NaN;
      },
    };
    context.selection.subscribe(group.redraw);
    units.subscribe(group.refresh);
    counterflex.theme.subscribe(group.refresh);
    return group;
  }

  function endOf(run) {
    return run.curves ? run.curves.s_mm[run.curves.s_mm.length - 1] : 0;
  }

  /** The part of the path nearest to `range` that is as long. */
  function clamped([from, to], total) {
    const length = Math.min(to - from, total);
    const begin = Math.min(Math.max(from, 0), total - length);
    return [begin, begin + length];
  }

  /** Shows a place with its neighbourhood: its block, where that is long, and at least a fiftieth of the path. */
  function neighbourhood(group, curves, i) {
    const line = curves.first_line[i];
    let first = i, last = i;
    while (first > 0 && curves.last_line[first - 1] === line) --first;
    while (last + 1 < curves.s_mm.length && curves.first_line[last + 1] === line) ++last;
    const begin = first > 0 ? curves.s_mm[first - 1] : 0, end = curves.s_mm[last];
    const least = group.total / 50, most = group.total / 3, length = Math.min(Math.max(1.5 * (end - begin), least), most);
    const middle = end - begin > most ? curves.s_mm[i] : (begin + end) / 2;
    return [middle - length / 2, middle + length / 2];
  }

  const button = (text, label, click) => counterflex.dom.el('button', {type: 'button', 'aria-label': label, title: label, click}, text);

  /** Buttons that do what the mouse does, for the keyboard and for fingers. */
  function controls(group) {
    const {el} = counterflex.dom;
    const box = (key, text) => el('label', null, el('input', {type: 'checkbox', checked: group.shown[key], change: (event) => {
      group.shown[key] = event.target.checked;
      group.redraw();
    }}), el('span', null, text));
    return el('div', {class: 'controls'},
        el('div', {class: 'buttons', role: 'group', 'aria-label': 'Part of the path'},
            button('+', 'Zoom in', () => group.zoom(0.5, 0)), button('\u2212', 'Zoom out', () => group.zoom(2, 0)),
            button('\u25c0', 'Back along the path', () => group.zoom(1, -0.25)), button('\u25b6', 'On along the path', () => group.zoom(1, 0.25)),
            button('All', 'The whole path', () => group.setWindow(null))),
        el('fieldset', {class: 'choice'}, el('legend', null, 'Marks'), box('blocks', 'blocks'), box('rapids', 'rapids'), box('steps', 'force steps')));
  }

  counterflex.plotGroup = {create, controls, neighbourhood};
})();
