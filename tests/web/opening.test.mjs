// All ways to open a scene: links, files, folders, the gallery, addresses; and what the page shows while
// loading, and cancellation.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import {
  distance, drop, image, middle, patience, pick, programs, sceneShown, scratch, source, stage, still, test, view,
} from './support.mjs';

const example = join(source, 'examples/soup.glb');
const bytes = readFileSync(example);
const folder = scratch();
const diffsoup = join(folder, 'bowl');
execFileSync(join(programs, 'tureen'), ['convert', example, diffsoup], { stdio: 'ignore' });

/** Connections that a test holds back, by path; `rest` sends the remaining bytes. */
const held = new Map();
/** Sends the beginning of the example, and the remainder only after rest(). */
function stalling(part) {
  return (request, response) => {
    const at = Math.round(part * bytes.length);
    response.writeHead(200, { 'content-type': 'model/gltf-binary', 'content-length': bytes.length });
    response.write(bytes.subarray(0, at));
    const connection = { closed: false, rest: () => response.end(bytes.subarray(at)) };
    response.on('close', () => { connection.closed = !response.writableFinished; });
    held.set(new URL(request.url, 'http://site').pathname, connection);
  };
}

/** An endless response without a length: 4096 bytes every 256 ms. */
function drizzle(request, response) {
  response.writeHead(200, { 'content-type': 'model/gltf-binary' });
  let at = 0;
  const timer = setInterval(() => response.write(bytes.subarray(at, at += 4096)), 256);
  const connection = { closed: false };
  response.on('close', () => {
    clearInterval(timer);
    connection.closed = true;
  });
  held.set('/drizzle.glb', connection);
}

const { visit } = await stage({
  routes: { '/tenth.glb': stalling(0.02), '/half.glb': stalling(0.5), '/slow.glb': stalling(0.3), '/drizzle.glb': drizzle },
});

