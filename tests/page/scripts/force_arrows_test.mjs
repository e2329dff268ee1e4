import assert from 'node:assert/strict';
import test from 'node:test';
import {load_scripts, plain} from './load_scripts.mjs';

const {forceArrows} = load_scripts('page_data.js', 'camera.js', 'path_model.js', 'force_arrows.js');

/** Curves with a stretch for each force [x, y, z], 10 mm apart; `least` of merged waypoints differs. */
function curves_of(forces, least = forces) {
  const quantities = {};
  ['x', 'y', 'z'].forEach((axis, k) => {
    quantities[`force_${axis}_N`] = {least: Float32Array.from(least, (f) => f[k]), largest: Float32Array.from(forces, (f) => f[k])};
  });
  return {s_mm: Float64Array.from(forces, (_, i) => 10 * (i + 1)), quantities};
}

test('only a run with a force has arrows', () => {
  assert.equal(forceArrows.usable({curves: curves_of([[0, 0, 0], [3, 0, -4]])}), true);
  assert.equal(forceArrows.usable({curves: curves_of([[0, 0, 0]])}), false);
  assert.equal(forceArrows.usable({curves: curves_of([[NaN, NaN, NaN]])}), false);
  assert.equal(forceArrows.usable({curves: {...curves_of([[1, 0, 0]]), quantities: {}}}), false);
  assert.equal(forceArrows.usable({curves: null}), false);
});

test('arrows begin at the drawn places, point along the force, and are as long as it is in proportion', () => {
  const curves = curves_of([[0, 30, 40], [-100, 0, 0], [0, 0, 0], [NaN, NaN, NaN]]);
  const {arrows, N_per_mm} = forceArrows.arrowsOf(curves, (i) => [i, 0, 0], 2, {width: 1000, height: 500});
  // 0.14 of 500 pixels are 35 mm at 2 pixels per mm: the largest force, 100 N.
  assert.ok(Math.abs(N_per_mm - 100 / 35) < 1e-9);
  assert.deepEqual(plain(arrows).map(({stretch}) => stretch), [0, 1]);
  assert.deepEqual(plain(arrows)[1], {stretch: 1, from: [1, 0, 0], to: [1 - 35, 0, 0]});
  const [{from, to}] = plain(arrows);
  assert.deepEqual(to.map((v, k) => Number(((v - from[k]) * N_per_mm).toFixed(6))), [0, 30, 40]);
});

test('of merged waypoints each component is the one that is larger', () => {
  const curves = curves_of([[10, -1, 2]], [[-20, -3, 1]]);
  assert.deepEqual(plain(forceArrows.forceAt(curves, 0)), [-20, -3, 2]);
});

test('a long path has at most sixty arrows, evenly along its length, and a short one has one for each stretch', () => {
  const long = {s_mm: Float64Array.from({length: 8000}, (_, i) => 0.5 * (i + 1))};
  const places = plain(forceArrows.placesOf(long));
  assert.equal(places.length, 60);
  const steps = places.slice(1).map((p, i) => long.s_mm[p] - long.s_mm[places[i]]);
  for (const step of steps) assert.ok(Math.abs(step - 4000 / 60) < 1);
  assert.deepEqual(plain(forceArrows.placesOf({s_mm: Float64Array.from([10, 20, 30])})), [0, 1, 2]);
  assert.deepEqual(plain(forceArrows.placesOf({s_mm: new Float64Array(0)})), []);
});
