// Formats of splats that the page's second program reads, scenes in several files by address, and files that the page writes.

import assert from 'node:assert/strict';
import { execFileSync, spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { gzipSync } from 'node:zlib';
import { drawingPage, drawingRoutes } from './drawing.mjs';
import { splatPly } from './splat_ply.mjs';
import { each, errorKind, errorShown, pick, programs, sceneShown, scratch, source, stage, still, test } from './support.mjs';

const folder = scratch(), file = (name) => join(folder, name);
const playbot = join(source, '../shared/data/gaussians/playbot');
const routes = { ...drawingRoutes };
for (const [prefix, root] of [['/streamed/', file('streamed')], ['/playbot/', playbot]])
  for (const path of paths(root, prefix === '/playbot/'))
    routes[prefix + path] = (request, response) => {
      const bytes = readFileSync(join(root, path));
      response.writeHead(200, { 'content-length': bytes.length }).end(bytes);
    };
/** Requests for the file without an extension, and the answer to a second one for the other file, which never comes. */
let unnamedRequests = 0, stalledRequests = 0, stalls;
const stalled = new Promise((resolve) => { stalls = resolve; });
routes['/unnamed'] = (request, response) => {
  ++unnamedRequests;
  response.writeHead(200).end(readFileSync(file('read.spz')));
};
routes['/once.spz'] = (request, response) => {
  if (++stalledRequests === 1) return response.writeHead(200).end(readFileSync(file('read.spz')));
  stalls();
};
const { visit } = await stage({ routes });

/** The files of a streamed scene with two levels, which are made here, or of playbot. */
function paths(root, isPlaybot) {
  const images = ['means_l', 'means_u', 'scales', 'quats', 'sh0', 'shN_labels', 'shN_centroids'].map((name) => `${name}.webp`);
  const of = (part) => ['meta.json', ...images].map((name) => `${part}/${name}`);
  if (isPlaybot) return existsSync(root) ? ['lod-meta.json', ...of('0_0'), ...of('5_0')] : [];
  writeFileSync(file('splats.ply'), splatPly(1000));
  writeFileSync(file('few.ply'), splatPly(300));
  for (const [name, part] of [['splats', 'fine'], ['few', 'coarse']]) {
    convert(`${name}.ply`, `${name}.sog`);
    mkdirSync(join(root, part), { recursive: true });
    for (const [entry, bytes] of storedEntries(readFileSync(file(`${name}.sog`)))) writeFileSync(join(root, part, entry), bytes);
  }
  const lods = { 0: { file: 0, offset: 0, count: 1000 }, 1: { file: 1, offset: 0, count: 300 } };
  writeFileSync(join(root, 'lod-meta.json'), JSON.stringify({
    lodLevels: 2, filenames: ['fine/meta.json', 'coarse/meta.json'], environment: null,
    tree: { bound: { min: [-1, -1, -1], max: [1, 1, 1] }, lods },
  }));
  return ['lod-meta.json', ...of('fine'), ...of('coarse')].filter((path) => existsSync(join(root, path)));
}

function convert(from, to) {
  execFileSync(join(programs, 'tureen'), ['convert', file(from), file(to), '--quiet', '--force', '--no-measure'], { stdio: 'pipe' });
}

/** The files of a zip archive without compression. */
function storedEntries(zip) {
  const entries = [];
  for (let at = 0; zip.readUInt32LE(at) === 0x04034b50;) {
    const size = zip.readUInt32LE(at + 18), name = zip.readUInt16LE(at + 26), begin = at + 30 + name + zip.readUInt16LE(at + 28);
    assert.equal(zip.readUInt16LE(at + 8), 0, 'stored');
    entries.push([zip.toString('utf8', at + 30, at + 30 + name), zip.subarray(begin, begin + size)]);
    at = begin + size;
  }
  return entries;
}

const from = { eye: [0.4, 0.7, 2.6], target: [0, 0, 0], up: [0, -1, 0], fov: 1, roll: 0 };
const wanted = { from, width: 96, height: 72 };

// The program and the page read a file with the same code; GLB keeps every number. So the images are equal.
test('each format has the image that its conversion by the program has', (context) => visit('drawing.html', async (page) => {
  const { load, image } = await drawingPage(page);
  const formats = ['sog', 'spz', 'compressed.ply', 'splat', 'usda', 'usdz'];
  await each(context, formats.map((extension) => [extension, async () => {
    const name = `read.${extension}`;
    convert('splats.ply', name);
    convert(name, 'expected.glb');
    await load(folder, ['expected.glb']);
    const expected = await image(wanted);
    await load(folder, [name]);
    assert.deepEqual(await image(wanted), expected);
  }]));
  await context.test('SPZ of version 3, by gzip', async () => {
    execFileSync(join(programs, 'tureen'), ['convert', file('splats.ply'), file('three.spz'), '--spz-version', '3', '--quiet', '--no-measure'], { stdio: 'pipe' });
    convert('three.spz', 'three.glb');
    await load(folder, ['three.glb']);
    const expected = await image(wanted);
    await load(folder, ['three.spz']);
    assert.deepEqual(await image(wanted), expected);
  });
  await context.test('SPZ in glTF, which the first program hands on', async () => {
    const spz = readFileSync(file('read.spz')), splatting = 'KHR_gaussian_splatting', packed = `${splatting}_compression_spz_2`;
    const inner = { [packed]: { bufferView: 0 } }, method = { kernel: 'ellipse', colorSpace: 'srgb_rec709_display' };
    const primitive = { mode: 0, attributes: {}, extensions: { [splatting]: { ...method, extensions: inner } } };
    writeFileSync(file('inside.gltf'), JSON.stringify({
      asset: { version: '2.0' }, extensionsUsed: [splatting, packed], extensionsRequired: [splatting, packed],
      scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0 }], meshes: [{ primitives: [primitive] }],
      bufferViews: [{ buffer: 0, byteLength: spz.length }],
      buffers: [{ byteLength: spz.length, uri: `data:application/octet-stream;base64,${spz.toString('base64')}` }],
    }));
    convert('inside.gltf', 'inside.glb');
    await load(folder, ['inside.glb']);
    const expected = await image(wanted);
    await load(folder, ['inside.gltf']);
    assert.deepEqual(await image(wanted), expected);
    assert.equal(await page.evaluate(() => viewer.scene.splats), 1000);
  });
  await context.test('a name without its extension', async () => {
    writeFileSync(file('unnamed'), readFileSync(file('read.spz')));
    await load(folder, ['read.spz']);
    const expected = await image(wanted);
    await load(folder, ['unnamed']);
    assert.deepEqual(await image(wanted), expected);
    await page.evaluate(() => viewer.load({ url: '/unnamed' }));
    assert.deepEqual(await image(wanted), expected);
    assert.equal(unnamedRequests, 1, 'the second program gets what the first has downloaded');
  });
  await context.test('a debug view', async () => {
    await load(folder, ['expected.glb']);
    const expected = await image({ ...wanted, look: 'overdraw' });
    await load(folder, ['read.usdz']);
    assert.deepEqual(await image({ ...wanted, look: 'overdraw' }), expected);
  });
  await context.test('a load cancels the reading for a debug view', async () => {
    await page.evaluate(async () => {
      await viewer.load({ url: '/once.spz' });
      window.shown = viewer.show('overdraw').then(() => 'shown', (error) => error.kind);
    });
    await stalled;
    assert.equal(await page.evaluate(async () => {
      await viewer.load({ url: '/soup.glb' });
      return window.shown;
    }), 'cancelled');
  });
}));

