import assert from 'node:assert/strict';
import fs from 'node:fs';
import test from 'node:test';
import {data_in, pixels, texts, visit} from './browser.mjs';

test('every curve has names and units on both axes, in the chosen unit', () => visit('pocket', async (page) => {
  const names = (plot, axis) => texts(page, `.plot.${plot} .dygraph-${axis}label`);
  await page.waitForFunction(() => document.querySelectorAll('.plot.loads .dygraph-ylabel').length > 0);
  for (const plot of ['before', 'after', 'sources']) {
    assert.deepEqual(await names(plot, 'x'), ['Path length, mm']);
    assert.deepEqual(await names(plot, 'y'), ['Deviation, \u00b5m']);
  }
  assert.deepEqual(await names('force', 'y'), ['Force, N']);
  assert.deepEqual(await names('loads', 'y'), ['Moment at the end, N m']);
  await page.check('input[name=unit][value=inch]');
  assert.deepEqual([...await names('before', 'x'), ...await names('before', 'y')], ['Path length, in', 'Deviation, in']);
}));

/** The file that a click saves: {name, bytes}. */
async function saved(page, selector) {
  const [download] = await Promise.all([page.waitForEvent('download'), page.click(selector)]);
  return {name: download.suggestedFilename(), bytes: fs.readFileSync(await download.path())};
}

test('a chart is saved as a picture and as a table', () => visit('pocket', async (page) => {
  const picture = await saved(page, 'figure:has(.plot.before) button:has-text("PNG")');
  assert.equal(picture.name, 'pocket_before.png');
  assert.equal(picture.bytes.subarray(1, 4).toString(), 'PNG');
  assert.ok(picture.bytes.length > 5000, `${picture.bytes.length}`);
  const table = await saved(page, 'figure:has(.plot.before) button:has-text("CSV")');
  assert.equal(table.name, 'pocket_before.csv');
  const [head, ...rows] = table.bytes.toString().trim().split('\n');
  assert.equal(head, 'path length mm,line,"before (Deviation, \u00b5m)"');
  const largest = Math.max(...rows.map((row) => Number(row.split(',')[2])));
  assert.ok(Math.abs(largest - 1000 * data_in('pocket').runs[0].report.summary.before.max_mm) < 0.001, `${largest}`);
}));

test('the path is saved as a picture', () => visit('pocket', async (page) => {
  const {name, bytes} = await saved(page, '.scene-controls button:has-text("PNG")');
  assert.equal(name, 'pocket_path_after.png');
  assert.ok(bytes.length > 5000, `${bytes.length}`);
}));

test('the switch takes the common shift out of the deviation before', () => visit('face', async (page) => {
  const kind = () => page.$eval('.scene-view', (node) => node.dataset.kind);
  const box = page.locator('label:has-text("without the common shift") input');
  assert.equal(await kind(), 'after');
  assert.equal(await box.isDisabled(), true);
  await page.check('.scene-view input[value="before"]');
  await box.check();
  await page.waitForFunction(() => document.querySelector('.scene-view').dataset.kind === 'shifted');
  assert.ok(await pixels(page, '.scene-canvas', '--ink') > 100);
  await box.uncheck();
  await page.waitForFunction(() => document.querySelector('.scene-view').dataset.kind === 'before');
}));
