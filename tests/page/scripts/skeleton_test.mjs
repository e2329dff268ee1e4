import assert from 'node:assert/strict';
import test from 'node:test';
import {load_scripts, plain} from './load_scripts.mjs';

const {skeleton} = load_scripts('page_data.js', 'lines.js', 'series.js', 'skeleton.js');

/** A base that stays, and a node that moves along x: at 0, 10, 20 ... mm, at each place or at every second one. */
function run_of(s_mm, every = 1) {
  const frames = s_mm.filter((_, i) => i % every === 0).map((_, i) => 10 * every * i);
  return {curves: {s_mm: Float64Array.from(s_mm), first_line: Int32Array.from(s_mm, (_, i) => i + 1), last_line: Int32Array.from(s_mm, (_, i) => i + 1)},
    machine: {s_mm: Float64Array.from(s_mm), line: Int32Array.from(s_mm, (_, i) => i + 1),
      skeleton: {every, lines: [[[0, 0, 5], Float32Array.from(frames.flatMap((x) => [x, 0, 0]))]]}}};
}

const tip = (lines) => plain(lines)[0][1];

test('the lines at a stretch are those of its place', () => {
  const linesAt = skeleton.follow(run_of([1, 2, 3, 4]));
  assert.deepEqual(plain(linesAt(2)), [[[0, 0, 5], [20, 0, 0]]]);
});

test('stretches of the same path length before and after a rapid have their own places', () => {
  const linesAt = skeleton.follow(run_of([1, 2, 2, 3]));
  assert.deepEqual([0, 1, 2, 3].map((i) => tip(linesAt(i))[0]), [0, 10, 20, 30]);
});

test('between frames, and between places of the machine, lines are interpolated', () => {
  assert.deepEqual([0, 1, 2, 3, 4].map((i) => tip(skeleton.follow(run_of([1, 2, 3, 4, 5], 2))(i))[0]), [0, 10, 20, 30, 40]);
  const fewer = run_of([1, 2, 3, 4]);
  Object.assign(fewer.machine, {s_mm: Float64Array.from([1, 4]), line: Int32Array.from([1, 4])});
  assert.ok(Math.abs(tip(skeleton.follow(fewer)(1))[0] - 10 / 3) < 1e-9);
});

test('behind the last frame the machine stays', () => {
  assert.equal(tip(skeleton.follow(run_of([1, 2, 3, 4], 3))(3))[0], 30);
  assert.equal(tip(skeleton.follow(run_of([1, 2, 3, 4, 5], 3))(4))[0], 30);
});

test('a place that is not known has no lines, and does not count for the box', () => {
  const run = run_of([1, 2, 3]);
  run.machine.skeleton.lines[0][1].set([NaN, NaN, NaN], 3);
  assert.deepEqual(plain(skeleton.follow(run)(1)), []);
  assert.deepEqual(plain(skeleton.boxOf(run.machine)), {low: [0, 0, 0], high: [20, 0, 5]});
});

test('only a run with curves and lines of its machine has a machine to show', () => {
  const run = run_of([1]);
  assert.equal(skeleton.usable(run), true);
  assert.equal(skeleton.usable({...run, machine: null}), false);
  assert.equal(skeleton.usable({...run, machine: {...run.machine, skeleton: null}}), false);
});
