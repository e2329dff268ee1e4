import assert from 'node:assert/strict';
import test from 'node:test';
import {colours, data_in, pixels, report_of, texts, visit, write_page} from './browser.mjs';

const scene = (page) => page.$eval('#path-view .scene-view', (node) => ({...node.dataset}));

test('a page draws its curves and its path without errors or requests', () => visit('groove', async (page) => {
  assert.ok(await pixels(page, '.plot.before canvas', '--before') > 300);
  assert.ok(await pixels(page, '.plot.after canvas', '--after') > 300);
  assert.equal((await scene(page)).renderer, 'webgl');
}));

test('plots below are drawn, too, while the page is idle', () => visit('groove', async (page) => {
  await page.waitForFunction(() => document.querySelectorAll('.plot.force canvas').length > 0);
  assert.ok(await pixels(page, '.plot.sources canvas', '--geometry') > 300);
  assert.ok(await pixels(page, '.plot.force canvas', '--x') > 100);
}));

test('without WebGL everything is drawn flat', () => visit('groove', async (page) => {
  assert.ok(await pixels(page, '.plot.before canvas', '--before') > 300);
  assert.notEqual((await scene(page)).renderer, 'webgl');
  assert.ok(await colours(page, '#path-view canvas') > 20);
}, {webgl: false}));

for (const name of ['groove', 'pocket', 'predicted', 'face', 'hostile', 'failed', 'unverified', 'bracket', 'large'])
  test(`the page of the run "${name}" has the report beside it, and shows its verdict`, () => visit(name, async (page) => {
    assert.deepEqual(data_in(name).runs[0].report, report_of(name));
    const [verdict] = await texts(page, '.verdict');
    assert.ok(verdict.length > 20 && !/undefined|NaN|null/.test(verdict), verdict);
    const text = await page.innerText('main');
    assert.doesNotMatch(text, /undefined|NaN|\[object|null/);
  }));

test('a failed run shows the failure, its place, and that no program was written', () => visit('failed', async (page) => {
  const [verdict] = await texts(page, '.verdict.bad');
  const {failure} = report_of('failed');
  assert.ok(verdict.includes(`Line ${failure.line}`) && verdict.includes(failure.what), verdict);
  assert.match(verdict, /No corrected program was written/);
}));

test('residuals above the tolerance are at the top, reasons of blocks that are not corrected below', () => visit('bracket', async (page) => {
  const {blocks, warnings} = report_of('bracket');
  const [verdict] = await texts(page, '.verdict.warn');
  assert.match(verdict, /more than the tolerance of 5.0 \u00b5m; [\d.]+ % of the cutting length is within it/);
  const rows = await texts(page, '#remarks tbody tr');
  assert.ok(blocks.left_alone.length > 0 && blocks.machine_positions.length > 3 && warnings.length > 0);
  const captions = await texts(page, '#remarks caption');
  assert.ok(captions.includes('In machine coordinates, not changed: 4 blocks'), captions.join());
  for (const {line, why} of [...blocks.left_alone, ...blocks.machine_positions]) assert.ok(rows.includes(`${line}${why}`), why);
  for (const {line, what} of warnings) assert.ok(rows.includes(`${line}${what}`), what);
}));

test('a prediction does not show a corrected program', () => visit('predicted', async (page) => {
  assert.equal(await page.locator('.plot.after').count(), 0);
  assert.equal(await page.locator('[data-card=after]').count(), 0);
  for (const part of ['#verdict', '#worst', '#curves', '#numbers']) assert.doesNotMatch(await page.innerText(part), /residual|[Aa]fter/);
}));

test('texts of files are shown as text only', () => visit('hostile', async (page) => {
  assert.equal(await page.locator('main img').count(), 0);
  assert.equal(await page.locator('main td b, main a b, main th b').count(), 0);
  assert.match(await page.innerText('#operations'), /<\/script><img src=x/i);
  assert.match(await page.innerText('#operations'), /FINISH <b>/);
}));

test('a page without attribution is drawn without the missing parts', async () => {
  const data = data_in('groove');
  for (const name of Object.keys(data.runs[0].curves.quantities))
    if (/^(geometry|load|gravity|superposition|discrepancy)_/.test(name)) delete data.runs[0].curves.quantities[name];
  Object.assign(data.runs[0].report.summary, {sources: null, sensitivity: null});
  for (const row of data.runs[0].report.worst) row.causes = null;
  write_page('groove', data, 'without_attribution');
  await visit('without_attribution', async (page) => {
    assert.equal(await page.locator('#sources').isVisible(), false);
    assert.equal(await page.locator('#sensitivity').isVisible(), false);
    assert.ok(await pixels(page, '.plot.before canvas', '--before') > 300);
  });
});

test('a report of an older version is shown without the missing parts', async () => {
  const data = data_in('groove');
  const {report} = data.runs[0];
  for (const key of ['operations', 'units', 'loads']) delete report[key];
  delete report.summary.corrected_percent;
  report.worst = report.worst.map(({line, before_mm, after_mm}) => ({line, before_mm, after_mm}));
  write_page('groove', data, 'older');
  await visit('older', async (page) => {
    assert.ok(await pixels(page, '.plot.before canvas', '--before') > 300);
    assert.match(await page.innerText('#place h3'), new RegExp(`Line ${report.summary.before.max_line}$`));
    assert.doesNotMatch(await page.innerText('main'), /undefined|NaN|\[object|null/);
  });
});

/** Curves with only their first stretch. */
function first_stretch(curves) {
  const cut = (base64, bytes) => Buffer.from(base64, 'base64').subarray(0, bytes).toString('base64');
  const sizes = {s_mm: 8, first_line: 4, last_line: 4, operation: 4, after_rapid: 1, place_mm: 12, place_before_mm: 12, place_after_mm: 12};
  const quantities = Object.entries(curves.quantities).map(([name, q]) => [name, {largest: cut(q.largest, 4)}]);
  const arrays = Object.entries(sizes).map(([name, bytes]) => [name, cut(curves[name], bytes)]);
  return {...curves, ...Object.fromEntries(arrays), quantities: Object.fromEntries(quantities), stretches: 1, waypoints: 1};
}

test('a path of a single place is drawn, and an empty path is omitted', async () => {
  const data = data_in('groove');
  data.runs[0].curves = first_stretch(data.runs[0].curves);
  write_page('groove', data, 'single');
  await visit('single', async (page) => assert.ok(await pixels(page, '.plot.before canvas', '--before') > 4));
  data.runs[0].curves = null;
  write_page('groove', data, 'without_curves');
  await visit('without_curves', async (page) => {
    for (const part of ['#path', '#curves', '#sources', '#force']) assert.equal(await page.locator(part).isVisible(), false, part);
    assert.ok(await page.locator('[data-card=before]').isVisible());
  });
});

test('unreadable data give a message', async () => {
  write_page('groove', {schema: 'counterflex-page 99', runs: []}, 'unreadable');
  await assert.rejects(visit('unreadable', () => {}), /counterflex-page 99/);
});
