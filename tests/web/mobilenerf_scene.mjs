// A small scene in MobileNeRF's format: two shapes with a few quads and two feature images each, and the
// network that computes colours from them. Generated from a fixed seed.

import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { writePng } from './png.mjs';

/** Numbers from 0 to 1 (mulberry32). */
function randomNumbers(seed) {
  return () => {
    seed = (seed + 0x6d2b79f5) | 0;
    let t = Math.imul(seed ^ (seed >>> 15), seed | 1);
    t ^= t + Math.imul(t ^ (t >>> 7), t | 61);
    return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
  };
}

/** 11 inputs (two times four features and the direction), two layers of 16, a colour. */
function network(random, shapes) {
  const sizes = [11, 16, 16, 3], json = { obj_num: shapes };
  const weight = () => 2 * random() - 1;
  for (let layer = 0; layer < 3; ++layer) {
    json[`${layer}_weights`] = Array.from({ length: sizes[layer] }, () => Array.from({ length: sizes[layer + 1] }, weight));
    json[`${layer}_bias`] = Array.from({ length: sizes[layer + 1] }, weight);
  }
  return json;
}

/** Quads in the unit ball, each with the whole image. */
function shape(random, quads) {
  const lines = [];
  const place = () => Array.from({ length: 3 }, () => 1.2 * random() - 0.6);
  for (let i = 0; i < quads; ++i) {
    const [corner, u, v] = [place(), place(), place()];
    for (const [a, b] of [[0, 0], [1, 0], [1, 1], [0, 1]])
      lines.push(`v ${corner.map((value, axis) => value + a * u[axis] + b * v[axis]).join(' ')}`);
  }
  lines.push('vt 0 0', 'vt 1 0', 'vt 1 1', 'vt 0 1');
  for (let i = 0; i < quads; ++i) lines.push(`f ${[1, 2, 3, 4].map((k) => `${4 * i + k}/${k}`).join(' ')}`);
  return lines.join('\n') + '\n';
}

/** Noise; the first channel of the first image is the mask. */
function features(random, side, first) {
  const pixels = Uint8Array.from({ length: 4 * side * side }, (_, i) =>
    first && i % 4 === 0 && random() < 0.4 ? 0 : 1 + Math.floor(255 * random()));
  return writePng({ width: side, height: side, pixels });
}

export function writeMobileNerf(folder) {
  const random = randomNumbers(7), shapes = 2;
  mkdirSync(folder);
  writeFileSync(join(folder, 'mlp.json'), JSON.stringify(network(random, shapes)));
  for (let i = 0; i < shapes; ++i) {
    writeFileSync(join(folder, `shape${i}.obj`), shape(random, 12));
    writeFileSync(join(folder, `shape${i}.pngfeat0.png`), features(random, 16, true));
    writeFileSync(join(folder, `shape${i}.pngfeat1.png`), features(random, 16, false));
  }
}
