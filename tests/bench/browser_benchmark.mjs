// Frame times of bench.html in Chromium, compared with the baseline in the same page, on both rasterisers
// that need no GPU; the memory of a scene; and the time until the first image.
//
//   node browser_benchmark.mjs OUT SCENE.. [--quick] [--openings | --planning]
//
// --openings: only the time until the first image and until the whole scene. --planning: only the time of the plan, the
// first one of an engine and a later one, and that of the program.
// Writes OUT/SCENE-RASTERISER.json for `tureen report`, and everything else as lines of JSON on standard
// output.

import { execFileSync } from 'node:child_process';
import { copyFileSync, mkdirSync, mkdtempSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, extname, join } from 'node:path';
import { parseArgs } from 'node:util';
import { serve } from '../../web/serve.mjs';
import { built, launch, programs } from '../web/browser.mjs';

const { positionals: [out, ...scenes], values: { quick, openings: onlyOpenings, planning: onlyPlanning } } = parseArgs({
  allowPositionals: true,
  options: { quick: { type: 'boolean', default: false }, openings: { type: 'boolean', default: false },
    planning: { type: 'boolean', default: false } },
});
if (!out || scenes.length === 0) {
  console.error('use: browser_benchmark.mjs OUT SCENE.. [--quick] [--openings | --planning]');
  process.exit(2);
}

const size = quick ? '160x90' : '1280x720', rounds = quick ? 1 : 5, openings = quick ? 1 : 7;
/** Time limit of one page, ms. The baseline takes half a second per frame on two cores. */
const patience = 20 * 60_000;
/** Pause before a visit, ms. Opening a window with its spare processes, and closing the previous one, take
 *  half a second each on two cores; visits must begin with an idle browser. */
const restMs = 2000;

const median = (values) => [...values].sort((a, b) => a - b)[values.length >> 1];

async function inPage(browser, address, body) {
  const profile = await browser.newContext({ viewport: { width: 1280, height: 720 } });
  profile.setDefaultTimeout(patience);
  try {
    const page = await profile.newPage();
    return await body(page, () => page.goto(address));
  } finally {
    await profile.close();
  }
}

/** The result of bench.html, started by a link. */
const measured = (browser, site, query) => inPage(browser, `${site}bench.html?${query}&run=1`, async (page, open) => {
  await open();
  return page.evaluate(() => window.tureenBench);
});

/** Milliseconds from the beginning of the visit to the first image on the screen, and to the whole scene,
 *  in an empty profile. The page itself takes the times, because polling would make it draw. */
const opened = (browser, site, scene) => inPage(browser, `${site}?${scene}`, async (page, open) => {
  await page.addInitScript(() => {
    const images = {};
    for (const which of ['first', 'whole'])
      images[which] = new Promise((resolve) => { images[`${which}IsThere`] = resolve; });
    // The frame after next begins when this one has been drawn. Its callback gets the time of its beginning: the page may
    // smooth the image before.
    const drawn = (tell) => requestAnimationFrame(() => requestAnimationFrame(tell));
    new MutationObserver(() => {
      const { body } = document, loading = document.getElementById('loading');
      if (!body || !loading || body.classList.contains('empty')) return;
      drawn(images.firstIsThere);
      if (loading.hidden) drawn(images.wholeIsThere);
    }).observe(document, { subtree: true, childList: true, attributes: true });
    window.images = images;
  });
  await page.waitForTimeout(restMs);
  await open();
  return page.evaluate(async () => ({ first: await window.images.first, whole: await window.images.whole }));
});

/** A folder with only the site and the scenes. */
function siteWith() {
  const folder = mkdtempSync(join(tmpdir(), 'tureen-site-'));
  for (const name of readdirSync(join(built, 'site')))
    if (extname(name)) copyFileSync(join(built, 'site', name), join(folder, name));
  for (const scene of scenes) copyFileSync(scene, join(folder, basename(scene)));
  return folder;
}

/** Frame times, also of the baseline, with the scene's cameras if it has any. */
function frames(browser, site, path, scene) {
  const info = execFileSync(join(programs, 'tureen'), ['info', path, '--json'], { stdio: ['ignore', 'pipe', 'ignore'] });
  const set = JSON.parse(info).cameras.length > 0 ? 'recorded' : 'hemisphere';
  return measured(browser, site, `${scene}&published=1&set=${set}:8&size=${size}&rounds=${rounds}`);
}

