// The page draws the same images as the program. On llvmpipe they are compared with the goldens that `./dev
// golden` approves, with the same bounds; on SwiftShader they must be similar.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { drawingPage, drawingRoutes } from './drawing.mjs';
import { writeMobileNerf } from './mobilenerf_scene.mjs';
import { assertAlike, assertSame } from './images.mjs';
import { readPng, writePng } from './png.mjs';
import { programs, scratch, source, stage } from './support.mjs';

const scenes = scratch();
execFileSync(join(programs, 'make_golden_scenes'), [join(source, 'examples/soup.glb'), scenes]);
writeMobileNerf(join(scenes, 'mobilenerf'));

const golden = (name) => readPng(readFileSync(join(source, 'tests/golden', `${name}.png`)));

const llvmpipe = await stage({ routes: drawingRoutes });
const swiftshader = await stage({ routes: drawingRoutes, backend: 'swiftshader' });
const drawing = ({ visit }, body) => () => visit('drawing.html', async (page) => body(await drawingPage(page)));

const appearances = ['FaceColors', 'VertexColors', 'FaceHarmonics', 'VertexHarmonics',
                     'Lattice', 'LatticeMlp', 'UvTextures', 'UvTexturesMlp'];

for (const name of appearances) {
  test(`${name} on llvmpipe`, drawing(llvmpipe, async ({ load, image }) => {
    await load(scenes, [`${name}.glb`]);
    assertSame(name, golden(name), await image({ from: 0, width: 320, height: 240 }));
  }));
}

test('the example on llvmpipe', drawing(llvmpipe, async ({ load, image }) => {
  await load(join(source, 'examples'), ['soup.glb']);
  assertSame('example', golden('example'), await image({ from: 40, width: 320, height: 240 }));
}));

test('several layers on llvmpipe', drawing(llvmpipe, async ({ load, image }) => {
  await load(scenes, ['layers.glb']);
  assertSame('layers', golden('layers'), await image({ from: 0, width: 320, height: 240 }));
}));

for (const [blend, name] of [['raster', 'splats'], ['tiles', 'splats_in_tiles']]) {
  test(`splats by ${blend} on llvmpipe`, () => llvmpipe.visit(`drawing.html?blend=${blend}`, async (page) => {
    const { load, image } = await drawingPage(page);
    await load(scenes, ['splats.glb']);
    assertSame(name, golden(name), await image({ from: 0, width: 320, height: 240 }));
  }));
}

// The bounds of Layers.AgreeWithTheOracle (tests/runtime/layers_test.cpp): rounding to 8 bits gives 58.9 dB.
test('several layers agree with the oracle on llvmpipe', drawing(llvmpipe, async ({ load, image }) => {
  await load(scenes, ['layers.glb']);
  const files = [];
  for (const level of [0, 1]) {
    const drawn = await image({ from: 0, width: 320, height: 240, background: [level, level, level] });
    files.push(join(scenes, `layers-over-${level}.png`));
    writeFileSync(files[level], writePng(drawn));
  }
  const text = execFileSync(join(programs, 'compare_with_oracle'), [join(scenes, 'layers.glb'), ...files], { encoding: 'utf8' });
  const { psnr_db, p999_abs, coverage_mismatch, compared } = JSON.parse(text);
  console.log(text.trim());
  assert.ok(psnr_db >= 57 && p999_abs <= 1 / 255 && coverage_mismatch < 1e-4 && compared >= 0.05, text);
}));

test('every debug view on llvmpipe', drawing(llvmpipe, async ({ load, image }) => {
  await load(scenes, ['debug_views.glb']);
  for (const look of ['alpha', 'depth', 'features', 'mlp-weight', 'normals', 'overdraw', 'texels', 'triangle-id', 'wireframe', 'holes'])
    assertSame(`debug_view_${look}`, golden(`debug_view_${look}`),
               await image({ from: 0, width: 160, height: 120, look, features: { first: 4, count: 3 } }));
}));

// Exported folders contain no cameras; the program uses the same view.
const radians = Math.PI / 180;
const from = { eye: [1.6, -2.1, 1.2], target: [0.1, 0, 0.05], up: [0, 0, 1], fov: 50 * radians, roll: 0 };
function drawnByProgram(scene) {
  const file = `${scene}-expected.png`;
  const list = (numbers) => numbers.join(',');
  execFileSync(join(programs, 'tureen'), [
    'render', scene, '--context', 'osmesa', '--eye', list(from.eye), '--target', list(from.target), '--up', list(from.up),
    '--fov', String(from.fov / radians), '--size', '320x240', '-o', file]);
  return readPng(readFileSync(file));
}

for (const name of ['diffsoup', 'mobilenerf']) {
  test(`a folder of ${name} on llvmpipe`, drawing(llvmpipe, async ({ load, image }) => {
    const folder = join(scenes, name);
    await load(folder);
    assertSame(name, drawnByProgram(folder), await image({ from, width: 320, height: 240 }));
  }));
}

test('a compressed file on llvmpipe', drawing(llvmpipe, async ({ load, image }) => {
  const compressed = join(scenes, 'compressed.glb');
  execFileSync(join(programs, 'tureen'), ['convert', join(scenes, 'LatticeMlp.glb'), compressed, '--compress'], { stdio: 'ignore' });
  await load(scenes, ['compressed.glb']);
  assertSame('compressed', drawnByProgram(compressed), await image({ from, width: 320, height: 240 }));
}));

// SwiftShader rounds vertex positions and barycentrics differently, so pixels at edges may show the other side.
// With triangles of a few pixels that is 32 to 42 dB. A wrong appearance, a mirrored axis or a shifted lattice
// is below 25.
for (const name of appearances) {
  test(`${name} on SwiftShader`, drawing(swiftshader, async ({ load, image }) => {
    await load(scenes, [`${name}.glb`]);
    assertAlike(`${name}-swiftshader`, golden(name), await image({ from: 0, width: 320, height: 240 }), 30);
  }));
}

test('the example on SwiftShader', drawing(swiftshader, async ({ load, image }) => {
  await load(join(source, 'examples'), ['soup.glb']);
  assertAlike('example-swiftshader', golden('example'), await image({ from: 40, width: 320, height: 240 }), 30);
}));
