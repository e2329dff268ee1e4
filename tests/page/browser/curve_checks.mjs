import assert from 'node:assert/strict';
import test from 'node:test';
import {data_in, report_of} from './browser.mjs';

/** The largest value of a quantity of a page's curves; none: -1. */
function largest(curves, name) {
  const bytes = Buffer.from(curves.quantities[name].largest, 'base64');
  let most = -1;
  for (let i = 0; i < bytes.length; i += 4) {
    const value = bytes.readFloatLE(i);
    if (value > most) most = value;  // skips unknown values
  }
  return most;
}

const parts = {max_mm: '_mm', max_along_mm: '_along_mm', max_across_mm: '_across_mm', max_tool_axis_mm: '_tool_axis_mm'};

// Curves are single-precision numbers, reports are rounded to 1e-7 mm.
for (const name of ['groove', 'pocket', 'constant', 'face', 'hostile', 'large'])
  test(`the curves of "${name}" reach exactly the largest values of the report`, () => {
    const {curves} = data_in(name).runs[0], {summary} = report_of(name);
    const same = (quantity, expected) => {
      const found = largest(curves, quantity);
      assert.ok(Math.abs(found - expected) <= 1e-7 + 1e-6 * expected, `${quantity}: ${found}, the report has ${expected}`);
    };
    for (const which of ['before', 'after'])
      for (const [key, ending] of Object.entries(parts)) same(which + ending, summary[which][key]);
    const {at_worst, ...sources} = summary.sources;
    for (const [source, s] of Object.entries(sources)) if (s) same(`${source}_mm`, s.max_mm);
    same('air_mm', summary.air.max_mm);
  });
