import assert from 'node:assert/strict';
import test from 'node:test';
import {load_scripts, plain} from './load_scripts.mjs';

const {overlay} = load_scripts('path_model.js', 'overlay.js');

test('the numbers of a scale are round, start at zero and stay within it', () => {
  for (const most of [0.00023, 0.7, 4.1, 83.7, 1709, 2e5]) {
    const ticks = plain(overlay.ticks(most, 4));
    assert.equal(ticks[0], 0);
    assert.ok(ticks[ticks.length - 1] <= most);
    assert.ok(ticks.length >= 3 && ticks.length <= 7, `${most}: ${ticks}`);
    for (const tick of ticks) assert.ok(String(tick).length <= 7, `${most}: ${ticks}`);
  }
});

test('an empty scale has only its zero', () => assert.deepEqual(plain(overlay.ticks(0, 4)), [0]));