/** A .ksplat of level 0 and degree 0: a header, a section without buckets, and single numbers. */
function ksplat(count) {
  const bytes = Buffer.alloc(4096 + 1024 + 44 * count), at = (i, k) => 4096 + 1024 + 44 * i + 4 * k;
  bytes[1] = 1;  // version 0.1
  for (const place of [4, 8]) bytes.writeUInt32LE(1, place);  // sections
  for (const place of [12, 16, 4096, 4100]) bytes.writeUInt32LE(count, place);  // splats, also of the section
  for (let i = 0; i < count; ++i) {
    const turn = 0.7 * i, place = [Math.sin(turn), Math.cos(turn), i / count - 0.5], size = [0.2, 0.1, 0.05];
    [...place, ...size, Math.cos(turn), Math.sin(turn), 0, 0].forEach((value, k) => bytes.writeFloatLE(value, at(i, k)));
    [20 * i % 256, 255 - 7 * i % 256, 128, 200].forEach((value, k) => bytes.writeUInt8(value, at(i, 10) + k));
  }
  return bytes;
}

test('.ksplat, checkpoints and octagons have the images that their conversions have', (context) => visit('drawing.html', async (page) => {
  const { load, image } = await drawingPage(page), data = join(source, 'tests/formats/data');
  writeFileSync(file('ring.ksplat'), ksplat(40));
  for (const name of ['triangle_splatting.pt', 'triangle_splatting_plus.pt', 'mesh_splatting.pt', 'octagons.npz'])
    writeFileSync(file(name), readFileSync(join(data, name)));
  await each(context, ['ring.ksplat', 'triangle_splatting.pt', 'triangle_splatting_plus.pt', 'mesh_splatting.pt', 'octagons.npz'].map((name) => [name, async () => {
    convert(name, 'expected.glb');
    const { low, high } = JSON.parse(execFileSync(join(programs, 'tureen'), ['info', file('expected.glb'), '--json'], { stdio: 'pipe' })).bounds;
    const target = low.map((value, axis) => (value + high[axis]) / 2), size = Math.hypot(...low.map((value, axis) => high[axis] - value));
    const view = { ...wanted, from: { ...from, eye: target.map((value, axis) => value + size * [0.3, -0.4, 1][axis]), target } };
    await load(folder, ['expected.glb']);
    const expected = await image(view);
    assert.ok(new Set(expected.pixels).size > 10, 'something is drawn');
    await load(folder, [name]);
    assert.deepEqual(await image(view), expected);
  }]));
}));

