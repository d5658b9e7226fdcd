// The module's guarantees to a program: createViewer on an empty page.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { drawingPage, drawingRoutes } from './drawing.mjs';
import { readPng } from './png.mjs';
import { each, source, stage, test } from './support.mjs';

const example = readFileSync(join(source, 'examples/soup.glb'));
const answer = (bytes) => (request, response) => response.writeHead(200, { 'content-length': bytes.length }).end(bytes);

/** The example with its cameras repeated. */
function withCameras(times) {
  const size = example.readUInt32LE(12), json = JSON.parse(example.toString('utf8', 20, 20 + size));
  const [extension] = Object.values(json.extensions);
  extension.cameras = Array(times).fill(extension.cameras).flat();
  const text = Buffer.from(JSON.stringify(json)), padded = Buffer.alloc(4 * Math.ceil(text.length / 4), ' ');
  text.copy(padded);
  const head = Buffer.from(example.subarray(0, 20)), rest = example.subarray(20 + size);
  head.writeUInt32LE(20 + padded.length + rest.length, 8);
  head.writeUInt32LE(padded.length, 12);
  return Buffer.concat([head, padded, rest]);
}

/** Half of the example, without an end. */
const stalled = (request, response) => {
  response.writeHead(200, { 'content-length': example.length });
  response.write(example.subarray(0, example.length / 2));
};

const guarded = `<!doctype html><html lang="en"><title>Guarded</title><link rel="icon" href="data:,">
<canvas id="canvas" style="width: 64px; height: 48px"></canvas><script type="module" src="guarded.js"></script>`;
const { visit, server } = await stage({ routes: {
  ...drawingRoutes,
  '/thousand.glb': answer(withCameras(11)),
  '/half.glb': stalled,
  '/far.off': answer(Buffer.from('OFF\n3 1 0\n100 100 100\n101 100 100\n100 101 100\n3 0 1 2\n')),
  '/50%.glb': answer(example),
  '/guarded.js': (request, response) => response.writeHead(200, { 'content-type': 'text/javascript' }).end(
    `import { createViewer } from './viewer.js';
     const source = { url: 'soup.glb' };
     const viewer = await createViewer(document.getElementById('canvas'), { expected: source });
     document.title = String((await viewer.load({ url: './soup.glb' })).triangles);`),
  '/guarded.html': (request, response) => response.writeHead(200, {
    'content-type': 'text/html',
    'content-security-policy': "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src blob:; " +
                               "connect-src 'self'; img-src data:; style-src 'unsafe-inline'",
  }).end(guarded),
} });

/** The outcome of a call: its result, or the kind and text of its error. */
const tried = (page, body, given) => page.evaluate(async ([text, what]) => {
  try {
    return { result: await new Function('given', `return (async () => { ${text} })()`)(what) };
  } catch (error) {
    return { kind: error.kind, sentence: error.message };
  }
}, [body, given]);

const onViewer = (body, options) => (context) => visit('drawing.html', async (page) => {
  await drawingPage(page);
  await body(page, context);
}, options);

/** Tests on one page with a viewer; each loads its own scene. */
const onOnePage = [];
const part = (name, body) => onOnePage.push([name, body]);

const image = (page) => tried(page, `
  const bytes = new Uint8Array(await (await viewer.screenshot({ width: 64, height: 48 })).arrayBuffer());
  return btoa(String.fromCharCode(...bytes));`).then(({ result }) => readPng(Buffer.from(result, 'base64')));
const colours = ({ pixels }) => new Set(new Uint32Array(pixels.buffer.slice(pixels.byteOffset, pixels.byteOffset + pixels.length))).size;

part('a scene of a thousand cameras', async (page) => {
  const { result } = await tried(page, `return (await viewer.load({ url: 'thousand.glb' })).cameras.length;`);
  assert.ok(result > 900, `${result} cameras`);
  assert.equal((await tried(page, `viewer.showCamera(${result - 1}); return (await viewer.load({ url: 'soup.glb' })).triangles;`)).result, 7000);
  assert.equal((await tried(page, `viewer.showCamera(5000);`)).kind, 'usage');
});

test('a first image goes with its load', onViewer(async (page) => {
  const begun = `const first = new Promise((resolve) => viewer.on('preview', resolve));
    window.half = viewer.load({ url: 'half.glb' }).catch((error) => error.kind);
    await first;`;
  await tried(page, begun);
  assert.ok(colours(await image(page)) > 50, 'it is visible');
  assert.equal((await tried(page, `return viewer.load({ url: 'nowhere.glb' });`)).kind, 'network');
  assert.equal((await tried(page, 'return half;')).result, 'cancelled');
  assert.equal((await tried(page, 'return viewer.scene;')).result, null);
  assert.equal((await tried(page, 'await viewer.screenshot();')).kind, 'usage', 'it is removed');

  // The next scene gets its own view.
  await tried(page, begun);
  const { result } = await tried(page, `await viewer.load({ url: 'far.off' }); return viewer.getView();`);
  assert.ok(result.target.every((value) => Math.abs(value - 100) < 2), `target: ${result.target}`);
}, { expected: [/404/] }));

