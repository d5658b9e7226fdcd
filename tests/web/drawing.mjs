// A viewer of the package's API on an empty page, for tests of what it draws.

import { readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { readPng } from './png.mjs';

const emptyPage = `<!doctype html><html lang="en"><title>Drawing</title><link rel="icon" href="data:,">
<canvas id="canvas" style="width: 64px; height: 48px"></canvas>
<script type="module">
  import { createViewer } from '/viewer.js';
  const viewer = await createViewer(document.getElementById('canvas'));
  viewer.gliding = false;  // cameras are there at once
  window.viewer = viewer;
</script>`;

/** What stage() is to be given so that `drawingPage` works. */
export const drawingRoutes = {
  '/drawing.html': (request, response) => response.writeHead(200, { 'content-type': 'text/html' }).end(emptyPage),
};

/** Once the page that was visited at drawing.html is ready. */
export async function drawingPage(page) {
  await page.waitForFunction(() => window.viewer);
  return {
    /** A file, or a folder with all that is in it. */
    async load(folder, names = readdirSync(folder)) {
      const files = names.map((path) => ({ path, base64: readFileSync(join(folder, path)).toString('base64') }));
      await page.evaluate(async (given) => {
        const bytes = async (base64) => (await fetch(`data:application/octet-stream;base64,${base64}`)).blob();
        await viewer.load({ files: await Promise.all(given.map(async ({ path, base64 }) => ({ path, data: await bytes(base64) }))) });
      }, files);
    },
    /** `from`: the number of a recorded camera, or a pose. */
    async image({ from, width, height, look = 'color', features }) {
      const base64 = await page.evaluate(async ([at, size, what, which]) => {
        if (typeof at === 'number') viewer.showCamera(at); else viewer.setView(at);
        await viewer.show(what, which);
        const bytes = new Uint8Array(await (await viewer.screenshot(size)).arrayBuffer());
        return btoa(bytes.reduce((text, byte) => text + String.fromCharCode(byte), ''));
      }, [from, { width, height }, look, features]);
      return readPng(Buffer.from(base64, 'base64'));
    },
  };
}
