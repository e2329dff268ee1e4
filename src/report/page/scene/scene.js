'use strict';
/**
 * The path in space, coloured by deviation: `counterflex.scene.create(container, {runs, units, selection, hovered})`.
 * It draws on demand, on one 2-D canvas: the path with WebGL if available, else flat, and the overlay of overlay.js.
 */
(() => {
  const {el} = counterflex.dom;
  const picture = counterflex.scenePicture;
  const {skeleton, pathModel} = counterflex;
  const largestMachine = 2;  // times the path: a larger machine is shown only after a click
  const margin = [30, 84];  // pixels beside a fitted path, and above and below for scales and axes
  /** Sizes of one printed picture, of two and of more in a row. Texts are smaller in a picture of more pixels. */
  const paperSizes = {1: {width: 800, height: 400, ratio: 3}, 2: {width: 520, height: 270, ratio: 4},
    3: {width: 300, height: 230, ratio: 6}};
  const hint = 'Drag: turn. Shift or right button: move. Wheel (after a click), + and \u2212: zoom. '
    + 'Double click, 0: fit. Click on the path, \u2190 \u2192: choose a place. '
    + 'Shift + arrows: turn. Ctrl + arrows: move.';

  /** The elements of the view inside the container. */
  function furnish(container, controls) {
    const canvas = el('canvas', {class: 'scene-canvas'});
    const stage = el('div', {class: 'scene-stage', tabindex: 0, role: 'application',
      'aria-label': `The path in space. ${hint}`}, canvas);
    const status = el('p', {class: 'scene-status', 'aria-live': 'polite'});
    const paper = el('div', {class: 'scene-print'});
    const root = el('div', {class: 'scene-view'}, controls, stage, paper, el('p', {class: 'scene-hint'}, hint), status);
    container.append(root);
    return {root, stage, canvas, paper, status};
  }

  /** The view of runs; at least one has a path. */
  class Scene {
    constructor(container, {runs, units, selection, hovered}) {
      Object.assign(this, {container, runs, units, selection, hovered, hover: -1, frame: 0, points: null, ownFactor: false, withForces: false});
      this.facts = picture.survey(runs);
      this.machines = runs.map((run) => (skeleton.usable(run) ? {linesAt: skeleton.follow(run), box: this.relative(skeleton.boxOf(run.machine))} : null));
      const run = picture.usable(runs[selection.run]) ? selection.run : runs.findIndex(picture.usable);
      const kind = ['after', 'before', 'wanted'].find((each) => picture.knows(runs[run], each));
      this.camera = {...counterflex.camera.views.isometric, centre: [0, 0, 0], span: 1, fitted: true};
      this.controls = counterflex.sceneControls.create(this.choices(), this.acts());
      this.parts = furnish(container, this.controls.element);
      this.view = counterflex.ribbonView.create(() => this.fallBack()) || counterflex.flatView.create();
      const machine = this.machines[run];
      this.withMachine = Boolean(machine) && pathModel.sizeOf(machine.box) <= largestMachine * this.facts.size;
      this.present(picture.describe(this.facts, runs, run, kind, this.facts.usual(kind)));
      this.listen();
      this.draw();
    }

    choices() {
      const anywhere = (kind) => this.runs.some((run) => picture.knows(run, kind));
      return {kinds: counterflex.pathModel.kinds.map((value) => ({value, enabled: anywhere(value)})),
        runs: this.runs.map((run) => ({text: picture.nameOf(run), enabled: picture.usable(run)})),
        steps: this.facts.steps, machine: this.machines.some(Boolean), forces: this.runs.some(counterflex.forceArrows.usable)};
    }

    /** A box relative to the origin of the pictures. */
    relative({low, high}) {
      const moved = (place) => place.map((v, i) => v - this.facts.origin[i]);
      return {low: moved(low), high: moved(high)};
    }

    /** The machine of the run shown, or null if it is not to be shown. */
    machine() {
      return this.withMachine ? this.machines[this.shown.run] : null;
    }

    /** Its lines at the place under the mouse, else at the selected one: for `picture.paint`. */
    machineLines() {
      const machine = this.machine();
      const stretch = this.has(this.hover) ? this.hover : Math.max(0, this.chosen());
      return machine ? {lines: machine.linesAt(stretch), origin: this.facts.origin} : undefined;
    }

    /** Shows or hides the machine, with a camera that fits it or the path. */
    showMachine(on) {
      this.withMachine = on;
      this.move({...this.camera, fitted: true});
    }

    /** Shows or hides the arrows of the force. */
    showForces(on) {
      this.withForces = on;
      this.schedule();
    }

    /** The box of what is shown. */
    box() {
      const machine = this.machine();
      return machine ? pathModel.bounds([this.shown.box, machine.box].map(({low, high}) => ({place_mm: [...low, ...high]}))) : this.shown.box;
    }

    /** Actions of controls, mouse and keys. */
    acts() {
      return {
        show: (kind) => this.show(kind, this.shown.run),
        run: (run) => this.show(this.shown.kind, run),
        exaggerate: (factor) => this.exaggerate(factor),
        machine: (on) => this.showMachine(on),
        forces: (on) => this.showForces(on),
        save: () => counterflex.chartFiles.saveCanvas(this.parts.canvas, picture.fileName(this.runs[this.shown.run], this.shown.kind)),
        look: (name) => this.move({...this.camera, ...counterflex.camera.views[name], fitted: true}),
        turn: (dx, dy) => this.move(counterflex.camera.turn(this.camera, -0.01 * dx, 0.01 * dy)),
        pan: (dx, dy) => this.move(counterflex.camera.pan(this.camera, this.size(), dx, dy)),
        zoom: (factor, at) => this.zoom(factor, at),
        pick: (x, y, reach) => this.pick(x, y, reach),
        hover: (x, y) => this.pointAt(x, y),
        step: (count) => this.step(count),
      };
    }

    listen() {
      counterflex.sceneInput.listen(this.parts.stage, this.acts());
      this.selection.subscribe(() => this.selected());
      if (typeof ResizeObserver !== 'undefined') new ResizeObserver(() => this.schedule()).observe(this.parts.stage);
    }

    /** Called if WebGL is lost while the page is open. */
    fallBack() {
      this.view = counterflex.flatView.create();
      this.schedule();
    }

    /** Shows another path or exaggeration with the same camera. */
    present(shown) {
      this.shown = shown;
      this.hover = -1;
      this.points = null;
      this.controls.update(shown, this.withMachine, this.withForces);
      this.schedule();
    }

    /**
     * Without that run or kind: the run as before, or the wanted path. Each kind has its usual factor, unless the user
     * chose one that is not absurd.
     */
    show(kind, index) {
      const run = picture.usable(this.runs[index]) ? index : this.shown.run;
      const known = picture.knows(this.runs[run], kind) ? kind : 'wanted';
      const usual = this.facts.usual(known);
      const own = counterflex.pathModel.bearable(this.shown.factor, this.facts.size, this.facts.most[known]);
      const factor = known === 'wanted' || known === this.shown.kind ? this.shown.factor : this.ownFactor ? own : usual;
      this.present(picture.describe(this.facts, this.runs, run, known, factor));
    }

    /** 0: the usual factor. */
    exaggerate(factor) {
      this.ownFactor = factor > 0;
      this.present(picture.exaggerated(this.shown, this.ownFactor ? factor : this.facts.usual(this.shown.kind)));
    }

    size() {
      const {clientWidth, clientHeight} = this.parts.stage;
      return {width: clientWidth, height: clientHeight, ratio: Math.min(2, window.devicePixelRatio || 1)};
    }

    move(camera) {
      this.camera = camera;
      this.hover = -1;
      this.points = null;
      this.schedule();
    }

    zoom(factor, at) {
      const size = this.size();
      const limits = [1e-4 * this.facts.size, 20 * pathModel.sizeOf(this.box())];
      this.move(counterflex.camera.zoom(this.camera, size, factor, at || [size.width / 2, size.height / 2], limits));
    }

    /** The stretch that is selected in the run shown, -1 for none. */
    chosen() {
      const {run, stretch} = this.selection;
      return run === this.shown.run && this.has(stretch) ? stretch : -1;
    }

    has(stretch) {
      return Number.isInteger(stretch) && stretch >= 0 && stretch < this.shown.path.last.length;
    }

    nearest(x, y, reach) {
      this.points = this.points || counterflex.pick.projected(this.shown.path, this.shown.factor,
        counterflex.camera.projector(this.camera, this.size()));
      const point = counterflex.pick.nearest(this.points, this.shown.path.rapid, x, y, reach);
      return point < 0 ? -1 : this.shown.path.stretch[point];
    }

    pick(x, y, reach) {
      const stretch = this.nearest(x, y, reach);
      if (stretch >= 0) this.selection.set(this.shown.run, stretch);
    }

    pointAt(x, y) {
      const stretch = x < 0 ? -1 : this.nearest(x, y, 10);
      if (stretch === this.hover) return;
      this.hover = stretch;
      this.hovered(this.shown.run, stretch);
      this.schedule();
    }

    /** The place under the mouse in another view. */
    point(run, stretch) {
      if (run !== this.shown.run || stretch === this.hover) return;
      this.hover = stretch;
      this.schedule();
    }

    step(count) {
      const from = this.chosen();
      const to = from < 0 ? 0 : Math.min(this.shown.path.last.length - 1, Math.max(0, from + count));
      this.selection.set(this.shown.run, to);
    }

    /** Follows the selection: shows its run, and moves its place into the picture. */
    selected() {
      const {run} = this.selection;
      if (run !== this.shown.run && picture.usable(this.runs[run])) this.show(this.shown.kind, run);
      const stretch = this.chosen();
      if (stretch >= 0 && !this.inView(stretch)) this.centreOn(stretch, this.camera.span);
      this.schedule();
    }

    inView(stretch) {
      const size = this.size();
      const [x, y] = counterflex.camera.projector(this.camera, size)(...picture.placeOf(this.shown, stretch));
      return this.camera.fitted || (x > 20 && y > 20 && x < size.width - 20 && y < size.height - 20);
    }

    centreOn(stretch, span) {
      this.move({...this.camera, centre: picture.placeOf(this.shown, stretch), span, fitted: false});
    }

    goTo(run, stretch) {
      if (run !== this.shown.run) this.show(this.shown.kind, run);
      if (run !== this.shown.run || !this.has(stretch)) return;
      this.camera = this.fitted(this.size());
      this.centreOn(stretch, Math.min(this.camera.span, 0.3 * this.facts.size));
    }

    schedule() {
      if (this.frame === 0) this.frame = requestAnimationFrame(() => this.draw());
    }

    /** The camera with the same direction and the whole path in a picture of that size. */
    whole(size, box = this.box()) {
      return counterflex.camera.fit(this.camera, box, size, margin);
    }

    /** The camera for a picture of that size: fitted again unless it was moved by hand. */
    fitted(size) {
      return this.camera.fitted && size.width > 0 ? this.whole(size) : this.camera;
    }

    marked() {
      const chosen = this.chosen();
      const hover = this.hover >= 0 && this.hover !== chosen ? [{stretch: this.hover, radius: 4}] : [];
      return chosen >= 0 ? [...hover, {stretch: chosen, radius: 7}] : hover;
    }

    draw() {
      cancelAnimationFrame(this.frame);
      this.frame = 0;
      const size = this.size();
      if (size.width === 0 || size.height === 0) return;
      const {span} = this.camera;
      this.camera = this.fitted(size);
      if (span !== this.camera.span) this.points = null;
      picture.paint(this.view, this.parts.canvas, size, {shown: this.shown, camera: this.camera, units: this.units,
        theme: counterflex.colours.themeOf(this.container), marked: this.marked(), machine: this.machineLines(),
        forces: this.withForces});
      this.announce();
    }

    /** State for screen readers, and in data attributes of the view for tests and scripts. */
    announce() {
      const stretch = this.chosen();
      const text = stretch < 0 ? '' : picture.words(this.shown, stretch, this.units);
      if (text !== this.parts.status.textContent) this.parts.status.textContent = text;
      const centre = this.camera.centre.map((v, i) => (v + this.facts.origin[i]).toFixed(3));
      const degrees = (angle) => Math.round((angle * 180) / Math.PI);
      const {kind, run, factor} = this.shown;
      Object.assign(this.parts.root.dataset, {renderer: this.view.name, kind, run, factor, stretch,
        centre: centre.join(' '), span: this.camera.span.toPrecision(6),
        machine: this.machineTip(), forces: this.withForces, azimuth: degrees(this.camera.azimuth), elevation: degrees(this.camera.elevation)});
    }

    /** The tip of the machine that is shown; '' without one. */
    machineTip() {
      const {lines} = this.machineLines() || {lines: []};
      return lines.flat().slice(-1).map((tip) => tip.map((v) => v.toFixed(1)).join(' ')).join('');
    }

    /** For paper: the whole path of each run, before and after. */
    drawForPrint() {
      const pictures = picture.printed(this.facts, this.runs, this.shown.factor);
      const size = paperSizes[Math.min(pictures.length, 3)];
      const chosen = this.chosen();
      const canvases = pictures.map((shown) => {
        const canvas = el('canvas', {class: 'scene-paper', 'data-run': shown.run, 'data-kind': shown.kind,
          'data-factor': shown.factor});
        const marked = chosen >= 0 && shown.run === this.shown.run ? [{stretch: chosen, radius: 7}] : [];
        picture.paint(this.view, canvas, size, {shown, camera: this.whole(size, shown.box), units: this.units,
          theme: counterflex.colours.paper, marked});
        return canvas;
      });
      this.parts.paper.replaceChildren(...canvases);
    }
  }

  /** A sentence for a report without curves. */
  function createEmpty(container) {
    container.append(el('p', {class: 'scene-empty'}, 'The path cannot be shown: this report has no curves.'));
    const nothing = () => {};
    return {show: nothing, exaggerate: nothing, point: nothing, themeChanged: nothing, unitChanged: nothing, goTo: nothing,
      resize: nothing, drawForPrint: nothing};
  }

  /**
   * Builds the view inside `container`. `runs`: decoded runs; `units`: of units.js; `selection`: of selection.js;
   * `hovered(run, stretch)`: called with the stretch under the mouse, -1 for none.
   * Drawn when it returns, if the container has a size.
   */
  function create(container, options) {
    if (!options.runs.some(picture.usable)) return createEmpty(container);
    const scene = new Scene(container, options);
    const draw = () => scene.schedule();
    return {show: (kind, run = scene.shown.run) => scene.show(kind, run),
      exaggerate: (factor) => scene.exaggerate(factor), goTo: (run, stretch) => scene.goTo(run, stretch), point: (run, stretch) => scene.point(run, stretch),
      themeChanged: draw, unitChanged: draw, resize: draw, drawForPrint: () => scene.drawForPrint()};
  }

  counterflex.scene = {create};
})();
