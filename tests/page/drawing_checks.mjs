import assert from 'node:assert/strict';
import test from 'node:test';
import {colours, data_in, pixels, report_of, texts, visit, write_page} from './browser.mjs';

const scene = (page) => page.$eval('#path-view .scene-view', (node) => ({...node.dataset}));

test('a page draws its curves and its path without a complaint or a request', () => visit('groove', async (page) => {
  assert.ok(await pixels(page, '.plot.before', '--before') > 300);
  assert.ok(await pixels(page, '.plot.after', '--after') > 300);
  assert.equal((await scene(page)).renderer, 'webgl');
}));

test('plots below are drawn, too, while the page is idle', () => visit('groove', async (page) => {
  await page.waitForFunction(() => document.querySelectorAll('.plot.force canvas').length > 0);
  assert.ok(await pixels(page, '.plot.sources', '--geometry') > 300);
  assert.ok(await pixels(page, '.plot.force', '--x') > 100);
}));

test('without WebGL everything is drawn flat', () => visit('groove', async (page) => {
  assert.ok(await pixels(page, '.plot.before', '--before') > 300);
  assert.notEqual((await scene(page)).renderer, 'webgl');
  assert.ok(await colours(page, '#path-view canvas') > 20);
}, {webgl: false}));

for (const name of ['groove', 'pocket', 'predicted', 'face', 'hostile', 'failed', 'constant', 'large'])
  test(`the page of the run "${name}" holds the report that is beside it, and says its verdict`, () => visit(name, async (page) => {
    assert.deepEqual(data_in(name).runs[0].report, report_of(name));
    const [verdict] = await texts(page, '.verdict');
    assert.ok(verdict.length > 20 && !/undefined|NaN|null/.test(verdict), verdict);
    const text = await page.innerText('main');
    assert.doesNotMatch(text, /undefined|NaN|\[object|null/);
  }));

test('a failed run says so, where, and that no program was written', () => visit('failed', async (page) => {
  const [verdict] = await texts(page, '.verdict.bad');
  const {failure} = report_of('failed');
  assert.ok(verdict.includes(`Line ${failure.line}`) && verdict.includes(failure.what), verdict);
  assert.match(verdict, /No corrected program was written/);
}));

test('a prediction shows nothing of a corrected program', () => visit('predicted', async (page) => {
  assert.equal(await page.locator('.plot.after').count(), 0);
  assert.equal(await page.locator('[data-card=after]').count(), 0);
  for (const part of ['#verdict', '#worst', '#curves', '#numbers']) assert.doesNotMatch(await page.innerText(part), /residual|[Aa]fter/);
}));

test('what a file says is text and nothing more', () => visit('hostile', async (page) => {
  assert.equal(await page.locator('main img').count(), 0);
  assert.equal(await page.locator('main td b, main a b, main th b').count(), 0);
  assert.match(await page.innerText('#operations'), /<\/script><img src=x/i);
  assert.match(await page.innerText('#operations'), /FINISH <b>/);
}));

test('a page without attribution is drawn without what it lacks', async () => {
  const data = data_in('groove');
  for (const name of Object.keys(data.runs[0].curves.quantities))
    if (/^(geometry|load|gravity|superposition|discrepancy)_/.test(name)) delete data.runs[0].curves.quantities[name];
  Object.assign(data.runs[0].report.summary, {sources: null, sensitivity: null});
  for (const row of data.runs[0].report.worst) row.causes = null;
  write_page('groove', data, 'without_attribution');
  await visit('without_attribution', async (page) => {
    assert.equal(await page.locator('#sources').isVisible(), false);
    assert.equal(await page.locator('#sensitivity').isVisible(), false);
    assert.ok(await pixels(page, '.plot.before', '--before') > 300);
  });
});

test('data that cannot be read are said to be so', async () => {
  write_page('groove', {schema: 'counterflex-page 99', runs: []}, 'unreadable');
  await assert.rejects(visit('unreadable', () => {}), /counterflex-page 99/);
});
