// Navigation with a mouse, keys and fingers, checked by the camera in the page's address.

import assert from 'node:assert/strict';
import {
  distance, each, image, length, middle, minus, often, sceneShown, stage, test, view, viewChanged,
} from './support.mjs';

const { visit } = await stage();

/** Tests on one page with the example, with a mouse and keys and with fingers. */
const withMouse = [], withFingers = [];

/** A test that gets the page, the first view at rest, and the canvas's middle. `glides`: views change gradually, as
 *  they do by default, which takes many frames. */
const looking = (act, { glides = false } = {}) => async (page) => {
  await page.emulateMedia({ reducedMotion: 'reduce' });
  await page.evaluate(() => {
    document.querySelector('input[name=mode][value=orbit]').click();
    document.getElementById('home').click();
    document.activeElement.blur();
  });
  const first = await view(page);
  if (glides) await page.emulateMedia({ reducedMotion: 'no-preference' });
  await act(page, first, await middle(page));
};
const mouse = (name, act, options) => withMouse.push([name, looking(act, options)]);
const fingers = (name, act, options) => withFingers.push([name, looking(act, options)]);

const testAll = (name, tests, context) => test(name, (running) => visit('?scene=soup.glb', async (page) => {
  await sceneShown(page, 'soup');
  await each(running, tests, page);
}, context));

async function drag(page, { x, y }, dx, dy, options = {}) {
  await page.mouse.move(x, y);
  await page.mouse.down(options);
  await page.mouse.move(x + dx, y + dy, { steps: 5 });
  await page.mouse.up(options);
}

const reach = ({ eye, target }) => distance(eye, target);
/** Numbers in an address have five decimals. */
const near = (a, b, what) => assert.ok(distance(a, b) < 1e-3, `${what}: ${a} and ${b}`);

function assertTurned(before, after) {
  near(before.target, after.target, 'the target stays');
  assert.ok(Math.abs(reach(after) - reach(before)) < 1e-3, 'the distance stays');
  assert.ok(distance(before.eye, after.eye) > 0.02, 'the eye moves');
}

function assertMovedAlong(before, after) {
  near(minus(after.eye, before.eye), minus(after.target, before.target), 'eye and target move alike');
  assert.ok(distance(before.target, after.target) > 0.02, 'they move');
}

mouse('a drag turns the scene', async (page, before, at) => {
  await drag(page, at, 80, 20);
  assertTurned(before, await viewChanged(page, before));
}, { glides: true });

mouse('right drag and Shift drag move the scene along', async (page, before, at) => {
  await drag(page, at, 60, 0, { button: 'right' });
  const moved = await viewChanged(page, before);
  assertMovedAlong(before, moved);
  await page.keyboard.down('Shift');
  await drag(page, at, 0, 60);
  await page.keyboard.up('Shift');
  assertMovedAlong(moved, await viewChanged(page, moved));
});

mouse('the wheel goes nearer and farther, towards the pointer', async (page, before, { x, y, box }) => {
  await page.mouse.move(x, y);
  await page.mouse.wheel(0, -300);
  const nearer = await viewChanged(page, before);
  assert.ok(Math.abs(reach(nearer) / reach(before) - 0.9 ** 3) < 1e-3, `three steps of a tenth: ${reach(nearer) / reach(before)}`);
  near(nearer.target, before.target, 'from the middle the target stays');
  await page.mouse.wheel(0, 300);
  const back = await viewChanged(page, nearer);
  near(back.eye, before.eye, 'the eye returns');
  await page.mouse.move(box.x + 10, y);
  await page.mouse.wheel(0, -300);
  const aside = await viewChanged(page, back);
  assert.ok(distance(aside.target, before.target) > 0.1, 'away from the middle the target moves');
}, { glides: true });

mouse('a double click brings a point to the centre', async (page, before, { x, y }) => {
  await page.mouse.dblclick(x - 40, y + 10);
  const after = await viewChanged(page, before);
  assert.ok(distance(after.target, before.target) > 0.05, 'another target');
});

mouse('keys on the image', async (page, before) => {
  await page.focus('#canvas');
  await page.keyboard.press('ArrowRight');
  const turned = await viewChanged(page, before);
  assertTurned(before, turned);
  await page.keyboard.press('Shift+ArrowUp');
  const moved = await viewChanged(page, turned);
  assertMovedAlong(turned, moved);
  await page.keyboard.press('+');
  const nearer = await viewChanged(page, moved);
  assert.ok(reach(nearer) < reach(moved), 'plus is nearer');
  await page.keyboard.press('-');
  assert.ok(reach(await viewChanged(page, nearer)) > reach(nearer), 'minus is farther');
});

mouse('keys that fly, for as long as they are held', async (page, before) => {
  await page.focus('#canvas');
  await page.keyboard.down('w');
  const had = await page.evaluate(() => framesHad);
  await page.waitForFunction((before) => framesHad > before + 3, had, often);
  await page.keyboard.up('w');
  const after = await viewChanged(page, before);
  const ahead = minus(before.target, before.eye), way = minus(after.eye, before.eye);
  const along = way.reduce((sum, value, axis) => sum + value * ahead[axis], 0) / (length(way) * length(ahead));
  assert.ok(along > 0.999, `straight ahead: ${along}`);
  assert.ok(await page.isChecked('input[name=mode][value=fly]'), 'the panel shows the mode');
  near((await view(page)).eye, after.eye, 'it stops afterwards');
});

