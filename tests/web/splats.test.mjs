// Many splats by raster are sorted in a worker: moving does not wait, and at rest the order is that of the view. Tiles
// have the same picture.

import assert from 'node:assert/strict';
import { drawingPage, drawingRoutes } from './drawing.mjs';
import { assertAlike } from './images.mjs';
import { splatPly } from './splat_ply.mjs';
import { stage, test } from './support.mjs';

const ply = (count) => {
  const scene = splatPly(count);
  return (request, response) => response.writeHead(200, { 'content-length': scene.length }).end(scene);
};
// SplatPass sorts 100,000 and more beside the frames.
const { visit } = await stage({ routes: { ...drawingRoutes, '/many.ply': ply(120_000), '/few.ply': ply(3_000) } });

/** Turns by 1.9 degrees, where the order of the view before may still be drawn. Returns the numbers of channels
 *  that differ from an exact image: in the first frame, and in that after the next change of the order. */
const differences = (page) => page.evaluate(async () => {
  const size = { width: 64, height: 48 }, pose = (turn) => ({ eye: [4 * Math.sin(turn), 0, 4 * Math.cos(turn)], target: [0, 0, 0], up: [0, 1, 0], fov: 1, roll: 0 });
  const pixelsOf = (image) => {
    const canvas = new OffscreenCanvas(size.width, size.height), context = canvas.getContext('2d');
    context.drawImage(image, 0, 0);
    return context.getImageData(0, 0, size.width, size.height).data;
  };
  const exact = async (turn) => {
    viewer.setView(pose(turn));
    return pixelsOf(await createImageBitmap(await viewer.screenshot(size)));
  };
  const expected = await exact(0.033);
  await exact(0);
  viewer.setView(pose(0.033));
  const different = () => pixelsOf(viewer.canvas).reduce((sum, value, at) => sum + (value !== expected[at]), 0);
  viewer.draw();
  const first = different();
  const second = await new Promise((resolve) => { viewer.on('frame', () => resolve(different())); });
  return { first, second };
});

test('many splats are sorted in a worker until the order is that of the view', () => visit('drawing.html?blend=raster', async (page) => {
  await drawingPage(page);
  await page.evaluate(() => viewer.load({ url: '/many.ply' }));
  const { first, second } = await differences(page);
  assert.equal(page.workers().length, 1);
  assert.ok(first > 0, `the first frame has the earlier order: ${first} channels differ`);
  assert.equal(second, 0, 'the frame after it has the order of the view');
}));

test('without a worker, frames sort', () => visit('drawing.html?blend=raster', async (page) => {
  await drawingPage(page);
  await page.evaluate(async () => {
    await viewer.load({ url: '/many.ply' });
    window.Worker = class { constructor() { throw new Error('no workers'); } };
  });
  const { second } = await differences(page);
  assert.equal(page.workers().length, 0);
  assert.equal(second, 0);
}));

const view = { eye: [0.4, 0.7, 2.2], target: [0, 0, 0], up: [0, 1, 0], fov: 1, roll: 0 };
const imageOf = (address, wanted) => visit(address, async (page) => {
  const { image } = await drawingPage(page);
  await page.evaluate(() => viewer.load({ url: '/few.ply' }));
  return image({ from: view, width: 160, height: 120, ...wanted });
});

// Rounding both to 8 bits gives 55.9 dB.
test('tiles, the choice on llvmpipe, and raster have the same picture', async () => {
  const tiles = await imageOf('drawing.html?blend=tiles'), automatic = await imageOf('drawing.html');
  assertAlike('tiles-and-raster', await imageOf('drawing.html?blend=raster'), tiles, 55);
  assert.deepEqual(automatic, tiles);
});

test('a frame in tiles can be read from the canvas', () => visit('drawing.html?blend=tiles', async (page) => {
  await drawingPage(page);
  const brightest = await page.evaluate(async (from) => {
    await viewer.load({ url: '/few.ply' });
    viewer.background = [0, 0, 0];
    viewer.setView(from);
    viewer.draw();
    await new Promise((resolve) => { requestAnimationFrame(() => requestAnimationFrame(resolve)); });
    viewer.draw();  // after the canvas was presented
    const { width, height } = viewer.canvas, pixels = new Uint8Array(4 * width * height);
    const gl = viewer.canvas.getContext('webgl2');
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    return Math.max(...pixels.filter((value, at) => at % 4 < 3));
  }, view);
  assert.ok(brightest > 0);
}));

test('a debug view draws by raster what was blended in tiles', async () => {
  const wanted = { look: 'overdraw' };
  assert.deepEqual(await imageOf('drawing.html?blend=tiles', wanted), await imageOf('drawing.html?blend=raster', wanted));
});

test('the focus is the same point in tiles and by raster', async () => {
  const targetOf = (address) => visit(address, async (page) => {
    await drawingPage(page);
    return page.evaluate(async (from) => {
      await viewer.load({ url: '/few.ply' });
      viewer.setView(from);
      viewer.draw();
      return viewer.focus(40, 20) && viewer.getView().target;
    }, view);
  });
  const inTiles = await targetOf('drawing.html?blend=tiles');
  assert.ok(inTiles, 'no splat there');
  assert.deepEqual(inTiles, await targetOf('drawing.html?blend=raster'));
});
