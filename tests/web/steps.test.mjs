// Undo and redo: by the package's interface, on the page, and in a frame.

import assert from 'node:assert/strict';
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { drawingRoutes } from './drawing.mjs';
import { square } from './scenes.mjs';
import { splatPly } from './splat_ply.mjs';
import { drop, each, errors, errorShown, image, often, scratch, stage, still, test } from './support.mjs';

const files = { red: square(2, '255 0 0'), green: square(1.5, '0 255 0'), splats: splatPly(400) };
const folder = scratch();
for (const [name, bytes] of Object.entries(files)) writeFileSync(join(folder, `${name}.ply`), bytes);
/** Requests of each file; files that are gone. */
const asked = new Map(), gone = new Set();
const { visit, server } = await stage({
  routes: {
    ...drawingRoutes,
    ...Object.fromEntries(Object.entries(files).map(([name, bytes]) => [`/${name}.ply`, (request, response) => {
      asked.set(name, (asked.get(name) ?? 0) + 1);
      if (gone.has(name)) response.writeHead(404).end();
      else response.writeHead(200).end(bytes);
    }])),
  },
});

// -- the package's interface ----------------------------------------------------------------------

/** Tests on one page with a viewer; each loads its own scene first. */
const onOnePage = [];
const part = (name, body) => onOnePage.push([name, body]);

const viewing = (body, options) => (context) => visit('drawing.html', async (page) => {
  await page.waitForFunction(() => window.viewer);
  await page.evaluate(() => {
    window.loseContext = () => new Promise((resolve) => {
      const loss = viewer.canvas.getContext('webgl2').getExtension('WEBGL_lose_context');
      viewer.on('context', (what) => {
        if (what === 'lost') setTimeout(() => loss.restoreContext());
        else resolve();
      });
      loss.loseContext();
    });
    /** The image from one place, and what the interface says. */
    window.state = async () => {
      viewer.setView({ eye: [3, 2, 5], target: [0, 0, 0], up: [0, 1, 0], fov: 0.7, roll: 0 });
      const bytes = new Uint8Array(await (await viewer.screenshot({ width: 96, height: 64 })).arrayBuffer());
      return JSON.stringify([viewer.layers, viewer.background, viewer.scene?.name, [...bytes].join()]);
    };
    window.place = (x) => ({ position: [x, 0, 0], rotation: [0, 0, 0], scale: 1, mirror: false });
    /** Bytes of stores that are uploaded while `what` runs. */
    window.uploads = async (what) => {
      const gl = WebGL2RenderingContext.prototype, { texImage3D, texSubImage3D } = gl;
      let count = 0;
      gl.texImage3D = function (...given) { ++count; return texImage3D.apply(this, given); };
      gl.texSubImage3D = function (...given) { ++count; return texSubImage3D.apply(this, given); };
      try {
        await what();
      } finally {
        Object.assign(gl, { texImage3D, texSubImage3D });
      }
      return count;
    };
  });
  await body(page, context);
}, options);

part('every change is a step with a name; a moved view is none', async (page) => {
  const { names, again, drag } = await page.evaluate(async () => {
    await viewer.load({ url: 'red.ply' });
    await viewer.addLayers({ url: 'green.ply' });
    viewer.setLayer(0, { transform: place(1) });
    viewer.setLayer(1, { visible: false });
    await viewer.moveLayer(1, 0);
    viewer.setUp([1, 0, 0]);
    viewer.background = [0.5, 0.25, 0.125];
    await viewer.removeLayer(1);
    const { names } = viewer.steps;
    viewer.orbit(10, 10);
    viewer.frame();
    viewer.setLayer(0, { visible: false });  // as it is
    viewer.setUp([1, 0, 0]);
    const again = viewer.steps.names.length;
    viewer.holding = true;
    for (let i = 0; i < 10; ++i) viewer.setLayer(0, { transform: place(i / 10) });
    viewer.holding = false;
    viewer.setLayer(0, { transform: place(3) });
    return { names, again, drag: viewer.steps.names.slice(names.length) };
  });
  assert.deepEqual(names, ['Add green', 'Move red', 'Hide green', 'Reorder green', 'Change the up axis', 'Change the background', 'Remove red']);
  assert.equal(again, names.length);
  assert.deepEqual(drag, ['Move green', 'Move green']);
});

