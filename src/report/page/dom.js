'use strict';
(() => {
  /** Sets attributes; functions become listeners of the event of that name, true becomes an empty attribute. */
  function setAttributes(node, attributes) {
    for (const [name, value] of Object.entries(attributes)) {
      if (value === undefined || value === null || value === false) continue;
      if (typeof value === 'function') node.addEventListener(name, value);
      else node.setAttribute(name, value === true ? '' : value);
    }
  }

  /** Text nodes only: texts of files are never interpreted as markup. */
  function append(node, children) {
    for (const child of children.flat(Infinity))
      if (child !== null && child !== undefined && child !== false) node.append(child);
    return node;
  }

  /** An element with attributes and children: nodes, strings, lists of them; null is ignored. */
  function el(tag, attributes, ...children) {
    const node = document.createElement(tag);
    setAttributes(node, attributes || {});
    return append(node, children);
  }

  function svg(tag, attributes, ...children) {
    const node = document.createElementNS('http://www.w3.org/2000/svg', tag);
    setAttributes(node, attributes || {});
    return append(node, children);
  }

  /** Replaces the content of `node` by `children`. */
  function fill(node, ...children) {
    node.textContent = '';
    return append(node, children);
  }

  const classOf = (column) => [column.number && 'number', column.class].filter(Boolean).join(' ') || null;

  function cell(column, content, head) {
    const attributes = {class: classOf(column)};
    return head ? el('th', {...attributes, scope: 'row'}, content) : el('td', attributes, content);
  }

  /**
   * A table. `columns`: {title, number: aligned right, class}; `rows`: lists of cells, the first cell names
   * the row; a row may have `mark`, a class.
   */
  function table(caption, columns, rows) {
    const head = columns.map((c) => el('th', {scope: 'col', class: classOf(c)}, c.title));
    const body = rows.map((row) => el('tr', {class: row.mark}, columns.map((c, i) => cell(c, row[i], i === 0))));
    const whole = el('table', null, el('caption', null, caption), el('thead', null, el('tr', null, head)),
        el('tbody', null, body));
    return el('div', {class: 'table'}, whole);
  }

  /** Columns of words and of digits. */
  const textColumn = (title) => ({title, class: 'text'});
  const numberColumn = (title, className) => ({title, number: true, class: className});

  /** A bar filled to a share of its length, 0 to 1. */
  function bar(share, className) {
    return svg('svg', {viewBox: '0 0 100 10', preserveAspectRatio: 'none', 'aria-hidden': 'true', class: `part ${className}`},
        svg('rect', {x: 0, y: 0, width: (100 * Math.min(1, share)).toFixed(2), height: 10}));
  }

  /** Exclusive choices as radio buttons: `choices` are [value, label]; `change` gets the value. */
  function radios(legend, name, choices, chosen, change) {
    const buttons = choices.map(([value, label]) => el('label', null,
        el('input', {type: 'radio', name, value, checked: value === chosen, change: () => change(value)}),
        el('span', null, label)));
    return el('fieldset', {class: 'choice'}, el('legend', null, legend), buttons);
  }

  /** A link to a place of the page; it is plain text on paper. */
  function jump(text, target, go, label) {
    return el('a', {href: `#${target}`, 'aria-label': label, click: (event) => {
      event.preventDefault();
      go();
    }}, text);
  }

  counterflex.dom = {el, svg, fill, table, textColumn, numberColumn, bar, radios, jump};
})();
