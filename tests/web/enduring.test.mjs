// Events in the life of an open page: scenes come and go, the device is lost, the network fails, the tab is
// hidden, windows change their size.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { readPng } from './png.mjs';
import { goldenScenes } from './scenes.mjs';
import {
  distance, errorKind, errorShown, image, middle, noticeShown, often, pick, sceneShown, shortOfMemory, stage, still,
  test, thorough, view, viewChanged,
} from './support.mjs';

const other = join(goldenScenes(), 'UvTexturesMlp.glb');
const { visit, server } = await stage({
  routes: { '/UvTexturesMlp.glb': (request, response) => response.writeHead(200).end(readFileSync(other)) },
});

/** Counts living objects of WebGL and WebAssembly: runs in the page before its scripts. */
function keepCount() {
  window.counted = { objects: 0, memories: new Set() };
  const gl = WebGL2RenderingContext.prototype;
  for (const kind of ['Buffer', 'Framebuffer', 'Program', 'Renderbuffer', 'Shader', 'Texture', 'VertexArray']) {
    const [create, remove] = [gl[`create${kind}`], gl[`delete${kind}`]];
    const living = new Set();
    gl[`create${kind}`] = function (...given) {
      const made = create.apply(this, given);
      living.add(made);
      counted.objects++;
      return made;
    };
    gl[`delete${kind}`] = function (what) {
      if (living.delete(what)) counted.objects--;
      return remove.call(this, what);
    };
  }
  const instantiate = WebAssembly.instantiate;
  WebAssembly.instantiate = async (...given) => {
    const instance = await instantiate(...given);
    for (const part of Object.values(instance.exports))
      if (part instanceof WebAssembly.Memory) counted.memories.add(part);
    return instance;
  };
}

/** Measures after a garbage collection. */
async function measure(page, client) {
  await client.send('HeapProfiler.collectGarbage');
  const { usedSize } = await client.send('Runtime.getHeapUsage');
  const { metrics } = await client.send('Performance.getMetrics');
  const metric = (name) => metrics.find((one) => one.name === name).value;
  const { objects, wasm } = await page.evaluate(() => ({
    objects: counted.objects, wasm: [...counted.memories].reduce((sum, memory) => sum + memory.buffer.byteLength, 0),
  }));
  return { heap: usedSize, nodes: metric('Nodes'), listeners: metric('JSEventListeners'), objects, wasm, workers: page.workers().length };
}

/** `pairs`: of scenes, after three that fill all caches. */
const comeAndGo = (pairs) => () => visit('', async (page, profile) => {
  await profile.addInitScript(keepCount);
  await page.reload();
  const client = await profile.newCDPSession(page);
  await client.send('Performance.enable');
  const open = async (name) => {
    await page.evaluate(() => { if (document.getElementById('start').hidden) document.getElementById('open-start').click(); });
    await page.fill('#address', `${name}.glb`);
    await page.press('#address', 'Enter');
    await sceneShown(page, name);
  };
  const both = async (times) => {
    for (let i = 0; i < times; ++i) {
      await open('UvTexturesMlp');
      await open('soup');
    }
    return measure(page, client);
  };
  const before = await both(3), after = await both(pairs);
  console.log('after 6 scenes', before, `after ${6 + 2 * pairs}`, after);
  assert.equal(after.wasm, before.wasm, 'bytes of WebAssembly');
  assert.equal(after.objects, before.objects, 'objects of WebGL');
  assert.equal(after.workers, 0, 'workers');
  // The history of the tab has an entry per scene, and V8 keeps some profiles: tens of kilobytes. One of these
  // scenes is two megabytes.
  assert.ok(after.heap - before.heap < 1_000_000, `JavaScript's heap: ${before.heap} and ${after.heap} bytes`);
  assert.ok(after.nodes - before.nodes < 100, `elements: ${before.nodes} and ${after.nodes}`);
  assert.equal(after.listeners, before.listeners, 'listeners');
});
thorough('fourteen scenes one after the other leave nothing behind', comeAndGo(4));
thorough('nor do fifty', comeAndGo(22));

// With the example's 7000 faces, a store of 8-bit texels takes 1.26 MB at level 3, 0.43 MB at level 2 and 0.1
// MB at level 0.
test('without memory for all of a scene a lower lattice level is drawn and reported', () => visit('', async (page, profile) => {
  await profile.addInitScript(shortOfMemory, 500_000);
  await page.goto(new URL('?scene=soup.glb', server.address).href);
  await sceneShown(page, 'soup');
  await noticeShown(page, /\b2\b/);
  const { pixels } = readPng(await image(page));
  assert.ok(new Set(pixels).size > 100, 'there is an image');
}));

test('without memory for any level the page reports it and continues', () => visit('', async (page, profile) => {
  await profile.addInitScript(shortOfMemory, 50_000);
  await page.goto(new URL('?scene=soup.glb', server.address).href);
  assert.equal(await errorKind(page), 'memory');
  await page.locator('#start').waitFor();
}));

test('the device is lost and comes back, with scene, view and debug view', () => visit('?scene=soup.glb', async (page) => {
  await sceneShown(page, 'soup');
  const first = await view(page);
  await page.keyboard.press('2');
  const before = await viewChanged(page, first), shown = await image(page);
  await page.evaluate(() => {
    window.loss = document.getElementById('canvas').getContext('webgl2').getExtension('WEBGL_lose_context');
    loss.loseContext();
  });
  assert.equal(await errorKind(page), 'device');
  await page.mouse.wheel(0, 100);  // a frame that cannot be drawn is not an error
  await page.keyboard.press('ArrowLeft');
  await page.evaluate(() => loss.restoreContext());
  await noticeShown(page);
  await sceneShown(page, 'soup');
  const after = await view(page);
  assert.ok(distance(after.eye, before.eye) < 1e-3, 'the same view');
  assert.ok(shown.equals(await image(page)), 'the same image');
}));

