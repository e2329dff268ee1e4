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

  const linksInSight = 5;

  /** Links to the visible sections: the first ones, and the others behind "More". */
  function contents(node) {
    const sections = [...document.querySelectorAll('main section')].filter((section) => !section.hidden);
    const links = sections.map((section) => el('li', null, el('a', {href: `#${section.id}`}, section.dataset.short)));
    const more = el('details', {class: 'more'}, el('summary', null, 'More'), el('ul', null, links.slice(linksInSight)));
    more.addEventListener('click', (event) => event.target.closest('a') && more.removeAttribute('open'));
    document.addEventListener('click', (event) => !more.contains(event.target) && more.removeAttribute('open'));
    fill(node, el('ul', null, links.slice(0, linksInSight), links.length > linksInSight ? el('li', null, more) : null));
  }

  function render(node, units) {
    const print = el('button', {type: 'button', id: 'print', click: () => window.print()}, 'Print');
    fill(node, unitChoice(units), themeButton(), print);
  }

  counterflex.toolbar = {render, contents};
})();
