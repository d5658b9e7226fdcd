// What a first-time user does with the page: the way back to the first view.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { sceneShown, stage, view } from './support.mjs';

const { visit } = await stage();

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
