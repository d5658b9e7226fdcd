// Shared by the browser tests: the site on its own server, a browser, and visits that fail if a page logs an
// error or contacts another server.
//
//   const { visit, server } = await stage();         a server per file; one browser per backend for all files
//   test('..', () => visit('?scene=soup.glb', async (page) => { .. }));
//
// A file runs alone by `node --test FILE`, or with all others in one process by every.mjs.

import assert from 'node:assert/strict';
import { mkdirSync, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after as afterAll, test as rootTest } from 'node:test';
import { serve } from '../../web/serve.mjs';
import { built, launchForTests, programs, source } from './browser.mjs';

export { built, programs, source };
/** The folder for images of failing tests. */
export const evidence = process.env.TUREEN_EVIDENCE ?? join(source, 'build/release/golden-variants');

/** A slow browser, on two cores that also draw, needs time; a hanging test must end. */
export const patience = 60_000;

/** A visit that takes longer hangs: its browser is ended, and the next visit starts another one. */
const limit = 10 * patience;

// -- tests and files --------------------------------------------------------------------------------

/** The file that every.mjs runs: node:test's context of the file, its tests and what follows them. Null for a
 *  file that runs alone. */
let running = null;

/** node:test's test(), as a part of the file that runs. */
export function test(...given) {
  if (!running) return rootTest(...given);
  const ended = running.context.test(...given);
  running.tests.push(ended);
  return ended;
}

/** A test that runs only with TUREEN_THOROUGH=1, as in `./dev test --all`: it repeats a check elsewhere or at
 *  another size, or is slow. */
export const thorough = (name, body) =>
  test(name, { skip: process.env.TUREEN_THOROUGH === '1' ? false : 'only in ./dev test --all' }, body);

/** Parts of a test, [[name, body], ..], which `given` is passed to: each is reported as a test. For tests of one page, so
 *  that it is opened once. */
export async function each(context, parts, ...given) {
  for (const [name, body] of parts) await context.test(name, (part) => body(...given, part));
}

/** Calls `body` after the file's tests. */
function after(body) {
  if (running) running.endings.push(body);
  else afterAll(body);
}

/** Runs a file of tests within a test of node:test. `load` imports the file. */
export async function runFile(context, load) {
  const file = running = { context, tests: [], endings: [] };
  try {
    await load();
  } finally {
    await Promise.all(file.tests);
    running = null;
    for (const body of file.endings) await body();
  }
}

// -- browsers ---------------------------------------------------------------------------------------

/** Browsers, or their starts, by backend. */
const browsers = new Map();

/** Starts a browser, also instead of one that has ended. */
async function browserOf(backend) {
  const known = await browsers.get(backend)?.catch(() => null);
  if (known?.isConnected()) return known;
  const starting = launchForTests(backend);
  browsers.set(backend, starting);
  return starting;
}

/** Ends all browsers. */
export async function endBrowsers() {
  const started = [...browsers.values()];
  browsers.clear();
  for (const browser of started) await (await browser.catch(() => null))?.close();
}

// -- visits -----------------------------------------------------------------------------------------

/** Polling of pages: not by frames, because hidden pages have none. */
export const often = { polling: 100 };

/** Counts the frames that a page requests and gets: a page that shows everything requests none. Runs in
 *  the page before its scripts. */
function countFrames() {
  const ask = window.requestAnimationFrame.bind(window), cancel = window.cancelAnimationFrame.bind(window);
  const asked = new Set();
  window.framesHad = 0;
  window.requestAnimationFrame = (callback) => {
    const id = ask((now) => {
      asked.delete(id);
      ++window.framesHad;
      callback(now);
    });
    asked.add(id);
    return id;
  };
  window.cancelAnimationFrame = (id) => {
    asked.delete(id);
    cancel(id);
  };
  // At least two frames: a canvas gets its new size after the first.
  window.still = async () => {
    for (let frames = 0; frames < 2 || asked.size > 0; ++frames) await new Promise((resolve) => ask(resolve));
  };
}

/** Keeps one sample per pixel, as the goldens have. Runs in the page before its scripts. */
function keepFrames() {
  try {
    localStorage.setItem('tureen.smooth', 'false');
  } catch { /* a page without storage */ }
}

