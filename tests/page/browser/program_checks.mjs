import assert from 'node:assert/strict';
import fs from 'node:fs';
import test from 'node:test';
import {data_in, report_of, texts, visit, write_page} from './browser.mjs';

const current = async (page) => (await texts(page, '.code-line.current .code-number')).map(Number);
const selected = (page) => page.evaluate(() => counterflex.context.selection.stretch);

test('the page has the text of the program, and marks the line of the selected place', () => visit('pocket', async (page) => {
  const {inputs, summary} = report_of('pocket');
  assert.equal(data_in('pocket').runs[0].source.text, fs.readFileSync(inputs.program.path, 'utf8'));
  assert.deepEqual(await current(page), [summary.before.max_line]);
  await page.click('#worst tbody tr:nth-child(3) a');
  assert.deepEqual(await current(page), [report_of('pocket').worst[2].line]);
}));

test('the slider moves along the path, and a click on a line shows its place', () => visit('pocket', async (page) => {
  await page.focus('.code-slider');
  await page.keyboard.press('Home');
  assert.equal(await selected(page), 0);
  await page.keyboard.press('ArrowRight');
  assert.equal(await selected(page), 1);
  const [line] = await current(page);
  await page.click(`.code-line[data-line="${line + 1}"]`);
  assert.deepEqual(await current(page), [line + 1]);
  assert.match(await page.innerText('#place h3'), new RegExp(`Line ${line + 1}$`));
}));

test('the button plays the path, and stops it', () => visit('pocket', async (page) => {
  await page.focus('.code-slider');
  await page.keyboard.press('Home');
  await page.click('.code-play');
  await page.waitForFunction(() => counterflex.context.selection.stretch > 3);
  await page.click('.code-play');
  const stretch = await selected(page);
  await page.waitForTimeout(400);
  assert.equal(await selected(page), stretch);
}));

test('the program follows the mouse over a curve, and returns to the selected place', () => visit('pocket', async (page) => {
  const before = await current(page);
  await page.locator('.plot.before').scrollIntoViewIfNeeded();
  const box = await page.locator('.plot.before').boundingBox();
  await page.mouse.move(box.x + 0.3 * box.width, box.y + 100);
  const [text] = await texts(page, '#curves .readout');
  assert.deepEqual(await current(page), [Number(/line (\d+)/.exec(text)[1])]);
  await page.mouse.move(box.x + 0.3 * box.width, box.y - 60);
  await page.waitForFunction((line) => document.querySelector('.code-line.current').dataset.line === String(line), before[0]);
}));

test('a page without the text of its program has a note', async () => {
  const data = data_in('pocket');
  data.runs[0].source.text = null;
  write_page('pocket', data, 'without_text');
  await visit('without_text', async (page) => {
    assert.match(await page.innerText('.code-view'), /longer than 2 MB/);
    assert.equal(await page.locator('.code-slider').isVisible(), true);
  });
});
