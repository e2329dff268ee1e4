import assert from 'node:assert/strict';
import test from 'node:test';
import {report_of, texts, visit} from './browser.mjs';

const per_mm = {'\u00b5m': 1000, 'mm': 1, 'in': 1 / 25.4};

/** A shown number is a value as far as its digits go, and has digits enough. */
function same(shown, value, what) {
  const digits = (shown.split('.')[1] || '').length;
  assert.ok(Math.abs(Number(shown) - value) <= 0.500001 * 10 ** -digits, `${what}: ${shown} is not ${value}`);
  assert.ok(value === 0 || 0.5 * 10 ** -digits <= 0.06 * Math.abs(value), `${what}: ${shown} has too few digits for ${value}`);
}

/** A shown length with its unit is one in mm. */
function same_length(shown, mm, what) {
  const [number, unit] = shown.split(' ');
  same(number, mm * per_mm[unit], what);
}

const card = (page, key) => page.$eval(`[data-card=${key}] strong`, (node) => node.textContent);

async function check_cards(page, {summary}) {
  same_length(await card(page, 'before'), summary.before.max_mm, 'before');
  same_length(await card(page, 'after'), summary.after.max_mm, 'after');
  same_length(await card(page, 'air'), summary.air.max_mm, 'without force');
  same_length(await card(page, 'correction'), summary.correction.max_mm, 'correction');
  same((await card(page, 'factor')).split(' ')[0], summary.before.max_mm / summary.after.max_mm, 'factor');
  const share = parseFloat(await card(page, 'corrected'));
  assert.ok(share <= summary.corrected_percent && share > summary.corrected_percent - 0.100001, `${share}`);
}

const choose = (page, name, value) => page.check(`input[name=${name}][value="${value}"]`);

for (const name of ['groove', 'pocket', 'face'])
  test(`every card of "${name}" is the number of the report in every unit`, () => visit(name, async (page) => {
    const report = report_of(name);
    assert.equal(await page.$eval('input[name=unit]:checked', (input) => input.value), report.units.shown);
    for (const unit of ['um', 'mm', 'inch']) {
      await choose(page, 'unit', unit);
      await check_cards(page, report);
    }
  }));

test('the table of worst blocks has the rows of the report', () => visit('groove', async (page) => {
  const {worst} = report_of('groove');
  const rows = await page.$$eval('#worst tbody tr', (all) => all.map((tr) => [...tr.children].map((cell) => cell.textContent)));
  assert.equal(rows.length, worst.length);
  rows.forEach((row, i) => {
    assert.equal(row[0], String(worst[i].line));
    same(row[1], 1000 * worst[i].before_mm, 'before');
    same(row[2], 1000 * worst[i].after_mm, 'after');
  });
}));

test('the statistics and the deviations under other forces are the numbers of the report', () => visit('groove', async (page) => {
  const {summary} = report_of('groove');
  const column = (selector, n) => texts(page, `${selector} tbody tr td:nth-child(${n})`);
  const expected = (s) => [s.max_mm, s.p95_mm, s.rms_mm, s.mean_mm, ...s.max_axis_mm, s.max_across_mm, s.max_tool_axis_mm, s.max_along_mm];
  for (const [n, s] of [[2, summary.before], [3, summary.after]]) {
    const shown = await column('#numbers', n);
    const [line] = shown.splice(1, 1);
    assert.equal(line, String(s.max_line));
    expected(s).forEach((mm, i) => same(shown[i], 1000 * mm, `row ${i}`));
    same(shown[10], s.max_rotation_deg, 'rotation');
  }
  const {sensitivity} = summary;
  const largest = await column('#sensitivity', 2);
  [summary.after, sensitivity.force_plus_30, sensitivity.force_minus_30, sensitivity.without_force]
      .forEach((s, i) => same(largest[i], 1000 * s.max_mm, `force ${i}`));
}));

test('operations are those of the report', () => visit('hostile', async (page) => {
  const {operations} = report_of('hostile');
  assert.ok(operations.length >= 2);
  const names = await texts(page, '#operations tbody th');
  operations.forEach((operation, i) => assert.ok(names[i].includes(operation.operation), names[i]));
  const tools = await texts(page, '#operations tbody td:nth-child(2)');
  operations.forEach((operation, i) => assert.equal(tools[i], operation.tool > 0 ? `T${operation.tool}` : '\u2013'));
}));

test('inputs are there with their whole hashes', () => visit('pocket', async (page) => {
  const text = await page.innerText('#facts');
  for (const {path, sha256} of Object.values(report_of('pocket').inputs)) assert.ok(text.includes(path) && text.includes(sha256));
}));
