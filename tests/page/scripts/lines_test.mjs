import assert from 'node:assert/strict';
import test from 'node:test';
import {load_scripts, plain} from './load_scripts.mjs';

const {lines, loads, worst, series} =
  load_scripts('page_data.js', 'units.js', 'dom.js', 'words.js', 'lines.js', 'worst.js', 'series.js', 'loads.js');

/** Curves with stretches that end at `s_mm`, of these lines, and a quantity "before_mm". */
function curves_of(s_mm, line, before = line.map(() => 1)) {
  return {s_mm, first_line: line, last_line: line, quantities: {before_mm: {least: before, largest: before}}};
}

test('a place whose path length was rounded up stays in the stretch that ends there', () => {
  const curves = curves_of([10.12345674, 10.2, 12345.6784, 12346], [5, 5, 6, 6]);
  for (const [line, s, stretch] of [[5, 10.1234567, 0], [5, 10.1234568, 0], [5, 10.15, 1], [6, 12345.68, 2], [6, 12345.9, 3]]) {
    assert.equal(lines.stretchNear(curves, line, s), stretch, `${line} at ${s}`);
    assert.equal(worst.stretchOf(curves, {line, s_mm: s}), stretch, `${line} at ${s}`);
  }
});

test('a place is of its own line, also where another line ends or lies beside it', () => {
  const curves = curves_of([10, 20, 20, 30], [5, 6, 7, 8]);
  for (const [line, s, stretch] of [[5, 10, 0], [6, 10, 1], [6, 20, 1], [7, 20, 2], [8, 20, 3], [5, 28, 0], [8, 3, 3]])
    assert.equal(lines.stretchNear(curves, line, s), stretch, `${line} at ${s}`);
  assert.equal(lines.stretchNear(curves, 99, 15), 1);
});

test('a line is shown where the quantity in question is largest, by size and by the least as well', () => {
  const curves = curves_of([1, 2, 3, 4], [5, 6, 6, 6], [9, 1, NaN, 3]);
  assert.equal(lines.stretchOf(curves, 6, 'before_mm'), 3);
  curves.quantities.before_mm.least = [9, -7, NaN, 3];
  assert.equal(lines.stretchOf(curves, 6, 'before_mm'), 1);
  assert.equal(lines.stretchOf(curves, 6), 1);
  assert.equal(lines.stretchOf(curves, 6, 'air_mm'), 1);
  assert.equal(lines.stretchOf(curves, 7, 'before_mm'), -1);
  assert.equal(lines.stretchOf(null, 6), -1);
});

const run = {curves: curves_of([10.12345674, 20, 30], [5, 6, 7]),
  loads: {s_mm: [10.12346, 20, 25], line: [5, 6, 7], chains: [{name: 'x', moment_max_Nm: [1, null, 4]}]}};

test('a place of the loads is of its own line', () => {
  const points = series.along(run, run.loads);
  assert.deepEqual(plain(points.map(({line, stretch}) => [line, stretch])), [[5, 0], [6, 1], [7, 2]]);
  const {places} = series.tabulate([{run: 0, points, values: [1, 2, 3]}], 30, 1);
  assert.deepEqual(plain(places.map(({line}) => line)), [null, 5, 6, 7, null]);
});

test('the line of the largest load leads to where that load is largest', () => {
  assert.deepEqual(plain(loads.placeOfLargest(run, {name: 'x'}, 'moment_max_Nm')), {s_mm: 25});
  assert.deepEqual(plain(loads.placeOfLargest(run, {name: 'y'}, 'moment_max_Nm')), {});
  assert.deepEqual(plain(loads.placeOfLargest({loads: null}, {name: 'x'}, 'moment_max_Nm')), {});
});

test('an operation is shown where its lines are, where no merged stretch is of it', () => {
  const curves = {...curves_of([1, 2, 3], [5, 20, 40]), last_line: [19, 39, 60], operation: [0, 2, 2]};
  assert.deepEqual(plain(lines.ofOperation(curves, 2, {first_line: 30, last_line: 60})), [1, 2]);
  assert.deepEqual(plain(lines.ofOperation(curves, 1, {first_line: 18, last_line: 22})), [0, 1]);
  assert.deepEqual(plain(lines.ofOperation(curves, 3, {first_line: 70, last_line: 80})), [-1, -1]);
});

test('a stretch of several lines is called by the first and the last', () => {
  const curves = {first_line: [1, 5], last_line: [4, 5]};
  assert.deepEqual([0, 1].map((i) => lines.words(curves, i)), ['lines 1 to 4', 'line 5']);
});

test('both rows of a merged stretch give its larger absolute value', () => {
  const points = series.places({s_mm: [8, 16], after_rapid: [0, 0], waypoints_per_stretch: 8});
  const values = series.valuesAt(points, {least: [-5, 1], largest: [2, 3]}, 1);
  const {rows, places} = series.tabulate([{run: 0, points, values}], 16, 1);
  const told = rows.map((row, k) => series.largestOfTwo(row, places[k].twin)[1]);
  assert.deepEqual(plain(told), [null, -5, -5, 3, 3, null]);
});
