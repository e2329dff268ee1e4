'use strict';
(() => {
  const {jump} = counterflex.dom;

  /** The first stretch of a run that holds a line of the program; -1: the path has none. */
  function stretchOf(curves, line) {
    return curves ? curves.first_line.findIndex((first, i) => first <= line && line <= curves.last_line[i]) : -1;
  }

  /** A line number that takes the views there where the path has the line; a dash where there is no line. */
  function link(context, run, line) {
    if (!(line > 0)) return '\u2013';
    const stretch = stretchOf(context.runs[run].curves, line);
    if (stretch < 0) return String(line);
    return jump(String(line), 'curves', () => context.goTo(run, stretch), `Line ${line}: show it in all views`);
  }

  counterflex.lines = {stretchOf, link};
})();
