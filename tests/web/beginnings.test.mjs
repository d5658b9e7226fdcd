// The start of the page: without WebGL2, as a single file from the disk, and the time of its first image.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { brotliCompressSync } from 'node:zlib';
import { built, middle, pick, image, programs, sceneShown, scratch, source, stage, still, view, viewChanged } from './support.mjs';

const folder = scratch();
const { visit } = await stage();
const { visit: visitWithout } = await stage({ backend: 'none' });

test('without WebGL2 the page says so', () => visitWithout('?scene=soup.glb', async (page) => {
  await page.locator('[role=alert] h2', { hasText: 'WebGL2' }).waitFor();
  assert.match(await page.textContent('[role=alert]'), /Firefox.*Chrome.*Safari/);
}, { expected: [/WebGL/] }));

test('a page of one file, from the disk', () => {
  const file = join(folder, 'a page & a scene.html');
  execFileSync(join(programs, 'tureen'), ['convert', join(source, 'examples/soup.glb'), file],
               { env: { ...process.env, TUREEN_WEB_TEMPLATE: join(built, 'scene_template.html') }, stdio: 'ignore' });
  return visit(pathToFileURL(file).href, async (page) => {
    await sceneShown(page);
    const before = await image(page);
    const { x, y } = await middle(page);
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 80, y, { steps: 4 });
    await page.mouse.up();
    await still(page);
    assert.ok(!before.equals(await image(page)), 'it rotates');
    await pick(page, join(source, 'examples/soup.glb'));
    await sceneShown(page, 'soup');
    await page.selectOption('#debug-view', 'depth', { force: true });
    await page.locator('#legend').waitFor();
  });
});

test('a template without a scene opens files', () => visit(pathToFileURL(join(built, 'scene_template.html')).href, async (page) => {
  await page.locator('#start').waitFor();
  await pick(page, join(source, 'examples/soup.glb'));
  await sceneShown(page, 'soup');
}));

test('what a browser fetches before the first scene is below 400 KB', () => {
  const size = ['page.js', 'loader_worker.js', 'tureen.js', 'tureen.wasm', 'index.html', 'style.css']
    .reduce((sum, name) => sum + brotliCompressSync(readFileSync(join(built, 'site', name))).length, 0);
  console.log(`engine, scripts and page by brotli: ${size} bytes`);
  assert.ok(size < 400_000, `${size} bytes`);
});

// No time is asserted: other tests and builds share the processor. docs/benchmarks.md has times on an idle one.
test('the first image of the example', () => visit('?scene=soup.glb', async (page) => {
  await sceneShown(page, 'soup');
  const before = await view(page);
  assert.ok(before.eye);
  const ms = await page.evaluate(() => Math.round(performance.now()));
  console.log(`shown at most ${ms} ms after the page was requested`);
}));