/** Waits until the page, or a page in a frame of it, shows everything and requests no frame. */
export const still = (page) => page.evaluate(() => window.still());

/** A folder that is removed after the file's tests. */
export function scratch() {
  const folder = mkdtempSync(join(tmpdir(), 'tureen-web-'));
  after(() => rmSync(folder, { recursive: true, force: true }));
  return folder;
}

/** A folder for the output of a failing test. */
export function evidenceOf(name) {
  const folder = join(evidence, name.replace(/[^\w.-]+/g, '_'));
  rmSync(folder, { recursive: true, force: true });
  return {
    file(base) {
      mkdirSync(folder, { recursive: true });
      return join(folder, base);
    },
  };
}

/**
 * `routes`: answers by path, as {'/slow.glb': (request, response) => ..}, instead of the site's files.
 * `folder`: served instead of the site.
 */
export async function stage({ backend = 'llvmpipe', routes = {}, folder = join(built, 'site') } = {}) {
  const server = await serve(folder, {
    first(request, response) {
      const route = routes[new URL(request.url, 'http://site').pathname];
      if (route) route(request, response);
      return route !== undefined;
    },
  });
  after(() => server.close());
  if (!running) after(endBrowsers);

  async function visitIn(browser, fail, address, body, { expected = [], friends = [], smooth = false, inWorkers = '', clock = false, ...context }) {
    const reducedMotion = smooth ? 'no-preference' : 'reduce';
    const profile = await browser.newContext({ viewport: { width: 800, height: 500 }, reducedMotion, ...context });
    profile.setDefaultTimeout(patience);
    if (clock) await profile.clock.install();
    await profile.addInitScript(countFrames);
    if (!smooth) await profile.addInitScript(keepFrames);
    if (inWorkers)
      await profile.route('**/loader_worker.js', async (route) => {
        const response = await route.fetch();
        await route.fulfill({ response, body: inWorkers + await response.text() });
      });
    profile.on('page', (page) => page.on('crash', () => fail(new Error('the page crashed'))));
    const complaints = [], strangers = [];
    const own = (url) => [server.address, ...friends].some((origin) => url.startsWith(origin)) ||
      /^(blob|data|file|about):/.test(url);
    profile.on('console', (message) => {
      const text = `${message.text()} (${message.location().url})`;
      if (message.type() === 'error' && !expected.some((pattern) => pattern.test(text))) complaints.push(text);
    });
    profile.on('weberror', (error) => complaints.push(error.error().stack));
    profile.on('request', (request) => { if (!own(request.url())) strangers.push(request.url()); });
    try {
      const page = await profile.newPage();
      await page.goto(new URL(address, server.address).href);
      const result = await body(page, profile);
      assert.deepEqual(complaints, [], 'errors of the page');
      assert.deepEqual(strangers, [], 'requests to other servers');
      return result;
    } finally {
      if (browser.isConnected()) await profile.close();
    }
  }

  /**
   * Opens an address in a new profile, passes the page to `body` and returns its result. Fails if the page logs an error
   * that matches none of `expected`, throws, or contacts a server that is not in `friends`. The page has less motion, since
   * a view that changes gradually takes many frames; { reducedMotion: 'no-preference' } is the default of browsers.
   * `smooth`: the page has motion, and smooths its image at rest, as it does by default. `inWorkers`: a script that loaders
   * run first. `clock`: the page's timers follow page.clock. If the browser ends, or the page
   * crashes or hangs, the next visit starts another browser.
   */
  async function visit(address, body, options = {}) {
    const browser = await browserOf(backend);
    let fail, failed = false;
    const failing = new Promise((_, reject) => {
      fail = (error) => {
        failed = true;
        reject(error);
      };
    });
    const timer = setTimeout(() => fail(new Error(`the visit did not end within ${limit / 1000} seconds`)), limit);
    try {
      return await Promise.race([visitIn(browser, fail, address, body, options), failing]);
    } catch (error) {
      if (failed) await browser.close();  // the visit may still wait
      else if (!browser.isConnected()) throw new Error('the browser ended during the visit', { cause: error });
      throw error;
    } finally {
      clearTimeout(timer);
    }
  }
  return { server, visit };
}

