import assert from 'node:assert/strict';
import test from 'node:test';
import {load_scripts, plain} from './load_scripts.mjs';

const {units, words} = load_scripts('units.js', 'words.js');
const causes = (geometry_mm, load_mm, gravity_mm = null, discrepancy_mm = 0) => ({geometry_mm, load_mm, gravity_mm, discrepancy_mm});

test('the largest part is named alone where it is more than twice the next', () => {
  assert.match(words.cause(causes(1, 0.4)), /mostly errors of assembly/);
  assert.match(words.cause(causes(0.1, 0.5)), /mostly the cutting force bends the machine/);
  assert.match(words.cause(causes(0.1, 0.1, 0.9)), /mostly the weight/);
  assert.equal(words.cause(causes(0.5, 0.4)), 'errors of assembly and cutting force');
  assert.equal(words.causeInShort(causes(0.4, 0.5)), 'force, assembly');
});

test('nothing is said of causes that are unknown or nought', () => {
  for (const none of [null, causes(null, null, null, null), causes(0, 0)]) {
    assert.equal(words.cause(none), '');
    assert.equal(words.causeInShort(none), '');
  }
  assert.deepEqual(plain(words.parts(causes(1, 2))).map(({key}) => key), ['geometry_mm', 'load_mm', 'discrepancy_mm']);
});

test('a factor is said where it is one, with a digit where it is small', () => {
  const factor = (before, after) => words.factor({max_mm: before}, {max_mm: after});
  assert.equal(factor(1.7088, 0.0041), '417');
  assert.equal(factor(0.05, 0.01), '5.0');
  for (const none of [factor(1, 0.9), factor(1, 0), words.factor(null, null)]) assert.equal(none, '');
});

test('a deviation has two digits or more in every unit, a length along the path its own unit', () => {
  for (const [unit, shown] of [['um', '4.1 \u00b5m'], ['mm', '0.0041 mm'], ['inch', '0.000160 in']])
    assert.equal(units.create(unit).format(0.0040515), shown);
  assert.equal(units.create('um').format(1.7087676), '1709 \u00b5m');
  assert.equal(units.create('um').format(0), '0.0 \u00b5m');
  assert.equal(units.create('inch').length(25.4), '1.000 in');
  assert.equal(units.create('um').length(220), '220.0 mm');
  for (const unknown of [null, undefined, NaN, Infinity]) assert.equal(units.create('mm').number(unknown), '\u2013');
});

test('those who subscribe hear of another unit', () => {
  const shown = units.create('um');
  const heard = [];
  shown.subscribe(() => heard.push(shown.label));
  shown.set('inch');
  assert.deepEqual(heard, ['in']);
});

test('a share is never rounded up to the whole', () => {
  assert.equal(units.percent(99.9999), '99.9 %');
  assert.equal(units.percent(100), '100 %');
  assert.equal(units.percent(54.36), '54.3 %');
  assert.equal(units.percent(null), '\u2013');
});

const run = (before, after) => ({report: {summary: {before: {max_mm: before}, after: after === null ? null : {max_mm: after}}}});
const compared = (...runs) => words.comparison(runs, units.create('um'));

test('two runs are compared by what both have: the residual, or the deviation before', () => {
  assert.match(compared(run(1, 0.004), run(2, 0.003)), /B is off by 1.0 \u00b5m less than A .* after correction/);
  assert.match(compared(run(1, 0.004), run(2, null)), /B is off by 1000 \u00b5m more than A .* before correction/);
  assert.match(compared(run(1, null), run(1, null)), /the same at their worst, before correction/);
  assert.match(compared({report: {summary: {before: null, after: null}}}, run(1, 1)), /no deviation to compare/);
});
