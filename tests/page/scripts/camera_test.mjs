import assert from 'node:assert/strict';
import test from 'node:test';
import {load_scripts} from './load_scripts.mjs';

const {camera} = load_scripts('camera.js');
const size = {width: 800, height: 500};
const start = {...camera.views.isometric, centre: [10, 20, 30], span: 100, fitted: false};
const box = {low: [-100, 0, 40], high: [300, 50, 60]};

const near = (actual, expected, tolerance = 1e-9) => expected.forEach((v, i) =>
  assert.ok(Math.abs(actual[i] - v) <= tolerance, `${actual} is not ${expected}`));

test('the axes of the picture are a right-handed orthonormal triad for every direction', () => {
  for (const azimuth of [0, 0.3, 2, -4])
    for (const elevation of [-1.5, 0, 0.6, Math.PI / 2]) {
      const {right, up, back} = camera.basis({azimuth, elevation});
      near([Math.hypot(...right), Math.hypot(...up)], [1, 1]);
      near([right[1] * up[2] - right[2] * up[1], right[2] * up[0] - right[0] * up[2],
        right[0] * up[1] - right[1] * up[0]], back);
    }
});

test('from above x is to the right and y up, from the front z is up, from the side y is to the right', () => {
  const axes = (name) => camera.basis(camera.views[name]);
  near([...axes('top').right, ...axes('top').up], [1, 0, 0, 0, 1, 0]);
  near([...axes('front').right, ...axes('front').up], [1, 0, 0, 0, 0, 1]);
  near([...axes('side').right, ...axes('side').up], [0, 1, 0, 0, 0, 1]);
});

test('an isometric view shows the three axes equally long', () => {
  const {right, up} = camera.basis(camera.views.isometric);
  near([0, 1, 2].map((i) => Math.hypot(right[i], up[i])), [1, 1, 1].map((v) => v * Math.sqrt(2 / 3)));
});

test('the centre of a camera is in the middle of the picture', () => {
  near(camera.projector(start, size)(...start.centre), [400, 250], 1e-9);
});

test('the shorter side of the picture shows the span', () => {
  const top = {...start, ...camera.views.top};
  near(camera.projector(top, size)(10, 20 + 50, 30), [400, 0]);
  near(camera.projector(top, {width: 300, height: 500})(10 + 50, 20, 30), [300, 250]);
});

test('a fitted box is whole in the picture and touches its margin', () => {
  for (const view of Object.values(camera.views))
    for (const picture of [size, {width: 300, height: 500}]) {
      const project = camera.projector(camera.fit({...start, ...view}, box, picture, [20, 60]), picture);
      const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((b) =>
        project(...[0, 1, 2].map((k) => ((b >> k) & 1 ? box.high[k] : box.low[k]))));
      const beside = Math.min(...corners.map(([x]) => Math.min(x, picture.width - x))) - 20;
      const above = Math.min(...corners.map(([, y]) => Math.min(y, picture.height - y))) - 60;
      assert.ok(Math.abs(Math.min(beside, above)) < 1e-6, `${beside} ${above}`);
    }
});

test('flat boxes, lines and points are fitted with a finite span', () => {
  const boxes = [{low: [0, 0, 5], high: [100, 50, 5]}, {low: [0, 0, 0], high: [0, 0, 100]},
    {low: [1, 2, 3], high: [1, 2, 3]}];
  for (const flat of boxes)
    for (const view of Object.values(camera.views)) {
      const {span} = camera.fit({...start, ...view}, flat, size, [60, 60]);
      assert.ok(span > 1 && span < 1000, `${span}`);
    }
});

test('panning slides the picture by so many pixels', () => {
  const [x, y, z] = [1, 2, 3];
  const before = camera.projector(start, size)(x, y, z);
  const after = camera.projector(camera.pan(start, size, 30, -20), size)(x, y, z);
  near([after[0] - before[0], after[1] - before[1]], [30, -20]);
});

test('zooming keeps the point under the pointer, within the limits of the span', () => {
  const {right, up} = camera.basis(start);
  const k = camera.scale(start, size);
  const under = start.centre.map((v, i) => v + ((200 - 400) * right[i] - (100 - 250) * up[i]) / k);
  for (const factor of [0.5, 3, 1e9]) {
    const zoomed = camera.zoom(start, size, factor, [200, 100], [0.1, 1000]);
    near(camera.projector(zoomed, size)(...under), [200, 100], 1e-6);
    assert.equal(zoomed.span, Math.max(0.1, 100 / factor));
  }
});

test('the elevation stays between straight down and straight up', () => {
  assert.equal(camera.turn(start, 0, 9).elevation, Math.PI / 2);
  assert.equal(camera.turn(start, 0, -9).elevation, -Math.PI / 2);
});
