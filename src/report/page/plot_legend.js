'use strict';
(() => {
  const {el, svg, fill} = counterflex.dom;
  const {colour} = counterflex.theme;

  /** A number on an axis, without the noise of binary fractions. */
  const tick = (value) => String(Number(value.toPrecision(6)));

  /** A piece of the line as it is drawn. */
  function swatch(series) {
    return svg('svg', {class: 'swatch', width: 28, height: 8, 'aria-hidden': 'true'}, svg('line', {
      x1: 0, y1: 4, x2: 28, y2: 4, stroke: colour(series.colour), 'stroke-width': series.width || 2,
      'stroke-dasharray': series.dash ? series.dash.join(' ') : null,
    }));
  }

  /** Says what the curves are at a row. */
  function readout(plot, k) {
    const {content, context} = plot;
    const row = content.rows[k], {run, stretch} = content.places[k];
    const line = content.lineAt(run, stretch);
    const known = content.series.map((s, i) => [s, row[i + 1]]).filter(([s, v]) => v !== null && !Number.isNaN(v) && !plot.hidden.has(s.label));
    const values = known.map(([s, v]) => `${s.label} ${content.text(v)}`);
    fill(plot.legend.readout, `${tick(Number(row[0].toFixed(3)))} ${context.units.lengthLabel}, line ${line}: ${values.join(', ')}`);
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
    return el('button', {type: 'button', class: 'entry', 'aria-pressed': String(shown), click: () => toggle(plot, series)}, swatch(series), series.label);
  }

  /** What the lines are, for the eye; on paper it stays without being a button. */
  function fillLegend(plot) {
    const {content, legend} = plot;
    fill(legend.title, content.title);
    fill(legend.entries, content.series.map((series) => legendEntry(plot, series)));
    fill(legend.paper, content.series.filter((s) => !plot.hidden.has(s.label)).map((s) => el('span', {class: 'entry'}, swatch(s), s.label)));
    plot.host.setAttribute('aria-label', `${content.title}. Arrow keys move along the path, plus and minus zoom, Home shows all.`);
  }

  counterflex.plotLegend = {fillLegend, readout, clearReadout, tick};
})();
