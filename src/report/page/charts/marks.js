'use strict';
(() => {
  const {colour} = counterflex.theme;
  const closest = 34;  // px between labels of lines

  function vertical(canvas, area, x, dash, width) {
    canvas.setLineDash(dash);
    canvas.lineWidth = width;
    canvas.beginPath();
    canvas.moveTo(Math.round(x) + 0.5, area.y);
    canvas.lineTo(Math.round(x) + 0.5, area.y + area.h);
    canvas.stroke();
    canvas.setLineDash([]);
  }

  /** Marks in view: [{x, line}], at most one for each pixel. */
  function inView(marks, toX, area) {
    const result = [];
    let last = -Infinity;
    for (const {s, line} of marks) {
      const x = toX(s);
      if (x < area.x || x > area.x + area.w || x - last < 1) continue;
      result.push({x, line});
      last = x;
    }
    return result;
  }

  /** Text with a halo in the background colour, legible over lines. */
  function write(canvas, text, x, y, align, ink) {
    canvas.font = '11px sans-serif';
    canvas.textAlign = align;
    canvas.setLineDash([]);
    canvas.lineJoin = 'round';
    canvas.lineWidth = 4;
    canvas.strokeStyle = colour('--ground');
    canvas.strokeText(text, x, y);
    canvas.fillStyle = ink;
    canvas.fillText(text, x, y);
  }

  /** Writes the line numbers of marks if there is room. */
  function labels(canvas, area, marks, y) {
    let free = -Infinity;
    for (const {x, line} of marks) {
      if (x < free || x + 24 > area.x + area.w) continue;
      write(canvas, String(line), x + 3, y, 'left', colour('--muted'));
      free = x + closest;
    }
  }

  /** Ends of blocks, from the lines of neighbouring stretches. A stretch of several blocks has no marks. */
  function blockEnds(curves) {
    const marks = [];
    if (curves.waypoints_per_stretch > 1) return marks;
    const {s_mm: s, first_line: line} = curves;
    for (let i = 0; i < s.length; ++i)
      if (i === 0 || line[i] !== line[i - 1]) marks.push({s: i === 0 ? 0 : s[i - 1], line: line[i]});
    return marks;
  }

  /**
   * Marks of a run by path length: starts of blocks, rapids, steps of the force. `thinned`: one of that many rapids and
   * steps is marked; 0: all.
   */
  function of(run) {
    const {curves} = run;
    if (!curves) return {blocks: [], rapids: [], steps: [], thinned: {}};
    const placed = (marks) => marks.s_mm.map((s) => ({s}));
    const thinned = ({count, s_mm: s}) => (s.length > 0 && count > s.length ? Math.round(count / s.length) : 0);
    return {blocks: blockEnds(curves), rapids: placed(curves.rapids), steps: placed(curves.force_steps),
      thinned: {rapids: thinned(curves.rapids), steps: thinned(curves.force_steps)}};
  }

  function drawBlocks(canvas, area, blocks) {
    canvas.strokeStyle = colour('--line');
    for (const {x} of blocks) vertical(canvas, area, x, [], 1);
  }

  /** Whether marks are drawn only at the edge: they are too many, or represent others. */
  const tooMany = (marks, area, thinned) => thinned > 0 || marks.length > area.w / 8;

  function drawRapids(canvas, area, rapids, dense) {
    canvas.strokeStyle = colour('--muted');
    for (const {x} of rapids) vertical(canvas, dense ? {y: area.y + area.h - 6, h: 6} : area, x, [3, 4], 1);
  }

  function triangle(canvas, x, y) {
    canvas.beginPath();
    canvas.moveTo(x - 4, y);
    canvas.lineTo(x + 4, y);
    canvas.lineTo(x, y + 7);
    canvas.fill();
  }

  function drawSteps(canvas, area, steps, dense) {
    canvas.strokeStyle = canvas.fillStyle = colour('--step');
    for (const {x} of steps) {
      vertical(canvas, dense ? {y: area.y, h: 6} : area, x, [1, 3], 1);
      if (!dense) triangle(canvas, x, area.y);
    }
  }

  /** Draws marks under the curves. `toX` takes path length to the canvas, `shown` are the kinds to draw. */
  function draw(canvas, area, marks, toX, shown) {
    canvas.save();
    const all = shown.blocks ? inView(marks.blocks, toX, area) : [];
    const blocks = all.length > area.w / 24 ? [] : all;
    drawBlocks(canvas, area, blocks);
    for (const [kind, drawKind] of [['rapids', drawRapids], ['steps', drawSteps]]) {
      if (!shown[kind]) continue;
      const visible = inView(marks[kind], toX, area);
      drawKind(canvas, area, visible, tooMany(visible, area, marks.thinned[kind]));
    }
    labels(canvas, area, blocks, area.y + 18);
    canvas.restore();
  }

  /** The selected place: a prominent line. */
  function drawSelected(canvas, area, x) {
    if (x < area.x || x > area.x + area.w) return;
    canvas.save();
    canvas.strokeStyle = canvas.fillStyle = colour('--accent');
    vertical(canvas, area, x, [], 2);
    triangle(canvas, x, area.y);
    canvas.restore();
  }

  /** A horizontal limit with its name. */
  function drawLevel(canvas, area, y, text) {
    if (!(y >= area.y && y <= area.y + area.h)) return;
    canvas.save();
    canvas.strokeStyle = colour('--limit');
    canvas.setLineDash([8, 4]);
    canvas.lineWidth = 1.5;
    canvas.beginPath();
    canvas.moveTo(area.x, y);
    canvas.lineTo(area.x + area.w, y);
    canvas.stroke();
    write(canvas, text, area.x + area.w - 4, y < area.y + 14 ? y + 12 : y - 4, 'right', colour('--limit'));
    canvas.restore();
  }

  counterflex.marks = {of, draw, drawSelected, drawLevel};
})();
