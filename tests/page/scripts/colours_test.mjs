import assert from 'node:assert/strict';
import test from 'node:test';
import {load_scripts, plain} from './load_scripts.mjs';

const {colours} = load_scripts('colours.js');
const fractions = Array.from({length: 101}, (_, i) => i / 100);
const grounds = [{dark: false, rgb: [1, 1, 1]}, {dark: true, rgb: [0.08, 0.1, 0.12]}];

// How dichromats see linear sRGB. Source: Machado, Oliveira, Fernandes, "A physiologically-based model for simulation
// of color vision deficiency", 2009, severity 1.
const dichromats = {
  protan: [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
  deutan: [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.01182, 0.04294, 0.968881]],
  tritan: [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.3039]],
};

const to_linear = (v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
const seen_by = (matrix, rgb) => matrix.map((row) =>
  Math.min(1, Math.max(0, row.reduce((sum, v, i) => sum + v * to_linear(rgb[i]), 0))));
const lightness = (linear) => Math.cbrt(0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]);

test('larger deviations stand out more from the ground', () => {
  for (const {dark, rgb} of grounds) {
    const contrasts = fractions.map((f) => colours.contrast(colours.at(f, dark), rgb));
    for (let i = 1; i < contrasts.length; ++i) assert.ok(contrasts[i] > contrasts[i - 1], `${dark} ${i}`);
  }
});

test('the smallest deviation is still seen on the ground, the largest plainly', () => {
  for (const {dark, rgb} of grounds) {
    assert.ok(colours.contrast(colours.at(0, dark), rgb) > 1.9);
    assert.ok(colours.contrast(colours.at(1, dark), rgb) > 10);
  }
});

test('the lightness of the scale is monotonic also for dichromats', () => {
  for (const [name, matrix] of Object.entries(dichromats))
    for (const {dark} of grounds) {
      const seen = fractions.filter((_, i) => i % 10 === 0).map((f) => lightness(seen_by(matrix, colours.at(f, dark))));
      for (let i = 1; i < seen.length; ++i)
        assert.ok((dark ? 1 : -1) * (seen[i] - seen[i - 1]) > 0.01, `${name} ${dark} ${i}: ${seen}`);
    }
});

test('beyond its ends the scale keeps the colour of the end', () => {
  assert.deepEqual(plain(colours.at(-1, true)), plain(colours.at(0, true)));
  assert.deepEqual(plain(colours.at(7, false)), plain(colours.at(1, false)));
});

test('the table of bytes is the scale', () => {
  const table = colours.table(256, true);
  assert.equal(table.length, 1024);
  for (const i of [0, 100, 255]) {
    const expected = [...colours.at(i / 255, true).map((v) => Math.round(255 * v)), 255];
    assert.deepEqual(Array.from(table.slice(4 * i, 4 * i + 4)), plain(expected));
  }
});

test('colours of style sheets are read, other texts are not', () => {
  assert.deepEqual(plain(colours.parse(' #fff ')), [1, 1, 1]);
  assert.deepEqual(plain(colours.parse('#336699')), [0.2, 0.4, 0.6]);
  assert.deepEqual(plain(colours.parse('rgb(51, 102, 153)')), [0.2, 0.4, 0.6]);
  for (const text of ['', 'red', '#12', 'var(--x)']) assert.equal(colours.parse(text), null);
});

test('a colour is written in the form of style sheets', () => assert.equal(colours.css([0, 0.2, 1]), 'rgb(0, 51, 255)'));
