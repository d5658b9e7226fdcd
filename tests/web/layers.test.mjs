// Scenes of several layers: by the package's interface, on the page, in a link and in a frame; the memory of
// the page's instance; and what a device or the limit refuses.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { drawingRoutes } from './drawing.mjs';
import { readPng } from './png.mjs';
import { square } from './scenes.mjs';
import {
  drop, each, errorShown, image, noticeShown, often, pick, programs, sceneShown, scratch, stage, still, test, thorough, view,
} from './support.mjs';

const colors = { red: [255, 0, 0], green: [0, 255, 0], blue: [0, 0, 255] };
const files = { red: square(2, '255 0 0'), green: square(2, '0 255 0'), blue: square(1, '0 0 255') };
const folder = scratch();
for (const [name, text] of Object.entries(files)) writeFileSync(join(folder, `${name}.ply`), text);

const plies = Object.fromEntries(Object.entries(files).map(([name, text]) =>
  [`/${name}.ply`, (request, response) => response.writeHead(200).end(text)]));
const embedder = `<!doctype html><html lang="en"><title>Embedder</title><link rel="icon" href="data:,">
<iframe id="frame" title="A scene" style="width: 480px; height: 320px; border: 0"></iframe>
<script>
  const waiting = new Map(), heard = [];
  let last = 0;
  function call(name, ...given) {
    return new Promise((resolve) => {
      waiting.set(++last, resolve);
      document.getElementById('frame').contentWindow.postMessage({ tureen: 1, id: last, call: name, arguments: given }, '*');
    });
  }
  addEventListener('message', ({ data }) => {
    if (data.event) heard.push(data);
    else waiting.get(data.id)(data.error ? { error: data.error } : data.result);
  });
</script>`;
const { visit, server } = await stage({
  routes: {
    ...drawingRoutes,
    ...Object.fromEntries(['/red.ply', '/green.ply', '/blue.ply', '/several.glb', '/many.glb'].map((path) =>
      [path, (request, response) => plies[path](request, response)])),
    '/stalled.ply': () => {},  // no answer
    '/embedder.html': (request, response) => response.writeHead(200, { 'content-type': 'text/html' }).end(embedder),
  },
});

// -- the package's interface ----------------------------------------------------------------------

/** Tests on one page with a viewer; each loads its own scene first. */
const onOnePage = [];
const part = (name, body) => onOnePage.push([name, body]);

/** Opens a page with a viewer that looks at the origin from the front. */
const viewing = (body, options) => (context) => visit('drawing.html', async (page) => {
  await page.waitForFunction(() => window.viewer);
  await page.evaluate(() => {
    window.front = () => viewer.setView({ eye: [0, 0, 5], target: [0, 0, 0], up: [0, 1, 0], fov: 0.7, roll: 0 });
    window.loseContext = () => new Promise((resolve) => {
      const loss = viewer.canvas.getContext('webgl2').getExtension('WEBGL_lose_context');
      viewer.on('context', (what) => {
        if (what === 'lost') setTimeout(() => loss.restoreContext());  // a context cannot be restored during its event
        else resolve();
      });
      loss.loseContext();
    });
    window.shown = () => viewer.layers.map(({ name, triangles, visible }) => ({ name, triangles, visible }));
  });
  await body(page, context);
}, options);

/** The colour in the middle of the image. */
async function middleColor(page) {
  const base64 = await page.evaluate(async () => {
    front();
    const bytes = new Uint8Array(await (await viewer.screenshot({ width: 32, height: 32 })).arrayBuffer());
    return btoa(String.fromCharCode(...bytes));
  });
  const { pixels, width } = readPng(Buffer.from(base64, 'base64'));
  return [...pixels.subarray(4 * (16 * width + 16)).subarray(0, 3)];
}

