// Bad files and bad servers: the page shows an error and continues.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { readPng } from './png.mjs';
import {
  each, errorKind, errors, errorShown, image, pick, sceneShown, source, stage, test, thorough,
} from './support.mjs';

const example = readFileSync(join(source, 'examples/soup.glb'));
const answer = (bytes, type = 'model/gltf-binary') => (request, response) =>
  response.writeHead(200, { 'content-type': type, 'content-length': bytes.length }).end(bytes);
const damaged = (at, value) => {
  const copy = Buffer.from(example);
  copy.writeUInt32LE(value, at);
  return copy;
};
/** Noise from a fixed seed. */
const garbage = Buffer.from(Uint32Array.from({ length: 5000 }, (_, i) => Math.imul(i + 1, 2654435761) ^ (i << 7)).buffer);

const { visit, server } = await stage({ routes: {
  '/cut-off.glb': answer(example.subarray(0, example.length - 1000)),
  '/beginning.glb': answer(example.subarray(0, 10)),
  '/empty.glb': answer(Buffer.alloc(0)),
  '/garbage.glb': answer(garbage),
  '/page.glb': answer(Buffer.from('<!doctype html><title>Not found</title>'), 'text/html'),
  '/long-json.glb': answer(damaged(12, 0xfffffff0)),
  '/counts.off': answer(Buffer.from('OFF\n4000000000 4000000000 0\n0 0 0\n')),
  '/breaks-off.glb': (request, response) => {
    response.writeHead(200, { 'content-length': example.length });
    response.write(example.subarray(0, 300_000), () => setTimeout(() => response.destroy(), 200));
  },
  '/refused.glb': (request, response) => response.writeHead(403).end(),
} });

/** For each: the kind of its error, and values in its text: the file, the position and the fault. A
 *  server's rejection is also in the console. */
const cases = [
  ['cut-off.glb', 'input', ['cut-off.glb: byte 8: ', example.length, example.length - 1000]],
  ['beginning.glb', 'input', ['beginning.glb: byte 8: ', 4, 2]],
  ['empty.glb', 'input', ['empty.glb: ']],
  ['garbage.glb', 'input', ['garbage.glb: byte 0: ']],
  ['page.glb', 'input', ['page.glb: ']],
  ['long-json.glb', 'input', ['long-json.glb: byte 12: ', 4294967280, example.length - 20]],
  ['counts.off', 'input', ['counts.off:2: ', 4000000000, 7]],
  ['breaks-off.glb', 'network', ['breaks-off.glb'], /ERR_CONTENT_LENGTH_MISMATCH|ERR_CONNECTION/],
  ['nowhere.glb', 'network', ['nowhere.glb', 404], /404/],
  ['refused.glb', 'network', ['refused.glb', 403], /403/],
  ['ftp://example.org/soup.glb', 'usage', ['ftp']],
];

/** Checks the error that is shown. */
async function assertRefused(page, kind, values) {
  const said = await errorShown(page);
  assert.equal(await errorKind(page), kind);
  for (const value of values) assert.ok(said.includes(value), `${value}: ${said}`);
  assert.ok(await page.isVisible('#start'), 'another can be opened');
}

/** Those of a link in each run: one of each kind. */
const linked = ['garbage.glb', 'breaks-off.glb', 'ftp://example.org/soup.glb'];

for (const [address, kind, values, complaint] of cases)
  (linked.includes(address) ? test : thorough)(`${address}, and then a good one`, () => visit(`?scene=${address}`, async (page) => {
    await assertRefused(page, kind, values);
    await page.click('#gallery-list button');
    await sceneShown(page, 'soup');
    assert.deepEqual(await errors(page), [], 'the error is removed');
  }, { expected: complaint ? [complaint] : [] }));

test('one bad address after the other', (context) => visit('', async (page) => {
  await page.locator('#gallery-list button').waitFor();
  const others = cases.filter(([address]) => !linked.includes(address));
  await each(context, others.map(([address, kind, values]) => [address, async () => {
    await page.fill('#address', address);
    await page.press('#address', 'Enter');
    await page.locator('#errors .message', { hasText: address }).waitFor();
    await assertRefused(page, kind, values);
  }]));
}, { expected: [/404/, /403/] }));

test('a bad one leaves the scene that is shown', () => visit('?scene=soup.glb', async (page) => {
  await sceneShown(page, 'soup');
  const before = await image(page);
  await pick(page, { name: 'garbage.glb', mimeType: 'model/gltf-binary', buffer: garbage });
  assert.match(await errorShown(page), /garbage\.glb/);
  assert.equal(await page.textContent('#scene-title'), 'soup');
  await page.click('#errors button');
  assert.deepEqual(await errors(page), []);
  assert.ok(before.equals(await image(page)), 'the image is unchanged');
}));

test('files that are no scene', () => visit('', async (page) => {
  const files = {
    'notes.txt': Buffer.from('Dear diary\n'), 'picture.png': readFileSync(join(source, 'docs/images/example.png')),
    'model.pt': Buffer.concat([Buffer.from('PK\x03\x04'), garbage]),
    'packed.spz': Buffer.concat([Buffer.from('\x1f\x8b', 'latin1'), garbage]),
    'octagons.npz': Buffer.concat([Buffer.from('PK\x03\x04'), garbage]),
    'loop.gltf': Buffer.from('{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"children": [0]}]}'),
    '<img src=x onerror=alert(1)>.glb': garbage,
  };
  for (const [name, buffer] of Object.entries(files)) {
    await pick(page, { name, mimeType: 'application/octet-stream', buffer });
    await page.locator('#errors .message p', { hasText: name }).waitFor();
    const shown = await errors(page);
    assert.equal(shown.length, 1, 'one error for each');
  }
  assert.equal(await page.locator('#errors img').count(), 0, 'names are text');
  await pick(page, join(source, 'examples/soup.glb'));
  await sceneShown(page, 'soup');
}));

test('a scene with nothing to draw is background', () => visit('', async (page) => {
  const off = Buffer.from('OFF\n3 1 0\nnan nan nan\n0 1 0\n1 0 0\n3 0 1 2\n');
  await pick(page, { name: 'nan.off', mimeType: 'text/plain', buffer: off });
  await sceneShown(page, 'nan');
  const { width, height, pixels } = readPng(await image(page));
  const row = pixels.subarray(4 * width * (height >> 1)).subarray(0, 4 * width);  // the canvas has round corners
  assert.ok(new Set(row).size <= 4, 'one colour');
}));

test('no file outside of the site is served', async () => {
  for (const path of ['..%2f..%2f..%2fCMakeLists.txt', '%2e%2e/%2e%2e/CMakeLists.txt', '%00', '%', 'examples/../../npm/package.json', 'nothing'])
    assert.equal((await fetch(server.address + path)).status, 404, path);
  assert.equal((await fetch(server.address, { method: 'POST' })).status, 405);
});
