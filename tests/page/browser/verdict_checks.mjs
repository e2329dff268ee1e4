import assert from 'node:assert/strict';
import test from 'node:test';
import {report_of, texts, visit} from './browser.mjs';

const verdicts = {groove: ['OK', 'good'], bracket: ['PARTLY', 'warn'], failed: ['FAILED', 'bad'], unverified: ['FAILED', 'bad']};

for (const [name, [word, kind]] of Object.entries(verdicts))
  test(`the verdict of "${name}" is a band with its word and colour`, () => visit(name, async (page) => {
    assert.deepEqual(await texts(page, `.verdict.${kind} .word`), [word]);
    const ground = await page.$eval('.verdict .word', (node) => getComputedStyle(node).backgroundColor);
    const colour = await page.evaluate((property) => {
      const probe = document.body.appendChild(document.createElement('i'));
      probe.style.color = `var(${property})`;
      return getComputedStyle(probe).color;
    }, `--${kind}`);
    assert.equal(ground, colour);
  }));

test('the assumptions and the written file are directly below the verdict, before the cards', () => visit('groove', async (page) => {
  const top = (selector) => page.$eval(selector, (node) => node.getBoundingClientRect().top);
  assert.ok(await top('.verdict') < await top('.assumptions') && await top('.assumptions') < await top('.cards'));
  const [{work}, text] = [report_of('groove').assumptions, await page.innerText('.assumptions')];
  assert.ok(text.includes(work), text);
  assert.match(text, /Cutting force: up to 217 N. 2 feed moves without a force./);
  assert.match(await page.innerText('.run'), /Written to \/.*\/pages\/groove\.ngc/);
}));

test('a failure has its place, the deviation there by causes, and what to do', () => visit('failed', async (page) => {
  const {at, line} = report_of('failed').failure;
  const text = await page.innerText('#failure');
  assert.match(text, new RegExp(`Line ${line}\\b`));
  assert.equal((await page.innerText('#failure pre .failed')).trim(), `${line}  N40 G1 Z-73.65 F300`);
  assert.match(text, /off by up to 1709 \u00b5m: mostly errors of assembly/);
  assert.match(text, /--max-correction-mm 1\.8\./);
  const cells = await texts(page, '#failure .vector-sum tr.total td');
  at.before_mm.forEach((mm, k) => assert.equal(Number(cells[k].replace('\u2212', '-')), Math.round(1000 * mm)));
  for (const part of ['#worst', '#place']) assert.equal(await page.locator(part).isVisible(), false, part);
}));

test('a failed verification opens at its failure, after the correction', () => visit('unverified', async (page) => {
  const {failure, options} = report_of('unverified');
  assert.match(await page.innerText('#place h3'), new RegExp(`Line ${failure.line}$`));
  const [, after] = /After: ([\d.]+) \u00b5m/.exec(await page.innerText('#place .cause'));
  assert.ok(Number(after) > 1000 * options['tolerance-mm'] && Number(after) < 1000 * options['tolerance-mm'] + 2, after);
  assert.equal((await page.$eval('.scene-view', (node) => node.dataset.kind)), 'after');
  assert.match(await page.innerText('#failure'), new RegExp(`line ${failure.corrected_line} of the corrected program`));
}));

test('the bar has five links, and the others behind "More"', () => visit('pocket', async (page) => {
  assert.equal(await page.locator('#contents > ul > li > a').count(), 5);
  assert.equal(await page.locator('.more a').first().isVisible(), false);
  await page.click('.more summary');
  await page.click('.more a:has-text("Numbers")');
  await page.waitForFunction(() => location.hash === '#numbers');
  assert.equal(await page.locator('.more a').first().isVisible(), false);
}, {width: 400}));
