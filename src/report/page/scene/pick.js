'use strict';
/** Finds the place of a path at a point of the picture. */
(() => {
  /** A path in the picture: pixels x and y, and depth in mm towards the eye, for each stretch. */
  function projected(path, factor, project) {
    const [x, y, depth] = [0, 1, 2].map(() => new Float32Array(path.count));
    for (let i = 0; i < path.count; ++i)
      [x[i], y[i], depth[i]] = project(...counterflex.pathModel.drawnAt(path, i, factor));
    return {x, y, depth};
  }

  /** The fraction, 0..1, of the line from (x0, y0) to (x1, y1) at the point nearest to (x, y). */
  function nearestOn(x0, y0, x1, y1, x, y) {
    const [dx, dy] = [x1 - x0, y1 - y0];
    const length2 = dx * dx + dy * dy;
    return length2 > 0 ? Math.min(1, Math.max(0, ((x - x0) * dx + (y - y0) * dy) / length2)) : 1;
  }

  /** The feed line to stretch `i` seen from (x, y): {stretch: its nearer end, distance, depth} in pixels and mm. */
  function candidate({x: xs, y: ys, depth}, rapid, i, x, y) {
    const j = i > 0 && !rapid[i] ? i - 1 : i;
    const t = nearestOn(xs[j], ys[j], xs[i], ys[i], x, y);
    return {stretch: t < 0.5 ? j : i, depth: depth[j] + t * (depth[i] - depth[j]),
      distance: Math.hypot(xs[j] + t * (xs[i] - xs[j]) - x, ys[j] + t * (ys[i] - ys[j]) - y)};
  }

  /**
   * The stretch nearest to pixel (x, y), or -1 without one within `reach` pixels. Of overlapping lines (within two
   * pixels) the one nearest to the eye.
   */
  function nearest(picture, rapid, x, y, reach) {
    const near = [];
    for (let i = 0; i < picture.x.length; ++i) {
      const line = candidate(picture, rapid, i, x, y);
      if (line.distance <= reach) near.push(line);
    }
    const least = near.reduce((best, line) => Math.min(best, line.distance), reach);
    const front = near.filter((line) => line.distance <= least + 2)
      .reduce((best, line) => (best && best.depth >= line.depth ? best : line), null);
    return front ? front.stretch : -1;
  }

  counterflex.pick = {projected, nearest};
})();
