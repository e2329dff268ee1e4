import assert from 'node:assert/strict';
import test from 'node:test';
import {load_scripts, plain} from './load_scripts.mjs';

const {axes} = load_scripts('page_data.js', 'units.js', 'dom.js', 'words.js', 'lines.js', 'series.js', 'axes.js');

const axis = (margin, min, max) => ({name: 'axis A1', unit: 'deg', min, max, least_margin: margin, margin_line: 7});

test('the least margin of an axis is that of the run, also beyond the places of the curves', () => {
  assert.deepEqual(plain(axes.leastMargin(axis(30, -100, 100))), {margin: 30, line: 7, share: 0.15});
});

test('an axis with one limit has a margin, but no share of a travel; one without limits has none', () => {
  assert.deepEqual(plain(axes.leastMargin(axis(3, 0, null))), {margin: 3, line: 7, share: null});
  assert.equal(axes.leastMargin(axis(null, null, null)), null);
});

test('an axis is marked near a limit, and more so outside its travel', () => {
  assert.equal(axes.stateOf(axis(50, -100, 100)), '');
  assert.equal(axes.stateOf(axis(9, -100, 100)), 'near');
  assert.equal(axes.stateOf(axis(-1, -100, 100)), 'over');
  assert.equal(axes.stateOf(axis(-1, 0, null)), 'over');
  assert.equal(axes.stateOf(axis(1, 0, null)), '');
  assert.equal(axes.stateOf(axis(null, null, null)), '');
});