mouse('digits, F, R and M', async (page, before) => {
  await page.keyboard.press('1');
  const front = await viewChanged(page, before);
  await page.keyboard.press('5');
  const top = await viewChanged(page, front);
  const down = minus(top.target, top.eye);
  assert.ok(-down[2] / length(down) > 0.98, `5 looks from the top: ${down}`);
  await page.keyboard.press('r');
  near((await viewChanged(page, top)).eye, before.eye, 'R is the first view');
  await page.keyboard.press('m');
  assert.ok(await page.isChecked('input[name=mode][value=fly]'));
  await page.keyboard.press('f');
  assert.ok(await page.isChecked('input[name=mode][value=orbit]'), 'F shows all, in orbit mode');
}, { glides: true });

mouse('I turns the scene upside down, and back', async (page, before) => {
  await page.keyboard.press('i');
  const turned = await viewChanged(page, before);
  near(turned.up, before.up.map((value) => -value), 'the up axis');
  await page.keyboard.press('i');
  near((await viewChanged(page, turned)).up, before.up, 'the up axis again');
});

mouse('views, cameras and saved views of the panel', async (page, before) => {
  await page.click('#camera-next');  // the first camera; the example stores another first view
  const camera = await viewChanged(page, before);
  await page.fill('#view-name', 'mine');
  await page.press('#view-name', 'Enter');
  await page.click('#named-views button:text-is("Back")');
  const back = await viewChanged(page, camera);
  await page.click('#saved .go:has-text("mine")');
  near((await viewChanged(page, back)).eye, camera.eye, 'the saved view');
  await page.reload();
  await sceneShown(page, 'soup');
  near((await view(page)).eye, camera.eye, 'a reload keeps the view');
  assert.deepEqual(await page.locator('#saved .go').allTextContents(), ['mine'], 'saved views are kept');
});

mouse('debug views, with legends', async (page) => {
  const colors = await image(page);
  await page.keyboard.press('v');
  await page.waitForFunction(() => location.hash.includes('look='));
  assert.ok(!colors.equals(await image(page)), 'another image');
  await page.evaluate(() => { document.getElementById('debug-view').closest('details').open = true; });
  const looks = await page.locator('#debug-view option').evaluateAll((all) => all.map(({ value, disabled }) => `${value}${disabled}`));
  assert.ok(looks.includes('normalsfalse'), looks.join());
  assert.ok(!looks.some((look) => /opacity|order|true/.test(look)), `none of splats: ${looks}`);
  for (const look of ['depth', 'normals', 'overdraw', 'triangle-id']) {
    await page.selectOption('#debug-view', look);
    await page.waitForFunction((wanted) => location.hash.includes(`look=${wanted}`), look);
  }
  await page.selectOption('#debug-view', 'color');
  await page.waitForFunction(() => !location.hash.includes('look='));
  assert.ok(colors.equals(await image(page)), 'the colours return');
});

testAll('with a mouse and keys', withMouse);

// -- fingers ----------------------------------------------------------------------------------------

const phone = { viewport: { width: 390, height: 700 }, hasTouch: true, isMobile: true };

/** Moves fingers in straight lines: [[from, to], ..], each {x, y}. */
async function swipe(page, lines) {
  const client = await page.context().newCDPSession(page);
  const steps = 6;
  const at = (part) => lines.map(([from, to], id) =>
    ({ id, x: from.x + part * (to.x - from.x), y: from.y + part * (to.y - from.y) }));
  await client.send('Input.dispatchTouchEvent', { type: 'touchStart', touchPoints: at(0) });
  for (let step = 1; step <= steps; ++step)
    await client.send('Input.dispatchTouchEvent', { type: 'touchMove', touchPoints: at(step / steps) });
  await client.send('Input.dispatchTouchEvent', { type: 'touchEnd', touchPoints: [] });
}

fingers('one finger turns', async (page, before, { x, y }) => {
  await swipe(page, [[{ x, y }, { x: x + 80, y }]]);
  assertTurned(before, await viewChanged(page, before));
});

fingers('two fingers pinch, which doubles the scale', async (page, before, { x, y }) => {
  await swipe(page, [[{ x: x - 40, y }, { x: x - 80, y }], [{ x: x + 40, y }, { x: x + 80, y }]]);
  const after = await viewChanged(page, before);
  assert.ok(Math.abs(reach(after) / reach(before) - 0.5) < 0.01, `half the distance: ${reach(after) / reach(before)}`);
  near(after.target, before.target, 'the middle stays');
});

fingers('two fingers move the scene along', async (page, before, { x, y }) => {
  await swipe(page, [[{ x: x - 40, y }, { x: x - 40, y: y + 60 }], [{ x: x + 40, y }, { x: x + 40, y: y + 60 }]]);
  const after = await viewChanged(page, before);
  // Touch events are sent for one finger after the other, so their distance varies on the way.
  assert.ok(Math.abs(reach(after) / reach(before) - 1) < 0.02, 'the distance stays');
  assert.ok(distance(before.target, after.target) > 0.1, 'the target moves');
});

fingers('two taps bring a point to the centre', async (page, before, { x, y }) => {
  await page.touchscreen.tap(x - 30, y);
  await page.touchscreen.tap(x - 30, y);
  const after = await viewChanged(page, before);
  assert.ok(distance(after.target, before.target) > 0.05, 'another target');
}, { glides: true });

testAll('with fingers', withFingers, phone);