test('the device is lost while a scene loads', () => visit('', async (page) => {
  await page.evaluate(() => {
    window.loss = document.getElementById('canvas').getContext('webgl2').getExtension('WEBGL_lose_context');
  });
  await page.fill('#address', 'soup.glb');
  await page.press('#address', 'Enter');
  await page.evaluate(() => loss.loseContext());
  assert.equal(await errorKind(page), 'device');
  await page.evaluate(() => loss.restoreContext());
  await noticeShown(page);
  await page.fill('#address', 'soup.glb');
  await page.press('#address', 'Enter');
  await sceneShown(page, 'soup');
}));

test('without a network the page continues', () => visit('?scene=soup.glb', async (page, profile) => {
  await sceneShown(page, 'soup');
  const before = await view(page);
  await profile.setOffline(true);
  await page.keyboard.press('3');
  await viewChanged(page, before);
  await page.click('#open-start');
  await page.fill('#address', 'other.glb');
  await page.press('#address', 'Enter');
  await errorShown(page);
  assert.equal(await page.textContent('#scene-title'), 'soup', 'the old scene stays');
  await profile.setOffline(false);
  await page.click('#open-start');
  await page.fill('#address', 'soup.glb');
  await page.press('#address', 'Enter');
  await page.locator('#errors .message').waitFor({ state: 'detached' });
  await sceneShown(page, 'soup');
}, { expected: [/ERR_INTERNET_DISCONNECTED/] }));

// The loader's script is fetched once and kept.
test('without a network files are opened', () => visit('?scene=soup.glb', async (page, profile) => {
  await sceneShown(page, 'soup');
  await profile.setOffline(true);
  await pick(page, other);
  await sceneShown(page, 'UvTexturesMlp');
  await profile.setOffline(false);
}, { expected: [/ERR_INTERNET_DISCONNECTED/] }));

/** Simulates hiding and showing the page, which a browser under test does not support: no animation
 *  frames while it is hidden, and an event for each change. Runs in the page before its scripts. */
function mayBeHidden() {
  let hidden = false, waiting = [];
  const frame = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (callback) => frame((now) => { if (hidden) waiting.push(callback); else callback(now); });
  Object.defineProperty(document, 'visibilityState', { get: () => (hidden ? 'hidden' : 'visible') });
  Object.defineProperty(document, 'hidden', { get: () => hidden });
  window.hide = (now) => {
    hidden = now;
    document.dispatchEvent(new Event('visibilitychange'));
    if (!hidden) for (const callback of waiting.splice(0)) window.requestAnimationFrame(callback);
  };
}

test('a hidden tab moves nothing, opens scenes, and shows them when it is visible', () => visit('', async (page, profile) => {
  await profile.addInitScript(mayBeHidden);
  await page.goto(new URL('?scene=soup.glb', page.url()).href);
  await sceneShown(page, 'soup');
  const before = await view(page);
  await page.evaluate(() => hide(true));
  await page.evaluate(() => document.querySelector('#named-views button').click());
  await still(page);
  assert.equal(await page.evaluate(() => location.hash), before.hash, 'nothing moves');
  await page.evaluate(() => hide(false));
  assert.ok(distance((await viewChanged(page, before)).eye, before.eye) > 0.1, 'it moves when it is visible');

  const shown = await image(page);
  await page.evaluate(() => hide(true));
  await pick(page, other);
  await sceneShown(page, 'UvTexturesMlp');
  await page.evaluate(() => hide(false));
  await still(page);
  assert.ok(!shown.equals(await image(page)), 'the other scene is drawn');
}, { reducedMotion: 'no-preference' }));

/** Waits until the canvas has as many pixels as the screen area that it covers. */
async function assertSharp(page, ratio) {
  await page.waitForFunction((dots) => {
    const canvas = document.getElementById('canvas');
    return devicePixelRatio === dots && canvas.clientWidth > 0 &&
      canvas.width === Math.round(canvas.clientWidth * dots) && canvas.height === Math.round(canvas.clientHeight * dots);
  }, ratio, often);
}

for (const [ratio, when] of [[1, thorough], [1.5, test], [2, thorough]]) {
  when(`${ratio} device pixels per CSS pixel, in windows of any size`, () => visit('?scene=soup.glb', async (page) => {
    await sceneShown(page, 'soup');
    await assertSharp(page, ratio);
    for (const [width, height] of [[500, 700], [333, 251], [900, 420]]) {
      await page.setViewportSize({ width, height });
      await assertSharp(page, ratio);
    }
    await page.keyboard.press('h');  // hides the panel
    await assertSharp(page, ratio);
    const { x, y } = await middle(page);
    const before = await view(page);
    await page.mouse.dblclick(x, y);  // the middle stays the middle for any pixel ratio
    const after = await view(page);
    const way = after.target.map((value, axis) => value - before.eye[axis]);
    const ahead = before.target.map((value, axis) => value - before.eye[axis]);
    const cosine = way.reduce((sum, value, axis) => sum + value * ahead[axis], 0) / Math.hypot(...way) / Math.hypot(...ahead);
    assert.ok(cosine > 0.9999, `the middle is the middle: ${cosine}`);
  }, { deviceScaleFactor: ratio }));
}

test('a phone that is turned', () => visit('?scene=soup.glb', async (page) => {
  await sceneShown(page, 'soup');
  await page.setViewportSize({ width: 844, height: 390 });
  await assertSharp(page, 3);
  assert.equal(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), true, 'the page fits the screen');
}, { viewport: { width: 390, height: 844 }, deviceScaleFactor: 3, hasTouch: true, isMobile: true }));