const waitFor = async (what, meaning) => {
  for (let waited = 0; !what(); waited += 50) {
    assert.ok(waited < patience, meaning);
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
};

test('a link carries scene, camera and debug view',
     () => visit('?scene=soup.glb#eye=3,-4,2&target=0,0,0.5&up=0,0,1&fov=30&look=normals', async (page) => {
  await sceneShown(page, 'soup');
  const { eye, target, fov } = await view(page);
  assert.deepEqual([eye, target, fov], [[3, -4, 2], [0, 0, 0.5], 30]);
  // The debug view reads the scene again, after the colours are shown.
  await page.waitForFunction(() => location.hash.includes('look=normals'));
}));

test('a link\'s invalid camera is reported, and the scene is shown',
     () => visit('?scene=soup.glb#eye=1,2&target=0,0,0', async (page) => {
  await sceneShown(page, 'soup');
  await page.locator('#notices', { hasText: /\beye\b.*\btarget\b/ }).waitFor();
}));

test('the gallery, and Back again', () => visit('', async (page) => {
  await page.click('#gallery-list button');
  await sceneShown(page, 'soup');
  assert.match(page.url(), /\?scene=soup\.glb#eye=/);
  assert.ok(await page.isHidden('#start'));
  await page.goBack();
  await page.waitForFunction(() => document.body.classList.contains('empty'));
  assert.ok(await page.isVisible('#start'), 'the card is back');
  await page.goForward();
  await sceneShown(page, 'soup');
}));

test('an address that is typed', () => visit('', async (page) => {
  await page.fill('#address', 'soup.glb');
  await page.press('#address', 'Enter');
  await sceneShown(page, 'soup');
}));

test('a file that is picked', () => visit('', async (page) => {
  const [chooser] = await Promise.all([page.waitForEvent('filechooser'), page.click('#choose-files')]);
  await chooser.setFiles(example);
  await sceneShown(page, 'soup');
  assert.doesNotMatch(page.url(), /scene=/, 'a file has no address');
}));

test('a folder that is picked', () => visit('', async (page) => {
  await pick(page, diffsoup, '#choose-folder');
  await sceneShown(page, 'bowl');
  assert.match(await page.textContent('#facts'), /7,000 triangles/);
  const number = String.raw`-?[\d.]+(?:e[-+]\d+)?`, three = (between) => Array(3).fill(`(${number})`).join(between);
  const facts = new RegExp(`Extent${three(' × ')}Box${three(', ')} to ${three(', ')}Appearance.*GPU memory[\\d.]+`);
  const [, ...values] = facts.exec(await page.textContent('#facts')) ?? assert.fail(await page.textContent('#facts'));
  // Each has four digits, so a difference has the error of three roundings.
  for (let axis = 0; axis < 3; ++axis) {
    const [extent, low, high] = [0, 3, 6].map((at) => Number(values[at + axis]));
    assert.ok(extent > 0 && Math.abs(high - low - extent) <= 5e-4 * (Math.abs(high) + Math.abs(low) + extent), String(values));
  }
}));

test('a link without an up direction takes the scene\'s', () => visit('?scene=soup.glb#eye=4,-6,3&target=0,0,0', async (page) => {
  await sceneShown(page, 'soup');
  assert.deepEqual((await view(page)).up, [0, 0, 1]);
}));

test('a link to a view of a file applies to the opened file', () => visit('#eye=4,-6,3&target=0,0,0.5&up=0,0,1', async (page) => {
  await pick(page, example);
  await sceneShown(page, 'soup');
  assert.ok(distance((await view(page)).eye, [4, -6, 3]) < 0.01);
}));

test('a file that is dropped', () => visit('', async (page) => {
  await drop(page, [example]);
  await sceneShown(page, 'soup');
}));

test('a folder that is dropped', () => visit('', async (page) => {
  await drop(page, [diffsoup]);
  await sceneShown(page, 'bowl');
}));

test('a cancelled download leaves the old scene', () => visit('?scene=soup.glb', async (page) => {
  await sceneShown(page, 'soup');
  const before = await image(page);
  await page.keyboard.press('o');
  await page.fill('#address', 'drizzle.glb');
  await page.press('#address', 'Enter');
  await page.locator('#loading-what', { hasText: 'kB' }).waitFor();
  assert.equal(await page.getAttribute('#progress', 'aria-valuenow'), null, 'the size is unknown');
  await page.click('#cancel');
  await page.locator('#loading').waitFor({ state: 'hidden' });
  await waitFor(() => held.get('/drizzle.glb').closed, 'the connection is closed');
  await waitFor(() => page.workers().length === 0, 'the loader is gone');
  assert.equal(await page.textContent('#scene-title'), 'soup');
  await still(page);
  assert.ok(before.equals(await image(page)), 'the image is unchanged');
}));

test('the bar shows the progress', () => visit('?scene=slow.glb', async (page) => {
  await page.locator('#loading-what', { hasText: ' of ' }).waitFor();
  const now = Number(await page.getAttribute('#progress', 'aria-valuenow'));
  assert.ok(now > 0 && now < 60, `a part of it: ${now} %`);
  await page.click('#cancel');
  await page.locator('#start').waitFor();
  await waitFor(() => held.get('/slow.glb').closed, 'the connection is closed');
}));

test('the scene is requested while the engine is still on its way', () => visit('', async (page) => {
  const requested = page.waitForRequest(/soup\.glb/);
  await page.route('**/tureen.wasm', async (route) => {
    await requested;
    await route.continue();
  });
  await page.goto(new URL('?scene=soup.glb', page.url()).href);
  await sceneShown(page, 'soup');
}));

test('another scene replaces one that is loading', () => visit('?scene=tenth.glb', async (page) => {
  await waitFor(() => held.has('/tenth.glb'), 'it is requested');
  await pick(page, example);
  await sceneShown(page, 'soup');
  await waitFor(() => held.get('/tenth.glb').closed, 'the first connection is closed');
  assert.equal(page.workers().length, 0);
}));

test('a first image before the end of the download, which can be rotated', () => visit('?scene=half.glb', async (page) => {
  await page.locator('body:not(.empty)').waitFor();
  await page.locator('#loading').waitFor();  // the rest is still loading
  await still(page);
  const first = await image(page);
  assert.ok(await page.isHidden('#start'));
  const { x, y } = await middle(page);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 120, y, { steps: 4 });
  await page.mouse.up();
  await still(page);
  const turned = await image(page);
  assert.ok(!first.equals(turned), 'a drag turns the first image');
  held.get('/half.glb').rest();
  await sceneShown(page, 'soup');
  const after = await view(page);
  assert.ok(!turned.equals(await image(page)), 'the texels have arrived');
  await page.keyboard.press('r');
  await page.waitForFunction((hash) => location.hash !== hash, after.hash);
  assert.ok(distance((await view(page)).eye, after.eye) > 0.1, 'the rotated view had stayed');
}));