/** A module of web/viewer. */
async function viewerModule(name) {
  const { build } = await import(pathToFileURL(join(source, 'web/node_modules/esbuild/lib/main.js')).href);
  const outfile = file(`${name}.mjs`);
  await build({ entryPoints: [join(source, `web/viewer/${name}.ts`)], bundle: true, format: 'esm', platform: 'node', outfile, logLevel: 'warning' });
  return import(pathToFileURL(outfile).href);
}

// RFC 8878, 3.1.1: frames of raw blocks and blocks of one byte, by hand. `size`: in the header; -1: none.
test('zstd: exactly one frame of exactly the bytes', async () => {
  const { codecs: { unzstd } } = await viewerModule('codecs');
  const block = (type, size, last, ...bytes) => {
    const head = size << 3 | type << 1 | (last ? 1 : 0);
    return [head & 255, head >> 8 & 255, head >> 16, ...bytes];
  };
  const frame = (size, ...blocks) => [0x28, 0xb5, 0x2f, 0xfd, ...(size < 0 ? [0, 0] : [32, size]), ...blocks.flat()];
  const raw = (last, ...bytes) => block(0, bytes.length, last, ...bytes);
  const read = (size, ...bytes) => {
    const output = new Uint8Array(size), result = unzstd(Uint8Array.from(bytes), output);
    return result < 0 ? result : [...output.subarray(0, result)];
  };
  for (const size of [5, -1]) {
    assert.deepEqual(read(5, ...frame(size, raw(false, 1, 2), block(1, 3, true, 7))), [1, 2, 7, 7, 7]);
    assert.equal(read(5, ...frame(size, raw(true, 1, 2, 3))), -1, 'too few');
    assert.equal(read(5, ...frame(size, raw(false, 1, 2, 3), block(1, 3, true, 7))), -1, 'too many');
    assert.equal(read(5, ...frame(size, raw(true, 1, 2, 3, 4, 5)), 0), -1, 'a byte more');
    assert.equal(read(5, ...frame(size, raw(false, 1, 2, 3, 4, 5))), -1, 'no last block');
  }
  assert.equal(read(4, ...frame(2, raw(true, 1, 2)), ...frame(2, raw(true, 3, 4))), -1, 'two frames');
  assert.equal(read(5, ...frame(4, raw(true, 1, 2, 3, 4, 5))), -1, 'another size in the header');
  const checked = frame(2, raw(true, 1, 2));
  checked[4] |= 4;
  assert.deepEqual(read(2, ...checked, 0, 0, 0, 0), [1, 2], 'a checksum, which is not compared');
});

test('files of a scene: few at once, none after an error, no more than the memory', async () => {
  const { planFiles } = await viewerModule('file_plan');
  const names = Array.from({ length: 100 }, (_, i) => `${i}.webp`);
  let begun = 0, running = 0, most = 0;
  const load = (memory, part) => {
    let there = [];
    const engine = {
      putFiles: (_, bytes) => { there = [...bytes.keys()]; },
      call: () => ({ levels: [], level: 0, missing: names.filter((name) => !there.includes(`a/${name}`)) }),
      emptyFolder: () => {},
    };
    begun = running = most = 0;
    const files = { bytes: new Map([['a/meta.json', new Uint8Array(10)]]), paths: ['a/meta.json'] };
    return planFiles(engine, files, { url: 'https://a.example/a/meta.json', name: 'a' }, memory, null, async (url) => {
      most = Math.max(most, ++running);
      const number = ++begun;
      await new Promise((resolve) => { setTimeout(resolve); });
      --running;
      return part(number, url);
    });
  };
  const { files } = await load(1010, () => new Uint8Array(10));
  assert.equal(files.bytes.size, 101);
  assert.ok(most > 1 && most <= 8, String(most));
  await assert.rejects(load(1009, () => new Uint8Array(10)), { kind: 'memory' });
  await assert.rejects(load(1e6, (number) => {
    if (number === 20) throw new Error('no answer');
    return new Uint8Array(10);
  }), /no answer/);
  assert.ok(begun < 30, String(begun));
});

