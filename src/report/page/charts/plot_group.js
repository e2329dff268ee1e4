'use strict';
(() => {
  const {el, fill} = counterflex.dom;

  /**
   * Plots over the same path length. They zoom and pan together and show their values at one place. `context`: {runs,
   * units, selection}. Lengths here are in mm; the axes show units of the path.
   */
  function create(context) {
    const {runs, units} = context;
    const total = Math.max(...runs.map((run) => run.report.summary.path_mm || 0), ...runs.map(endOf), 1e-3);
    const group = {
      plots: [],
      total,
      window: null,
      frame: 0,
      shown: {blocks: true, rapids: true, steps: true},
      marks: runs.map((run) => counterflex.marks.of(run)),  // only those of the selected run are drawn
      /** Shows path length `range` (mm) in all plots; null: all of it. */
      setWindow(range) {
        group.window = range && clamped(range, total);
        for (const plot of group.plots) plot.showWindow();
      },
      /** Zooms by `factor` about the middle, and moves by `share` of the visible range. */
      zoom(factor, share) {
        const [from, to] = group.window || [0, total];
        const middle = (from + to) / 2 + share * (to - from), half = ((to - from) / 2) * factor;
        group.setWindow(2 * half >= total ? null : [middle - half, middle + half]);
      },
      /** Shows values at path length `s` (mm) in all plots; null: in none. */
      hover(s, from) {
        for (const plot of group.plots) if (plot !== from) plot.showValues(s);
        const run = runs[context.selection.run].curves ? context.selection.run : runs.findIndex((each) => each.curves);
        if (run < 0) return;
        const stretch = s === null ? -1 : counterflex.data.stretchAt(runs[run].curves, s);
        if (context.program) context.program.point(run, stretch);
        if (context.scene) context.scene.point(run, stretch);
      },
      /** Draws marks again, once for all calls before the next frame. */
      redraw() {
        cancelAnimationFrame(group.frame);
        group.frame = requestAnimationFrame(() => group.plots.forEach((plot) => plot.redraw()));
      },
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

  /** The range on the path nearest to `range` with the same length. */
  function clamped([from, to], total) {
    const length = Math.min(to - from, total);
    const begin = Math.min(Math.max(from, 0), total - length);
    return [begin, begin + length];
  }

  /** Shows a place with its neighbourhood: its block if it is long, and at least a fiftieth of the path. */
  function neighbourhood(group, curves, i) {
    const line = curves.first_line[i];
    let first = i, last = i;
    while (first > 0 && curves.last_line[first - 1] === line) --first;
    while (last + 1 < curves.s_mm.length && curves.first_line[last + 1] === line) ++last;
    const begin = first > 0 ? curves.s_mm[first - 1] : 0, end = curves.s_mm[last];
    const least = group.total / 50, most = group.total / 3;
    const length = Math.min(Math.max(1.5 * (end - begin), least), most);
    const middle = end - begin > most ? curves.s_mm[i] : (begin + end) / 2;
    return [middle - length / 2, middle + length / 2];
  }

  function button(text, label, click) {
    return el('button', {type: 'button', 'aria-label': label, title: label, click}, text);
  }

  /** The run whose marks are drawn. */
  function marksTitle({runs, selection}) {
    const node = el('legend', {class: 'marks-title'});
    const update = () => fill(node, runs.length > 1 ? `Marks of ${runs[selection.run].letter}` : 'Marks');
    selection.subscribe(update);
    update();
    return node;
  }

  /** Whether marks of a kind are drawn. */
  function markBox(group, key, text) {
    const change = (event) => {
      group.shown[key] = event.target.checked;
      group.redraw();
    };
    return el('label', null, el('input', {type: 'checkbox', checked: group.shown[key], change}), el('span', null, text));
  }

  /** Buttons for the actions of the mouse, for keyboard and touch. */
  function controls(context, group) {
    const buttons = [button('+', 'Zoom in', () => group.zoom(0.5, 0)),
      button('\u2212', 'Zoom out', () => group.zoom(2, 0)),
      button('\u25c0', 'Back along the path', () => group.zoom(1, -0.25)),
      button('\u25b6', 'Forward along the path', () => group.zoom(1, 0.25)),
      button('All', 'The whole path', () => group.setWindow(null))];
    const boxes = [['blocks', 'blocks'], ['rapids', 'rapids'], ['steps', 'force steps']];
    return el('div', {class: 'controls'},
        el('div', {class: 'buttons', role: 'group', 'aria-label': 'Part of the path'}, buttons),
        el('fieldset', {class: 'choice'}, marksTitle(context),
            boxes.map(([key, text]) => markBox(group, key, text))));
  }

  counterflex.plotGroup = {create, controls, neighbourhood};
})();
