import assert from 'node:assert/strict';
import test from 'node:test';
import {pixels, visit} from './browser.mjs';

const brightness = (page) => page.evaluate(() => {
  const [r, g, b] = getComputedStyle(document.body).backgroundColor.match(/\d+/g).map(Number);
  return (0.2126 * r + 0.7152 * g + 0.0722 * b) / 255;
});

test('a page is dark if the system is, and the button overrides it', () => visit('groove', async (page) => {
  assert.ok(await brightness(page) < 0.2);
  assert.ok(await pixels(page, '.plot.before canvas', '--before') > 300);
  await page.click('#theme');
  assert.ok(await brightness(page) > 0.8);
  assert.ok(await pixels(page, '.plot.before canvas', '--before') > 300);
  await page.click('#theme');
  assert.ok(await brightness(page) < 0.2);
}, {scheme: 'dark'}));

test('a page is light where the system is', () => visit('groove', async (page) => assert.ok(await brightness(page) > 0.8)));

for (const name of ['groove', 'hostile', 'two'])
  test(`the page "${name}" fits a narrow window`, () => visit(name, async (page) => {
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth) <= 400);
  }, {width: 400}));

const pages_of = (pdf) => (pdf.toString('latin1').match(/\/Type\s*\/Page\b/g) || []).length;

/** Pictures in a document: blank ones have few bytes. */
function images_of(pdf) {
  const found = pdf.toString('latin1').matchAll(/\/Subtype\s*\/Image\b[^>]*?\/Width (\d+)[^]*?\/Length (\d+)/g);
  return [...found].map(([, width, bytes]) => ({width: Number(width), bytes: Number(bytes)}));
}

test('a printed page is light, complete and without buttons', () => visit('groove', async (page) => {
  await page.emulateMedia({media: 'print'});
  await page.waitForFunction(() => document.documentElement.hasAttribute('data-printing'));
  assert.ok(await brightness(page) > 0.99);
  assert.deepEqual(await page.$$eval('button, input, select', (nodes) => nodes.filter((n) => n.checkVisibility()).map((n) => n.textContent)), []);
  for (const [plot, colour] of [['before', '--before'], ['after', '--after'], ['sources', '--geometry'], ['force', '--x']])
    assert.ok(await pixels(page, `.plot.${plot} .paper-copy`, colour) > 300, plot);
  const widths = await page.$$eval('.plot', (plots) => plots.filter((plot) => plot.checkVisibility()).map((plot) => plot.offsetWidth));
  assert.ok(widths.every((width) => width <= 700), widths.join());
  assert.equal(await page.locator('#axes').isVisible(), false);
  const pdf = await page.pdf({format: 'A4'});
  assert.ok(pages_of(pdf) > 1 && pages_of(pdf) <= 4, `${pages_of(pdf)} pages`);
  const pictures = images_of(pdf).filter(({width}) => width >= 1900);
  assert.ok(pictures.length > widths.length, `${pictures.length} pictures of ${widths.length} plots and the path`);
  for (const {bytes} of pictures) assert.ok(bytes > 4000, `${bytes} bytes`);
  await page.emulateMedia({media: 'screen'});
  await page.waitForFunction(() => !document.documentElement.hasAttribute('data-printing'));
  assert.ok(await brightness(page) < 0.2);
  assert.ok(await page.$eval('.plot.before', (plot) => plot.offsetWidth) > 700);
}, {scheme: 'dark'}));

test('a printed page has the whole path, for any zoom', () => visit('pocket', async (page) => {
  const ticks = () => page.$$eval('.plot.before .dygraph-axis-label-x', (nodes) => nodes.map((node) => Number(node.textContent)));
  const range = async () => Math.max(...await ticks()) - Math.min(...await ticks());
  const whole = await range();
  await page.focus('.plot.before');
  for (let i = 0; i < 4; ++i) await page.keyboard.press('+');
  const zoomed = await range();
  assert.ok(zoomed < 0.2 * whole);
  await page.emulateMedia({media: 'print'});
  await page.waitForFunction(() => document.documentElement.hasAttribute('data-printing'));
  assert.ok(await range() > 0.7 * whole, `${await ticks()}`);
  await page.emulateMedia({media: 'screen'});
  await page.waitForFunction(() => !document.documentElement.hasAttribute('data-printing'));
  assert.ok(await range() < 0.2 * whole);
}));

test('a narrow window shows line, deviations and cause of the worst blocks, and whole captions', () => visit('pocket', async (page) => {
  const shown = await page.$$eval('#worst thead th', (all) => all.filter((th) => th.checkVisibility()).map((th) => th.textContent));
  assert.deepEqual(shown, ['Line', 'Before', 'After', 'Force', 'Mostly from']);
  for (const right of await page.$$eval('caption', (all) => all.filter((c) => c.checkVisibility()).map((c) => c.getBoundingClientRect().right)))
    assert.ok(right <= 400, `${right}`);
}, {width: 400}));

for (const name of ['pocket', 'face', 'panel', 'bracket', 'compared', 'failed', 'unverified'])
  test(`"${name}" is printed on four pages at most`, () => visit(name, async (page) => {
    await page.emulateMedia({media: 'print'});
    await page.waitForFunction(() => document.documentElement.hasAttribute('data-printing'));
    const pages = pages_of(await page.pdf({preferCSSPageSize: true}));
    assert.ok(pages >= 1 && pages <= 4, `${pages} pages`);
  }));

test('the foot of a printed page has program, machine, day and number of the page', () => visit('pocket', async (page) => {
  const rules = await page.evaluate(() => document.adoptedStyleSheets.flatMap((sheet) => [...sheet.cssRules].map((rule) => rule.cssText)).join());
  assert.match(rules, /pocket\.ngc on Three-axis mill/);
  assert.match(rules, /printed \d{4}-\d\d-\d\d/);
  assert.match(rules, /counter\(page\).*counter\(pages\)/);
}));
