// A viewer of the package's API on an empty page, for tests of its images.

import { readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { readPng } from './png.mjs';

const emptyPage = `<!doctype html><html lang="en"><title>Drawing</title><link rel="icon" href="data:,">
<canvas id="canvas" style="width: 64px; height: 48px"></canvas>
<script type="module">
  import { createViewer } from '/viewer.js';
  const given = new URLSearchParams(location.search), blend = given.get('blend') ?? undefined;
  const viewer = await createViewer(document.getElementById('canvas'), { blend, smoothAtRest: given.has('smooth') });
  viewer.gliding = false;  // cameras move at once
  window.viewer = viewer;
</script>`;

/** Files that pages load, by number. */
const offered = [];

/** Routes that stage() needs for `drawingPage`. */
export const drawingRoutes = {
  '/offered': (request, response) => response.writeHead(200).end(readFileSync(offered[Number(request.url.split('?')[1])])),
  '/drawing.html': (request, response) => response.writeHead(200, { 'content-type': 'text/html' }).end(emptyPage),
};

/** Helpers for a page at drawing.html or drawing.html?blend=raster, once it is ready. With ?smooth, images are those at rest;
 *  otherwise they have one sample per pixel, as the goldens. */
export async function drawingPage(page) {
  await page.waitForFunction(() => window.viewer);
  return {
    /** Loads a file, or a folder with all its files. */
    async load(folder, names = readdirSync(folder)) {
      const files = names.map((path) => ({ path, url: `/offered?${offered.push(join(folder, path)) - 1}` }));
      await page.evaluate(async (given) => {
        const bytes = async (url) => (await fetch(url)).blob();
        await viewer.load({ files: await Promise.all(given.map(async ({ path, url }) => ({ path, data: await bytes(url) }))) });
      }, files);
    },
    /** `from`: the number of a recorded camera, or a pose. `background`: by default the scene's. */
    async image({ from, width, height, look = 'color', features, background }) {
      const base64 = await page.evaluate(async ([at, size, what, which, color]) => {
        if (color) viewer.background = color;
        if (typeof at === 'number') viewer.showCamera(at); else viewer.setView(at);
        await viewer.show(what, which);
        const bytes = new Uint8Array(await (await viewer.screenshot(size)).arrayBuffer());
        return btoa(bytes.reduce((text, byte) => text + String.fromCharCode(byte), ''));
      }, [from, { width, height }, look, features, background]);
      return readPng(Buffer.from(base64, 'base64'));
    },
  };
}
