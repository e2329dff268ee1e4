// The page's scripts without a browser: pure functions are tested in node.
import fs from 'node:fs';
import path from 'node:path';
import {fileURLToPath} from 'node:url';
import vm from 'node:vm';

const folder = path.join(path.dirname(fileURLToPath(import.meta.url)), '../../../src/report/page');

const paths = fs.readFileSync(path.join(folder, 'scripts.txt'), 'utf8').trim().split('\n');

/** The text of a script of the page, by its name without folders. */
function text_of(name) {
  const found = paths.find((file) => path.basename(file) === name);
  if (!found) throw new Error(`${name} is not in scripts.txt`);
  return fs.readFileSync(path.join(folder, found), 'utf8');
}

/** The object `counterflex` after these scripts of the page have run, in this order. */
export function load_scripts(...names) {
  const texts = names.map(text_of);
  const context = vm.createContext({});
  if (!names.includes('page_data.js')) vm.runInContext('var counterflex = {};', context);  // else it makes it
  for (const [i, text] of texts.entries()) vm.runInContext(text, context, {filename: names[i]});
  return vm.runInContext('counterflex', context);
}

/** Values that a script made, as those of the test's own world, so that deepEqual compares contents alone. */
export const plain = (value) => JSON.parse(JSON.stringify(value));
