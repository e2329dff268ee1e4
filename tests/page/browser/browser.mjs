// One browser for all tests: opens pages of reports and records their errors.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import {fileURLToPath, pathToFileURL} from 'node:url';
import {chromium} from 'playwright-core';

export const folder = path.join(path.dirname(fileURLToPath(import.meta.url)), 'pages');

let browser = null;

async function launched() {
  browser = browser || await chromium.launch({
    executablePath: process.env.COUNTERFLEX_BROWSER,
    // WebGL in software; flat views are then drawn without it.
    args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-accelerated-2d-canvas'],
  });
  return browser;
}

export async function close() {
  if (browser) await browser.close();
}

/** Messages of the browser about its software renderer are not errors of the page. */
const of_the_driver = (text) => /GL Driver Message|GPU stall due to ReadPixels/.test(text);

function watch(page) {
  const complaints = [];
  page.on('console', (message) => {
    if (!['error', 'warning'].includes(message.type()) || of_the_driver(message.text())) return;
    complaints.push(`${message.type()}: ${message.text()}`);
  });
  page.on('pageerror', (error) => complaints.push(`exception: ${error.stack}`));
  page.on('request', (request) => {
    if (request.url() !== page.first_address && !request.url().startsWith('data:')) complaints.push(`request: ${request.url()}`);
  });
  page.on('dialog', (dialog) => complaints.push(`dialog: ${dialog.message()}`) && dialog.dismiss());
  return complaints;
}

function without_webgl() {
  const get_context = HTMLCanvasElement.prototype.getContext;
  HTMLCanvasElement.prototype.getContext = function(kind, ...rest) {
    return /webgl/.test(kind) ? null : get_context.call(this, kind, ...rest);
  };
}

/**
 * Opens a page, calls `check` when it is ready, and fails if the page reported errors.
 * `options`: {width, scheme, webgl, touch}.
 */
export async function visit(name, check, {width = 1400, scheme = 'light', webgl = true, touch = false} = {}) {
  const context = await (await launched()).newContext({viewport: {width, height: 900}, colorScheme: scheme, hasTouch: touch});
  try {
    const page = await context.newPage();
    page.first_address = pathToFileURL(path.join(folder, `${name}.html`)).href;
    page.setDefaultTimeout(15000);
    const complaints = watch(page);
    if (!webgl) await page.addInitScript(without_webgl);
    await page.goto(page.first_address);
    await page.waitForFunction(() => document.documentElement.dataset.ready);
    assert.equal(await page.evaluate(() => document.documentElement.dataset.ready), 'yes', complaints.join('\n'));
    await check(page);
    assert.deepEqual(complaints, []);
  } finally {
    await context.close();
  }
}

/** The report beside a page. */
export const report_of = (name) => JSON.parse(fs.readFileSync(path.join(folder, `${name}.json`), 'utf8'));

const data_of = /(<script type="application\/json" id="counterflex-data">)([\s\S]*?)(<\/script>)/;

/** The data inside a page. */
export function data_in(name) {
  return JSON.parse(data_of.exec(fs.readFileSync(path.join(folder, `${name}.html`), 'utf8'))[2]);
}

/** Writes a page like that of `name` with other data. */
export function write_page(name, data, result) {
  const text = fs.readFileSync(path.join(folder, `${name}.html`), 'utf8');
  const json = JSON.stringify(data).replaceAll('<', '\\u003c');
  fs.writeFileSync(path.join(folder, `${result}.html`), text.replace(data_of, (all, begin, old, end) => begin + json + end));
}

export const bytes_of = (name) => fs.statSync(path.join(folder, `${name}.html`)).size;

/** The number of pixels of canvases with nearly the named colour of the style sheet; for null, the number of colours. */
function colours_of(page, selector, property) {
  return page.evaluate(([where, then]) => {
    const colours = [];
    for (const canvas of document.querySelectorAll(where)) {
      if (canvas.width === 0 || canvas.height === 0) continue;
      const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext('2d', {willReadFrequently: true});
      copy.drawImage(canvas, 0, 0);
      const {data} = copy.getImageData(0, 0, canvas.width, canvas.height);
      for (let i = 0; i < data.length; i += 4) if (data[i + 3] > 128) colours.push((data[i] << 16) + (data[i + 1] << 8) + data[i + 2]);
    }
    if (then === null) return new Set(colours).size;
    const text = getComputedStyle(document.documentElement).getPropertyValue(then).trim();
    const part = (colour, shift) => (colour >> shift) & 255;
    const wanted = parseInt(text.slice(1), 16);
    return colours.filter((c) => [0, 8, 16].every((shift) => Math.abs(part(c, shift) - part(wanted, shift)) < 24)).length;
  }, [selector, property]);
}

/** How many colours there are in canvases. */
export const colours = (page, selector) => colours_of(page, selector, null);

/** How many pixels of canvases have a colour of the style sheet, or nearly. */
export const pixels = colours_of;

export const texts = (page, selector) => page.$$eval(selector, (nodes) => nodes.map((node) => node.textContent));
