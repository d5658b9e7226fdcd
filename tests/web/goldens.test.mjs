// The page draws the same images as the program. On llvmpipe they are compared with the goldens that `./dev
// golden` approves, with the same bounds; on SwiftShader they must be similar.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { drawingPage, drawingRoutes } from './drawing.mjs';
import { writeMobileNerf } from './mobilenerf_scene.mjs';
import { assertAlike, assertSame } from './images.mjs';
import { readPng, writePng } from './png.mjs';
import { goldenScenes } from './scenes.mjs';
import { each, programs, source, stage, test, thorough } from './support.mjs';

const scenes = goldenScenes();
writeMobileNerf(join(scenes, 'mobilenerf'));

const golden = (name) => readPng(readFileSync(join(source, 'tests/golden', `${name}.png`)));

const llvmpipe = await stage({ routes: drawingRoutes });
const swiftshader = await stage({ routes: drawingRoutes, backend: 'swiftshader' });

/** Draws all images of `tests`, [[name, body], ..], on one page. */
const drawing = ({ visit }, tests) => (context) => visit('drawing.html', async (page) => each(context, tests, await drawingPage(page)));

const appearances = ['FaceColors', 'VertexColors', 'FaceHarmonics', 'VertexHarmonics',
                     'Lattice', 'LatticeMlp', 'UvTextures', 'UvTexturesMlp'];

/** Compares the scene's image from a recorded camera with its golden. */
const likeGolden = (compare, name, folder, file, from) => async ({ load, image }) => {
  await load(folder, [file]);
  compare(name, golden(name), await image({ from, width: 320, height: 240 }));
};
const same = (...given) => likeGolden(assertSame, ...given);

const onLlvmpipe = [
  ...appearances.map((name) => [name, same(name, scenes, `${name}.glb`, 0)]),
  ['the example', same('example', join(source, 'examples'), 'soup.glb', 40)],
  ['several layers', same('layers', scenes, 'layers.glb', 0)],
];

// The bounds of Layers.AgreeWithTheOracle (tests/runtime/layers_test.cpp): rounding to 8 bits gives 58.9 dB.
onLlvmpipe.push(['several layers agree with the oracle', async ({ load, image }) => {
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
}]);

onLlvmpipe.push(['every debug view', async ({ load, image }) => {
  await load(scenes, ['debug_views.glb']);
  for (const look of ['alpha', 'depth', 'features', 'mlp-weight', 'normals', 'overdraw', 'texels', 'triangle-id', 'wireframe', 'holes'])
    assertSame(`debug_view_${look}`, golden(`debug_view_${look}`),
               await image({ from: 0, width: 160, height: 120, look, features: { first: 4, count: 3 } }));
}]);

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

for (const name of ['diffsoup', 'mobilenerf'])
  onLlvmpipe.push([`a folder of ${name}`, async ({ load, image }) => {
    const folder = join(scenes, name);
    await load(folder);
    assertSame(name, drawnByProgram(folder), await image({ from, width: 320, height: 240 }));
  }]);

onLlvmpipe.push(['a compressed file', async ({ load, image }) => {
  const compressed = join(scenes, 'compressed.glb');
  // A large error, since a search for a small one takes longer.
  execFileSync(join(programs, 'tureen'), ['convert', join(scenes, 'LatticeMlp.glb'), compressed, '--compress', '--max-error', '5'],
               { stdio: 'ignore' });
  await load(scenes, ['compressed.glb']);
  assertSame('compressed', drawnByProgram(compressed), await image({ from, width: 320, height: 240 }));
}]);

test('on llvmpipe', drawing(llvmpipe, onLlvmpipe));

for (const [blend, name] of [['raster', 'splats'], ['tiles', 'splats_in_tiles']])
  test(`splats by ${blend} on llvmpipe`, () => llvmpipe.visit(`drawing.html?blend=${blend}`, async (page) =>
    same(name, scenes, 'splats.glb', 0)(await drawingPage(page))));

// SwiftShader rounds vertex positions and barycentrics differently, so pixels at edges may show the other side.
// With triangles of a few pixels that is 32 to 42 dB. A wrong appearance, a mirrored axis or a shifted lattice
// is below 25.
const alike = (name, ...given) =>
  likeGolden((drawn, expected, actual) => assertAlike(`${drawn}-swiftshader`, expected, actual, 30), name, ...given);
const example = ['the example', alike('example', join(source, 'examples'), 'soup.glb', 40)];
test('on SwiftShader', drawing(swiftshader, [example]));
thorough('each appearance on SwiftShader', drawing(swiftshader, appearances.map((name) => [name, alike(name, scenes, `${name}.glb`, 0)])));
