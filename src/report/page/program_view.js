'use strict';
/** The program beside the path: the lines around the place that is shown, and a slider that plays the path. */
(() => {
  const {el, fill} = counterflex.dom;
  const around = 5, near = 2;  // lines above and below the current one; on a phone
  const playTime = 20000;  // ms for the whole path

  /** One line. A click selects its place. */
  function lineNode(run, number, current, go) {
    const isCurrent = number >= current[0] && number <= current[1];
    const distance = number < current[0] ? current[0] - number : number - current[0];
    return el('div', {class: `code-line ${isCurrent ? 'current' : ''} ${distance > near ? 'far' : ''}`, 'data-line': number,
      'aria-current': isCurrent ? 'true' : null, click: () => go(number)},
        el('span', {class: 'code-number', 'aria-hidden': 'true'}, String(number)), el('code', null, run.source.lines[number - 1]));
  }

  function showLines(node, run, stretch, go) {
    const {curves, source: {lines}} = run;
    if (lines.length === 0) return fill(node, el('p', {class: 'note'}, 'The text of the program is not in this page: it is longer than 2 MB.'));
    const first = stretch < 0 ? 1 : curves.first_line[stretch], last = stretch < 0 ? 0 : curves.last_line[stretch];
    const from = Math.max(1, Math.min(first - around, lines.length - 2 * around));
    const to = Math.min(lines.length, from + 2 * around);
    fill(node, Array.from({length: Math.max(0, to - from + 1)}, (_, i) => lineNode(run, from + i, [first, last], go)));
  }

  /** Moves along the path until its end, or until it is stopped. `move(s)`: to a path length. */
  function player(button, total, place, move) {
    let timer = 0, start = 0, begin = 0;
    const show = () => {
      fill(button, timer ? '\u275a\u275a' : '\u25b6');
      button.setAttribute('aria-label', timer ? 'Stop' : 'Play the path');
    };
    const stop = () => {
      clearTimeout(timer);
      timer = 0;
      show();
    };
    const step = () => {
      const s = begin + ((performance.now() - start) / playTime) * total();
      move(Math.min(s, total()));
      if (s >= total()) return stop();
      timer = setTimeout(step, 80);
    };
    button.addEventListener('click', () => {
      if (timer) return stop();
      begin = place() >= total() - 1e-9 ? 0 : place();
      start = performance.now();
      timer = setTimeout(step, 0);
      show();
    });
    show();
    return stop;
  }

  /**
   * The view for the runs of `context`: {element, point(run, stretch): shows the place under the mouse, -1: the selected
   * one}. It follows the selection.
   */
  function create({runs, selection}) {
    const lines = el('div', {class: 'code-lines'});
    const slider = el('input', {type: 'range', class: 'code-slider', min: 0, step: 1, 'aria-label': 'Place on the path'});
    const button = el('button', {type: 'button', class: 'code-play'});
    const usable = (index) => (runs[index].curves ? index : runs.findIndex((run) => run.curves));
    const curvesOf = () => runs[usable(selection.run)].curves;
    const select = (stretch) => selection.set(usable(selection.run), stretch);
    const go = (line) => {
      const stretch = counterflex.lines.stretchOf(curvesOf(), line);
      if (stretch >= 0) select(stretch);
    };
    const show = (index, stretch) => showLines(lines, runs[index], stretch, go);
    const total = () => curvesOf().s_mm[curvesOf().s_mm.length - 1];
    const stop = player(button, total, () => (selection.stretch < 0 ? 0 : curvesOf().s_mm[selection.stretch]),
        (s) => select(counterflex.data.stretchAt(curvesOf(), s)));
    slider.addEventListener('input', () => {
      stop();
      select(Number(slider.value));
    });
    const selected = () => {
      const index = usable(selection.run);
      const stretch = index === selection.run ? selection.stretch : -1;
      slider.max = runs[index].curves.s_mm.length - 1;
      slider.value = Math.max(0, stretch);
      slider.setAttribute('aria-valuetext', stretch < 0 ? 'no place' : counterflex.lines.words(runs[index].curves, stretch));
      show(index, stretch);
    };
    selection.subscribe(selected);
    selected();
    return {element: el('div', {class: 'code-view'}, el('div', {class: 'code-player'}, button, slider), lines),
      point: (index, stretch) => (stretch < 0 ? selected() : show(index, stretch))};
  }

  counterflex.programView = {create};
})();
