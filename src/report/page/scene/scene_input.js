'use strict';
/** Translates mouse, touch and keys of the path view to actions: turn, pan, zoom, pick, hover, step. */
(() => {
  const still = 4;  // pixels: a press with less movement is a click

  const middle = (points) => points.reduce((sum, p) => [sum[0] + p.x / points.length, sum[1] + p.y / points.length],
    [0, 0]);
  const spread = ([a, b]) => (b ? Math.hypot(a.x - b.x, a.y - b.y) : 0);

  /** The position of an event in the element, pixels. */
  function placeIn(element, event) {
    const box = element.getBoundingClientRect();
    return {x: event.clientX - box.left, y: event.clientY - box.top};
  }

  /** The movement of fingers or mouse from `before` to `now`, lists of {x, y}. */
  function drag(act, before, now, panning) {
    const [from, to] = [middle(before), middle(now)];
    const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    if (now.length < 2 && !panning) return act.turn(dx, dy);
    act.pan(dx, dy);
    if (now.length === 2 && spread(before) > 0) act.zoom(spread(now) / spread(before), to);
  }

  function listenToPointers(element, act) {
    const down = new Map();  // pointer id: {x, y, button}
    let travel = 0;
    element.addEventListener('pointerdown', (event) => {
      element.setPointerCapture(event.pointerId);
      if (down.size === 0) travel = 0;
      const pan = event.button > 0 || event.shiftKey || event.ctrlKey || event.metaKey;
      down.set(event.pointerId, {...placeIn(element, event), pan});
    });
    element.addEventListener('pointermove', (event) => {
      const here = placeIn(element, event);
      const pressed = down.get(event.pointerId);
      if (!pressed) return event.pointerType === 'mouse' ? act.hover(here.x, here.y) : undefined;
      const before = [...down.values()];
      travel += Math.hypot(here.x - pressed.x, here.y - pressed.y);
      down.set(event.pointerId, {...pressed, ...here});
      if (travel >= still) drag(act, before, [...down.values()], pressed.pan);
    });
    const up = (event) => {
      const pressed = down.get(event.pointerId);
      down.delete(event.pointerId);
      const click = event.type === 'pointerup' && pressed && down.size === 0 && travel < still && !pressed.pan;
      if (click) act.pick(pressed.x, pressed.y, event.pointerType === 'mouse' ? 16 : 30);
    };
    element.addEventListener('pointerup', up);
    element.addEventListener('pointercancel', up);
    element.addEventListener('pointerleave', () => act.hover(-1, -1));
    element.addEventListener('contextmenu', (event) => event.preventDefault());
  }

  /** The wheel zooms only while the view has the focus, so that the wheel scrolls the page otherwise. */
  function listenToWheel(element, act) {
    element.addEventListener('wheel', (event) => {
      if (document.activeElement !== element && !event.ctrlKey) return;
      event.preventDefault();
      const pixels = event.deltaY * (event.deltaMode === 1 ? 20 : event.deltaMode === 2 ? 400 : 1);
      const {x, y} = placeIn(element, event);
      act.zoom(Math.exp(-0.002 * Math.max(-300, Math.min(300, pixels))), [x, y]);
    }, {passive: false});
  }

  const arrows = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]};

  /** The action of a key, or null; `shift` turns, `control` moves the picture. */
  function actOfKey(act, {key, shiftKey, ctrlKey, metaKey, altKey}) {
    if (altKey || metaKey) return null;
    const arrow = arrows[key];
    if (arrow && ctrlKey) return () => act.pan(40 * arrow[0], 40 * arrow[1]);
    if (ctrlKey) return null;
    if (arrow && shiftKey) return () => act.turn(24 * arrow[0], 24 * arrow[1]);
    if (key === 'ArrowLeft' || key === 'ArrowRight') return () => act.step(arrow[0]);
    const others = {'+': () => act.zoom(1.25, null), '=': () => act.zoom(1.25, null), '-': () => act.zoom(0.8, null),
      'Home': () => act.step(-Infinity), 'End': () => act.step(Infinity), '0': () => act.look('fit')};
    return others[key] || null;
  }

  function listenToKeys(element, act) {
    element.addEventListener('keydown', (event) => {
      const does = actOfKey(act, event);
      if (!does) return;
      event.preventDefault();
      does();
    });
  }

  /**
   * Listens to an element. `act` = {turn(dx, dy), pan(dx, dy), zoom(factor, [x, y] or null for the middle),
   * pick(x, y, reach), hover(x, y), step(count), look(view)}, all in pixels.
   */
  function listen(element, act) {
    listenToPointers(element, act);
    listenToWheel(element, act);
    listenToKeys(element, act);
    element.addEventListener('dblclick', () => act.look('fit'));
  }

  counterflex.sceneInput = {listen, actOfKey};
})();
