'use strict';
(() => {
  const {el, svg, fill} = counterflex.dom;
  const {colour} = counterflex.theme;

  /** A number on an axis, without the noise of binary fractions. */
  const tick = (value) => String(Number(value.toPrecision(6)));

  /** A sample of the drawn line. */
  function swatch(series) {
    return svg('svg', {class: 'swatch', width: 28, height: 8, 'aria-hidden': 'true'}, svg('line', {
      x1: 0, y1: 4, x2: 28, y2: 4, stroke: colour(series.colour), 'stroke-width': series.width || 2,
      'stroke-dasharray': series.dash ? series.dash.join(' ') : null,
    }));
  }

  /** Shows the values of the curves at a row. */
  function readout(plot, k) {
    const {content, context} = plot;
    const row = counterflex.series.largestOfTwo(content.rows[k], content.places[k].twin);
    const isShown = (series, v) => v !== null && !Number.isNaN(v) && !plot.hidden.has(series.label);
    const values = content.series.map((series, i) => [series, row[i + 1]]).filter(([series, v]) => isShown(series, v))
        .map(([series, v]) => `${series.label} ${(series.text || content.text)(v)}`);
    const place = `${tick(Number(row[0].toFixed(3)))} ${context.units.lengthLabel}`;
    const upTo = content.places[k].twin ? 'up to ' : '';
    fill(plot.legend.readout, `${place}, ${content.placeText(content.places[k])}: ${upTo}${values.join(', ')}`);
  }

  function clearReadout(plot) {
    fill(plot.legend.readout, '\u00a0');
  }

  function toggle(plot, series) {
    const shown = plot.hidden.delete(series.label);
    if (!shown) plot.hidden.add(series.label);
    plot.refresh();
  }

  function legendEntry(plot, series) {
    const shown = !plot.hidden.has(series.label);
    const attributes = {type: 'button', class: 'entry', 'aria-pressed': String(shown), click: () => toggle(plot, series)};
    return el('button', attributes, swatch(series), series.label);
  }

  /** The legend. On paper its entries are not buttons. */
  function fillLegend(plot) {
    const {content, legend} = plot;
    fill(legend.title, content.title);
    const focused = [...legend.entries.children].indexOf(document.activeElement);
    fill(legend.entries, content.series.map((series) => legendEntry(plot, series)));
    if (focused >= 0 && legend.entries.children[focused]) legend.entries.children[focused].focus();
    const drawn = content.series.filter((s) => !plot.hidden.has(s.label));
    fill(legend.paper, drawn.map((s) => el('span', {class: 'entry'}, swatch(s), s.label)));
    const keys = 'Arrow keys move along the path, plus and minus zoom, Home shows all.';
    plot.host.setAttribute('aria-label', `${content.title}. ${keys}`);
  }

  counterflex.plotLegend = {fillLegend, readout, clearReadout, tick};
})();
