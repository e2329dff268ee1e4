'use strict';
/**
 * One picture of the path view: the path, its layers, its words, and drawing them on a canvas. `shown` is {curves,
 * letter, tolerance_mm, kind, run, factor, path, range, shift, box}: the content, independent of the camera.
 */
(() => {
  const titles = {wanted: () => 'Wanted path', before: (unit) => `Deviation before, ${unit}`,
    shifted: (unit) => `Before, without the common shift, ${unit}`,
    after: (unit) => `Model residual after, ${unit}`};

  const kindOfData = (kind) => (kind === 'shifted' ? 'before' : kind);

  const usable = (run) => Boolean(run && run.curves) && run.curves.place_mm.length > 0;

  /** "A: before calibration", or its known part. */
  const nameOf = ({letter, name}) => [...new Set([letter, name])].filter(Boolean).join(': ');

  /** The name of a file with a picture. */
  const fileName = (run, kind) => counterflex.chartFiles.nameOf(run, `path_${kind}`);

  /** Whether a run has a path of that kind. */
  const knows = (run, kind) => usable(run) && counterflex.pathModel.has(run.curves, kindOfData(kind));

  /** The shift of a run that touching off the part removes: of its datum, if the report has one, else the mean. */
  function shiftOf({report, curves}) {
    const {offsets = []} = (report.summary && report.summary.common_shift) || {};
    return offsets.length === 1 ? offsets[0].shift_mm : counterflex.pathModel.meanOf(curves, 'before');
  }

  /** Shared by all pictures: the common origin and size of the runs, and the ranges of their deviations, mm. */
  function survey(runs) {
    const {pathModel} = counterflex;
    const present = runs.filter(usable);
    const all = present.map((run) => run.curves);
    const box = pathModel.bounds(all);
    const range = (kind) => pathModel.rangeOf(all.map((curves) => pathModel.valued(curves, kind)));
    const ranges = {wanted: {low: 0, high: 0}, before: range('before'), after: range('after'),
      shifted: pathModel.rangeOf(present.map((run) => pathModel.valued(run.curves, 'before', shiftOf(run))))};
    const most = Object.fromEntries(Object.entries(ranges).map(([kind, {high}]) => [kind, high]));
    const size = pathModel.sizeOf(box);
    return {most, ranges, size, origin: box.low.map((v, i) => (v + box.high[i]) / 2),
      usual: (kind) => pathModel.exaggeration(size, most[kind]),
      steps: pathModel.exaggerations(size, Object.values(most))};
  }

  /**
   * The pictures for paper: for each run its path before and after, or else the wanted path, each with `factor` or a
   * smaller one if needed.
   */
  function printed(facts, runs, factor) {
    return runs.flatMap((run, index) => {
      const known = ['before', 'after'].filter((kind) => knows(run, kind));
      const kinds = known.length > 0 ? known : ['wanted'].filter((kind) => knows(run, kind));
      const bearable = (kind) => counterflex.pathModel.bearable(factor, facts.size, facts.most[kind]);
      return kinds.map((kind) => describe(facts, runs, index, kind, bearable(kind)));
    });
  }

  /** The title of a picture, with the letter of the run if there are two. */
  const titleOf = ({kind, letter}, unit) => (letter ? `${letter}: ` : '') + titles[kind](unit);

  /** `shown` for a run's path of a kind, exaggerated by `factor`; 'shifted': before, without the common shift. */
  function describe(facts, runs, run, kind, factor) {
    const {curves, report, letter} = runs[run];
    const shift = kind === 'shifted' ? shiftOf(runs[run]) : undefined;
    const range = facts.ranges[kind];
    const path = counterflex.pathModel.build(curves, kindOfData(kind), facts.origin, range, shift);
    const tolerance_mm = Number((report.options || {})['tolerance-mm']);
    return exaggerated({curves, letter, tolerance_mm, kind, run, path, range, shift}, factor);
  }

  const exaggerated = (shown, factor) =>
    ({...shown, factor, box: counterflex.pathModel.boxOf(shown.path, factor)});

  /**
   * The layers of a picture, from the bottom: rapids, the wanted path, and the shown path. A layer that `covers` hides
   * layers behind it; the wanted path beside another path never does.
   */
  function layers({path, kind, factor}, theme) {
    const alone = kind === 'wanted';
    const dot = path.count === 1 ? 4 : 1;
    const base = {path, factor: 0, opacity: 1, covers: false, dash: [], width: 2, colour: theme.muted};
    const rapids = {...base, factor, style: 'rapid', width: 1.2, dash: [5, 4], opacity: 0.8};
    const wanted = {...base, style: 'plain', covers: alone, colour: theme.ink, opacity: alone ? 1 : 0.45,
      width: (alone ? 2.5 : 1.2) * dot};
    return alone ? [rapids, wanted]
      : [rapids, wanted, {...base, factor, style: 'deviation', covers: true, width: 4 * dot}];
  }

  /**
   * "line 12: 4.1 µm" for a stretch: "up to" if it has several waypoints, "about" if the deviation is interpolated from
   * its neighbours; only the line if it is unknown or not shown.
   */
  function words({curves, kind, path}, i, units) {
    const [first, last] = [curves.first_line[i], curves.last_line[i]];
    const lines = first === last ? `line ${first}` : `lines ${first} to ${last}`;
    const point = path.last[i];
    if (kind === 'wanted' || path.fraction[point] < 0) return lines;
    const isKnown = Number.isFinite(curves.quantities[`${kindOfData(kind)}_mm`].largest[i]);
    const single = first === last && !(curves.waypoints_per_stretch > 1);
    return `${lines}: ${!isKnown ? 'about ' : single ? '' : 'up to '}${units.format(path.value[point])}`;
  }

  /** The drawn place of a stretch: [x, y, z], mm from the origin. */
  const placeOf = ({path, factor}, stretch) => counterflex.pathModel.drawnAt(path, path.last[stretch], factor);

  /** The radius around `centre` that includes the box. */
  const reachOf = (centre, {low, high}) =>
    1 + Math.hypot(...centre.map((v, i) => Math.max(Math.abs(low[i] - v), Math.abs(high[i] - v))));

  function mark({stretch, radius}, shown, project, units) {
    const [x, y] = project(...placeOf(shown, stretch));
    return {x, y, radius, text: words(shown, stretch, units)};
  }

  /** The notes of the picture, the lowest line first. */
  function notes({kind, factor, path, shift}, units) {
    const rapids = path.rapid.some((rapid, i) => rapid && i > 0) ? ['dashed: rapids'] : [];
    return kind === 'wanted' ? rapids
      : [`deviation \u00d7 ${factor}`, ['thin: wanted path', ...rapids].join(', '),
        ...(shift ? [`common shift x, y, z: ${shift.map(units.number).join(', ')} ${units.label}`] : [])];
  }

  /**
   * Draws `shown` with a `view` (flat or WebGL) on a canvas of `size` = {width, height, ratio}. `marked`: places with
   * a ring and a label, {stretch, radius in pixels}. `machine`: {lines, origin} of skeleton.js, or undefined;
   * `forces`: whether arrows of the force are drawn.
   */
  function paint(view, canvas, size, {shown, theme, camera, units, marked, machine, forces}) {
    canvas.width = Math.round(size.width * size.ratio);
    canvas.height = Math.round(size.height * size.ratio);
    const context = canvas.getContext('2d');
    const project = counterflex.camera.projector(camera, size);
    view.draw(context, size, {theme, camera, layers: layers(shown, theme), reach: reachOf(camera.centre, shown.box)});
    if (machine) counterflex.skeleton.draw(context, machine, project, theme);
    if (forces)
      counterflex.forceArrows.draw(context, size, {curves: shown.curves, placeOf: (stretch) => placeOf(shown, stretch), camera, project, theme});
    counterflex.overlay.draw(context, size, {theme, camera, units,
      marks: marked.map((each) => mark(each, shown, project, units)),
      bar: {title: titleOf(shown, units.label), range: shown.range, letter: shown.letter, tolerance_mm: shown.tolerance_mm},
      notes: notes(shown, units)});
  }

  counterflex.scenePicture = {usable, nameOf, fileName, knows, survey, describe, printed, titleOf, exaggerated, words, placeOf, paint};
})();
