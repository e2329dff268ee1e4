import assert from 'node:assert/strict';
import test from 'node:test';
import {data_in, report_of, texts, visit, write_page} from './browser.mjs';

const axis = async (page, plot) => (await texts(page, `.plot.${plot} .dygraph-axis-label-x`)).map(Number);
const camera = (page) => page.$eval('#path-view .scene-view', ({dataset}) => `${dataset.centre} ${dataset.span} ${dataset.stretch}`);
const spread = (ticks) => Math.max(...ticks) - Math.min(...ticks);

async function drawn_again(page, before) {
  await page.waitForFunction((old) => {
    const {dataset} = document.querySelector('#path-view .scene-view');
    return `${dataset.centre} ${dataset.span} ${dataset.stretch}` !== old;
  }, before);
}

/** Selects a row of the worst blocks by `act`, and checks that both views and the cause show it. */
async function follows(page, row, act) {
  const {worst} = report_of('pocket');
  const axis_before = await axis(page, 'before'), camera_before = await camera(page);
  await act(`#worst tbody tr:nth-child(${row + 1}) a`);
  await drawn_again(page, camera_before);
  const axis_after = await axis(page, 'before');
  assert.ok(spread(axis_after) < spread(axis_before), `${axis_before} and ${axis_after}`);
  assert.deepEqual(await axis(page, 'after'), axis_after);
  const s = worst[row].s_mm;
  assert.ok(Math.min(...axis_after) - spread(axis_after) < s && s < Math.max(...axis_after) + spread(axis_after));
  assert.match(await page.innerText('#place h3'), new RegExp(`ine ${worst[row].line}\\b`));
  assert.ok((await page.innerText('#place pre')).includes(worst[row].text.trim()));
  assert.match(await page.innerText('#place .cause'), /assembly|force/);
}

test('a click on a worst block shows it in both views, with the cause', () => visit('pocket', (page) =>
  follows(page, 2, (link) => page.click(link))));

test('Enter on a worst block does the same', () => visit('pocket', (page) => follows(page, 3, async (link) => {
  await page.focus(link);
  await page.keyboard.press('Enter');
})));

test('a click beside the link of a row does as well', () => visit('pocket', (page) =>
  follows(page, 1, (link) => page.click(`${link.replace(/ a$/, '')} td:nth-child(4)`))));

test('a page opens at the place of the first card, and shows the numbers there', () => visit('pocket', async (page) => {
  const {before} = report_of('pocket').summary;
  assert.match(await page.innerText('#place h3'), new RegExp(`Line ${before.max_line}$`));
  const card = await page.innerText('[data-card=before] strong');
  assert.ok((await page.innerText('#place .cause')).startsWith(`Off by ${card} before`));
  assert.equal(await page.innerText('#place .vector-sum tr.total td:last-child'), card.split(' ')[0]);
}));

test('a page of holes alone opens at the largest deviation before, too', () => visit('holes', async (page) => {
  const {summary, worst} = report_of('holes');
  assert.notEqual(worst[0].line, summary.before.max_line);
  assert.match(await page.innerText('#place h3'), new RegExp(`Line ${summary.before.max_line}$`));
}));

test('every control is reached with the keyboard, the way past the bar first', () => visit('pocket', async (page) => {
  await page.keyboard.press('Tab');
  assert.equal(await page.evaluate(() => document.activeElement.className), 'skip');
  const reached = new Set();
  for (let i = 0; i < 120; ++i) {
    await page.keyboard.press('Tab');
    reached.add(await page.evaluate(() => {
      const {activeElement: node} = document;
      return node.id || node.name || node.className || node.textContent;
    }));
  }
  for (const what of ['unit', 'theme', 'component', 'plot before', 'scene-stage']) assert.ok(reached.has(what), `${what} of ${[...reached].join('|')}`);
}));