part('layers are added, ordered, hidden, placed and removed', async (page) => {
  await page.evaluate(() => viewer.load({ url: 'red.ply' }));
  assert.deepEqual(await middleColor(page), colors.red);
  const added = await page.evaluate(async () => (await viewer.addLayers({ url: 'green.ply' })).map(({ name }) => name));
  assert.deepEqual(added, ['green']);
  assert.deepEqual(await page.evaluate(() => shown()),
                   [{ name: 'red', triangles: 2, visible: true }, { name: 'green', triangles: 2, visible: true }]);
  assert.deepEqual(await middleColor(page), colors.red, 'at equal depth the earlier layer');
  await page.evaluate(() => viewer.moveLayer(1, 0));
  assert.deepEqual(await middleColor(page), colors.green);
  await page.evaluate(() => viewer.setLayer(0, { visible: false }));
  assert.deepEqual(await middleColor(page), colors.red);
  await page.evaluate(() => viewer.setLayer(0, { visible: true, transform: { position: [0, 0, -1], rotation: [0, 0, 0], scale: 1, mirror: false } }));
  assert.deepEqual(await middleColor(page), colors.red, 'the green square is farther');
  await page.evaluate(() => viewer.setLayer(0, { transform: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 1] }));
  assert.deepEqual(await middleColor(page), colors.green, 'the green square is nearer');
  assert.deepEqual(await page.evaluate(() => viewer.layers[0].placement.position), [0, 0, 1]);
  await page.evaluate(() => viewer.removeLayer(0));
  assert.deepEqual(await middleColor(page), colors.red);
  assert.deepEqual(await page.evaluate(() => shown().map(({ name }) => name)), ['red']);
  await page.evaluate(() => viewer.removeLayer(0));
  assert.equal(await page.evaluate(() => viewer.scene), null, 'without its only layer there is no scene');
});

part('names that collide get numbers; the facts are those of all layers', async (page) => {
  const summary = await page.evaluate(async () => {
    await viewer.load({ url: 'red.ply' });
    await Promise.all([viewer.addLayers({ url: 'red.ply' }), viewer.addLayers({ url: 'red.ply' }), viewer.addLayers({ url: 'blue.ply' })]);
    return viewer.scene;
  });
  assert.deepEqual(await page.evaluate(() => shown().map(({ name }) => name)), ['red', 'red 2', 'red 3', 'blue']);
  assert.equal(summary.triangles, 8);
  assert.equal(summary.name, 'red');
  const { bytes, total } = await page.evaluate(() =>
    ({ bytes: viewer.layers.reduce((sum, { deviceBytes }) => sum + deviceBytes, 0), total: viewer.scene.deviceBytes }));
  assert.equal(bytes, total);
});

part('the view stays when layers are added; all visible ones are framed', async (page) => {
  const { before, after, near, far } = await page.evaluate(async () => {
    await viewer.load({ url: 'red.ply' });
    front();
    const before = viewer.getView();
    await viewer.addLayers({ url: 'green.ply' });
    viewer.setLayer(1, { transform: { position: [20, 0, 0], rotation: [0, 0, 0], scale: 1, mirror: false } });
    const after = viewer.getView();
    viewer.frame();
    const far = viewer.getView();
    viewer.setLayer(1, { visible: false });
    viewer.frame();
    return { before, after, far, near: viewer.getView() };
  });
  assert.deepEqual(after, before);
  assert.ok(Math.abs(far.target[0] - 10) < 1e-6, `the middle of both: ${far.target}`);
  assert.ok(Math.abs(near.target[0]) < 1e-6, `the middle of the visible one: ${near.target}`);
});

part('a transform and its parts', async (page) => {
  const worst = await page.evaluate(async () => {
    await viewer.load({ url: 'red.ply' });
    const set = (transform) => {
      viewer.setLayer(0, { transform });
      return viewer.layers[0];
    };
    let worst = 0, seed = 1;
    const random = () => (seed = (seed * 16807) % 2147483647) / 2147483647 * 2 - 1;
    for (let i = 0; i < 200; ++i) {
      const rotation = [random() * 3, random() * 3, random() * 3];
      if (i % 5 === 0) rotation[1] = Math.PI / 2 * (i % 2 ? 1 : -1);  // the rotations about x and z coincide
      const { transform } = set({ position: [random(), random(), random()], rotation, scale: Math.exp(3 * random()), mirror: i % 2 === 0 });
      const again = set(set(transform).placement).transform;
      worst = Math.max(worst, ...again.map((value, index) => Math.abs(value - transform[index]) / (1 + Math.abs(transform[index]))));
    }
    return worst;
  });
  // The conversions of degrees and radians and of the matrix round a few times.
  assert.ok(worst < 1e-12, `relative difference ${worst}`);
  for (const scale of [0, -1, null])
    assert.match(await page.evaluate((value) => {
      try {
        viewer.setLayer(0, { transform: { position: [0, 0, 0], rotation: [0, 0, 0], scale: value ?? NaN, mirror: false } });
        return 'accepted';
      } catch (error) {
        return `${error.kind}: ${error.message}`;
      }
    }, scale), /scale above 0/);
});

