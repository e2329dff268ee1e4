import assert from 'node:assert/strict';
import test from 'node:test';
import {load_scripts, plain} from './load_scripts.mjs';

const {units, summary, facts, curves} =
  load_scripts('units.js', 'dom.js', 'words.js', 'summary.js', 'facts.js', 'series.js', 'curves.js');
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
