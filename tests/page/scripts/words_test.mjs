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

test('unknown or zero causes are not mentioned', () => {
  for (const none of [null, causes(null, null, null, null), causes(0, 0)]) {
    assert.equal(words.cause(none), '');
    assert.equal(words.causeInShort(none), '');
  }
  assert.deepEqual(plain(words.parts(causes(1, 2))).map(({key}) => key), ['geometry_mm', 'load_mm', 'discrepancy_mm']);
});

test('a factor is shown if it is meaningful, with a digit if it is small', () => {
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

test('subscribers are called for another unit', () => {
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

/** The report of a run in which so many moves were not corrected. */
const report_of = (summary, not_corrected = 0) =>
  ({command: 'compensate', options: {'tolerance-mm': 0.005}, blocks: {not_corrected}, failure: null, summary: {path_mm: 10, after: null, ...summary}});
const verdict = (...report) => plain(words.verdict(report_of(...report), units.create('um')));
const of = (max_mm) => ({max_mm, max_line: 3});

test('a run without a feed move is not shown as good', () => {
  assert.deepEqual(verdict({path_mm: 0, before: null}),
      {text: 'No waypoint was solved: the program has no feed move.', kind: 'warn'});
  assert.match(verdict({path_mm: 0, before: null}, 3).text, /no feed move. 3 moves are not corrected/);
  assert.equal(verdict({before: of(0.1), after: of(0.001)}).kind, 'good');
});

test('a program of holes has numbers, though its cutting length is zero', () => {
  assert.equal(verdict({path_mm: 0, before: of(0.1), after: of(0.001)}).kind, 'good');
});

test('the number of moves that are not included is shown', () => {
  const {text, kind} = verdict({before: of(0.1), after: of(0.001)}, 1);
  assert.match(text, /1 move is not corrected and not included in these numbers/);
  assert.equal(kind, 'warn');
  assert.equal(verdict({before: of(0.1)}, 2).kind, 'warn');
  assert.equal(verdict({before: of(0.1)}).kind, 'neutral');
});

test('the verdict of the run comes first, and decides the colour', () => {
  const said = (report) => plain(words.verdict({...report_of({before: of(0.1), after: of(0.001)}), ...report}, units.create('um')));
  assert.match(said({verdict: 'OK', verdict_reason: '', output: 'o.nc'}).text, /^OK\. Off by up to/);
  assert.equal(said({verdict: 'OK', output: 'o.nc'}).kind, 'good');
  const prediction = said({command: 'predict', verdict: 'PREDICTED', summary: {path_mm: 10, before: of(3.7)}});
  assert.match(prediction.text, /^PREDICTED\. Run as it is, the program is off by up to/);
  assert.equal(prediction.kind, 'neutral');
  const reason = '54 % of the cutting length, worst 0.0095 mm > 0.005';
  const partly = said({verdict: 'PARTLY', verdict_reason: reason, output: null});
  assert.ok(partly.text.startsWith(`PARTLY (${reason}). `), partly.text);
  assert.match(partly.text, /No corrected program was written\.$/);
  assert.equal(partly.kind, 'warn');
  const above = said({verdict: 'PARTLY', verdict_reason: reason, output: 'o.nc', summary: {path_mm: 10, before: of(0.1), after: of(0.0095), corrected_percent: 54.36}});
  assert.match(above.text, /^PARTLY\. Off by .*more than the tolerance of 5\.0 \u00b5m; 54\.3 % of the cutting length is within it\./);
  assert.doesNotMatch(said({verdict: 'PARTLY', verdict_reason: reason, output: 'o.nc'}).text, /No corrected program/);
  assert.equal(said({verdict: 'NOTHING CORRECTED', verdict_reason: 'no feed move', output: null}).kind, 'bad');
  const failure = {line: 3, what: 'too far'};
  assert.deepEqual(said({verdict: 'FAILED', failure, output: null}),
      {text: 'FAILED. Line 3: too far. No corrected program was written.', kind: 'bad'});
});

test('the reason of PARTLY is shown if a share of the cutting length is not all of it', () => {
  const partly = (verdict_reason, corrected_percent, feed_moves) => plain(words.verdict({...report_of({before: of(0.1), after: of(0.0252), corrected_percent}),
    verdict: 'PARTLY', verdict_reason, feed_moves, output: 'o.nc'}, units.create('um'))).text;
  for (const [reason, percent, moves] of [
    ['100 % of the cutting length, 4 feed moves above the tolerance, worst 0.0252 mm > 0.005', 100, {missed: 4, unknown: 0, unknown_length: 0}],
    ['54 % of the known cutting length, worst 0.0252 mm > 0.005, 1 feed move of unknown length', 54, {missed: 1, unknown: 1, unknown_length: 1}],
    ['1 of 3 feed moves, worst 0.0252 mm > 0.005', null, {missed: 2, unknown: 0, unknown_length: 0}]])
    assert.equal(partly(reason, percent, moves),
        `PARTLY (${reason.replace(', worst 0.0252 mm > 0.005', '')}). Off by up to 100 \u00b5m before, 25.2 \u00b5m after (model residual): 4.0 times smaller. That is more than the tolerance of 5.0 \u00b5m.`);
});

test('the cutting length is named as the known one if some feed moves have an unknown length', () => {
  assert.equal(words.cuttingLength({feed_moves: {unknown_length: 1}}), 'known cutting length');
  assert.equal(words.cuttingLength({feed_moves: {unknown_length: 0}}), 'cutting length');
  assert.equal(words.cuttingLength({}), 'cutting length');
});

test('moves that are not corrected individually are counted as moves', () => {
  assert.equal(words.otherMoves({grouped: 17, held: 0, corrected_in_part: 2, not_corrected: 4684, left_alone_count: 1}), 4703);
  assert.equal(words.otherMoves({grouped: null, held: null, corrected_in_part: null, not_corrected: null}), 0);
});
