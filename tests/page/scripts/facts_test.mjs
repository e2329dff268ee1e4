import assert from 'node:assert/strict';
import test from 'node:test';
import {load_scripts, plain} from './load_scripts.mjs';

const {units, summary, remarks, facts, curves} =
  load_scripts('units.js', 'dom.js', 'words.js', 'summary.js', 'remarks.js', 'facts.js', 'series.js', 'curves.js');
const report = {machine: 'mill', command: 'compensate', options: {'tolerance-mm': 0.005},
  control: {path_tolerances: [{line: 3, path_mm: 0.0508}, {line: 9, path_mm: null}]}};

test('tolerances are in the chosen unit', () => {
  for (const [unit, own, control] of [['um', '5.0 \u00b5m', '50.8 \u00b5m'], ['mm', '0.0050 mm', '0.0508 mm'], ['inch', '0.000197 in', '0.00200 in']]) {
    const shown = units.create(unit);
    assert.equal(summary.subtitle(report, shown), `on mill, compensate, tolerance ${own}`);
    assert.equal(facts.optionText('tolerance-mm', 0.005, shown), own);
    assert.equal(facts.pathTolerances(report, shown), `line 3: ${control}; line 9: no path tolerance`);
  }
  assert.equal(facts.optionText('max-segment-mm', 2, units.create('um')), '2');
});

test('what a free turn about the spindle gains, or that it gains nothing', () => {
  const um = units.create('um');
  const spin = {programmed_mm: 0.4, turned_mm: 0.25, targets: 40, turned: 30, least_deg: -90, most_deg: 12.5};
  assert.equal(facts.freeSpin({free_spin: spin}, um),
    '-90 to 13\u00b0, 30 of 40 targets; largest deviation before correction 400 \u00b5m \u2192 250 \u00b5m');
  assert.equal(facts.freeSpin({free_spin: {...spin, turned: 0}}, um),
    'as programmed, largest deviation before correction 400 \u00b5m: no turn gains 1 %');
  assert.equal(facts.freeSpin({}, um), 'as programmed');
});

const runs_of = (...mm) => mm.map((tolerance, i) => ({letter: mm.length > 1 ? 'AB'[i] : '',
  report: {options: tolerance === null ? {} : {'tolerance-mm': tolerance}, summary: {after: {}}}}));
const labels = (...mm) => curves.tolerances({runs: runs_of(...mm), units: units.create('um')}).map(({label}) => label);

test('the label of a tolerance has the letters of the runs that it judges', () => {
  assert.deepEqual(plain(labels(0.005)), ['tolerance 5.0 \u00b5m']);
  assert.deepEqual(plain(labels(0.005, 0.005)), ['tolerance of A and B 5.0 \u00b5m']);
  assert.deepEqual(plain(labels(0.005, 0.02)), ['tolerance of A 5.0 \u00b5m', 'tolerance of B 20.0 \u00b5m']);
  assert.deepEqual(plain(labels(null, 0.02)), ['tolerance of B 20.0 \u00b5m']);
  const [predicted, compensated] = runs_of(0.005, 0.005);
  predicted.report.summary.after = null;
  const shown = curves.tolerances({runs: [predicted, compensated], units: units.create('um')});
  assert.deepEqual(plain(shown.map(({label}) => label)), ['tolerance of B 5.0 \u00b5m']);
  assert.deepEqual(plain(labels(null)), []);
});

test('without a cutting force the page does not warn of a dry run', () => {
  const reminders = (largest_N, largest_Nm) => plain(summary.reminders({options: {'tolerance-mm': 0.005}, blocks: {}, failure: null,
    summary: {air: {max_mm: 0.0252, line: 13}}, forces: {largest_N, largest_Nm, without_force: {moves: 0}}}, units.create('um')));
  assert.deepEqual(reminders(0, 0), []);
  for (const [force, moment] of [[60, 0], [0, 2]]) assert.match(reminders(force, moment)[0].text, /do not run it dry/);
});

test('a moment without a force is a cutting force, in the assumptions and the points to check', () => {
  const sentence = (largest_N, largest_Nm, moves, failure = null) =>
    summary.forceSentence({failure, forces: {largest_N, largest_Nm, without_force: {moves}}});
  assert.equal(sentence(60.4, 2, 3), 'Cutting force: up to 60 N. 3 feed moves without a force.');
  assert.equal(sentence(0, 23.346, 1), 'Cutting force: up to 23.35 N m. 1 feed move without a force.');
  assert.equal(sentence(0, 0, 3), 'No cutting force acts.');
  assert.equal(sentence(0, 0, 3, {line: 3}), '');
  const found = summary.reminders({options: {}, blocks: {}, failure: null, summary: {},
    forces: {largest_N: 0, largest_Nm: 2, without_force: {moves: 1}}}, units.create('um'));
  assert.deepEqual(plain(found).map(({text}) => text), ['1 feed move without a cutting force']);
});

test('the length of moves without a force is that of the moves with a known length', () => {
  const text = (sum) => remarks.unforced(sum, units.create('um'));
  assert.match(text({moves: 5, unknown_length: 2, length_mm: 25}), /^5 feed moves, 25[.0]* mm, 2 of unknown length$/);
  assert.match(text({moves: 5, unknown_length: 0, length_mm: 25}), /^5 feed moves, 25[.0]* mm$/);
  assert.equal(text({moves: 2, unknown_length: 2, length_mm: null}), '2 feed moves, length unknown');
});
