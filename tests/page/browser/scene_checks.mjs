import assert from 'node:assert/strict';
import test from 'node:test';
import {data_in, visit, write_page} from './browser.mjs';

const stage = '#path-view .scene-stage';
const state = (page) => page.$eval('#path-view .scene-view', ({dataset}) => ({...dataset}));

/** The state of the view after `act`, once it differs from what it was. */
async function changed(page, act) {
  const before = JSON.stringify(await state(page));
  await act();
  await page.waitForFunction((old) =>
    JSON.stringify({...document.querySelector('#path-view .scene-view').dataset}) !== old, before);
  return state(page);
}

const settled = (page) => page.evaluate(() =>
  new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));

/** The coloured pixels of the path, away from the scales: [x, y] in pixels of the stage; every one of `step`. */
function path_pixels(page, step = 1) {
  return page.$eval('.scene-canvas', (canvas, every) => {
    const k = canvas.width / canvas.clientWidth;
    const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext('2d', {willReadFrequently: true});
    copy.drawImage(canvas, 0, 0);
    const {data} = copy.getImageData(0, 0, canvas.width, canvas.height);
    const found = [];
    for (let y = 110 * k; y < canvas.height - 110 * k; y += every)
      for (let x = 0; x < canvas.width; x += every) {
        const i = 4 * (Math.round(y) * canvas.width + x);
        const part = [data[i], data[i + 1], data[i + 2]];
        if (Math.max(...part) - Math.min(...part) > 60) found.push([x / k, y / k]);
      }
    return found;
  }, step);
}

async function at(page, [x, y]) {
  await page.locator(stage).scrollIntoViewIfNeeded();
  const box = await page.locator(stage).boundingBox();
  return [box.x + x, box.y + y];
}

/** Drags from the middle of the view by pixels. */
async function drag(page, dx, dy, button = 'left') {
  const {width, height} = await page.locator(stage).boundingBox();
  const [x, y] = await at(page, [width / 2, height / 2]);
  await page.mouse.move(x, y);
  await page.mouse.down({button});
  await page.mouse.move(x + dx, y + dy, {steps: 4});
  await page.mouse.up({button});
}

/** Two fingers around a place of the view, first `from` and then `to` pixels away from it. */
async function pinch(page, from, to) {
  await page.focus(stage);
  const session = await page.context().newCDPSession(page);
  const [x, y] = await at(page, [250, 200]);
  const touch = (type, half) => session.send('Input.dispatchTouchEvent',
    {type, touchPoints: half === null ? [] : [{x: x - half, y, id: 1}, {x: x + half, y, id: 2}]});
  await touch('touchStart', from);
  await touch('touchMove', to);
  await touch('touchEnd', null);
}

const picture = (page) => page.$eval('.scene-canvas', (canvas) => canvas.toDataURL());

/** Clicks on a pixel of the path and checks that the place is selected and announced. */
async function choose(page, pixel) {
  await page.mouse.click(...await at(page, pixel));
  await settled(page);
  const [line] = (await page.innerText('.scene-status')).match(/\d+/);
  assert.equal(await page.innerText('#place h3'), `Line ${line}`);
}

test('with WebGL and without, the path is in the same place and a click on it selects that place', async () => {
  const pictures = [];
  for (const webgl of [true, false])
    await visit('pocket', async (page) => {
      const pixels = await path_pixels(page);
      pictures.push(new Set(pixels.map(([x, y]) => `${x} ${y}`)));
      for (const pixel of [pixels[Math.floor(pixels.length / 3)], pixels[pixels.length - 1]]) await choose(page, pixel);
    }, {webgl});
  const [one, other] = pictures;
  const both = [...one].filter((pixel) => other.has(pixel)).length;
  assert.ok(both > 1000 && both > 0.8 * Math.max(one.size, other.size), `${both} of ${one.size} and ${other.size}`);
});

test('keys walk along the path, turn, move and zoom the view that has the focus', () => visit('pocket', async (page) => {
  await page.focus(stage);
  const start = await state(page);
  const after = (key) => changed(page, () => page.keyboard.press(key));
  const count = data_in('pocket').runs[0].curves.stretches;
  const walk = [['End', count - 1], ['ArrowLeft', count - 2], ['Home', 0], ['ArrowRight', 1]];
  for (const [key, stretch] of walk) assert.equal((await after(key)).stretch, String(stretch));
  assert.notEqual((await after('Shift+ArrowRight')).azimuth, start.azimuth);
  assert.notEqual((await after('Shift+ArrowUp')).elevation, start.elevation);
  assert.notEqual((await after('Control+ArrowRight')).centre, start.centre);
  assert.ok(Number((await after('+')).span) < start.span);
  assert.equal((await after('0')).centre, start.centre);
}));

test('a drag turns, the right button moves, two fingers zoom, and none of them is a click', () => visit('pocket', async (page) => {
  const start = await state(page);
  const turned = await changed(page, () => drag(page, 60, 30));
  assert.ok(turned.azimuth !== start.azimuth && turned.elevation !== start.elevation);
  const moved = await changed(page, () => drag(page, 60, 30, 'right'));
  assert.notEqual(moved.centre, turned.centre);
  assert.equal(moved.azimuth, turned.azimuth);
  const pinched = await changed(page, () => pinch(page, 40, 80));
  assert.ok(Number(pinched.span) < 0.7 * moved.span, `${pinched.span} of ${moved.span}`);
  assert.equal(pinched.stretch, start.stretch);
}));

