// The page in a frame, controlled by messages from the embedding page; and the examples.

import assert from 'node:assert/strict';
import { sceneShown, stage, still, test } from './support.mjs';

const embedder = `<!doctype html><html lang="en"><title>Embedder</title><link rel="icon" href="data:,">
<iframe id="frame" title="A scene" style="width: 480px; height: 320px; border: 0"></iframe>
<script>
  const frame = document.getElementById('frame'), waiting = new Map(), heard = [];
  let last = 0;
  /** The result, or the error as it was sent. */
  function call(name, ...given) {
    return new Promise((resolve) => {
      waiting.set(++last, resolve);
      frame.contentWindow.postMessage({ tureen: 1, id: last, call: name, arguments: given }, '*');
    });
  }
  addEventListener('message', ({ source, data }) => {
    if (source !== frame.contentWindow || data?.tureen !== 1) return;
    if (data.event) heard.push(data);
    else waiting.get(data.id)(data.error ? { error: data.error } : data.result);
  });
  const ready = () => new Promise((resolve) => {
    const look = setInterval(() => { if (heard.some(({ event }) => event === 'ready')) resolve(clearInterval(look)); }, 50);
  });
</script>`;
const { visit, server } = await stage({
  routes: { '/embedder.html': (request, response) => response.writeHead(200, { 'content-type': 'text/html' }).end(embedder) },
});

/** Another origin of the same server: localhost by its IP address. */
const elsewhere = server.address.replace('localhost', '127.0.0.1');
const framed = (query, body, address = '/embedder.html') => () => visit(address, async (page) => {
  await page.evaluate((source) => { frame.src = source; }, `${server.address}index.html?embed${query}`);
  await page.evaluate(() => ready());
  await body(page);
}, { friends: [elsewhere] });

/** Calls the framed page. */
const call = (page, ...given) => page.evaluate((what) => window.call(...what), given);
/** Waits until the framed page shows a complete scene. */
const framedScene = (page) => page.waitForFunction(async () => await window.call('scene') !== null);

test('a scene, views and an image, by calls', framed('', async (page) => {
  const summary = await call(page, 'load', { url: 'soup.glb' });
  assert.equal(summary.triangles, 7000);
  assert.equal((await call(page, 'scene')).name, 'soup');
  const pose = { eye: [3, -4, 2], target: [0, 0, 0.5], up: [0, 0, 1], fov: 0.6, roll: 0 };
  await call(page, 'setView', pose);
  const now = await call(page, 'getView');
  for (const part of ['eye', 'target', 'up'])
    now[part].forEach((value, axis) => assert.ok(Math.abs(value - pose[part][axis]) < 1e-9, `${part}: ${now[part]}`));
  const size = await page.evaluate(async () => {
    const image = await createImageBitmap(await window.call('screenshot', { width: 64, height: 48 }));
    return [image.width, image.height];
  });
  assert.deepEqual(size, [64, 48]);
  await call(page, 'show', 'depth');
  assert.ok((await call(page, 'legend')).length > 0);
  assert.equal((await call(page, 'stats')).width, 480);
  await call(page, 'clear');
  assert.equal(await call(page, 'scene'), null);
}));

test('events that are subscribed to, until they are not', framed('&scene=soup.glb', async (page) => {
  await call(page, 'subscribe', 'view');
  const count = () => page.evaluate(() => heard.filter(({ event }) => event === 'view').length);
  await framedScene(page);
  await call(page, 'orbit', 40, 0);
  await page.waitForFunction(() => heard.some(({ event, data }) => event === 'view' && data.eye.length === 3));
  await call(page, 'unsubscribe', 'view');
  const before = await count();
  await call(page, 'orbit', 40, 0);
  await still(page.frames()[1]);
  await call(page, 'stats');  // an answer arrives after earlier events
  assert.equal(await count(), before);
}));

test('only the image is there', framed('&scene=soup.glb', async (page) => {
  const inside = page.frameLocator('#frame');
  await framedScene(page);
  for (const part of ['.actions', '#panel', '#start']) assert.ok(await inside.locator(part).isHidden(), part);
  // The heading is for screen readers only, so it takes at most a pixel.
  assert.deepEqual(await inside.locator('header').evaluate(({ offsetWidth, offsetHeight }) => [offsetWidth, offsetHeight]), [1, 1]);
  assert.deepEqual(await inside.locator('#canvas').evaluate(({ clientWidth, clientHeight }) => [clientWidth, clientHeight]), [480, 320]);
}));

test('what is wrong is answered by a sentence and its kind', framed('', async (page) => {
  const wrong = [
    [['explode'], ['explode'], 'usage'],
    [['load', { url: 'nowhere.glb' }], ['404'], 'network'],
    [['load', { url: 'javascript:alert(1)' }], ['javascript'], 'usage'],
    [['load', 7], ['url'], 'usage'],
    [['setView', { eye: [1, 2] }], ['eye', 'target', 'up'], 'usage'],
    [['setBackground', 'red'], [], 'usage'],
    [['showCamera', 3], [], 'usage'],
    [['subscribe', 'everything'], [], 'usage'],
  ];
  for (const [what, values, kind] of wrong) {
    const { error } = await call(page, ...what);
    for (const value of values) assert.ok(error.message.includes(value), error.message);
    assert.equal(error.kind, kind, error.message);
  }
  // Messages that are not calls are ignored.
  await page.evaluate(() => {
    for (const message of [null, 7, 'call', { tureen: 2, id: 1, call: 'clear' }, { tureen: 1, call: 'clear' }, { tureen: 1, id: {}, call: 'clear' }])
      frame.contentWindow.postMessage(message, '*');
  });
  assert.equal((await call(page, 'load', { url: 'soup.glb' })).triangles, 7000);
}));

test('a page of another origin', framed('', async (page) => {
  assert.equal((await call(page, 'load', { url: 'soup.glb' })).name, 'soup');
}, `${elsewhere}embedder.html`));

test('only the origins that the address names are answered', framed(`&origin=https://a.example`, async (page) => {
  const inside = page.frames()[1];
  await inside.evaluate(() => { window.delivered = new Promise((resolve) => { addEventListener('message', resolve); }); });
  await page.evaluate(() => {
    window.answer = 'silence';
    void window.call('scene').then((scene) => { window.answer = scene; });
  });
  // Messages arrive in their order, so an answer would be before the event.
  await inside.evaluate(async () => {
    await delivered;
    await new Promise((resolve) => { setTimeout(resolve); });
    parent.postMessage({ tureen: 1, event: 'later' }, '*');
  });
  await page.waitForFunction(() => heard.some(({ event }) => event === 'later'));
  assert.equal(await page.evaluate(() => answer), 'silence');
}));

test('an origin that is named is answered', framed(`&origin=${server.address.slice(0, -1)}`, async (page) => {
  assert.equal(await call(page, 'scene'), null);
}));

test('the example of a frame', () => visit('examples/embed.html', async (page) => {
  await page.frameLocator('iframe').locator('body:not(.empty)').waitFor();
  await page.click('#where');
  await page.locator('#status', { hasText: /\d\.\d\d/ }).waitFor();
  await page.click('#image');
  await page.locator('#images img').waitFor();
}));

test('the example of a viewer', () => visit('examples/viewer.html', async (page) => {
  await page.locator('#status', { hasText: '7,000 triangles' }).waitFor();
  await page.click('#corner');
}));
