import assert from 'node:assert/strict';
import test from 'node:test';
import {bytes_of, data_in, pixels, report_of, texts, visit, write_page} from './browser.mjs';

test('the page of a long program is small, for any length', () => {
  const {curves} = data_in('large').runs[0];
  assert.ok(curves.waypoints_per_stretch > 1 && curves.stretches > 4096 && curves.stretches <= 8192, `${curves.stretches}`);
  assert.ok(bytes_of('large') < 25e6);
});

/** Time until the page is ready, ms: the shortest of three. */
async function ready_after(name) {
  const times = [];
  for (let i = 0; i < 3; ++i)
    await visit(name, async (page) => times.push(await page.evaluate(() => performance.getEntriesByName('counterflex-ready')[0].startTime)));
  return Math.min(...times);
}

// A page of any length has at most as many stretches as this one. A ratio, as computers differ and have other work.
test('the page of a long program is ready a few times later than that of six blocks', async () => {
  const short = await ready_after('groove'), long = await ready_after('large');
  console.log(`ready after ${short.toFixed(0)} ms with six blocks, ${long.toFixed(0)} ms with 34,000`);
  assert.ok(long < 6 * short, `ready after ${long} ms, ${short} ms with six blocks`);
});

test('least and largest values of merged points are drawn', () => visit('large', async (page) => {
  assert.ok(await pixels(page, '.plot.before canvas', '--before') > 2000);
  assert.match(await page.innerText('#curves'), /Each stretch of \d+ points is drawn with its least and its largest value/);
}));

test('the largest deviation of a long program is shown as a sum of its causes', () => visit('large', async (page) => {
  const {before, sources: {at_worst}} = report_of('large').summary;
  assert.match(await page.innerText('#place h3'), new RegExp(`^Line ${before.max_line}$`));
  const cells = await texts(page, '#place .vector-sum tr.total td');
  at_worst.before_mm.forEach((mm, k) => assert.ok(Math.abs(Number(cells[k].replace('\u2212', '-')) - 1000 * mm) < 0.51, cells[k]));
  assert.match(await page.innerText('#place .vector-sum caption'), new RegExp(`^Causes at the largest deviation before, in line ${before.max_line}, in `));
  assert.match(await page.innerText('#place .merged'), /"Up to" is the largest value of a stretch of \d+ points/);
  assert.match(await page.innerText('#sources'), /the drawn causes need not add up/);
  assert.match(await page.innerText('#place .cause'), /^Off by [\d.]+ \u00b5m before: .*After: up to [\d.]+ \u00b5m\.$/);
}));

test('a page with thinned marks has a note', async () => {
  const data = data_in('pocket');
  const {force_steps: steps} = data.runs[0].curves;
  steps.count = 64 * steps.s_mm.length;
  write_page('pocket', data, 'thinned');
  await visit('thinned', async (page) => assert.match(await page.innerText('#curves'), /One of every 64 steps of the force is marked/));
  await visit('pocket', async (page) => assert.doesNotMatch(await page.innerText('#curves'), /Of every/));
});

test('the readout shows the lines of a merged stretch and the largest value in them', () => visit('large', async (page) => {
  await page.locator('.plot.before').scrollIntoViewIfNeeded();
  const box = await page.locator('.plot.before').boundingBox();
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 100);
  const [text] = await texts(page, '#curves .readout');
  const [, first, last] = /, lines (\d+) to (\d+): up to before [\d.]+ \u00b5m$/.exec(text) || assert.fail(text);
  assert.ok(Number(first) < Number(last), text);
}));
