// The image at rest: 64 frames that together have the samples of `tureen render --supersample 8`.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { drawingPage, drawingRoutes } from './drawing.mjs';
import { assertAlike, assertSame } from './images.mjs';
import { readPng } from './png.mjs';
import { each, often, programs, sceneShown, scratch, source, stage, still, test } from './support.mjs';

const folder = scratch();
const { visit } = await stage({ routes: drawingRoutes });
const soup = join(source, 'examples/soup.glb');

/** The image of `tureen render` at the example's second camera. */
function rendered(width, height, ...options) {
  const file = join(folder, 'rendered.png');
  execFileSync(join(programs, 'tureen'), ['render', soup, '--camera', `${soup}:1`, '--size', `${width}x${height}`, ...options, '--force', '-o', file],
               { stdio: 'ignore' });
  return readPng(readFileSync(file));
}

/** Opens the drawing page with the example at its second camera, at rest; counts its frames in window.drawn. */
const atRest = (body, options) => (context) => visit('drawing.html?smooth', async (page) => {
  const drawing = await drawingPage(page);
  await page.evaluate(async () => {
    await viewer.load({ url: 'soup.glb' });
    window.drawn = 0;
    viewer.on('frame', () => { ++window.drawn; });
    viewer.showCamera(1);
  });
  await still(page);
  await body(page, drawing, context);
}, options);

/** The canvas's pixels in a task that draws it. */
async function canvasOf(page) {
  const base64 = await page.evaluate(async () => {
    viewer.draw();
    const { width, height } = viewer.canvas, copy = new OffscreenCanvas(width, height);
    copy.getContext('2d').drawImage(viewer.canvas, 0, 0);
    const bytes = new Uint8Array(await (await copy.convertToBlob({ type: 'image/png' })).arrayBuffer());
    return btoa(bytes.reduce((text, byte) => text + String.fromCharCode(byte), ''));
  });
  return readPng(Buffer.from(base64, 'base64'));
}

const onOnePage = [];

onOnePage.push(['the canvas and screenshots have the samples of --supersample 8', async (page, drawing) => {
  assertAlike('canvas-at-rest', rendered(64, 48, '--supersample', '8'), await canvasOf(page), 60);
  for (const [width, height] of [[64, 48], [200, 150]])
    assertAlike('screenshot-at-rest', rendered(width, height, '--supersample', '8'), await drawing.image({ from: 1, width, height }), 60);
}]);

test('it ends, and every change begins it anew', atRest(async (page) => {
  const drawn = () => page.evaluate(() => window.drawn);
  const first = await drawn();
  assert.ok(first >= 65, `${first} frames`);
  await page.clock.fastForward('01:00');
  assert.equal(await drawn(), first, 'a minute later no frame was drawn');
  for (const change of ['viewer.background = [0, 0, 1]', 'viewer.setLayer(0, { transform: { position: [0.1, 0, 0], rotation: [0, 0, 0], scale: 1, mirror: false } })',
                        'viewer.orbit(20, 0)', 'viewer.canvas.style.width = "80px"']) {
    const before = await drawn();
    await page.evaluate(change);
    await page.waitForFunction((at) => window.drawn > at, before, often);  // the clock does not wait for a new size
    await still(page);
    const frames = await drawn() - before;
    assert.ok(frames >= 65 && frames < 80, `${frames} frames after ${change}`);
  }
}, { clock: true }));

onOnePage.push(['debug views and moving images have one sample a pixel', async (page) => {
  const before = await page.evaluate(async () => {
    await viewer.show('depth');
    return window.drawn;
  });
  await still(page);
  assert.ok(await page.evaluate(() => window.drawn) - before <= 3);
  await page.evaluate(() => viewer.show('color'));
  await page.evaluate(() => viewer.fly([0, 0, 1e-6], 1));
  await page.waitForFunction((at) => window.drawn > at + 3, before, often);
  const moving = await canvasOf(page);
  await page.evaluate(() => viewer.fly([0, 0, 0], 1));
  assertAlike('canvas-moving', rendered(64, 48), moving, 45);
}]);

onOnePage.push(['without it, one frame is drawn', async (page, drawing) => {
  await page.evaluate(() => {
    viewer.smoothAtRest = false;
    viewer.showCamera(1);
  });
  await still(page);
  const before = await page.evaluate(() => window.drawn);
  assertSame('canvas-once', rendered(64, 48), await canvasOf(page));
  assertSame('screenshot-once', rendered(64, 48), await drawing.image({ from: 1, width: 64, height: 48 }));
  await still(page);
  const frames = await page.evaluate(() => window.drawn) - before;
  assert.ok(frames <= 6, `${frames} frames`);
}]);

test('on one page', atRest((page, drawing, context) => each(context, onOnePage, page, drawing)));

test('the page has a switch, which it stores', () => visit('?scene=soup.glb', async (page) => {
  await sceneShown(page, 'soup');
  const frames = async () => {
    const before = await page.evaluate(() => window.framesHad);
    await page.evaluate(() => document.getElementById('canvas').focus());
    await page.keyboard.press('7');
    await still(page);
    return await page.evaluate(() => window.framesHad) - before;
  };
  assert.ok(await page.isChecked('#smooth'));
  assert.ok(await frames() >= 65);
  await page.evaluate(() => document.getElementById('smooth').click());
  await still(page);
  await page.keyboard.press('1');
  await still(page);
  assert.equal(await page.evaluate(() => localStorage.getItem('tureen.smooth')), 'false');
}, { smooth: true }));
