import assert from 'node:assert/strict';
import test from 'node:test';
import {load_scripts, plain} from './load_scripts.mjs';

const {failure} =
  load_scripts('units.js', 'dom.js', 'words.js', 'lines.js', 'vectors.js', 'vector_sum.js', 'failure.js');

const at = (geometry, load) => ({line: 7, place_mm: [0, 0, 0], geometry_mm: [geometry, 0, 0], load_mm: [0, load, 0], gravity_mm: null,
  preloads_mm: null, superposition_mm: [geometry, load, 0], before_mm: [geometry, load, 0]});
const report_of = (kind, rest = {}, command = 'compensate') =>
  ({command, options: {'max-correction-mm': 1, 'tolerance-mm': 0.005}, failure: {kind, line: 7, what: 'why', ...rest}});
const cures = (...report) => failure.curesOf(report_of(...report)).join(' ');

test('the cure of a correction above its limit depends on its largest cause, and has a sufficient limit', () => {
  assert.match(cures('limit', {at: at(1.71, 0.2)}), /touched_at_mm.*--max-correction-mm 1\.8\./);
  assert.match(cures('limit', {at: at(0.2, 2.5)}), /sign of the force.*--max-correction-mm 2\.6\./);
});

test('outside the travel the part or the tool is to be moved', () => {
  for (const text of [cures('limit'), cures('limit', {at: at(0.1, 0.1)})]) assert.match(text, /--work.*travel/);
});

test('a failed verification is compensated again', () => {
  assert.match(cures('not_compensated', {}, 'verify'), /Compensate the original program again/);
  assert.match(cures('not_compensated'), /force and the stiffness/);
});

test('a failed verification opens at its first place above the tolerance', () => {
  const of = (values) => ({least: values, largest: values});
  const curves = {s_mm: [1, 2, 3, 4], first_line: [6, 7, 7, 7], last_line: [6, 7, 7, 7],
    quantities: {after_mm: of([0.9, 0.001, 0.006, 0.02])}};
  assert.equal(failure.stretchOf({report: report_of('not_compensated'), curves}), 2);
  assert.equal(failure.stretchOf({report: {...report_of('not_compensated'), failure: null}, curves}), -1);
  assert.equal(failure.stretchOf({report: report_of('not_compensated'), curves: null}), -1);
});
