import assert from 'node:assert/strict';
import test from 'node:test';
import {data_in, pixels, texts, visit, write_page} from './browser.mjs';

const places = Array.from({length: 50}, (_, i) => 4 * i);
const peak = (largest, limit) => ({largest, line: 9, limit});

/** Loads of two chains: x exceeds its limit, y has none. */
function with_loads(data) {
  const [run] = data.runs;
  run.report.loads = {places: 50, unsolved: 2, chains: [
    {name: 'x', moment_max_Nm: peak(9.375, 7.5), spring_force_max_N: peak(40, 100)},
    {name: 'y', moment_max_Nm: peak(3, null), spring_force_max_N: peak(20, null)}]};
  const wave = (size) => places.map((s) => size * Math.abs(Math.sin(s / 30)));
  run.loads = {s_mm: places, line: places.map(() => 9), chains: [
    {name: 'x', moment_max_Nm: wave(9.375), spring_force_max_N: wave(40)}, {name: 'y', moment_max_Nm: wave(3), spring_force_max_N: wave(20)}]};
  return data;
}

test('loads are drawn over the path with their limits, and listed with a column for each chain', async () => {
  write_page('groove', with_loads(data_in('groove')), 'loads');
  await visit('loads', async (page) => {
    await page.waitForFunction(() => document.querySelectorAll('.plot.loads canvas').length > 0);
    assert.ok(await pixels(page, '.plot.loads canvas', '--x') > 300);
    assert.ok(await pixels(page, '.plot.loads canvas', '--limit') > 100);
    assert.match(await page.innerText('.reminders'), /1 load above the limit/);
    assert.deepEqual(await texts(page, '#loads thead th'), ['Load', 'x', 'y']);
    const rows = await texts(page, '#loads tbody tr');
    assert.equal(rows[0], 'Moment at the end9.375 N m, line 9limit 7.5 N m 125 %: above the limit3 N m, line 9');
    assert.equal(rows[1], 'Spring force40 N, line 9limit 100 N 40 %20 N, line 9');
    assert.match(await page.innerText('#loads caption'), /50 places of the path; unknown at 2 more/);
    await page.check('input[name=load][value=spring_force_max_N]');
    assert.match(await page.innerText('#loads h3'), /Spring force of each chain, in N$/);
  });
});

test('a run without loads has no such section', async () => {
  const data = data_in('groove');
  Object.assign(data.runs[0], {loads: null});
  data.runs[0].report.loads = null;
  write_page('groove', data, 'without_loads');
  await visit('without_loads', async (page) => assert.equal(await page.locator('#loads').isVisible(), false));
});