/** Simulates a device without memory for larger texel stores: runs in the page. */
export function shortOfMemory(maxBytes) {
  const gl = WebGL2RenderingContext.prototype, { texImage3D, getError } = gl;
  let missing = false;
  gl.texImage3D = function (...given) {
    const [, , , width, height, depth] = given;
    if (4 * width * height * depth > maxBytes) missing = true;
    else texImage3D.apply(this, given);
  };
  gl.getError = function () {
    const error = missing ? this.OUT_OF_MEMORY : getError.call(this);
    missing = false;
    return error;
  };
}

// -- the visible page -------------------------------------------------------------------------------

/** Waits until a complete scene is shown. Fails at once if the page shows an error. */
export async function sceneShown(page, name) {
  await page.waitForFunction((wanted) => {
    const title = document.getElementById('scene-title')?.textContent;
    const whole = document.getElementById('loading')?.hidden && !document.body.classList.contains('empty');
    return (title && whole && (!wanted || title === wanted)) || document.querySelector('[role=alert] p');
  }, name, often);
  assert.deepEqual(await errors(page), []);
}

/** Picks files, or a folder, with the card's buttons, once the page has them. */
export async function pick(page, files, button = '#choose-files') {
  const card = page.locator('#start');
  if (await card.isHidden()) await page.click('#open-start');
  await card.waitFor();
  const chooser = page.waitForEvent('filechooser');
  await page.click(button);
  await (await chooser).setFiles(files);
}

/** The texts of the page's errors. */
export const errors = (page) => page.locator('#errors .message p').allTextContents();
/** Waits for an error and returns its text. */
export async function errorShown(page) {
  await page.locator('#errors .message p').first().waitFor();
  return (await errors(page))[0];
}
/** Waits for an error and returns its kind, a ViewerError's. */
export async function errorKind(page) {
  const message = page.locator('#errors .message').first();
  await message.waitFor();
  return message.getAttribute('data-kind');
}
export const noticeShown = (page, part = '') => page.locator('#notices .message', { hasText: part }).first().waitFor();

/** The camera in the page's address, once it is at rest. */
export async function view(page) {
  const readOut = () => {
    const parts = new URLSearchParams(location.hash.slice(1));
    const vector = (name) => parts.get(name)?.split(',').map(Number);
    return { eye: vector('eye'), target: vector('target'), up: vector('up'), fov: Number(parts.get('fov')), hash: location.hash };
  };
  await page.waitForFunction(() => location.hash.includes('eye='), null, often);
  await still(page);
  return page.evaluate(readOut);
}

/** Waits until the address has another view than `before`, and returns that. */
export async function viewChanged(page, before) {
  await page.waitForFunction((hash) => location.hash !== hash, before.hash, often);
  return view(page);
}

/** The canvas as shown on the screen, without the elements over it. A PNG. */
export async function image(page) {
  const show = (visibility) => page.evaluate((how) => {
    for (const over of document.querySelectorAll('.corner, .loading, .messages')) over.style.visibility = how;
  }, visibility);
  await show('hidden');
  const png = await page.locator('#canvas').screenshot();
  await show('');
  return png;
}

export const minus = (a, b) => a.map((value, axis) => value - b[axis]);
export const length = (a) => Math.hypot(...a);
export const distance = (a, b) => length(minus(a, b));

/** The canvas's middle, in the page's pixels. */
export async function middle(page) {
  const box = await page.locator('#canvas').boundingBox();
  return { x: box.x + box.width / 2, y: box.y + box.height / 2, box };
}

/** A drop with the system's events. */
export async function drop(page, paths) {
  await page.locator('#actions:not([inert])').waitFor();  // earlier drops are ignored
  const { x, y } = await middle(page);
  const client = await page.context().newCDPSession(page);
  const data = { items: [], files: paths, dragOperationsMask: 1 };
  for (const type of ['dragEnter', 'dragOver']) await client.send('Input.dispatchDragEvent', { type, x, y, data });
  await page.locator('#drop-here').waitFor();  // the page accepts the drop, soon after the system's event
  await client.send('Input.dispatchDragEvent', { type: 'drop', x, y, data });
  await page.locator('#drop-here').waitFor({ state: 'hidden' });
}
