'use strict';
(() => {
  const {el, fill, radios} = counterflex.dom;

  function unitChoice(units) {
    const choices = units.names.map((name) => [name, units.nameOf(name)]);
    return radios('Unit', 'unit', choices, units.shown, (unit) => units.set(unit));
  }

  /** A button that switches between auto, light and dark and shows the current choice. */
  function themeButton() {
    const {theme} = counterflex;
    const button = el('button', {type: 'button', id: 'theme', click: () => {
      const next = (theme.names.indexOf(theme.chosen) + 1) % theme.names.length;
      theme.set(theme.names[next]);
      update();
    }});
    const update = () => fill(button, `Colours: ${theme.chosen}`);
    update();
    return button;
  }

  /** Links to the visible sections. */
  function contents(node) {
    const sections = [...document.querySelectorAll('main section')].filter((section) => !section.hidden);
    fill(node, el('ul', null, sections.map((section) => el('li', null,
        el('a', {href: `#${section.id}`}, section.dataset.short)))));
  }

  function render(node, units) {
    const print = el('button', {type: 'button', id: 'print', click: () => window.print()}, 'Print');
    fill(node, unitChoice(units), themeButton(), print);
  }

  counterflex.toolbar = {render, contents};
})();
