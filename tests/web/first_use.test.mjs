// A first-time user's steps in the page: photographs, the way back to the first view, a phone.

import assert from 'node:assert/strict';
import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { errorShown, pick, sceneShown, scratch, source, stage, still, test, view } from './support.mjs';

const { visit } = await stage();

const phone = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };

const photograph = Buffer.from('\xFF\xD8\xFF\xE0 of a fox', 'latin1');
const dataset = join(scratch(), 'fox');
mkdirSync(join(dataset, 'images'), { recursive: true });
writeFileSync(join(dataset, 'images/0001.jpg'), photograph);

test('R restores the up axis, and the panel its reason', () => visit('?scene=soup.glb', async (page) => {
  await sceneShown(page, 'soup');
  const state = async () => ({ up: (await view(page)).up, menu: await page.inputValue('#up'), reason: await page.textContent('#up-reason') });
  const before = await state();
  assert.notEqual(before.reason, '');
  for (const keys of ['u', 'i', 'ui']) {
    for (const key of keys) await page.keyboard.press(key);
    const changed = await state();
    assert.notDeepEqual(changed.up, before.up, keys);
    assert.equal(changed.reason, '', 'the reason applies to another axis');
    await page.keyboard.press('r');
    assert.deepEqual(await state(), before, keys);
  }
}, { viewport: { width: 1100, height: 700 } }));

test('an upright phone shows the whole width of the first view, also when it is turned', () => visit('?scene=soup.glb', async (page) => {
  await sceneShown(page, 'soup');
  const angles = async () => {
    await still(page);
    const { width, height } = await page.locator('#canvas').boundingBox();
    const vertical = Number(await page.inputValue('#fov')), tangent = Math.tan(vertical * Math.PI / 360);
    return { upright: width < height, vertical, horizontal: 360 / Math.PI * Math.atan(tangent * width / height) };
  };
  // examples/first_view.json: 1280x720 pixels
  const stored = (pixels) => 2 * Math.atan(pixels / 2 / 1343.538) * 180 / Math.PI;
  const near = (angle, wanted) => assert.ok(Math.abs(angle - wanted) < 1, `${angle} and ${wanted} degrees`);
  for (const [width, height] of [[390, 844], [844, 390], [320, 700]]) {
    await page.setViewportSize({ width, height });
    const { upright, vertical, horizontal } = await angles();
    assert.equal(upright, width < height);
    near(upright ? horizontal : vertical, stored(upright ? 1280 : 720));
  }
}, phone));

test('the page names the program that opens photographs', () => visit('', async (page) => {
  await pick(page, { name: '0001.jpg', mimeType: 'image/jpeg', buffer: photograph });
  assert.match(await errorShown(page), /0001\.jpg.*image.*tureen view FOLDER/);
  await page.click('#errors button');
  await pick(page, dataset, '#choose-folder');
  assert.match(await errorShown(page), /tureen view FOLDER/);
  await pick(page, { name: 'notes.glb', mimeType: 'model/gltf-binary', buffer: Buffer.from('no scene') });
  await page.locator('#errors .message', { hasText: 'notes.glb' }).waitFor();
  assert.doesNotMatch(await errorShown(page), /photographs/);
}));

test('the link of a local file names the way to send the scene', () => visit('', async (page) => {
  await pick(page, join(source, 'examples/soup.glb'));
  await sceneShown(page, 'soup');
  assert.match(await page.textContent('#link-hint'), /only the camera.*tureen convert SCENE scene\.html/);
}));

test('at most three messages are shown, and an error until a scene is opened', () => visit('?scene=soup.glb', async (page) => {
  await sceneShown(page, 'soup');
  const messages = () => page.locator('.message p').allTextContents();
  for (const key of 'uuuuu') await page.keyboard.press(key);
  assert.equal((await messages()).length, 3);
  await pick(page, { name: 'bad.glb', mimeType: 'model/gltf-binary', buffer: Buffer.from('no scene') });
  const error = await errorShown(page);
  assert.equal((await messages()).length, 3);
  for (const key of 'iuuuu') await page.keyboard.press(key);
  const shown = await messages();
  assert.equal(shown.length, 3);
  assert.ok(shown.includes(error), 'the error stays');
  assert.match(shown.at(-1), /up axis/, 'the last notice');
  await pick(page, join(source, 'examples/soup.glb'));
  await page.locator('#errors .message').waitFor({ state: 'detached' });
}));

test('a phone saves images from the bar, and its help begins with touch', () => visit('?scene=soup.glb', async (page) => {
  await sceneShown(page, 'soup');
  const download = page.waitForEvent('download');
  await page.tap('#quick-image');
  assert.equal((await download).suggestedFilename(), 'soup.png');
  await page.setViewportSize({ width: 320, height: 568 });
  assert.equal(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), true, 'the bar fits');
  await page.tap('#open-help');
  assert.equal(await page.textContent('#help-tables h3'), 'Touch');
}, phone));

for (const [where, how] of [['a wide page', {}], ['a phone', phone]])
  test(`the gallery opens the example from its corner, on ${where}`, () => visit('', async (page) => {
    await page.click('#gallery-list button');
    await sceneShown(page, 'soup');
    const opened = await view(page);
    await page.keyboard.press('7');  // the same view, by the page's keys
    await still(page);
    const corner = await view(page);
    for (const axis of [0, 1, 2]) assert.ok(Math.abs(opened.eye[axis] - corner.eye[axis]) < 1e-3, `${opened.hash} and ${corner.hash}`);
  }, how));
