import assert from 'node:assert/strict';
import test from 'node:test';
import {data_in, pixels, report_of, texts, visit, write_page} from './browser.mjs';

/** The number of a comparison's row, by the key of reports. */
const values_of = (document, key) => document.summary.find((row) => row.key === key).values;

test('the page of a comparison has both reports with the curves of their own pages', async () => {
  const {runs} = data_in('compared');
  assert.deepEqual(runs.map((run) => run.name), ['pocket', 'constant']);
  for (const run of runs) {
    assert.deepEqual(run.report, report_of(run.name));
    assert.deepEqual(run.curves, data_in(run.name).runs[0].curves);
    assert.deepEqual(run.loads, data_in(run.name).runs[0].loads);
  }
});

test('the page of a comparison shows the numbers of its document, and curves of both runs', () => visit('compared', async (page) => {
  const rows = await page.$$eval('#numbers tbody tr', (all) => all.map((tr) => [...tr.children].map((cell) => cell.textContent)));
  const largest = rows.find((row) => row[0] === 'Largest');
  const document = report_of('compared');
  const expected = [...values_of(document, '/summary/before/max_mm'), ...values_of(document, '/summary/after/max_mm')];
  const shown = largest.slice(1).filter((_, i) => [0, 1, 3, 4].includes(i));
  expected.forEach((value, i) => assert.ok(Math.abs(Number(shown[i]) - 1000 * value) < 0.06, `${largest} lacks ${value}`));
  assert.ok(await pixels(page, '.plot canvas', '--x') > 300);
  assert.match((await texts(page, 'h1')).join(), /Two runs/);
}));

test('a prediction beside a compensation makes a page, too', () => visit('half_compared', async (page) => {
  assert.equal(await page.locator('#numbers').isVisible(), true);
}));

test('the page shows the conclusion of two runs unchanged', async () => {
  const data = {...data_in('compared'), conclusion: 'B is off by <b>less</b> than A.'};
  write_page('compared', data, 'concluded');
  await visit('concluded', async (page) => assert.deepEqual(await texts(page, '#verdict > .verdict'), [data.conclusion]));
  delete data.conclusion;
  write_page('compared', data, 'unconcluded');
  await visit('unconcluded', async (page) => assert.deepEqual(await texts(page, '#verdict > .verdict'), []));
});

test('marks and printed paths have the letter of their run', () => visit('compared', async (page) => {
  const title = () => page.innerText('#curves .marks-title');
  await page.click('#worst .stack > :nth-child(1) tbody tr:nth-child(2) a');
  assert.equal(await title(), 'Marks of A');
  await page.click('#worst .stack > :nth-child(2) tbody tr:nth-child(2) a');
  assert.equal(await title(), 'Marks of B');
  await page.emulateMedia({media: 'print'});
  await page.waitForFunction(() => document.querySelectorAll('.scene-paper').length === 4);
  const shown = await page.$$eval('.scene-paper', (all) => all.map(({dataset}) => dataset.run + dataset.kind));
  assert.deepEqual(shown, ['0before', '0after', '1before', '1after']);
}));
