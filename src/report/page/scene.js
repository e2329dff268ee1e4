'use strict';
/**
 * The path in space, coloured by deviation: `counterflex.scene.create(container, {runs, units, selection})`.
 * It draws on demand, on one 2-D canvas: the path with WebGL where there is any, else flat, and over it what
 * overlay.js draws.
 */
(() => {
  const {el} = counterflex.dom;
  const hint = 'Drag: turn. Shift or right button: move. Wheel (after a click), + and \u2212: zoom. Double click, 0: fit. '
    + 'Click on the path, \u2190 \u2192: choose a place. Shift + arrows: turn. Ctrl + arrows: move.';
  const titles = {wanted: () => 'Wanted path', before: (unit) => `Deviation before, ${unit}`,
    after: (unit) => `Model residual after, ${unit}`};

  const usable = (run) => Boolean(run.curves) && run.curves.place_mm.length > 0;

  /** What does not change: the runs' common box and origin, and the largest deviations of all runs. */
  function survey(runs) {
    const all = runs.filter(usable).map((run) => run.curves);
    const box = counterflex.pathModel.bounds(all);
    const most = {wanted: 0, before: counterflex.pathModel.largest(all, 'before'),
      after: counterflex.pathModel.largest(all, 'after')};
    const size = counterflex.pathModel.sizeOf(box);
    return {most, size, origin: box.low.map((v, i) => (v + box.high[i]) / 2),
      usual: counterflex.pathModel.exaggeration(size, most.before || most.after),
      steps: counterflex.pathModel.exaggerations(size, [most.before, most.after])};
  }

  /** The elements of the view inside the container. */
  function furnish(container, controls) {
    const canvas = el('canvas', {class: 'scene-canvas'});
    const stage = el('div', {class: 'scene-stage', tabindex: 0, role: 'application',
      'aria-label': `The path in space. ${hint}`}, canvas);
    const said = el('p', {class: 'scene-said', 'aria-live': 'polite'});
    const paper = el('canvas', {class: 'scene-print'});
    const root = el('div', {class: 'scene-view'}, controls.element, stage, paper,
      el('p', {class: 'scene-hint'}, hint), said);
    container.append(root);
    return {root, stage, canvas, paper, said};
  }

  /**
   * The layers of a picture, from the bottom: rapids, the wanted path, and the one that is shown. What `covers` hides
   * what is behind it; the wanted path beside another never does.
   */
  function layersOf({path, kind, factor}, theme) {
    const base = {path, factor: 0, opacity: 1, covers: false, dash: [], width: 2, colour: theme.muted};
    const dot = path.count === 1 ? 4 : 1;
    const rapids = {...base, factor, style: 'rapid', width: 1.2, dash: [5, 4], opacity: 0.8};
    const wanted = {...base, style: 'plain', covers: kind === 'wanted', colour: theme.ink, opacity: kind === 'wanted' ? 1 : 0.45,
      width: (kind === 'wanted' ? 2.5 : 1.2) * dot};
    const shown = {...base, factor, style: 'deviation', covers: true, width: 4 * dot};
    return kind === 'wanted' ? [rapids, wanted] : [rapids, wanted, shown];
  }

  const linesOf = ({first_line, last_line}, i) => (first_line[i] === last_line[i] ? `line ${first_line[i]}`
    : `lines ${first_line[i]} to ${last_line[i]}`);

  /** "line 12: 4.1 um" of a stretch, without the deviation where that is unknown or not shown. */
  function wordsOf(curves, kind, i, units) {
    const value = curves.quantities[`${kind}_mm`]?.largest[i];
    const most = curves.first_line[i] === curves.last_line[i] ? '' : 'up to ';
    return linesOf(curves, i) + (Number.isFinite(value) ? `: ${most}${units.format(value)}` : '');
  }

  /** The distance from `centre` within which the box lies. */
  const reachOf = (centre, {low, high}) =>
    1 + Math.hypot(...centre.map((v, i) => Math.max(Math.abs(low[i] - v), Math.abs(high[i] - v))));

  /** The view of runs that have a path: see create. */
  class Scene {
    constructor(container, {runs, units, selection}) {
      Object.assign(this, {container, runs, units, selection, hover: -1, frame: 0, said: ''});
      this.facts = survey(runs);
      this.run = usable(runs[selection.run]  ?? {}) ? selection.run : runs.findIndex(usable);
      this.kind = ['before', 'after', 'wanted'].find((kind) => this.knows(kind));
      this.factor = this.facts.usual;
      this.camera = {...counterflex.camera.views.isometric, centre: [0, 0, 0], span: 1, fitted: true};
      this.controls = counterflex.sceneControls.create(this.choices(), {show: (kind) => this.show(kind, this.run),
        run: (run) => this.show(this.kind, run), exaggerate: (factor) => this.exaggerate(factor),
        look: (view) => this.look(view)});
      this.parts = furnish(container, this.controls);
      this.view = counterflex.ribbonView.create(() => this.fallBack()) || counterflex.flatView.create();
      this.rebuild();
      this.listen();
      this.draw();
    }

    knows(kind, run = this.run) {
      return usable(this.runs[run]) && counterflex.pathModel.has(this.runs[run].curves, kind);
    }

    choices() {
      const anywhere = (value) => this.runs.some((_, run) => this.knows(value, run));
      return {kinds: counterflex.pathModel.kinds.map((value) => ({value, enabled: anywhere(value)})),
        runs: this.runs.map((run) => ({text: [run.letter, run.name].filter(Boolean).join(': '), enabled: usable(run)})),
        steps: this.facts.steps, usual: this.facts.usual};
    }

    /** Where WebGL goes away while the page is open. */
    fallBack() {
      this.view = counterflex.flatView.create();
      this.schedule();
    }

    rebuild() {
      this.path = counterflex.pathModel.build(this.runs[this.run].curves, this.kind, this.facts.origin,
        this.facts.most[this.kind]);
      this.reshape();
    }

    reshape() {
      this.box = counterflex.pathModel.boxOf(this.path, this.factor);
      this.picturePoints = null;
      this.controls.update(this);
    }

    listen() {
      const size = () => this.size();
      counterflex.sceneInput.listen(this.parts.stage, {
        turn: (dx, dy) => this.move(counterflex.camera.turn(this.camera, -0.01 * dx, 0.01 * dy)),
        pan: (dx, dy) => this.move(counterflex.camera.pan(this.camera, size(), dx, dy)),
        zoom: (factor, at) => this.zoom(factor, at),
        pick: (x, y, reach) => this.pick(x, y, reach),
        hover: (x, y) => this.pointAt(x, y),
        step: (count) => this.step(count),
        look: (view) => this.look(view),
      });
      this.selection.subscribe(() => this.selected());
      if (typeof ResizeObserver !== 'undefined') new ResizeObserver(() => this.schedule()).observe(this.parts.stage);
    }

    size() {
      const {clientWidth, clientHeight} = this.parts.stage;
      return {width: clientWidth, height: clientHeight, ratio: Math.min(2, window.devicePixelRatio || 1)};
    }

    move(camera) {
      this.camera = camera;
      this.picturePoints = null;
      this.hover = -1;
      this.schedule();
    }

    zoom(factor, at) {
      const size = this.size();
      const limits = [1e-4 * this.facts.size, 20 * this.facts.size];
      this.move(counterflex.camera.zoom(this.camera, size, factor, at || [size.width / 2, size.height / 2], limits));
    }

    look(view) {
      this.move({...this.camera, ...counterflex.camera.views[view], fitted: true});
    }

    /** The stretch that is selected in the run shown, -1 for none. */
    chosen() {
      const {run, stretch} = this.selection;
      return run === this.run && stretch >= 0 && stretch < this.path.count ? stretch : -1;
    }

    pick(x, y, reach) {
      const stretch = this.nearest(x, y, reach);
      if (stretch >= 0) this.selection.set(this.run, stretch);
    }

    pointAt(x, y) {
      const stretch = x < 0 ? -1 : this.nearest(x, y, 10);
      if (stretch === this.hover) return;
      this.hover = stretch;
      this.schedule();
    }

    nearest(x, y, reach) {
      this.picturePoints = this.picturePoints || counterflex.pick.projected(this.path, this.factor,
        counterflex.camera.projector(this.camera, this.size()));
      return counterflex.pick.nearest(this.picturePoints, this.path.rapid, x, y, reach);
    }

    step(count) {
      const from = this.chosen();
      const to = from < 0 ? 0 : Math.min(this.path.count - 1, Math.max(0, from + count));
      this.selection.set(this.run, to);
    }

    /** Follows the selection: shows its run, and brings its place into the picture where it is outside. */
    selected() {
      const {run} = this.selection;
      if (run !== this.run && usable(this.runs[run] ?? {})) this.show(this.kind, run);
      const stretch = this.chosen();
      if (stretch >= 0 && !this.inView(stretch)) this.centreOn(stretch, this.camera.span);
      this.schedule();
    }

    inView(stretch) {
      const size = this.size();
      const [x, y] = counterflex.camera.projector(this.camera, size)(...this.placeOf(stretch));
      return this.camera.fitted || (x > 20 && y > 20 && x < size.width - 20 && y < size.height - 20);
    }

    placeOf(stretch) {
      return counterflex.pathModel.drawnAt(this.path, stretch, this.factor);
    }

    centreOn(stretch, span) {
      this.move({...this.camera, centre: this.placeOf(stretch), span, fitted: false});
    }

    show(kind, run) {
      this.run = usable(this.runs[run] ?? {}) ? run : this.run;
      this.kind = this.knows(kind) ? kind : 'wanted';
      this.hover = -1;
      this.rebuild();
      this.schedule();
    }

    exaggerate(factor) {
      this.factor = factor > 0 ? factor : this.facts.usual;
      this.reshape();
      this.schedule();
    }

    goTo(run, stretch) {
      if (run !== this.run) this.show(this.kind, run);
      if (run !== this.run || !(stretch >= 0 && stretch < this.path.count)) return;
      this.fitWhereWanted(this.size());
      this.centreOn(stretch, Math.min(this.camera.span, 0.3 * this.facts.size));
    }

    schedule() {
      if (this.frame === 0) this.frame = requestAnimationFrame(() => this.draw());
    }

    fitWhereWanted(size) {
      if (this.camera.fitted && size.width > 0)
        this.camera = counterflex.camera.fit(this.camera, this.box, size, 70);
    }

    /** The marks of the selected place and of the one under the mouse. */
    marks(camera, size) {
      const project = counterflex.camera.projector(camera, size);
      const mark = (stretch, radius) => {
        const [x, y] = project(...this.placeOf(stretch));
        return {x, y, radius, text: wordsOf(this.runs[this.run].curves, this.kind, stretch, this.units)};
      };
      const chosen = this.chosen();
      const hover = this.hover >= 0 && this.hover !== chosen ? [mark(this.hover, 4)] : [];
      return chosen >= 0 ? [...hover, mark(chosen, 7)] : hover;
    }

    /** Draws on a canvas of `size`; `theme` as colours.js has it. */
    paint(canvas, size, theme, camera) {
      canvas.width = Math.round(size.width * size.ratio);
      canvas.height = Math.round(size.height * size.ratio);
      const context = canvas.getContext('2d');
      const mostMm = this.facts.most[this.kind];
      const toleranceMm = Number(this.runs[this.run].report.options?.['tolerance-mm']);
      this.view.draw(context, size, {theme, camera, layers: layersOf(this, theme),
        reach: reachOf(camera.centre, this.box)});
      counterflex.overlay.draw(context, size, {theme, camera, units: this.units, marks: this.marks(camera, size),
        bar: {title: titles[this.kind](this.units.label), mostMm, toleranceMm},
        factor: this.kind === 'wanted' ? 0 : this.factor});
    }

    draw() {
      cancelAnimationFrame(this.frame);
      this.frame = 0;
      const size = this.size();
      if (size.width === 0 || size.height === 0) return;
      const span = this.camera.span;
      this.fitWhereWanted(size);
      if (span !== this.camera.span) this.picturePoints = null;
      this.paint(this.parts.canvas, size, counterflex.colours.themeOf(this.container), this.camera);
      this.tell();
    }

    /** For screen readers, and in data attributes of the view for those who test or script it. */
    tell() {
      const stretch = this.chosen();
      const text = stretch < 0 ? '' : wordsOf(this.runs[this.run].curves, this.kind, stretch, this.units);
      if (text !== this.said) this.parts.said.textContent = this.said = text;
      const centre = this.camera.centre.map((v, i) => (v + this.facts.origin[i]).toFixed(3));
      Object.assign(this.parts.root.dataset, {renderer: this.view.name, kind: this.kind, run: this.run,
        factor: this.factor, stretch, centre: centre.join(' '), span: this.camera.span.toPrecision(6)});
    }

    drawForPrint() {
      const size = {width: 960, height: 560, ratio: 2};
      const camera = this.camera.fitted ? counterflex.camera.fit(this.camera, this.box, size, 70) : this.camera;
      this.paint(this.parts.paper, size, counterflex.colours.paper, camera);
    }
  }

  /** A sentence where there is nothing to draw. */
  function createEmpty(container) {
    container.append(el('p', {class: 'scene-empty'}, 'The path cannot be shown: this report has no curves.'));
    const nothing = () => {};
    return {show: nothing, exaggerate: nothing, themeChanged: nothing, unitChanged: nothing, goTo: nothing,
      resize: nothing, drawForPrint: nothing};
  }

  /**
   * Builds the view inside `container`. `runs`: decoded runs; `units`: {format(mm), number(mm), label}; `selection`:
   * {run, stretch, subscribe(fn), set(run, stretch)}. Drawn when it returns, if the container has a size.
   */
  function create(container, options) {
    if (!options.runs.some(usable)) return createEmpty(container);
    const scene = new Scene(container, options);
    const draw = () => scene.schedule();
    return {show: (kind, run = scene.run) => scene.show(kind, run), exaggerate: (factor) => scene.exaggerate(factor),
      goTo: (run, stretch) => scene.goTo(run, stretch), themeChanged: draw, unitChanged: draw, resize: draw,
      drawForPrint: () => scene.drawForPrint()};
  }

  counterflex.scene = {create};
})();