part('undoing a removal reads the source again and draws the same image', async (page) => {
  asked.clear();
  const { before, after, removed, steps, moves, returns } = await page.evaluate(async () => {
    await viewer.load({ url: 'red.ply' });
    await viewer.addLayers({ url: 'splats.ply' });
    await viewer.addLayers({ url: 'soup.glb' });
    viewer.setLayer(1, { transform: place(0.3) });
    const before = await state();
    await viewer.removeLayer(1);
    const removed = await state();
    await viewer.undo();
    const after = await state(), whole = await uploads(() => viewer.addLayers({ url: 'soup.glb' }));
    await viewer.removeLayer(3);
    const returns = await uploads(() => viewer.undo()) / whole;
    await viewer.goToStep(3);
    const moves = await uploads(async () => {
      await viewer.undo();
      await viewer.redo();
      await viewer.moveLayer(1, 0);
      await viewer.goToStep(0);
      viewer.setLayer(0, { visible: false });
      viewer.setLayer(0, { transform: place(1) });
    });
    return { before, after, removed, steps: viewer.steps, moves, returns };
  });
  assert.equal(after, before);
  assert.notEqual(removed, before);
  assert.deepEqual(steps, { names: ['Hide red', 'Move red'], position: 2 });
  assert.equal(asked.get('splats'), 2);
  assert.equal(asked.get('red'), 1, 'only what is missing is read');
  assert.equal(moves, 0, 'nothing else is uploaded');
  assert.equal(returns, 1, 'a layer that returns is uploaded once');
});

part('a source that is gone stops the undo, and nothing has changed', async (page) => {
  const { kind, before, after, later } = await page.evaluate(async () => {
    await viewer.load({ url: 'red.ply' });
    await viewer.addLayers({ url: 'green.ply' });
    await viewer.removeLayer(0);
    return { before: await state() };
  }).then(async ({ before }) => {
    gone.add('red');
    const { kind, after } = await page.evaluate(async () => ({
      kind: await viewer.undo().then(() => null, (error) => error.kind), after: await state(),
    }));
    gone.delete('red');
    return { kind, before, after, later: await page.evaluate(async () => {
      await viewer.undo();
      return viewer.layers.map(({ name }) => name);
    }) };
  });
  assert.equal(kind, 'network');
  assert.equal(after, before);
  assert.deepEqual(later, ['red', 'green']);
});

part('steps wait for one another, and a new scene begins without them', async (page) => {
  const { kinds, meanwhile, names, positions } = await page.evaluate(async () => {
    await viewer.load({ url: 'red.ply' });
    const adding = viewer.addLayers({ url: 'green.ply' });
    const positions = [];
    viewer.on('steps', ({ position }) => positions.push(position));
    await Promise.all([adding, viewer.undo(), viewer.undo(), viewer.redo()]);
    viewer.removeLayer(0);
    const reading = viewer.undo().then(() => null, (error) => error.kind);
    await new Promise((resolve) => setTimeout(resolve));  // the undo reads the source
    viewer.setLayer(0, { visible: false });
    const kinds = [await reading], meanwhile = viewer.steps.names;
    viewer.removeLayer(0);
    await viewer.load({ url: 'red.ply' });
    await viewer.addLayers({ url: 'green.ply' });
    viewer.removeLayer(0);
    const undone = viewer.undo().then(() => null, (error) => error.kind);
    await viewer.load({ url: 'splats.ply' });
    return { kinds: [...kinds, await undone], meanwhile, names: viewer.steps.names, positions };
  });
  assert.deepEqual(positions.slice(0, 3), [1, 0, 1]);
  assert.deepEqual(kinds, ['cancelled', 'cancelled']);
  assert.deepEqual(meanwhile, ['Add green', 'Remove red', 'Hide green']);
  assert.deepEqual(names, []);
});

part('debug views stay, and the layers return to them', async (page) => {
  const { views, before, after } = await page.evaluate(async () => {
    await viewer.load({ url: 'red.ply' });
    await viewer.addLayers({ url: 'green.ply' });
    await viewer.show('depth');
    const before = await state(), views = [];
    await viewer.removeLayer(0);
    views.push(viewer.debugView, viewer.legend.length > 0);
    await viewer.undo();
    views.push(viewer.debugView, viewer.legend.length > 0);
    const after = await state();
    await viewer.show('color');
    return { views, before, after };
  });
  assert.deepEqual(views, ['depth', true, 'depth', true]);
  assert.equal(after, before);
});