part('debug views with several layers, which keep their places', async (page) => {
  const names = await page.evaluate(async () => {
    await viewer.load({ url: 'red.ply' });
    await viewer.addLayers({ url: 'green.ply' });
    await viewer.moveLayer(1, 0);
    await viewer.show('triangle-id');
    return shown().map(({ name }) => name);
  });
  assert.deepEqual(names, ['green', 'red']);
  const front = await middleColor(page);
  assert.notDeepEqual(front, colors.green, 'a debug view');
  await page.evaluate(() => viewer.setLayer(0, { visible: false }));
  assert.notDeepEqual(await middleColor(page), front, 'the other layer\'s triangle');
  await page.evaluate(() => viewer.addLayers({ url: 'blue.ply' }));
  assert.equal(await page.evaluate(() => viewer.debugView), 'triangle-id', 'it stays when a layer is added');
  await page.evaluate(() => viewer.removeLayer(1));
  assert.equal(await page.evaluate(() => viewer.debugView), 'triangle-id');
  await page.evaluate(() => viewer.show('color'));
  assert.deepEqual(await middleColor(page), colors.blue, 'only green, which is hidden, and blue are left');
});

test('the memory of the page\'s instance does not grow with a layer', viewing(async (page) => {
  const bytes = await page.evaluate(async () => {
    await viewer.load({ url: 'soup.glb' });
    const bytes = [];
    for (let layers = 2; layers <= 4; ++layers) {
      await viewer.addLayers({ url: 'soup.glb' });
      viewer.draw();
      bytes.push(viewer.stats.wasmBytes);
    }
    return bytes;
  });
  assert.equal(bytes[2], bytes[0], `${bytes}`);
}));

thorough('nor with thirteen', viewing(async (page) => {
  const { one, many, bytes, ms } = await page.evaluate(async () => {
    await viewer.load({ url: 'soup.glb' });
    viewer.draw();
    const one = viewer.stats.wasmBytes, bytes = [viewer.scene.deviceBytes];
    for (let i = 1; i < 14; ++i) await viewer.addLayers({ url: 'soup.glb' });
    bytes.push(viewer.scene.deviceBytes);
    viewer.draw();
    const start = performance.now();
    for (let i = 0; i < 5; ++i) {
      viewer.draw();
      await viewer.screenshot({ width: 64, height: 48 });  // waits for the device
    }
    return { one, many: viewer.stats.wasmBytes, bytes, ms: (performance.now() - start) / 10 };
  });
  console.log(`WebAssembly: ${one} and ${many} bytes; device: ${bytes}; a frame of 64 x 48: ${ms.toFixed(1)} ms`);
  assert.ok(bytes[1] < 100e6, '14 of the example on the device');
  assert.ok(many < 64e6, `${many} bytes of WebAssembly`);
}));

/** Simulates a device that refuses further texel stores after window.noMore is set: runs before the page's scripts. */
function shortOfMemory() {
  const gl = WebGL2RenderingContext.prototype, { getError, texImage3D } = gl;
  let missing = false;
  gl.texImage3D = function (...given) {
    if (window.noMore) missing = true;
    else texImage3D.apply(this, given);
  };
  gl.getError = function () {
    const error = missing ? this.OUT_OF_MEMORY : getError.call(this);
    missing = false;
    return error;
  };
}

async function reloadedShort(page, profile) {
  await page.waitForFunction(() => window.viewer);  // a viewer that has not started would report an error
  await profile.addInitScript(shortOfMemory);
  await page.reload();
  await page.waitForFunction(() => window.viewer);
}

test('a layer that does not fit is named with its forecast, and the others stay', () => visit('drawing.html', async (page, profile) => {
  await reloadedShort(page, profile);
  const { error, kind, names, progress, scene } = await page.evaluate(async () => {
    const progress = [];
    viewer.on('progress', ({ deviceBytes }) => { if (deviceBytes !== null) progress.push(deviceBytes); });
    await viewer.load({ url: 'soup.glb' });
    const before = viewer.scene.deviceBytes;
    window.noMore = true;
    const refusal = await viewer.addLayers({ url: 'soup.glb' }).catch((error) => error);
    window.noMore = false;
    await viewer.addLayers({ url: 'soup.glb' });  // the device has memory again
    return { error: refusal.message, kind: refusal.kind, names: viewer.layers.map(({ name }) => name), progress, scene: [before, viewer.scene.deviceBytes] };
  });
  assert.equal(kind, 'memory');
  assert.match(error, /“soup 2”.*\d\sMB/);
  assert.deepEqual(names, ['soup', 'soup 2']);
  assert.equal(scene[1], 2 * scene[0], 'the refused layer left nothing on the device');
  // Renderer::device_bytes() is larger than the forecast by the padding of its textures.
  assert.ok(progress.length > 0 && progress[0] <= scene[0] && progress[0] > scene[0] / 2, `${progress[0]} of ${scene[0]} bytes`);
}));