test('a streamed SOG by its address, and another level', () => visit('?scene=streamed/lod-meta.json', async (page) => {
  await sceneShown(page, 'streamed');
  assert.match(await page.textContent('#facts'), /1,000 splats.*GPU memorynone: the processor draws the splats/);
  const before = await page.evaluate(() => location.hash);
  await page.selectOption('#detail', { index: 1 });
  await page.waitForFunction(() => document.getElementById('facts').textContent.includes('300 splats'));
  await still(page);
  assert.equal(await page.evaluate(() => location.hash), before, 'the view stays');
  await page.reload();
  await sceneShown(page, 'streamed');
  assert.match(await page.textContent('#facts'), /300 splats/, 'the link has the level');
}));

test('damaged files have the program’s errors', (context) => visit('', async (page) => {
  const spz = readFileSync(file('three.spz')), sog = readFileSync(file('splats.sog'));
  const cases = {
    'cut.spz': spz.subarray(0, spz.length - 100), 'cut.sog': sog.subarray(0, sog.length / 2),
    'many.spz': (() => {
      const head = Buffer.alloc(16);
      head.write('NGSP');
      head.writeUInt32LE(3, 4);
      head.writeUInt32LE(9_000_000, 8);
      return gzipSync(head);
    })(),
    'noise.bin': Buffer.from(Uint32Array.from({ length: 500 }, (_, i) => Math.imul(i + 1, 2654435761)).buffer),
  };
  await each(context, Object.entries(cases).map(([name, bytes]) => [name, async () => {
    writeFileSync(file(name), bytes);
    let expected = '';
    try {
      convert(name, 'never.glb');
    } catch (error) {
      expected = String(error.stderr);
    }
    await page.evaluate(() => document.querySelector('#errors').replaceChildren());
    await pick(page, file(name));
    const said = await errorShown(page);
    assert.equal(await errorKind(page), 'input');
    const reason = said.slice(said.indexOf(name)).replace(/: not a file in a supported format.*/s, ': not a file in a supported format');
    assert.ok(expected.includes(reason), `${said}\n${expected}`);
  }]));
}));

test('the page writes GLB, PLY and a page, and plays tours', (context) => visit('drawing.html', async (page) => {
  const { load, image } = await drawingPage(page);
  const written = async (format) => {
    const base64 = await page.evaluate(async (kind) => {
      const bytes = new Uint8Array(await (await viewer.write(kind)).file.arrayBuffer());
      return btoa(bytes.reduce((text, byte) => text + String.fromCharCode(byte), ''));
    }, format);
    writeFileSync(file(`written.${format}`), Buffer.from(base64, 'base64'));
  };
  await load(folder, ['splats.sog']);
  await page.evaluate(() => viewer.setLayer(0, { transform: { position: [0.3, 0, 0], rotation: [0, 0, 1], scale: 0.5, mirror: false } }));
  const expected = await image(wanted);
  await context.test('GLB', async () => {
    await written('glb');
    await load(folder, ['written.glb']);
    assert.deepEqual(await image(wanted), expected);
  });
  await context.test('cancelled', async () => assert.equal(await page.evaluate(async () => {
    const ending = new AbortController(), file = viewer.write('glb', { signal: ending.signal });
    ending.abort();
    return file.catch((error) => error.kind);
  }), 'cancelled'));
  await context.test('HTML', async () => {
    await written('html');
    const html = readFileSync(file('written.html'), 'latin1');
    const [, base64] = /id="scene" data-name="[^"]*">([^<]+)</.exec(html);
    writeFileSync(file('inside.glb'), Buffer.from(base64, 'base64'));
    await load(folder, ['inside.glb']);
    assert.deepEqual(await image(wanted), expected);
  });
  await context.test('PLY of a single layer', async () => {
    await load(folder, ['splats.ply']);
    const before = await image(wanted);
    await written('ply');
    await load(folder, ['written.ply']);
    assert.deepEqual(await image(wanted), before);
  });
  await context.test('a turntable keeps the distance, and ends when the view is moved', async () => {
    const { moved, kept, ended, refused } = await page.evaluate(async (pose) => {
      const apart = ({ eye, target }) => Math.hypot(...eye.map((value, axis) => value - target[axis]));
      viewer.setView(pose);
      viewer.play('turntable', 2);
      const eye = viewer.getView().eye;
      for (let frames = 0; frames < 5; ++frames) await new Promise((resolve) => { viewer.on('frame', resolve); });
      const now = viewer.getView();
      viewer.orbit(1, 0);
      const ended = viewer.playing;
      let refused = false;
      try { viewer.play('cameras'); } catch (error) { refused = error.kind === 'usage'; }
      return { moved: Math.hypot(...eye.map((value, axis) => value - now.eye[axis])), kept: apart(now) / apart(pose), ended, refused };
    }, from);
    assert.ok(moved > 0);
    // The target is where the line of sight is nearest to the box's centre, which is not exactly the origin.
    assert.ok(Math.abs(kept - 1) < 0.05, String(kept));
    assert.equal(ended, null);
    assert.ok(refused, 'there are no cameras');
  });
}));

