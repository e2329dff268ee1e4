import assert from 'node:assert/strict';
import test from 'node:test';
import {load_scripts, plain} from './load_scripts.mjs';

const {pathModel, pick, arcs} = load_scripts('arcs.js', 'path_model.js', 'pick.js');

const to = (high) => ({low: 0, high});

/** Curves of a path along x, one stretch a mm; deviations in z. */
function curves_of(before, after_rapid = before.map((_, i) => (i === 0 ? 1 : 0))) {
  const spread = (values) => Float32Array.from(values.flatMap((v) => (Number.isNaN(v) ? [v, v, v] : [0, 0, v])));
  return {s_mm: Float64Array.from(before, (_, i) => i),
    place_mm: Float32Array.from(before.flatMap((_, i) => [i, 0, 0])), direction: null,
    after_rapid: Uint8Array.from(after_rapid), place_before_mm: spread(before),
    place_after_mm: spread(before.map(() => NaN)), quantities: {before_mm: {largest: Float32Array.from(before)}}};
}

const close = (actual, expected) => {
  assert.equal(actual.length, expected.length);
  expected.forEach((v, i) => assert.ok(Math.abs(actual[i] - v) < 1e-6, `${actual} is not ${expected}`));
};

test('a default exaggeration makes the largest deviation about a twentieth of the path', () => {
  for (const size of [0.3, 17, 220, 4100])
    for (const deviation of [1e-4, 0.0041, 0.07, 0.6]) {
      const factor = pathModel.exaggeration(size, deviation);
      const share = (factor * deviation) / size;
      assert.ok(factor === 1 || (share > 0.05 / 1.6 && share < 0.05 * 1.6), `${size} ${deviation}: ${factor}`);
      assert.match(factor.toExponential(), /^[125]e/);
    }
});

test('an exaggeration chosen for a small deviation is replaced by the usual one for a large deviation', () => {
  assert.equal(pathModel.bearable(5000, 40, 0.0003), 5000);
  assert.equal(pathModel.bearable(5000, 40, 0.08), pathModel.exaggeration(40, 0.08));
  assert.equal(pathModel.bearable(20, 40, 0.08), 20);
});

test('without a deviation the exaggeration is 1', () => assert.equal(pathModel.exaggeration(100, 0), 1));

test('the steps of the slider hold the default and reach the smallest of the deviations', () => {
  const steps = pathModel.exaggerations(200, [1.7, 0.004]);
  assert.ok(steps.includes(pathModel.exaggeration(200, 1.7)));
  assert.ok(steps[steps.length - 1] >= (0.5 * 200) / 0.004);
  assert.equal(steps[0], 1);
  for (const step of steps) assert.match(step.toExponential(), /^[125]e/);
});

test('the box of a flat path, a line and a point has a size above zero; without places there is no box', () => {
  for (const place_mm of [[0, 0, 5, 9, 9, 5], [0, 0, 0, 0, 0, 4], [1, 2, 3]])
    assert.ok(pathModel.sizeOf(pathModel.bounds([{place_mm: Float32Array.from(place_mm)}])) > 0);
  assert.equal(pathModel.bounds([{place_mm: new Float32Array(0)}]), null);
});

test('gaps between known deviations are linear in path length', () => {
  const path = pathModel.build(curves_of([0.1, NaN, NaN, 0.4]), 'before', [0, 0, 0], to(0.4));
  close(path.fraction, [0.25, 0.5, 0.75, 1]);
  close(path.deviation, [0, 0, 0.1, 0, 0, 0.2, 0, 0, 0.3, 0, 0, 0.4]);
});

test('at the ends of a run of feed moves the nearest known deviation holds', () => {
  close(pathModel.build(curves_of([NaN, 0.2, NaN]), 'before', [0, 0, 0], to(0.2)).fraction, [1, 1, 1]);
});

test('deviations are not carried across a rapid: unknown runs stay unknown', () => {
  const path = pathModel.build(curves_of([0.2, 0.2, NaN, NaN], [1, 0, 1, 0]), 'before', [0, 0, 0], to(0.2));
  close(path.fraction, [1, 1, -1, -1]);
  close(path.deviation, [0, 0, 0.2, 0, 0, 0.2, 0, 0, 0, 0, 0, 0]);
});

test('two stretches at one path length, the first of them unknown, give no division by zero', () => {
  const curves = curves_of([0.1, NaN, 0.3]);
  curves.s_mm.fill(5);
  assert.ok(pathModel.build(curves, 'before', [0, 0, 0], to(0.3)).fraction.every((v) => v >= 0 && v <= 1));
});

test('colours run from the least to the largest deviation', () => {
  const curves = curves_of([0.25, 0.375, 0.5]);
  const range = pathModel.rangeOf([pathModel.valued(curves, 'before')]);
  close([range.low, range.high], [0.25, 0.5]);
  close(pathModel.build(curves, 'before', [0, 0, 0], range).fraction, [0, 0.5, 1]);
});

