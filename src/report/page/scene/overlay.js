'use strict';
/**
 * The overlay of the path views, drawn on a 2-D canvas: the colour scale with its numbers, the axes of the machine, the
 * scale of lengths, the exaggeration, and the label of the selected place.
 */
(() => {
  const font = '12px system-ui, sans-serif';
  const edge = 12;

  /** Text with a halo in the background colour, legible over lines. */
  function write(context, theme, text, x, y, align = 'left', colour = theme.ink) {
    context.font = font;
    context.textAlign = align;
    context.textBaseline = 'middle';
    context.lineJoin = 'round';
    context.lineWidth = 3;
    context.strokeStyle = counterflex.colours.css(theme.ground);
    context.strokeText(text, x, y);
    context.fillStyle = counterflex.colours.css(colour);
    context.fillText(text, x, y);
  }

  function line(context, colour, width, ...points) {
    context.beginPath();
    points.forEach(([x, y], i) => (i === 0 ? context.moveTo(x, y) : context.lineTo(x, y)));
    context.lineWidth = width;
    context.strokeStyle = counterflex.colours.css(colour);
    context.stroke();
  }

  /** Round numbers from `least` to `most`, in steps of 1, 2 or 5 times a power of ten; about `count` of them. */
  function ticks(least, most, count) {
    if (!(most > least)) return [least];
    const step = counterflex.pathModel.oneTwoFive((most - least) / count);
    const first = Math.ceil(least / step - 1e-9), last = Math.floor(most / step + 1e-9);
    return Array.from({length: Math.max(0, last - first + 1)}, (_, i) => Number(((first + i) * step).toPrecision(6)));
  }

  /** Background behind numbers, so that lines do not cross them. */
  function plate(context, theme, x, y, width, height) {
    context.globalAlpha = 0.8;
    context.fillStyle = counterflex.colours.css(theme.ground);
    context.fillRect(x, y, width, height);
    context.globalAlpha = 1;
  }

  function gradient(context, theme, x, y, width, height) {
    for (let i = 0; i < width; ++i) {
      context.fillStyle = counterflex.colours.css(counterflex.colours.at(i / (width - 1), theme.dark));
      context.fillRect(x + i, y, 1, height);
    }
  }

  /** The least and the largest value at the ends of the scale, and round numbers between them where there is room. */
  function scaleNumbers(context, theme, {range}, units, x, y, width) {
    const ends = [range.low, range.high].map((mm) => String(units.number(mm)));
    context.font = font;
    const half = (text) => context.measureText(text).width / 2;
    const [from, to] = [2 * half(ends[0]) + 8, width - 2 * half(ends[1]) - 8];
    const [low, high] = [range.low * units.scale, range.high * units.scale];
    for (const tick of ticks(low, high, 4)) {
      const at = (width * (tick - low)) / (high - low);
      if (!(at - half(String(tick)) > from && at + half(String(tick)) < to)) continue;
      line(context, theme.ink, 1, [x + at, y], [x + at, y + 4]);
      write(context, theme, String(tick), x + at, y + 12, 'center');
    }
    for (const at of [0, width]) line(context, theme.ink, 1, [x + at, y], [x + at, y + 4]);
    write(context, theme, ends[0], x, y + 12, 'left');
    write(context, theme, ends[1], x + width, y + 12, 'right');
  }

  /** A triangle at the tolerance, or a note if it is outside the scale. */
  function toleranceMark(context, theme, {range, letter, tolerance_mm: tolerance}, units, x, y, width) {
    if (!(tolerance > 0)) return;
    const text = `${counterflex.words.tolerance(letter ? [letter] : [])} ${units.format(tolerance)}`;
    const note = (words) => write(context, theme, words, x, y + 36, 'left', theme.muted);
    if (tolerance >= range.high) return note(`all within the ${text}`);
    if (tolerance < range.low) return note(`all above the ${text}`);
    const at = x + ((tolerance - range.low) / (range.high - range.low)) * width;
    context.beginPath();
    context.moveTo(at, y - 1);
    context.lineTo(at - 4, y - 7);
    context.lineTo(at + 4, y - 7);
    context.fillStyle = counterflex.colours.css(theme.ink);
    context.fill();
    note(`\u25be ${text}`);
  }

  const barWidth = (size) => Math.round(Math.min(260, 0.6 * size.width));

  /** The scale of colours, upper left: {title, range: {low, high} in mm, letter of the run, tolerance_mm}; without a largest value only the title. */
  function colourBar(context, size, theme, bar, units) {
    if (!(bar.range.high > 0)) return write(context, theme, bar.title, edge, edge + 6);
    const width = barWidth(size);
    const y = edge + 22;
    plate(context, theme, 0, 0, width + 4 * edge, y + 48);
    write(context, theme, bar.title, edge, edge + 6);
    gradient(context, theme, edge, y, width, 10);
    scaleNumbers(context, theme, bar, units, edge, y + 10, width);
    toleranceMark(context, theme, bar, units, edge, y, width);
  }

  /** The axes of the machine, lower left; an axis towards the eye is a ring. */
  function triad(context, size, theme, camera) {
    const {right, up, back} = counterflex.camera.basis(camera);
    const [x, y, length] = [edge + 34, size.height - edge - 34, 30];
    const axes = ['x', 'y', 'z'].map((name, i) => ({name, i})).sort((a, b) => back[a.i] - back[b.i]);
    for (const {name, i} of axes) {
      const tip = [x + length * right[i], y - length * up[i]];
      line(context, theme.ink, 2, [x, y], tip);
      if (Math.hypot(right[i], up[i]) < 0.2) {
        context.beginPath();
        context.arc(x, y, 4, 0, 2 * Math.PI);
        context.stroke();
        write(context, theme, name, x - 12, y + 12, 'center');
      } else {
        write(context, theme, name, tip[0] + 9 * right[i], tip[1] - 9 * up[i], 'center');
      }
    }
  }

  /** A length of the picture's scale, lower right, and notes above it. */
  function lengths(context, size, theme, camera, units, notes) {
    const pixelsPerUnit = counterflex.camera.scale(camera, size) / units.lengthScale;
    const length = counterflex.pathModel.oneTwoFive(Math.min(120, 0.25 * size.width) / pixelsPerUnit);
    const [x, y] = [size.width - edge, size.height - edge - 4];
    const left = x - length * pixelsPerUnit;
    context.font = font;
    const width = Math.max(x - left, ...notes.map((note) => context.measureText(note).width)) + 2 * edge;
    const height = 24 + 18 * notes.length + edge;
    plate(context, theme, size.width - width, size.height - height - edge, width, height + edge);
    line(context, theme.ink, 2, [left, y - 5], [left, y], [x, y], [x, y - 5]);
    write(context, theme, `${length} ${units.lengthLabel}`, (left + x) / 2, y - 12, 'center');
    notes.forEach((note, i) => write(context, theme, note, x, y - 32 - 18 * i, 'right', theme.muted));
  }

  /** A ring around a place in the picture, and its label beside it, inside the picture: {x, y, text}. */
  function label(context, size, theme, mark, radius) {
    for (const [colour, width] of [[theme.ground, 5], [theme.ink, 2]]) {
      context.beginPath();
      context.arc(mark.x, mark.y, radius, 0, 2 * Math.PI);
      context.lineWidth = width;
      context.strokeStyle = counterflex.colours.css(colour);
      context.stroke();
    }
    context.font = font;
    const width = context.measureText(mark.text).width + 12;
    const toLeft = mark.x + radius + 6 + width > size.width;
    const x = Math.min(Math.max(2, toLeft ? mark.x - radius - 6 - width : mark.x + radius + 6), size.width - width - 2);
    const onScale = x < barWidth(size) + 4 * edge && mark.y - 27 < edge + 70;
    const y = Math.min(Math.max(14, onScale ? mark.y + 18 : mark.y - 16), size.height - 14);
    context.fillStyle = counterflex.colours.css(theme.ground);
    context.fillRect(x, y - 11, width, 22);
    context.lineWidth = 1;
    context.strokeRect(x + 0.5, y - 10.5, width - 1, 21);
    write(context, theme, mark.text, x + 6, y);
  }

  /** The whole overlay: `picture` = {theme, camera, units, bar, notes: [text], marks: [{x, y, text, radius}]}. */
  function draw(context, size, picture) {
    const {theme, camera, units} = picture;
    colourBar(context, size, theme, picture.bar, units);
    triad(context, size, theme, camera);
    lengths(context, size, theme, camera, units, picture.notes);
    for (const mark of picture.marks) label(context, size, theme, mark, mark.radius);
  }

  counterflex.overlay = {draw, ticks};
})();