/** The error of one layer more than the device can number, the number of layers, and the middle's colour. `fill` adds the
 *  others; it runs in the page. */
async function refusal(page, fill) {
  await page.evaluate(fill);
  const { message, kind, count } = await page.evaluate(async () => {
    const refusal = await viewer.addLayers({ url: 'blue.ply' }).catch((error) => error);
    return { message: refusal.message, kind: refusal.kind, count: viewer.layers.length };
  });
  assert.equal(count, 255);
  assert.equal(kind, 'usage');
  assert.match(message, /\b255\b/);
  assert.deepEqual(await middleColor(page), colors.blue);
}

const many = join(folder, 'many.glb');
execFileSync(join(programs, 'tureen'), ['convert', ...Array(254).fill(join(folder, 'blue.ply')), '-o', many]);
plies['/many.glb'] = (request, response) => response.writeHead(200).end(readFileSync(many));

part('more layers than the device can number are refused', (page) => refusal(page, async () => {
  await viewer.load({ url: 'many.glb' });
  await viewer.addLayers({ url: 'blue.ply' });
}));

thorough('more layers than the device can number, each of a file, are refused', viewing((page) => refusal(page, async () => {
  const { maxLayers } = await import('/viewer.js');
  const texts = await (await fetch('blue.ply')).blob();
  const one = () => ({ files: [{ path: 'one.ply', data: texts }] });
  await viewer.load(one());
  const added = [];
  for (let i = 1; i < maxLayers; ++i) added.push(viewer.addLayers(one()));
  await Promise.all(added);
})));

