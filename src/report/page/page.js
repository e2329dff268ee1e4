'use strict';
(() => {
  const {el, fill} = counterflex.dom;
  const root = document.documentElement;

  const body = (id) => document.querySelector(`#${id} .body`);

  function hide(id) {
    document.getElementById(id).hidden = true;
  }

  function goToSection(id) {
    const section = document.getElementById(id);
    section.scrollIntoView({block: 'start'});
    section.tabIndex = -1;
    section.focus({preventScroll: true});
  }

  /** Shared by all parts of the page. */
  function contextOf(runs, conclusion) {
    const shown = (runs[0].report.units || {}).shown || 'um';
    const units = counterflex.units.create(shown), selection = counterflex.selection.create();
    return {runs, conclusion, units, selection, scene: null, program: null, group: null, plots: []};
  }

  /** Sections of text and tables. A change of unit renders them again. */
  function renderTexts(context) {
    const {tables, remarks, facts} = counterflex;
    const sections = {failure: counterflex.failure.render, operations: tables.operations, sensitivity: tables.sensitivity, remarks: remarks.render,
      numbers: tables.numbers, program: facts.program, facts: facts.render};
    fill(document.getElementById('verdict'), counterflex.summary.render(context));
    fill(body('worst'), counterflex.worst.render(context));
    document.getElementById('worst').hidden = !context.runs.some((run) => run.report.worst.length > 0);
    for (const [id, render] of Object.entries(sections)) {
      const content = render(context);
      document.getElementById(id).hidden = content === null;
      fill(body(id), content);
    }
    fill(document.getElementById('load-tables'), counterflex.loads.render(context));
    fill(document.getElementById('axis-tables'), counterflex.axes.render(context));
    renderPlace(context);
  }

  /** The values at the selected place; `row`: of the worst blocks, if it was chosen there. Null without a place. */
  function placeOf(run, stretch, row) {
    if (run.curves && stretch >= 0) return counterflex.place.ofStretch(run, stretch, row || undefined);
    return row ? counterflex.place.ofRow(row) : null;
  }

  /** The card of the selected place. */
  function renderPlace(context) {
    const {selection, runs, row} = context;
    const run = runs[selection.run];
    const chosen = row && row.run === selection.run && row.stretch === selection.stretch ? row.row : null;
    const known = placeOf(run, selection.stretch, chosen);
    fill(body('place'), known ? counterflex.place.card(run, known, context.units) : el('p', null, 'No place is selected.'));
    counterflex.worst.mark(body('worst'), selection.run, chosen ? chosen.line : -1);
  }

  function selectRow(context, run, row) {
    const {curves} = context.runs[run];
    const stretch = curves ? counterflex.worst.stretchOf(curves, row) : -1;
    context.row = {run, stretch, row};
    context.selection.set(run, stretch);
    renderPlace(context);
    return stretch;
  }

  /** Shows a row of the worst blocks in all views. */
  function goToRow(context, run, row) {
    const stretch = selectRow(context, run, row);
    document.getElementById('place').scrollIntoView({block: 'nearest'});
    if (stretch >= 0) showStretch(context, run, stretch);
  }

  /** Zooms curves and path to a stretch and selects it. */
  function showStretch(context, run, stretch) {
    const {curves} = context.runs[run];
    context.selection.set(run, stretch);
    context.group.setWindow(counterflex.plotGroup.neighbourhood(context.group, curves, stretch));
    if (context.scene) context.scene.goTo(run, stretch);
  }

  /** Shows a stretch of the path in all views, and scrolls to its cause. */
  function goTo(context, run, stretch) {
    showStretch(context, run, stretch);
    goToSection('place');
  }

  /** Zooms the curves to an operation. */
  function goToOperation(context, run, index) {
    const {curves} = context.runs[run];
    goToSection('curves');
    if (!curves) return;
    const [first, last] = counterflex.lines.ofOperation(curves, index, context.runs[run].report.operations[index]);
    if (first < 0) return;
    const begin = first > 0 ? curves.s_mm[first - 1] : 0;
    context.group.setWindow([begin, Math.max(curves.s_mm[last], begin + context.group.total / 1000)]);
    context.selection.set(run, first);
    if (context.scene) context.scene.goTo(run, first);
  }

  function addPlots(context, id, made) {
    if (!made || made.plots.length === 0) return false;
    fill(body(id), made.content);
    context.plots.push(...made.plots);
    return true;
  }

  /** Holes have no length to draw over. */
  const hasPath = ({runs}) => runs.some(({report}) => report.summary.path_mm > 0);

  /** The section of the axes. Its plots, which it returns, are not printed. */
  function renderAxes(context, group) {
    const made = counterflex.axes.plots(context, group);
    const drawn = made && hasPath(context);
    fill(body('axes'), drawn && made.content, el('div', {id: 'axis-tables'}));
    document.getElementById('axes').hidden = made === null;
    return drawn ? made.plots : [];
  }

  function renderPlots(context) {
    const {curves, loads, plotGroup} = counterflex;
    const group = context.group = plotGroup.create(context);
    const points = curves.pointsOf(context);
    const sections = {curves: curves.deviations, sources: curves.sources, force: curves.force};
    for (const [id, make] of Object.entries(sections))
      if (!addPlots(context, id, make(context, group, points))) hide(id);
    const tables = el('div', {id: 'load-tables'});
    const drawn = hasPath(context) && addPlots(context, 'loads', loads.plots(context, group));
    body('loads').append(tables);
    if (!drawn && !loads.exist(context)) hide('loads');
    for (const plot of context.plots.slice(0, 2)) plot.ensure();
    counterflex.lazily([...context.plots.slice(2), ...renderAxes(context, group)]);
  }

  function renderScene(context) {
    const {runs, units, selection} = context;
    if (!counterflex.scene || !runs.some((run) => run.curves)) return hide('path');
    context.program = counterflex.programView.create(context);
    document.getElementById('code-view').append(context.program.element);
    const hovered = (run, stretch) => context.program.point(run, stretch);
    context.scene = counterflex.scene.create(document.getElementById('path-view'), {runs, units, selection, hovered});
    units.subscribe(() => context.scene.unitChanged());
    counterflex.theme.subscribe(() => context.scene.themeChanged());
    window.addEventListener('resize', () => context.scene.resize());
  }

  /**
   * Selects the place to show first: that of a failed verification, else the largest deviation before, which the first
   * card has, else the first of the worst blocks. A hole of a cycle is in no stretch.
   */
  function selectFirst(context) {
    const {runs, selection} = context;
    const failed = runs.findIndex((run) => counterflex.failure.stretchOf(run) >= 0);
    if (failed >= 0) return selection.set(failed, counterflex.failure.stretchOf(runs[failed]));
    const run = runs.findIndex(({report}) => report.worst.length > 0);
    if (run < 0) return hide('place');
    const {curves, report} = runs[run];
    const line = report.summary.before ? report.summary.before.max_line : 0;
    const stretch = curves && line > 0 ? counterflex.lines.stretchOf(curves, line, 'before_mm') : -1;
    const row = report.worst.find((one) => one.line === line);
    if (stretch < 0) return selectRow(context, run, row || report.worst[0]);
    if (row) context.row = {run, stretch, row};
    selection.set(run, stretch);
  }

  function start(json) {
    const {data} = counterflex;
    const runs = data.decode(json);
    const context = contextOf(runs, data.conclusion(json));
    root.dataset.runs = runs.length;
    context.goToRow = (run, row) => goToRow(context, run, row);
    context.goTo = (run, stretch) => goTo(context, run, stretch);
    context.goToOperation = (run, index) => goToOperation(context, run, index);
    counterflex.toolbar.render(document.getElementById('tools'), context.units);
    renderPlots(context);
    renderTexts(context);
    renderScene(context);
    context.units.subscribe(() => renderTexts(context));
    context.selection.subscribe(() => renderPlace(context));
    selectFirst(context);
    renderPlace(context);
    counterflex.toolbar.contents(document.getElementById('contents'));
    counterflex.paper(context);
    counterflex.context = context;
  }

  function ready() {
    root.dataset.ready = 'yes';
    performance.mark('counterflex-ready');
  }

  /** Shows a message if the page cannot be drawn. */
  function fail(error) {
    root.dataset.ready = 'failed';
    const text = `This report could not be drawn: ${error.message}. The same numbers are in the JSON file beside it.`;
    document.getElementById('main').prepend(el('p', {class: 'trouble', role: 'alert'}, text));
    console.error(error);
  }

  counterflex.goToSection = goToSection;

  document.addEventListener('DOMContentLoaded', () => {
    try {
      start(JSON.parse(document.getElementById('counterflex-data').textContent));
      ready();
    } catch (error) {
      fail(error);
    }
  });
})();
