import assert from 'node:assert/strict';
import test from 'node:test';
import {data_in, pixels, texts, visit, write_page} from './browser.mjs';

const drawn = (page, plot) => page.waitForFunction((name) => document.querySelectorAll(`.plot.${name} canvas`).length > 0, plot);
const state = (page) => page.$eval('#path-view .scene-view', ({dataset}) => ({...dataset}));

/** The tip of the machine that is drawn, and the commanded place of the stretch that is selected, mm. */
async function tip_and_place(page) {
  await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
  const tip = (await state(page)).machine.split(' ').map(Number);
  const place = await page.evaluate(() => {
    const {selection: {stretch}, runs: [{curves}]} = counterflex.context;
    const correction = counterflex.vectors.at(curves, 'correction', stretch).vector;
    return Array.from(correction, (v, i) => curves.place_mm[3 * stretch + i] + v);
  });
  return [tip, place];
}

const distance = (a, b) => Math.hypot(...a.map((v, i) => v - b[i]));

test('axes are drawn between their limits, all together or one in its unit, and listed', () => visit('face', async (page) => {
  await drawn(page, 'axes');
  assert.match(await page.innerText('#axes h3 >> nth=0'), /in % of their travel/);
  assert.ok(await pixels(page, '.plot.axes canvas', '--limit') > 200);
  assert.deepEqual(await texts(page, '#axes tbody th'), ['axis A1', 'axis A2', 'axis A3', 'axis A4', 'axis A5', 'axis A6']);
  const [, least, largest, travel, margin] = (await texts(page, '#axes tbody tr:nth-child(2) :is(th, td)'));
  assert.equal(travel, '-140 to -5 deg');
  assert.ok(parseFloat(least) <= parseFloat(largest));
  assert.match(margin, /^[\d.]+ deg, line \d+$/);
  await page.check('#axes input[name=axis][value="axis A2"]');
  assert.match(await page.innerText('#axes h3 >> nth=0'), /axis A2 as the control shows it, in deg$/);
}));

test('the values of axes at the mouse are in their own units', () => visit('face', async (page) => {
  await drawn(page, 'axes');
  await page.locator('.plot.axes').scrollIntoViewIfNeeded();
  const {x, y, width, height} = await page.locator('.plot.axes').boundingBox();
  await page.mouse.move(x + width / 2, y + height / 2);
  const readout = await page.innerText('#axes .readout >> nth=0');
  assert.match(readout, /line \d+: A1 -?[\d.]+ deg, A2 -?[\d.]+ deg/);
  assert.doesNotMatch(readout, /%/);
}));

test('an arm shows its distances from singular poses', () => visit('face', async (page) => {
  await drawn(page, 'margins');
  assert.deepEqual(await texts(page, '#axes figure:has(.plot.margins) .entries:not(.paper) .entry'), ['wrist', 'elbow', 'shoulder']);
  assert.match(await page.innerText('#axes .note >> nth=0'), /axes A4 and A6 are in line/);
}));

test('an axis near its limit, and one outside its travel, are marked', async () => {
  const data = data_in('face');
  const [near, over] = data.runs[0].machine.axes;
  Object.assign(near, {min: -1, max: 1000, least_margin: 1});
  Object.assign(over, {min: 500, max: 1000, least_margin: -400});
  write_page('face', data, 'near_limits');
  await visit('near_limits', async (page) => {
    assert.match(await page.innerText('#axes tr.exceeded'), /outside its travel/);
    await drawn(page, 'axes');
    assert.ok((await texts(page, '#axes .entry')).includes('A2 (outside its travel)'));
  });
});

test('a machine without limits is drawn in its units', async () => {
  const data = data_in('face');
  for (const axis of data.runs[0].machine.axes) Object.assign(axis, {min: null, max: null, least_margin: null});
  write_page('face', data, 'without_limits');
  await visit('without_limits', async (page) => {
    await drawn(page, 'axes');
    assert.match(await page.innerText('#axes h3 >> nth=0'), /axis A1 as the control shows it, in deg/);
    assert.deepEqual(await texts(page, '#axes tbody tr:first-child td:nth-child(4)'), ['no limits']);
  });
});

for (const webgl of [true, false])
  test(`the machine has its tip at the place that is shown, ${webgl ? 'with' : 'without'} WebGL`, () => visit('face', async (page) => {
    assert.equal((await state(page)).machine, '');
    const {span} = await state(page);
    await page.check('input[name=machine]');
    await page.focus('.code-slider');
    await page.keyboard.press('End');
    for (let steps = 0; steps < 3; ++steps) {
      const [tip, place] = await tip_and_place(page);
      assert.ok(distance(tip, place) < 0.1, `${tip} is not ${place}`);
      for (let i = 0; i < 8; ++i) await page.keyboard.press('ArrowLeft');
    }
    assert.ok((await state(page)).span > 2 * span);  // the machine is larger than the path
    await page.uncheck('input[name=machine]');
    await page.waitForFunction((old) => document.querySelector('#path-view .scene-view').dataset.span === old, span);
    assert.equal((await state(page)).machine, '');
  }, {webgl}));

for (const webgl of [true, false])
  test(`the force is drawn on the path if chosen, ${webgl ? 'with' : 'without'} WebGL`, () => visit('pocket', async (page) => {
    const picture = () => page.$eval('#path-view .scene-canvas', (canvas) => canvas.toDataURL());
    const shown = (forces) => page.waitForFunction((on) => document.querySelector('#path-view .scene-view').dataset.forces === on, forces);
    await shown('false');
    const before = await picture();
    await page.check('input[name=forces]');
    await shown('true');
    assert.notEqual(await picture(), before);
    await page.uncheck('input[name=forces]');
    await shown('false');
    assert.equal(await picture(), before);
  }, {webgl}));

test('the machine follows the mouse over a curve', () => visit('face', async (page) => {
  await page.check('input[name=machine]');
  const [selected] = await tip_and_place(page);
  await drawn(page, 'after');
  const {width, height} = await page.locator('.plot.after').boundingBox();
  await page.locator('.plot.after').hover({position: {x: width - 40, y: height / 2}});
  const [hovered] = await tip_and_place(page);
  assert.ok(distance(hovered, selected) > 1, `${hovered}`);
}));

test('a run without the machine along its path has no such section, and no machine to show', async () => {
  const data = data_in('face');
  delete data.runs[0].machine;  // as pages of earlier versions
  write_page('face', data, 'without_machine');
  await visit('without_machine', async (page) => {
    assert.equal(await page.locator('#axes').isVisible(), false);
    assert.equal(await page.locator('input[name=machine]').count(), 0);
  });
});
