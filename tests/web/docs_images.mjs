// Draws the images of the page in docs/viewer.md: node tests/web/docs_images.mjs FOLDER. Needs what the
// browser tests need.

import { join } from 'node:path';
import { serve } from '../../web/serve.mjs';
import { built, launch } from './browser.mjs';

const folder = process.argv[2];
if (!folder) throw new Error('use: node tests/web/docs_images.mjs FOLDER');
const server = await serve(join(built, 'site'));
const browser = await launch('llvmpipe');
try {
  for (const colorScheme of ['dark', 'light']) {
    const profile = await browser.newContext({ viewport: { width: 960, height: 640 }, colorScheme });
    const page = await profile.newPage();
    await page.goto(new URL('?scene=soup.glb', server.address).href);
    await page.waitForFunction(() => document.getElementById('loading').hidden && !document.body.classList.contains('empty'));
    await page.keyboard.press('7');
    await page.waitForTimeout(3000);  // the view has arrived
    await page.screenshot({ path: join(folder, `page_${colorScheme}.png`) });
    await profile.close();
  }
} finally {
  await browser.close();
  await server.close();
}
