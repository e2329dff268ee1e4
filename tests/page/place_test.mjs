import assert from 'node:assert/strict';
import test from 'node:test';
import {load_scripts, plain} from './load_scripts.mjs';

const {place, data} = load_scripts('page_data.js', 'units.js', 'dom.js', 'words.js', 'place.js');

/** Curves of stretches of these lines, each a mm long; NaN is not known. */
function run_of(lines, before, load = before) {
  const of = (values) => ({least: values, largest: values});
  return {report: {}, curves: {s_mm: lines.map((_, i) => i + 1), first_line: lines, last_line: lines, operation: lines.map(() => -1),
    place_mm: new Float32Array(3 * lines.length), quantities: {before_mm: of(before), load_mm: of(load), after_mm: of(before.map(() => 0.001))}}};
}

const told = (run, i) => {
  const {before_mm, about, causes, after_mm} = place.ofStretch(run, i);
  return plain([before_mm, about, causes.load_mm, after_mm]);
};

test('a stretch without a deviation before shows that nearest on its block as "about"', () => {
  const run = run_of([5, 5, 5, 5, 5], [1, NaN, NaN, NaN, 2]);
  assert.deepEqual(told(run, 1), [1, true, 1, 0.001]);
  assert.deepEqual(told(run, 3), [2, true, 2, 0.001]);
  assert.deepEqual(told(run, 4), [2, false, 2, 0.001]);
});

test('values of other blocks are not used', () => {
  const run = run_of([5, 6, 7, 6], [1, NaN, 3, 4]);
  assert.deepEqual(told(run, 1), [null, false, null, 0.001]);
  assert.deepEqual(told(run_of([6], [NaN]), 0), [null, false, null, 0.001]);
});

test('a run without attribution shows the deviation', () => {
  assert.deepEqual(told(run_of([5, 5], [1, 2], [NaN, NaN]), 1), [2, false, null, 0.001]);
  const run = run_of([5, 5], [1, NaN]);
  delete run.curves.quantities.load_mm;
  assert.deepEqual(told(run, 1), [1, true, null, 0.001]);
});

test('the conclusion of two runs is a text, or empty', () => {
  assert.equal(data.conclusion({conclusion: 'B is off by less.'}), 'B is off by less.');
  for (const none of [{}, {conclusion: null}, {conclusion: 5}]) assert.equal(data.conclusion(none), '');
});