part('what is wrong is reported, and changes nothing', async (page) => {
  const wrong = await page.evaluate(async () => {
    await viewer.load({ url: 'red.ply' });
    const attempts = [
      () => viewer.setLayer(1, { visible: false }),
      () => viewer.setLayer(0, { transform: [1, 2, 3] }),
      () => viewer.setLayer(0, { transform: [2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] }),
      () => viewer.setLayer(0, { transform: { position: [0, 0, 0], rotation: [0, 0, 0], scale: 0, mirror: false } }),
      () => viewer.moveLayer(0, 1),
      () => viewer.removeLayer(-1),
    ];
    const kinds = [];
    for (const attempt of attempts) {
      try {
        await attempt();
        kinds.push(null);
      } catch (error) {
        kinds.push(error.kind);
      }
    }
    return { kinds, layers: viewer.layers.length, transform: viewer.layers[0].transform };
  });
  assert.deepEqual(wrong.kinds, Array(6).fill('usage'));
  assert.equal(wrong.layers, 1);
  assert.deepEqual(wrong.transform, [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
});

part('a new scene cancels layers that are being added', async (page) => {
  const { kinds, names } = await page.evaluate(async () => {
    await viewer.load({ url: 'red.ply' });
    const added = [viewer.addLayers({ url: 'green.ply' }), viewer.addLayers({ url: 'green.ply' })];
    const loaded = viewer.load({ url: 'blue.ply' });
    const kinds = await Promise.all(added.map((one) => one.then(() => null, (error) => error.kind)));
    await loaded;
    return { kinds, names: viewer.layers.map(({ name }) => name) };
  });
  assert.deepEqual(kinds, ['cancelled', 'cancelled']);
  assert.deepEqual(names, ['blue']);
});

part('a debug view that is chosen while layers are added follows them', async (page) => {
  const names = await page.evaluate(async () => {
    await viewer.load({ url: 'red.ply' });
    const added = viewer.addLayers({ url: 'green.ply' });
    const shows = viewer.show('triangle-id');
    await Promise.all([added, shows]);
    const more = viewer.show('depth');
    await Promise.all([more, viewer.addLayers({ url: 'blue.ply' })]);
    return viewer.layers.map(({ name }) => name);
  });
  assert.deepEqual(names, ['red', 'green', 'blue']);
  assert.equal(await page.evaluate(() => viewer.debugView), 'depth');
});

part('a layer is removed while another is added', async (page) => {
  const { added, names } = await page.evaluate(async () => {
    await viewer.load({ url: 'red.ply' });
    await viewer.addLayers({ url: 'green.ply' });
    const adding = viewer.addLayers({ url: 'blue.ply' });
    await viewer.removeLayer(0);
    return { added: (await adding).map(({ name }) => name), names: viewer.layers.map(({ name }) => name) };
  });
  assert.deepEqual(added, ['blue']);
  assert.deepEqual(names, ['green', 'blue']);
});

test('the device is lost and comes back, with all layers', viewing(async (page) => {
  const before = await page.evaluate(async () => {
    await viewer.load({ url: 'red.ply' });
    await viewer.addLayers({ url: 'green.ply' });
    await viewer.addLayers({ url: 'blue.ply' });
    await viewer.moveLayer(2, 0);
    await viewer.removeLayer(1);
    viewer.setLayer(1, { transform: { position: [0, 0, 1], rotation: [0, 1, 0], scale: 2, mirror: true }, visible: false });
    return JSON.stringify(viewer.layers);
  });
  await page.evaluate(async () => {
    await loseContext();
  });
  assert.equal(await page.evaluate(() => JSON.stringify(viewer.layers)), before);
  assert.deepEqual(await middleColor(page), colors.blue);
}));

test('the device is lost, and a file is missing when it comes back', viewing(async (page) => {
  await page.evaluate(async () => {
    const { href } = new URL('green.ply', location.href), blob = URL.createObjectURL(await (await fetch(href)).blob());
    await viewer.load({ url: blob, name: 'gone' });
    await viewer.addLayers({ url: 'red.ply' });
    await viewer.addLayers({ url: 'blue.ply' });
    URL.revokeObjectURL(blob);
    window.noted = [];
    viewer.on('notice', (sentence) => noted.push(sentence));
    await loseContext();
  });
  assert.deepEqual(await page.evaluate(() => shown().map(({ name }) => name)), ['red', 'blue']);
  assert.equal(await page.evaluate(() => noted.length), 1);
  assert.deepEqual(await middleColor(page), colors.red);
}, { expected: [/ERR_FILE_NOT_FOUND/] }));

const several = join(folder, 'several.glb');
execFileSync(join(programs, 'tureen'), ['convert', ...['red', 'green', 'blue'].map((name) => join(folder, `${name}.ply`)),
                                        '-o', several]);
plies['/several.glb'] = (request, response) => response.writeHead(200).end(readFileSync(several));

part('a file of several layers, loaded and added', async (page) => {
  const list = await page.evaluate(async () => {
    await viewer.load({ url: 'several.glb' });
    await viewer.addLayers({ url: 'several.glb' });
    return viewer.layers.map(({ name, sourceLayer }) => [name, sourceLayer]);
  });
  assert.deepEqual(list, [['red', 0], ['green', 1], ['blue', 2], ['red 2', 0], ['green 2', 1], ['blue 2', 2]]);
  assert.deepEqual(await middleColor(page), colors.red);
  await page.evaluate(() => viewer.show('triangle-id'));
  await page.evaluate(() => viewer.show('color'));
  await page.evaluate(async () => {
    await viewer.removeLayer(0);
    await viewer.removeLayer(0);
  });
  assert.deepEqual(await middleColor(page), colors.blue);
});

part('layers of a file that was cancelled are not added', async (page) => {
  const { kind, uploaded, after, bytes } = await page.evaluate(async () => {
    await viewer.load({ url: 'red.ply' });
    const ending = new AbortController(), before = viewer.scene.deviceBytes;
    let uploads = 0;
    viewer.on('progress', ({ stage }) => {
      if (stage === 'upload' && ++uploads === 2) setTimeout(() => ending.abort());  // the second of three layers
    });
    const kind = await viewer.addLayers({ url: 'several.glb' }, { signal: ending.signal }).then(() => null, (error) => error.kind);
    viewer.setLayer(0, { visible: true });
    await viewer.addLayers({ url: 'red.ply' });
    return { kind, uploaded: uploads, after: viewer.layers.map(({ name }) => name), bytes: viewer.scene.deviceBytes / before };
  });
  assert.equal(kind, 'cancelled');
  assert.ok(uploaded > 1);
  assert.deepEqual(after, ['red', 'red 2']);
  assert.equal(bytes, 2, 'nothing of it is left on the device');
});

test('of a file that does not fit, the layers that fit are drawn', () => visit('drawing.html', async (page, profile) => {
  await reloadedShort(page, profile);
  const { names, notices } = await page.evaluate(async () => {
    const notices = [];
    viewer.on('notice', (sentence) => notices.push(sentence));
    // Refuses everything until the file is read again, layer by layer; then the second layer.
    window.noMore = true;
    let layers = 0;
    viewer.on('progress', ({ stage, deviceBytes }) => {
      if (deviceBytes !== null && stage === 'upload') window.noMore = ++layers === 2;
    });
    await viewer.load({ url: 'several.glb' });
    return { names: viewer.layers.map(({ name }) => name), notices };
  });
  assert.deepEqual(names, ['red', 'blue']);
  assert.match(notices.join(), /“green”.*MB/);
}));

test('by the interface', viewing((page, context) => each(context, onOnePage, page)));

// -- the page -------------------------------------------------------------------------------------

/** The names in the list of layers. */
const names = (page) => page.locator('#layers .go span').allTextContents();
const layersShown = (page, wanted) => page.waitForFunction((list) =>
  document.getElementById('loading').hidden &&
  [...document.querySelectorAll('#layers .go span')].map((one) => one.textContent).join() === list, wanted.join(), often);

test('files that are dropped on a scene are added; a picked file replaces it', () => visit('?scene=red.ply', async (page) => {
  await sceneShown(page, 'red');
  assert.ok(await page.isHidden('#layers-part'), 'one layer has no list');
  await drop(page, [join(folder, 'green.ply'), join(folder, 'red.ply')]);
  await layersShown(page, ['red', 'green', 'red 2']);
  assert.ok(await page.isVisible('#layers-part'));
  assert.equal(await page.textContent('#scene-title'), 'red and 2 more');
  assert.match(await page.inputValue('#link'), /\?scene=red\.ply#/, 'local files have no address');
  assert.match(await page.textContent('#link-hint'), /local files/);
  await pick(page, join(folder, 'blue.ply'));
  await sceneShown(page, 'blue');
  assert.ok(await page.isHidden('#layers-part'));
}));

test('several dropped files without a scene', () => visit('', async (page) => {
  await drop(page, [join(folder, 'blue.ply'), join(folder, 'green.ply')]);
  await layersShown(page, ['blue', 'green']);
}));

test('the list shows, moves and removes layers, by keys too', () => visit('?scene=red.ply&scene=green.ply&scene=blue.ply', async (page) => {
  await layersShown(page, ['red', 'green', 'blue']);
  await page.click('[aria-label="Move up green"]');
  await layersShown(page, ['green', 'red', 'blue']);
  assert.equal(await page.evaluate(() => document.activeElement.textContent.includes('green')), true,
               'the button is off in the first row, so the focus is on its layer');
  await page.focus('[aria-label="Move down green"]');
  await page.keyboard.press('Enter');
  await layersShown(page, ['red', 'green', 'blue']);
  assert.equal(await page.evaluate(() => document.activeElement.getAttribute('aria-label')), 'Move down green', 'the focus stays');
  await still(page);
  const before = await image(page);
  await page.uncheck('[aria-label="Show red"]');
  await still(page);
  assert.ok(!before.equals(await image(page)));
  await page.click('[aria-label="Remove red"]');
  await layersShown(page, ['green', 'blue']);
  await page.click('[aria-label="Remove green"]');
  await page.locator('#layers-part').waitFor({ state: 'hidden' });
  assert.equal(await page.textContent('#scene-title'), 'blue');
  await page.waitForFunction(() => location.search === '?scene=blue.ply', null, often);
}));

test('a link has the scenes, and the order, places and visibility of their layers',
     () => visit('?scene=red.ply&scene=green.ply&scene=red.ply', async (page) => {
  await layersShown(page, ['red', 'green', 'red 2']);
  assert.doesNotMatch(await page.inputValue('#link'), /layers=/, 'as in the files');
  await page.click('[aria-label="Move up green"]');
  await page.uncheck('[aria-label="Show red 2"]');
  await page.click('#layers .go:has-text("green")');
  const entered = { 'layer-position-x': '1.25', 'layer-position-z': '-0.5', 'layer-rotation-x': '30', 'layer-rotation-y': '90', 'layer-scale': '1.5' };
  for (const [id, value] of Object.entries(entered)) {
    await page.fill(`#${id}`, value);
    await page.press(`#${id}`, 'Enter');
  }
  await page.check('#layer-mirror');
  for (const [id, value] of Object.entries(entered)) assert.equal(await page.inputValue(`#${id}`), value, id);
  await view(page);
  const link = page.url();
  assert.match(link, /\?scene=green\.ply&scene=red\.ply&scene=red\.ply#/);
  assert.match(link, /layers=1,at:1\.25:0:-0\.5,turn:30:90:0,scale:1\.5,mirror;2;3,hidden/);
  const shown = await image(page);
  await page.goto('about:blank');
  await page.goto(link);
  await layersShown(page, ['green', 'red', 'red 2']);
  await still(page);
  assert.equal(await page.isChecked('[aria-label="Show red 2"]'), false);
  assert.equal(await page.inputValue('#layer-position-x'), '1.25');
  assert.equal(page.url(), link);
  // The link rounds the camera, so pixels at edges may differ.
  const [a, b] = [readPng(shown).pixels, readPng(await image(page)).pixels];
  const different = a.reduce((count, value, index) => count + (Math.abs(value - b[index]) > 8 ? 1 : 0), 0);
  assert.ok(a.length === b.length && different < a.length / 200, `${different} of ${a.length} values differ`);
}));

test('a new scene ends the opening of a link', () => visit('?scene=red.ply&scene=stalled.ply&scene=green.ply', async (page) => {
  await page.waitForFunction(() => document.getElementById('loading-name').textContent.includes('stalled'), null, often);
  await pick(page, join(folder, 'blue.ply'));
  await sceneShown(page, 'blue');
  await still(page);
  assert.equal(await page.textContent('#scene-title'), 'blue');
}));

test('a link\'s unreadable layers are reported, and the scenes are shown', () => visit('?scene=red.ply&scene=green.ply#layers=1,nowhere', async (page) => {
  await layersShown(page, ['red', 'green']);
  await noticeShown(page, 'layers');
}));

test('a scene of a link that is missing is reported, and the others are shown',
     () => visit('?scene=red.ply&scene=nowhere.ply&scene=blue.ply#layers=3,hidden;2;1', async (page) => {
  await layersShown(page, ['blue', 'red']);
  assert.equal(await page.isChecked('[aria-label="Show blue"]'), false, 'the numbers are the link\'s');
  await still(page);
  assert.match(page.url(), /\?scene=red\.ply&scene=nowhere\.ply&scene=blue\.ply#layers=3,hidden;2;1$/, 'the address still has all scenes');
  assert.match(await errorShown(page), /nowhere\.ply.*404/);
}, { expected: [/404/] }));

// -- in a frame -----------------------------------------------------------------------------------

test('layers by calls from an embedding page', () => visit('embedder.html', async (page) => {
  await page.evaluate((address) => { document.getElementById('frame').src = address; }, `${server.address}index.html?embed&scene=red.ply`);
  await page.waitForFunction(() => heard.some(({ event }) => event === 'ready'));
  await page.waitForFunction(async () => await call('scene') !== null);
  const call = (...given) => page.evaluate((what) => window.call(...what), given);
  await call('subscribe', 'layers');
  const added = await call('addLayers', { url: 'green.ply' });
  assert.deepEqual(added.map(({ name, source }) => [name, source]), [['green', undefined]]);
  await call('moveLayer', 1, 0);
  await call('setLayer', 0, { visible: false, transform: { position: [1, 2, 3], rotation: [0, 0, 0] } });
  const layers = await call('layers');
  assert.deepEqual(layers.map(({ name, visible }) => [name, visible]), [['green', false], ['red', true]]);
  assert.deepEqual(layers[0].transform.slice(12), [1, 2, 3, 1]);
  await call('removeLayer', 0);
  assert.deepEqual((await call('layers')).map(({ name }) => name), ['red']);
  await page.waitForFunction(() => heard.some(({ event, data }) => event === 'layers' && data.length === 1));
  for (const wrong of [['setLayer', 0, { transform: [1] }], ['removeLayer', 9], ['moveLayer', 0, -1]])
    assert.equal((await call(...wrong)).error.kind, 'usage');
}));
