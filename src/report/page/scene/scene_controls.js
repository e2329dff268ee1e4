'use strict';
/** The controls of the path view: kind of path, run, exaggeration and direction. */
(() => {
  const {el} = counterflex.dom;

  let groups = 0;  // radio buttons of one group share a name

  /**
   * Radio buttons: `choices` = [{value, text, enabled}]. Returns {element, set(value)}; calls `chosen(value)` on a
   * change.
   */
  function radios(legend, choices, chosen) {
    const name = `scene-choice-${++groups}`;
    const inputs = choices.map(({value, enabled}) =>
      el('input', {type: 'radio', name, value, disabled: !enabled, change: () => chosen(value)}));
    const labels = choices.map(({text}, i) => el('label', null, inputs[i], el('span', null, text)));
    return {element: el('fieldset', {class: 'choice'}, el('legend', null, legend), labels),
      set(value) {
        for (const input of inputs) input.checked = input.value === String(value);
      }};
  }

  const nearestStep = (steps, factor) =>
    steps.reduce((best, step, i) => (Math.abs(Math.log(step / factor)) < Math.abs(Math.log(steps[best] / factor))
      ? i : best), 0);

  /** The slider of the exaggeration, on `steps`; a double click chooses 0, the usual factor. */
  function slider(steps, chosen) {
    const output = el('output', {class: 'scene-factor'});
    const input = el('input', {type: 'range', min: 0, max: steps.length - 1, step: 1, disabled: steps.length < 2,
      title: 'Double click: reset', input: () => chosen(steps[Number(input.value)]),
      dblclick: () => chosen(0)});
    return {element: el('label', {class: 'scene-slider'}, 'Exaggeration ', input, output), set(factor) {
      input.value = nearestStep(steps, factor);
      output.textContent = `\u00d7 ${factor}`;
      input.setAttribute('aria-valuetext', `${factor} times`);
    }};
  }

  const views = [['top', 'Top'], ['front', 'Front'], ['side', 'Side'], ['isometric', 'Isometric'], ['fit', 'Fit']];

  function viewButtons(look) {
    return el('div', {class: 'scene-views', role: 'group', 'aria-label': 'View'}, views.map(([name, text]) =>
      el('button', {type: 'button', value: name, click: () => look(name)}, text)));
  }

  /** Switches between the deviation before and the same without its common shift. */
  function shiftSwitch(show) {
    const input = el('input', {type: 'checkbox', change: () => show(input.checked ? 'shifted' : 'before')});
    const title = 'Touching off the part on this machine removes the shift that all deviations have in common.';
    return {element: el('label', {class: 'choice', title}, input, el('span', null, 'without the common shift')), set(kind) {
      input.checked = kind === 'shifted';
      input.disabled = kind !== 'shifted' && kind !== 'before';
    }};
  }

  /** Shows the lines of the machine. */
  function machineSwitch(show) {
    const input = el('input', {type: 'checkbox', name: 'machine', change: () => show(input.checked)});
    return {element: el('label', {class: 'choice', title: 'The machine at the place that is shown'}, input, el('span', null, 'machine')), set(on) {
      input.checked = on;
    }};
  }

  /** Shows arrows of the cutting force. */
  function forceSwitch(show) {
    const input = el('input', {type: 'checkbox', name: 'forces', change: () => show(input.checked)});
    return {element: el('label', {class: 'choice', title: 'The cutting force on the tool at places along the path'}, input, el('span', null, 'forces')), set(on) {
      input.checked = on;
    }};
  }

  const kindTexts = {wanted: 'wanted', before: 'before', after: 'after (model residual)'};

  /**
   * All controls: `options` = {kinds: [{value, enabled}], runs: [{text, enabled}], steps, machine and forces: whether there are any}, `act` = {show(kind),
   * run(index), exaggerate(factor), machine(on), forces(on), look(view), save()}. Returns {element, update({kind, run, factor}, machine, forces)}.
   */
  function create(options, act) {
    const kinds = radios('Path', options.kinds.map((kind) => ({...kind, text: kindTexts[kind.value]})), act.show);
    const runs = options.runs.length < 2 ? null : radios('Run',
      options.runs.map((run, i) => ({...run, value: String(i)})), (value) => act.run(Number(value)));
    const factor = slider(options.steps, act.exaggerate);
    const shift = shiftSwitch(act.show);
    const machine = options.machine ? machineSwitch(act.machine) : null;
    const forces = options.forces ? forceSwitch(act.forces) : null;
    const save = el('button', {type: 'button', click: act.save}, 'PNG');
    const parts = [kinds.element, shift.element, ...(runs ? [runs.element] : []), factor.element, ...(machine ? [machine.element] : []), ...(forces ? [forces.element] : []), viewButtons(act.look), save];
    return {element: el('div', {class: 'scene-controls'}, parts), update(state, withMachine, withForces) {
      kinds.set(state.kind === 'shifted' ? 'before' : state.kind);
      shift.set(state.kind);
      if (runs) runs.set(state.run);
      if (machine) machine.set(withMachine);
      if (forces) forces.set(withForces);
      factor.set(state.factor);
    }};
  }

  counterflex.sceneControls = {create};
})();