// splats.ply assumes -y, the example stores z.
test('an added scene with another up axis is turned upright, unless that is switched off', () => visit('drawing.html', async (page) => {
  await drawingPage(page);
  const { turned, notes, kept } = await page.evaluate(async (bytes) => {
    await viewer.load({ url: '/soup.glb' });
    const files = [{ path: 'splats.ply', data: new Blob([Uint8Array.from(atob(bytes), (letter) => letter.charCodeAt(0))]) }];
    const [first] = await viewer.addLayers({ files });
    const { notes } = viewer.scene;
    viewer.upright = false;
    const [second] = await viewer.addLayers({ files });
    return { turned: first.transform, notes, kept: second.transform };
  }, splatPly(10).toString('base64'));
  // The layer's -y becomes the world's z.
  assert.deepEqual(turned.slice(4, 7).map((value) => Math.round(1e6 * value) / 1e6 + 0), [0, 0, -1]);
  assert.ok(notes.some((note) => /-y.*\bz\b/.test(note)), notes.join('; '));
  assert.deepEqual(kept, [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
}));

test('the list of names has every extension that the program reads', () => {
  writeFileSync(file('scene.unknown'), 'nothing');
  const { stderr } = spawnSync(join(programs, 'tureen'), ['info', file('scene.unknown')], { encoding: 'utf8' });
  const names = [...stderr.matchAll(/\(([^)]*)\)/g)].flatMap(([, some]) => some.split(', ')).filter((name) => name.startsWith('.'));
  assert.ok(names.length > 12, stderr);
  const list = readFileSync(join(source, 'web/viewer/formats.ts'), 'utf8');
  for (const name of names) assert.ok(list.includes(`'${name}'`), name);
  // What a page in one file names, because it lacks the second program; binary USD has an error of its own.
  const [, elsewhere] = /const char\* elsewhere :\s*\{([^}]*)\}/.exec(readFileSync(join(source, 'formats/scene_file.cpp'), 'utf8'));
  const further = [...list.matchAll(/kind\('(\.\w+)', true/g)].map(([, name]) => name);
  assert.deepEqual([...elsewhere.matchAll(/"(.+?)"/g)].map(([, name]) => name).sort(),
                   further.filter((name) => name !== '.usd' && name !== '.usdc').sort());
});

test('what only the program reads has an error that names it', (context) => visit('', async (page) => {
  const gltf = { asset: { version: '2.0' }, extensionsRequired: ['EXT_meshopt_compression'] };
  const cases = { 'mesh.obj': 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n', 'packed.gltf': JSON.stringify(gltf) };
  await each(context, Object.entries(cases).map(([name, content]) => [name, async () => {
    writeFileSync(file(name), content);
    await page.evaluate(() => document.querySelector('#errors').replaceChildren());
    await pick(page, file(name));
    assert.match(await errorShown(page), /MobileNeRF|EXT_meshopt/);
  }]));
}));

// Should take 3 s; on two cores that also draw, and perhaps build, a test can only print it.
test('playbot is shown whole', { skip: existsSync(playbot) ? false : 'no ../shared/data' }, () => visit('drawing.html', async (page) => {
  await drawingPage(page);
  const [splats, ms] = await page.evaluate(async () => {
    const begin = performance.now(), scene = await viewer.load({ url: '/playbot/lod-meta.json' });
    viewer.draw();
    return [scene.splats, performance.now() - begin];
  });
  assert.equal(splats, 500_000);
  console.log(`playbot: ${Math.round(ms)} ms`);
}));
