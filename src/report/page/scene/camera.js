'use strict';
/**
 * The camera of the path views: parallel projection, z of the machine up. Plain state and pure functions, so that
 * the WebGL view and the flat view show the same.
 *
 * State: {azimuth, elevation} in radians, the direction to the eye (azimuth 0: from the front, that is
 * from -y; elevation 90 degrees: from above); `centre`, the point in the middle of the picture, mm; `span`, the mm
 * that the shorter side of the picture shows; `fitted`: whether it is fitted again when the window changes.
 */
(() => {
  const quarter = Math.PI / 2;

  /** The views of the buttons. */
  const views = {
    top: {azimuth: 0, elevation: quarter},
    front: {azimuth: 0, elevation: 0},
    side: {azimuth: quarter, elevation: 0},
    isometric: {azimuth: Math.PI / 4, elevation: Math.atan(Math.SQRT1_2)},
  };

  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

  /** Unit vectors of the picture, axes of the machine: right, up, and back (towards the eye). */
  function basis({azimuth, elevation}) {
    const [c, s, ce, se] = [Math.cos(azimuth), Math.sin(azimuth), Math.cos(elevation), Math.sin(elevation)];
    return {right: [c, s, 0], up: [-s * se, c * se, ce], back: [s * ce, -c * ce, se]};
  }

  /** Pixels per mm in a picture of that size. */
  const scale = (camera, size) => Math.min(size.width, size.height) / camera.span;

  /**
   * A function that maps a place (x, y, z in mm) to [x, y, depth]: pixels from the upper left corner, and mm
   * towards the eye.
   */
  function projector(camera, size) {
    const {right, up, back} = basis(camera);
    const k = scale(camera, size);
    const [x0, y0] = [size.width / 2 - k * dot(right, camera.centre), size.height / 2 + k * dot(up, camera.centre)];
    return (x, y, z) => [x0 + k * (right[0] * x + right[1] * y + right[2] * z),
      y0 - k * (up[0] * x + up[1] * y + up[2] * z), back[0] * x + back[1] * y + back[2] * z];
  }

  /** The eight corners of a box {low: [3], high: [3]}. */
  const corners = ({low, high}) => [0, 1, 2, 3, 4, 5, 6, 7].map((bits) =>
    [0, 1, 2].map((axis) => ((bits >> axis) & 1 ? high[axis] : low[axis])));

  /**
   * Seen from the same side, the whole box, with `margin` = [pixels left and right, pixels above and below] left
   * free. A box without extent in the picture is shown with some surroundings, a single point with 10 mm.
   */
  function fit(camera, box, size, margin) {
    const {right, up} = basis(camera);
    const largest = Math.max(...box.high.map((v, i) => v - box.low[i]));
    const least = largest > 0 ? 0.05 * largest : 10;
    const extent = (axis) => {
      const along = corners(box).map((p) => dot(axis, p));
      return Math.max(Math.max(...along) - Math.min(...along), least);
    };
    const free = (length, edge) => Math.max(0.4 * length, length - 2 * edge);
    const k = Math.min(free(size.width, margin[0]) / extent(right), free(size.height, margin[1]) / extent(up));
    const centre = box.low.map((v, i) => (v + box.high[i]) / 2);
    return {...camera, centre, span: Math.min(size.width, size.height) / k, fitted: true};
  }

  /** Rotated by radians; the elevation stays between straight down and straight up. */
  const turn = (camera, byAzimuth, byElevation) => ({...camera, azimuth: camera.azimuth + byAzimuth, fitted: false,
    elevation: Math.min(quarter, Math.max(-quarter, camera.elevation + byElevation))});

  /** Moved so that the picture shifts by pixels to the right and down. */
  function pan(camera, size, dx, dy) {
    const {right, up} = basis(camera);
    const k = scale(camera, size);
    return {...camera, centre: camera.centre.map((v, i) => v - (dx * right[i] - dy * up[i]) / k), fitted: false};
  }

  /** Larger by `factor` (smaller below 1); the point at pixel [x, y] stays there. `limits`: of the span, [mm, mm]. */
  function zoom(camera, size, factor, [x, y], limits) {
    const span = Math.min(limits[1], Math.max(limits[0], camera.span / factor));
    const {right, up} = basis(camera);
    const mm = (1 - span / camera.span) / scale(camera, size);  // shift for each pixel from the middle
    const [dx, dy] = [mm * (x - size.width / 2), mm * (y - size.height / 2)];
    return {...camera, centre: camera.centre.map((v, i) => v + dx * right[i] - dy * up[i]), span, fitted: false};
  }

  counterflex.camera = {views, basis, scale, projector, fit, turn, pan, zoom};
})();