test('keys on a plot zoom all plots, and Home shows all', () => visit('pocket', async (page) => {
  const whole = await axis(page, 'after');
  await page.focus('.plot.before');
  await page.keyboard.press('+');
  await page.keyboard.press('+');
  const zoomed = await axis(page, 'after');
  assert.ok(spread(zoomed) < 0.5 * spread(whole));
  await page.keyboard.press('ArrowRight');
  assert.ok(Math.max(...await axis(page, 'after')) > Math.max(...zoomed));
  await page.keyboard.press('Home');
  assert.deepEqual(await axis(page, 'after'), whole);
}));

test('dragging zooms both plots, and a double click shows all again', () => visit('pocket', async (page) => {
  await page.locator('.plot.before').scrollIntoViewIfNeeded();
  const whole = await axis(page, 'after');
  const box = await page.locator('.plot.before').boundingBox();
  await page.mouse.move(box.x + 0.4 * box.width, box.y + 100);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.6 * box.width, box.y + 100, {steps: 4});
  await page.mouse.up();
  assert.ok(spread(await axis(page, 'after')) < 0.5 * spread(whole));
  await page.mouse.dblclick(box.x + 0.5 * box.width, box.y + 100);
  assert.deepEqual(await axis(page, 'after'), whole);
}));

test('the readout shows line and values, in both plots', () => visit('pocket', async (page) => {
  await page.locator('.plot.before').scrollIntoViewIfNeeded();
  const box = await page.locator('.plot.before').boundingBox();
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 100);
  const [before, after] = await texts(page, '#curves .readout');
  assert.match(before, /line \d+: before [\d.]+ \u00b5m/);
  assert.match(after, /line \d+: after [\d.]+ \u00b5m/);
}));

test('the readout is for the place under the mouse, also in zoomed curves and between points', () => visit('pocket', async (page) => {
  await page.locator('.plot.before').scrollIntoViewIfNeeded();
  const box = await page.locator('.plot.before').boundingBox();
  for (const zooms of [0, 3]) {
    await page.focus('.plot.before');
    for (let i = 0; i < zooms; ++i) await page.keyboard.press('+');
    for (const share of [0.1, 0.5, 0.99]) {
      await page.mouse.move(box.x + share * box.width, box.y + 100);
      const [text] = await texts(page, '#curves .readout');
      const s = parseFloat(text), ticks = await axis(page, 'before');
      assert.ok(s > Math.min(...ticks) - spread(ticks) / 3 && s < Math.max(...ticks) + spread(ticks) / 3, `${text} of ${ticks}`);
      assert.match(text, /line \d+: before/);
    }
  }
}));

test('an operation zooms the curves to it', () => visit('hostile', async (page) => {
  const whole = await axis(page, 'before');
  await page.click('#operations tbody tr:nth-child(2) a');
  assert.ok(spread(await axis(page, 'before')) < spread(whole));
}));

test('components, the logarithm and units redraw the curves', () => visit('pocket', async (page) => {
  const title = () => page.innerText('#curves h3 >> nth=0');
  await page.check('input[name=component][value="tool_axis_"]');
  assert.match(await title(), /along the tool axis, in \u00b5m/);
  await page.check('#curves label:has-text("logarithmic") input');
  await page.check('input[name=component][value="rotation_"]');
  assert.match(await title(), /rotation, in degrees/);
  await page.check('input[name=component][value="x_"]');
  await page.check('input[name=unit][value=inch]');
  assert.match(await title(), /x, in inches/);
}));

test('the line of a remark shows its place in both views', () => visit('hostile', async (page) => {
  const before = await axis(page, 'before'), camera_before = await camera(page);
  const [link] = await page.$$('#remarks tbody a');
  const line = await link.textContent();
  await link.click();
  await drawn_again(page, camera_before);
  assert.ok(spread(await axis(page, 'before')) < spread(before));
  assert.match(await page.innerText('#place h3'), new RegExp(`ine ${line}$`));
}));

