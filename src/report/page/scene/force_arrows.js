'use strict';
/** The cutting force along the path view: arrows of the force on the tool, N, axes of the machine, and their scale. */
(() => {
  const most = 60;  // arrows of a picture
  const longest = 0.14;  // of the shorter side of the picture: the arrow of the largest force
  const head = 7;  // pixels
  const edge = 12;  // as in overlay.js
  const components = ['force_x_N', 'force_y_N', 'force_z_N'];

  /** The force in a stretch: [x, y, z], null if unknown. Of merged waypoints each component is the one that is larger. */
  function forceAt({quantities}, i) {
    const force = components.map((name) => {
      const {least, largest} = quantities[name];
      return Math.abs(least[i]) > Math.abs(largest[i]) ? least[i] : largest[i];
    });
    return force.every(Number.isFinite) ? force : null;
  }

  /** The size of the largest force along curves, N; 0 without forces. */
  function largestOf(curves) {
    if (!components.every((name) => curves.quantities[name])) return 0;
    let largest = 0;
    curves.s_mm.forEach((_, i) => {
      const force = forceAt(curves, i);
      if (force) largest = Math.max(largest, Math.hypot(...force));
    });
    return largest;
  }

  /** Whether a run has forces to show. */
  const usable = (run) => Boolean(run && run.curves) && largestOf(run.curves) > 0;

  /** The stretches with an arrow: at most `count`, at equal steps of cutting path length, ascending. */
  function placesOf({s_mm: s}, count = most) {
    const total = s.length > 0 ? s[s.length - 1] : 0;
    const places = [];
    let i = 0;
    for (let k = 0; k < count && i < s.length; ++k) {
      while (i < s.length - 1 && s[i] < ((k + 0.5) * total) / count) ++i;
      if (places[places.length - 1] !== i) places.push(i);
    }
    return places;
  }

  /**
   * The arrows of a picture: [{stretch, from, to}], places in mm from the origin, and the scale: {arrows, N_per_mm}.
   * `placeOf(stretch)`: the drawn place.
   */
  function arrowsOf(curves, placeOf, pixelsPerMm, size) {
    const largest = largestOf(curves);
    const mm = (longest * Math.min(size.width, size.height)) / pixelsPerMm;
    if (!(largest > 0) || !(mm > 0)) return {arrows: [], N_per_mm: 0};
    const arrows = placesOf(curves).map((stretch) => ({stretch, force: forceAt(curves, stretch)}))
      .filter(({force}) => force && Math.hypot(...force) > 0)
      .map(({stretch, force}) => {
        const from = placeOf(stretch);
        return {stretch, from, to: from.map((v, k) => v + (force[k] * mm) / largest)};
      });
    return {arrows, N_per_mm: largest / mm};
  }

  /** An arrow between two pixels. A short one, towards the eye, is a dot. */
  function arrow(context, [x0, y0], [x1, y1]) {
    const length = Math.hypot(x1 - x0, y1 - y0);
    context.beginPath();
    if (length < 2) {
      context.arc(x0, y0, 2, 0, 2 * Math.PI);
      context.fill();
      return;
    }
    const [dx, dy] = [(x1 - x0) / length, (y1 - y0) / length], tip = Math.min(head, 0.6 * length);
    context.moveTo(x0, y0);
    context.lineTo(x1 - tip * dx, y1 - tip * dy);
    context.stroke();
    context.beginPath();
    context.moveTo(x1, y1);
    context.lineTo(x1 - tip * dx - 0.4 * tip * dy, y1 - tip * dy + 0.4 * tip * dx);
    context.lineTo(x1 - tip * dx + 0.4 * tip * dy, y1 - tip * dy - 0.4 * tip * dx);
    context.closePath();
    context.fill();
  }

  /** The scale, upper right: an arrow as long as that of a round force in the plane of the picture. */
  function legend(context, size, theme, N_per_pixel) {
    const force = counterflex.pathModel.oneTwoFive(0.7 * N_per_pixel * longest * Math.min(size.width, size.height));
    const text = `${force} N on the tool`;
    context.font = '12px system-ui, sans-serif';
    const width = context.measureText(text).width, length = force / N_per_pixel;
    const right = size.width - edge, left = right - Math.max(width, length);
    context.globalAlpha = 0.8;
    context.fillStyle = counterflex.colours.css(theme.ground);
    context.fillRect(left - edge, 0, size.width - left + edge, 52);
    context.globalAlpha = 1;
    context.fillStyle = context.strokeStyle = counterflex.colours.css(theme.ink);
    arrow(context, [right - length, 40], [right, 40]);
    context.textAlign = 'right';
    context.textBaseline = 'middle';
    context.fillText(text, right, 20);
  }

  /** Draws arrows and scale. `placeOf(stretch)`: the drawn place of a stretch, mm from the origin. */
  function draw(context, size, {curves, placeOf, camera, project, theme}) {
    const pixelsPerMm = counterflex.camera.scale(camera, size);
    const {arrows, N_per_mm} = arrowsOf(curves, placeOf, pixelsPerMm, size);
    if (arrows.length === 0) return;
    context.save();
    context.lineWidth = 1.8;
    context.lineCap = 'round';
    context.fillStyle = context.strokeStyle = counterflex.colours.css(theme.ink);
    for (const {from, to} of arrows) arrow(context, project(...from), project(...to));
    legend(context, size, theme, N_per_mm / pixelsPerMm);
    context.restore();
  }

  counterflex.forceArrows = {usable, forceAt, largestOf, placesOf, arrowsOf, draw};
})();
