import assert from 'node:assert/strict';
import test from 'node:test';
import {load_scripts, plain} from './load_scripts.mjs';

const {scenePicture} = load_scripts('colours.js', 'camera.js', 'arcs.js', 'path_model.js', 'overlay.js', 'scene_picture.js');
const units = {format: (mm) => `${(1000 * mm).toFixed(1)} um`};

/** A run whose deviations before are these, along x in steps of a mm, in z. */
function run_of(before, lines = before.map((_, i) => [i + 1, i + 1])) {
  const places = Float32Array.from(before.flatMap((_, i) => [i, 0, 0]));
  const curves = {s_mm: Float64Array.from(before, (_, i) => i), place_mm: places,
    place_before_mm: Float32Array.from(before.flatMap((v) => (Number.isNaN(v) ? [v, v, v] : [0, 0, v]))),
    place_after_mm: places.map(() => NaN), after_rapid: Uint8Array.from(before, (_, i) => (i === 0 ? 1 : 0)),
    first_line: Int32Array.from(lines, (l) => l[0]), last_line: Int32Array.from(lines, (l) => l[1]),
    quantities: {before_mm: {largest: Float32Array.from(before)}}};
  return {name: '', report: {options: {'tolerance-mm': 0.005}}, curves};
}

function shown(run, kind = 'before') {
  return scenePicture.describe(scenePicture.survey([run]), [run], 0, kind, 10);
}

test('a place is called by its line and deviation', () => {
  assert.equal(scenePicture.words(shown(run_of([0.1, 0.2])), 1, units), 'line 2: 200.0 um');
});

test('a stretch of several lines shows them, and marks its deviation as the largest', () => {
  const several = run_of([0.1, 0.2], [[1, 4], [5, 9]]);
  assert.equal(scenePicture.words(shown(several), 0, units), 'lines 1 to 4: up to 100.0 um');
});

test('a stretch of several waypoints of one line is marked, too', () => {
  const merged = run_of([0.1, 0.2]);
  merged.curves.waypoints_per_stretch = 8;
  assert.equal(scenePicture.words(shown(merged), 1, units), 'line 2: up to 200.0 um');
});

test('an interpolated deviation is marked as "about", an unknown one is not shown', () => {
  assert.equal(scenePicture.words(shown(run_of([0.1, NaN, 0.2])), 1, units), 'line 2: about 150.0 um');
  assert.equal(scenePicture.words(shown(run_of([0.1, 0.2]), 'after'), 0, units), 'line 1');
  assert.equal(scenePicture.words(shown(run_of([0.1, 0.2]), 'wanted'), 0, units), 'line 1');
});

test('runs share origin, colours and exaggeration, so that they can be compared', () => {
  const [one, other] = [run_of([0.1, 0.1]), run_of([0.4, 0.4, 0.4])];
  const facts = scenePicture.survey([one, other]);
  assert.ok(Math.abs(facts.most.before - 0.4) < 1e-6);
  assert.deepEqual(plain(facts.origin), [1, 0, 0]);
  const fraction = (run) => scenePicture.describe(facts, [one, other], run, 'before', 1).path.fraction[0];
  assert.deepEqual([fraction(0), fraction(1)], [0, 1]);
});

test('a run without curves, or with empty ones, cannot be shown', () => {
  for (const run of [undefined, {curves: null}, {curves: {place_mm: new Float32Array(0)}}])
    assert.equal(scenePicture.usable(run), false);
});

test('a run is called by letter and name, once where they are the same', () => {
  assert.equal(scenePicture.nameOf({letter: 'A', name: 'before calibration'}), 'A: before calibration');
  assert.equal(scenePicture.nameOf({letter: 'B', name: 'B'}), 'B');
});

test('the tolerance is the one of the run', () => assert.equal(shown(run_of([0.1])).tolerance_mm, 0.005));

const with_after = (run, after) => {
  run.curves.place_after_mm = Float32Array.from(after.flatMap((v) => [0, 0, v]));
  run.curves.quantities.after_mm = {largest: Float32Array.from(after)};
  return run;
};

test('paper has the path before and after of each run, each with a suitable factor', () => {
  const runs = [{...with_after(run_of([0.4, 0.4, 0.4]), [0.001, 0.001, 0.001]), letter: 'A'}, {...run_of([0.1, 0.1]), letter: 'B'}];
  const facts = scenePicture.survey(runs);
  const printed = scenePicture.printed(facts, runs, 900);
  assert.deepEqual(plain(printed.map(({run, kind}) => [run, kind])), [[0, 'before'], [0, 'after'], [1, 'before']]);
  const size = (box) => box.high[2] - box.low[2];
  for (const {factor, box, kind} of printed)
    assert.ok(factor * facts.most[kind] <= 0.5 * facts.size && size(box) <= 0.5 * facts.size, `${kind} ${factor} ${size(box)}`);
  assert.equal(printed[1].factor, 900);
  assert.deepEqual(plain(printed.map((each) => scenePicture.titleOf(each, 'mm'))),
    ['A: Deviation before, mm', 'A: Model residual after, mm', 'B: Deviation before, mm']);
});

test('paper has the wanted path of a run without deviations, and no picture of a run without a path', () => {
  const wanted = run_of([NaN, NaN]);
  wanted.curves.quantities = {};
  const runs = [wanted, {curves: null, report: {}}];
  assert.deepEqual(plain(scenePicture.printed(scenePicture.survey(runs), runs, 10).map(({run, kind}) => [run, kind])), [[0, 'wanted']]);
  assert.equal(scenePicture.titleOf({kind: 'wanted', letter: ''}, 'mm'), 'Wanted path');
});
