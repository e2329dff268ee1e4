'use strict';
(() => {
  const {el} = counterflex.dom;
  const {colour} = counterflex.theme;
  const {fillLegend, readout, clearReadout, tick} = counterflex.plotLegend;
  // The legend of dygraphs writes style attributes, which the page's security policy forbids.
  Dygraph.PLUGINS = Dygraph.PLUGINS.filter((plugin) => plugin !== Dygraph.Plugins.Legend);

  const paperWidth = 680, paperHeight = 128;  // px: fits between the margins of A4 and of letter

  function lowerBound(rows, x) {
    let low = 0, high = rows.length - 1;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (rows[middle][0] < x) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  /** Row nearest to `x` with a known value, or -1. */
  function nearestRow(rows, x) {
    const known = (k) => rows[k] && rows[k].some((v, c) => c > 0 && v !== null && !Number.isNaN(v));
    const start = lowerBound(rows, x);
    for (let d = 0; d < rows.length; ++d) {
      const near = [start + d, start - d].filter(known);
      if (near.length > 0) return near.sort((a, b) => Math.abs(rows[a][0] - x) - Math.abs(rows[b][0] - x))[0];
      if (d > 64) return -1;
    }
    return -1;
  }

  /** Largest absolute value of all rows. */
  function largestOf(rows) {
    let largest = 0;
    for (const row of rows)
      for (let c = 1; c < row.length; ++c) if (Math.abs(row[c]) > largest) largest = Math.abs(row[c]);
    return largest;
  }

  /** Absolute values for a logarithmic scale of four decades; smaller ones are at its bottom. */
  function magnitudes(rows) {
    const least = largestOf(rows) * 1e-4;
    const size = (v) => (v === null || Number.isNaN(v) ? v : Math.max(Math.abs(v), least) || null);
    return rows.map((row) => row.map((v, c) => (c === 0 ? v : size(v))));
  }

  /** The range of the plot includes levels that are not far from the curves, and those that are `held`. */
  function heldLevels({rows, levels}) {
    if (!levels || levels.length === 0) return [];
    const largest = largestOf(rows);
    return levels.filter(({value, held}) => held || Math.abs(value) < 5 * largest).map(({value}) => value);
  }

  /** Rows with one more column for each of these levels: an invisible series. */
  const withLevels = (rows, held) => (held.length === 0 ? rows : rows.map((row) => row.concat(held)));

  /** Options of each series by its name; those of levels make them invisible. */
  function seriesOptions(series, held) {
    const drawn = series.map((s) => [s.label, {strokePattern: s.dash || null, strokeWidth: s.width || 2}]);
    const hidden = held.map((_, i) => [`level ${i}`, {plotter: () => {}, highlightCircleSize: 0}]);
    return Object.fromEntries([...drawn, ...hidden]);
  }

  /** The visible range in the unit of the axis; null: all, as always on paper. */
  function windowOf({group, context, printing}) {
    return printing || !group.window ? null : group.window.map((s) => s * context.units.lengthScale);
  }

  /** The low plots of paper have closer labels, and only the unit of an axis with a long name: the title has the name. */
  function valueAxis({content: {axis}, printing}) {
    const isLong = printing && axis.length > 16;
    return {ylabel: isLong ? axis.split(', ').pop() : axis, pixelsPerLabel: printing ? 15 : 26};
  }

  /** Options that depend on data, unit, theme and window. */
  function options(plot) {
    const {series, rows, log} = plot.content;
    const held = heldLevels(plot.content);
    const axis = {axisLineColor: colour('--muted'), gridLineColor: colour('--line'), axisLabelFontSize: 12,
      axisLabelFormatter: tick};
    const {ylabel, pixelsPerLabel} = valueAxis(plot);
    return {
      file: withLevels(log ? magnitudes(rows) : rows, held),
      labels: ['s', ...series.map((s) => s.label), ...held.map((_, i) => `level ${i}`)],
      colors: [...series.map((s) => colour(s.colour)), ...held.map(() => colour('--limit'))],
      series: seriesOptions(series, held),
      visibility: [...series.map((s) => !plot.hidden.has(s.label)), ...held.map(() => true)],
      dateWindow: windowOf(plot),
      logscale: Boolean(log),
      includeZero: !log,
      xlabel: `Path length, ${plot.context.units.lengthLabel}`,
      ylabel,
      axes: {x: {...axis, drawGrid: false, ticker: Dygraph.numericTicks},
        y: {...axis, axisLabelWidth: 64, pixelsPerLabel}},
    };
  }

  function underlay(plot, canvas, area, g) {
    const {content, group, context} = plot;
    const toX = (s) => g.toDomXCoord(s * context.units.lengthScale);
    counterflex.marks.draw(canvas, area, group.marks[context.selection.run], toX, group.shown);
    for (const {value, label} of content.levels || [])
      counterflex.marks.drawLevel(canvas, area, g.toDomYCoord(value), label);
    counterflex.marks.drawSelected(canvas, area, toX(group.selected()));
  }

  function callbacks(plot) {
    const {group, context} = plot;
    return {
      highlightCallback(event, x) {
        const k = nearestRow(plot.content.rows, x);
        if (k >= 0) readout(plot, k);
        group.hover(x / context.units.lengthScale, plot);
      },
      unhighlightCallback() {
        clearReadout(plot);
        group.hover(null, plot);
      },
      clickCallback(event, x) {
        const k = nearestRow(plot.content.rows, x);
        if (k >= 0) plot.content.select(plot.content.places[k]);
      },
      drawCallback(g, initial) {
        if (initial || plot.busy) return;
        const window = g.isZoomed('x') ? g.xAxisRange().map((x) => x / context.units.lengthScale) : null;
        if (String(window) !== String(group.window)) group.setWindow(window);
      },
      underlayCallback: (canvas, area, g) => underlay(plot, canvas, area, g),
    };
  }

  const model = Dygraph.defaultInteractionModel;
  const ofTwo = (action) => (event, g, context) => event.touches.length > 1 && action(event, g, context);

  /** Two fingers zoom and move; one scrolls the page, and its tap is a click. */
  const interactionModel = {...model, touchstart: ofTwo(model.touchstart), touchmove: ofTwo(model.touchmove),
    touchend: () => {}};

  const fixed = {interactionModel, connectSeparatedPoints: true, pointSize: 2, drawGapEdgePoints: true, highlightCircleSize: 4,
    xRangePad: 4, yRangePad: 12, rightGap: 12, xLabelHeight: 16, yLabelWidth: 18, axisLineWidth: 1, gridLineWidth: 1};

  /** Changes the graph without zooming the other plots. */
  function quietly(plot, change) {
    plot.busy = true;
    try {
      change();
    } finally {
      plot.busy = false;
    }
  }

  function build(plot) {
    plot.content = plot.describe();
    const {file, ...changing} = options(plot);
    quietly(plot, () => {
      plot.graph = new Dygraph(plot.host, file, {...fixed, ...changing, ...callbacks(plot)});
    });
    fillLegend(plot);
  }

  const keys = {
    ArrowLeft: (group) => group.zoom(1, -0.25),
    ArrowRight: (group) => group.zoom(1, 0.25),
    '+': (group) => group.zoom(0.5, 0),
    '=': (group) => group.zoom(0.5, 0),
    '-': (group) => group.zoom(2, 0),
    Home: (group) => group.setWindow(null),
  };

  function key(plot, event) {
    const action = keys[event.key];
    if (!action || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    action(plot.group);
  }

  /** A copy of the drawing: browsers may not print the content of a canvas on the screen. */
  function copyForPaper(plot) {
    const drawn = plot.host.querySelector('canvas');
    const copy = el('canvas', {class: 'paper-copy', width: drawn.width, height: drawn.height});
    copy.style.width = drawn.style.width;
    copy.style.height = drawn.style.height;
    copy.getContext('2d').drawImage(drawn, 0, 0);
    drawn.after(copy);
  }

  /** Draws for paper, sharp and as wide as the page, or for the screen again. */
  function setPrinting(plot, on) {
    plot.printing = on;
    plot.ensure();
    plot.host.querySelectorAll('.paper-copy').forEach((copy) => copy.remove());
    plot.host.style.width = on ? `${paperWidth}px` : '';
    plot.host.style.height = on ? `${paperHeight}px` : '';
    const {ylabel, pixelsPerLabel} = valueAxis(plot);
    quietly(plot, () => {
      plot.graph.updateOptions({pixelRatio: on ? 3 : null, dateWindow: windowOf(plot), ylabel, axes: {y: {pixelsPerLabel}}}, true);
      plot.graph.resize();
    });
    if (on) copyForPaper(plot);
  }

  function frame(plot, className) {
    const save = counterflex.chartFiles.buttons(plot, className);
    plot.host = el('div', {class: `plot ${className}`, tabindex: 0, role: 'application',
      keydown: (event) => key(plot, event)});
    plot.legend = {title: el('h3'), entries: el('div', {class: 'entries'}), paper: el('div', {class: 'entries paper'}),
      readout: el('p', {class: 'readout'}, '\u00a0')};
    const {title, entries, paper, readout: values} = plot.legend;
    plot.node = el('figure', null, el('figcaption', null, title, entries, paper, save), plot.host, values);
  }

  /**
   * A plot over the path, built at the first call of `ensure`. `describe` returns its current content: {title, axis: name
   * and unit of the values, series: [{label, colour, dash, width, text(value)}], rows, places, levels: [{value, label, held}], log,
   * text(value), placeText(place), lineOf(place), select(place)}.
   */
  function create(context, group, describe, className) {
    const plot = {context, group, describe, hidden: new Set(), graph: null, busy: false, printing: false};
    frame(plot, className || '');
    Object.assign(plot, {
      ensure: () => plot.graph || build(plot),
      refresh() {
        if (!plot.graph) return;
        plot.content = describe();
        quietly(plot, () => plot.graph.updateOptions(options(plot)));
        fillLegend(plot);
      },
      redraw: () => plot.graph && quietly(plot, () => plot.graph.updateOptions({})),
      showWindow: () => plot.graph && quietly(plot, () => plot.graph.updateOptions({dateWindow: windowOf(plot)})),
      showValues(s) {
        if (!plot.graph) return;
        const k = s === null ? -1 : nearestRow(plot.content.rows, s * context.units.lengthScale);
        if (k < 0) return void (plot.graph.clearSelection(), clearReadout(plot));
        plot.graph.setSelection(k);
        readout(plot, k);
      },
      setPrinting: (on) => setPrinting(plot, on),
    });
    group.plots.push(plot);
    return plot;
  }

  counterflex.plot = {create, nearestRow};
})();