test('two failed runs are side by side, too', async () => {
  const data = data_in('failed');
  data.runs.push(data_in('failed').runs[0]);
  write_page('failed', data, 'two_failed');
  await visit('two_failed', async (page) => {
    assert.equal(await page.locator('.verdict.bad').count(), 2);
    assert.equal(await page.locator('main > #verdict > .verdict').count(), 0);
  });
});

test('two runs are side by side, their curves in the same plots', async () => {
  const data = data_in('pocket');
  data.runs.push(data_in('constant').runs[0]);
  data.runs[0].name = 'forces of each block';
  write_page('pocket', data, 'two');
  await visit('two', async (page) => {
    assert.deepEqual(await texts(page, '.run .letter'), ['A', 'B']);
    assert.deepEqual(await texts(page, '#curves figure:first-of-type button.entry'), ['before A', 'before B']);
    assert.equal(await page.locator('#worst table').count(), 2);
    const [a, b] = ['pocket', 'constant'].map((name) => 1000 * report_of(name).summary.after.max_mm);
    const row = await texts(page, '#numbers tbody tr:first-child td');
    assert.ok(Math.abs(Number(row[5]) - (b - a)) < 0.1, `${row} ${a} ${b}`);
    assert.match(await page.innerText('#facts'), /forces, SHA-256 differs/);
    await page.click('#worst .stack > :nth-child(2) tbody tr:nth-child(2) a');
    assert.match(await page.innerText('#place h3'), /^B: /);
  });
});

test('hiding a curve with Enter keeps the focus on its name', () => visit('pocket', async (page) => {
  await page.waitForFunction(() => document.querySelectorAll('.plot.sources canvas').length > 0);
  await page.focus('#sources button.entry:nth-child(2)');
  for (const pressed of ['false', 'true']) {
    await page.keyboard.press('Enter');
    assert.equal(await page.evaluate(() => document.activeElement.textContent), 'geometry');
    assert.equal(await page.evaluate(() => document.activeElement.getAttribute('aria-pressed')), pressed);
  }
}));

test('the line of the largest deviation before is followed from its card and from the numbers', () => visit('pocket', async (page) => {
  const {max_line: line} = report_of('pocket').summary.before;
  for (const link of ['[data-card=before] a', '#numbers tbody tr:nth-child(2) td:nth-child(2) a']) {
    await page.click('#worst tbody tr:nth-child(4) a');
    await page.click(link);
    assert.match(await page.innerText('#place h3'), new RegExp(`Line ${line}$`));
    const [told] = /[\d.]+/.exec(await page.innerText('#place .cause'));
    assert.equal(told, /[\d.]+/.exec(await page.innerText('[data-card=before] strong'))[0]);
  }
}));

/** One finger that moves from a place to another. */
async function swipe(page, from, to) {
  const client = await page.context().newCDPSession(page);
  const touch = (type, points) => client.send('Input.dispatchTouchEvent', {type, touchPoints: points});
  await touch('touchStart', [from]);
  for (let k = 1; k <= 8; ++k) await touch('touchMove', [{x: from.x + (k * (to.x - from.x)) / 8, y: from.y + (k * (to.y - from.y)) / 8}]);
  await touch('touchEnd', []);
}

test('a finger on a plot scrolls the page, and its tap selects', () => visit('pocket', async (page) => {
  await page.locator('.plot.before').scrollIntoViewIfNeeded();
  const whole = await axis(page, 'before'), top = await page.evaluate(() => scrollY);
  const box = await page.locator('.plot.before').boundingBox();
  const selected = await page.evaluate(() => counterflex.context.selection.stretch);
  await page.touchscreen.tap(box.x + 0.8 * box.width, box.y + 100);
  await page.waitForFunction((old) => counterflex.context.selection.stretch !== old, selected);
  await swipe(page, {x: box.x + 200, y: box.y + 150}, {x: box.x + 190, y: box.y + 20});
  await page.waitForFunction((old) => scrollY > old + 40, top);
  assert.deepEqual(await axis(page, 'before'), whole);
}, {touch: true}));
