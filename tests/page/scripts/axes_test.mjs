import assert from 'node:assert/strict';
import test from 'node:test';
import {load_scripts, plain} from './load_scripts.mjs';

const {axes} = load_scripts('page_data.js', 'units.js', 'dom.js', 'words.js', 'lines.js', 'series.js', 'axes.js');

const axis = (values, min, max) => ({name: 'axis A1', unit: 'deg', min, max, values: Float32Array.from(values)});

test('the least margin of an axis is to its nearer limit, with its place and its share of the travel', () => {
  assert.deepEqual(plain(axes.leastMargin(axis([0, 50, -70], -100, 100))), {margin: 30, index: 2, share: 0.15});
  assert.deepEqual(plain(axes.leastMargin(axis([0, NaN, 95], -100, 100))), {margin: 5, index: 2, share: 0.025});
});

test('an axis with one limit has a margin, but no share of a travel; one without limits has none', () => {
  assert.deepEqual(plain(axes.leastMargin(axis([3, 7], 0, null))), {margin: 3, index: 0, share: null});
  assert.equal(axes.leastMargin(axis([3, 7], null, null)), null);
});

test('an axis is marked near a limit, and more so outside its travel', () => {
  assert.equal(axes.stateOf(axis([0, 50], -100, 100)), '');
  assert.equal(axes.stateOf(axis([0, 91], -100, 100)), 'near');
  assert.equal(axes.stateOf(axis([0, 101], -100, 100)), 'over');
  assert.equal(axes.stateOf(axis([1, -1], 0, null)), 'over');
  assert.equal(axes.stateOf(axis([1, 2], 0, null)), '');
  assert.equal(axes.stateOf(axis([1e6], null, null)), '');
});
