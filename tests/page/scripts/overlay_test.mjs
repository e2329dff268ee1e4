import assert from 'node:assert/strict';
import test from 'node:test';
import {load_scripts, plain} from './load_scripts.mjs';

const {overlay, units} = load_scripts('units.js', 'words.js', 'camera.js', 'colours.js', 'arcs.js', 'path_model.js', 'overlay.js');

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

/** The texts that a drawing writes. */
function written(bar) {
  const texts = [];
  const own = {fillText: (text) => texts.push(text), measureText: () => ({width: 50}), createLinearGradient: () => ({addColorStop() {}})};
  const context = new Proxy(own, {get: (target, name) => target[name] || (() => {}), set: () => true});
  const theme = new Proxy({}, {get: () => [0, 0, 0]});
  overlay.draw(context, {width: 600, height: 400, ratio: 1},
      {theme, camera: {azimuth: 0, elevation: 0, centre: [0, 0, 0], span: 100}, units: units.create('um'), marks: [], bar, notes: []});
  return texts.join('\n');
}

test('beside another run the tolerance of a scale has the letter of its run', () => {
  const bar = {title: 'Before', range: {low: 0.001, high: 0.1}, tolerance_mm: 0.005};
  assert.match(written(bar), /tolerance 5\.0 \u00b5m/);
  assert.match(written({...bar, letter: 'B'}), /tolerance of B 5\.0 \u00b5m/);
  assert.match(written({...bar, letter: 'B', tolerance_mm: 0.2}), /all within the tolerance of B 200 \u00b5m/);
});
