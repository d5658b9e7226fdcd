// Builds the page's products from TypeScript and an engine built by Emscripten:
//
//   node build.mjs --engine DIR --out DIR
//
// The engine's DIR contains tureen.js (an ES module that creates engines) and tureen.wasm. The output is
//   site/                 a static site: the page, its worker and engine, gallery, examples
//   scene_template.html   the page in one file, with an empty element that `tureen convert` fills
//   npm/                  a package: createViewer as an ES module with its types
// and a table of sizes. The build fails if the files that a browser must fetch exceed the limit.

import { spawnSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import { cpSync, existsSync, mkdirSync, readFileSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { basename, dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';
import { brotliCompressSync, gzipSync } from 'node:zlib';
import { build } from 'esbuild';

/** The element for the scene of `tureen convert`; the program's html_scene searches for exactly this text. */
const emptyScene = '<script type="application/octet-stream;base64" id="scene" data-name=""></script>';
/** The site's pages, without the examples: HTML, its script and its style. */
const pages = [
  { html: 'page/index.html', script: 'page/page.ts', style: 'page/style.css', engine: 'tureen' },
  { html: 'bench/bench.html', script: 'bench/bench.ts', style: 'bench/bench.css', engine: 'tureen_bench' },
];

const here = dirname(fileURLToPath(import.meta.url));
const root = dirname(here);
const from = (path) => join(here, path);
const text = (path) => readFileSync(path, 'utf8');
/** Maximum compressed size of engine, scripts and page together, in bytes. */
const maxBytes = Number(/"bytes page (\d+):/.exec(text(join(root, 'cmake/limits.cmake')))[1]);

class Failure extends Error {}
const fail = (sentence) => { throw new Failure(sentence); };

function options() {
  const { values } = parseArgs({ options: { engine: { type: 'string' }, out: { type: 'string' } } });
  if (!values.engine || !values.out) fail('usage: node build.mjs --engine DIR --out DIR');
  const engine = resolve(values.engine), out = resolve(values.out);
  for (const name of ['tureen', 'tureen_bench', 'tureen_formats'].flatMap((program) => [`${program}.js`, `${program}.wasm`]))
    if (!existsSync(join(engine, name))) fail(`${join(engine, name)} is missing: build the engine first.`);
  return { engine, out };
}

function version() {
  const found = /project\(tureen VERSION ([\d.]+)/.exec(text(join(root, 'CMakeLists.txt')))?.[1];
  return found ?? fail('CMakeLists.txt has no project version.');
}

/** The commit, in the same form as in the program (cmake/commit.cmake). */
function commit() {
  const git = spawnSync('git', ['-C', root, 'describe', '--always', '--tags', '--dirty'], { encoding: 'utf8' });
  return git.status === 0 ? git.stdout.trim() : 'unknown';
}

/** One script or style with all its imports. `how`: options of esbuild. */
async function bundle(entry, how = {}) {
  const result = await build({
    entryPoints: [entry], bundle: true, write: false, minify: true, platform: 'browser',
    target: 'es2022', legalComments: 'none', logLevel: 'warning', ...how,
  });
  return result.outputFiles[0].text;
}

/** A module of the site or the package. It shares the engine's script with the worker, so a browser fetches it once. */
const module = (entry, engine = 'tureen') => bundle(from(entry), {
  format: 'esm',
  define: { builtVersion: JSON.stringify(version()), builtCommit: JSON.stringify(commit()) },
  plugins: [{
    name: 'shared engine',
    setup: ({ onResolve }) => onResolve({ filter: /^tureen-engine$/ }, () => ({ path: `./${engine}.js`, external: true })),
  }],
});

/** Replaces a text that must occur exactly once. */
function replaceOnce(whole, part, by) {
  const pieces = whole.split(part);
  if (pieces.length !== 2)
    fail(`“${part.slice(0, 60)}” must occur once in the page, not ${pieces.length - 1} times.`);
  return pieces.join(by);
}

function write(folder, name, content) {
  mkdirSync(dirname(join(folder, name)), { recursive: true });
  writeFileSync(join(folder, name), content);
}

/** models.json with the sizes of the files next to it. */
function gallery(folder) {
  const models = JSON.parse(text(from('page/models.json')));
  const weighed = models.map((model) => ({ ...model, bytes: statSync(join(folder, model.url)).size }));
  return JSON.stringify(weighed, null, 2) + '\n';
}

/** Writes the engine, its worker and the viewer module; what is loaded on demand for further formats; and the page for
 *  scenes that it saves as HTML. */
function placeEngine(folder, engine, parts) {
  write(folder, 'tureen_formats.js', parts.formatsEngine);
  write(folder, 'formats_worker.js', parts.formatsWorker);
  cpSync(join(engine, 'tureen_formats.wasm'), join(folder, 'tureen_formats.wasm'));
  write(folder, 'formats_licenses.txt', ['fzstd', 'pako'].map((name) => `${name}\n\n${text(from(`node_modules/${name}/LICENSE`))}`).join('\n'));
  write(folder, 'scene_template.html', parts.template);
  write(folder, 'tureen.js', parts.engine);
  write(folder, 'viewer.js', parts.viewer);
  write(folder, 'loader_worker.js', parts.worker);
  cpSync(join(engine, 'tureen.wasm'), join(folder, 'tureen.wasm'));
}

/** A page without the indentation of its lines: a hundred bytes less by brotli. */
const unindented = (html) => html.replace(/\n\s+/g, '\n');

async function makeSite(folder, engine, parts) {
  for (const { html, script, style, engine: its } of pages) {
    write(folder, basename(html), unindented(text(from(html))));
    write(folder, basename(script, '.ts') + '.js', await module(script, its));
    write(folder, basename(style), await bundle(from(style)));
  }
  placeEngine(folder, engine, parts);
  write(folder, 'tureen_bench.js', await engineModule(engine, 'tureen_bench'));
  cpSync(join(engine, 'tureen_bench.wasm'), join(folder, 'tureen_bench.wasm'));
  cpSync(from('examples'), join(folder, 'examples'), { recursive: true });
  cpSync(join(root, 'examples/soup.glb'), join(folder, 'soup.glb'));
  cpSync(join(root, 'docs/images/example.png'), join(folder, 'soup.png'));
  write(folder, 'models.json', gallery(folder));
}

/** A Blob has no base address, so import.meta.url becomes an address that is never fetched: the program's bytes
 *  are passed to the engine. */
const nowhere = { 'import.meta.url': '"file:///"' };

/** The last line of tureen.js. The worker's script is tureen.js without it, followed by loader_worker.js
 *  (viewer/assets.ts), so that a browser fetches the engine's script once. */
const engineExport = 'export default createTureen.default;\n';

/** The engine's script: a global createTureen, then its export. */
const engineModule = async (engine, program = 'tureen') =>
  await bundle(join(engine, `${program}.js`), { format: 'iife', globalName: 'createTureen', define: nowhere }) + engineExport;

/** The worker's script without the engine's. */
const workerScript = (entry = 'viewer/loader_worker.ts') => bundle(from(entry), {
  format: 'iife', define: nowhere,
  plugins: [{
    name: 'engine before this script',
    setup: ({ onResolve, onLoad }) => {
      onResolve({ filter: /^tureen-engine$/ }, ({ path }) => ({ path, namespace: 'global' }));
      onLoad({ filter: /.*/, namespace: 'global' }, () => ({ contents: 'export default createTureen.default;' }));
    },
  }],
});

/** A script without imports, for the single file. */
const selfContained = (entry, engine) => bundle(from(entry), {
  format: 'iife', alias: { 'tureen-engine': join(engine, 'tureen.js') }, define: nowhere,
});

/** The page as a single file. */
async function makeTemplate(engine, parts) {
  const script = await selfContained('page/single_file.ts', engine);
  const style = await bundle(from('page/style.css'));
  if (/<\/script|<!--/i.test(script)) fail('The script of the single file contains </script or <!--, which ends a script in HTML.');
  const part = (id, bytes) => `<script type="application/octet-stream;base64" id="${id}">` +
    `${Buffer.from(bytes).toString('base64')}</script>\n`;
  const hash = createHash('sha256').update(script).digest('base64');
  const parts64 = part('engine', readFileSync(join(engine, 'tureen.wasm'))) + part('worker', parts.engine.replace(engineExport, '') + parts.worker);

  let page = text(from('page/index.html'));
  page = replaceOnce(page, '<link rel="stylesheet" href="style.css">', `<style>\n${style}</style>`);
  for (const early of ['<link rel="modulepreload" href="tureen.js">', '<link rel="preload" href="tureen.wasm" as="fetch" crossorigin>',
                       '<link rel="preload" href="loader_worker.js" as="fetch" crossorigin>'])
    page = replaceOnce(page, `${early}\n`, '');
  page = replaceOnce(page, '<script type="module" src="page.js"></script>\n', '');
  page = replaceOnce(page, "script-src 'self' 'wasm-unsafe-eval'; style-src 'self'",
                     `script-src 'sha256-${hash}' 'wasm-unsafe-eval' blob:; style-src 'unsafe-inline'`);
  page = replaceOnce(page, '</body>', `${emptyScene}\n${parts64}<script>${script}</script>\n</body>`);
  replaceOnce(page, emptyScene, '');  // checks that it occurs once
  return page;
}

function makePackage(folder, engine, parts) {
  const { name, ...rest } = JSON.parse(text(from('package/package.json')));
  write(folder, 'package.json', JSON.stringify({ name, version: version(), ...rest }, null, 2) + '\n');
  placeEngine(folder, engine, parts);
  cpSync(from('package/README.md'), join(folder, 'README.md'));
  cpSync(join(root, 'LICENSE'), join(folder, 'LICENSE'));
  const compiler = from('node_modules/typescript/bin/tsc');
  const types = spawnSync(process.execPath, [compiler, '-p', from('package'), '--outDir', join(folder, 'types')],
                          { stdio: 'inherit' });
  if (types.status !== 0) fail('The types of the package could not be built: see above.');
}

/** Prints the sizes of the files that a browser fetches before the first scene. */
function weigh(site) {
  const totals = [0, 0, 0];
  const row = (name, sizes) =>
    console.log(name.padEnd(18) + sizes.map((size) => size.toLocaleString('en').padStart(12)).join(''));
  console.log(' '.repeat(18) + ['bytes', 'gzip', 'brotli'].map((name) => name.padStart(12)).join(''));
  const weighed = (name) => {
    const bytes = readFileSync(join(site, name));
    const sizes = [bytes.length, gzipSync(bytes, { level: 9 }).length, brotliCompressSync(bytes).length];
    row(name, sizes);
    return sizes;
  };
  for (const name of ['page.js', 'loader_worker.js', 'tureen.js', 'tureen.wasm', 'index.html', 'style.css'])
    weighed(name).forEach((size, i) => { totals[i] += size; });
  row('together', totals);
  console.log('on demand, for further formats and for downloads:');
  for (const name of ['formats_worker.js', 'tureen_formats.js', 'tureen_formats.wasm']) weighed(name);
  if (totals[2] > maxBytes)
    fail(`Engine, scripts and page have ${totals[2]} bytes with brotli; the limit in cmake/limits.cmake is ${maxBytes}.`);
}

async function main() {
  const { engine, out } = options();
  const site = join(out, 'site'), npm = join(out, 'npm');
  const parts = {
    engine: await engineModule(engine),
    viewer: await module('package/index.ts'),
    worker: await workerScript(),
    formatsEngine: await engineModule(engine, 'tureen_formats'),
    formatsWorker: await workerScript('viewer/formats_worker.ts'),
  };
  parts.template = await makeTemplate(engine, parts);
  for (const folder of [site, npm]) rmSync(folder, { recursive: true, force: true });
  await makeSite(site, engine, parts);
  write(out, 'scene_template.html', parts.template);
  makePackage(npm, engine, parts);
  weigh(site);
}

main().catch((error) => {
  console.error(error instanceof Failure ? error.message : error);
  process.exitCode = 1;
});
