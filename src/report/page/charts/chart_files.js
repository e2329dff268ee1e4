'use strict';
/** Charts as files: PNG for documents, CSV for spreadsheets. */
(() => {
  const {el} = counterflex.dom;

  const stem = (path) => path.split('/').pop().replace(/\.[^.]*$/, '').replace(/[^\w.-]+/g, '_') || 'program';

  /** "pocket_before": the name of a file of a run, without its ending. */
  const nameOf = ({report}, what) => `${stem(counterflex.words.fileName(report, 'program'))}_${what}`;

  function save(blob, name) {
    const link = el('a', {href: URL.createObjectURL(blob), download: name});
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  }

  const saveCanvas = (canvas, name) => canvas.toBlob((blob) => save(blob, `${name}.png`), 'image/png');

  const quoted = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);

  /** The rows of a plot: path length, line, and the value of each curve; an unknown value is empty. */
  function csvOf({rows, places, series, lineOf}, lengthLabel, axis) {
    const head = [`path length ${lengthLabel}`, 'line', ...series.map((s) => `${s.label} (${axis})`)];
    const number = (v) => (v === null || Number.isNaN(v) ? '' : String(Number(v.toPrecision(9))));
    const lines = rows.map((row, k) => [number(row[0]), lineOf(places[k]), ...row.slice(1).map(number)])
        .filter((cells) => cells.slice(2).some((cell) => cell !== ''));
    return [head.map(quoted), ...lines].map((cells) => cells.join(',')).join('\n') + '\n';
  }

  /** Texts of the axes, which are elements beside the canvas. */
  function drawLabels(context, host, ratio) {
    const box = host.getBoundingClientRect();
    context.fillStyle = counterflex.theme.colour('--ink');
    context.textBaseline = 'middle';
    for (const node of host.querySelectorAll('.dygraph-axis-label, .dygraph-xlabel, .dygraph-ylabel')) {
      const {left, top, width, height} = node.getBoundingClientRect();
      context.save();
      context.font = `${12 * ratio}px sans-serif`;
      context.translate((left - box.left + width / 2) * ratio, (top - box.top + height / 2) * ratio);
      if (node.classList.contains('dygraph-ylabel')) context.rotate(-Math.PI / 2);
      context.textAlign = node.classList.contains('dygraph-axis-label-y') ? 'right' : 'center';
      const x = context.textAlign === 'right' ? (width / 2) * ratio : 0;
      context.fillText(node.textContent, x, 0);
      context.restore();
    }
  }

  /** Title and names of the curves, above the plot. */
  function drawHead(context, {title, series}, ratio) {
    context.textBaseline = 'top';
    context.textAlign = 'left';
    context.fillStyle = counterflex.theme.colour('--ink');
    context.font = `bold ${14 * ratio}px sans-serif`;
    context.fillText(title, 8 * ratio, 6 * ratio);
    context.font = `${12 * ratio}px sans-serif`;
    let x = 8 * ratio;
    for (const {label, colour, dash} of series) {
      context.strokeStyle = counterflex.theme.colour(colour);
      context.lineWidth = 2 * ratio;
      context.setLineDash((dash || []).map((v) => v * ratio));
      context.beginPath();
      context.moveTo(x, 34 * ratio);
      context.lineTo(x + 24 * ratio, 34 * ratio);
      context.stroke();
      context.fillText(label, x + 30 * ratio, 28 * ratio);
      x += context.measureText(label).width + 46 * ratio;
    }
  }

  /** A plot with its title, curves' names and axes on the page's ground. */
  function pictureOf(plot) {
    const drawn = plot.host.querySelector('canvas');
    const ratio = drawn.width / drawn.clientWidth, head = 48 * ratio;
    const canvas = el('canvas', {width: drawn.width, height: drawn.height + head});
    const context = canvas.getContext('2d');
    context.fillStyle = counterflex.theme.colour('--ground');
    context.fillRect(0, 0, canvas.width, canvas.height);
    drawHead(context, {...plot.content, series: plot.content.series.filter((s) => !plot.hidden.has(s.label))}, ratio);
    context.setLineDash([]);
    context.translate(0, head);
    context.drawImage(drawn, 0, 0);
    drawLabels(context, plot.host, ratio);
    return canvas;
  }

  /** Buttons that save a plot. */
  function buttons(plot, what) {
    const name = () => nameOf(plot.context.runs[0], what);
    const saveCsv = () => save(new Blob([csvOf(plot.content, plot.context.units.lengthLabel, plot.content.axis)], {type: 'text/csv'}), `${name()}.csv`);
    const button = (text, label, click) => el('button', {type: 'button', 'aria-label': label, title: label, click}, text);
    return el('span', {class: 'save'}, button('PNG', 'Save this chart as a picture', () => saveCanvas(pictureOf(plot), name())),
        button('CSV', 'Save the values of this chart as a table', saveCsv));
  }

  counterflex.chartFiles = {nameOf, saveCanvas, csvOf, buttons};
})();
