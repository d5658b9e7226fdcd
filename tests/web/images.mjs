// Comparison of two images, and the images that a failure leaves behind.

import assert from 'node:assert/strict';
import { writeFileSync } from 'node:fs';
import { writePng } from './png.mjs';
import { evidence, evidenceOf } from './support.mjs';

/** The number of pixels that differ at all, and by more than a step; and the PSNR. */
function differences(expected, actual) {
  let off = 0, offByMore = 0, squares = 0;
  for (let i = 0; i < actual.pixels.length; i += 4) {
    let largest = 0;
    for (let c = i; c < i + 4; ++c) {
      const by = Math.abs(actual.pixels[c] - expected.pixels[c]);
      largest = Math.max(largest, by);
      if (c < i + 3) squares += by * by;
    }
    off += largest > 0;
    offByMore += largest > 1;
  }
  const pixels = actual.pixels.length / 4;
  return { off, offByMore, pixels, psnr: 10 * Math.log10((255 * 255) / (squares / (3 * pixels))) };
}

function leave(name, expected, actual) {
  const folder = evidenceOf(`${name}-browser`);
  const enlarged = actual.pixels.map((value, i) => (i % 4 === 3 ? 255 : Math.min(255, 16 * Math.abs(value - expected.pixels[i]))));
  const images = { expected, actual, difference: { ...actual, pixels: enlarged } };
  for (const [what, image] of Object.entries(images)) writeFileSync(folder.file(`${what}.png`), writePng(image));
}

function compare(name, expected, actual, isGood) {
  assert.deepEqual([actual.width, actual.height], [expected.width, expected.height], `${name}: sizes`);
  const { off, offByMore, pixels, psnr } = differences(expected, actual);
  if (isGood({ off, offByMore, pixels, psnr })) return;
  leave(name, expected, actual);
  assert.fail(`${name} differs: of ${pixels} pixels ${off} are off, ${offByMore} by more than a step, ` +
              `${psnr.toFixed(1)} dB; the images are in ${evidence}/${name}-browser`);
}

/** The bounds of the native goldens (tests/support/golden.hpp): 1 pixel in 300 off at all, 1 in 3,000 by
 *  more than a step. llvmpipe differs by less between models of processors. */
export function assertSame(name, expected, actual) {
  compare(name, expected, actual, ({ off, offByMore, pixels }) => off * 300 <= pixels && offByMore * 3000 <= pixels);
}

export function assertAlike(name, expected, actual, decibels) {
  compare(name, expected, actual, ({ psnr }) => psnr >= decibels);
}