test('300 random changes, undos and redos end as they began', viewing(async (page) => {
  const wrong = await page.evaluate(async () => {
    const dropped = { files: [{ path: 'dropped.ply', data: await (await fetch('green.ply')).blob() }] };
    await viewer.load({ url: 'red.ply' });
    await viewer.addLayers({ url: 'splats.ply' });
    await viewer.addLayers({ url: 'soup.glb' });
    await viewer.addLayers(dropped);
    viewer.forgetSteps();
    let seed = 7;
    const random = (below) => Math.floor((seed = (seed * 16807) % 2147483647) / 2147483647 * below);
    const seen = () => JSON.stringify([viewer.layers, viewer.background]);
    const first = await state(), states = [seen()], wrong = [];
    for (let i = 0; i < 300; ++i) {
      const { layers, steps: { position, names } } = viewer, any = random(layers.length), what = random(12);
      if (what < 3) await viewer.undo();
      else if (what < 5) await viewer.redo();
      else if (what < 7) viewer.setLayer(any, { transform: place(random(100) / 50 - 1) });
      else if (what < 9) viewer.setLayer(any, { visible: !layers[any].visible });
      else if (what === 9) await viewer.moveLayer(any, random(layers.length));
      else if (what === 10) viewer.background = [random(256) / 256, 0, 0];
      else if (layers.length > 1 && random(2) === 0) await viewer.removeLayer(any);
      const now = viewer.steps;
      if (what >= 5 && now.position > position) states.splice(now.position, Infinity, seen());
      if (seen() !== states[now.position]) wrong.push(`after ${i}: ${what}`);
    }
    const last = viewer.steps.names.length;
    await viewer.goToStep(last);
    const end = await state();
    await viewer.goToStep(0);
    if (await state() !== first) wrong.push('the first state');
    await viewer.goToStep(last);
    if (await state() !== end) wrong.push('the last state');
    return { wrong, last };
  });
  assert.deepEqual(wrong.wrong, []);
  assert.ok(wrong.last > 10, `${wrong.last} steps`);
}));

test('a lost device loses no step', viewing(async (page) => {
  const { before, after, names, first, undone } = await page.evaluate(async () => {
    await viewer.load({ url: 'red.ply' });
    await viewer.addLayers({ url: 'splats.ply' });
    const first = await state();
    viewer.setLayer(1, { transform: place(0.5) });
    viewer.background = [0, 0, 0.5];
    await viewer.removeLayer(0);
    const before = await state();
    await loseContext();
    const after = await state(), { names } = viewer.steps;
    await viewer.goToStep(1);
    return { before, after, names, first, undone: await state() };
  });
  assert.equal(after, before);
  assert.deepEqual(names, ['Add splats', 'Place splats', 'Change the background', 'Remove red']);
  assert.equal(undone, first);
}));

test('by the interface', viewing((page, context) => each(context, onOnePage, page), { expected: [/404/] }));

// -- the page -------------------------------------------------------------------------------------

const layersShown = (page, wanted) => page.waitForFunction((list) =>
  document.getElementById('loading').hidden &&
  [...document.querySelectorAll('#layers .go span')].map((one) => one.textContent).join() === list, wanted.join(), often);
const steps = (page) => page.locator('#steps button').allTextContents();
const current = (page) => page.locator('#steps [aria-current]').textContent();

