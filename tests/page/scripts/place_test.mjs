import assert from 'node:assert/strict';
import test from 'node:test';
import {load_scripts, plain} from './load_scripts.mjs';

const {place, vectorSum, data} =
  load_scripts('page_data.js', 'units.js', 'dom.js', 'words.js', 'vectors.js', 'vector_sum.js', 'place.js');

/** Curves of stretches of these lines, each a mm long, deviations in x; NaN is not known. */
function run_of(lines, before, load = before, after_rapid = lines.map(() => 0)) {
  const of = (values) => ({least: values, largest: values}), zero = of(before.map(() => 0));
  const vector = (name, values) => ({[`${name}_x_mm`]: of(values), [`${name}_y_mm`]: zero, [`${name}_z_mm`]: zero, [`${name}_mm`]: of(values)});
  return {report: {}, source: {lines: [], output: ''}, curves: {s_mm: lines.map((_, i) => i + 1), first_line: lines, last_line: lines,
    operation: lines.map(() => -1), after_rapid, place_mm: new Float32Array(3 * lines.length), waypoints_per_stretch: 1,
    quantities: {...vector('before', before), ...vector('load', load), after_mm: of(before.map(() => 0.001))}}};
}

const told = (run, i, row) => {
  const {before_mm, about, sizes, after_mm} = place.ofStretch(run, i, row);
  return plain([before_mm, about, (sizes || {}).load_mm, after_mm]);
};

test('a stretch without a deviation before shows what is between its neighbours as "about"', () => {
  const run = run_of([5, 5, 5, 5, 5], [1, NaN, NaN, NaN, 2]);
  assert.deepEqual(told(run, 1), [1.25, true, 1.25, 0.001]);
  assert.deepEqual(told(run, 3), [1.75, true, 1.75, 0.001]);
  assert.deepEqual(told(run, 4), [2, false, 2, 0.001]);
});

test('the deviation and its causes at a place add up, also between two known places', () => {
  const run = run_of([5, 5, 5], [1, NaN, 3], [0.5, NaN, 1]);
  const {vectors, causes} = place.ofStretch(run, 1);
  assert.deepEqual(plain([vectors.before.vector, causes[0].vector]), [[2, 0, 0], [0.75, 0, 0]]);
});

test('all causes are in the sum of a place, that of the fixture too', () => {
  const run = run_of([5], [10], [3]), {quantities} = run.curves;
  for (const [i, base] of ['geometry', 'fixture', 'gravity', 'preloads', 'discrepancy'].entries())
    for (const axis of ['x', 'y', 'z']) quantities[`${base}_${axis}_mm`] = {largest: [axis === 'x' ? [1, 4, 0.5, 0.25, 1.25][i] : 0]};
  const {vectors, causes} = place.ofStretch(run, 0);
  assert.deepEqual(plain(causes.map(({key}) => key)), ['geometry_mm', 'load_mm', 'fixture_mm', 'gravity_mm', 'preloads_mm', 'discrepancy_mm']);
  assert.equal(causes.reduce((sum, {vector}) => sum + vector[0], 0), vectors.before.vector[0]);
});

test('values beyond a rapid are not used', () => {
  assert.deepEqual(told(run_of([5, 6, 7], [1, NaN, 3], undefined, [1, 1, 1]), 1), [null, false, null, 0.001]);
  assert.deepEqual(told(run_of([6], [NaN]), 0), [null, false, null, 0.001]);
});

test('a run without attribution shows the deviation, a chosen row has its own sizes of causes', () => {
  assert.deepEqual(told(run_of([5, 5], [1, 2], [NaN, NaN]), 1), [2, false, null, 0.001]);
  assert.deepEqual(told(run_of([5, 5], [1, 2], [NaN, NaN]), 1, {line: 5, causes: {load_mm: 7}}), [2, false, 7, 0.001]);
});

test('a stretch of several waypoints has the causes of the largest deviation of the run', () => {
  const run = run_of([5, 8, 9], [1, 3, 2]);
  run.curves.waypoints_per_stretch = 2;
  const at_worst = {line: 8, place_mm: [7, 0, 0], before_mm: [3, 0, 0], superposition_mm: [2, 0, 0], geometry_mm: [1.5, 0, 0], load_mm: [0.5, 0, 0]};
  run.report.summary = {sources: {at_worst}};
  const {vectors, causes, place_mm} = plain(place.ofStretch(run, 1));
  assert.deepEqual([vectors.before.vector, causes.map(({vector}) => vector[0]), place_mm], [[3, 0, 0], [1.5, 0.5, 1], [7, 0, 0]]);
  for (const [i, row] of [[0, undefined], [2, undefined], [1, {line: 7}]]) assert.equal(place.ofStretch(run, i, row).causes.length, 0);
  assert.match(place.mergedText(run, place.ofStretch(run, 1)), /^The causes are those at the largest deviation before\. .*stretch of 2 points\.$/);
  assert.match(place.mergedText(run, place.ofStretch(run, 2)), /^This is a stretch of 2 points\..* only for the largest deviation before, in line 8\.$/);
  assert.equal(place.mergedText(run_of([5], [1]), place.ofStretch(run_of([5], [1]), 0)), '');
  const row = {line: 9, before_mm: 1.5, after_mm: 0.0005};
  assert.deepEqual(told(run, 2, row), [1.5, false, null, 0.0005]);
});

test('the text of the line is in the program', () => {
  const run = run_of([2, 3], [1, 2]);
  run.source.lines = ['G21', 'G1 X5', 'Y5'];
  assert.equal(place.ofStretch(run, 0).text, 'G1 X5');
});

test('the bars of causes follow each other along each axis, and end where that of their sum does', () => {
  const rows = plain(vectorSum.spans([{vector: [1, -2, 0]}, {vector: [-3, -1, 0]}], [-2, -3, 0]));
  assert.deepEqual(rows[0], [[0, 1], [0, -2], [0, 0]]);
  assert.deepEqual(rows[1], [[1, -2], [-2, -3], [0, 0]]);
  assert.deepEqual(rows[2], [[0, -2], [0, -3], [0, 0]]);
});

test('the conclusion of two runs is a text, or empty', () => {
  assert.equal(data.conclusion({conclusion: 'B is off by less.'}), 'B is off by less.');
  for (const none of [{}, {conclusion: null}, {conclusion: 5}]) assert.equal(data.conclusion(none), '');
});