test('the background before a first image returns if loading fails', onViewer(async (page) => {
  const { result } = await tried(page, `
    viewer.background = [1, 0, 0];
    const first = new Promise((resolve) => viewer.on('preview', resolve));
    const half = viewer.load({ url: 'half.glb' }).catch(() => {});
    await first;
    const during = viewer.background;
    await viewer.load({ url: 'nowhere.glb' }).catch(() => half);
    return [during, viewer.background];`);
  assert.notDeepEqual(result[0], [1, 0, 0], 'a scene has a background');
  assert.deepEqual(result[1], [1, 0, 0]);
}, { expected: [/404/] }));

part('the first view of a scene without cameras has all of it in a canvas of any shape', async (page) => {
  const { result: [first, framed] } = await tried(page, `
    viewer.canvas.style.width = '40px';
    viewer.canvas.style.height = '160px';
    await still();
    await viewer.load({ url: 'far.off' });
    const first = viewer.getView();
    viewer.home();
    const framed = viewer.getView();
    viewer.canvas.style.width = '64px';
    viewer.canvas.style.height = '48px';
    await still();
    return [first, framed];`);
  for (const axis of [0, 1, 2]) assert.ok(Math.abs(first.eye[axis] - framed.eye[axis]) < 1e-6, `${first.eye} and ${framed.eye}`);
});

part('a load cancelled before it begins leaves no worker', async (page) => {
  const { kind } = await tried(page, `return viewer.load({ url: 'soup.glb' }, { signal: AbortSignal.abort() });`);
  assert.equal(kind, 'cancelled');
  for (let tries = 0; page.workers().length > 0 && tries < 50; ++tries) await page.waitForTimeout(100);
  assert.equal(page.workers().length, 0);
});

part('an address that cannot be decoded is used unchanged', async (page) => {
  assert.equal((await tried(page, `return (await viewer.load({ url: '50%.glb' })).triangles;`)).result, 7000);
  assert.equal((await tried(page, `return viewer.load({ url: 'http://[' });`)).kind, 'usage');
});

part('invalid values are rejected, and change nothing', async (page) => {
  await tried(page, `await viewer.load({ url: 'soup.glb' });`);
  for (const nonsense of ['viewer.resolution = { targetFps: -1 };', 'viewer.resolution = NaN;',
                          'await viewer.screenshot({ width: 0, height: 10 });', 'await viewer.screenshot({ width: 1e9, height: 1 });',
                          'const pose = viewer.getView(); viewer.setView({ ...pose, target: pose.eye });',
                          `await viewer.show('everything');`])
    assert.equal((await tried(page, nonsense)).kind, 'usage', nonsense);
  assert.equal((await tried(page, 'viewer.draw(); return viewer.stats.scale;')).result, 1);
});

part('of two debug views the later one is shown', async (page) => {
  await tried(page, `await viewer.load({ url: 'soup.glb' });`);
  const { result } = await tried(page, `await Promise.all([viewer.show('depth'), viewer.show('normals'), viewer.show('color')]); return viewer.debugView;`);
  assert.equal(result, 'color');
});

part('setting other properties does not move the view', async (page) => {
  const { result } = await tried(page, `
    await viewer.load({ url: 'soup.glb' });
    let views = 0;
    viewer.on('view', () => { ++views; });
    viewer.background = [1, 0, 0];
    viewer.mode = 'fly';
    await still();
    const unmoved = views;
    viewer.orbit(30, 0);
    await still();
    return [unmoved, views];`);
  assert.deepEqual(result, [0, 1]);
});

test('on one page', onViewer((page, context) => each(context, onOnePage, page)));

test('an instance that does not start is reported', () => visit('models.json', async (page) => {
  await page.addInitScript(() => { WebAssembly.instantiate = () => Promise.reject(new RangeError('out of memory')); });
  await page.goto(server.address);
  await page.locator('[role=alert]', { hasText: 'RangeError: out of memory' }).waitFor();
}, { expected: [/favicon/] }));

test('a page with the policy that the package needs', () => visit('guarded.html', async (page) => {
  await page.waitForFunction(() => document.title === '7000', null, { polling: 100 });
}));
