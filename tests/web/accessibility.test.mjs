// axe-core finds no violations in any part of the page, in light and dark, on wide screens and phones. Also
// tests what axe-core cannot: the keyboard alone is enough.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { errorShown, pick, sceneShown, source, stage, test, thorough, view, viewChanged } from './support.mjs';

const axe = readFileSync(join(source, 'web/node_modules/axe-core/axe.min.js'), 'utf8');
const { visit } = await stage();

async function assertAccessible(page, where) {
  await page.evaluate(`${axe}; 0`);  // the page's policy forbids an added script element
  const violations = await page.evaluate(async () => (await window.axe.run()).violations.map(({ id, help, nodes }) =>
    `${id}: ${help}: ${nodes.map(({ html, failureSummary }) => `${html} ${failureSummary}`).join('; ')}`));
  assert.deepEqual(violations, [], where);
}

/** Visits each part of the page. */
async function walk(page) {
  await page.locator('#gallery-list button').waitFor();
  await assertAccessible(page, 'the start');
  await page.click('#gallery-list button');
  await sceneShown(page, 'soup');
  await assertAccessible(page, 'a scene');
  if (await page.isHidden('#panel')) await page.click('#toggle-panel');
  await page.evaluate(() => { for (const section of document.querySelectorAll('details')) section.open = true; });
  await page.selectOption('#debug-view', 'depth');
  await page.locator('#legend').waitFor();
  await page.fill('#view-name', 'mine');
  await page.press('#view-name', 'Enter');
  await assertAccessible(page, 'the panel, all of it, with a legend and a notice');
  await page.click('#toggle-panel');
  await page.click('#open-help');
  await assertAccessible(page, 'the help');
  await page.keyboard.press('Escape');
  await pick(page, { name: 'bad.glb', mimeType: 'model/gltf-binary', buffer: Buffer.from('glTF, or not') });
  await errorShown(page);
  await page.click('#open-start');
  await assertAccessible(page, 'an error, and the start over a scene');
}

const phone = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };
const desktop = (height) => ({ viewport: { width: 1100, height } });
test('light', () => visit('', walk, { ...desktop(700), colorScheme: 'light' }));
thorough('dark, on a phone', () => visit('', walk, { ...phone, colorScheme: 'dark' }));
thorough('dark', () => visit('', walk, { ...desktop(700), colorScheme: 'dark' }));
thorough('light, on a phone', () => visit('', walk, { ...phone, colorScheme: 'light' }));

const listOfLayers = (how) => () => visit('?scene=soup.glb&scene=soup.glb', async (page) => {
  await page.waitForFunction(() => document.querySelectorAll('#layers li').length === 2 && document.getElementById('loading').hidden);
  if (await page.isHidden('#panel')) await page.click('#toggle-panel');
  await page.click('#layers .go:has-text("soup 2")');
  for (const box of ['uncheck', 'check']) await page[box]('[aria-label="Show soup 2"]');
  await page.keyboard.press('Control+z');
  await page.locator('#steps .undone').waitFor();
  await assertAccessible(page, 'layers, and steps with an undone one');
  assert.equal(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), true, 'the panel fits');
}, how);
test('a list of layers, on a phone', listOfLayers({ ...phone, colorScheme: 'dark' }));
thorough('a list of layers', listOfLayers(desktop(1200)));

test('in a frame', () => visit('?embed', async (page) => {
  await assertAccessible(page, 'embedded');
}));

test('a scene is opened, looked at and left with the keyboard alone', () => visit('', async (page) => {
  const focused = () => page.evaluate(() => document.activeElement.id || document.activeElement.className);
  const tabTo = async (wanted) => {
    for (let i = 0; i < 60; ++i) {
      if (await focused() === wanted) return;
      await page.keyboard.press('Tab');
    }
    assert.fail(`Tab does not get to ${wanted}`);
  };
  await page.locator('#gallery-list button').waitFor();
  await tabTo('card');
  await page.keyboard.press('Enter');
  await sceneShown(page, 'soup');
  await tabTo('canvas');
  const before = await view(page);
  await page.keyboard.press('ArrowLeft');
  await viewChanged(page, before);
  await tabTo('frame');
  await page.keyboard.press('Shift+?');
  await page.locator('dialog[open]').waitFor();
  await page.keyboard.press('Escape');
  assert.equal(await focused(), 'frame', 'the focus is restored');
  await page.keyboard.press('o');
  assert.equal(await focused(), 'start-title');
  await page.keyboard.press('Escape');
  assert.ok(await page.isHidden('#start'));
}));

test('less motion, for who asks for it', () => visit('?scene=soup.glb', async (page) => {
  await sceneShown(page, 'soup');
  const before = await view(page);
  const frames = await page.evaluate(async () => {
    const before = framesHad;
    document.querySelector('#named-views button').click();
    await still();
    return framesHad - before;
  });
  assert.ok(frames <= 2, `the view changes at once, in ${frames} frames`);
  assert.notEqual((await view(page)).hash, before.hash);
}, { reducedMotion: 'reduce' }));
