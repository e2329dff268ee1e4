import assert from 'node:assert/strict';
import test from 'node:test';
import {load_scripts} from './load_scripts.mjs';

const {chartFiles} = load_scripts('units.js', 'dom.js', 'words.js', 'chart_files.js');

test('the table of a chart has path length, line and the values of each curve; unknown values are empty', () => {
  const content = {rows: [[0, null, null], [1.5, 12.25, null], [2, NaN, -3], [4, null, null]],
    places: [{line: ''}, {line: 7}, {line: 8}, {line: 9}], series: [{label: 'before'}, {label: 'chain "a", x'}], lineOf: ({line}) => line};
  assert.equal(chartFiles.csvOf(content, 'mm', 'Deviation'),
    'path length mm,line,before (Deviation),"chain ""a"", x (Deviation)"\n1.5,7,12.25,\n2,8,,-3\n');
});

test('a file has the name of the program, with the characters of file names only', () => {
  const run = {report: {inputs: {program: {path: 'parts/my part #2.ngc'}}}};
  assert.equal(chartFiles.nameOf(run, 'before'), 'my_part_2_before');
});
