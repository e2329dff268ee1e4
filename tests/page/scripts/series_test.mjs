import assert from 'node:assert/strict';
import test from 'node:test';
import {load_scripts, plain} from './load_scripts.mjs';

const {data, series} = load_scripts('page_data.js', 'series.js');
const curves = (s_mm, after_rapid, waypoints_per_stretch) => ({s_mm, after_rapid, waypoints_per_stretch});
const same = (values) => ({least: values, largest: values});

test('without merging each stretch is a point, and a rapid breaks the line', () => {
  const points = series.places(curves([0, 5, 5, 9], [1, 0, 1, 0], 1));
  assert.deepEqual(plain(points.map(({s, stretch}) => [s, stretch])), [[0, 0], [5, 1], [5, 1], [5, 2], [9, 3]]);
  const values = series.valuesAt(points, same([1, 2, 3, 4]), 10);
  assert.ok(Number.isNaN(values[2]));
  assert.deepEqual(plain([...values.slice(0, 2), ...values.slice(3)]), [10, 20, 30, 40]);
});

test('of a merged stretch both least and largest are drawn, so that no peak is lost', () => {
  const points = series.places(curves([8, 16, 24], [0, 0, 0], 8));
  assert.equal(points.length, 6);
  const quantity = {least: [1, 3, 0], largest: [2, 90, 4]};
  const values = series.valuesAt(points, quantity, 1);
  for (const v of [...quantity.least, ...quantity.largest]) assert.ok(values.includes(v), `${v} of ${values}`);
});

test('a curve that rises or falls steadily is drawn so, merged or not', () => {
  const points = series.places(curves([8, 16, 24], [0, 0, 0], 8));
  assert.deepEqual(plain(series.valuesAt(points, {least: [1, 3, 5], largest: [2, 4, 6]}, 1)), [1, 2, 3, 4, 5, 6]);
  const falling = plain(series.valuesAt(points, {least: [5, 3, 1], largest: [6, 4, 2]}, 1));
  assert.deepEqual(falling.slice(2), [4, 3, 2, 1]);
});

test('an unknown value is a gap that the line crosses', () => {
  const points = series.places(curves([1, 2, 3], [0, 0, 0], 1));
  assert.deepEqual(plain(series.valuesAt(points, same([1, NaN, 3]), 1)), [1, null, 3]);
});

test('rows are in order of the path, each with the place that it is, both ends of the path included', () => {
  const of_a = series.places(curves([1, 3], [0, 0], 1)), of_b = series.places(curves([2, 4], [0, 0], 1));
  const {rows, places} = series.tabulate([{run: 0, points: of_a, values: [10, 30]}, {run: 0, points: of_a, values: [11, 31]},
    {run: 1, points: of_b, values: [20, 40]}], 5, 2);
  assert.deepEqual(plain(rows), [[0, null, null, null], [2, 10, 11, null], [4, null, null, 20], [6, 30, 31, null], [8, null, null, 40],
    [10, null, null, null]]);
  assert.deepEqual(plain(places.map(({run, stretch}) => [run, stretch])), [[0, -1], [0, 0], [1, 0], [0, 1], [1, 1], [0, -1]]);
});

test('a stretch is found by path length, the ends and beyond included', () => {
  const c = {s_mm: [1, 2, 2, 5]};
  assert.deepEqual([-1, 0.5, 1, 1.5, 2, 4, 5, 9].map((s) => data.stretchAt(c, s)), [0, 0, 0, 1, 1, 3, 3, 3]);
});