test('without the common shift the deviations are those from their mean over the path', () => {
  const curves = curves_of([0.3, 0.3, 0.3, 0.6]);
  close(pathModel.meanOf(curves, 'before'), [0, 0, 0.4]);
  close(pathModel.valued(curves, 'before', [0, 0, 0.4]).value, [0.1, 0.1, 0.1, 0.2]);
  close(pathModel.build(curves, 'before', [0, 0, 0], to(0.2), [0, 0, 0.4]).fraction, [0.5, 0.5, 0.5, 1]);
});

/** A quarter of a circle of radius 10 about the origin, from (10, 0) to (0, 10), then a line. */
const quarter = () => ({...curves_of([0.1, 0.2, 0.2]), place_mm: Float32Array.from([10, 0, 0, 0, 10, 0, -5, 10, 0]),
  direction: Float32Array.from([0, 1, 0, -1, 0, 0, -1, 0, 0])});

test('an arc is drawn with points on it, a line without', () => {
  const path = pathModel.build(quarter(), 'before', [0, 0, 0], to(0.2));
  assert.ok(path.count >= 31 && path.count <= 34, `${path.count}`);
  for (let i = 0; i <= path.last[1]; ++i)
    assert.ok(Math.abs(Math.hypot(path.place[3 * i], path.place[3 * i + 1]) - 10) < 1e-4, `${i}`);
  assert.equal(path.last[2] - path.last[1], 1);
  const middle = path.last[1] / 2;
  close([path.fraction[middle], path.stretch[middle - 1], path.stretch[middle]], [0.75, 0, 1]);
});

test('without directions, and at a rapid, the path has the points of its stretches', () => {
  assert.equal(pathModel.build({...quarter(), direction: null}, 'before', [0, 0, 0], to(0.2)).count, 3);
  assert.equal(pathModel.build({...quarter(), after_rapid: Uint8Array.from([1, 1, 0])}, 'before', [0, 0, 0], to(0.2)).count, 3);
  assert.deepEqual(plain(arcs.inside([0, 0, 0], [0, 0, 0], [1, 0, 0])), []);
});

test('a kind without any value is not known, and drawn as wanted', () => {
  const curves = curves_of([0.1, 0.2]);
  assert.deepEqual(plain(pathModel.kinds.map((kind) => pathModel.has(curves, kind))), [true, true, false]);
  const path = pathModel.build(curves, 'after', [0, 0, 0], to(0));
  close(path.fraction, [-1, -1]);
  close(path.deviation, [0, 0, 0, 0, 0, 0]);
});

test('the wanted path has no deviation', () => {
  const path = pathModel.build(curves_of([0.1, 0.2]), 'wanted', [0, 0, 0], to(0));
  close(path.fraction, [-1, -1]);
  close(path.deviation, [0, 0, 0, 0, 0, 0]);
});

test('a path is drawn around the origin that is given, exaggerated', () => {
  const path = pathModel.build(curves_of([0.1, 0.2]), 'before', [1, 2, 3], to(0.2));
  close(pathModel.drawnAt(path, 1, 10), [0, -2, -1]);
  const box = pathModel.boxOf(path, 10);
  close([...box.low, ...box.high], [-1, -2, -3, 0, -2, -1]);
});

// Seen from above, one pixel a mm, y down.
const from_above = (x, y, z) => [x, -y, z];
const picked = (places, after_rapid, x, y, reach = 10) => {
  const path = {count: places.length, place: Float32Array.from(places.flat()),
    deviation: new Float32Array(3 * places.length), rapid: Uint8Array.from(after_rapid)};
  return pick.nearest(pick.projected(path, 1, from_above), path.rapid, x, y, reach);
};

test('a click near the path takes the nearer end of the nearest line', () => {
  const corner = [[0, 0, 0], [100, 0, 0], [100, 100, 0]];
  assert.equal(picked(corner, [1, 0, 0], 20, 4), 0);
  assert.equal(picked(corner, [1, 0, 0], 80, -4), 1);
  assert.equal(picked(corner, [1, 0, 0], 103, -90), 2);
});

test('a click beyond reach takes nothing, nor does one on a rapid', () => {
  assert.equal(picked([[0, 0, 0], [100, 0, 0]], [1, 0], 50, 11), -1);
  assert.equal(picked([[0, 0, 0], [100, 0, 0]], [1, 1], 50, 0), -1);
});

test('of lines that cover each other a click takes the one nearest to the eye', () => {
  const passes = [[0, 0, 0], [100, 0, 0], [0, 0, 50], [100, 0, 50], [0, 0, 20], [100, 0, 20]];
  assert.equal(picked(passes, [1, 0, 1, 0, 1, 0], 90, 0), 3);
});

test('a path of one place can be clicked', () => assert.equal(picked([[5, 5, 0]], [1], 6, -5), 0));