test('keys, buttons and the list undo and redo; dropped files return', () => visit('?scene=red.ply', async (page) => {
  await page.locator('#facts dd').first().waitFor();
  await drop(page, [join(folder, 'splats.ply')]);
  await layersShown(page, ['red', 'splats']);
  await still(page);
  const both = await image(page);
  assert.deepEqual(await steps(page), ['Before the first step', 'Add splats']);
  await page.click('[aria-label="Remove splats"]');
  await page.locator('#layers-part').waitFor({ state: 'hidden' });
  await page.keyboard.press('Control+z');
  await layersShown(page, ['red', 'splats']);
  await still(page);
  assert.ok(both.equals(await image(page)), 'the removed layer is drawn as before');
  assert.equal(await current(page), 'Add splats');
  assert.equal(await page.isDisabled('#redo'), false);
  await page.keyboard.press('Control+y');
  await page.locator('#layers-part').waitFor({ state: 'hidden' });
  assert.equal(await page.isDisabled('#redo'), true);
  await page.click('#undo');
  await layersShown(page, ['red', 'splats']);
  await page.keyboard.press('Control+Shift+z');
  await page.locator('#layers-part').waitFor({ state: 'hidden' });
  await page.click('#steps button:has-text("Add splats")');
  await layersShown(page, ['red', 'splats']);
  assert.equal(await current(page), 'Add splats');
  assert.match(await page.locator('#notices').textContent(), /Undone: Remove splats/);
  await page.click('#steps button:has-text("Before")');
  await page.locator('#layers-part').waitFor({ state: 'hidden' });
  assert.equal(await page.isDisabled('#undo'), true);
  assert.deepEqual(await errors(page), []);
  writeFileSync(join(folder, 'splats.ply'), files.green);
  await page.keyboard.press('Control+y');
  assert.match(await errorShown(page), /splats\.ply.*changed/);
  assert.equal(await current(page), 'Before the first step', 'nothing has changed');
  writeFileSync(join(folder, 'splats.ply'), files.splats);
}));

test('a text field has its own undo; a colour that is chosen is one step', () => visit('?scene=red.ply', async (page) => {
  await page.locator('#facts dd').first().waitFor();
  const before = await page.inputValue('#background');
  await page.evaluate(() => {
    const field = document.getElementById('background');
    for (const value of ['#102030', '#203040', '#304050']) {
      field.value = value;
      field.dispatchEvent(new Event('input', { bubbles: true }));
    }
    field.dispatchEvent(new Event('change', { bubbles: true }));
  });
  assert.deepEqual(await steps(page), ['Before the first step', 'Change the background']);
  await page.evaluate(() => { document.querySelector('details:has(#view-name)').open = true; });
  await page.fill('#view-name', 'mine');
  await page.press('#view-name', 'Control+z');
  assert.equal(await page.inputValue('#background'), '#304050');
  await page.locator('#canvas').focus();
  await page.keyboard.press('u');
  await page.keyboard.press('Control+z');
  await page.waitForFunction(() => document.querySelector('#steps [aria-current]').textContent === 'Change the background', null, often);
  await page.keyboard.press('Control+z');
  await page.waitForFunction((value) => document.getElementById('background').value === value, before, often);
  assert.equal(await current(page), 'Before the first step');
}));

test('a link of several scenes opens without steps', () => visit('?scene=red.ply&scene=green.ply#layers=2,hidden;1', async (page) => {
  await layersShown(page, ['green', 'red']);
  await still(page);
  assert.ok(await page.isHidden('#steps-part'));
  await page.keyboard.press('Control+z');
  await page.locator('#notices .message', { hasText: 'nothing to undo' }).waitFor();
}));

test('by calls from an embedding page', () => visit('drawing.html', async (page) => {
  const heard = await page.evaluate(async (address) => {
    const frame = document.createElement('iframe'), waiting = new Map(), heard = [];
    let last = 0;
    const call = (name, ...given) => new Promise((resolve) => {
      waiting.set(++last, resolve);
      frame.contentWindow.postMessage({ tureen: 1, id: last, call: name, arguments: given }, '*');
    });
    const ready = new Promise((resolve) => addEventListener('message', ({ data }) => {
      if (data.event === 'ready') resolve();
      else if (data.event) heard.push(data.data.position);
      else waiting.get(data.id)(data.error ?? data.result);
    }));
    frame.src = `${address}index.html?embed`;
    document.body.append(frame);
    await ready;
    await call('load', { url: 'red.ply' });
    await call('subscribe', 'steps');
    await call('setHolding', true);
    await call('setBackground', [1, 0, 0]);
    await call('setBackground', [0, 1, 0]);
    await call('setHolding', false);
    await call('setLayer', 0, { visible: false });
    await call('undo');
    await call('undo');
    await call('redo');
    const steps = await call('steps');
    await call('goToStep', 2);
    const wrong = await call('goToStep', 9);
    await call('forgetSteps');
    return { heard, steps, wrong: wrong.kind, end: await call('steps') };
  }, server.address);
  assert.deepEqual(heard.steps, { names: ['Change the background', 'Hide red'], position: 1 });
  assert.deepEqual(heard.heard.slice(-5), [1, 0, 1, 2, 0]);
  assert.equal(heard.wrong, 'usage');
  assert.deepEqual(heard.end, { names: [], position: 0 });
}));
