// The start of the page: without WebGL2, as a single file from the disk, and the time of its first image.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { assertAlike } from './images.mjs';
import { readPng } from './png.mjs';
import {
  built, image, middle, pick, programs, sceneShown, scratch, source, stage, still, test, view, viewChanged,
} from './support.mjs';

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

/** A PLY file as 3DGS writes it, with Gaussians on a spiral. */
function spiralOfSplats(number) {
  const names = ['x', 'y', 'z', 'f_dc_0', 'f_dc_1', 'f_dc_2', 'opacity', 'scale_0', 'scale_1', 'scale_2', 'rot_0', 'rot_1', 'rot_2', 'rot_3'];
  const header = ['ply', 'format binary_little_endian 1.0', `element vertex ${number}`,
                  ...names.map((name) => `property float ${name}`), 'end_header', ''].join('\n');
  const values = Array.from({ length: number }, (_, i) => {
    const angle = 0.2 * i, color = [0, 2, 4].map((phase) => Math.cos(angle + phase));
    const scales = [0.3, 0.1, 0.05].map(Math.log);  // the opacity is a logit
    return [Math.cos(angle), 0.01 * i - 1, Math.sin(angle), ...color, 1, ...scales, Math.cos(angle), 0, Math.sin(angle), 0.5];
  });
  return Buffer.concat([Buffer.from(header), Buffer.from(new Float32Array(values.flat()).buffer)]);
}

/** An image without its outermost pixels: the page rounds the canvas's corners. */
function inner({ width, height, pixels }, by = 24) {
  const row = (y) => pixels.subarray(4 * (y * width + by), 4 * ((y + 1) * width - by));
  const rows = Array.from({ length: height - 2 * by }, (_, y) => row(y + by));
  return { width: width - 2 * by, height: rows.length, pixels: Buffer.concat(rows) };
}

test('a page of one file with splats shows what the program draws', () => {
  const scene = join(folder, 'splats.ply'), file = join(folder, 'splats.html'), drawn = join(folder, 'splats.png');
  writeFileSync(scene, spiralOfSplats(200));
  const run = (...words) => execFileSync(join(programs, 'tureen'), words,
    { env: { ...process.env, TUREEN_WEB_TEMPLATE: join(built, 'scene_template.html') }, stdio: 'ignore' });
  run('convert', scene, file);
  return visit(pathToFileURL(file).href, async (page) => {
    await sceneShown(page);
    const { x, y, box } = await middle(page);
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 80, y - 40, { steps: 4 });
    await page.mouse.up();
    const { eye, target, up, fov } = await view(page);
    const shown = readPng(await image(page));
    run('render', scene, '-o', drawn, '--size', `${shown.width}x${shown.height}`, '--eye', eye.join(), '--target', target.join(),
        '--up', up.join(), '--fov', `${fov}`);
    assert.equal(shown.width, box.width);
    // The camera in the address has few digits. A missing or wrongly ordered splat costs far more.
    assertAlike('splats-page', inner(readPng(readFileSync(drawn))), inner(shown), 50);
  });
});

test('a template without a scene opens files', () => visit(pathToFileURL(join(built, 'scene_template.html')).href, async (page) => {
  await page.locator('#start').waitFor();
  await pick(page, join(source, 'examples/soup.glb'));
  await sceneShown(page, 'soup');
}));

// No time is asserted: other tests and builds share the processor. docs/benchmarks.md has times on an idle one.
test('the first image of the example', () => visit('?scene=soup.glb', async (page) => {
  await sceneShown(page, 'soup');
  const before = await view(page);
  assert.ok(before.eye);
  const ms = await page.evaluate(() => Math.round(performance.now()));
  console.log(`shown at most ${ms} ms after the page was requested`);
}));
