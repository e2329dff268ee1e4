'use strict';
/** Draws paths on a 2-D canvas: the view for browsers without WebGL, with the same camera and colours. */
(() => {
  const shades = 48;  // number of colours; neighbours of the same shade are one stroke

  /** The shade of a segment, -1 where its deviation is unknown. */
  const shade = (fraction, i) => (fraction[i] < 0 || fraction[i - 1] < 0 ? -1
    : Math.round(0.5 * (fraction[i] + fraction[i - 1]) * (shades - 1)));

  function stroke(context, colour, width, dash) {
    context.strokeStyle = counterflex.colours.css(colour);
    context.lineWidth = width;
    context.setLineDash(dash);
    context.stroke();
  }

  /** Strokes segments [i - 1, i] for which `wanted(i)`; consecutive ones with equal `key(i)` are one stroke. */
  function strokes(context, points, wanted, key, paint) {
    let open = null;
    for (let i = 1; i < points.x.length; ++i) {
      const name = wanted(i) ? key(i) : null;
      if (open !== null && name !== open) paint(open);
      if (name !== null) {
        if (name !== open) {
          context.beginPath();
          context.moveTo(points.x[i - 1], points.y[i - 1]);
        }
        context.lineTo(points.x[i], points.y[i]);
      }
      open = name;
    }
    if (open !== null) paint(open);
  }

  /** One layer: {path, factor, style: 'deviation' | 'plain' | 'rapid', width, colour, opacity, dash}. */
  function drawLayer(context, project, layer, theme) {
    const {path, style, width} = layer;
    const points = counterflex.pick.projected(path, layer.factor, project);
    context.globalAlpha = layer.opacity;
    context.lineCap = style === 'rapid' ? 'butt' : 'round';
    context.lineJoin = 'round';
    const rapid = style === 'rapid' ? 1 : 0;
    const key = style === 'deviation' ? (i) => shade(path.fraction, i) : () => 0;
    const colourOf = (name) => (style !== 'deviation' ? layer.colour
      : name < 0 ? theme.muted : counterflex.colours.at(name / (shades - 1), theme.dark));
    strokes(context, points, (i) => Boolean(path.rapid[i]) === Boolean(rapid), key,
      (name) => stroke(context, colourOf(name), width, layer.dash));
    if (path.count === 1 && style !== 'rapid') dot(context, points, colourOf(key(0)), width);
  }

  /** A path with only one place. */
  function dot(context, points, colour, width) {
    context.beginPath();
    context.arc(points.x[0], points.y[0], width, 0, 2 * Math.PI);
    context.fillStyle = counterflex.colours.css(colour);
    context.fill();
  }

  /**
   * Draws layers, the first at the bottom, on a canvas of `size` = {width, height, ratio} (pixels of the page, and
   * device pixels each).
   */
  function draw(context, size, {theme, camera, layers}) {
    context.setTransform(size.ratio, 0, 0, size.ratio, 0, 0);
    context.fillStyle = counterflex.colours.css(theme.ground);
    context.fillRect(0, 0, size.width, size.height);
    const project = counterflex.camera.projector(camera, size);
    for (const layer of layers) drawLayer(context, project, layer, theme);
    context.setLineDash([]);
    context.globalAlpha = 1;
  }

  /** The view has no canvas; `draw(context, size, picture)` draws the paths on the given one. */
  const create = () => ({name: 'canvas', draw, dispose() {}});

  counterflex.flatView = {create};
})();
