import assert from 'node:assert/strict';
import test from 'node:test';
import {load_scripts, plain} from './load_scripts.mjs';

const {overlay} = load_scripts('arcs.js', 'path_model.js', 'overlay.js');

test('the numbers of a scale are round and stay within it, from its least to its largest value', () => {
  for (const [least, most] of [[0, 0.00023], [0.1, 0.7], [3.3, 4.1], [51.2, 83.7], [352, 359], [1318, 2081], [0, 2e5]]) {
    const ticks = plain(overlay.ticks(least, most, 4));
    assert.ok(ticks[0] >= least && ticks[ticks.length - 1] <= most, `${least} ${most}: ${ticks}`);
    assert.ok(ticks.length >= 2 && ticks.length <= 7, `${least} ${most}: ${ticks}`);
    for (const tick of ticks) assert.ok(String(tick).length <= 7, `${least} ${most}: ${ticks}`);
  }
});

test('a scale of one value has only that', () => {
  assert.deepEqual(plain(overlay.ticks(0, 0, 4)), [0]);
  assert.deepEqual(plain(overlay.ticks(5, 5, 4)), [5]);
});