test('the wheel scrolls the page past the view, and zooms once the view has the focus', () => visit('pocket', async (page) => {
  const start = await state(page);
  await page.mouse.move(...await at(page, [200, 200]));
  await page.mouse.wheel(0, 60);
  await page.waitForFunction(() => scrollY > 0);
  assert.deepEqual(await state(page), start);
  await page.focus(stage);
  await page.mouse.move(...await at(page, [200, 200]));
  assert.ok(Number((await changed(page, () => page.mouse.wheel(0, -100))).span) < start.span);
}));

test('controls choose the side, the path and the exaggeration', () => visit('pocket', async (page) => {
  for (const [button, azimuth, elevation] of [['Top', 0, 90], ['Front', 0, 0], ['Side', 90, 0], ['Isometric', 45, 35]]) {
    const now = await changed(page, () => page.click(`.scene-views button:has-text("${button}")`));
    assert.deepEqual([now.azimuth, now.elevation].map(Number), [azimuth, elevation], button);
    assert.ok((await path_pixels(page)).length > 300, button);
  }
  await changed(page, () => page.check('.scene-view input[value="before"]'));
  const usual = Number((await state(page)).factor);
  const pictures = new Set([await picture(page)]);
  for (const kind of ['wanted', 'after']) {
    await changed(page, () => page.check(`.scene-view input[value="${kind}"]`));
    pictures.add(await picture(page));
  }
  await page.focus('.scene-slider input');
  const {factor} = await changed(page, () => page.keyboard.press('End'));
  assert.ok(Number(factor) > 100 * usual, `${factor} of ${usual}`);
  assert.ok((await page.innerText('.scene-factor')).includes(factor));
  pictures.add(await picture(page));
  assert.equal(pictures.size, 4);
  const back = await changed(page, () => page.check('.scene-view input[value="before"]'));
  assert.equal(Number(back.factor), usual, 'a factor for the small deviation is absurd for the large one');
}));

function keep_context() {
  const get_context = HTMLCanvasElement.prototype.getContext;
  HTMLCanvasElement.prototype.getContext = function(kind, ...rest) {
    const context = get_context.call(this, kind, ...rest);
    if (kind === 'webgl') window.kept_context = context;
    return context;
  };
}

test('if the graphics processor is lost the view is drawn flat', () => visit('pocket', async (page) => {
  await page.addInitScript(keep_context);
  await page.reload();
  await page.waitForFunction(() => document.documentElement.dataset.ready);
  await page.evaluate(() => window.kept_context.getExtension('WEBGL_lose_context').loseContext());
  await page.waitForFunction(() => document.querySelector('.scene-view').dataset.renderer === 'canvas');
  assert.ok((await path_pixels(page)).length > 1000);
}));

test('on a dark background the view is dark, and on paper it is light, before and after', () => visit('pocket', async (page) => {
  const grounds = (selector) => page.$$eval(selector, (canvases) => canvases.map((canvas) =>
    Array.from(canvas.getContext('2d').getImageData(canvas.width - 5, 5, 1, 1).data).slice(0, 3)));
  for (const ground of await grounds('.scene-canvas')) assert.ok(Math.max(...ground) < 60, `${ground}`);
  await page.emulateMedia({media: 'print'});
  await page.waitForFunction(() => document.querySelectorAll('.scene-paper').length === 2);
  assert.deepEqual(await grounds('.scene-paper'), [[255, 255, 255], [255, 255, 255]]);
  assert.equal(await page.locator('.scene-controls').isVisible(), false);
}, {scheme: 'dark'}));

const width_of = {s_mm: 8, first_line: 4, last_line: 4, operation: 4, after_rapid: 1, place_mm: 12,
  place_before_mm: 12, place_after_mm: 12};

/** Curves with the first `count` stretches alone. */
function cut(curves, count) {
  const head = (base64, width) => Buffer.from(base64, 'base64').subarray(0, count * width).toString('base64');
  for (const [name, width] of Object.entries(width_of)) curves[name] = head(curves[name], width);
  for (const quantity of Object.values(curves.quantities))
    for (const name of Object.keys(quantity)) quantity[name] = head(quantity[name], 4);
  return {...curves, stretches: count, waypoints: count};
}

for (const [count, what] of [[1, 'place'], [2, 'line']])
  test(`a path of a single ${what} is drawn`, async () => {
    const data = data_in('pocket');
    data.runs[0].curves = cut(data.runs[0].curves, count);
    write_page('pocket', data, `single_${what}`);
    await visit(`single_${what}`, async (page) => {
      assert.ok((await path_pixels(page)).length > 20);
      for (const button of ['Top', 'Front', 'Side'])
        assert.ok(Number((await changed(page, () => page.click(`.scene-views button:has-text("${button}")`))).span) > 0);
    });
  });