/** The memory of the scene alone. */
async function memory(browser, site, scene) {
  const { scenes: [alone] } = await measured(browser, site, `${scene}&published=0&set=hemisphere:1&size=16x16&rounds=1`);
  return { device: alone.configurations[0].device_bytes, wasm: alone.wasm_bytes };
}

async function openingTimes(browser, site, scene) {
  const times = [];
  for (let i = 0; i < openings; ++i) times.push(await opened(browser, site, scene));
  return { first: median(times.map(({ first }) => first)), whole: median(times.map(({ whole }) => whole)) };
}

/** Milliseconds of the plan: of a new engine in an idle page of a new browser, later, and natively. */
async function planningTimes(site, path) {
  const times = { first: [], later: [], native: [] };
  for (let i = 0; i < openings; ++i) {
    const browser = await launch('llvmpipe');
    try {
      const [first, ...others] = await inPage(browser, `${site}bench.html`, async (page, open) => {
        await open();
        return page.evaluate(async (name) => {
          const { default: create } = await import('/tureen.js');
          const program = await WebAssembly.compile(await (await fetch('/tureen.wasm')).arrayBuffer());
          const engine = await create({
            instantiateWasm: (imports, done) => {
              WebAssembly.instantiate(program, imports).then((instance) => done(instance, program));
              return {};
            },
          });
          const call = (command, given) => {
            const json = new TextEncoder().encode(JSON.stringify(given));
            engine.HEAPU8.set(json, engine.ccall('tureen_arguments', 'number', ['number'], [json.length]));
            return JSON.parse(engine.ccall('tureen_call', 'string', ['string'], [command])).result;
          };
          engine.FS.mkdir('/scene');
          engine.FS.writeFile(`/scene/${name}`, new Uint8Array(await (await fetch(`/${name}`)).arrayBuffer()), { canOwn: true });
          call('read', { folder: '/scene', paths: [name], memory: 2 ** 40 });
          const limits = { max_texture_size: 8192, max_array_layers: 2048, clip_control: false, compute_shaders: false, software: true, blend: 'auto' };
          return Array.from({ length: 5 }, () => {
            const begin = performance.now();
            call('prepare', { limits });
            return performance.now() - begin;
          });
        }, basename(path));
      });
      times.first.push(first);
      times.later.push(median(others));
    } finally {
      await browser.close();
    }
    const bench = execFileSync(join(programs, 'tureen'), ['bench', path, '--size', '64x64', '--json'], { stdio: ['ignore', 'pipe', 'ignore'] });
    times.native.push(JSON.parse(bench).load.plan_ms);
  }
  return { first: median(times.first), later: median(times.later), native: median(times.native) };
}

/** Measures a scene on a rasteriser: writes its file for `tureen report`, and its row. */
async function measureScene(browser, site, rasteriser, path) {
  const name = basename(path, extname(path)), file = encodeURIComponent(basename(path));
  console.error(`${name} on ${rasteriser}`);
  if (onlyOpenings) {
    const { first, whole } = await openingTimes(browser, site, `scene=${file}`);
    console.log(JSON.stringify({ scene: name, rasteriser, first_image_ms: first, whole_scene_ms: whole }));
    return;
  }
  const result = await frames(browser, site, path, `scenes=${file}`);
  writeFileSync(join(out, `${name}-${rasteriser}.json`), JSON.stringify(result, null, 1) + '\n');
  const { device, wasm } = await memory(browser, site, `scenes=${file}`);
  const { first, whole } = await openingTimes(browser, site, `scene=${file}`);
  console.log(JSON.stringify({ scene: name, rasteriser, device_mb: device / 1e6, wasm_mb: wasm / 1e6,
    first_image_ms: first, whole_scene_ms: whole }));
}

mkdirSync(out, { recursive: true });
const folder = siteWith(), server = await serve(folder);
try {
  if (onlyPlanning)
    for (const path of scenes) console.log(JSON.stringify({ scene: basename(path), plan_ms: await planningTimes(server.address, path) }));
  for (const rasteriser of onlyPlanning ? [] : ['llvmpipe', 'swiftshader']) {
    const browser = await launch(rasteriser);
    try {
      for (const path of scenes) await measureScene(browser, server.address, rasteriser, path);
    } finally {
      await browser.close();
    }
  }
} finally {
  await server.close();
  rmSync(folder, { recursive: true });
}
