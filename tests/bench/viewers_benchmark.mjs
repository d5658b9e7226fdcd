// Tureen's viewer and three viewers of Gaussians from npm in Chromium, on both rasterisers that need no GPU: the times
// of frames while the camera moves, the time until the first whole image, and the PSNR of the images.
//
//   node viewers_benchmark.mjs OUT SCENE.ply [--views FILE] [--quick] [--only-first]
//
// --only-first: only the time until the first image, from more visits.
// --views: the cameras, by default those of the guitar (tests/bench/viewers/guitar_views.json); `./dev bench` uses
// SCENE.views.json if it exists. Writes the images to OUT, and rows as lines of JSON to standard output.

import { execFileSync } from 'node:child_process';
import { copyFileSync, existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { parseArgs } from 'node:util';
import { build } from '../../web/node_modules/esbuild/lib/main.js';
import { serve } from '../../web/serve.mjs';
import { built, launch, programs, source } from '../web/browser.mjs';
import { writePng } from '../web/png.mjs';

const sources = join(source, 'tests/bench/viewers');
const { positionals: [out, scene], values: { views: viewsFile, quick, 'only-first': onlyFirst } } = parseArgs({
  allowPositionals: true,
  options: {
    quick: { type: 'boolean', default: false },
    'only-first': { type: 'boolean', default: false },
    views: { type: 'string', default: join(sources, 'guitar_views.json') },
  },
});
if (!out || !scene) {
  console.error('use: viewers_benchmark.mjs OUT SCENE.ply [--views FILE] [--quick] [--only-first]');
  process.exit(2);
}

const [width, height] = quick ? [160, 90] : [1280, 720];
/** Visits of each case. */
const rounds = quick ? 1 : onlyFirst ? 5 : 2;
/** Of one view in one round. Slow viewers draw fewer frames. */
const motion = quick ? { frames: 2, minFrames: 1, maxMs: 1 } : { frames: 8, minFrames: 3, maxMs: 3000 };
/** Time limit of a step in the page, ms. */
const patience = 180_000;
/** A busy machine must neither lose the context nor slow down timers. */
const flags = ['--disable-gpu-watchdog', '--disable-background-timer-throttling', '--disable-renderer-backgrounding'];

/** Deviations of the kernels from 3DGS, as options of splat_reference (tests/bench/splat_reference.cpp). */
const faint = ['--min-alpha=0.00196', '--max-alpha=1'], cut = ['--cut=8', ...faint], clamped = [...cut, '--clamp-colors'];
/** `rules`: those of the viewer's own kernel. */
const cases = [
  { name: 'Tureen, raster', viewer: 'tureen', options: { blend: 'raster' }, rules: [] },
  { name: 'Tureen, tiles', viewer: 'tureen', options: { blend: 'tiles' }, rules: [] },
  { name: 'PlayCanvas', viewer: 'playcanvas', rules: ['--quarter-dilation', '--renormalised', '--cut=8', '--min-width=1', '--max-alpha=1'] },
  { name: 'Babylon.js', viewer: 'babylon', rules: ['--quarter-dilation', ...clamped] },
  { name: 'Spark', viewer: 'spark', rules: ['--mip', '--radial', ...clamped] },
  { name: 'Spark, as 3DGS', viewer: 'spark', options: { exact: true }, rules: ['--max-alpha=1'] },
];

const median = (values) => {
  const sorted = [...values].sort((a, b) => a - b), half = sorted.length >> 1;
  return sorted.length % 2 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2;
};

const { views, ...lens } = JSON.parse(readFileSync(viewsFile, 'utf8'));
const cameras = Object.fromEntries(Object.entries(views).map(([name, view]) => [name, { ...view, ...lens }]));

/** Installs the viewers into their own folder. */
function install() {
  const lock = join(sources, 'package-lock.json'), installed = join(sources, 'node_modules/.installed-lock.json');
  if (existsSync(installed) && readFileSync(installed).equals(readFileSync(lock))) return;
  console.error('Installing the viewers');
  // Babylon.js' loaders ask for a package of types that only other loaders use.
  execFileSync('npm', ['ci', '--legacy-peer-deps', '--ignore-scripts', '--no-audit', '--no-fund'],
               { cwd: sources, stdio: ['ignore', 'ignore', 'inherit'] });
  copyFileSync(lock, installed);
}

/** A folder with the page, the viewers and the scene. */
async function makeSite() {
  const folder = join(out, 'site');
  mkdirSync(folder, { recursive: true });
  await build({
    entryPoints: ['page', ...new Set(cases.map(({ viewer }) => viewer))].map((name) => join(sources, `${name}.js`)),
    outdir: join(folder, 'viewers'), bundle: true, minify: true, format: 'esm', target: 'es2022', logLevel: 'warning',
    external: ['/tureen/viewer.js'], loader: { '.wasm': 'binary' },
  });
  copyFileSync(join(sources, 'index.html'), join(folder, 'viewers/index.html'));
  mkdirSync(join(folder, 'tureen'), { recursive: true });
  for (const name of ['viewer.js', 'tureen.js', 'tureen.wasm', 'loader_worker.js'])
    copyFileSync(join(built, 'site', name), join(folder, 'tureen', name));
  copyFileSync(scene, join(folder, 'scene.ply'));
  return folder;
}

/** The image of a view in double precision: red, green, blue and transmittance of each pixel, rows from the top. */
function reference(name, rules) {
  const { eye, target, up, fov } = cameras[name], file = join(out, 'reference.bin');
  execFileSync(join(programs, 'splat_reference'), [
    scene, file, `--eye=${eye}`, `--target=${target}`, `--up=${up}`, `--fov=${fov}`, `--width=${width}`, `--height=${height}`, ...rules,
  ], { stdio: ['ignore', 'ignore', 'inherit'] });
  const bytes = readFileSync(file);
  return new Float32Array(bytes.buffer, bytes.byteOffset, 4 * width * height);
}

/** PSNR in dB of RGBA bytes, over the pixels of the reference for which `isIn` holds. */
function psnr(pixels, expected, isIn = () => true) {
  let squares = 0, values = 0;
  for (let at = 0; at < pixels.length; at += 4) {
    if (!isIn(at)) continue;
    for (let c = at; c < at + 3; ++c) squares += (pixels[c] / 255 - Math.min(expected[c], 1)) ** 2;
    values += 3;
  }
  return -10 * Math.log10(squares / values);
}

/** The rows of pixels in reverse order. */
function upsideDown(pixels) {
  const rows = Array.from({ length: height }, (_, y) => pixels.subarray(4 * width * y, 4 * width * (y + 1)));
  return Buffer.concat(rows.reverse());
}

/** One visit in a fresh browser: times, and the images if `wantsImages`. */
async function visit(rasteriser, { viewer, options = {} }, address, wantsImages) {
  const browser = await launch(rasteriser, flags);
  try {
    const page = await browser.newPage({ viewport: { width, height } });
    page.setDefaultTimeout(patience);
    page.on('pageerror', (error) => console.error(`${viewer}: ${error.message}`));
    await page.addInitScript((settings) => { window.settings = settings; },
                             { viewer, options, width, height, url: '/scene.ply', camera: Object.values(cameras)[0] });
    await page.goto(address);
    const late = new Promise((_, reject) => setTimeout(reject, 4 * patience, new Error('no answer')).unref());
    late.catch(() => {});  // it may reject after an error of the page
    const call = (method, ...given) => Promise.race([late, page.evaluate(
      async ([name, args]) => (await window.bench)[name](...args), [method, given])]);
    const firstImageMs = await Promise.race([late, page.evaluate(async () => (await window.bench).firstImageMs)]);
    const moved = {}, images = {};
    if (onlyFirst) return { firstImageMs, moved, images };
    for (const [name, camera] of Object.entries(cameras)) moved[name] = await call('move', camera, motion);
    if (wantsImages)
      for (const [name, camera] of Object.entries(cameras))
        images[name] = upsideDown(Buffer.from(await call('image', camera), 'base64'));
    return { firstImageMs, moved, images };
  } finally {
    await browser.close();
  }
}

/** Visits of every case in turn (A B C A B C), so that load on the machine affects all of them. */
async function measure(address) {
  const visits = new Map();
  for (let round = 0; round < rounds; ++round)
    for (const rasteriser of ['llvmpipe', 'swiftshader'])
      for (const each of cases) {
        const key = `${each.name} on ${rasteriser}`;
        visits.has(key) || visits.set(key, { rasteriser, each, done: [] });
        // A browser may crash, or lose the context on a busy machine.
        for (let attempt = 0; attempt < 2; ++attempt)
          try {
            const result = await visit(rasteriser, each, address, visits.get(key).done.length === 0);
            const frames = Object.entries(result.moved).map(([name, { ms }]) => `, ${name} ${median(ms).toFixed(0)}`);
            console.error(`${round} ${key}: first ${result.firstImageMs.toFixed(0)}${frames.join('')}`);
            visits.get(key).done.push(result);
            break;
          } catch (error) {
            console.error(`${round} ${key}: ${error.message}`);
          }
      }
  return [...visits.values()];
}

/** A row for each view. */
function rows({ rasteriser, each, done }, references) {
  if (done.length === 0) return [{ rasteriser, viewer: each.name, view: 'failed' }];
  const firstImage = median(done.map(({ firstImageMs }) => firstImageMs));
  if (onlyFirst) return [{ rasteriser, viewer: each.name, first_image_ms: firstImage }];
  return Object.keys(cameras).map((view) => {
    const image = done[0].images[view], { exact, own } = references(view, each.rules);
    writeFileSync(join(out, `${rasteriser}-${each.name.replace(/\W+/g, '_')}-${view}.png`),
                  writePng({ width, height, pixels: image.map((value, at) => (at % 4 === 3 ? 255 : value)) }));
    const moved = done.map((result) => result.moved[view]), medians = moved.map(({ ms }) => median(ms));
    return {
      rasteriser, viewer: each.name, view,
      frame_ms: median(moved.flatMap(({ ms }) => ms)),
      spread: Math.max(...medians) / Math.min(...medians) - 1,
      orders: median(moved.map(({ orders }) => orders)),
      first_image_ms: firstImage,
      psnr_db: psnr(image, exact),
      object_psnr_db: psnr(image, exact, (at) => exact[at + 3] < 0.999),
      own_psnr_db: psnr(image, own),
    };
  });
}

install();
const server = await serve(await makeSite());
try {
  const measured = await measure(`${server.address}viewers/`);
  const drawn = new Map();
  const image = (view, rules) => {
    const key = [view, ...rules].join(' ');
    drawn.has(key) || drawn.set(key, reference(view, rules));
    return drawn.get(key);
  };
  const references = (view, rules) => ({ exact: image(view, []), own: image(view, rules) });
  for (const each of measured) for (const row of rows(each, references)) console.log(JSON.stringify(row));
} finally {
  await server.close();
}
